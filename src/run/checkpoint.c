#include "run/checkpoint.h"

#include "base/mem.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* --- identities ------------------------------------------------------------------- */

void identity_add(struct identity *identity, const char *name, const char *format, ...)
{
    char value[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(value, sizeof value, format, args);
    va_end(args);
    assert(identity->count < (int)(sizeof identity->entries / sizeof *identity->entries));
    identity->entries[identity->count++] = (struct identity_entry){name,
                                                                   text_copy(value)};
}

void identity_deinit(struct identity *identity)
{
    for (int i = 0; i < identity->count; i++)
        mem_free(identity->entries[i].value);
    identity->count = 0;
}

/* Appends "name\0value\0". */
static void append_string(struct text *blob, const char *string)
{
    text_append(blob, "%s", string);
    blob->length++; /* the zero that ends it */
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

static bool head_check(struct checkpoint *checkpoint, const char *path,
                       const struct settings *settings, struct err *err)
{
    struct checkpoint_head *head = &checkpoint->head;
    pack_head(checkpoint->pack, head);
    checkpoint->other_budget = head->budget_seconds != settings->seconds ||
                               head->budget_mutations != settings->mutations_per_pixel;
    return pack_ok(checkpoint->pack) && budget_check(checkpoint, path, settings, err);
}

bool checkpoint_open(struct checkpoint *checkpoint, const char *path,
                     const struct identity *identity, const struct settings *settings,
                     struct err *err)
{
    *checkpoint = (struct checkpoint){.pack = pack_open(path, CHECKPOINT_LAYOUT, err)};
    if (checkpoint->pack == NULL)
        return false;
    if (identity_check(checkpoint->pack, path, identity, err) &&
        head_check(checkpoint, path, settings, err))
        return true;
    pack_close(checkpoint->pack, err); /* reports a read error, if that was the cause */
    checkpoint->pack = NULL;
    return false;
}
