/* etalon merge: the picture of a run that was computed in parts. */

#include "base/mem.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/delivery.h"
#include "cli/fail.h"
#include "cli/output.h"
#include "image/exr.h"
#include "lab/identity.h"

#include <stdio.h>

struct merge {
    const struct args *args;
    int count; /* files */
    struct checkpoint_label *labels;
    struct checkpoint *parts;
    struct identity identity;
    struct session session;
    struct delivery delivery;
    struct image *reference;
    struct run_result result;
    bool partial;
};

/* Names every value in which the run of a part differs from that of the first. */
static bool check_same_run(const struct merge *m, int index, struct err *err)
{
    const struct checkpoint_label *first = &m->labels[0], *label = &m->labels[index];
    const char *first_path = m->args->operands[0], *path = m->args->operands[index];
    const struct checkpoint_head *a = &first->head, *b = &label->head;
    struct text list = {0};
    for (int i = 0; i < first->identity.count; i++) {
        const struct identity_entry *entry = &first->identity.entries[i];
        const char *value = identity_find(&label->identity, entry->name);
        if (value == NULL || !text_equal(value, entry->value))
            text_append(&list, "%s%s: %s here, %s in %s", list.length ? "; " : "",
                        entry->name, value ? value : "none", entry->value, first_path);
    }
    if (a->part.count != b->part.count)
        text_append(&list, "%snumber of parts: %d here, %d in %s",
                    list.length ? "; " : "", b->part.count, a->part.count, first_path);
    if (a->budget_seconds != b->budget_seconds ||
        a->budget_mutations != b->budget_mutations)
        text_append(&list, "%sbudget: %g %s here, %g %s in %s", list.length ? "; " : "",
                    b->budget_seconds + b->budget_mutations,
                    b->budget_seconds > 0.0 ? "seconds" : "mutations per pixel",
                    a->budget_seconds + a->budget_mutations,
                    a->budget_seconds > 0.0 ? "seconds" : "mutations per pixel",
                    first_path);
    bool same = list.length == 0;
    if (!same)
        err_set(err, ERR_VALUE, &(struct place){path, 0, 0}, "%s", list.data);
    mem_free(list.data);
    return same;
}

static bool check_label(const struct merge *m, int index, struct err *err)
{
    const struct checkpoint_head *head = &m->labels[index].head;
    struct place at = {m->args->operands[index], 0, 0};
    if (part_is_whole(head->part))
        return err_set(err, ERR_VALUE, &at,
                       "this is the checkpoint of a whole run, not a part");
    if (!head->started)
        return err_set(err, ERR_VALUE, &at,
                       "the measured start of this part is not over: continue it with "
                       "--resume %s",
                       at.file);
    if (!head->finished && !m->partial)
        return err_set(err, ERR_VALUE, &at,
                       "this part has not used up its budget: continue it with --resume "
                       "%s, or take it as it is: --partial",
                       at.file);
    if (index > 0 && !check_same_run(m, index, err))
        return false;
    for (int i = 0; i < index; i++)
        if (m->labels[i].head.part.index == head->part.index)
            return err_set(err, ERR_VALUE, &at, "this is part %d/%d, as is %s",
                           head->part.index + 1, head->part.count, m->args->operands[i]);
    return true;
}

static bool is_given(const struct merge *m, int index)
{
    for (int i = 0; i < m->count; i++)
        if (m->labels[i].head.part.index == index)
            return true;
    return false;
}

/* The parts that are not given, as "2, 5". */
static int list_missing(const struct merge *m, struct text *list)
{
    int missing = 0;
    for (int i = 0; i < m->labels[0].head.part.count; i++)
        if (!is_given(m, i)) {
            text_append(list, "%s%d", missing ? ", " : "", i + 1);
            missing++;
        }
    return missing;
}

static bool check_missing(const struct merge *m, struct err *err)
{
    struct text list = {0};
    int all = m->labels[0].head.part.count, missing = list_missing(m, &list);
    bool ok = missing == 0 || m->partial;
    if (!ok)
        err_set(err, ERR_USAGE, NULL,
                "part%s %s of %d %s missing: give the file%s, or do without: --partial",
                missing > 1 ? "s" : "", list.data, all, missing > 1 ? "are" : "is",
                missing > 1 ? "s" : "");
    else if (missing > 0)
        fprintf(
            stderr,
            "warning: part%s %s of %d %s left out: the picture is of fewer chains and "
            "samples\n",
            missing > 1 ? "s" : "", list.data, all, missing > 1 ? "are" : "is");
    mem_free(list.data);
    return ok;
}

