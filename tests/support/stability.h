#ifndef ETALON_TESTS_SUPPORT_STABILITY_H
#define ETALON_TESTS_SUPPORT_STABILITY_H

/* Cases of numerical stability: a scene with a number that is driven to extremes, its
 * picture known in closed form (or by a long run of another integrator), and what every
 * integrator makes of it.
 *
 * A residual is |mean of replicates - reference| in units of
 *     sqrt(se^2 + se_reference^2 + (precision * reference)^2),
 * se from the spread between replicates, precision the case's own bound on the rounding
 * of float geometry and pictures. Its p (Student's t) is held against two levels by
 * Sidak over all residuals of the table: warned below STABILITY_WARN, failed below
 * STABILITY_FAIL. */

#include "math/accum.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#define STABILITY_WARN 0.05
#define STABILITY_FAIL 1e-4
/* Replicates that spread by more than this share of the reference tell too little. */
#define STABILITY_BLIND      0.5
#define STABILITY_SKEWED     0.1
#define STABILITY_REPLICATES 16
#define STABILITY_FILM       4
#define STABILITY_CELLS      2    /* left and right half of the film */
#define STABILITY_PRECISION  4e-6 /* some 64 roundings of float */

enum case_outcome { PASSED, WARNED, FAILED, REFUSED };
static const char *const case_outcomes[] = {"passed", "warned", "failed", "refused"};

/* --- integrators ------------------------------------------------------------------ */

struct stability_setup {
    const char *name;
    const char *words[6];
    bool
        biased; /* by design: only the brightness of the whole film is held to be right */
    bool plain; /* no film of large steps */
};

static const struct stability_setup stability_setups[] = {
    {"pt", {"integrator=pt"}, false, false},
    {"bdpt", {"integrator=bdpt"}, false, false},
    {"pssmlt", {"integrator=pssmlt"}, false, false},
    {"pssmlt plain", {"integrator=pssmlt", "estimator=plain"}, false, true},
    {"pssmlt pt", {"integrator=pssmlt", "builder=pt"}, false, false},
    {"pssmlt pt plain",
     {"integrator=pssmlt", "builder=pt", "estimator=plain"},
     false,
     true},
    {"mmlt", {"integrator=mmlt", "direct=joint"}, false, false},
    {"mmlt plain", {"integrator=mmlt", "direct=joint", "estimator=plain"}, false, true},
    {"mmlt separate", {"integrator=mmlt", "direct=separate"}, false, false},
    {"pfmlt exact", {"integrator=pfmlt", "mode=exact", "direct=joint"}, false, false},
    {"pfmlt counted", {"integrator=pfmlt", "mode=counted", "direct=joint"}, false, false},
    {"pfmlt paper", {"integrator=pfmlt", "mode=paper", "direct=joint"}, true, true},
    {"pssmlt gaussian", {"integrator=pssmlt", "kernel=gaussian"}, false, false},
    {"mmlt gaussian by length",
     {"integrator=mmlt", "kernel=gaussian", "per=length", "direct=joint",
      "allocation=brightness"},
     false,
     false},
    {"smlt",
     {"integrator=smlt", "share_floor=1", "ceiling=20", "passes_share=0.5"},
     false,
     false},
    {"smlt mmlt",
     {"integrator=smlt", "metropolis=mmlt", "share_floor=0.5", "ceiling=20",
      "passes_share=0.5"},
     false,
     false},
    {"pfmlt separate plain",
     {"integrator=pfmlt", "direct=separate", "estimator=plain"},
     false,
     true},
    {"rjmlt", {"integrator=rjmlt", "direct=joint"}, false, false},
    {"rjmlt exact",
     {"integrator=rjmlt", "mode=exact", "jump_probability=0.5"},
     false,
     false},
    {"mlt", {"integrator=mlt", "direct=joint"}, false, false},
    {"mlt separate plain",
     {"integrator=mlt", "direct=separate", "estimator=plain"},
     false,
     true},
};

/* smlt weighs pixels as relMSE does, by 1/(I^2 + 0.01), so the scale of emission matters
 * to its bits. */
static inline bool stability_ignores_scale(const struct stability_setup *setup)
{
    return strncmp(setup->name, "smlt", 4) != 0;
}

#define STABILITY_SETUPS ((int)(sizeof stability_setups / sizeof *stability_setups))

/* --- cases ------------------------------------------------------------------------ */

