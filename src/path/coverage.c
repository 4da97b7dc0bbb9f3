#include "path/coverage.h"

#include "base/par.h"
#include "math/rng.h"
#include "path/passage.h"

struct coverage {
    const struct scene *scene;
    uint64_t seed;
    float *alpha;
};

/* 1 - T of the ray through the film position. */
static double ray_coverage(const struct scene *scene, const double film[2],
                           const double lens[2])
{
    struct ray_endpoint from = camera_sample_lens(&scene->camera, lens);
    struct vec3 w;
    double pdf;
    camera_sample_direction(&scene->camera, &from, film, &w, &pdf);
    return 1.0 - rgb_luminance(passage_escape(scene, &from, w));
}

static double pixel_coverage(const struct coverage *c, int x, int y)
{
    const struct camera *camera = &c->scene->camera;
    struct rng rng;
    double sum = 0.0;
    rng_init(&rng, c->seed, RNG_COVERAGE,
             (uint64_t)y * (uint64_t)camera->width + (uint64_t)x);
    for (int i = 0; i < COVERAGE_SIDE * COVERAGE_SIDE; i++) {
        int line = i / COVERAGE_SIDE;
        double u[4];
        for (int j = 0; j < 4; j++)
            u[j] = rng_double(&rng);
        double column = (i % COVERAGE_SIDE + u[0]) / COVERAGE_SIDE;
        double row = (line + u[1]) / COVERAGE_SIDE;
        double film[2] = {(x + column) / camera->width, (y + row) / camera->height};
        sum += ray_coverage(c->scene, film, u + 2);
    }
    return fmax(sum / (COVERAGE_SIDE * COVERAGE_SIDE), 0.0);
}

static void cover_row(void *ctx, long y, int thread)
{
    const struct coverage *c = ctx;
    int width = c->scene->camera.width;
    (void)thread;
    for (int x = 0; x < width; x++)
        c->alpha[y * width + x] = (float)pixel_coverage(c, x, (int)y);
}

void coverage_picture(const struct scene *scene, uint64_t seed, int threads, float *alpha)
{
    par_for(scene->camera.height, threads, cover_row,
            &(struct coverage){scene, seed, alpha});
}
