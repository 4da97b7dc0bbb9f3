#include "cli/resume.h"

#include "base/ranks.h"
#include "base/text.h"
#include "cli/output.h"
#include "integrator/registry.h"
#include "lab/identity.h"

#include <stdio.h>
#include <string.h>

#define EVERY 60.0 /* s */

static bool take_every(struct resume *resume, const char *every, struct err *err)
{
    resume->options.every = EVERY;
    if (every == NULL)
        return true;
    if (resume->options.path == NULL)
        return err_set(err, ERR_USAGE, NULL,
                       "--every needs a file to write: --checkpoint FILE");
    if (!text_to_double(every, &resume->options.every) || resume->options.every < 0.0)
        return err_set(err, ERR_USAGE, NULL,
                       "--every '%s': give a number of seconds, 0 or more", every);
    return true;
}

/* The file that a part writes is the checkpoint of its end, and until then its own. */
static bool take_part(struct resume *resume, const struct args *args, struct err *err)
{
    const char *part = args_value(args, "part"), *out = args_value(args, "output");
    struct run_part *p = &resume->part;
    int end = 0;
    if (part == NULL)
        return true;
    if (sscanf(part, "%7d/%7d%n", &p->index, &p->count, &end) != 2 ||
        (size_t)end != strlen(part) || p->count < 1 || p->count > PARTS_MOST ||
        p->index < 1 || p->index > p->count)
        return err_set(err, ERR_USAGE, NULL,
                       "--part '%s': give I/N, part I of N, from 1/N to N/N", part);
    p->index--;
    if (resume->options.path)
        return err_set(err, ERR_USAGE, NULL,
                       "--checkpoint is not for a part: what -o names is its checkpoint");
    resume->options.path = out;
    return true;
}

bool resume_take_args(struct resume *resume, const struct args *args, struct err *err)
{
    *resume = (struct resume){.from = args_value(args, "resume")};
    resume->options.path = args_value(args, "checkpoint");
    resume->options.identity = &resume->identity;
    if (!take_part(resume, args, err))
        return false;
    return take_every(resume, args_value(args, "every"), err) &&
           output_check(resume->options.path, err) &&
           (resume->options.path == NULL || pack_writable(resume->options.path, err));
}

/* Under a time budget the start of each part would be another, and so would its chains.
 */
static bool check_part(const struct resume *resume, const struct session *session,
                       struct err *err)
{
    const struct settings *s = &session->settings;
    bool chains = integrator_find(s->integrator)->methods->chains;
    bool ranks = ranks_count() > 1;
    if (part_is_whole(resume->part) && !ranks)
        return true;
    if (ranks && !part_is_whole(resume->part))
        return err_set(err, ERR_USAGE, NULL,
                       "--part is not for mpirun: each rank is one");
    if (settings_until(s))
        return err_set(
            err, ERR_USAGE, NULL,
            "until_converged and until_relmse need the whole run: they are not "
            "for a part");
    if (s->seconds > 0.0 && chains && resume->from == NULL)
        return err_set(err, ERR_USAGE, NULL,
                       "%s with a budget in seconds needs a common start: etalon "
                       "startup SCENE --save FILE, and --resume FILE",
                       ranks ? "mpirun" : "--part");
    if (s->seconds > 0.0 && !chains &&
        settings_film_sampling(s) == FILM_SAMPLING_ADAPTIVE)
        return err_set(
            err, ERR_USAGE, NULL,
            "%s with film_sampling=adaptive needs a budget in mutations per "
            "pixel: under one in seconds each part would measure another start",
            ranks ? "mpirun" : "--part");
    return true;
}

bool resume_open(struct resume *resume, const char *scene_path,
                 const struct session *session, const char *reference, struct err *err)
{
    resume->options.scene = scene_path;
    if (!check_part(resume, session, err))
        return false;
    if (resume->from == NULL && resume->options.path == NULL)
        return true;
    return identity_init(&resume->identity, scene_path, session->scene,
                         &session->settings, reference, err) &&
           (resume->from == NULL ||
            checkpoint_open(&resume->checkpoint, resume->from, &resume->identity,
                            &session->settings, resume->part, err));
}

void resume_tell(const struct resume *resume)
{
    const struct checkpoint_head *head = &resume->checkpoint.head;
    if (resume->from == NULL)
        return;
    fprintf(stderr, "resumed from %s: %.6g mutations per pixel in %.6g s are done\n",
            resume->from, head->mutations, head->seconds);
    if (resume->checkpoint.other_budget)
        fprintf(stderr,
                "warning: the checkpoint was made with another budget; its "
                "measured start keeps the length that follows from that budget\n");
}

void resume_give(struct resume *resume, struct run_options *options)
{
    options->part = resume->part;
    if (ranks_count() > 1)
        options->part = (struct run_part){ranks_own(), ranks_count()};
    if (resume->options.path)
        options->checkpoint = &resume->options;
    if (resume->from)
        options->resume = &resume->checkpoint;
}

void resume_close(struct resume *resume)
{
    pack_destroy(resume->checkpoint.pack);
    identity_deinit(&resume->identity);
}