/* What is driven to extremes is x. */
struct stability_sweep {
    const char *category, *name;
    struct scene_desc *(*make)(double x);
    /* Luminance of the two halves of the film; NULL: what pt says with 16 times the
     * samples. */
    void (*exact)(double x, double cells[STABILITY_CELLS]);
    int depth;        /* 0: x */
    double effort;    /* mutations per pixel: 64 times this; 0 is 1 */
    double precision; /* relative; 0: STABILITY_PRECISION; and for each unit of x: */
    double precision_slope, precision_over; /* over x */
    bool may_refuse;                        /* an error line is an answer */
    bool unmixed;  /* more than chains can mix without a film of large steps: then the
                      verdict has to say so */
    bool heavy;    /* tested with ETALON_LONG only */
    bool unlikely; /* so little light gets through that chains may find none */
    int count;
    double x[12]; /* [count], the most extreme first */
};

struct stability_row {
    const struct stability_sweep *of;
    double x;
    const char *setup;
    double value, reference, se, residual, p;
    int tests; /* residuals of which p is the least */
    double z;  /* of the whole film, signed, in standard errors; NAN: not to be pooled */
    enum case_outcome verdict;
    char note[200];
    char told[200]; /* what the scene's log or the table says of it beforehand */
};

struct stability_cell {
    struct welford mean[STABILITY_CELLS + 1]; /* the last: of the whole film */
    double nonfinite, saturated, b;
    int converged; /* verdicts */
    bool infinite; /* a pixel is not a finite number */
};

static inline void stability_add(struct stability_cell *cell, const struct run_result *r)
{
    double sum[STABILITY_CELLS] = {0.0}, all = 0.0;
    int width = r->image->width, height = r->image->height;
    int cells = width < STABILITY_CELLS ? 1 : STABILITY_CELLS;
    for (int i = 0; i < width * height; i++) {
        const float *p = r->image->pixels + 3 * i;
        struct rgb v = rgb((double)p[0], (double)p[1], (double)p[2]);
        cell->infinite |= !rgb_is_finite(v);
        sum[cells * (i % width) / width] += rgb_luminance(v);
        all += rgb_luminance(v);
    }
    for (int i = 0; i < STABILITY_CELLS; i++)
        welford_add(&cell->mean[i], sum[i % cells] * cells / (width * height));
    welford_add(&cell->mean[STABILITY_CELLS], all / (width * height));
    cell->converged += r->verdict.call == VERDICT_CONVERGED;
    cell->nonfinite += r->statistics.nonfinite;
    cell->saturated += r->statistics.saturated;
    cell->b += r->statistics.b / STABILITY_REPLICATES;
}

/* Settings of a case; `more` multiplies its effort. */
static inline struct settings stability_settings(const struct stability_sweep *c,
                                                 double x,
                                                 const struct stability_setup *setup,
                                                 double more)
{
    char mpp[64], depth[64], bootstrap[64];
    double effort = (c->effort > 0.0 ? c->effort : 1.0) * more;
    const char *words[10] = {mpp, depth, bootstrap, "chains=16"};
    snprintf(mpp, sizeof mpp, "mutations_per_pixel=%.0f", 64.0 * effort);
    snprintf(depth, sizeof depth, "max_depth=%d", c->depth > 0 ? c->depth : (int)x);
    snprintf(bootstrap, sizeof bootstrap, "bootstrap=%.0f", fmin(2000.0 * effort, 1e6));
    for (int i = 0; i < 5 && setup->words[i]; i++)
        words[4 + i] = setup->words[i];
    return test_settings(words);
}

/* Streams of its own for each case, so that cases err independently. */
static inline long stability_seed(const struct stability_sweep *c, double x)
{
    uint32_t hash = 2166136261u; /* FNV-1a */
    char text[128];
    snprintf(text, sizeof text, "%s, %s %g", c->category, c->name, x);
    for (const char *s = text; *s; s++)
        hash = (hash ^ (unsigned char)*s) * 16777619u;
    return STABILITY_REPLICATES * (long)hash;
}

static inline bool stability_render(const struct scene *scene, struct settings *settings,
                                    struct stability_cell *cell, struct err *err)
{
    long first = settings->seed;
    *cell = (struct stability_cell){0};
    for (int i = 0; i < STABILITY_REPLICATES; i++) {
        settings->seed = first + i;
        struct run_options options = {.scene = scene, .settings = settings};
        struct run_result result = {0};
        bool good = run_render(&options, &result, err);
        if (good)
            stability_add(cell, &result);
        run_result_deinit(&result);
        if (!good)
            return false;
    }
    return true;
}

/* Of the whole film, for stability_pool: only where it is chance that decides, and its
 * law not too skewed. */
static inline double stability_signed(const struct stability_cell *x, const double *exact,
                                      const struct stability_cell *reference,
                                      double precision)
{
    const struct welford *whole = &x->mean[STABILITY_CELLS];
    double se = welford_se(whole), other = 0.0, r = 0.5 * (exact[0] + exact[1]);
    if (reference) {
        r = reference->mean[STABILITY_CELLS].mean;
        other = welford_se(&reference->mean[STABILITY_CELLS]);
    }
    bool chance = se > 10.0 * precision * fabs(r) && se < STABILITY_SKEWED * fabs(r);
    return chance ? (whole->mean - r) / hypot(se, other) : (double)NAN;
}

