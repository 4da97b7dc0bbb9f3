/* run, base/mem: when there is no more memory in the middle of a run, the run
 * ends, says so, and what there is can be written. Each case in a process of its own,
 * which between two rounds takes all the memory that there is for it, to the last byte.
 */

#include "image/exr.h"
#include "lab/statistics.h"
#include "support/test_run.h"

#include "base/mem.h"

#include <stdlib.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define SIDE 200

/* Address sanitizers reserve terabytes of addresses. */
#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED true
#elif defined(__has_feature)
#define SANITIZED __has_feature(address_sanitizer)
#else
#define SANITIZED false
#endif

/* Where a compiler must take what is allocated to be seen. */
static void *volatile taken;

static void take_all(void)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file == NULL || fscanf(file, "%lu", &pages) != 1)
        _exit(9);
    fclose(file);
    struct rlimit limit = {pages * (unsigned long)sysconf(_SC_PAGESIZE), RLIM_INFINITY};
    if (setrlimit(RLIMIT_AS, &limit) != 0)
        _exit(10);
    for (size_t size = (size_t)1 << 28; size >= 16; size /= 2)
        while ((taken = malloc(size)) != NULL)
            continue;
}

static bool take_once(void *ctx, const struct error_row *row)
{
    int *rows = ctx;
    if (row->wall_s > 0.0 && (*rows)++ == 0)
        take_all();
    return true;
}

static bool write_all(const struct run_result *r, const struct scene *scene,
                      const struct settings *s, const char *path)
{
    struct statistics_record record;
    int count;
    statistics_record_init(&record, r, s, scene, "");
    struct exr_attribute *attributes = statistics_attributes(&record, &count);
    return exr_write(path, r->image, attributes, count, &r->layers, NULL);
}

static const char *const integrators[] = {"integrator=pt",     "integrator=bdpt",
                                          "integrator=pssmlt", "integrator=mmlt",
                                          "integrator=pfmlt",  "integrator=smlt"};

/* In the child: its exit status says what was wrong. */
static int starve(const struct scene *scene, const char *integrator, const char *path)
{
    const char *const words[] = {integrator, "seconds=60", "bootstrap=3000",
                                 "max_depth=4", NULL};
    struct settings s = test_settings(words);
    struct image *reference = image_create(SIDE, SIDE);
    struct run_result r = {0};
    struct err err = {0};
    int rows = 0;
    struct run_options options = {.scene = scene,
                                  .settings = &s,
                                  .reference = reference,
                                  .on_error_row = take_once,
                                  .hook_ctx = &rows};
    if (run_render(&options, &r, &err))
        return 11;
    if (err.code != ERR_MEMORY || strstr(err.message, "out of memory after") == NULL)
        return 12;
    if (r.image == NULL || !(rgb_luminance(test_image_mean(r.image)) > 0.0) ||
        !(r.statistics.paths > 0.0) || r.seconds_total > 50.0)
        return 13;
    if (r.end != RUN_MEMORY)
        return 14;
    return write_all(&r, scene, &s, path) ? 42 : 15;
}

static void picture_is_written(void **state)
{
    (void)state;
    if (SANITIZED)
        skip();
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, SIDE);
    test_room(desc);
    test_lamp(desc, 0.3, rgb(3, 2, 1));
    struct scene *scene = test_build(desc, false);
    for (size_t i = 0; i < sizeof integrators / sizeof *integrators; i++) {
        char path[64];
        int status;
        snprintf(path, sizeof path, "/tmp/etalon-exhaustion.%ld.exr", (long)getpid());
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0)
            _exit(starve(scene, integrators[i], path));
        assert_int_equal(waitpid(child, &status, 0), child);
        print_message("%s: %d\n", integrators[i], status >> 8);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 42);
        struct image *image = exr_read(path, NULL, NULL);
        char *ended = exr_read_attribute(path, "etalon:ended_by");
        assert_non_null(image);
        assert_string_equal(ended, "out of memory");
        assert_true(rgb_luminance(test_image_mean(image)) > 0.0);
        image_destroy(image);
        mem_free(ended);
        unlink(path);
    }
    scene_destroy(scene);
}

/* The reserve serves the allocation that failed; then there is none. */
static void reserve_is_used_once(void **state)
{
    (void)state;
    if (SANITIZED)
        skip();
    int status;
    bool *served = mmap(NULL, 1, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1,
                        0);
    assert_true(served != MAP_FAILED);
    pid_t child = fork();
    if (child == 0) {
        if (!mem_reserve((size_t)64 << 20) || mem_exhausted())
            _exit(10);
        take_all();
        void *first = mem_alloc((size_t)32 << 20, 1);
        if (first == NULL || !mem_exhausted())
            _exit(11);
        *served = true;
        if (dup2(STDOUT_FILENO, STDERR_FILENO) < 0)
            _exit(12);
        mem_alloc((size_t)64 << 20, 1); /* ends the process with status 1 */
        _exit(13);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 1);
    assert_true(*served);
    munmap(served, 1);
    assert_true(mem_reserve(4096));
    assert_false(mem_exhausted());
    mem_release_reserve();
    mem_release_reserve();
    assert_false(mem_exhausted());
    assert_false(mem_reserve(SIZE_MAX / 2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(picture_is_written),
        cmocka_unit_test(reserve_is_used_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
