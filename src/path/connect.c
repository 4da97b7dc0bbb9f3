#include "path/connect.h"

/* The edge from y to *film, where the one ray of an orthographic camera to y starts. */
static bool edge_to_film(const struct camera *camera, const struct vertex *y,
                         struct vertex *film, struct edge *e)
{
    *e = (struct edge){vec3_neg(film->wo), 1.0};
    return camera_meet(camera, film->wo, y->hit.at.p, &film->hit.at);
}

enum failure connect_camera(const struct subpaths *paths, const struct vertex *y,
                            struct connection *out)
{
    const struct camera *camera = &paths->scene->camera;
    const struct vertex *z = &paths->camera[0];
    struct vertex film;
    struct edge e;
    struct bsdf_value f;
    double pdf, cos_axis;
    if (camera->orthographic) {
        film = *z;
        z = &film;
        if (!edge_to_film(camera, y, &film, &e))
            return FAILURE_ZERO;
    } else if (!edge_between(&y->hit.at, &z->hit.at, &e)) {
        return FAILURE_ZERO;
    }
    struct vec3 seen = vec3_neg(e.w);
    out->pixel = camera_project(camera, &z->hit.at, seen, &pdf, &cos_axis);
    if (out->pixel < 0 || !vertex_scatter(y, e.w, TRANSPORT_IMPORTANCE, &f))
        return FAILURE_ZERO;
    /* C_{s,1} [Veach97 Eq. 10.8]: W_e cos / p(lens point) equals the density of the
     * direction, as both are normalised over the film. */
    double cos_y = edge_cos_geometric(y, e.w);
    double q = pdf * cos_y * e.inverse_square;
    out->value = rgb_scale(rgb_mul(y->throughput, f.f), y->adjoint * q);
    out->untested = paths->blind && !camera->orthographic;
    struct passage passage;
    enum failure failure = edge_unobstructed(paths, y, z, e.w, out->untested, &out->value,
                                             &passage);
    if (failure != FAILURE_NONE)
        return failure;
    /* [Veach97 Eqs. 9.8 and 10.9] */
    out->weight = mis_weight(mis_side(y, q * passage.density, f.pdf_rev, passage.end_y),
                             0.0);
    return FAILURE_NONE;
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
    double conv_y = edge_cos_geometric(y, e.w) * e.inverse_square;
    double conv_z = edge_cos_geometric(z, e.w) * e.inverse_square;
    /* C_{s,t} = alpha_s f G f alpha_t [Veach97 Eq. 10.8]; y->adjoint turns its cosine at
     * y into that of the adjoint BSDF [Veach97 Eq. 5.19]. */
    struct rgb f = rgb_mul(rgb_mul(y->throughput, fy.f), rgb_mul(z->throughput, fz.f));
    out->value = rgb_scale(f, y->adjoint * conv_y * edge_cos_shading(z, e.w));
    out->pixel = paths->pixel;
    out->untested = paths->blind;
    struct passage passage;
    enum failure failure = edge_unobstructed(paths, y, z, e.w, out->untested, &out->value,
                                             &passage);
    if (failure != FAILURE_NONE)
        return failure;
    conv_y *= passage.density;
    conv_z *= passage.density;
    /* [Veach97 Eqs. 9.8 and 10.9] */
    out->weight = mis_weight(mis_side(y, fz.pdf * conv_y, fy.pdf_rev, passage.end_y),
                             mis_side(z, fy.pdf * conv_z, fz.pdf_rev, passage.end_z));
    return FAILURE_NONE;
}
