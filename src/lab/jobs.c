#include "lab/jobs.h"

#include "base/mem.h"
#include "base/text.h"
#include "lab/fingerprint.h"
#include "lab/product.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>

/* Raised when the contents of an id, or what a job does for the same contents, change. */
#define ID_VERSION 1

/* --- names ----------------------------------------------------------------------- */

static const char *short_key(const char *key)
{
    if (text_equal(key, "large_step_probability"))
        return "p_l";
    return text_equal(key, "mutations_per_pixel") ? "mpp" : key;
}

static void append_setting(struct text *label, const struct choice *choice)
{
    const char *blank = label->length ? " " : "";
    if (text_equal(choice->key, "integrator"))
        text_append(label, "%s%s", blank, choice->value);
    else
        text_append(label, "%s%s=%s", blank, short_key(choice->key), choice->value);
}

/* The label: what distinguishes jobs of one scene, except budgets: a variant's own
 * settings, unless its label stands for them, and all other settings with several
 * choices. */
static char *make_label(const struct product *product,
                        const struct experiment_variant *variant)
{
    struct text label = {0};
    if (variant->label)
        text_append(&label, "%s", variant->label);
    for (size_t i = 0; i < product->count; i++) {
        const struct axis *axis = product->axes[i];
        bool own = axes_find(&variant->axes, axis->name) == axis;
        if (!text_equal(axis->name, "budget") &&
            (axis->count > 1 || (own && variant->label == NULL)))
            append_setting(&label, product_taken(product, i));
    }
    return label.data;
}

static char *make_name(const struct job *job)
{
    const char *seconds = job_value(job, "seconds");
    const char *mutations = job_value(job, "mutations_per_pixel");
    struct text name = {0};
    text_append(&name, "%s %s", job->scene->label, job->label);
    if (seconds)
        text_append(&name, " %ss", seconds);
    if (mutations)
        text_append(&name, " mpp=%s", mutations);
    text_append(&name, " seed=%ld", job->seed);
    return name.data;
}

/* --- ids ------------------------------------------------------------------------- */

static void hash_value(struct hash *hash, const char *value)
{
    double number;
    if (text_to_double(value, &number)) {
        char *digits = text_format("%.17g", number);
        hash_text(hash, digits);
        mem_free(digits);
    } else {
        hash_text(hash, value);
    }
}

static bool hash_reference(struct hash *hash, const struct reference_spec *spec,
                           struct err *err)
{
    hash_number(hash, (uint64_t)spec->kind);
    if (spec->kind == REFERENCE_FILE)
        return fingerprint_file(spec->file, &spec->at, hash, err);
    for (size_t i = 0; i < spec->settings.count; i++) {
        hash_text(hash, spec->settings.items[i].choices[0].key);
        hash_value(hash, spec->settings.items[i].choices[0].value);
    }
    return true;
}

static void hash_choices(struct hash *hash, const struct job *job)
{
    for (size_t i = 0; i < job->choice_count; i++) {
        hash_text(hash, job->choices[i].key);
        hash_value(hash, job->choices[i].value);
    }
}

static bool make_id(struct job *job, struct err *err)
{
    struct hash hash;
    hash_init(&hash);
    hash_number(&hash, ID_VERSION);
    hash_text(&hash, job->scene->given);
    hash_number(&hash, job->scene_fingerprint);
    hash_number(&hash, (uint64_t)job->seed);
    hash_choices(&hash, job);
    bool ok = hash_reference(&hash, job->reference, err);
    hash_digits(&hash, job->id);
    return ok;
}

/* Hashes contents only, so that cells are the same wherever the experiment file lies. */
static bool make_cell(struct job *job, struct err *err)
{
    struct hash hash;
    hash_init(&hash);
    hash_number(&hash, ID_VERSION);
    hash_number(&hash, job->scene_fingerprint);
    hash_choices(&hash, job);
    bool ok = hash_reference(&hash, job->reference, err);
    hash_digits(&hash, job->cell);
    return ok;
}

/* --- making them ----------------------------------------------------------------- */

