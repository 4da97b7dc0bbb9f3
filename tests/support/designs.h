#ifndef ETALON_TESTS_SUPPORT_DESIGNS_H
#define ETALON_TESTS_SUPPORT_DESIGNS_H

/* The designs of all integrators against a known truth, by few figures that many short
 * replicate runs are pooled into: a t-test each, with what it would miss. */

#include "math/accum.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#define DESIGN_DEPTH 5
#define DESIGN_SIDE  16 /* pixels a side of the film */

/* What one run gives. Pictures are pooled to a mean, so that float rounding (1e-7) is all
 * that the figures lose. */
enum figure {
    FIGURE_FILM,    /* luminance, mean over the film */
    FIGURE_B,       /* b of the statistics */
    FIGURE_FILM_B,  /* their ratio: 1, and much of the noise is common to both */
    FIGURE_RED,     /* mean over the film */
    FIGURE_BLUE,    /* the same */
    FIGURE_QUARTER, /* 4: luminance of a quarter of the film over b */
    FIGURE_LENGTH = FIGURE_QUARTER + 4, /* b of paths of 1, 2, ... edges; multiplexed */
    FIGURES = FIGURE_LENGTH + DESIGN_DEPTH
};

static const char *const figure_names[FIGURES] = {
    "film",      "b",         "film/b", "red",     "blue",    "quarter 1", "quarter 2",
    "quarter 3", "quarter 4", "1 edge", "2 edges", "3 edges", "4 edges",   "5 edges"};

struct truth {
    double value[FIGURES], se[FIGURES];
};

struct figures {
    struct welford of[FIGURES]; /* over replicates; none where a design has no such */
};

static const struct design {
    const char *words[5];
    double cost; /* of a mutation or sample, in those of mmlt */
} designs[] = {
    {{"integrator=pt"}, 3.0},
    {{"integrator=bdpt"}, 3.0},
    {{"integrator=pssmlt"}, 3.0},
    {{"integrator=pssmlt", "estimator=plain", "large_step_probability=0.3"}, 3.0},
    {{"integrator=pssmlt", "kernel=gaussian", "large_step_probability=0.1"}, 3.0},
    {{"integrator=pssmlt", "builder=pt"}, 2.0},
    {{"integrator=pssmlt", "builder=pt", "estimator=plain", "large_step_probability=1"},
     2.0},
    {{"integrator=mmlt", "direct=joint"}, 1.0},
    {{"integrator=mmlt", "estimator=plain", "large_step_probability=0.3"}, 1.0},
    {{"integrator=mmlt", "kernel=gaussian", "per=length", "direct=joint"}, 1.0},
    {{"integrator=mmlt", "direct=separate"}, 1.0},
    {{"integrator=mmlt", "allocation=brightness"}, 1.0},
    {{"integrator=pfmlt", "direct=joint"}, 1.0},
    {{"integrator=pfmlt", "mode=counted", "per=length"}, 1.0},
    {{"integrator=pfmlt", "direct=separate", "estimator=plain"}, 1.0},
    {{"integrator=rjmlt", "direct=joint", "jump_probability=0.5"}, 1.5},
    {{"integrator=rjmlt", "mode=exact", "jump_probability=0.3"}, 1.5},
    {{"integrator=pssmlt", "ceiling=1.2"}, 3.0},
    {{"integrator=mmlt", "direct=joint", "two_stage=true", "ceiling=2"}, 1.0},
    {{"integrator=smlt", "share_floor=1", "ceiling=1.1", "passes_share=0.3"}, 3.0},
    {{"integrator=smlt", "metropolis=mmlt", "share_floor=1", "ceiling=3",
      "passes_share=0.3"},
     2.0},
    {{"integrator=mlt", "direct=joint", "mutation_weights=measured"}, 1.0},
    {{"integrator=mlt", "direct=separate", "estimator=plain", "deletion=weighted"}, 1.0},
    /* VARIANTS */
    {{"integrator=smlt", "builder=pt", "share_floor=0.2", "ceiling=none",
      "passes_share=0.6"},
     2.0},
    {{"integrator=smlt", "share_floor=1", "ceiling=10", "passes_share=0.4",
      "bootstrap=2"},
     3.0},
    {{"integrator=smlt", "estimator=plain", "share_floor=3", "ceiling=2",
      "passes_share=0.5"},
     3.0},
    {{"integrator=smlt", "metropolis=mmlt", "share_floor=0.3", "ceiling=none",
      "passes_share=0.3"},
     2.0},
};

#define DESIGNS ((int)(sizeof designs / sizeof designs[0]))

/* The last designs are further splits. Tests whose truth is not exact take them in their
 * long form, as test_integrator_smlt.c looks at splits pixel by pixel. */
#define VARIANTS 4

static inline bool design_over_pt(const struct design *design)
{
    for (int i = 0; i < 5 && design->words[i]; i++)
        if (!strcmp(design->words[i], "builder=pt") ||
            !strcmp(design->words[i], "integrator=pt"))
            return true;
    return false;
}

