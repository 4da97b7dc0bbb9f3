#include "path/mis_ref.h"

#include <assert.h>
#include <math.h>

#define MIS_REF_MAX 130

/* The joined path from the light x[0] to the lens x[edges]. */
struct joined {
    const struct scene *scene;
    const struct vertex *x[MIS_REF_MAX];
    bool from_camera[MIS_REF_MAX]; /* grown by the camera walk */
    int edges;
    int s;
    long double pass[MIS_REF_MAX];         /* Q of the edge x[i] to x[i+1] */
    struct rgb transmittance[MIS_REF_MAX]; /* T of it: path/passage.h */
};

/* An end of a path that is a direction, and that, from it into the scene. */
static bool at_infinity(const struct joined *p, const struct vertex *v)
{
    return vertex_is_direction(v, &p->scene->camera);
}

static struct vec3 outwards(const struct vertex *v)
{
    return v->kind == VERTEX_CAMERA ? v->wo : v->hit.at.ng;
}

static struct vec3 direction(const struct joined *p, const struct vertex *a,
                             const struct vertex *b)
{
    if (at_infinity(p, a))
        return outwards(a);
    if (at_infinity(p, b))
        return vec3_neg(outwards(b));
    return vec3_normalize(vec3_sub(b->hit.at.p, a->hit.at.p));
}

/* Straight lobe of what was hit, along w. */
static bool straight_at(const struct hit *hit, struct vec3 w, struct bsdf_straight *out)
{
    struct bsdf_nodes nodes;
    const struct bsdf *bsdf = hit->bsdf;
    if (bsdf->flags & BSDF_TEXTURED)
        bsdf = hit_bsdf(hit, &nodes);
    return hit->light < 0 && bsdf_straight(bsdf, frame_to_local(&hit->shading, w), out);
}

/* Where the edge from a surface ends: at an orthographic camera, on its film. */
static struct ray_endpoint end_of(const struct joined *p, const struct vertex *from,
                                  const struct vertex *to)
{
    struct ray_endpoint end = to->hit.at;
    if (to->kind == VERTEX_CAMERA && at_infinity(p, to))
        camera_meet(&p->scene->camera, to->wo, from->hit.at.p, &end);
    return end;
}

/* Whether what was hit is the flat surface on which v lies, to within the rounding of the
 * places. An edge that ends at v does not cross it, but a ray that grazes it may meet it
 * far from v: the rounding over the cosine. */
static bool is_plane_of(const struct vertex *v, const struct hit *hit)
{
    if (v->kind != VERTEX_SURFACE || v->hit.shape != hit->shape)
        return false;
    struct vec3 n = v->hit.at.ng, apart = vec3_sub(hit->at.p, v->hit.at.p);
    return fabs((double)vec3_dot(n, hit->at.ng)) > 1.0 - 1e-6 &&
           fabs((double)vec3_dot(n, apart)) <= 4.0 * (double)v->hit.at.offset;
}

/* What lies between the ends of the edge i: Q and T. The edge is turned by `turn` about
 * its start, so that what rounding decides can be told. */
static void pass_edge(const struct joined *p, int i, struct vec3 turn, long double *pass,
                      struct rgb *transmittance)
{
    bool backwards = at_infinity(p, p->x[i]);
    const struct vertex *from = p->x[backwards ? i + 1 : i],
                        *to = p->x[backwards ? i : i + 1];
    bool endless = to->kind == VERTEX_LIGHT && at_infinity(p, to);
    struct ray_endpoint end = end_of(p, from, to);
    struct vec3 w = direction(p, from, to), all = vec3_sub(end.p, from->hit.at.p);
    double length = endless ? (double)INFINITY : sqrt((double)vec3_dot(all, all));
    /* A curved end may be met some way before its place. */
    double cos = fabs((double)vec3_dot(to->hit.at.ng, w));
    double slack = (endless ? 0.0 : 1e-5 * length) +
                   4.0 * (double)to->hit.at.offset / fmax(cos, 1e-3);
    struct ray_endpoint at = from->hit.at;
    struct hit hit;
    struct bsdf_straight s;
    *pass = 1.0L;
    *transmittance = rgb_grey(1.0);
    w = vec3_normalize(vec3_add(w, turn));
    while (accel_intersect(p->scene, &at, w, &hit)) {
        at = hit.at;
        if (is_plane_of(from, &hit) || is_plane_of(to, &hit))
            continue;
        double so_far = (double)vec3_dot(vec3_sub(hit.at.p, from->hit.at.p), w);
        if (so_far > length - slack || !straight_at(&hit, w, &s))
            break;
        *pass *= (long double)s.chance;
        *transmittance = rgb_mul(*transmittance, s.transmittance);
    }
}

