/* The rule on made-up runs: parts that agree, parts that each stay elsewhere, too short
 * ones, and each doubt by itself. Error bars from deviations that are known. */
#include "convergence/verdict.h"
#include "math/rng.h"
#include "support/stat_test.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <string.h>

#define FALSE_ALARM 1e-4

enum { SIDE = 64, REPLICAS = 8, TILES = 16 };

struct made {
    struct replicas *films;
    struct time_spans spans;
    struct image *picture;
    struct evidence evidence;
};

/* Deviations +1, -1, +1, ...: the variance of the mean is 8 / (8 * 7). */
static double deviations(const void *self, long pixel, double *out)
{
    const double *common = self;
    (void)pixel;
    for (int r = 0; r < REPLICAS; r++)
        out[r] = r % 2 ? -1.0 : 1.0;
    return *common;
}

/* What parts add to a tile in a span of time: noise of their own, */
struct plan {
    int spans;
    double stay;     /* times what a part has drawn for the tile once for all, */
    double part;     /* what every second part adds everywhere, */
    double drift;    /* what every span has more of than the last, */
    double constant; /* and what is always there. */
};

static void make_plan(struct made *m, uint64_t run, const struct plan *plan)
{
    static const double none = 0.0;
    struct rng rng;
    double place[REPLICAS][TILES];
    rng_init(&rng, 7, RNG_TEST, run);
    *m = (struct made){0};
    m->films = replicas_create(SIDE, SIDE, REPLICAS, 1, true);
    m->picture = image_create(SIDE, SIDE);
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        m->picture->pixels[i] = 10.0f;
    time_spans_init(&m->spans, m->films, 1.0);
    for (int span = -1; span < plan->spans; span++) {
        for (int r = 0; r < REPLICAS; r++)
            for (int tile = 0; tile < TILES; tile++) {
                double u = rng_double(&rng);
                if (span < 0)
                    place[r][tile] = u;
                int at = (r * SIDE + tile / 4 * 16) * SIDE + tile % 4 * 16;
                if (span >= 0)
                    replica_add(&m->films->lanes[0], at,
                                (u + plan->stay * place[r][tile] + plan->part * (r % 2) +
                                 plan->drift * span + plan->constant) *
                                    REPLICAS_ONE,
                                rng.s[0]);
            }
        replica_flush(&m->films->lanes[0]);
        if (span >= 0)
            time_spans_take(&m->spans, m->films, span + 1.0, false, 1);
    }
    m->evidence = (struct evidence){
        .replicas = REPLICAS,
        .spans = &m->spans,
        .deviations = deviations,
        .self = &none,
        .replicas_with_pass = REPLICAS,
        .fewest_replicas = REPLICAS,
    };
}

static void make(struct made *m, uint64_t run, int spans, double stay)
{
    make_plan(m, run, &(struct plan){.spans = spans, .stay = stay});
}

static void unmake(struct made *m)
{
    time_spans_deinit(&m->spans);
    replicas_destroy(m->films);
    image_destroy(m->picture);
}

static enum verdict_call call_of(const struct made *m, const char *word)
{
    struct verdict v;
    verdict_find(&m->evidence, m->picture, &v);
    enum verdict_call call = v.call;
    if (word && strstr(v.words, word) == NULL)
        fail_msg("'%s' lacks '%s'", v.words, word);
    verdict_deinit(&v);
    return call;
}

/* Parts that agree: a doubt in at most one of a hundred; parts that stay: always. */
static void agreement_is_seen(void **state)
{
    (void)state;
    const int runs = 300;
    int doubted = 0;
    for (int run = 0; run < runs; run++) {
        struct made m;
        make(&m, (uint64_t)run, 16, 0.0);
        doubted += call_of(&m, NULL) != VERDICT_CONVERGED;
        unmake(&m);
        if (run % 10)
            continue;
        make(&m, (uint64_t)run, 16, 2.0);
        assert_int_equal(call_of(&m, "tiles disagree"), VERDICT_NOT);
        unmake(&m);
    }
    printf("%d of %d doubted\n", doubted, runs);
    double p = doubted ? gsl_cdf_binomial_Q((unsigned)doubted - 1, 0.01, (unsigned)runs)
                       : 1.0;
    assert_true(stat_ok("doubts about parts that agree", p, FALSE_ALARM));
}

/* Parts that no tile can tell apart, but all together; parts that all drift; and those
 * that differ by less than rounding may. */
