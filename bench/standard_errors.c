/* Standard errors of statistics against their spread over seeds.
 *
 *   standard_errors SCENE SEEDS LABEL key=value ...
 *
 * A row for every figure, apart by commas: label; figure; its mean over runs, standard
 * deviation, mean standard error, and the ratio of these two; the same ratio of the runs
 * alone that say of themselves that they can be trusted, and how many these are; runs
 * whose 99 % interval holds the mean of all (of p_l, whose own interval does); ok, or
 * what explains a ratio outside [.8, 1.25]; for figures that hang on p_l runs whose rule
 * was unsure, and the reason that the first of these gives:
 *
 *   few seeds, heavy b   some run said so of itself (seeds_few, b_trusted)
 *   chance               so many standard deviations of normal figures spread so far
 *   p_l unsure           some run cannot tell which branch of the rule holds: its error
 *                        of p_l is a bound, reached where both are as likely
 *   constant             the rule gives a constant
 *   FAIL                 none of these; the exit status is 1 then */

#include "program.h"

#include "math/accum.h"
#include "math/law.h"
#include "math/student.h"

#include <math.h>
#include <stddef.h>

#define SEEDS_MOST 1000
#define LEVEL      0.999 /* of chance, in one cell */

struct figure {
    const char *name;
    size_t value, se, freedom;
};

