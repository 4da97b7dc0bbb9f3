#include "import/yaml/scene_yaml.h"

#include "base/text.h"

typedef bool step_fn(const struct doc_node *node, struct xform *out, struct err *err);

static bool translate(const struct doc_node *node, struct xform *out, struct err *err)
{
    double v[3];
    if (!doc_to_doubles(node, v, 3, err))
        return false;
    *out = xform_translate(v[0], v[1], v[2]);
    return true;
}

static bool scale(const struct doc_node *node, struct xform *out, struct err *err)
{
    double v[3];
    if (!scene_yaml_three(node, v, err))
        return false;
    struct place at = doc_place(node);
    if (v[0] == 0.0 || v[1] == 0.0 || v[2] == 0.0)
        return err_set(err, ERR_VALUE, &at, "a scale of 0 has no inverse");
    *out = xform_scale(v[0], v[1], v[2]);
    return true;
}

static bool rotate(const struct doc_node *node, struct xform *out, struct err *err)
{
    static const char *const keys[] = {"axis", "degrees", NULL};
    double axis[3];
    double degrees;
    const struct doc_node *a, *d;
    if (!scene_yaml_map(node, "rotate", keys, err) ||
        !(a = scene_yaml_want(node, "axis", err)) ||
        !(d = scene_yaml_want(node, "degrees", err)) ||
        !doc_to_doubles(a, axis, 3, err) || !doc_to_double(d, &degrees, err))
        return false;
    struct place at = doc_place(a);
    if (axis[0] == 0.0 && axis[1] == 0.0 && axis[2] == 0.0)
        return err_set(err, ERR_VALUE, &at, "the axis is zero");
    *out = xform_rotate(degrees, axis[0], axis[1], axis[2]);
    return true;
}

static bool matrix(const struct doc_node *node, struct xform *out, struct err *err)
{
    double m[16];
    if (!doc_to_doubles(node, m, 16, err))
        return false;
    struct place at = doc_place(node);
    if (m[12] != 0.0 || m[13] != 0.0 || m[14] != 0.0 || m[15] != 1.0)
        return err_set(err, ERR_VALUE, &at, "the last row of the matrix is not 0 0 0 1");
    return xform_from_matrix(m, out) ||
           err_set(err, ERR_VALUE, &at, "the matrix has no inverse");
}

/* Puts the object at position with its +z towards target and its +y upwards. */
static bool look_at(const struct doc_node *node, struct xform *out, struct err *err)
{
    static const char *const keys[] = {"position", "target", "up", NULL};
    double position[3] = {0}, target[3] = {0}, up[3] = {0.0, 1.0, 0.0};
    if (!scene_yaml_map(node, "look_at", keys, err) ||
        !scene_yaml_vector(node, "position", position, err) ||
        !scene_yaml_vector(node, "target", target, err) ||
        !scene_yaml_vector(node, "up", up, err))
        return false;
    struct place at = doc_place(node);
    return xform_look_at(position, target, up, out) ||
           err_set(err, ERR_VALUE, &at,
                   "position and target coincide, or up points along the view");
}

static const char *const step_names[] = {"translate", "scale",   "rotate",
                                         "matrix",    "look_at", NULL};
static step_fn *const steps[] = {translate, scale, rotate, matrix, look_at};

static bool read_step(const struct doc_node *node, struct xform *out, struct err *err)
{
    if (!scene_yaml_map(node, "a step of a transform", step_names, err))
        return false;
    struct place at = doc_place(node);
    if (doc_count(node) != 1)
        return err_set(err, ERR_SYNTAX, &at,
                       "one step is one key; write a list of steps to give an order");
    for (int i = 0; step_names[i]; i++)
        if (text_equal(doc_key(node, 0), step_names[i]))
            return steps[i](doc_item(node, 0), out, err);
    return false; /* doc_check_keys let no other name through */
}

bool scene_yaml_transform(const struct doc_node *node, struct xform *out, struct err *err)
{
    bool list = doc_kind(node) == DOC_LIST;
    *out = xform_identity();
    for (int i = 0; i < (list ? doc_count(node) : 1); i++) {
        struct xform step;
        if (!read_step(list ? doc_item(node, i) : node, &step, err))
            return false;
        *out = xform_mul(&step, out);
    }
    return true;
}
