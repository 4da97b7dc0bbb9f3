/* Surfaces of revolution. */
#include "import/pbrt/pbrt_shape.h"

#include "math/warp.h"

#include <math.h>

#define RINGS 65 /* of a curved profile */

/* pbrt turns the normals of mirrored quadrics to the other side, but for those of points
 * that it samples on lamps: what a lamp lights has its light from the side that it keeps.
 */
static bool reversed(const struct pbrt *p)
{
    bool mirrored = xform_swaps_handedness(&p->state.ctm);
    return p->state.reverse_orientation != (mirrored && !p->state.emits);
}

/* `form` and `what`: "a part of a", "sphere". */
static bool add_rings(struct pbrt *p, const char *form, const char *what,
                      const struct mesh_ring *rings, int count, double phi_max,
                      struct err *err)
{
    struct mesh *mesh = mesh_revolve(rings, count,
                                     fmin(phi_max, 360.0) * MATH_PI / 180.0);
    log_note(&p->desc->log, &p->params.place, "%s %s is taken as a mesh", form, what);
    return pbrt_shape_add_turned_mesh(p, mesh, reversed(p), err);
}

/* Lamps are sampled by area, which an uneven scale would change from point to point. */
static bool is_whole(const struct pbrt *p, double phi_max)
{
    double scale;
    return phi_max >= 360.0 &&
           (!p->state.emits || xform_is_similarity(&p->state.ctm, &scale));
}

static const char *form_of(bool part)
{
    return part ? "a part of a" : "a lamp on an unevenly scaled";
}

static bool add_whole(struct pbrt *p, struct shape_desc *shape, struct err *err)
{
    shape->to_world = p->state.ctm;
    shape->reverse_orientation = reversed(p);
    return pbrt_shape_add(p, shape, err);
}

static bool check(const struct pbrt *p, double radius, double phi_max, struct err *err)
{
    if (!(radius > 0.0))
        return err_set(err, ERR_VALUE, &p->params.place, "the radius is not positive");
    return phi_max > 0.0 ||
           err_set(err, ERR_VALUE, &p->params.place, "phimax is not positive");
}

bool pbrt_quadric_sphere(struct pbrt *p, struct err *err)
{
    struct shape_desc shape = {.kind = SHAPE_SPHERE, .radius = 1.0};
    struct mesh_ring rings[RINGS];
    double phi = 360.0, low = -HUGE_VAL, high = HUGE_VAL;
    if (!pbrt_params_float(&p->params, "radius", &shape.radius, err) ||
        !pbrt_params_float(&p->params, "phimax", &phi, err) ||
        !pbrt_params_float(&p->params, "zmin", &low, err) ||
        !pbrt_params_float(&p->params, "zmax", &high, err) ||
        !check(p, shape.radius, phi, err))
        return false;
    double r = shape.radius, from = fmin(low, high), to = fmax(low, high);
    bool part = from > -r || to < r || phi < 360.0;
    if (!part && is_whole(p, phi))
        return add_whole(p, &shape, err);
    if (from >= r || to <= -r)
        return err_set(err, ERR_VALUE, &p->params.place,
                       "zmin and zmax leave nothing of the sphere");
    double a = from <= -r ? MATH_PI : acos(from / r), b = to >= r ? 0.0 : acos(to / r);
    for (int i = 0; i < RINGS; i++) {
        double theta = a + (b - a) * i / (RINGS - 1), s = sin(theta), c = cos(theta);
        bool pole = theta == 0.0 || theta == MATH_PI;
        rings[i] = (struct mesh_ring){pole ? 0.0 : r * s, r * c, s, c};
    }
    return add_rings(p, form_of(part), "sphere", rings, RINGS, phi, err);
}

bool pbrt_quadric_disk(struct pbrt *p, struct err *err)
{
    struct shape_desc shape = {.kind = SHAPE_DISK, .radius = 1.0};
    double phi = 360.0, inner = 0.0;
    if (!pbrt_params_float(&p->params, "radius", &shape.radius, err) ||
        !pbrt_params_float(&p->params, "height", &shape.height, err) ||
        !pbrt_params_float(&p->params, "innerradius", &inner, err) ||
        !pbrt_params_float(&p->params, "phimax", &phi, err) ||
        !check(p, shape.radius, phi, err))
        return false;
    if (inner <= 0.0 && is_whole(p, phi))
        return add_whole(p, &shape, err);
    if (inner >= shape.radius)
        return err_set(err, ERR_VALUE, &p->params.place,
                       "innerradius is not below the radius");
    const struct mesh_ring rings[] = {{shape.radius, shape.height, 0.0, 1.0},
                                      {fmax(inner, 0.0), shape.height, 0.0, 1.0}};
    return add_rings(p, form_of(inner > 0.0 || phi < 360.0), "disk", rings, 2, phi, err);
}

