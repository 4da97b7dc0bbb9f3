/* The folder gets an experiment file like one that a user would write, so `etalon bench`
 * can go on with it, for example with more seeds. */

#include "cli/render_all.h"

#include "analysis/analysis_why.h"
#include "analysis/analysis_words.h"
#include "base/json.h"
#include "base/mem.h"
#include "cli/bench_tell.h"
#include "cli/fail.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/report_page.h"
#include "cli/session.h"
#include "integrator/registry.h"
#include "lab/folder.h"
#include "lab/runner.h"
#include "settings/setting.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define INTERRUPTED 130 /* exit status, as shells report SIGINT */

/* Given as options of their own in an experiment, or made from others. */
static const char *const apart[] = {"integrator", "seed", "budget", "seconds",
                                    "mutations_per_pixel"};

struct all {
    struct settings settings; /* as given, over the defaults: seed and budget */
    char **keys, **values;    /* other settings that were given, each once */
    size_t count;
    bool has_budget;
    const char *reference; /* or NULL */
    const char *folder;
    char *file; /* FOLDER/experiment.yaml */
    struct experiment *experiment;
    struct jobs jobs;
};

bool render_all_wanted(const struct args *args)
{
    const char *integrator = args_value(args, "integrator");
    return integrator && text_equal(integrator, "all");
}

/* --- the options ----------------------------------------------------------------- */

static bool is_apart(const char *key)
{
    for (size_t i = 0; i < sizeof apart / sizeof *apart; i++)
        if (text_equal(key, apart[i]))
            return true;
    return false;
}

/* Keeps the last value of each setting. Takes key. */
static void keep(struct all *all, char *key, const char *value)
{
    size_t i = 0;
    while (i < all->count && !text_equal(all->keys[i], key))
        i++;
    if (i < all->count) {
        mem_free(all->keys[i]);
        mem_free(all->values[i]);
    } else {
        all->count++;
    }
    all->keys[i] = key;
    all->values[i] = text_copy(value);
}

static bool take_setting(struct all *all, const struct arg *arg, struct err *err)
{
    static const char *const others[] = {"set", "output", "reference", NULL};
    const char *value, *name = arg->option->name;
    char *key;
    bool known = arg->option->setting && strncmp(name, "until-", strlen("until-")) != 0;
    for (int i = 0; others[i]; i++)
        known = known || text_equal(name, others[i]);
    if (!known)
        return err_set(err, ERR_USAGE, NULL, "--%s does not go with -i all", name);
    if (!session_given(arg, &key, &value, err))
        return false;
    bool all_of_them = key && text_equal(key, "integrator") && text_equal(value, "all");
    if (key && !all_of_them && !settings_set(&all->settings, key, value, NULL, err)) {
        mem_free(key);
        return false;
    }
    if (key && is_apart(key)) {
        all->has_budget = all->has_budget ||
                          (!text_equal(key, "integrator") && !text_equal(key, "seed"));
        mem_free(key);
    } else if (key) {
        keep(all, key, value);
    }
    return true;
}

static bool take_args(struct all *all, const struct args *args, struct err *err)
{
    all->folder = args_value(args, "output");
    all->reference = args_value(args, "reference");
    if (all->folder == NULL || text_ends_with(all->folder, ".exr"))
        return err_set(err, ERR_USAGE, NULL,
                       "-i all needs -o DIR, a folder for the pictures and their page");
    all->file = text_join(all->folder, "experiment.yaml");
    settings_init(&all->settings);
    all->keys = mem_alloc((size_t)args->given_count, sizeof *all->keys);
    all->values = mem_alloc((size_t)args->given_count, sizeof *all->values);
    for (int i = 0; i < args->given_count; i++)
        if (!take_setting(all, &args->given[i], err))
            return false;
    return true;
}

/* --- the experiment -------------------------------------------------------------- */

/* The caller owns it. */
static char *absolute(const char *path)
{
    char *folder = getcwd(NULL, 0);
    char *whole = text_join(folder ? folder : ".", path);
    free(folder);
    return whole;
}

static void list_integrators(struct json *json)
{
    json_open(json, "integrators", '[');
    for (int i = 0; integrator_types[i]; i++)
        if (!text_equal(integrator_types[i]->name, "auto"))
            json_text(json, NULL, integrator_types[i]->name);
    json_close(json, '[');
}

static void list_paths(struct json *json, const struct all *all, const char *scene)
{
    char *path = absolute(scene);
    json_open(json, "scenes", '[');
    json_text(json, NULL, path);
    json_close(json, '[');
    mem_free(path);
    if (all->reference == NULL)
        return;
    path = absolute(all->reference);
    json_text(json, "reference", path);
    mem_free(path);
}