/* Chance that a walk which comes to x[i] from x[previous] ends there. */
static long double ends_at(const struct joined *p, int i, int previous)
{
    const struct vertex *v = p->x[i];
    struct bsdf_straight s;
    if (i == 0 || i == p->edges ||
        !straight_at(&v->hit, direction(p, v, p->x[previous]), &s))
        return 1.0L;
    return 1.0L - (long double)s.chance;
}

/* |cos at `to`| / distance^2: density per solid angle at `from` to density per area at
 * `to` [Veach97, section 8.2.2]. */
static long double to_area(const struct joined *p, const struct vertex *from,
                           const struct vertex *to)
{
    if (at_infinity(p, to))
        return 1.0L;
    if (at_infinity(p, from))
        return fabsl((long double)vec3_dot(to->hit.at.ng, outwards(from)));
    struct vec3 d = vec3_sub(to->hit.at.p, from->hit.at.p);
    long double x = (long double)d.x, y = (long double)d.y, z = (long double)d.z;
    long double square = x * x + y * y + z * z;
    bool has_normal = vec3_dot(to->hit.at.ng, to->hit.at.ng) > 0.0f;
    long double cos = has_normal
                          ? fabsl((long double)vec3_dot(to->hit.at.ng, d)) / sqrtl(square)
                          : 1.0L;
    return cos / square;
}

/* Density per solid angle of x[next] seen from x[i] when coming from x[previous]. A delta
 * event was kept by the walk that made it: its own direction or the other one. */
static double scatter_pdf(const struct joined *p, int previous, int i, int next)
{
    const struct vertex *v = p->x[i];
    bool to_lens = next > i;
    if (v->delta_event)
        return to_lens != p->from_camera[i] ? v->event_pdf : v->event_pdf_rev;
    struct vec3 wo = frame_to_local(&v->hit.shading, direction(p, v, p->x[previous]));
    struct vec3 wi = frame_to_local(&v->hit.shading, direction(p, v, p->x[next]));
    struct bsdf_value f;
    return bsdf_eval(v->hit.bsdf, wo, wi, TRANSPORT_RADIANCE, &f) ? f.pdf : 0.0;
}

/* Density per area of x[i] when the path grows from the light. */
static long double pdf_from_light(const struct joined *p, int i)
{
    const struct light *light = p->x[0]->light;
    if (i == 0)
        return (long double)light_pdf_point(light, &p->x[0]->hit.at);
    const struct vertex *from = p->x[i - 1];
    struct vec3 w = direction(p, from, p->x[i]);
    double pdf = i == 1 ? light->type->pdf_direction(light, &from->hit.at, w)
                        : scatter_pdf(p, i - 2, i - 1, i);
    return (long double)pdf * to_area(p, from, p->x[i]);
}

static long double pdf_from_camera(const struct joined *p, int i)
{
    if (i == p->edges)
        return 1.0L;
    const struct vertex *from = p->x[i + 1];
    double pdf_lens = 0.0, cos;
    if (i + 1 == p->edges) {
        struct vec3 w = direction(p, from, p->x[i]);
        struct ray_endpoint start = from->hit.at;
        if (at_infinity(p, from) && !at_infinity(p, p->x[i]))
            camera_meet(&p->scene->camera, w, p->x[i]->hit.at.p, &start);
        camera_project(&p->scene->camera, &start, w, &pdf_lens, &cos);
        return (long double)pdf_lens * to_area(p, from, p->x[i]);
    }
    return (long double)scatter_pdf(p, i + 2, i + 1, i) * to_area(p, from, p->x[i]);
}

/* Whether the technique that makes s vertices from the light can make this path. */
static bool exists(const struct joined *p, int s)
{
    if (s == 0)
        return !p->x[0]->light->delta_position;
    if (p->edges == 1)
        return false; /* (1,1) is not used */
    bool light_end = s == 1 || !p->x[s - 1]->delta_event;
    bool camera_end = s == p->edges || !p->x[s]->delta_event;
    return light_end && camera_end;
}

/* log of the path's density under the technique with s vertices from the light. */
static long double log_density(const struct joined *p, int s)
{
    long double sum = 0.0L;
    for (int i = 0; i <= p->edges; i++)
        sum += logl(i < s ? pdf_from_light(p, i) : pdf_from_camera(p, i));
    /* Walks pass what lies on their edges; both end where they are connected. */
    for (int i = 0; i < p->edges; i++)
        sum += i + 1 == s ? 0.0L : logl(p->pass[i]);
    if (s > 0)
        sum += logl(ends_at(p, s - 1, s - 2)) + logl(ends_at(p, s, s + 1));
    return sum;
}

static struct joined join(const struct scene *scene, const struct vertex *light, int s,
                          const struct vertex *camera, int t)
{
    assert(s >= 0 && t >= 1 && s + t >= 2 && s + t <= MIS_REF_MAX);
    struct joined p = {.scene = scene, .edges = s + t - 1, .s = s};
    for (int i = 0; i < s; i++)
        p.x[i] = &light[i];
    for (int i = 0; i < t; i++) {
        p.x[s + i] = &camera[t - 1 - i];
        p.from_camera[s + i] = true;
    }
    for (int i = 0; i < p.edges; i++)
        pass_edge(&p, i, vec3(0, 0, 0), &p.pass[i], &p.transmittance[i]);
    return p;
}

