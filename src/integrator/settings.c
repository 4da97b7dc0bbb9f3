#include "integrator/settings.h"

#include "base/par.h"
#include "base/text.h"

void settings_init(struct settings *settings)
{
    *settings = (struct settings){
        .integrator = "pssmlt",
        .p_large = (double)NAN,
        .rule = "zsolnai2013",
        .mode = "exact",
        .builder = "bdpt",
        .chains = 256,
        .bootstrap = 100000,
        .start = 0.02,
        .start_cap = 0.2,
        .start_mutations = 64,
        .mutations_per_pixel = 64.0,
        .seed = 1,
        .replicas = 8,
    };
}

static bool is_pfmlt(const struct settings *s, const char *mode)
{
    return text_equal(s->integrator, "pfmlt") && (!mode || text_equal(s->mode, mode));
}

const struct kernel_type *settings_kernel(const struct settings *s)
{
    if (s->kernel)
        return s->kernel;
    return is_pfmlt(s, NULL) ? &kernel_gaussian : &kernel_exponential;
}

enum estimator settings_estimator(const struct settings *s)
{
    if (s->estimator_given)
        return s->estimator;
    return is_pfmlt(s, "paper") ? ESTIMATOR_PLAIN : ESTIMATOR_KELEMEN;
}

/* Two passes are a quarter of eight mutations a pixel. */
#define PLAIN_LEAST 8.0

static bool has_time_for_passes(const struct settings *s)
{
    return s->seconds > 0.0 || s->mutations_per_pixel >= PLAIN_LEAST;
}

int settings_plain_lengths(const struct settings *s, int max_depth)
{
    bool separate = s->direct == DIRECT_SEPARATE ||
                    (s->direct == DIRECT_DEFAULT && has_time_for_passes(s));
    int most = max_depth > 2 ? 2 : max_depth - 1; /* chains keep the last one */
    return separate ? most : 0;
}

bool settings_check(const struct settings *s, struct err *err)
{
    double s1 = s->s1 > 0.0 ? s->s1 : 1.0 / 1024.0, s2 = s->s2 > 0.0 ? s->s2 : 1.0 / 64.0;
    if (s->p_large == 0.0 && !s->allow_zero)
        return err_set(err, ERR_USAGE, NULL,
                       "large_step_probability: 0 leaves a chain where it starts; give a "
                       "number in (0,1], or set allow_zero=true");
    if (!(s1 < s2))
        return err_set(err, ERR_USAGE, NULL, "s1 (%g) must be less than s2 (%g)", s1, s2);
    if (is_pfmlt(s, "exact") && !settings_kernel(s)->log_density)
        return err_set(err, ERR_USAGE, NULL,
                       "pfmlt in mode exact needs a kernel whose density is known: "
                       "kernel=gaussian, not %s",
                       settings_kernel(s)->name);
    if (is_pfmlt(s, "paper") && settings_estimator(s) != ESTIMATOR_PLAIN)
        return err_set(err, ERR_USAGE, NULL,
                       "pfmlt in mode paper knows no weights for large steps: "
                       "estimator=plain, not kelemen");
    if (s->direct == DIRECT_SEPARATE && !has_time_for_passes(s))
        return err_set(
            err, ERR_USAGE, NULL,
            "direct=separate takes two plain samples a pixel, a quarter of all "
            "paths: give 8 mutations per pixel or more, or direct=joint");
    if (settings_until(s) && (s->replicas == 1 || is_pfmlt(s, "paper")))
        return err_set(err, ERR_USAGE, NULL,
                       "until_converged and until_relmse need error bars, which %s does "
                       "without",
                       s->replicas == 1 ? "replicas=1" : "pfmlt in mode paper");
    if (s->start > s->start_cap)
        return err_set(err, ERR_USAGE, NULL, "start (%g) must not exceed start_cap (%g)",
                       s->start, s->start_cap);
    return true;
}

int settings_depth_of(const struct settings *settings, int file_depth)
{
    if (settings->max_depth > 0)
        return (int)settings->max_depth;
    if (file_depth > 0)
        return file_depth < SETTINGS_MAX_DEPTH ? file_depth : SETTINGS_MAX_DEPTH;
    return SETTINGS_DEFAULT_DEPTH;
}

int settings_depth(const struct settings *settings, const struct scene *scene)
{
    return settings_depth_of(settings, scene->max_depth);
}

int settings_threads(const struct settings *settings)
{
    return settings->threads > 0 ? (int)settings->threads : par_threads_available();
}
