/* run: a run that may take more memory than there is is refused before it
 * takes any, whatever the integrator; and what a run is said to take at most is what it
 * takes. */
#include "base/machine.h"
#include "integrator/automatic.h"
#include "integrator/registry.h"
#include "support/test_run.h"

#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* Address sanitizers reserve terabytes of addresses, and memory beside all that is asked
 * for. */
#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif
#ifndef SANITIZED
#define SANITIZED 0
#endif

static struct scene *room(int size)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 3.5f), vec3(0, 1, 0), 45.0, size);
    test_room(desc);
    test_lamp(desc, 0.4, rgb_grey(3.0));
    return test_build(desc, false);
}

/* Bytes of addresses that this process has. */
static double addresses(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%20ld", &pages), 1);
    fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE);
}

/* Half a gigabyte of addresses is left, and a film of 400 million pixels asked for: the
 * first array of it would end the process. */
static void test_refusal(void **state)
{
    (void)state;
    struct rlimit before, tight;
    if (SANITIZED)
        skip();
    struct scene *scene = room(20000);
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    tight = before;
    tight.rlim_cur = (rlim_t)(addresses() + 0x1p29);
    for (const struct integrator_type *const *type = integrator_types; *type; type++) {
        struct settings s = test_settings((const char *const[]){NULL});
        struct run_options options = {.scene = scene, .settings = &s};
        struct run_result result = {0};
        struct err err = {0};
        s.integrator = (*type)->name;
        double peak = machine_memory_peak();
        assert_int_equal(setrlimit(RLIMIT_AS, &tight), 0);
        bool ran = run_render(&options, &result, &err);
        assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
        assert_false(ran);
        assert_null(result.image);
        assert_non_null(strstr(err.message, s.integrator));
        assert_non_null(strstr(err.message, "MB of memory are available"));
        assert_true(machine_memory_peak() - peak < 0x1p22);
    }
    scene_destroy(scene);
}

/* Bytes that a run takes at most in a process of its own, beside the scene. */
static double taken(const struct scene *scene, const struct settings *settings)
{
    int pipes[2];
    double bytes = -1.0;
    assert_int_equal(pipe(pipes), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        double before = machine_memory_now();
        struct run_result result = test_run(scene, settings);
        bytes = machine_memory_peak() - before;
        run_result_deinit(&result);
        _exit(write(pipes[1], &bytes, sizeof bytes) != sizeof bytes);
    }
    close(pipes[1]);
    assert_int_equal(read(pipes[0], &bytes, sizeof bytes), sizeof bytes);
    close(pipes[0]);
    assert_int_equal(waitpid(child, NULL, 0), child);
    return bytes;
}

/* The bound holds for all; what falls short of it by more than a tenth is the film's fine
 * sums, of which pages without a small splat are never touched, and extra bootstrap
 * paths. Structs, stacks and what is touched of the program for the first time come to
 * less than two megabytes. */
static void test_bound(void **state)
{
    (void)state;
    if (SANITIZED)
        skip();
    struct scene *scene = room(256);
    for (const struct integrator_type *const *type = integrator_types; *type; type++) {
        const char *const words[] = {"mutations_per_pixel=2", "max_depth=4",
                                     "direct=joint", NULL};
        struct settings s = test_settings(words);
        s.integrator = (*type)->name;
        struct run_memory memory = run_memory(scene, &s);
        double wanted = run_memory_sum(&memory), got = taken(scene, &s);
        print_message("%s: %.2f MB of at most %.2f\n", s.integrator, got / 0x1p20,
                      wanted / 0x1p20);
        assert_true(got <= wanted + 0x1p21);
        /* auto may choose one that takes less than the others would. */
        if (*type != &integrator_auto)
            assert_true(got >= 0.9 * (wanted - memory.rare - memory.extra));
    }
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refusal),
        cmocka_unit_test(test_bound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
