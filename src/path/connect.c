#include "path/connect.h"

#include "path/mis.h"

/* The straight line between two vertices. */
struct edge {
    struct vec3 w;         /* unit, from a to b */
    double inverse_square; /* 1 / distance^2 */
};

static bool edge_between(const struct anchor *a, const struct anchor *b, struct edge *e)
{
    struct vec3 d = vec3_sub(b->p, a->p);
    double x = (double)d.x, y = (double)d.y, z = (double)d.z;
    double square = x * x + y * y + z * z;
    if (!(square > 0.0))
        return false;
    double inverse = 1.0 / sqrt(square);
    e->w = vec3((float)(x * inverse), (float)(y * inverse), (float)(z * inverse));
    e->inverse_square = 1.0 / square;
    return true;
}

/* To the point of a light; at infinity a place beyond all shapes stands for it, so that
 * visibility is tested as ever. */
static bool edge_from_light(struct vertex *y, const struct anchor *z, struct edge *e)
{
    if (!y->light->infinite)
        return edge_between(&y->hit.at, z, e);
    *e = (struct edge){y->hit.at.ng, 1.0};
    float far = (float)(2.0 * y->light->sphere.radius);
    y->hit.at.p = vec3_mad(z->p, -far, y->hit.at.ng);
    return true;
}

static double cos_geometric(const struct vertex *v, struct vec3 w)
{
    return fabs((double)vec3_dot(v->hit.at.ng, w));
}

static double cos_shading(const struct vertex *v, struct vec3 w)
{
    return fabs((double)vec3_dot(v->hit.shading.n, w));
}

bool connect_hit(const struct subpaths *paths, const struct vertex *z, int edges,
                 struct connection *out)
{
    const struct light *light = z->light;
    if (light == NULL)
        return false;
    struct rgb emission = light_emission(light, &z->hit.at, z->wo);
    if (rgb_is_black(emission))
        return false;
    out->value = rgb_mul(z->throughput, emission);
    out->pixel = paths->pixel;
    out->weight = 1.0; /* a light seen directly has one technique only */
    if (edges > 1) {
        double q = light->type->pdf_direction(light, &z->hit.at, z->wo);
        double pdf_point = light_pdf_point(light, &z->hit.at);
        out->weight = mis_weight(0.0, mis_side(z, pdf_point, q));
    }
    return true;
}

bool connect_light(const struct subpaths *paths, const double u[3],
                   const struct vertex *z, struct connection *out, struct vertex *point)
{
    struct vertex y;
    struct edge e;
    struct bsdf_value f;
    y.light = light_sample(paths->scene, u[0], u + 1, &y.hit.at);
    if (!edge_from_light(&y, &z->hit.at, &e))
        return false;
    struct rgb emission = light_emission(y.light, &y.hit.at, e.w);
    if (rgb_is_black(emission) ||
        !vertex_scatter(z, vec3_neg(e.w), TRANSPORT_RADIANCE, &f))
        return false;
    bool delta = y.light->delta_position;
    double cos_light = delta ? 1.0 : cos_geometric(&y, e.w);
    double geometry = cos_light * cos_shading(z, e.w) * e.inverse_square;
    y.pdf_fwd = light_pdf_point(y.light, &y.hit.at);
    out->value = rgb_scale(rgb_mul(rgb_mul(z->throughput, f.f), emission),
                           geometry / y.pdf_fwd);
    out->pixel = paths->pixel;
    y.prev_connects = !delta;
    y.mis_tail = 0.0;
    double q_light = f.pdf * cos_light * e.inverse_square;
    double q_dir = y.light->type->pdf_direction(y.light, &y.hit.at, e.w);
    double q_surface = q_dir * cos_geometric(z, e.w) * e.inverse_square;
    out->weight = mis_weight(mis_side(&y, q_light, 0.0),
                             mis_side(z, q_surface, f.pdf_rev));
    if (rgb_is_black(out->value) || !accel_visible(paths->scene, &y.hit.at, &z->hit.at))
        return false;
    if (point) {
        y.kind = VERTEX_LIGHT;
        y.connectible = true;
        y.delta_event = false;
        *point = y;
    }
    return true;
}

bool connect_camera(const struct subpaths *paths, const struct vertex *y,
                    struct connection *out)
{
    const struct vertex *z = &paths->camera[0];
    struct edge e;
    struct bsdf_value f;
    double pdf, cos_axis;
    if (!edge_between(&y->hit.at, &z->hit.at, &e))
        return false;
    struct vec3 seen = vec3_neg(e.w);
    out->pixel = camera_project(&paths->scene->camera, &z->hit.at, seen, &pdf, &cos_axis);
    if (out->pixel < 0 || !vertex_scatter(y, e.w, TRANSPORT_IMPORTANCE, &f))
        return false;
    /* We cos / (lens density) is the density of the direction: both are normalised over
     * the film. */
    double cos_y = cos_geometric(y, e.w);
    double q = pdf * cos_y * e.inverse_square;
    out->value = rgb_scale(rgb_mul(y->throughput, f.f), y->adjoint * q);
    out->weight = mis_weight(mis_side(y, q, f.pdf_rev), 0.0);
    return !rgb_is_black(out->value) &&
           accel_visible(paths->scene, &y->hit.at, &z->hit.at);
}

bool connect_surfaces(const struct subpaths *paths, const struct vertex *y,
                      const struct vertex *z, struct connection *out)
{
    struct edge e;
    struct bsdf_value fy, fz;
    if (!edge_between(&y->hit.at, &z->hit.at, &e) ||
        !vertex_scatter(y, e.w, TRANSPORT_IMPORTANCE, &fy) ||
        !vertex_scatter(z, vec3_neg(e.w), TRANSPORT_RADIANCE, &fz))
        return false;
    double conv_y = cos_geometric(y, e.w) * e.inverse_square;
    double conv_z = cos_geometric(z, e.w) * e.inverse_square;
    struct rgb f = rgb_mul(rgb_mul(y->throughput, fy.f), rgb_mul(z->throughput, fz.f));
    out->value = rgb_scale(f, y->adjoint * conv_y * cos_shading(z, e.w));
    out->pixel = paths->pixel;
    out->weight = mis_weight(mis_side(y, fz.pdf * conv_y, fy.pdf_rev),
                             mis_side(z, fy.pdf * conv_z, fz.pdf_rev));
    return !rgb_is_black(out->value) &&
           accel_visible(paths->scene, &y->hit.at, &z->hit.at);
}