#define AT(field) offsetof(struct run_statistics, field)
#define FIGURE(name, field)                                  \
    {                                                        \
        name, AT(field), AT(field##_se), AT(field##_freedom) \
    }

static const struct figure figures[] = {
    FIGURE("eta_s", start.eta_s),
    FIGURE("eta_l", start.eta_l),
    FIGURE("eta_0", start.eta_0),
    FIGURE("r", start.r),
    FIGURE("p_l", plarge.p_l),
    FIGURE("acceptance_start", start.acceptance),
    FIGURE("failure_rate_start", start.failure_rate),
    FIGURE("eta_s_run", whole.eta_s),
    FIGURE("eta_l_run", whole.eta_l),
    FIGURE("eta_0_run", whole.eta_0),
    FIGURE("r_run", whole.r),
    FIGURE("b", b),
    FIGURE("acceptance", whole.acceptance),
    FIGURE("failure_rate", whole.failure_rate),
};

#define FIGURES ((int)(sizeof figures / sizeof figures[0]))

/* What a run says of a figure. */
struct saying {
    double value, se, freedom;
};

struct runs {
    long count;
    struct saying says[FIGURES][SEEDS_MOST];
    bool few[SEEDS_MOST], heavy[SEEDS_MOST], unsure[SEEDS_MOST];
    double p_lo[SEEDS_MOST], p_hi[SEEDS_MOST]; /* interval of p_l */
    char reason[sizeof((struct plarge *)NULL)->reason];
};

static double at(const struct run_statistics *s, size_t offset)
{
    return *(const double *)((const char *)s + offset);
}

static void note(struct runs *runs, const struct run_statistics *s)
{
    long i = runs->count++;
    for (int f = 0; f < FIGURES; f++)
        runs->says[f][i] = (struct saying){at(s, figures[f].value), at(s, figures[f].se),
                                           at(s, figures[f].freedom)};
    runs->few[i] = s->seeds_few;
    runs->heavy[i] = !s->b_trusted;
    runs->unsure[i] = s->plarge.unsure;
    runs->p_lo[i] = s->plarge.p_l_lo;
    runs->p_hi[i] = s->plarge.p_l_hi;
    if (s->plarge.unsure && runs->reason[0] == '\0')
        snprintf(runs->reason, sizeof runs->reason, "%s", s->plarge.reason);
}

struct summary {
    struct welford value;
    double se; /* mean */
    long held;
};

static bool is_p_l(int f)
{
    return figures[f].value == AT(plarge.p_l);
}

/* p_l alone, and what it mixes in the whole run. */
static bool hangs_on_p_l(int f)
{
    return is_p_l(f) || figures[f].value == AT(whole.acceptance) ||
           figures[f].value == AT(whole.failure_rate);
}

static bool counts(const struct runs *runs, long i, bool trusted)
{
    return !(trusted && (runs->few[i] || runs->heavy[i]));
}

/* Whether a run's 99 % interval holds the mean of all. */
static bool holds(const struct runs *runs, int f, long i, double mean)
{
    struct saying s = runs->says[f][i];
    double t = student_quantile(0.5 * (1.0 + 0.99), fmax(s.freedom, 1.0));
    if (is_p_l(f))
        return mean >= runs->p_lo[i] - 1e-12 && mean <= runs->p_hi[i] + 1e-12;
    return fabs(s.value - mean) <= t * s.se + 1e-12;
}

static struct summary summarize(const struct runs *runs, int f, bool trusted)
{
    struct summary s = {0};
    for (long i = 0; i < runs->count; i++) {
        if (!counts(runs, i, trusted))
            continue;
        welford_add(&s.value, runs->says[f][i].value);
        s.se += runs->says[f][i].se;
    }
    s.se /= s.value.count;
    for (long i = 0; i < runs->count; i++)
        s.held += counts(runs, i, trusted) && holds(runs, f, i, s.value.mean);
    return s;
}

static bool within(double ratio)
{
    return ratio >= 0.8 && ratio <= 1.25;
}

/* Standard deviation of log sd over n normal figures. */
static bool by_chance(double ratio, double n)
{
    double reach = law_normal_quantile(0.5 + 0.5 * LEVEL) / sqrt(2.0 * (n - 1.0));
    return fabs(log(ratio)) <= reach;
}

static long count_unsure(const struct runs *runs)
{
    long unsure = 0;
    for (long i = 0; i < runs->count; i++)
        unsure += runs->unsure[i];
    return unsure;
}

static const char *judge(const struct runs *runs, double ratio, int f)
{
    long few = 0, heavy = 0;
    for (long i = 0; i < runs->count; i++) {
        few += runs->few[i];
        heavy += runs->heavy[i];
    }
    if (within(ratio))
        return "ok";
    if (isnan(ratio))
        return "constant";
    if (by_chance(ratio, (double)runs->count))
        return "chance";
    if (hangs_on_p_l(f) && count_unsure(runs) > 0)
        return "p_l unsure";
    return few > 0 && heavy > 0 ? "few seeds; heavy b"
           : few > 0            ? "few seeds"
           : heavy > 0          ? "heavy b"
                                : "FAIL";
}

static bool print_rows(const struct runs *runs, const char *label)
{
    bool good = true;
    for (int f = 0; f < FIGURES; f++) {
        struct summary all = summarize(runs, f, false), sure = summarize(runs, f, true);
        double sd = sqrt(welford_variance(&all.value)), ratio = sd / all.se;
        const char *word = judge(runs, ratio, f);
        printf("%s,%s,%.6g,%.3g,%.3g,%.3f,%.3f,%.0f,%ld,%s,", label, figures[f].name,
               all.value.mean, sd, all.se, ratio,
               sqrt(welford_variance(&sure.value)) / sure.se, sure.value.count, all.held,
               word);
        if (hangs_on_p_l(f))
            printf("%ld,\"%s\"\n", count_unsure(runs), runs->reason);
        else
            printf("0,\n");
        good = good && strcmp(word, "FAIL") != 0;
    }
    fflush(stdout);
    return good;
}

int main(int argc, char **argv)
{
    static struct runs runs;
    struct settings settings;
    long seeds = argc > 3 ? strtol(argv[2], NULL, 10) : 0;
    if (seeds < 2 || seeds > SEEDS_MOST) {
        fprintf(stderr, "usage: standard_errors SCENE SEEDS LABEL [key=value ...]\n");
        return 2;
    }
    settings_init(&settings);
    for (int i = 4; i < argc; i++)
        program_set(&settings, argv[i]);
    struct scene *scene = program_open_scene(argv[1], &settings);
    for (long i = 0; i < seeds; i++, settings.seed++) {
        struct run_result r = program_render(scene, &settings);
        note(&runs, &r.statistics);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
    return print_rows(&runs, argv[3]) ? 0 : 1;
}
