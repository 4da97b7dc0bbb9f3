#ifndef ETALON_PATH_VERTEX_H
#define ETALON_PATH_VERTEX_H

/* Vertices of sub-paths. A sub-path v_0 .. v_n grows from its end (lens or light); all
 * densities are per area, so that those of different techniques can be compared.
 *
 * MIS by ratios. With p(v) the density of v from its own side, q(v) from the other side,
 * and r(v) = q(v)/p(v), the balance heuristic [Veach97 Eq. 9.8] over the techniques of a
 * path wants, by the ratios of their densities [Veach97 Eq. 10.9],
 *     S_e = r_e (d_e + r_{e-1} (d_{e-1} + r_{e-2} (...)))
 * on each side of a connection at v_e, d_i = 1 if the technique that connects v_{i-1} to
 * v_i exists (path/passage.h: less where walks may pass one of them). Only r_e and
 * q(v_{e-1}) depend on the connection, so a vertex carries mis_tail_e = T_{e-1} conv_e /
 * p(v_{e-1}),  T_e = d_e + q_dir(v_e) mis_tail_e, where conv_e = |cos at v_{e-1}| /
 * distance^2 turns a density per solid angle at v_e into one per area at v_{e-1}. Then
 * S_e = r_e (d_e + q_dir mis_tail_e): constant work a connection, ratios only, whatever
 * the length of the path.
 *
 * A light at infinity is a vertex whose place is a direction: p and q of it are per solid
 * angle, those of its neighbour come from where the path enters, per area across the
 * direction (scene/light.h). So it is with the lens point of an orthographic camera,
 * whose rays' direction is its wo (scene/camera.h). Nothing above changes but conv, which
 * has no 1/distance^2 on such an edge and no cosine at its far end: the camera's density
 * of the direction at the neighbour is q(v_0) itself, and conv_1 = 1; q of the neighbour
 * is |cos| / (pi R^2). */

#include "scene/scene.h"

enum vertex_kind { VERTEX_CAMERA, VERTEX_LIGHT, VERTEX_SURFACE };

struct vertex {
    enum vertex_kind kind;
    bool connectible;          /* can be the end of a connection */
    bool delta_event;          /* the walk left by a delta lobe */
    bool has_shading_normal;   /* it may differ from the geometric one */
    struct hit hit;            /* where; lens and lights have hit.at only */
    const struct light *light; /* the light it is on, or NULL */
    struct vec3 wo;            /* to the previous vertex; and in the shading frame: */
    struct vec3 wo_local;
    float cos_wo;          /* ng . wo */
    double adjoint;        /* |ns.wo| / |ng.wo| [Veach97 Eq. 5.19], 1 if flat */
    struct rgb throughput; /* arriving here: product of f cos / pdf so far */
    /* d_e of the text above, without this vertex's chance of ending a walk from the other
     * side: for a connection that ends here. */
    double prev_connects;
    double end_chance; /* of ending here rather than passing: 1 but of path/passage.h */
    double pdf_fwd;    /* p(v), 1/m^2 */
    double mis_tail;
    double event_pdf, event_pdf_rev; /* of the direction the walk left in, 1/sr */
    struct rgb event_weight;         /* of a delta event: bsdf_sample's weight */
};

/* Whether the place of an end of a path is a direction: rays from it are parallel. */
static inline bool vertex_is_direction(const struct vertex *v,
                                       const struct camera *camera)
{
    if (v->kind == VERTEX_LIGHT)
        return v->light->infinite;
    return v->kind == VERTEX_CAMERA && camera->orthographic;
}

/* Whether shading and geometric normal agree that wo -> w reflects or transmits. */
static inline bool vertex_sides_agree(const struct vertex *v, struct vec3 w,
                                      float w_local_z)
{
    if (!v->has_shading_normal)
        return true;
    return (v->cos_wo * vec3_dot(v->hit.at.ng, w) > 0.0f) ==
           (v->wo_local.z * w_local_z > 0.0f);
}

/* The BSDF at a surface vertex between wo and w; false if zero, also where shading and
 * geometric normal disagree about the side. */
static inline bool vertex_scatter(const struct vertex *v, struct vec3 w,
                                  enum transport mode, struct bsdf_value *out)
{
    struct vec3 wi = frame_to_local(&v->hit.shading, w);
    return vertex_sides_agree(v, w, wi.z) &&
           bsdf_eval(v->hit.bsdf, v->wo_local, wi, mode, out);
}

/* Both sub-paths of one sample and what they need: scratch of one thread. */
struct subpaths {
    const struct scene *scene;
    int max_depth;    /* edges of the whole path */
    bool many_lights; /* the pick is drawn */
    /* Textures, lights at infinity or an orthographic camera: path/walk_step.h. */
    bool special;
    unsigned keep; /* numbers drawn though a BSDF does not read them */
    int32_t pixel; /* of the camera sub-path */
    int camera_count, light_count;
    bool filtered_out; /* the last walk hit a surface that its hit filter refused */
    double lobe;       /* the lobe's number at the next vertex, or -1: path/passage.h */
    /* sub-paths ended at a number that was not finite; the estimator adds them to its
     * contribution and clears the count. */
    long nonfinite;
    /* Russian roulette of bdpt's connections, or NULL: path/estimate_roulette.h. */
    struct roulette *roulette;
    bool blind; /* connections are not tested for visibility: path/connect.h */
    struct vertex *camera, *light; /* [max_depth + 1] each, one after the other */
    struct bsdf_nodes *nodes;      /* one a vertex, if a material is textured */
    /* Of the surface that a connection passes; NULL if there are no such surfaces. */
    struct bsdf_nodes *passed;
};

/* One scattering event of a walk: the sampled direction, its density, and the part of the
 * MIS recurrence that is known before the next vertex is found. */
struct scatter_step {
    struct vec3 w;
    double pdf;            /* 1/sr; then of the whole edge: path/passage.h */
    struct rgb throughput; /* with this step's weight */
    double tail_over_pdf;  /* T_e / p(v_e) of the vertex left */
    double cos;            /* |ng . w| there (1 without a surface) */
    double connects;       /* 0 if the event was a delta, else the vertex's end_chance */
};

#endif
