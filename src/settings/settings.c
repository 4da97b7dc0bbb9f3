#include "settings/settings.h"

#include "base/mem.h"
#include "base/par.h"
#include "base/text.h"
#include "settings/setting.h"

const char *settings_mode(const struct settings *s)
{
    if (s->mode)
        return s->mode;
    return text_equal(s->integrator, "rjmlt") ? "counted" : "exact";
}

static bool has_mode(const struct settings *s, const char *mode)
{
    return settings_uses(s, "mode") && text_equal(settings_mode(s), mode);
}

const char *settings_rule(const struct settings *s)
{
    return s->rule ? s->rule : has_mode(s, "paper") ? "zsolnai2013" : "tours";
}

const struct kernel_type *settings_kernel(const struct settings *s)
{
    if (s->kernel)
        return kernel_find(s->kernel);
    bool gaussian = text_equal(s->integrator, "pfmlt") || has_mode(s, "exact") ||
                    has_mode(s, "paper");
    return gaussian ? &kernel_gaussian : &kernel_exponential;
}

/* The best width of small steps falls with the number of pixels: the largest step moves a
 * path some four pixels far, from 64x40 to 960x600 (results/zsolnai13-table1, "Width of
 * small steps"). The published rule comes with the widths of [Kelemen02]. */
#define STEP_PIXELS 4.0
#define STEP_LEAST  (1.0 / 256.0)
#define STEP_MOST   (1.0 / 8.0)

static double auto_step(const struct settings *s, double pixels)
{
    if (text_equal(settings_rule(s), "zsolnai2013"))
        return KERNEL_S2;
    return fmin(fmax(STEP_PIXELS / sqrt(pixels), STEP_LEAST), STEP_MOST);
}

double settings_sigma(const struct settings *s, double pixels)
{
    double over_step = KERNEL_SIGMA / KERNEL_S2;
    return s->sigma > 0.0 ? s->sigma : over_step * auto_step(s, pixels);
}

double settings_s2(const struct settings *s, double pixels)
{
    return s->s2 > 0.0 ? s->s2 : auto_step(s, pixels);
}

enum estimator settings_estimator(const struct settings *s)
{
    bool plain = s->estimator ? text_equal(s->estimator, "plain") : has_mode(s, "paper");
    return plain ? ESTIMATOR_PLAIN : ESTIMATOR_KELEMEN;
}

enum film_sampling settings_film_sampling(const struct settings *s)
{
    if (s->film_sampling != FILM_SAMPLING_DEFAULT)
        return s->film_sampling;
    return text_equal(s->integrator, "auto") ? FILM_SAMPLING_ADAPTIVE
                                             : FILM_SAMPLING_UNIFORM;
}

static bool is_smlt(const struct settings *s)
{
    return text_equal(s->integrator, "smlt");
}

double settings_ceiling(const struct settings *s)
{
    double given = settings_uses(s, "ceiling") ? s->ceiling : (double)INFINITY;
    return given != 0.0 ? given : is_smlt(s) ? (double)NAN : (double)INFINITY;
}

bool settings_splits(const struct settings *s)
{
    return is_smlt(s) || !(settings_ceiling(s) == (double)INFINITY) ||
           (s->two_stage && settings_uses(s, "two_stage"));
}

bool settings_multiplexed(const struct settings *s)
{
    return is_smlt(s) && text_equal(s->metropolis, "mmlt");
}

/* Mutations per pixel at which two passes are a quarter of the budget. */
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

/* The integrator has none of these layers. */
static bool refuse_layers(const struct settings *s, long layers, const char *why,
                          struct err *err)
{
    struct settings one = {.layers = layers};
    struct text names = {0};
    setting_print(settings_find("layers"), &one, &names);
    err_set(err, ERR_USAGE, NULL, "layers=%s: %s %s", names.data, s->integrator, why);
    mem_free(names.data);
    return false;
}

long settings_layers_lacking(const struct settings *s)
{
    long lacking = settings_uses(s, "chains") ? LAYER_UNWEIGHTED
                                              : LAYER_ACCEPTANCE | LAYER_VISITS;
    if (text_equal(s->integrator, "mlt"))
        lacking |= LAYER_LENGTHS | LAYER_TECHNIQUES;
    return text_equal(s->integrator, "auto") ? 0 : s->layers & lacking;
}

static bool check_layers(const struct settings *s, struct err *err)
{
    long lacking = settings_layers_lacking(s);
    if (lacking == 0)
        return true;
    const char *why = "samples paths in proportion to their weighted light, so that the "
                      "unweighted one would have an unbounded variance; pt and bdpt have "
                      "it";
    if (!settings_uses(s, "chains"))
        why = "has no chains";
    else if (text_equal(s->integrator, "mlt"))
        why = "does not sample paths by techniques";
    return refuse_layers(s, lacking, why, err);
}