bool pbrt_quadric_cylinder(struct pbrt *p, struct err *err)
{
    struct shape_desc shape = {
        .kind = SHAPE_CYLINDER, .radius = 1.0, .z_min = -1.0, .z_max = 1.0};
    double phi = 360.0;
    if (!pbrt_params_float(&p->params, "radius", &shape.radius, err) ||
        !pbrt_params_float(&p->params, "zmin", &shape.z_min, err) ||
        !pbrt_params_float(&p->params, "zmax", &shape.z_max, err) ||
        !pbrt_params_float(&p->params, "phimax", &phi, err) ||
        !check(p, shape.radius, phi, err))
        return false;
    if (!(shape.z_min < shape.z_max))
        return err_set(err, ERR_VALUE, &p->params.place, "zmin is not below zmax");
    if (is_whole(p, phi))
        return add_whole(p, &shape, err);
    const struct mesh_ring rings[] = {{shape.radius, shape.z_min, 1.0, 0.0},
                                      {shape.radius, shape.z_max, 1.0, 0.0}};
    return add_rings(p, form_of(phi < 360.0), "cylinder", rings, 2, phi, err);
}

bool pbrt_quadric_cone(struct pbrt *p, struct err *err)
{
    double radius = 1.0, height = 1.0, phi = 360.0;
    if (!pbrt_params_float(&p->params, "radius", &radius, err) ||
        !pbrt_params_float(&p->params, "height", &height, err) ||
        !pbrt_params_float(&p->params, "phimax", &phi, err) ||
        !check(p, radius, phi, err))
        return false;
    const struct mesh_ring rings[] = {{radius, 0.0, height, radius},
                                      {0.0, height, height, radius}};
    return add_rings(p, "a", "cone", rings, 2, phi, err);
}

/* radius^2 z / z_max = r^2; the normal is (z', -r') of a step along the profile. */
bool pbrt_quadric_paraboloid(struct pbrt *p, struct err *err)
{
    struct mesh_ring rings[RINGS];
    double radius = 1.0, z_min = 0.0, z_max = 1.0, phi = 360.0;
    if (!pbrt_params_float(&p->params, "radius", &radius, err) ||
        !pbrt_params_float(&p->params, "zmin", &z_min, err) ||
        !pbrt_params_float(&p->params, "zmax", &z_max, err) ||
        !pbrt_params_float(&p->params, "phimax", &phi, err) ||
        !check(p, radius, phi, err))
        return false;
    if (!(z_min >= 0.0 && z_min < z_max))
        return err_set(err, ERR_VALUE, &p->params.place,
                       "a paraboloid wants 0 <= zmin < zmax");
    /* Rings at equal steps of the radius, where the curve is. */
    double a = sqrt(z_min / z_max);
    for (int i = 0; i < RINGS; i++) {
        double t = a + (1.0 - a) * i / (RINGS - 1);
        rings[i] = (struct mesh_ring){radius * t, z_max * t * t, 2.0 * z_max * t,
                                      -radius};
    }
    return add_rings(p, "a", "paraboloid", rings, RINGS, phi, err);
}

/* A line segment, turned about z. */
bool pbrt_quadric_hyperboloid(struct pbrt *p, struct err *err)
{
    struct mesh_ring rings[RINGS];
    double a[3] = {0.0, 0.0, 0.0}, b[3] = {1.0, 1.0, 1.0}, d[3], phi = 360.0;
    bool found;
    if (!pbrt_params_point(&p->params, "p1", a, &found, err) ||
        !pbrt_params_point(&p->params, "p2", b, &found, err) ||
        !pbrt_params_float(&p->params, "phimax", &phi, err) || !check(p, 1.0, phi, err))
        return false;
    for (int i = 0; i < 3; i++)
        d[i] = b[i] - a[i];
    if (d[0] == 0.0 && d[1] == 0.0 && (d[2] == 0.0 || (a[0] == 0.0 && a[1] == 0.0)))
        return err_set(err, ERR_VALUE, &p->params.place,
                       "p1 and p2 of a hyperboloid make no surface");
    for (int i = 0; i < RINGS; i++) {
        double t = (double)i / (RINGS - 1), x = a[0] + t * d[0], y = a[1] + t * d[1];
        double radius = hypot(x, y);
        double grows = radius > 0.0 ? (x * d[0] + y * d[1]) / radius : hypot(d[0], d[1]);
        rings[i] = (struct mesh_ring){radius, a[2] + t * d[2], d[2], -grows};
        if (rings[i].normal_radius == 0.0 && rings[i].normal_z == 0.0)
            rings[i].normal_z = 1.0;
    }
    return add_rings(p, "a", "hyperboloid", rings, RINGS, phi, err);
}
