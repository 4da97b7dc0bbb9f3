/* Streams never change silently: the values below were computed by a second, independent
 * program; those from state {1,2,3,4} are the published test vector of xoshiro256++. */
#include "math/rng.h"
#include "math/ustream.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

static void generator_gives_the_published_values(void **state)
{
    (void)state;
    static const uint64_t expected[10] = {
        41943041U,
        58720359U,
        3588806011781223U,
        3591011842654386U,
        9228616714210784205U,
        9973669472204895162U,
        14011001112246962877U,
        12406186145184390807U,
        15849039046786891736U,
        10450023813501588000U,
    };
    struct rng rng = {{1, 2, 3, 4}};
    for (int i = 0; i < 10; i++)
        assert_true(rng_u64(&rng) == expected[i]);
}

static void streams_never_change(void **state)
{
    (void)state;
    static const struct {
        uint64_t seed, index, first[3];
        enum rng_purpose purpose;
    } cases[] = {
        {1,
         0,
         {0x2c18c8d88a23f7a4, 0x6b49784674f27809, 0xd00f96f770525075},
         RNG_BOOTSTRAP},
        {1, 0, {0xb0088aa220917025, 0x56373ecffb7c0aca, 0xd4750195bef93aea}, RNG_CHAIN},
        {1, 1, {0xd96f548951f35c61, 0xe66777e779baac9e, 0xb953d5e211f1fa7a}, RNG_CHAIN},
        {UINT64_MAX,
         UINT64_MAX,
         {0x731174305fa7c4f5, 0xbd6ef7c993eabe4e, 0x3d66e60c5e44189e},
         RNG_TEST},
    };
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
        struct rng rng;
        rng_init(&rng, cases[c].seed, cases[c].purpose, cases[c].index);
        for (int i = 0; i < 3; i++)
            assert_true(rng_u64(&rng) == cases[c].first[i]);
    }
}

static void doubles_fill_the_unit_interval_below_one(void **state)
{
    (void)state;
    struct rng rng = {{0, 0, 0, 0}};
    assert_true(rng_double(&rng) == 0.0);
    /* The largest output, rotl(0 + s3, 23) + 0 with s3 = ~0, maps to the largest double
     * below 1. */
    rng = (struct rng){{0, 0, 0, UINT64_MAX}};
    assert_true(rng_double(&rng) == 1.0 - 0x1p-53);
}

static int compare_states(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct rng));
}

static void distinct_triples_share_no_state_and_no_word(void **state)
{
    (void)state;
    enum { SEEDS = 16, PURPOSES = 6, INDICES = 1024, COUNT = SEEDS * PURPOSES * INDICES };
    struct rng *states = malloc(COUNT * sizeof *states);
    assert_non_null(states);
    int n = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++)
        for (int purpose = 1; purpose <= PURPOSES; purpose++)
            for (uint64_t index = 0; index < INDICES; index++)
                rng_init(&states[n++], seed, (enum rng_purpose)purpose, index);
    for (int word = 0; word < 4; word++) {
        /* 1e5 words of 64 bits: a shared one has chance 3e-10. */
        qsort(states, COUNT, sizeof *states, compare_states);
        for (int i = 1; i < COUNT; i++)
            assert_true(states[i].s[0] != states[i - 1].s[0]);
        for (int i = 0; i < COUNT; i++) {
            uint64_t first = states[i].s[0];
            memmove(states[i].s, states[i].s + 1, 3 * sizeof first);
            states[i].s[3] = first;
        }
    }
    free(states);
}

static void random_stream_passes_the_generator_on(void **state)
{
    (void)state;
    struct rng a, b;
    rng_init(&a, 7, RNG_TEST, 0);
    rng_init(&b, 7, RNG_TEST, 0);
    struct ustream_random random;
    ustream_random_init(&random, &a);
    for (int count = 1; count <= USTREAM_MAX_COUNT; count++) {
        const double *u = ustream_take(&random.stream, 100 - 7 * count, count);
        for (int i = 0; i < count; i++)
            assert_true(u[i] == rng_double(&b));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(generator_gives_the_published_values),
        cmocka_unit_test(streams_never_change),
        cmocka_unit_test(doubles_fill_the_unit_interval_below_one),
        cmocka_unit_test(distinct_triples_share_no_state_and_no_word),
        cmocka_unit_test(random_stream_passes_the_generator_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