/* The worst of both halves and the whole, whose error is often far less, or the whole
 * alone of what is biased; x against reference cells with their own errors (NULL: 0). */
static inline void stability_compare(const struct stability_cell *x, const double *exact,
                                     const struct stability_cell *reference, bool biased,
                                     double precision, struct stability_row *row)
{
    row->p = 2.0;
    row->z = stability_signed(x, exact, reference, precision);
    for (int i = biased ? STABILITY_CELLS : 0; i <= STABILITY_CELLS; i++) {
        double se = welford_se(&x->mean[i]), other = 0.0;
        double r = i == STABILITY_CELLS ? 0.5 * (exact[0] + exact[1]) : exact[i];
        double freedom = STABILITY_REPLICATES - 1;
        if (reference) {
            r = reference->mean[i].mean;
            other = welford_se(&reference->mean[i]);
        }
        double scale = sqrt(se * se + other * other + precision * precision * r * r);
        double difference = x->mean[i].mean - r;
        double residual = difference == 0.0 ? 0.0 : fabs(difference) / scale;
        double p = isfinite(residual) ? stat_t_p(residual, freedom) : 0.0;
        row->tests++;
        if (!(p < row->p))
            continue;
        row->p = p;
        row->residual = residual;
        row->value = x->mean[i].mean;
        row->reference = r;
        row->se = hypot(se, other);
    }
}

static inline void stability_note(struct stability_row *row, enum case_outcome verdict,
                                  const char *note)
{
    if (verdict > row->verdict) {
        row->verdict = verdict;
        snprintf(row->note, sizeof row->note, "%.*s", (int)sizeof row->note - 1, note);
    }
}

/* What needs no level: all that a run itself says. */
static inline void stability_inspect(const struct stability_sweep *c,
                                     const struct stability_cell *x,
                                     struct stability_row *row)
{
    char text[160];
    snprintf(text, sizeof text, "reports %g values that are not finite", x->nonfinite);
    if (x->nonfinite > 0.0)
        stability_note(row, WARNED, text);
    snprintf(text, sizeof text, "reports %g splats too bright for the film",
             x->saturated);
    if (x->saturated > 0.0)
        stability_note(row, WARNED, text);
    if (x->infinite)
        stability_note(row, FAILED, "a pixel is not a finite number");
    if (x->b == 0.0 && c->unlikely)
        stability_note(row, WARNED, "says that it found no light at all");
    else if (row->se > STABILITY_BLIND * fabs(row->reference))
        stability_note(row, WARNED, "too noisy to tell");
}

/* What was said beforehand: the scene's log, or where chains cannot mix the verdicts of
 * all replicates (of mode paper, which has none, that it is biased). */
static inline void stability_tell(const struct stability_sweep *c,
                                  const struct stability_setup *setup,
                                  const struct log *log, const struct stability_cell *x,
                                  struct stability_row *row)
{
    if (c->unlikely || c->unmixed || log->count > 0)
        row->z = (double)NAN;
    if (c->unmixed && setup->plain && x->converged == 0)
        snprintf(row->told, sizeof row->told, "%s",
                 setup->biased ? "mode paper: biased"
                               : "the verdict: not converged, or too short");
    if (log->count > 0)
        snprintf(row->told, sizeof row->told, "says: %.180s",
                 log->notes[log->count - 1].text);
}

/* Rows of a whole table, and of one call below at most. */
#define STABILITY_ROWS_MOST 8192
#define STABILITY_ROWS_CALL 256

/* Before any call that adds to `count` rows. */
static inline void stability_need_rows(int count)
{
    if (count <= STABILITY_ROWS_MOST - STABILITY_ROWS_CALL)
        return;
    fprintf(stderr, "the table of stability has no place for more than %d rows\n", count);
    abort();
}