static int compare_keys(const void *a, const void *b)
{
    const struct choice *x = a, *y = b;
    return strcmp(x->key, y->key);
}

static void take_choices(struct job *job, const struct product *product)
{
    job->choice_count = product->count;
    job->choices = mem_alloc(product->count, sizeof *job->choices);
    for (size_t i = 0; i < product->count; i++)
        job->choices[i] = *product_taken(product, i);
    qsort(job->choices, job->choice_count, sizeof *job->choices, compare_keys);
}

static const struct reference_spec *reference_of(const struct experiment *e,
                                                 const struct experiment_scene *scene)
{
    return scene->reference.kind == REFERENCE_UNSET ? &e->reference : &scene->reference;
}

static bool add_job(struct jobs *jobs, const struct experiment *e,
                    const struct experiment_scene *scene,
                    const struct experiment_variant *variant,
                    const struct product *product, struct err *err)
{
    jobs->items = mem_grow(jobs->items, &jobs->capacity, jobs->count + 1,
                           sizeof *jobs->items);
    struct job *job = &jobs->items[jobs->count++];
    struct settings settings;
    *job = (struct job){.scene = scene, .reference = reference_of(e, scene)};
    take_choices(job, product);
    job->label = make_label(product, variant);
    settings_init(&settings);
    return job_settings(job, &settings, err);
}

/* Counts before any job is made: a short file can ask for more than memory holds. */
static bool check_count(const struct jobs *jobs, const struct experiment *e,
                        const struct product *product, struct err *err)
{
    size_t most = JOBS_MAX / e->seed_count;
    return jobs->count + product_size(product, most) <= most ||
           err_set(err, ERR_VALUE, &e->at, "the experiment has more than %d jobs",
                   JOBS_MAX);
}

static bool add_scene(struct jobs *jobs, const struct experiment *e,
                      const struct experiment_scene *scene, struct err *err)
{
    bool ok = true;
    for (size_t v = 0; ok && v < e->variant_count; v++) {
        struct product product;
        product_init(&product, e, scene, &e->variants[v]);
        ok = check_count(jobs, e, &product, err);
        for (bool more = ok; more; more = ok && product_next(&product))
            ok = add_job(jobs, e, scene, &e->variants[v], &product, err);
        product_deinit(&product);
    }
    return ok;
}

bool job_settings(const struct job *job, struct settings *settings, struct err *err)
{
    struct err inner = {0};
    for (size_t i = 0; i < job->choice_count; i++) {
        const struct choice *c = &job->choices[i];
        if (!settings_set(settings, c->key, c->value, &c->at, err))
            return false;
    }
    settings->seed = job->seed;
    return settings_check(settings, &inner) ||
           err_set(err, inner.code, &job->scene->at, "%s %s: %s", job->scene->label,
                   job->label, inner.message);
}

const char *job_value(const struct job *job, const char *key)
{
    for (size_t i = 0; i < job->choice_count; i++)
        if (text_equal(job->choices[i].key, key))
            return job->choices[i].value;
    return NULL;
}

bool job_matches(const struct job *job, const char *pattern)
{
    if (strpbrk(pattern, "*?["))
        return fnmatch(pattern, job->name, 0) == 0;
    return strstr(job->name, pattern) != NULL;
}

/* Jobs whose scene is built with the same options are put together, in the order of the
 * first of each. */
static bool built_alike(const struct job *a, const struct job *b)
{
    static const char *const keys[] = {"size", "keep_all", NULL};
    for (int i = 0; keys[i]; i++) {
        const char *x = job_value(a, keys[i]), *y = job_value(b, keys[i]);
        if (!text_equal(x ? x : "", y ? y : ""))
            return false;
    }
    return true;
}

static void group(struct job *jobs, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        struct job moved = jobs[i];
        size_t to = i;
        while (to > 0 && !built_alike(&jobs[to - 1], &moved))
            to--;
        to = to > 0 ? to : i; /* none before it is built alike: it stays */
        memmove(&jobs[to + 1], &jobs[to], (i - to) * sizeof *jobs);
        jobs[to] = moved;
    }
}

