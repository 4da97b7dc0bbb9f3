#include "import/yaml/scene_yaml.h"

#include "base/text.h"
#include "import/suggest.h"

static bool read_axis(const struct doc_node *map, enum fov_axis *axis, struct err *err)
{
    static const char *const names[] = {[FOV_SMALLER] = "smaller",
                                        [FOV_LARGER] = "larger",
                                        [FOV_X] = "x",
                                        [FOV_Y] = "y",
                                        [FOV_DIAGONAL] = "diagonal",
                                        NULL};
    const struct doc_node *node = doc_get(map, "fov_axis");
    const char *name;
    if (!node)
        return true;
    if (!doc_to_text(node, &name, err))
        return false;
    for (int i = 0; names[i]; i++) {
        if (text_equal(name, names[i])) {
            *axis = (enum fov_axis)i;
            return true;
        }
    }
    struct place at = doc_place(node);
    return suggest_fail(err, &at, "fov_axis", name, names);
}

/* The world of our files is right-handed, xform_look_at's camera is not: mirror x. */
static bool read_view(const struct doc_node *map, struct xform *to_world, struct err *err)
{
    double position[3], target[3], up[3] = {0.0, 1.0, 0.0};
    if (!scene_yaml_want(map, "position", err) || !scene_yaml_want(map, "target", err) ||
        !scene_yaml_vector(map, "position", position, err) ||
        !scene_yaml_vector(map, "target", target, err) ||
        !scene_yaml_vector(map, "up", up, err))
        return false;
    struct place at = doc_place(map);
    struct xform view, mirror = xform_scale(-1.0, 1.0, 1.0);
    if (!xform_look_at(position, target, up, &view))
        return err_set(err, ERR_VALUE, &at,
                       "position and target coincide, or up points along the view");
    *to_world = xform_mul(&view, &mirror);
    return true;
}

static bool read_matrix(const struct doc_node *map, struct xform *to_world,
                        struct err *err)
{
    double m[16];
    const struct doc_node *node = doc_get(map, "matrix");
    struct place at = doc_place(node);
    if (doc_get(map, "position") || doc_get(map, "target") || doc_get(map, "up"))
        return err_set(err, ERR_VALUE, &at,
                       "a matrix leaves no room for position, target or up");
    if (!doc_to_doubles(node, m, 16, err))
        return false;
    return xform_from_matrix(m, to_world) ||
           err_set(err, ERR_VALUE, &at, "the matrix has no inverse");
}

bool scene_yaml_camera(struct scene_yaml *s, const struct doc_node *map, struct err *err)
{
    static const char *const keys[] = {
        "position",    "target",         "up",     "fov",    "fov_axis",
        "lens_radius", "focus_distance", "matrix", "extent", NULL};
    struct camera_desc *camera = &s->desc->camera;
    camera->place = scene_yaml_place(s, map);
    camera->fov = 40.0;
    camera->fov_axis = FOV_SMALLER;
    camera->focus_distance = 1.0;
    if (!scene_yaml_map(map, "camera", keys, err) ||
        !(doc_get(map, "matrix") ? read_matrix(map, &camera->to_world, err)
                                 : read_view(map, &camera->to_world, err)) ||
        !read_axis(map, &camera->fov_axis, err) ||
        !scene_yaml_double(map, "fov", &camera->fov, err) ||
        !scene_yaml_double(map, "extent", &camera->extent, err) ||
        !scene_yaml_double(map, "lens_radius", &camera->lens_radius, err) ||
        !scene_yaml_double(map, "focus_distance", &camera->focus_distance, err))
        return false;
    struct place at = doc_place(map);
    if (doc_get(map, "extent") && (doc_get(map, "fov") || !(camera->extent > 0.0)))
        return err_set(err, ERR_VALUE, &at,
                       "the extent of an orthographic camera is positive, and leaves no "
                       "room for a fov");
    if (!(camera->fov > 0.0 && camera->fov < 180.0))
        return err_set(err, ERR_VALUE, &at, "fov %g is not between 0 and 180 degrees",
                       camera->fov);
    if (camera->lens_radius < 0.0 || !(camera->focus_distance > 0.0))
        return err_set(err, ERR_VALUE, &at,
                       "lens_radius must not be negative, focus_distance must be "
                       "positive");
    if (camera->lens_radius > 0.0 && !doc_get(map, "focus_distance"))
        return err_set(err, ERR_VALUE, &at, "a lens wants a focus_distance");
    return true;
}
