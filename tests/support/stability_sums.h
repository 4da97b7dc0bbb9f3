#ifndef ETALON_TESTS_SUPPORT_STABILITY_SUMS_H
#define ETALON_TESTS_SUPPORT_STABILITY_SUMS_H

/* Rows of the stability table that need no scene: stiff chains on toy targets, and sums.
 */

#include "support/stability.h"
#include "support/stiff_verdict.h"

static const struct stability_sweep stability_chain_sweeps[] = {
    {.category = "chains", .name = "island in 40 dimensions"},
    {.category = "chains", .name = "two islands, 1e-4"},
    {.category = "chains", .name = "plateaus of 1e12"},
};
static const struct stability_sweep stability_film_sweep = {
    .category = "accumulation",
    .name = "film, 2^20 splats of",
    .count = 8,
    .x = {1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1, 1e3, 1e6}};
static const struct stability_sweep stability_sum_sweep = {
    .category = "accumulation",
    .name = "sum of 2^20 terms over",
    .count = 3,
    .x = {1e12, 1e6, 1}};
static const struct stability_sweep stability_full_sweep = {
    .category = "accumulation",
    .name = "splat beyond the film",
    .count = 2,
    .x = {1e12, (double)INFINITY}};

static const struct stability_sweep stability_verdict_sweep = {.category = "chains",
                                                               .name = "verdict"};

/* A row for each cell whose pixel is not black. */
static inline int stability_stiff(int which, const struct stiff_setup *setup,
                                  struct stability_row *rows)
{
    const struct stiff *targets[] = {&stiff_island, &stiff_two_islands, &stiff_plateaus};
    const struct stiff *target = targets[which];
    static struct stiff_outcome o;
    int count = 0;
    stiff_run(target, setup, which == 0 ? 0.5 : 0.3, 4000, &o);
    for (int j = 0; j < target->cells; j++) {
        double exact = stiff_cell(target, j);
        if (!(exact > 0.0))
            continue;
        struct stability_row *row = &rows[count++];
        *row = (struct stability_row){.of = &stability_chain_sweeps[which],
                                      .x = j,
                                      .setup = setup->name,
                                      .tests = 1,
                                      .z = (double)NAN};
        row->value = o.cell[j].mean;
        row->reference = exact;
        row->se = welford_se(&o.cell[j]);
        row->residual = fabs(row->value - exact) / row->se;
        row->p = stat_mean_p(o.values[j], STIFF_CHAINS, exact);
        if (row->se > STABILITY_BLIND * exact)
            stability_note(row, WARNED, "too noisy to tell");
    }
    return count;
}

/* value: the call; x: p_large. Chains that mix may not be doubted, others must be. */
static inline struct stability_row stability_verdict(const struct stiff *target,
                                                     const struct stiff_setup *setup,
                                                     double p_large, bool mixes)
{
    struct stability_row row = {.of = &stability_verdict_sweep,
                                .x = p_large,
                                .setup = setup->name,
                                .p = 1.0,
                                .reference = mixes ? VERDICT_CONVERGED : VERDICT_NOT,
                                .z = (double)NAN};
    char words[200];
    row.value = stiff_judge(target, setup, p_large, 200, words, sizeof words);
    if (row.value != row.reference)
        stability_note(&row, FAILED, words);
    return row;
}

static inline int stability_chains(struct stability_row *rows)
{
    const struct stiff_setup *setups[] = {&stiff_mh, &stiff_counted, &stiff_exact};
    int count = 0;
    for (int which = 0; which < 3; which++)
        for (int i = 0; i < 3; i++)
            count += stability_stiff(which, setups[i], rows + count);
    for (int i = 0; i < 3; i++) {
        const struct stiff_setup *s = setups[i];
        rows[count++] = stability_verdict(&stiff_island, s, 0.5, false);
        rows[count++] = stability_verdict(&stiff_plateaus, s, 1e-5, false);
        rows[count++] = stability_verdict(&stiff_plateaus, s, 0.3, true);
        rows[count++] = stability_verdict(&stiff_two_islands, s, 0.3, true);
    }
    rows[count++] = stability_verdict(&stiff_island, &stiff_plain, 0.05, false);
    rows[count++] = stability_verdict(&stiff_plateaus, &stiff_plain, 1e-5, false);
    return count;
}

/* Exact to a bound: no statistics, so the residual itself decides, 1 being the bound. */
static inline struct stability_row stability_bounded(const struct stability_sweep *of,
                                                     double x, double value,
                                                     double reference, double bound)
{
    struct stability_row row = {.of = of,
                                .x = x,
                                .setup = "sum",
                                .p = 1.0,
                                .value = value,
                                .reference = reference};
    row.residual = fabs(value - reference) / bound;
    if (!(row.residual <= 1.0))
        stability_note(&row, FAILED, "beyond the bound of its roundings");
    return row;
}

static inline struct stability_row stability_film_sum(double weight)
{
    const long count = 1L << 20;
    struct film *film = film_create(1, 1);
    for (long i = 0; i < count; i++)
        film_splat(film, 0, rgb_grey(1.0), weight);
    double value = film_value(film, 0).g, exact = weight * (double)count;
    bool small = weight * FILM_ONE < FILM_SMALL;
    double bound = (small ? 0x1p-73 : 0x1p-37) * (double)count + 0x1p-50 * exact;
    struct stability_row row = stability_bounded(&stability_film_sweep, weight, value,
                                                 exact, bound);
    if (film_saturated(film) > 0)
        stability_note(&row, FAILED, "clamped within its range");
    film_destroy(film);
    return row;
}

/* Whole numbers of both signs over `range` times 2^20, against their exact sum. A sum in
 * long double is off by 2^-64 of all sizes, in which a plain one would go unseen. */
static inline struct stability_row stability_compensated(double range)
{
    const long count = 1L << 20;
    struct accum sum = {0.0, 0.0};
    struct rng rng;
    __extension__ __int128 exact = 0;
    double sizes = 0.0;
    rng_init(&rng, 7, RNG_TEST, 0);
    for (long i = 0; i < count; i++) {
        double sign = i % 2 ? -1.0 : 1.0;
        double x = floor(sign * rng_double(&rng) * pow(range, rng_double(&rng)) * 0x1p20);
        accum_add(&sum, x);
        exact += (int64_t)x;
        sizes += fabs(x);
    }
    double bound = 0x1p-52 * fabs((double)exact) + 0x1p-106 * (double)count * sizes;
    return stability_bounded(&stability_sum_sweep, range, accum_value(&sum),
                             (double)exact, bound);
}

/* Too bright, and told so. */
static inline struct stability_row stability_full_film(double weight)
{
    struct film *film = film_create(1, 1);
    film_splat(film, 0, rgb_grey(1.0), weight);
    struct stability_row row = {
        .of = &stability_full_sweep, .x = weight, .setup = "sum", .p = 1.0};
    row.value = (double)film_saturated(film);
    row.reference = 3.0;
    stability_note(&row, row.value == 3.0 ? REFUSED : FAILED,
                   "clamped, and counted as saturated");
    film_destroy(film);
    return row;
}

static inline int stability_sums(struct stability_row *rows)
{
    int count = 0;
    for (int i = 0; i < stability_film_sweep.count; i++)
        rows[count++] = stability_film_sum(stability_film_sweep.x[i]);
    for (int i = 0; i < stability_sum_sweep.count; i++)
        rows[count++] = stability_compensated(stability_sum_sweep.x[i]);
    for (int i = 0; i < stability_full_sweep.count; i++)
        rows[count++] = stability_full_film(stability_full_sweep.x[i]);
    return count;
}

#endif