static bool make_prototypes(const struct experiment *e, struct jobs *prototypes,
                            struct err *err)
{
    for (size_t s = 0; s < e->scene_count; s++) {
        const struct experiment_scene *scene = &e->scenes[s];
        size_t first = prototypes->count;
        struct hash hash;
        if (!add_scene(prototypes, e, scene, err) ||
            !fingerprint_scene(scene->path, &scene->at, &hash, err))
            return false;
        for (size_t i = first; i < prototypes->count; i++) {
            prototypes->items[i].scene_fingerprint = hash.value;
            if (!make_cell(&prototypes->items[i], err))
                return false;
        }
        group(&prototypes->items[first], prototypes->count - first);
    }
    return true;
}

static bool add_seeded(struct jobs *jobs, const struct job *prototype, long seed,
                       struct err *err)
{
    struct job *job = &jobs->items[jobs->count++];
    *job = *prototype;
    job->seed = seed;
    job->label = text_copy(prototype->label);
    job->choices = mem_alloc(job->choice_count, sizeof *job->choices);
    memcpy(job->choices, prototype->choices, job->choice_count * sizeof *job->choices);
    job->name = make_name(job);
    return make_id(job, err);
}

static int in_order(const struct job *a, const struct job *b)
{
    return (a > b) - (a < b); /* both point into one array */
}

static int compare_ids(const void *a, const void *b)
{
    const struct job *x = *(const struct job *const *)a;
    const struct job *y = *(const struct job *const *)b;
    int order = strcmp(x->id, y->id);
    return order ? order : in_order(x, y);
}

static int compare_names(const void *a, const void *b)
{
    const struct job *x = *(const struct job *const *)a;
    const struct job *y = *(const struct job *const *)b;
    int order = strcmp(x->name, y->name);
    return order ? order : in_order(x, y);
}

static bool check_different(const struct jobs *jobs, const struct experiment *e,
                            struct err *err)
{
    bool ok = true;
    size_t width = sizeof(const struct job *);
    const struct job **sorted = mem_alloc(jobs->count, width);
    for (size_t i = 0; i < jobs->count; i++)
        sorted[i] = &jobs->items[i];
    qsort(sorted, jobs->count, width, compare_ids);
    for (size_t i = 1; ok && i < jobs->count; i++)
        if (text_equal(sorted[i - 1]->id, sorted[i]->id))
            ok = err_set(err, ERR_VALUE, &e->at, "two jobs are the same: '%s' and '%s'",
                         sorted[i - 1]->name, sorted[i]->name);
    qsort(sorted, jobs->count, width, compare_names);
    for (size_t i = 1; ok && i < jobs->count; i++)
        if (text_equal(sorted[i - 1]->name, sorted[i]->name))
            ok = err_set(err, ERR_VALUE, &e->at,
                         "two jobs are called '%s'; give one a label of its own",
                         sorted[i]->name);
    mem_free(sorted);
    return ok;
}

bool jobs_make(const struct experiment *e, struct jobs *jobs, struct err *err)
{
    struct jobs prototypes = {0};
    *jobs = (struct jobs){0};
    bool ok = make_prototypes(e, &prototypes, err);
    if (ok)
        jobs->items = mem_alloc(e->seed_count * prototypes.count, sizeof *jobs->items);
    for (size_t s = 0; ok && s < e->seed_count; s++)
        for (size_t i = 0; ok && i < prototypes.count; i++)
            ok = add_seeded(jobs, &prototypes.items[i], e->seeds[s], err);
    jobs_deinit(&prototypes);
    return ok && check_different(jobs, e, err);
}

void jobs_deinit(struct jobs *jobs)
{
    for (size_t i = 0; i < jobs->count; i++) {
        mem_free(jobs->items[i].name);
        mem_free(jobs->items[i].label);
        mem_free(jobs->items[i].choices);
    }
    mem_free(jobs->items);
    *jobs = (struct jobs){0};
}