static void brightness_drift_and_rounding(void **state)
{
    (void)state;
    for (uint64_t run = 0; run < 5; run++) {
        struct made m;
        make_plan(&m, run, &(struct plan){.spans = 16, .part = 0.15});
        assert_int_equal(call_of(&m, "differ in brightness"), VERDICT_NOT);
        unmake(&m);
        make_plan(&m, run, &(struct plan){.spans = 16, .drift = 0.1});
        assert_int_equal(call_of(&m, "tiles disagree"), VERDICT_NOT);
        unmake(&m);
        make_plan(&m, run, &(struct plan){.spans = 16, .part = 1.0, .constant = 0x1p21});
        assert_int_equal(call_of(&m, NULL), VERDICT_CONVERGED);
        unmake(&m);
    }
}

static double noisy(const void *self, long pixel, double *out)
{
    double common = deviations(self, pixel, out);
    for (int r = 0; r < REPLICAS; r++)
        out[r] *= 10.0;
    return common;
}

/* One part alone is off, in a corner that is dark. */
static double outlier(const void *self, long pixel, double *out)
{
    (void)self;
    for (int r = 0; r < REPLICAS; r++)
        out[r] = pixel ? 0.0 : r ? -1.0 : REPLICAS - 1.0;
    return 0.0;
}

static double faint(const void *self, long pixel, double *out)
{
    double common = deviations(self, pixel, out);
    for (int r = 0; r < REPLICAS; r++)
        out[r] *= 0.02;
    return common;
}

/* Every pixel as before, plus red, green and blue. */
static void shift(struct image *image, float red, float green, float blue)
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        image->pixels[3 * i] += red;
        image->pixels[3 * i + 1] += green;
        image->pixels[3 * i + 2] += blue;
    }
}

/* To relMSE a picture of mean 0.01 is black, whatever its noise. Of a picture that moves
 * in blue alone luminance sees 7 %; one that moves in grey is as good as its bars. */
static void dark_and_coloured_noise(void **state)
{
    (void)state;
    struct made m;
    make(&m, 3, 16, 0.0);
    struct image *before = image_create(SIDE, SIDE);
    m.evidence.before = before;
    shift(before, 15.0f, 15.0f, 15.0f);
    assert_int_equal(call_of(&m, NULL), VERDICT_CONVERGED);
    shift(before, -5.0f, -5.0f, 0.0f);
    assert_int_equal(call_of(&m, "noise of blue is large, relMSE 0.2"), VERDICT_NOT);
    image_destroy(before);
    m.evidence.before = NULL;
    m.evidence.deviations = faint;
    assert_int_equal(call_of(&m, NULL), VERDICT_CONVERGED);
    shift(m.picture, -9.99f, -9.99f, -9.99f);
    assert_int_equal(call_of(&m, "so dark a picture"), VERDICT_NOT);
    unmake(&m);
}

static void doubts(void **state)
{
    (void)state;
    struct made m;
    make(&m, 3, 16, 0.0);
    assert_int_equal(call_of(&m, NULL), VERDICT_CONVERGED);
    struct evidence fine = m.evidence;
    m.evidence.replicas_wanted = 2 * REPLICAS;
    assert_int_equal(call_of(&m, "by 8 parts of the run: 16 would take"),
                     VERDICT_CONVERGED);
    m.evidence.missing = "replicas=1";
    assert_int_equal(call_of(&m, "replicas=1"), VERDICT_NONE);
    m.evidence = fine;
    m.evidence.no_light = true;
    assert_int_equal(call_of(&m, "no light"), VERDICT_NOT);
    m.evidence = fine;
    m.evidence.not_started = true;
    assert_int_equal(call_of(&m, "before its chains moved"), VERDICT_SHORT);
    m.evidence = fine;
    m.evidence.replicas_with_pass = 3;
    assert_int_equal(call_of(&m, "3 passes"), VERDICT_SHORT);
    m.evidence = fine;
    m.evidence.b_error = 0.2;
    assert_int_equal(call_of(&m, "20 %"), VERDICT_NOT);
    m.evidence = fine;
    m.evidence.few_chains_share = 0.1;
    m.evidence.few_chains_length = 9;
    assert_int_equal(call_of(&m, "9 edges"), VERDICT_NOT);
    m.evidence = fine;
    m.evidence.never_moved_share = 0.1;
    assert_int_equal(call_of(&m, "never moved"), VERDICT_NOT);
    m.evidence = fine;
    m.evidence.stuck_share = 0.1;
    m.evidence.stuck_fraction = 0.7;
    assert_int_equal(call_of(&m, "70 %"), VERDICT_NOT);
    m.evidence = fine;
    m.evidence.missed_places = 3;
    m.evidence.missed_x = 17;
    assert_int_equal(call_of(&m, "in 3 places large steps find"), VERDICT_NOT);
    assert_int_equal(call_of(&m, "(17,0)"), VERDICT_NOT);
    m.evidence = fine;
    m.evidence.lost = 2.0;
    assert_int_equal(call_of(&m, "2 values were not finite or too large"), VERDICT_NOT);
    m.evidence = fine;
    m.evidence.edges_cut = 5.0;
    assert_int_equal(call_of(&m, "5 edges pass too many panes"), VERDICT_NOT);
    m.evidence = fine;
    m.evidence.deviations = noisy;
    assert_int_equal(call_of(&m, "noise"), VERDICT_NOT);
    m.evidence.deviations = outlier;
    assert_int_equal(call_of(&m, "one part"), VERDICT_NOT);
    unmake(&m);
    make(&m, 3, 7, 0.0);
    assert_int_equal(call_of(&m, "7 spans"), VERDICT_SHORT);
    unmake(&m);
}

