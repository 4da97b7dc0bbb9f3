#include "path/features.h"

#include "base/mem.h"
#include "base/par.h"
#include "math/rng.h"
#include "path/walk.h"

#define PATHS (FEATURES_SIDE * FEATURES_SIDE)

static const char *const names[FEATURES_CHANNELS] = {
    "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z"};

/* Numbers of a camera path whose film position lies in a cell of a pixel. */
struct cell_stream {
    struct ustream stream; /* must be first */
    struct ustream_random inner;
    double x, y, width, height; /* of the film, in cells */
    double film[2];
};

struct features {
    const struct scene *scene;
    uint64_t seed;
    struct subpaths *paths; /* [threads] */
    float *channels[FEATURES_CHANNELS];
};

static const double *take(struct ustream *stream, int place, int count)
{
    struct cell_stream *s = (struct cell_stream *)stream;
    const double *u = ustream_take(&s->inner.stream, place, count);
    if (place != DIMS_FILM)
        return u;
    s->film[0] = (s->x + u[0]) / s->width;
    s->film[1] = (s->y + u[1]) / s->height;
    return s->film;
}

/* (eta_i/eta_o)^2 of a delta event, 1 of a reflection, by the densities of struct
 * bsdf_sample. */
static double eta2_of(const struct vertex *v, const struct vertex *next)
{
    double cos_o = (double)v->wo_local.z;
    double cos_i = (double)frame_to_local(&v->hit.shading, vec3_neg(next->wo)).z;
    return cos_o * cos_i < 0.0 ? fabs(cos_o / cos_i) * v->event_pdf / v->event_pdf_rev
                               : 1.0;
}

/* The first surface that the path does not leave by a delta lobe; NULL if there is none.
 * *eta2: by what refractions on the way there have divided the path's throughput, as it
 * is of radiance. */
static const struct vertex *find_surface(const struct subpaths *paths, double *eta2)
{
    *eta2 = 1.0;
    for (int i = 1; i < paths->camera_count; i++) {
        const struct vertex *v = &paths->camera[i];
        if (v->kind == VERTEX_SURFACE && !v->delta_event)
            return v;
        if (v->kind == VERTEX_SURFACE && i + 1 < paths->camera_count)
            *eta2 *= eta2_of(v, v + 1);
    }
    return NULL;
}

/* Power is what a surface reflects or transmits; radiance changes by refraction, too. */
static struct rgb albedo_at(const struct vertex *v, struct rng *rng)
{
    struct bsdf_sample sample;
    double u[3];
    if (v->light && v->hit.bsdf->flags & BSDF_BLACK)
        return rgb_grey(1.0);
    for (int i = 0; i < 3; i++)
        u[i] = rng_double(rng);
    if (!bsdf_sample(v->hit.bsdf, v->wo_local, u, TRANSPORT_IMPORTANCE, &sample))
        return rgb_grey(0.0);
    return rgb_mul(v->throughput, sample.weight);
}

/* Adds what one camera path finds; returns whether it meets a surface. */
static bool add_path(const struct subpaths *paths, struct rng *rng,
                     double sums[FEATURES_CHANNELS])
{
    double eta2;
    const struct vertex *first = &paths->camera[1], *v = find_surface(paths, &eta2);
    if (paths->camera_count < 2 || first->kind != VERTEX_SURFACE)
        return false;
    struct vec3 way = vec3_sub(first->hit.at.p, paths->camera[0].hit.at.p);
    sums[6] += (double)vec3_length(way);
    if (!v)
        return true;
    struct rgb albedo = rgb_scale(albedo_at(v, rng), eta2);
    float side = vec3_dot(v->hit.shading.n, v->wo) < 0.0f ? -1.0f : 1.0f;
    sums[0] += albedo.r;
    sums[1] += albedo.g;
    sums[2] += albedo.b;
    sums[3] += (double)(side * v->hit.shading.n.x);
    sums[4] += (double)(side * v->hit.shading.n.y);
    sums[5] += (double)(side * v->hit.shading.n.z);
    return true;
}

static void trace_pixel(const struct features *f, struct subpaths *paths, int x, int y)
{
    const struct camera *camera = &f->scene->camera;
    long pixel = (long)y * camera->width + x;
    double sums[FEATURES_CHANNELS] = {0.0}, met = 0.0;
    struct rng rng;
    struct cell_stream s = {.stream = {take},
                            .width = (double)camera->width * FEATURES_SIDE,
                            .height = (double)camera->height * FEATURES_SIDE};
    rng_init(&rng, f->seed, RNG_FEATURES, (uint64_t)pixel);
    ustream_random_init(&s.inner, &rng);
    for (int i = 0; i < PATHS; i++) {
        int row = i / FEATURES_SIDE;
        s.x = x * FEATURES_SIDE + i % FEATURES_SIDE;
        s.y = y * FEATURES_SIDE + row;
        walk_camera(paths, &s.stream, FEATURES_EDGES + 1, HIT_ANY);
        met += add_path(paths, &rng, sums);
    }
    for (int c = 0; c < 3; c++)
        f->channels[c][pixel] = (float)fmin(sums[c] / PATHS, 1.0);
    for (int c = 3; c < 6; c++)
        f->channels[c][pixel] = (float)(sums[c] / PATHS);
    f->channels[6][pixel] = met > 0.0 ? (float)(sums[6] / met) : 0.0f;
}

static void trace_row(void *ctx, long y, int thread)
{
    const struct features *f = ctx;
    for (int x = 0; x < f->scene->camera.width; x++)
        trace_pixel(f, &f->paths[thread], x, (int)y);
}

void features_add(const struct scene *scene, uint64_t seed, int threads,
                  struct layers *layers)
{
    size_t pixels = (size_t)scene->camera.width * (size_t)scene->camera.height;
    struct features f = {scene, seed, NULL, {NULL}};
    long cut = *scene->edges_cut;
    f.paths = mem_alloc((size_t)threads, sizeof *f.paths);
    for (int c = 0; c < FEATURES_CHANNELS; c++)
        f.channels[c] = layers_add(layers, names[c], pixels);
    for (int i = 0; i < threads; i++)
        subpaths_init(&f.paths[i], scene, FEATURES_EDGES);
    par_for(scene->camera.height, threads, trace_row, &f);
    for (int i = 0; i < threads; i++)
        subpaths_deinit(&f.paths[i]);
    mem_free(f.paths);
    *scene->edges_cut = cut; /* the picture has none of these paths */
}
