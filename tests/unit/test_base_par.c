/* base/par: every index exactly once, thread numbers in range, one thread means this one.
 */
#include "base/par.h"

#include "base/mem.h"

#include <pthread.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define COUNT 10000

struct tally {
    int seen[COUNT];
    long on_thread[8];
    int strangers; /* calls from another thread than the caller's */
    pthread_t caller;
};

static void count_index(void *ctx, long index, int thread)
{
    struct tally *tally = ctx;
    __atomic_fetch_add(&tally->seen[index], 1, __ATOMIC_RELAXED);
    __atomic_fetch_add(&tally->on_thread[thread], 1, __ATOMIC_RELAXED);
    if (!pthread_equal(pthread_self(), tally->caller))
        __atomic_fetch_add(&tally->strangers, 1, __ATOMIC_RELAXED);
}

static void every_index_once(void **state)
{
    (void)state;
    struct tally *tally = mem_alloc(1, sizeof *tally);
    for (int threads = 0; threads <= 4; threads++) {
        memset(tally, 0, sizeof *tally);
        tally->caller = pthread_self();
        par_for(COUNT, threads, count_index, tally);
        long sum = 0;
        for (int i = 0; i < COUNT; i++)
            assert_int_equal(tally->seen[i], 1);
        for (int i = 0; i < (threads > 1 ? threads : 1); i++)
            sum += tally->on_thread[i];
        assert_int_equal(sum, COUNT);
        if (threads <= 1)
            assert_int_equal(tally->strangers, 0);
    }
    mem_free(tally);
}

static void no_index_no_call(void **state)
{
    (void)state;
    par_for(0, 3, count_index, NULL);
    par_for(-5, 3, count_index, NULL);
    assert_true(par_threads_available() >= 1);
}

/* Two bodies that wait for each other end only if they run at the same time. */
static void meet(void *ctx, long index, int thread)
{
    (void)index;
    (void)thread;
    pthread_barrier_wait(ctx);
}

static void threads_run_together(void **state)
{
    (void)state;
    pthread_barrier_t barrier;
    pthread_barrier_init(&barrier, NULL, 2);
    par_for(2, 2, meet, &barrier);
    pthread_barrier_destroy(&barrier);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_index_once),
        cmocka_unit_test(no_index_no_call),
        cmocka_unit_test(threads_run_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
