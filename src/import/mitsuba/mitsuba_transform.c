#include "import/mitsuba/mitsuba_transform.h"

#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"

#include <math.h>
#include <string.h>

static bool no_inverse(const struct mitsuba_node *node, struct err *err)
{
    return err_set(err, ERR_VALUE, &node->place, "this <%s> has no inverse", node->name);
}

static bool translate(const struct mitsuba_node *node, struct xform *out, struct err *err)
{
    double v[3] = {0.0, 0.0, 0.0};
    if (!mitsuba_xyz(node, v, err))
        return false;
    *out = xform_translate(v[0], v[1], v[2]);
    return true;
}

static bool scale(const struct mitsuba_node *node, struct xform *out, struct err *err)
{
    double v[3] = {1.0, 1.0, 1.0};
    if (!mitsuba_xyz(node, v, err))
        return false;
    if (v[0] == 0.0 || v[1] == 0.0 || v[2] == 0.0)
        return no_inverse(node, err);
    *out = xform_scale(v[0], v[1], v[2]);
    return true;
}

static bool rotate(const struct mitsuba_node *node, struct xform *out, struct err *err)
{
    double axis[3] = {0.0, 0.0, 0.0}, angle;
    size_t count;
    if (!mitsuba_xyz(node, axis, err) ||
        !mitsuba_numbers(node, "angle", 1, &angle, &count, err))
        return false;
    if (count != 1)
        return err_set(err, ERR_SYNTAX, &node->place, "<rotate> wants an angle");
    if (axis[0] == 0.0 && axis[1] == 0.0 && axis[2] == 0.0)
        return err_set(err, ERR_VALUE, &node->place, "<rotate> wants an axis");
    *out = xform_rotate(angle, axis[0], axis[1], axis[2]);
    return true;
}

static bool matrix(const struct mitsuba_node *node, struct xform *out, struct err *err)
{
    double v[16], m[16];
    size_t count;
    if (!mitsuba_numbers(node, "value", 16, v, &count, err))
        return false;
    if (count != 16 && count != 9)
        return err_set(err, ERR_SYNTAX, &node->place,
                       "<matrix> wants 16 numbers by rows (or 9), not %zu", count);
    memset(m, 0, sizeof m);
    m[15] = 1.0;
    if (count == 16)
        memcpy(m, v, sizeof m);
    for (size_t i = 0; count == 9 && i < 9; i++)
        m[4 * (i / 3) + i % 3] = v[i];
    return xform_from_matrix(m, out) || no_inverse(node, err);
}

static bool point_attribute(const struct mitsuba_node *node, const char *name,
                            double out[3], struct err *err)
{
    size_t count;
    if (!mitsuba_numbers(node, name, 3, out, &count, err))
        return false;
    return count == 3 || err_set(err, ERR_SYNTAX, &node->place,
                                 "the %s of <%s> wants 3 numbers", name, node->name);
}

/* The coordinate axis that is farthest from the gaze. */
static void any_up(const double origin[3], const double target[3], double up[3])
{
    int least = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(target[i] - origin[i]) < fabs(target[least] - origin[least]))
            least = i;
    for (int i = 0; i < 3; i++)
        up[i] = i == least ? 1.0 : 0.0;
}

bool mitsuba_look_along(const double origin[3], const double target[3], struct xform *out)
{
    double up[3];
    any_up(origin, target, up);
    return xform_look_at(origin, target, up, out);
}

/* The columns are left = up x forward, up and forward: what pbrt calls right, in a
 * right-handed world. */
static bool lookat(const struct mitsuba_node *node, struct xform *out, struct err *err)
{
    double origin[3], target[3], up[3];
    bool has_up = mitsuba_attribute(node, "up");
    if (!point_attribute(node, "origin", origin, err) ||
        !point_attribute(node, "target", target, err) ||
        (has_up && !point_attribute(node, "up", up, err)))
        return false;
    return (has_up ? xform_look_at(origin, target, up, out)
                   : mitsuba_look_along(origin, target, out)) ||
           err_set(err, ERR_VALUE, &node->place,
                   "<%s>: origin and target coincide, or up is parallel to the gaze",
                   node->name);
}

static const struct {
    const char *element;
    bool (*read)(const struct mitsuba_node *node, struct xform *out, struct err *err);
} steps[] = {{"translate", translate}, {"scale", scale},   {"rotate", rotate},
             {"matrix", matrix},       {"lookat", lookat}, {"lookAt", lookat}};

static bool read_step(const struct mitsuba_node *node, struct xform *out, struct err *err)
{
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++)
        if (text_equal(node->name, steps[i].element))
            return steps[i].read(node, out, err);
    return err_set(err, ERR_VALUE, &node->place,
                   "<%s> is no step of a transform (translate, scale, rotate, matrix, "
                   "lookat)",
                   node->name);
}

/* Of Mitsuba 0.x's animations the transform that stands first; NULL if there is none. */
static struct mitsuba_node *first_of(const struct mitsuba_node *animation)
{
    for (size_t i = 0; i < animation->child_count; i++)
        if (text_equal(animation->children[i]->name, "transform"))
            return animation->children[i];
    return NULL;
}

bool mitsuba_transform(struct mitsuba_node *object, const char *name, struct xform *value,
                       struct err *err)
{
    struct mitsuba_node *node = mitsuba_property(object, name);
    if (!node)
        return true;
    if (text_equal(node->name, "animation") && !(node = first_of(node)))
        return err_set(err, ERR_VALUE, &mitsuba_property(object, name)->place,
                       "this <animation> holds no <transform>");
    if (!text_equal(node->name, "transform"))
        return err_set(err, ERR_VALUE, &node->place,
                       "\"%s\" wants <transform>, this is <%s>", name, node->name);
    *value = xform_identity();
    for (size_t i = 0; i < node->child_count; i++) {
        struct xform step;
        if (!read_step(node->children[i], &step, err))
            return false;
        *value = xform_mul(&step, value); /* in the order in which they stand */
    }
    return true;
}