/* JSON, which is YAML. */
static char *experiment_text(const struct all *all, const char *scene)
{
    struct json json = {0};
    json_open(&json, NULL, '{');
    json_text(&json, "experiment", "all");
    list_paths(&json, all, scene);
    list_integrators(&json);
    json_open(&json, "seeds", '[');
    json_count(&json, NULL, all->settings.seed);
    json_close(&json, '[');
    if (all->has_budget && all->settings.seconds > 0.0)
        json_number(&json, "seconds", all->settings.seconds);
    else if (all->has_budget)
        json_number(&json, "mutations_per_pixel", all->settings.mutations_per_pixel);
    for (size_t i = 0; i < all->count; i++)
        json_text(&json, all->keys[i], all->values[i]);
    json_close(&json, '{');
    text_append(&json.text, "\n");
    return json.text.data;
}

/* Results of other settings in the same folder would stand on the same page. */
static bool check_folder(const struct all *all, const char *text, struct err *err)
{
    struct err ignored = {0};
    char *runs = text_join(all->folder, "runs.csv");
    size_t size;
    bool used = access(runs, F_OK) == 0;
    char *old = used ? text_read_file(all->file, &size, NULL, &ignored) : NULL;
    bool same = old && text_equal(old, text);
    mem_free(old);
    mem_free(runs);
    return !used || same ||
           err_set(err, ERR_USAGE, NULL,
                   "'%s' holds results of another scene, or of other settings: give "
                   "another folder",
                   all->folder);
}

/* Leaves nothing of a command that was refused. */
static void withdraw(const struct all *all)
{
    char *runs = text_join(all->folder, "runs.csv");
    if (all->file && access(runs, F_OK) != 0) {
        unlink(all->file);
        rmdir(all->folder); /* unless it holds something */
    }
    mem_free(runs);
}

static bool make_experiment(struct all *all, const char *scene, struct err *err)
{
    char *text = experiment_text(all, scene);
    bool ok = check_folder(all, text, err) && folder_make(all->folder, err) &&
              text_write_file(all->file, text, strlen(text), err);
    mem_free(text);
    if (!ok)
        return false;
    all->experiment = experiment_load(all->file, err);
    return all->experiment && jobs_make(all->experiment, &all->jobs, err);
}

/* --- runs and page --------------------------------------------------------------- */

static bool run_jobs(struct all *all, struct runner_summary *summary, struct err *err)
{
    bool terminal = progress_wanted();
    struct runner_options options = {
        .experiment = all->experiment,
        .jobs = &all->jobs,
        .folder = all->folder,
        .references = all->folder,
        .own_method = true,
        .stop = interrupt_install(),
    };
    bench_tell(&options, &terminal);
    bool ok = runner_run(&options, summary, err);
    if (terminal)
        progress_clear();
    return ok;
}

static void print_outcome(const struct results *results, enum results_error error)
{
    struct families families;
    struct analysis_ranking ranking;
    struct text best = {0}, why = {0};
    families_make(results, &families);
    analysis_ranking_make(results, &families, &results->cells[0], error, &ranking);
    analysis_append_best(&best, &ranking);
    analysis_append_why(&why, results, &ranking, error);
    printf("by %s: %s\n", analysis_error_words(error), best.data);
    if (why.length > 0)
        printf("why: %s\n", why.data);
    analysis_ranking_deinit(&ranking);
    families_deinit(&families);
    mem_free(best.data);
    mem_free(why.data);
}

static bool write_page(const struct all *all, struct err *err)
{
    struct results *results = results_load(all->folder, err);
    if (results == NULL)
        return false;
    struct report_options options = {.references = all->folder, .axis = RESULTS_CPU};
    options.error = report_page_error(results);
    bool ok = report_page_write(results, &options, err);
    if (ok)
        print_outcome(results, options.error);
    results_destroy(results);
    return ok;
}

static void all_deinit(struct all *all)
{
    for (size_t i = 0; i < all->count; i++) {
        mem_free(all->keys[i]);
        mem_free(all->values[i]);
    }
    mem_free(all->keys);
    mem_free(all->values);
    mem_free(all->file);
    jobs_deinit(&all->jobs);
    experiment_destroy(all->experiment);
}

int render_all(const struct args *args)
{
    struct err err = {0};
    struct all all = {0};
    struct runner_summary summary = {0};
    bool taken = take_args(&all, args, &err);
    bool ok = taken && make_experiment(&all, args->operands[0], &err) &&
              run_jobs(&all, &summary, &err);
    if (taken && !ok)
        withdraw(&all);
    if (ok && summary.interrupted)
        fprintf(stderr, "interrupted: the same command goes on from there\n");
    else if (ok)
        ok = write_page(&all, &err);
    all_deinit(&all);
    return !ok ? fail(&err) : summary.interrupted ? INTERRUPTED : 0;
}
