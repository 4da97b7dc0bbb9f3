#include "import/mitsuba/mitsuba_property.h"

#include "base/text.h"
#include "import/number.h"

#include <ctype.h>
#include <float.h>
#include <limits.h>
#include <math.h>
#include <string.h>

bool mitsuba_same_name(const char *a, const char *b)
{
    for (;; a++, b++) {
        while (*a == '_')
            a++;
        while (*b == '_')
            b++;
        if (tolower((unsigned char)*a) != tolower((unsigned char)*b))
            return false;
        if (!*a)
            return true;
    }
}

bool mitsuba_one_of(const char *name, const char *const *list)
{
    for (; *list; list++)
        if (mitsuba_same_name(name, *list))
            return true;
    return false;
}

struct mitsuba_node *mitsuba_property(struct mitsuba_node *object, const char *name)
{
    for (size_t i = 0; i < object->child_count; i++) {
        struct mitsuba_node *child = object->children[i];
        const char *own = mitsuba_attribute(child, "name");
        if (own && mitsuba_same_name(own, name)) {
            child->used = true;
            return child;
        }
    }
    return NULL;
}

void mitsuba_ignore(struct mitsuba_node *object, const char *const *names)
{
    for (; *names; names++)
        mitsuba_property(object, *names);
}

static const char *want_value(const struct mitsuba_node *node, const char *attribute,
                              struct err *err)
{
    const char *value = mitsuba_attribute(node, attribute);
    if (!value)
        err_set(err, ERR_SYNTAX, &node->place, "<%s> wants the attribute %s", node->name,
                attribute);
    return value;
}

static bool is_separator(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',';
}

bool mitsuba_numbers(const struct mitsuba_node *node, const char *attribute, size_t room,
                     double *values, size_t *count, struct err *err)
{
    const char *s = want_value(node, attribute, err);
    *count = 0;
    if (!s)
        return false;
    for (;;) {
        while (is_separator(*s))
            s++;
        if (!*s)
            return true;
        double value;
        const char *after = number_parse(s, &value);
        if (!after || (*after && !is_separator(*after)))
            return err_set(err, ERR_SYNTAX, &node->place,
                           "\"%.40s\" in the %s of <%s> is not a number", s, attribute,
                           node->name);
        if (!(fabs(value) <= (double)FLT_MAX))
            return err_set(err, ERR_VALUE, &node->place,
                           "a number in the %s of <%s> is beyond the range of float",
                           attribute, node->name);
        if (*count == room)
            return err_set(err, ERR_SYNTAX, &node->place,
                           "the %s of <%s> holds more than %zu numbers", attribute,
                           node->name, room);
        values[(*count)++] = value;
        s = after;
    }
}

static bool one_number(const struct mitsuba_node *node, const char *attribute,
                       double *value, struct err *err)
{
    size_t count;
    if (!mitsuba_numbers(node, attribute, 1, value, &count, err))
        return false;
    return count == 1 || err_set(err, ERR_SYNTAX, &node->place,
                                 "the %s of <%s> holds no number", attribute, node->name);
}

static bool wrong_kind(const struct mitsuba_node *node, const char *wanted,
                       struct err *err)
{
    return err_set(err, ERR_VALUE, &node->place, "\"%s\" wants <%s>, this is <%s>",
                   mitsuba_attribute(node, "name"), wanted, node->name);
}

bool mitsuba_float(struct mitsuba_node *object, const char *name, double *value,
                   struct err *err)
{
    struct mitsuba_node *node = mitsuba_property(object, name);
    if (!node)
        return true;
    if (!text_equal(node->name, "float") && !text_equal(node->name, "integer"))
        return wrong_kind(node, "float", err);
    return one_number(node, "value", value, err);
}

bool mitsuba_integer(struct mitsuba_node *object, const char *name, int *value,
                     struct err *err)
{
    double number;
    struct mitsuba_node *node = mitsuba_property(object, name);
    if (!node)
        return true;
    if (!text_equal(node->name, "integer") && !text_equal(node->name, "float"))
        return wrong_kind(node, "integer", err);
    if (!one_number(node, "value", &number, err))
        return false;
    if (number != trunc(number) || number > INT_MAX || number < INT_MIN)
        return err_set(err, ERR_VALUE, &node->place, "%g is no integer of 32 bits",
                       number);
    *value = (int)number;
    return true;
}

bool mitsuba_boolean(struct mitsuba_node *object, const char *name, bool *value,
                     struct err *err)
{
    struct mitsuba_node *node = mitsuba_property(object, name);
    if (!node)
        return true;
    if (!text_equal(node->name, "boolean"))
        return wrong_kind(node, "boolean", err);
    const char *text = want_value(node, "value", err);
    if (!text)
        return false;
    *value = mitsuba_same_name(text, "true");
    return *value || mitsuba_same_name(text, "false") ||
           err_set(err, ERR_VALUE, &node->place, "\"%.40s\" is neither true nor false",
                   text);
}

bool mitsuba_string(struct mitsuba_node *object, const char *name, const char **value,
                    struct err *err)
{
    struct mitsuba_node *node = mitsuba_property(object, name);
    if (!node)
        return true;
    if (!text_equal(node->name, "string"))
        return wrong_kind(node, "string", err);
    const char *text = want_value(node, "value", err);
    if (text)
        *value = text;
    return text != NULL;
}

bool mitsuba_xyz(const struct mitsuba_node *node, double xyz[3], struct err *err)
{
    static const char *const names[3] = {"x", "y", "z"};
    if (mitsuba_attribute(node, "value")) {
        size_t count;
        if (!mitsuba_numbers(node, "value", 3, xyz, &count, err))
            return false;
        if (count == 1)
            xyz[1] = xyz[2] = xyz[0];
        return count == 1 || count == 3 ||
               err_set(err, ERR_SYNTAX, &node->place,
                       "the value of <%s> holds %zu numbers, 1 or 3 are wanted",
                       node->name, count);
    }
    for (int i = 0; i < 3; i++)
        if (mitsuba_attribute(node, names[i]) &&
            !one_number(node, names[i], &xyz[i], err))
            return false;
    return true;
}

bool mitsuba_point(struct mitsuba_node *object, const char *name, double value[3],
                   struct err *err)
{
    struct mitsuba_node *node = mitsuba_property(object, name);
    if (!node)
        return true;
    if (!text_equal(node->name, "point") && !text_equal(node->name, "vector"))
        return wrong_kind(node, "point", err);
    double xyz[3] = {0.0, 0.0, 0.0};
    if (!mitsuba_xyz(node, xyz, err))
        return false;
    memcpy(value, xyz, sizeof xyz);
    return true;
}
