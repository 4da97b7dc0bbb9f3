/* Speed of the renderer on a scene, and the share of it that bare Embree would take on
 * the very same rays. Linked with --wrap=rtcIntersect1 --wrap=rtcOccluded1.
 *
 *   speed SCENE SECONDS key=value ...
 *
 * Prints mutations (samples) per CPU second of a run with all settings given, rays of
 * each kind per mutation, and how fast bare Embree replays the rays of a short recorded
 * run. */

#include "program.h"

#include "base/clock.h"
#include "base/libraries.h"
#include "base/mem.h"
#include "base/par.h"
#include "math/order.h"

#include <embree3/rtcore.h>

#define RECORD_MOST 4000000
#define TURNS       5

struct recording {
    struct RTCRayHit *intersect; /* as asked */
    struct RTCRay *occluded;
    long intersect_count, occluded_count; /* asked for, stored up to RECORD_MOST */
    RTCScene scene;
    bool on;
};

static struct recording recording;

void __real_rtcIntersect1(RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRayHit *ray);
void __real_rtcOccluded1(RTCScene scene, struct RTCIntersectContext *context,
                         struct RTCRay *ray);
void __wrap_rtcIntersect1(RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRayHit *ray);
void __wrap_rtcOccluded1(RTCScene scene, struct RTCIntersectContext *context,
                         struct RTCRay *ray);

void __wrap_rtcIntersect1(RTCScene scene, struct RTCIntersectContext *context,
                          struct RTCRayHit *ray)
{
    if (recording.on) {
        recording.scene = scene;
        if (recording.intersect_count < RECORD_MOST)
            recording.intersect[recording.intersect_count] = *ray;
        recording.intersect_count++;
    }
    __real_rtcIntersect1(scene, context, ray);
}

void __wrap_rtcOccluded1(RTCScene scene, struct RTCIntersectContext *context,
                         struct RTCRay *ray)
{
    if (recording.on) {
        if (recording.occluded_count < RECORD_MOST)
            recording.occluded[recording.occluded_count] = *ray;
        recording.occluded_count++;
    }
    __real_rtcOccluded1(scene, context, ray);
}

static long least(long a, long b)
{
    return a < b ? a : b;
}

#define BLOCK 4096 /* rays that a thread replays at a time */

static void replay_intersect_block(void *ctx, long index, int thread)
{
    (void)ctx;
    (void)thread;
    long end = least((index + 1) * BLOCK, least(recording.intersect_count, RECORD_MOST));
    for (long i = index * BLOCK; i < end; i++) {
        struct RTCIntersectContext context;
        struct RTCRayHit ray = recording.intersect[i];
        rtcInitIntersectContext(&context);
        __real_rtcIntersect1(recording.scene, &context, &ray);
    }
}

static void replay_occluded_block(void *ctx, long index, int thread)
{
    (void)ctx;
    (void)thread;
    long end = least((index + 1) * BLOCK, least(recording.occluded_count, RECORD_MOST));
    for (long i = index * BLOCK; i < end; i++) {
        struct RTCIntersectContext context;
        struct RTCRay ray = recording.occluded[i];
        rtcInitIntersectContext(&context);
        __real_rtcOccluded1(recording.scene, &context, &ray);
    }
}

/* CPU seconds of bare Embree a ray, on as many threads as the run. */
static double replay(long count, int threads,
                     void (*block)(void *ctx, long index, int thread))
{
    long rays = least(count, RECORD_MOST), blocks = (rays + BLOCK - 1) / BLOCK;
    double begin = clock_cpu();
    par_for(blocks, threads, block, NULL);
    return rays > 0 ? (clock_cpu() - begin) / (double)rays : 0.0;
}

static double run(const struct scene *scene, const struct settings *settings,
                  double *paths)
{
    struct run_result result = program_render(scene, settings);
    double seconds = result.seconds_cpu;
    *paths = result.statistics.paths + result.statistics.bootstrap_paths;
    run_result_deinit(&result);
    return seconds;
}

static double record(const struct scene *scene, struct settings settings)
{
    double paths;
    settings.threads = 1;
    program_set(&settings, "mutations_per_pixel=32");
    recording.intersect = mem_alloc(RECORD_MOST, sizeof *recording.intersect);
    recording.occluded = mem_alloc(RECORD_MOST, sizeof *recording.occluded);
    recording.on = true;
    run(scene, &settings, &paths);
    recording.on = false;
    return paths;
}

struct figures {
    double speed, bare, share; /* million mutations per CPU second; speed / bare */
    double intersects, occludeds;
    double mray_intersect, mray_occluded;
};

static double median(double *x)
{
    sort_ascending(x, TURNS);
    return x[TURNS / 2];
}

/* The run and the replays in turn, so that a slow minute of the machine hits all alike;
 * medians. */
static struct figures measure(const struct scene *scene, struct settings settings)
{
    double paths, recorded = record(scene, settings);
    double cpu[TURNS], intersect[TURNS], occluded[TURNS], share[TURNS];
    struct figures f = {.intersects = (double)recording.intersect_count / recorded,
                        .occludeds = (double)recording.occluded_count / recorded};
    int threads = settings.threads > 0 ? (int)settings.threads : par_threads_available();
    settings.seconds /= TURNS;
    for (int i = 0; i < TURNS; i++) {
        intersect[i] = replay(recording.intersect_count, threads, replay_intersect_block);
        cpu[i] = run(scene, &settings, &paths) / paths;
        occluded[i] = replay(recording.occluded_count, threads, replay_occluded_block);
        share[i] = (f.intersects * intersect[i] + f.occludeds * occluded[i]) / cpu[i];
    }
    f.speed = 1e-6 / median(cpu);
    f.share = median(share);
    f.mray_intersect = 1e-6 / median(intersect);
    f.mray_occluded = f.occludeds > 0.0 ? 1e-6 / median(occluded) : 0.0;
    f.bare = 1e-6 / (f.intersects * median(intersect) + f.occludeds * median(occluded));
    return f;
}

int main(int argc, char **argv)
{
    struct settings settings;
    struct err err = {0};
    libraries_prepare(argv);
    if (argc < 3) {
        fprintf(stderr, "usage: speed SCENE SECONDS [key=value ...]\n");
        return 2;
    }
    settings_init(&settings);
    for (int i = 3; i < argc; i++)
        program_set(&settings, argv[i]);
    if (!settings_set(&settings, "seconds", argv[2], NULL, &err))
        program_die(&err);
    struct scene *scene = program_open_scene(argv[1], &settings);
    struct figures f = measure(scene, settings);
    printf("million_mutations_per_cpu_second: %.3f\n", f.speed);
    printf("rays_per_mutation: %.2f intersect, %.2f occluded\n", f.intersects,
           f.occludeds);
    printf("embree_mray_per_second: %.1f intersect, %.1f occluded\n", f.mray_intersect,
           f.mray_occluded);
    printf("bare_embree_million_mutations: %.3f\n", f.bare);
    printf("share_of_bare_embree: %.3f\n", f.share);
    mem_free(recording.intersect);
    mem_free(recording.occluded);
    scene_destroy(scene);
    return 0;
}
