#include "run/checkpoint.h"

#include "base/mem.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* --- identities ------------------------------------------------------------------- */

static void append_entry(struct identity *identity, const char *name, char *value)
{
    identity->entries = mem_grow(identity->entries, &identity->capacity,
                                 (size_t)identity->count + 1, sizeof *identity->entries);
    identity->entries[identity->count++] = (struct identity_entry){name, value};
}

void identity_add(struct identity *identity, const char *name, const char *format, ...)
{
    char value[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(value, sizeof value, format, args);
    va_end(args);
    append_entry(identity, name, text_copy(value));
}

void identity_deinit(struct identity *identity)
{
    for (int i = 0; i < identity->count; i++)
        mem_free(identity->entries[i].value);
    mem_free(identity->entries);
    *identity = (struct identity){.entries = NULL};
}

/* Appends "name\0value\0". */
static void append_string(struct text *blob, const char *string)
{
    text_append(blob, "%s", string);
    blob->length++; /* the zero that ends it */
}

const char *identity_find(const struct identity *identity, const char *name)
{
    for (int i = 0; i < identity->count; i++)
        if (text_equal(identity->entries[i].name, name))
            return identity->entries[i].value;
    return NULL;
}

static void identity_write(struct pack *pack, const struct identity *identity)
{
    struct text blob = {0};
    for (int i = 0; i < identity->count; i++) {
        append_string(&blob, identity->entries[i].name);
        append_string(&blob, identity->entries[i].value);
    }
    pack_blob(pack, "identity", &blob);
    mem_free(blob.data);
}

/* The next string of the blob, NULL at the end. The blob ends in a zero. */
static const char *next_string(const struct text *blob, const char *string)
{
    const char *next = string + strlen(string) + 1;
    return next < blob->data + blob->length ? next : NULL;
}

static const char *find_value(const struct text *blob, const char *name)
{
    const char *key = blob->length > 0 ? blob->data : NULL;
    while (key) {
        const char *value = next_string(blob, key);
        if (value == NULL || text_equal(key, name))
            return value;
        key = next_string(blob, value);
    }
    return NULL;
}

static void append_difference(struct text *list, const struct identity_entry *mine,
                              const char *theirs)
{
    text_append(list, "%s%s: the checkpoint was made with %s, this run has %s",
                list->length ? "; " : "", mine->name, theirs ? theirs : "none",
                mine->value);
}

static bool identity_check(struct pack *pack, const char *path,
                           const struct identity *identity, struct err *err)
{
    struct text blob = {0}, list = {0};
    pack_blob(pack, "identity", &blob);
    for (int i = 0; pack_ok(pack) && i < identity->count; i++) {
        const char *theirs = find_value(&blob, identity->entries[i].name);
        if (theirs == NULL || !text_equal(theirs, identity->entries[i].value))
            append_difference(&list, &identity->entries[i], theirs);
    }
    bool same = list.length == 0;
    if (!same)
        err_set(err, ERR_VALUE, &(struct place){path, 0, 0}, "%s", list.data);
    mem_free(list.data);
    mem_free(blob.data);
    return same;
}

/* --- heads ------------------------------------------------------------------------ */

static void pack_head(struct pack *pack, struct checkpoint_head *head)
{
    pack_double(pack, "budget_seconds", &head->budget_seconds);
    pack_double(pack, "budget_mutations", &head->budget_mutations);
    pack_double(pack, "seconds", &head->seconds);
    pack_double(pack, "mutations", &head->mutations);
    pack_flag(pack, "started", &head->started);
    pack_flag(pack, "finished", &head->finished);
    pack_int(pack, "part", &head->part.index, 0, PARTS_MOST);
    pack_int(pack, "parts", &head->part.count, 0, PARTS_MOST);
}

static void pack_scene(struct pack *pack, struct text *scene)
{
    pack_blob(pack, "scene", scene);
}

/* Until the measured start is over a part has the state of the whole run. */
static void set_part(struct pack *pack, const struct checkpoint_head *head)
{
    pack_set_part(pack, head->started ? head->part : (struct run_part){0, 0}, false);
}

struct pack *checkpoint_create(const struct checkpoint_options *options,
                               const struct checkpoint_head *head, struct err *err)
{
    struct checkpoint_head copy = *head;
    struct pack *pack = pack_create(options->path, CHECKPOINT_LAYOUT, err);
    if (pack == NULL)
        return NULL;
    identity_write(pack, options->identity);
    pack_head(pack, &copy);
    struct text scene = {0};
    text_append(&scene, "%s", options->scene ? options->scene : "");
    pack_scene(pack, &scene);
    mem_free(scene.data);
    set_part(pack, head);
    return pack;
}

static bool budget_check(const struct checkpoint *checkpoint, const char *path,
                         const struct settings *settings, struct err *err)
{
    const struct checkpoint_head *head = &checkpoint->head;
    struct place at = {path, 0, 0};
    bool timed = head->budget_seconds > 0.0;
    if (!checkpoint->other_budget)
        return true;
    if (!head->started)
        return err_set(err, ERR_VALUE, &at,
                       "budget: the checkpoint was made with %s=%.9g, and its measured "
                       "start, a share of the budget, is not over: give the same budget",
                       timed ? "seconds" : "mutations_per_pixel",
                       timed ? head->budget_seconds : head->budget_mutations);
    if (settings->seconds > 0.0 && settings->seconds < head->seconds)
        return err_set(err, ERR_VALUE, &at,
                       "budget: the checkpoint has taken %.9g seconds, this run has "
                       "seconds=%.9g: give more",
                       head->seconds, settings->seconds);
    if (settings->seconds <= 0.0 && settings->mutations_per_pixel < head->mutations)
        return err_set(err, ERR_VALUE, &at,
                       "budget: the checkpoint has made %.9g mutations per pixel, this "
                       "run has mutations_per_pixel=%.9g: give more",
                       head->mutations, settings->mutations_per_pixel);
    return true;
}

static bool part_check(const struct checkpoint_head *head, const char *path,
                       struct run_part part, struct err *err)
{
    struct run_part found = head->part;
    struct place at = {path, 0, 0};
    if (part_is_whole(found) ? part_is_whole(part) || head->started
                             : found.index == part.index && found.count == part.count)
        return true;
    if (part_is_whole(found))
        return err_set(err, ERR_VALUE, &at,
                       "part: the measured start of this run is not over: a part begins "
                       "where it is");
    if (part_is_whole(part))
        return err_set(err, ERR_VALUE, &at,
                       "part: the checkpoint was made with %d/%d, this run has none",
                       found.index + 1, found.count);
    return err_set(err, ERR_VALUE, &at,
                   "part: the checkpoint was made with %d/%d, this run has %d/%d",
                   found.index + 1, found.count, part.index + 1, part.count);
}

static bool head_check(struct checkpoint *checkpoint, const char *path,
                       const struct settings *settings, struct run_part part,
                       struct err *err)
{
    struct checkpoint_head *head = &checkpoint->head;
    struct text scene = {0};
    pack_head(checkpoint->pack, head);
    pack_scene(checkpoint->pack, &scene);
    mem_free(scene.data);
    set_part(checkpoint->pack, head);
    checkpoint->other_budget = head->budget_seconds != settings->seconds ||
                               head->budget_mutations != settings->mutations_per_pixel;
    return pack_ok(checkpoint->pack) && part_check(head, path, part, err) &&
           budget_check(checkpoint, path, settings, err);
}

bool checkpoint_open(struct checkpoint *checkpoint, const char *path,
                     const struct identity *identity, const struct settings *settings,
                     struct run_part part, struct err *err)
{
    *checkpoint = (struct checkpoint){.pack = pack_open(path, CHECKPOINT_LAYOUT, err)};
    if (checkpoint->pack == NULL)
        return false;
    if (identity_check(checkpoint->pack, path, identity, err) &&
        head_check(checkpoint, path, settings, part, err))
        return true;
    pack_close(checkpoint->pack, err); /* reports a read error, if that was the cause */
    checkpoint->pack = NULL;
    return false;
}

/* --- labels ----------------------------------------------------------------------- */

static void take_identity(const struct text *blob, struct identity *identity)
{
    const char *name = blob->length > 0 ? blob->data : NULL;
    while (name) {
        const char *value = next_string(blob, name);
        if (value == NULL)
            return;
        append_entry(identity, text_copy(name), text_copy(value));
        name = next_string(blob, value);
    }
}

bool checkpoint_label_read(struct checkpoint_label *label, const char *path,
                           struct err *err)
{
    struct text identity = {0}, scene = {0};
    struct pack *pack = pack_open(path, CHECKPOINT_LAYOUT, err);
    *label = (struct checkpoint_label){.scene = NULL};
    if (pack == NULL)
        return false;
    pack_blob(pack, "identity", &identity);
    pack_head(pack, &label->head);
    pack_scene(pack, &scene);
    bool ok = pack_ok(pack);
    if (ok)
        take_identity(&identity, &label->identity);
    label->scene = text_copy(scene.data ? scene.data : "");
    mem_free(identity.data);
    mem_free(scene.data);
    if (!ok)
        pack_close(pack, err); /* reports the failure */
    else
        pack_destroy(pack);
    return ok;
}

void checkpoint_label_deinit(struct checkpoint_label *label)
{
    for (int i = 0; i < label->identity.count; i++)
        mem_free((char *)label->identity.entries[i].name);
    identity_deinit(&label->identity);
    mem_free(label->scene);
}