/* Whether the edge i leaves or meets a surface so edge-on that the rounding of places
 * changes its cosine there: it does by offset / (cos * length). */
static bool grazes(const struct joined *p, int i)
{
    const struct vertex *ends[2] = {p->x[i], p->x[i + 1]};
    if (at_infinity(p, ends[0]) || at_infinity(p, ends[1]))
        return false;
    struct vec3 d = vec3_sub(ends[1]->hit.at.p, ends[0]->hit.at.p);
    double length = sqrt((double)vec3_dot(d, d));
    double rounding = (double)ends[0]->hit.at.offset + (double)ends[1]->hit.at.offset;
    for (int j = 0; j < 2; j++) {
        double apart = fabs((double)vec3_dot(ends[j]->hit.at.ng, d));
        if (ends[j]->kind == VERTEX_SURFACE &&
            (apart <= 200.0 * rounding || apart <= 2e-3 * length))
            return true;
    }
    return false;
}

bool mis_ref_sure(const struct scene *scene, const struct vertex *light, int s,
                  const struct vertex *camera, int t)
{
    struct joined p = join(scene, light, s, camera, t);
    for (int i = 0; i < p.edges; i++) {
        if (grazes(&p, i))
            return false;
        for (int turn = 0; turn < 6; turn++) {
            float by[3] = {0.0f, 0.0f, 0.0f};
            long double pass;
            struct rgb transmittance;
            by[turn / 2] = turn % 2 ? 4e-6f : -4e-6f;
            pass_edge(&p, i, vec3(by[0], by[1], by[2]), &pass, &transmittance);
            if (!(fabsl(pass - p.pass[i]) <= 1e-3L * p.pass[i]))
                return false;
        }
    }
    return true;
}

double mis_ref_weight(const struct scene *scene, const struct vertex *light, int s,
                      const struct vertex *camera, int t)
{
    struct joined p = join(scene, light, s, camera, t);
    /* The ends of the connection scatter without a delta, whatever their walk did next.
     */
    struct vertex ends[2];
    int at[2] = {s - 1, s};
    for (int i = 0; i < 2; i++)
        if (at[i] >= 0 && at[i] <= p.edges && s > 0) {
            ends[i] = *p.x[at[i]];
            ends[i].delta_event = false;
            p.x[at[i]] = &ends[i];
        }
    /* 1 / sum of p_i / p_s [Veach97 Eqs. 9.8 and 10.9]. */
    long double own = log_density(&p, s), sum = 0.0L;
    for (int i = 0; i <= p.edges; i++)
        if (exists(&p, i))
            sum += expl(log_density(&p, i) - own);
    return (double)(1.0L / sum);
}

/* Factor of the inner vertex x[i], light arriving from x[i-1]: BSDF, cosine, and the step
 * from solid angle to area at x[i-1]. */
static struct rgb scatter_factor(const struct joined *p, int i)
{
    const struct vertex *v = p->x[i];
    struct vec3 to_lens = direction(p, v, p->x[i + 1]),
                to_light = direction(p, v, p->x[i - 1]);
    struct vec3 wo = frame_to_local(&v->hit.shading, to_lens);
    struct vec3 wi = frame_to_local(&v->hit.shading, to_light);
    struct bsdf_value f;
    double geometric = (double)vec3_dot(v->hit.at.ng, to_lens) *
                       (double)vec3_dot(v->hit.at.ng, to_light);
    if ((geometric > 0.0) != ((double)wo.z * (double)wi.z > 0.0) ||
        !bsdf_eval(v->hit.bsdf, wo, wi, TRANSPORT_RADIANCE, &f))
        return rgb_grey(0.0);
    return rgb_scale(f.f, fabs((double)wi.z) * (double)to_area(p, v, p->x[i - 1]));
}

struct rgb mis_ref_value(const struct scene *scene, const struct vertex *light, int s,
                         const struct vertex *camera, int t)
{
    struct joined p = join(scene, light, s, camera, t);
    const struct vertex *first = p.x[0];
    struct rgb value = light_emission(first->light, &first->hit.at,
                                      direction(&p, first, p.x[1]));
    for (int i = 1; i < p.edges; i++)
        value = rgb_mul(value, scatter_factor(&p, i));
    for (int i = 0; i < p.edges; i++)
        value = rgb_mul(value, p.transmittance[i]);
    /* f_j(x) / p_s(x) [Veach97 Eqs. 8.7 and 8.9]. */
    double log_lens = (double)logl(pdf_from_camera(&p, p.edges - 1));
    return rgb_scale(value, exp(log_lens - (double)log_density(&p, s)));
}