/* Blindness is no doubt about what is seen, and takes none away; noise alone leaves the
 * bars sound. */
static void blind_plain_only_valid(void **state)
{
    (void)state;
    struct made m;
    struct verdict v;
    make(&m, 3, 16, 0.0);
    struct evidence fine = m.evidence;
    m.evidence.blind_to = "";
    assert_int_equal(call_of(&m, NULL), VERDICT_CONVERGED);
    m.evidence.blind_to = "LS+E";
    assert_int_equal(call_of(&m, NULL), VERDICT_BLIND);
    m.evidence.b_error = 0.2;
    assert_int_equal(call_of(&m, "20 %"), VERDICT_NOT);
    m.evidence = fine;
    m.evidence.plain_only_length = 2;
    assert_int_equal(call_of(&m, "no light was found on more than 2 edges"),
                     VERDICT_CONVERGED);
    m.evidence = fine;
    for (int i = 0; i < 3; i++) { /* fine, noisy, and in doubt besides */
        m.evidence.deviations = i > 0 ? noisy : deviations;
        m.evidence.b_error = i > 1 ? 0.2 : 0.0;
        verdict_find(&m.evidence, m.picture, &v);
        assert_int_equal(v.call, i > 0 ? VERDICT_NOT : VERDICT_CONVERGED);
        assert_int_equal(v.error_bars_valid, i < 2);
        assert_int_equal(v.parts, REPLICAS);
        verdict_deinit(&v);
    }
    unmake(&m);
}

/* All words fit, whatever there is to say. */
static void all_doubts_at_once(void **state)
{
    (void)state;
    struct made m;
    make(&m, 1, 16, 5.0);
    m.evidence.b_error = m.evidence.few_chains_share = m.evidence.never_moved_share = 1.0;
    assert_int_equal(call_of(&m, "tiles disagree"), VERDICT_NOT);
    unmake(&m);
}

static void bars(void **state)
{
    (void)state;
    struct made m;
    struct verdict v;
    const double common = 0.25;
    make(&m, 2, 16, 0.0);
    m.evidence.self = &common;
    verdict_find(&m.evidence, m.picture, &v);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_true(fabs((double)v.se[i] - sqrt(8.0 / 56.0 + common)) < 1e-6);
    double around = 4.0 / (pow(10.0 - 1.0 / 7.0, 2.0) + 0.01) +
                    4.0 / (pow(10.0 + 1.0 / 7.0, 2.0) + 0.01);
    assert_true(fabs(v.relmse - around / 56.0 - common / 100.01) < 1e-12);
    assert_true(v.relmse_se < 0.05 * v.relmse);
    assert_true(v.bar_95 > 2.0 && v.bar_95 < 2.4);
    verdict_deinit(&v);
    unmake(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agreement_is_seen),
        cmocka_unit_test(brightness_drift_and_rounding),
        cmocka_unit_test(dark_and_coloured_noise),
        cmocka_unit_test(doubts),
        cmocka_unit_test(blind_plain_only_valid),
        cmocka_unit_test(all_doubts_at_once),
        cmocka_unit_test(bars),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
