/* Multiplexed paths [Hachisuka14]: one length, one technique, one splat. */

#include "path/connect.h"
#include "path/estimate.h"

static bool usable(const struct needs *needs, int length, int t)
{
    if (t == length + 1)
        return needs->light_hits;
    if (t == 1) /* (1,1): light seen directly is left to (0,2) */
        return length > 1 && needs->camera_connections;
    return needs->light_connections;
}

void techniques_init(struct techniques *techniques, const struct needs *needs, int length)
{
    assert(length >= 1 && length <= DIMS_MAX_DEPTH);
    *techniques = (struct techniques){.length = length};
    for (int t = 1; t <= length + 1; t++)
        if (usable(needs, length, t))
            techniques->t[techniques->count++] = (uint8_t)t;
}

/* The technique's t; no number is drawn where there is one technique only. */
static int pick(const struct techniques *techniques, struct ustream *connect)
{
    if (techniques->count == 1)
        return techniques->t[0];
    /* Uniform over the techniques [Hachisuka14, section 4]. */
    double u = *ustream_take(connect, DIMS_TECHNIQUE, 1);
    return techniques->t[(int)(u * techniques->count)];
}

/* Grows sub-paths of exactly t camera and s light vertices that can be connected, camera
 * first; stops at the first failure [Zeng19, Alg. 2]. */
static enum failure grow(struct subpaths *paths, const struct numbers *numbers, int s,
                         int t)
{
    walk_camera(paths, numbers->camera, t, s == 0 ? HIT_LIGHT : HIT_CONNECTIBLE);
    if (paths->camera_count < t)
        return paths->filtered_out ? FAILURE_ZERO : FAILURE_CAMERA_PATH;
    if (s < 2)
        return FAILURE_NONE;
    walk_light(paths, numbers->light, s, HIT_CONNECTIBLE);
    if (paths->light_count < s)
        return paths->filtered_out ? FAILURE_ZERO : FAILURE_LIGHT_PATH;
    return FAILURE_NONE;
}

/* Connects the sub-paths. For s = 1 the light point is sampled with the numbers that
 * begin a light sub-path, so that the point stays the same when the technique changes. */
static inline enum failure join(struct subpaths *paths, const struct numbers *numbers,
                                int s, int t, struct connection *out,
                                struct vertex *point)
{
    const struct vertex *z = &paths->camera[t - 1];
    if (s == 0)
        return connect_hit(paths, z, t - 1, MIS_BIDIRECTIONAL, out);
    if (s == 1) {
        double u[3];
        dims_light(numbers->light, DIMS_LIGHT_PICK, paths->many_lights, u);
        return connect_light(paths, u, z, MIS_BIDIRECTIONAL, out, point);
    }
    if (t == 1)
        return connect_camera(paths, &paths->light[s - 1], out);
    return connect_surfaces(paths, &paths->light[s - 1], z, out);
}

enum failure estimate_technique(struct subpaths *paths, const struct numbers *numbers,
                                int s, int t, struct connection *out,
                                struct vertex *point)
{
    enum failure failure = grow(paths, numbers, s, t);
    return failure == FAILURE_NONE ? join(paths, numbers, s, t, out, point) : failure;
}

/* point: NULL, or receives the light point of s = 1. */
static inline __attribute__((always_inline)) int
estimate(struct subpaths *paths, const struct techniques *techniques,
         const struct numbers *numbers, struct vertex *point, struct contrib *out)
{
    int t = pick(techniques, numbers->connect), s = techniques->length + 1 - t;
    struct connection x;
    contrib_clear(out);
    out->failure = estimate_technique(paths, numbers, s, t, &x, point);
    out->connections = s > 1;
    if (out->failure == FAILURE_NONE) {
        out->failure = FAILURE_ZERO; /* contrib_add clears it if the splat is not black */
        /* w C / p(technique), p = 1 / count [Hachisuka14, section 4]. */
        contrib_add(out, x.pixel, rgb_scale(x.value, x.weight * techniques->count), s, t);
    }
    out->nonfinite += paths->nonfinite;
    paths->nonfinite = 0;
    return t;
}

void estimate_mmlt(struct subpaths *paths, const struct techniques *techniques,
                   const struct numbers *numbers, struct contrib *out)
{
    estimate(paths, techniques, numbers, NULL, out);
}

int estimate_mmlt_again(struct subpaths *paths, const struct techniques *techniques,
                        const struct numbers *numbers, struct contrib *out)
{
    return estimate(paths, techniques, numbers, paths->light, out);
}