bool settings_check(const struct settings *s, struct err *err)
{
    if (s->p_large == 0.0 && !s->allow_zero)
        return err_set(err, ERR_USAGE, NULL,
                       "large_step_probability: 0 leaves a chain where it starts; give a "
                       "number in (0,1], or set allow_zero=true");
    double least_s2 = settings_s2(s, HUGE_VAL);
    if (!(s->s1 < least_s2))
        return err_set(err, ERR_USAGE, NULL, "s1 (%g) must be less than s2 (%g%s)", s->s1,
                       least_s2, s->s2 > 0.0 ? "" : " in large pictures");
    if (has_mode(s, "exact") && !settings_kernel(s)->log_density)
        return err_set(err, ERR_USAGE, NULL,
                       "%s in mode exact needs a kernel whose density is known: "
                       "kernel=gaussian, not %s",
                       s->integrator, settings_kernel(s)->name);
    if (has_mode(s, "paper") && settings_estimator(s) != ESTIMATOR_PLAIN)
        return err_set(err, ERR_USAGE, NULL,
                       "%s in mode paper knows no weights for large steps: "
                       "estimator=plain, not kelemen",
                       s->integrator);
    if (settings_auto(s) && text_equal(settings_rule(s), "tours") && has_mode(s, "paper"))
        return err_set(err, ERR_USAGE, NULL,
                       "rule=tours predicts the error of chains whose proposals all "
                       "count as states; %s in mode paper needs rule=zsolnai2013",
                       s->integrator);
    if (s->direct == DIRECT_SEPARATE && !has_time_for_passes(s))
        return err_set(
            err, ERR_USAGE, NULL,
            "direct=separate takes two plain samples a pixel, a quarter of all "
            "paths: give 8 mutations per pixel or more, or direct=joint");
    if (settings_multiplexed(s) && !text_equal(s->builder, "bdpt"))
        return err_set(err, ERR_USAGE, NULL,
                       "smlt with metropolis=mmlt wants passes of the same techniques: "
                       "builder=bdpt, not %s",
                       s->builder);
    if (!is_smlt(s) && !(settings_ceiling(s) == (double)INFINITY) &&
        settings_estimator(s) == ESTIMATOR_PLAIN)
        return err_set(err, ERR_USAGE, NULL,
                       "what is above the ceiling is estimated by large steps: "
                       "estimator=kelemen, not plain");
    if (is_smlt(s) && !has_time_for_passes(s))
        return err_set(err, ERR_USAGE, NULL,
                       "smlt takes two independent samples a pixel: give 8 mutations "
                       "per pixel or more");
    if (settings_until(s) && (s->replicas == 1 || has_mode(s, "paper")))
        return err_set(err, ERR_USAGE, NULL,
                       "until_converged and until_relmse need error bars, which %s does "
                       "without",
                       s->replicas == 1 ? "replicas=1" : "mode paper");
    if (!check_layers(s, err))
        return false;
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

/* For other integrators `direct` has no effect. Its default depends on the budget, so
 * resolving it would bind a checkpoint to the budget. */
static enum direct resolve_direct(const struct settings *s, int max_depth)
{
    if (!settings_uses(s, "direct"))
        return DIRECT_DEFAULT;
    return settings_plain_lengths(s, max_depth) > 0 ? DIRECT_SEPARATE : DIRECT_JOINT;
}

struct settings settings_resolve(const struct settings *s, const struct scene *scene)
{
    struct settings resolved = *s;
    int depth = settings_depth(s, scene);
    bool kelemen = settings_estimator(s) == ESTIMATOR_KELEMEN;
    resolved.rule = settings_rule(s);
    resolved.mode = settings_mode(s);
    resolved.kernel = settings_kernel(s)->name;
    double pixels = (double)scene->camera.width * scene->camera.height;
    resolved.sigma = settings_sigma(s, pixels);
    resolved.s2 = settings_s2(s, pixels);
    resolved.estimator = kelemen ? "kelemen" : "plain";
    resolved.direct = resolve_direct(s, depth);
    if (settings_uses(s, "film_sampling"))
        resolved.film_sampling = settings_film_sampling(s);
    if (settings_uses(s, "ceiling"))
        resolved.ceiling = settings_ceiling(s);
    resolved.max_depth = depth;
    resolved.width = scene->camera.width;
    resolved.height = scene->camera.height;
    resolved.compact = accel_is_compact(scene->accel) ? ACCEL_COMPACT : ACCEL_FULL;
    return resolved;
}

bool settings_uses(const struct settings *settings, const char *key)
{
    const struct setting *setting = settings_find(key);
    return setting && setting_used(setting, settings);
}

int settings_threads(const struct settings *settings)
{
    return par_threads(settings->threads);
}
