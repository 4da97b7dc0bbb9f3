/* Random streams: uniform each, and independent of their neighbours in seed, purpose and
 * index. False-alarm rate 1e-3 for the whole file (Sidak over its 80 p-values); fixed
 * seed. */
#include "math/rng.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <gsl/gsl_cdf.h>
#include <math.h>

enum { STREAMS = 1 << 18, CELLS = 32, P_VALUES = 80 };

static void check_p(double p)
{
    assert_true(p > 1.0 - pow(1.0 - 1e-3, 1.0 / P_VALUES));
}

static void check_uniform(const long *counts, int cells, long samples)
{
    double chi2 = 0.0, expected = (double)samples / cells;
    for (int i = 0; i < cells; i++)
        chi2 += ((double)counts[i] - expected) * ((double)counts[i] - expected) /
                expected;
    check_p(gsl_cdf_chisq_Q(chi2, cells - 1));
}

static void check_z(double z)
{
    check_p(2.0 * gsl_cdf_ugaussian_Q(fabs(z)));
}

/* The first outputs over many indices are as random as one long stream. */
static void first_outputs_are_uniform_in_every_bit(void **state)
{
    (void)state;
    long ones[64] = {0}, counts[CELLS * CELLS] = {0};
    for (uint64_t index = 0; index < STREAMS; index++) {
        struct rng rng;
        rng_init(&rng, 1, RNG_CHAIN, index);
        uint64_t x = rng_u64(&rng);
        for (int bit = 0; bit < 64; bit++)
            ones[bit] += (long)(x >> bit & 1);
        counts[x >> 54]++;
    }
    for (int bit = 0; bit < 64; bit++)
        check_z(((double)ones[bit] - 0.5 * STREAMS) / (0.5 * sqrt(STREAMS)));
    check_uniform(counts, CELLS * CELLS, STREAMS);
}

static void successive_doubles_fill_the_square(void **state)
{
    (void)state;
    for (uint64_t index = 0; index < 3; index++) {
        long counts[CELLS * CELLS] = {0};
        struct rng rng;
        rng_init(&rng, 2, RNG_CHAIN, index);
        for (int k = 0; k < STREAMS; k++) {
            int x = (int)(rng_double(&rng) * CELLS);
            counts[x * CELLS + (int)(rng_double(&rng) * CELLS)]++;
        }
        check_uniform(counts, CELLS * CELLS, STREAMS);
    }
}

/* The k-th doubles of two streams fill the square, and the bits in which their k-th
 * outputs differ are half of all. */
static void check_neighbours(uint64_t seed_step, int purpose_step, uint64_t index_step,
                             int skip)
{
    long counts[CELLS * CELLS] = {0}, differ = 0;
    for (uint64_t i = 0; i < STREAMS; i++) {
        struct rng a, b;
        rng_init(&a, 3, RNG_BOOTSTRAP, i);
        rng_init(&b, 3 + seed_step, (enum rng_purpose)(RNG_BOOTSTRAP + purpose_step),
                 i + index_step);
        for (int k = 0; k < skip; k++) {
            rng_u64(&a);
            rng_u64(&b);
        }
        uint64_t x = rng_u64(&a), y = rng_u64(&b);
        counts[(x >> 59) * CELLS + (y >> 59)]++;
        differ += __builtin_popcountll(x ^ y);
    }
    check_uniform(counts, CELLS * CELLS, STREAMS);
    check_z(((double)differ - 32.0 * STREAMS) / (4.0 * sqrt(STREAMS)));
}

static void neighbouring_streams_are_independent(void **state)
{
    (void)state;
    check_neighbours(0, 0, 1, 0);
    check_neighbours(0, 0, 1, 5);
    check_neighbours(0, 0, UINT64_C(1) << 32, 0);
    check_neighbours(1, 0, 0, 0);
    check_neighbours(0, 1, 0, 0);
    check_neighbours(1, 0, (uint64_t)-1, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_outputs_are_uniform_in_every_bit),
        cmocka_unit_test(successive_doubles_fill_the_square),
        cmocka_unit_test(neighbouring_streams_are_independent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
