/* What is left when a part of a run is lost, and when parts made different numbers of
 * mutations, as under a time budget: as bright as the whole run on the mean over seeds,
 * pixel errors as the error bars say.
 *
 * Both are t-tests over SEEDS runs. The brightness is compared with that of the whole run
 * of the same seed. The squared error of a picture is that against the mean of the other
 * seeds' pictures, times (SEEDS - 1) / SEEDS, which has the variance of the picture as
 * its mean.
 *
 * Error bars of unequal parts may be too wide and are tested for being too narrow alone:
 * they weigh chains alike, and the films of single lengths weigh them by mutations.
 *
 * False alarms: FALSE_ALARM for all figures together. Power: a bias is seen nine times in
 * ten from SEES_LIGHT of the brightness, and error bars from SEES_ERROR of the squared
 * error; both are asserted from the standard errors found. Seen to fail: films divided as
 * if the start of lost chains, and of parts that are scaled up, were not in them (four
 * figures of light, 2.8 to 3.9 % too bright, by 4.9 to 5.4 sigmas with 24 seeds). */

#include "math/accum.h"
#include "support/stat_test.h"
#include "support/test_parts.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-3
#define SEES_LIGHT  0.06
#define SEES_ERROR  1.3

enum { SEEDS = 32, PARTS = 4, SIZE = 8, PIXELS = SIZE * SIZE };

#define CHAINS \
    "max_depth=5", "chains=64", "bootstrap=4000", "start_mutations=20", "rule=zsolnai2013"

static const char *const designs[][10] = {
    {"integrator=pssmlt", CHAINS},
    {"integrator=mmlt", CHAINS, "direct=separate"},
    {"integrator=mmlt", CHAINS, "direct=joint", "estimator=plain",
     "allocation=brightness"},
    {"integrator=pfmlt", CHAINS, "direct=joint"},
    {"integrator=bdpt", "max_depth=5"},
};

#define DESIGNS ((int)(sizeof designs / sizeof *designs))
#define LEVEL   stat_sidak(FALSE_ALARM, 4 * DESIGNS)

/* The pictures of all seeds, and what their error bars claim. */
struct sample {
    double y[SEEDS][PIXELS], light[SEEDS], claimed[SEEDS], paths;
};

static void take(struct sample *to, int seed, struct run_result *r)
{
    assert_non_null(r->verdict.se);
    to->light[seed] = to->claimed[seed] = 0.0;
    for (int i = 0; i < PIXELS; i++) {
        double se = (double)r->verdict.se[i];
        to->y[seed][i] = rgb_luminance(image_pixel(r->image, i));
        to->light[seed] += to->y[seed][i] / PIXELS;
        to->claimed[seed] += se * se / PIXELS;
    }
    to->paths += r->statistics.paths / SEEDS;
    run_result_deinit(r);
}

static double squared_error(const struct sample *s, int seed)
{
    double sum = 0.0;
    for (int i = 0; i < PIXELS; i++) {
        double others = 0.0;
        for (int j = 0; j < SEEDS; j++)
            others += j == seed ? 0.0 : s->y[j][i] / (SEEDS - 1);
        sum += pow(s->y[seed][i] - others, 2.0) / PIXELS;
    }
    return sum * (SEEDS - 1) / SEEDS;
}

/* Whether the mean of d is 0, and known well enough to see a difference of `sees`. */
static bool is_zero(const char *what, const struct welford *d, double unit, double sees,
                    bool may_exceed)
{
    double se = welford_se(d), seen = stat_t_seen(LEVEL, SEEDS - 1.0, 0.9) * se / unit;
    printf("    %-10s %+.3f +- %.3f, seen from %.3f\n", what, d->mean / unit, se / unit,
           seen);
    double p = may_exceed && d->mean > 0.0 ? 1.0 : stat_t_p(d->mean / se, SEEDS - 1.0);
    return stat_ok(what, p, LEVEL) && seen < sees;
}

static bool check(const char *name, const struct sample *some, const struct sample *all,
                  bool wide)
{
    struct welford light = {0}, error = {0}, real = {0}, whole = {0}, real_all = {0};
    for (int s = 0; s < SEEDS; s++) {
        double squares = squared_error(some, s);
        welford_add(&light, some->light[s] - all->light[s]);
        welford_add(&error, some->claimed[s] - squares);
        welford_add(&real, squares);
        welford_add(&whole, all->light[s]);
        welford_add(&real_all, squared_error(all, s));
    }
    printf("  %s: %.3f of the paths, squared error %.3g times the whole run's\n", name,
           some->paths / all->paths, real.mean / real_all.mean);
    bool bright = is_zero("light", &light, whole.mean, SEES_LIGHT, false);
    return is_zero("error bars", &error, real.mean, SEES_ERROR, wide) && bright;
}

/* Budgets of 1, 2, 3 and 4 quarters of the whole run's, from one start. */
static struct run_result unequal(struct job *job, char *files[PARTS_TESTED], bool chains)
{
    char *start = chains ? file_name("start", 0) : NULL;
    double budget = job->settings.mutations_per_pixel;
    if (start)
        save_start(job, start);
    for (int i = 0; i < PARTS; i++) {
        job->settings.mutations_per_pixel = budget * (i + 1) / PARTS;
        run_part(job, i, start, files[i], 0.0);
    }
    job->settings.mutations_per_pixel = budget;
    if (start)
        remove(start);
    mem_free(start);
    return merge(job, files, 0);
}

static void one_seed(struct job *job, int seed, bool chains, struct sample samples[3])
{
    char *files[PARTS_TESTED];
    job->settings.seed = seed + 1;
    run_parts(job, files);
    struct run_result r = merge(job, files, 0);
    take(&samples[0], seed, &r);
    r = merge(job, files, 1 << 1);
    take(&samples[1], seed, &r);
    r = unequal(job, files, chains);
    take(&samples[2], seed, &r);
    remove_parts(job, files);
}

static struct scene *make_scene(void)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, SIZE);
    test_room(desc);
    test_lamp(desc, 0.35, rgb(12.0, 10.0, 8.0));
    test_sphere(desc, vec3(-0.45f, 0.45f, -0.3f), 0.4, test_diffuse(desc, 0.3, 0.4, 0.7),
                rgb_grey(0.0), false);
    return test_build(desc, false);
}

static void test_brightness_and_errors(void **state)
{
    (void)state;
    struct scene *scene = make_scene();
    bool ok = true;
    for (int i = 0; i < DESIGNS; i++) {
        struct sample *samples = mem_alloc(3, sizeof *samples);
        struct job job = job_of(scene, designs[i]);
        bool chains = i + 1 < DESIGNS;
        job.settings.mutations_per_pixel = 320.0;
        job.count = PARTS;
        printf("%s\n", designs[i][0]);
        for (int s = 0; s < SEEDS; s++)
            one_seed(&job, s, chains, samples);
        ok = check("a part is lost", &samples[1], &samples[0], false) && ok;
        ok = check("unequal parts", &samples[2], &samples[0], true) && ok;
        identity_deinit(&job.identity);
        mem_free(samples);
    }
    scene_destroy(scene);
    assert_true(ok);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_brightness_and_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