static bool read_labels(struct merge *m, struct err *err)
{
    for (int i = 0; i < m->count; i++)
        if (!checkpoint_label_read(&m->labels[i], m->args->operands[i], err) ||
            !check_label(m, i, err))
            return false;
    return check_missing(m, err);
}

static bool take_args(struct merge *m, struct err *err)
{
    const char *out = args_value(m->args, "output");
    const char *reference = args_value(m->args, "reference");
    m->partial = args_value(m->args, "partial") != NULL;
    if (out == NULL)
        return err_set(err, ERR_USAGE, NULL, "merge needs -o OUT.exr");
    if (!delivery_init(&m->delivery, out, args_value(m->args, "stats"), err))
        return false;
    if (reference && !(m->reference = exr_read(reference, NULL, err)))
        return false;
    m->delivery.reference = m->reference;
    return true;
}

/* The scene, with the settings of the parts, as this program has it now. */
static bool open_session(struct merge *m, struct err *err)
{
    const char *given = args_value(m->args, "scene");
    const char *scene = given ? given : m->labels[0].scene;
    if (!session_open_again(&m->session, scene, &m->labels[0], m->args, err) ||
        !delivery_check_reference(m->reference, args_value(m->args, "reference"),
                                  &m->session.scene->camera, err) ||
        !identity_init(&m->identity, scene, m->session.scene, &m->session.settings, NULL,
                       err))
        return false;
    for (int i = 0; i < m->count; i++)
        if (!checkpoint_open(&m->parts[i], m->args->operands[i], &m->identity,
                             &m->session.settings, m->labels[i].head.part, err))
            return false;
    return true;
}

static bool merge(struct merge *m, struct err *err)
{
    struct run_options options = {.scene = m->session.scene,
                                  .settings = &m->session.settings};
    return run_merge(&options, m->parts, m->count, &m->result, err) &&
           delivery_write(&m->delivery, &m->session, &m->result, err);
}

static void close_all(struct merge *m)
{
    run_result_deinit(&m->result);
    for (int i = 0; i < m->count; i++) {
        pack_destroy(m->parts[i].pack);
        checkpoint_label_deinit(&m->labels[i]);
    }
    mem_free(m->parts);
    mem_free(m->labels);
    identity_deinit(&m->identity);
    image_destroy(m->reference);
    delivery_deinit(&m->delivery);
    session_close(&m->session);
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct merge m = {.args = args, .count = args->operand_count};
    m.labels = mem_alloc((size_t)m.count, sizeof *m.labels);
    m.parts = mem_alloc((size_t)m.count, sizeof *m.parts);
    bool ok = take_args(&m, &err) && read_labels(&m, &err) && open_session(&m, &err) &&
              merge(&m, &err);
    close_all(&m);
    return ok ? 0 : fail(&err);
}

static const struct arg_option own[] = {
    {"output", 'o', "OUT.exr", NULL, "the picture; a tone-mapped OUT.png goes beside it"},
    {"stats", 0, "OUT.yaml", NULL, "statistics of the run"},
    {"reference", 0, "REF.exr", NULL,
     "picture of the same size to measure the error "
     "against"},
    {"partial", 0, NULL, NULL,
     "goes without parts that are missing, and takes those that have not used up their "
     "budget"},
    {"scene", 0, "SCENE", NULL,
     "where the scene is; else where it was when the parts were computed"},
    {"threads", 0, "N", "threads", "0 = all"},
    {0},
};

const struct command command_merge = {
    .name = "merge",
    .summary = "makes the picture of a run from its parts (render --part)",
    .operands = "PART... -o OUT.exr [options]",
    .operand_count = 1,
    .takes_more = true,
    .groups = {own},
    .notes =
        "The parts must be of one run: the same program, scene, settings and number of "
        "parts;\nelse the first difference is named, and nothing is written.",
    .run = run,
};
