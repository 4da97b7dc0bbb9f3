#include "lab/reference_check.h"

#include "base/mem.h"
#include "base/text.h"
#include "image/exr.h"
#include "run/blind_spots.h"
#include "integrator/registry.h"

void provenance_deinit(struct provenance *provenance)
{
    mem_free(provenance->integrator);
    mem_free(provenance->estimator);
    mem_free(provenance->builder);
    *provenance = (struct provenance){0};
}

static bool read_number(const char *path, const char *name, long *value)
{
    char *text = exr_read_attribute(path, name);
    bool ok = text && text_to_long(text, value);
    mem_free(text);
    return ok;
}

static void read_own(const char *path, struct provenance *p)
{
    long seed;
    if (p->integrator == NULL)
        p->integrator = exr_read_attribute(path, "etalon:integrator");
    if (p->estimator == NULL)
        p->estimator = exr_read_attribute(path, "etalon:estimator");
    if (p->builder == NULL)
        p->builder = exr_read_attribute(path, "etalon:builder");
    if (p->max_depth == 0 && !read_number(path, "etalon:max_depth", &p->max_depth))
        p->max_depth = 0;
    if (p->seed_count < REFERENCE_HALVES && read_number(path, "etalon:seed", &seed))
        p->seeds[p->seed_count++] = seed;
}

void provenance_of_file(const char *path, struct provenance *provenance)
{
    static const char *const halves[] = {"etalon:mean_of", "etalon:mean_and"};
    char *folder = text_directory(path);
    read_own(path, provenance);
    for (int i = 0; i < 2; i++) {
        char *name = exr_read_attribute(path, halves[i]);
        char *half = name ? text_join(folder, name) : NULL;
        if (half)
            read_own(half, provenance);
        mem_free(half);
        mem_free(name);
    }
    mem_free(folder);
}

static const char *estimator_name(const struct settings *settings)
{
    if (!integrator_find(settings->integrator)->methods->chains)
        return "";
    return settings_estimator(settings) == ESTIMATOR_KELEMEN ? "kelemen" : "plain";
}

void provenance_of_request(const struct reference_request *request,
                           struct provenance *provenance)
{
    provenance->integrator = text_copy(request->settings.integrator);
    provenance->estimator = text_copy(estimator_name(&request->settings));
    provenance->builder = text_copy(request->settings.builder);
    for (int i = 0; i < REFERENCE_HALVES; i++)
        provenance->seeds[provenance->seed_count++] = REFERENCE_SEED + i;
}

/* --- what is refused ------------------------------------------------------------- */

/* pfmlt and rjmlt sample the same paths as mmlt; they differ in their treatment of
 * failures and in their moves. mlt has states and an evaluation of paths of its own. */
static const char *family(const char *integrator)
{
    bool same = text_equal(integrator, "pfmlt") || text_equal(integrator, "rjmlt");
    return same ? "mmlt" : integrator;
}

static const char *name_of(const struct job *job)
{
    return job->reference->kind == REFERENCE_FILE ? job->reference->given
                                                  : "to be rendered";
}

static bool check_method(const struct job *job, const struct settings *settings,
                         const struct provenance *p, struct err *err)
{
    const char *estimator = estimator_name(settings);
    if (p->integrator == NULL ||
        !text_equal(family(p->integrator), family(settings->integrator)) ||
        (p->estimator && !text_equal(p->estimator, estimator)))
        return true;
    return err_set(err, ERR_VALUE, &job->reference->at,
                   "the reference (%s) is of the method under test, %s%s%s, as '%s': an "
                   "error of the method would not show; take another, or --force",
                   name_of(job), p->integrator, estimator[0] ? " with estimator " : "",
                   estimator, job->name);
}

static bool check_seed(const struct job *job, const struct provenance *p, struct err *err)
{
    for (int i = 0; i < p->seed_count; i++)
        if (p->seeds[i] == job->seed)
            return err_set(err, ERR_VALUE, &job->reference->at,
                           "the reference (%s) has seed %ld, as '%s': their errors may "
                           "be correlated; take another seed, or --force",
                           name_of(job), job->seed, job->name);
    return true;
}

static bool check_depth(const struct job *job, int max_depth, const struct provenance *p,
                        struct err *err)
{
    if (p->max_depth == 0 || p->max_depth == max_depth)
        return true;
    return err_set(err, ERR_VALUE, &job->reference->at,
                   "the reference (%s) holds paths of up to %ld edges, the picture of "
                   "'%s' of up to %d; set max_depth, take another, or --force",
                   name_of(job), p->max_depth, job->name, max_depth);
}

/* A reference that lacks light is wrong for every method, also for one that lacks the
 * same light. */
static bool check_blind_spots(const struct job *job, int max_depth,
                              const struct scene_desc *desc, const struct provenance *p,
                              struct err *err)
{
    char blind_to[BLIND_TEXT], bdpt[BLIND_TEXT];
    struct settings made, best;
    settings_init(&made);
    settings_init(&best);
    if (p->integrator == NULL || integrator_find(p->integrator) == NULL)
        return true;
    made.integrator = p->integrator;
    made.builder = p->builder && p->builder[0] ? p->builder : made.builder;
    best.integrator = "bdpt";
    max_depth = p->max_depth > 0 ? (int)p->max_depth : max_depth;
    blind_spots(desc, &made, max_depth, blind_to);
    blind_spots(desc, &best, max_depth, bdpt);
    bool over_pt = settings_uses(&made, "builder") && text_equal(made.builder, "pt");
    return blind_to[0] == '\0' ||
           err_set(
               err, ERR_VALUE, &job->reference->at,
               "the reference (%s) is by %s%s, which is blind to light that the scene "
               "of '%s' may have: %s; %s, or --force",
               name_of(job), p->integrator, over_pt ? " over pt" : "", job->name,
               blind_to,
               text_equal(blind_to, bdpt) ? "no integrator samples it: give the "
                                            "lights an extent, take another"
                                          : "take another");
}

bool reference_check(const struct job *job, const struct settings *settings,
                     int max_depth, const struct scene_desc *desc,
                     const struct provenance *provenance, bool own_method,
                     struct err *err)
{
    return check_blind_spots(job, max_depth, desc, provenance, err) &&
           check_depth(job, max_depth, provenance, err) &&
           (own_method || check_method(job, settings, provenance, err)) &&
           check_seed(job, provenance, err);
}
