#include "import/mitsuba/mitsuba_parameter.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/suggest.h"

#include <string.h>

struct mitsuba_parameter {
    char *name, *value;
    bool defined; /* by the options */
    bool used;
};

void mitsuba_parameters_deinit(struct mitsuba_parameters *parameters)
{
    for (size_t i = 0; i < parameters->count; i++) {
        mem_free(parameters->list[i].name);
        mem_free(parameters->list[i].value);
    }
    mem_free(parameters->list);
    *parameters = (struct mitsuba_parameters){0};
}

static void add(struct mitsuba_parameters *parameters, struct mitsuba_parameter parameter)
{
    parameters->list = mem_grow(parameters->list, &parameters->capacity,
                                parameters->count + 1, sizeof *parameters->list);
    parameters->list[parameters->count++] = parameter;
}

static struct mitsuba_parameter *find(const struct mitsuba_parameters *parameters,
                                      const char *name)
{
    for (size_t i = 0; i < parameters->count; i++)
        if (text_equal(parameters->list[i].name, name))
            return &parameters->list[i];
    return NULL;
}

/* The longest known name at s; NULL if there is none. */
static struct mitsuba_parameter *find_longest(const struct mitsuba_parameters *parameters,
                                              const char *s)
{
    struct mitsuba_parameter *best = NULL;
    size_t best_length = 0;
    for (size_t i = 0; i < parameters->count; i++) {
        size_t length = strlen(parameters->list[i].name);
        if (length > best_length && strncmp(s, parameters->list[i].name, length) == 0) {
            best = &parameters->list[i];
            best_length = length;
        }
    }
    return best;
}

bool mitsuba_parameters_define(struct mitsuba_parameters *parameters,
                               const struct import_options *options, struct err *err)
{
    for (int i = 0; options && i < options->definition_count; i++) {
        const char *text = options->definitions[i], *equals = strchr(text, '=');
        if (!equals || equals == text)
            return err_set(err, ERR_USAGE, NULL,
                           "'%s' defines nothing: NAME=VALUE is wanted", text);
        char *name = text_copy_n(text, (size_t)(equals - text));
        if (find(parameters, name)) {
            mem_free(name);
            return err_set(err, ERR_USAGE, NULL, "'%s' is defined twice", text);
        }
        add(parameters,
            (struct mitsuba_parameter){name, text_copy(equals + 1), true, false});
    }
    return true;
}

void mitsuba_parameters_default(struct mitsuba_parameters *parameters, const char *name,
                                const char *value)
{
    struct mitsuba_parameter *before = find(parameters, name);
    if (before)
        before->used = true;
    else
        add(parameters,
            (struct mitsuba_parameter){text_copy(name), text_copy(value), false, true});
}

static bool unknown(const struct mitsuba_parameters *parameters, const char *name,
                    const struct place *at, struct err *err)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                  "0123456789_";
    const char **known = mem_alloc(parameters->count + 1, sizeof *known);
    for (size_t i = 0; i < parameters->count; i++)
        known[i] = parameters->list[i].name;
    char *word = text_copy_n(name, strspn(name, letters));
    suggest_fail(err, at, "parameter", word, known);
    mem_free(word);
    mem_free(known);
    return false;
}

/* What stands before the dollar and the value of the parameter behind it; *rest goes on
 * from there. */
static bool replace_one(const struct mitsuba_parameters *parameters, const char *dollar,
                        const char **rest, struct text *out, const struct place *at,
                        struct err *err)
{
    struct mitsuba_parameter *p = find_longest(parameters, dollar + 1);
    if (!p)
        return unknown(parameters, dollar + 1, at, err);
    p->used = true;
    text_append(out, "%.*s%s", (int)(dollar - *rest), *rest, p->value);
    *rest = dollar + 1 + strlen(p->name);
    return out->length <= MITSUBA_VALUE_MAX ||
           err_set(err, ERR_VALUE, at,
                   "$parameters make an attribute of more than %d bytes",
                   MITSUBA_VALUE_MAX);
}

char *mitsuba_parameters_replace(const struct mitsuba_parameters *parameters,
                                 const char *text, const struct place *at,
                                 struct err *err)
{
    struct text out = {0};
    text_append(&out, "%s", "");
    for (const char *dollar; (dollar = strchr(text, '$'));)
        if (!replace_one(parameters, dollar, &text, &out, at, err)) {
            mem_free(out.data);
            return NULL;
        }
    text_append(&out, "%s", text);
    return out.data;
}

bool mitsuba_parameters_check(const struct mitsuba_parameters *parameters,
                              const char *path, struct err *err)
{
    const struct place at = {path, 0, 0};
    const char **known = mem_alloc(parameters->count + 1, sizeof *known);
    size_t count = 0;
    const struct mitsuba_parameter *unused = NULL;
    for (size_t i = 0; i < parameters->count; i++) {
        const struct mitsuba_parameter *p = &parameters->list[i];
        if (p->defined && !p->used)
            unused = p;
        else
            known[count++] = p->name;
    }
    if (unused)
        suggest_fail(err, &at, "parameter", unused->name, known);
    mem_free(known);
    return !unused;
}