static inline void figures_add_run(struct figures *f, const struct run_result *r)
{
    const struct run_statistics *s = &r->statistics;
    double quarter[4] = {0.0}, half = DESIGN_SIDE / 2.0;
    struct rgb mean = test_image_mean(r->image);
    for (int i = 0; i < DESIGN_SIDE * DESIGN_SIDE; i++) {
        const float *v = r->image->pixels + 3 * i;
        bool right = i % DESIGN_SIDE >= half, low = i / DESIGN_SIDE >= half;
        quarter[2 * low + right] += rgb_luminance(
            rgb((double)v[0], (double)v[1], (double)v[2]));
    }
    welford_add(&f->of[FIGURE_FILM], rgb_luminance(mean));
    welford_add(&f->of[FIGURE_B], s->b);
    welford_add(&f->of[FIGURE_FILM_B], rgb_luminance(mean) / s->b);
    welford_add(&f->of[FIGURE_RED], mean.r);
    welford_add(&f->of[FIGURE_BLUE], mean.b);
    for (int i = 0; i < 4; i++)
        welford_add(&f->of[FIGURE_QUARTER + i], quarter[i] / (half * half) / s->b);
    /* Of a split they are means of targets, not of light. */
    for (int i = 0; i < s->length_count && !s->split.used; i++)
        welford_add(&f->of[FIGURE_LENGTH + s->lengths[i].length - 1], s->lengths[i].b);
}

/* `mutations` a pixel of mmlt, and as many of others as take that time; with ETALON_LONG
 * four times that, which sees half as much. */
static inline struct figures design_run(const struct scene *scene,
                                        const struct design *design, int replicates,
                                        double mutations)
{
    char depth[32], budget[64];
    const char *words[9] = {depth, budget, "bootstrap=4000"};
    struct figures figures = {0};
    snprintf(depth, sizeof depth, "max_depth=%d", DESIGN_DEPTH);
    snprintf(budget, sizeof budget, "mutations_per_pixel=%.0f",
             ceil(mutations * (getenv("ETALON_LONG") ? 4.0 : 1.0) / design->cost));
    for (int i = 0; i < 5; i++)
        words[3 + i] = design->words[i];
    struct settings s = test_settings(words);
    for (int i = 0; i < replicates; i++) {
        s.seed = 100 + i;
        struct run_result r = test_run(scene, &s);
        if (r.statistics.nonfinite > 0.0 || r.statistics.saturated > 0.0)
            abort();
        figures_add_run(&figures, &r);
        run_result_deinit(&r);
    }
    return figures;
}

static inline void design_print(const char *scene, const struct design *design)
{
    printf("%s:", scene);
    for (int i = 0; i < 5 && design->words[i]; i++)
        printf(" %s", design->words[i]);
    printf(":");
}

/* Two-sided t-tests at `level` each. What a figure sees is the smallest relative bias
 * that fails the test in nine of ten runs of it: it is taken from the standard error
 * measured. Prints the worst figure; says on stderr which differ. *sees: of the film. */
static inline bool figures_agree(const char *what, const struct figures *figures,
                                 const struct truth *truth, double level, double *sees)
{
    double worst = 0.0, least[FIGURES];
    int worst_figure = 0;
    bool ok = true;
    for (int i = 0; i < FIGURES; i++) {
        const struct welford *w = &figures->of[i];
        double value = truth->value[i], rounding = 1e-7 * value;
        least[i] = (double)NAN;
        if (w->count < 2.0)
            continue;
        double se = hypot(hypot(welford_se(w), truth->se[i]), rounding);
        double t = (w->mean - value) / se, freedom = w->count - 1.0;
        double critical = gsl_cdf_tdist_Qinv(0.5 * level, freedom) +
                          gsl_cdf_tdist_Qinv(0.1, freedom);
        least[i] = critical * se / value;
        if (fabs(t) > fabs(worst)) {
            worst = t;
            worst_figure = i;
        }
        char line[160];
        snprintf(line, sizeof line, "%s, %s, %.6g +- %.2g for %.6g, t %.2f", what,
                 figure_names[i], w->mean, se, value, t);
        ok = stat_ok(line, stat_t_p(t, freedom), level) && ok;
    }
    *sees = fmin(least[FIGURE_FILM], least[FIGURE_FILM_B]);
    printf(" worst t %.2f (%s); sees %.2f %% of film, %.2f %% of film/b, %.2f %% of b",
           worst, figure_names[worst_figure], 100.0 * least[FIGURE_FILM],
           100.0 * least[FIGURE_FILM_B], 100.0 * least[FIGURE_B]);
    if (figures->of[FIGURE_LENGTH + 2].count > 0.0)
        printf(", %.2f %% of b of 3 edges", 100.0 * least[FIGURE_LENGTH + 2]);
    printf("\n");
    return ok;
}

#endif