/* One case: a row for each setup of those with a bit in `setups`; returns how many. */
static inline int stability_run(const struct stability_sweep *c, double at,
                                unsigned setups, struct stability_row *rows)
{
    struct err err = {0};
    struct scene_options options = {.threads = 1};
    struct scene *scene = scene_build(c->make(at), &options, &err);
    int count = 0;
    if (!scene) {
        rows[0] = (struct stability_row){
            .of = c, .x = at, .setup = "all", .p = 1.0, .z = (double)NAN};
        stability_note(&rows[0], c->may_refuse ? REFUSED : FAILED, err.message);
        return 1;
    }
    double exact[STABILITY_CELLS] = {0.0};
    struct stability_cell reference, x;
    if (c->exact) {
        c->exact(at, exact);
    } else {
        struct settings s = stability_settings(c, at, &stability_setups[0], 16.0);
        s.seed = stability_seed(c, at) + (1L << 40);
        if (!stability_render(scene, &s, &reference, &err))
            test_scene_die(&err);
    }
    double precision = c->precision > 0.0 ? c->precision : STABILITY_PRECISION;
    if (c->precision_slope > 0.0)
        precision += c->precision_slope * at;
    if (c->precision_over > 0.0)
        precision += c->precision_over / at;
    for (int i = 0; i < STABILITY_SETUPS; i++) {
        const struct stability_setup *setup = &stability_setups[i];
        if (!(setups >> i & 1u))
            continue;
        struct stability_row *row = &rows[count++];
        *row = (struct stability_row){
            .of = c, .x = at, .setup = setup->name, .p = 1.0, .z = (double)NAN};
        struct settings s = stability_settings(c, at, setup, 1.0);
        s.seed = stability_seed(c, at);
        if (!stability_render(scene, &s, &x, &err)) {
            stability_note(row, c->may_refuse ? REFUSED : FAILED, err.message);
            continue;
        }
        stability_compare(&x, exact, c->exact ? NULL : &reference, setup->biased,
                          precision, row);
        stability_inspect(c, &x, row);
        stability_tell(c, setup, &scene->desc->log, &x, row);
    }
    scene_destroy(scene);
    return count;
}

/* What is too little to be seen in any case, a percent or two: the mean of a category's
 * deviations in one setup. */
static const struct stability_sweep stability_pooled[] = {
    {.category = "emitter", .name = "pooled"},
    {.category = "scale", .name = "pooled"},
    {.category = "radiance", .name = "pooled"},
    {.category = "grazing", .name = "pooled"},
    {.category = "roughness", .name = "pooled"},
    {.category = "ior", .name = "pooled"},
    {.category = "depth", .name = "pooled"},
    {.category = "gaps", .name = "pooled"},
    {.category = "camera", .name = "pooled"},
    {.category = "triangles", .name = "pooled"},
    {.category = "textures", .name = "pooled"},
};

#define STABILITY_POOLED ((int)(sizeof stability_pooled / sizeof *stability_pooled))

/* value: mean of the n signed residuals, each of Student's law of REPLICATES - 1 degrees;
 * returns false without any. */
static inline bool stability_pool(const struct stability_row *rows, int count,
                                  const struct stability_sweep *of, const char *setup,
                                  struct stability_row *pooled)
{
    const double freedom = STABILITY_REPLICATES - 1;
    struct welford mean = {0};
    for (int i = 0; i < count; i++)
        if (strcmp(rows[i].of->category, of->category) == 0 &&
            strcmp(rows[i].setup, setup) == 0 && !isnan(rows[i].z))
            welford_add(&mean, rows[i].z);
    double n = (double)mean.count;
    *pooled = (struct stability_row){.of = of,
                                     .x = n,
                                     .setup = setup,
                                     .value = mean.mean,
                                     .tests = 1,
                                     .z = (double)NAN};
    if (!(n > 0.0))
        return false;
    pooled->se = sqrt(freedom / (freedom - 2.0) / n);
    pooled->residual = fabs(mean.mean) / pooled->se;
    pooled->p = erfc(pooled->residual / sqrt(2.0));
    return true;
}

/* Adds the pooled rows; returns how many. */
static inline int stability_pools(struct stability_row *rows, int count)
{
    int more = 0;
    _Static_assert(STABILITY_POOLED * STABILITY_SETUPS <= STABILITY_ROWS_CALL, "rows");
    stability_need_rows(count);
    for (int k = 0; k < STABILITY_POOLED; k++)
        for (int i = 0; i < STABILITY_SETUPS; i++)
            more += stability_pool(rows, count, &stability_pooled[k],
                                   stability_setups[i].name, rows + count + more);
    return more;
}

/* Levels need all rows of the table. */
static inline void stability_judge(struct stability_row *rows, int count)
{
    int tests = 1;
    for (int i = 0; i < count; i++)
        tests += rows[i].tests;
    for (int i = 0; i < count; i++) {
        struct stability_row *row = &rows[i];
        char text[80];
        snprintf(text, sizeof text, "off by %.1f standard errors", row->residual);
        if (row->p < stat_sidak(STABILITY_FAIL, tests) && row->told[0])
            stability_note(row, WARNED, row->told);
        else if (row->p < stat_sidak(STABILITY_FAIL, tests))
            stability_note(row, FAILED, text);
        else if (row->p < stat_sidak(STABILITY_WARN, tests))
            stability_note(row, WARNED, text);
    }
}

#endif
