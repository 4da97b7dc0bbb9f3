#include "cli/session.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/text.h"
#include "cli/fail.h"
#include "cli/progress.h"
#include "import/import.h"
#include "run/blind_spots.h"
#include "lab/scene_settings.h"
#include "settings/setting.h"

#include <string.h>

bool session_given(const struct arg *arg, char **key, const char **value, struct err *err)
{
    *key = NULL;
    *value = arg->option->value ? arg->value : "true";
    if (arg->option->setting)
        *key = text_copy(arg->option->setting);
    if (!text_equal(arg->option->name, "set"))
        return true;
    const char *equals = strchr(arg->value, '=');
    if (equals == NULL || equals == arg->value)
        return err_set(err, ERR_USAGE, NULL, "--set wants KEY=VALUE, not '%s'",
                       arg->value);
    *key = text_copy_n(arg->value, (size_t)(equals - arg->value));
    *value = equals + 1;
    return true;
}

static bool apply_args(struct settings *settings, const struct args *args,
                       struct err *err)
{
    bool ok = true;
    for (int i = 0; ok && i < args->given_count; i++) {
        char *key;
        const char *value;
        ok = session_given(&args->given[i], &key, &value, err) &&
             (key == NULL || settings_set(settings, key, value, NULL, err));
        mem_free(key);
    }
    return ok;
}

/* Settings that determine the bits of the run that made a checkpoint, and its budget. */
static bool apply_label(struct settings *settings, const struct checkpoint_label *label,
                        struct err *err)
{
    const struct identity *identity = label ? &label->identity : NULL;
    for (int i = 0; identity && i < identity->count; i++) {
        const struct identity_entry *entry = &identity->entries[i];
        const struct setting *setting = settings_find(entry->name);
        if (setting && setting->resume == RESUME_SAME && entry->value[0] &&
            !settings_set(settings, entry->name, entry->value, NULL, err))
            return false;
    }
    if (label) {
        settings->allow_zero = true; /* it was checked before */
        settings->seconds = label->head.budget_seconds;
        settings->mutations_per_pixel = label->head.budget_mutations;
    }
    return true;
}

static void show_load(void *ctx, long done, long count)
{
    (void)ctx;
    progress_show_load("reading", done, count);
}

/* Splits the definitions of a label, "a=1 b=2", in place. */
static int split_definitions(char *text, const char **definitions)
{
    int count = 0;
    for (char *word = strtok(text, " "); word; word = strtok(NULL, " "))
        definitions[count++] = word;
    return count;
}

static int take_definitions(const struct args *args, const char **definitions)
{
    int count = 0;
    for (int i = 0; i < args->given_count; i++)
        if (text_equal(args->given[i].option->name, "define"))
            definitions[count++] = args->given[i].value;
    return count;
}

/* Reads the file, and builds the scene once all settings are known. */
static bool load(struct session *session, const char *path,
                 const struct checkpoint_label *label, const struct args *args,
                 bool shown, struct import_failure *failure, struct err *err)
{
    struct settings *settings = &session->settings;
    struct import_options importing = {.threads = settings_threads(settings),
                                       .progress = shown ? show_load : NULL};
    const char *defined = label ? identity_find(&label->identity, IDENTITY_DEFINITIONS)
                                : NULL;
    char *words = text_copy(defined && !text_equal(defined, "none") ? defined : "");
    const char **definitions = mem_alloc((size_t)args->given_count + strlen(words) + 1,
                                         sizeof *definitions);
    importing.definitions = definitions;
    importing.definition_count = label ? split_definitions(words, definitions)
                                       : take_definitions(args, definitions);
    importing.failure = failure;
    struct scene_desc *desc = import_scene(path, &importing, err);
    mem_free(definitions);
    mem_free(words);
    settings_init(settings); /* the scene's own come before the command line's */
    if (desc == NULL)
        return false;
    log_merge(&failure->log, &desc->log);
    session->note_count = desc->log.count;
    if (!scene_settings_apply(desc, settings, err) ||
        !apply_label(settings, label, err) || !apply_args(settings, args, err) ||
        !settings_check(settings, err)) {
        scene_desc_destroy(desc);
        return false;
    }
    if (shown)
        progress_show_load("building", 0, 0);
    struct scene_options options = scene_settings_options(settings);
    session->scene = scene_build(desc, &options, err);
    return session->scene != NULL;
}

/* What there is to say where loading failed: notes, and all errors but the last, which is
 * left in *err for the caller to tell. */
static void tell_failure(const struct import_failure *failure, struct err *err)
{
    log_print(&failure->log, stderr);
    if (failure->error_count == IMPORT_ERRORS_MAX)
        fprintf(stderr, "etalon: the first %d errors; there may be more:\n",
                IMPORT_ERRORS_MAX);
    for (int i = 0; i + 1 < failure->error_count; i++)
        fail(&failure->errors[i]);
    if (failure->error_count > 0)
        *err = failure->errors[failure->error_count - 1];
}

bool session_open(struct session *session, const char *path, const struct args *args,
                  struct err *err)
{
    return session_open_again(session, path, NULL, args, err);
}

bool session_open_again(struct session *session, const char *path,
                        const struct checkpoint_label *label, const struct args *args,
                        struct err *err)
{
    double begin = clock_wall();
    *session = (struct session){0};
    settings_init(&session->settings);
    if (!apply_args(&session->settings, args, err))
        return false;
    bool shown = progress_wanted();
    struct import_failure failure = {0};
    bool loaded = load(session, path, label, args, shown, &failure, err);
    if (shown)
        progress_clear();
    if (!loaded)
        tell_failure(&failure, err);
    import_failure_deinit(&failure);
    if (!loaded)
        return false;
    needs_left_out(&session->scene->needs, session->left_out, sizeof session->left_out);
    session->load_seconds = clock_wall() - begin;
    return true;
}

void session_close(struct session *session)
{
    scene_destroy(session->scene);
    session->scene = NULL;
}

void session_warn(const struct session *session)
{
    struct text text = {0};
    log_print(&session->scene->desc->log, stderr);
    if (blind_spots_tell(session->scene->desc, &session->settings,
                         settings_depth(&session->settings, session->scene), &text))
        fprintf(stderr, "warning: %s\n", text.data);
    mem_free(text.data);
}
