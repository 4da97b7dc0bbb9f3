#include "path/connect.h"

#include "path/mis.h"

/* The edge between two vertices; V and the cosines of the geometric term
 * G = V |cos| |cos'| / distance^2 [Veach97 Eq. 8.2] are the caller's. */
struct edge {
    struct vec3 w;         /* unit, from a to b */
    double inverse_square; /* 1 / distance^2 */
};

static bool edge_between(const struct ray_endpoint *a, const struct ray_endpoint *b,
                         struct edge *e)
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

/* The edge from the light point y to z. A point outside all shapes stands for a light at
 * infinity, so that accel_visible tests this edge as any other. */
static bool edge_from_light(struct vertex *y, const struct ray_endpoint *z,
                            struct edge *e)
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

/* Tests visibility last, as it costs most. */
static enum failure unobstructed(const struct subpaths *paths, const struct vertex *y,
                                 const struct vertex *z, struct rgb value)
{
    if (rgb_is_black(value))
        return FAILURE_ZERO;
    return accel_visible(paths->scene, &y->hit.at, &z->hit.at) ? FAILURE_NONE
                                                               : FAILURE_BLOCKED;
}

enum failure connect_hit(const struct subpaths *paths, const struct vertex *z, int edges,
                         struct connection *out)
{
    const struct light *light = z->light;
    if (light == NULL)
        return FAILURE_ZERO;
    struct rgb emission = light_emission(light, &z->hit.at, z->wo);
    if (rgb_is_black(emission))
        return FAILURE_ZERO;
    out->value = rgb_mul(z->throughput, emission); /* C_{0,t} [Veach97 Eq. 10.8] */
    out->pixel = paths->pixel;
    out->weight = 1.0; /* (0,2) is the only technique of length 1 */
    if (edges > 1) {
        double q = light->type->pdf_direction(light, &z->hit.at, z->wo);
        double pdf_point = light_pdf_point(light, &z->hit.at);
        out->weight = mis_weight(0.0, mis_side(z, pdf_point, q));
    }
    return FAILURE_NONE;
}

enum failure connect_light(const struct subpaths *paths, const double u[3],
                           const struct vertex *z, struct connection *out,
                           struct vertex *point)
{
    struct vertex y;
    struct edge e;
    struct bsdf_value f;
    y.light = light_sample(paths->scene, u[0], u + 1, &y.hit.at);
    if (!edge_from_light(&y, &z->hit.at, &e))
        return FAILURE_ZERO;
    struct rgb emission = light_emission(y.light, &y.hit.at, e.w);
    if (rgb_is_black(emission) ||
        !vertex_scatter(z, vec3_neg(e.w), TRANSPORT_RADIANCE, &f))
        return FAILURE_ZERO;
    bool delta = y.light->delta_position;
    double cos_light = delta ? 1.0 : cos_geometric(&y, e.w);
    double geometry = cos_light * cos_shading(z, e.w) * e.inverse_square;
    y.pdf_fwd = light_pdf_point(y.light, &y.hit.at);
    /* C_{1,t} = (L_e / p) G f alpha_t [Veach97 Eq. 10.8]. */
    out->value = rgb_scale(rgb_mul(rgb_mul(z->throughput, f.f), emission),
                           geometry / y.pdf_fwd);
    out->pixel = paths->pixel;
    y.prev_connects = !delta;
    y.mis_tail = 0.0;
    /* Densities of both ends as the other sub-path would sample them, per area: what
     * [Veach97 Eq. 10.9] wants. */
    double q_light = f.pdf * cos_light * e.inverse_square;
    double q_dir = y.light->type->pdf_direction(y.light, &y.hit.at, e.w);
    double q_surface = q_dir * cos_geometric(z, e.w) * e.inverse_square;
    out->weight = mis_weight(mis_side(&y, q_light, 0.0),
                             mis_side(z, q_surface, f.pdf_rev));
    enum failure failure = unobstructed(paths, &y, z, out->value);
    if (failure == FAILURE_NONE && point) {
        y.kind = VERTEX_LIGHT;
        y.connectible = true;
        y.delta_event = false;
        *point = y;
    }
    return failure;
}

enum failure connect_camera(const struct subpaths *paths, const struct vertex *y,
                            struct connection *out)
{
    const struct vertex *z = &paths->camera[0];
    struct edge e;
    struct bsdf_value f;
    double pdf, cos_axis;
    if (!edge_between(&y->hit.at, &z->hit.at, &e))
        return FAILURE_ZERO;
    struct vec3 seen = vec3_neg(e.w);
    out->pixel = camera_project(&paths->scene->camera, &z->hit.at, seen, &pdf, &cos_axis);
    if (out->pixel < 0 || !vertex_scatter(y, e.w, TRANSPORT_IMPORTANCE, &f))
        return FAILURE_ZERO;
    /* C_{s,1} [Veach97 Eq. 10.8]: W_e cos / p(lens point) equals the density of the
     * direction, since both are normalised over the film. */
    double cos_y = cos_geometric(y, e.w);
    double q = pdf * cos_y * e.inverse_square;
    out->value = rgb_scale(rgb_mul(y->throughput, f.f), y->adjoint * q);
    out->weight = mis_weight(mis_side(y, q, f.pdf_rev), 0.0);
    return unobstructed(paths, y, z, out->value);
}

enum failure connect_surfaces(const struct subpaths *paths, const struct vertex *y,
                              const struct vertex *z, struct connection *out)
{
    struct edge e;
    struct bsdf_value fy, fz;
    if (!edge_between(&y->hit.at, &z->hit.at, &e) ||
        !vertex_scatter(y, e.w, TRANSPORT_IMPORTANCE, &fy) ||
        !vertex_scatter(z, vec3_neg(e.w), TRANSPORT_RADIANCE, &fz))
        return FAILURE_ZERO;
    double conv_y = cos_geometric(y, e.w) * e.inverse_square;
    double conv_z = cos_geometric(z, e.w) * e.inverse_square;
    /* C_{s,t} = alpha_s f G f alpha_t [Veach97 Eq. 10.8]; y->adjoint turns its cosine at
     * y into that of the adjoint BSDF [Veach97 Eq. 5.19]. */
    struct rgb f = rgb_mul(rgb_mul(y->throughput, fy.f), rgb_mul(z->throughput, fz.f));
    out->value = rgb_scale(f, y->adjoint * conv_y * cos_shading(z, e.w));
    out->pixel = paths->pixel;
    out->weight = mis_weight(mis_side(y, fz.pdf * conv_y, fy.pdf_rev),
                             mis_side(z, fy.pdf * conv_z, fz.pdf_rev));
    return unobstructed(paths, y, z, out->value);
}
