#include "cli/resume.h"

#include "base/text.h"
#include "cli/output.h"
#include "lab/identity.h"

#include <stdio.h>

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

bool resume_take_args(struct resume *resume, const struct args *args, struct err *err)
{
    *resume = (struct resume){.from = args_value(args, "resume")};
    resume->options.path = args_value(args, "checkpoint");
    resume->options.identity = &resume->identity;
    return take_every(resume, args_value(args, "every"), err) &&
           output_check(resume->options.path, err) &&
           (resume->options.path == NULL || pack_writable(resume->options.path, err));
}

bool resume_open(struct resume *resume, const char *scene_path,
                 const struct session *session, const char *reference, struct err *err)
{
    if (resume->from == NULL && resume->options.path == NULL)
        return true;
    return identity_init(&resume->identity, scene_path, session->scene,
                         &session->settings, reference, err) &&
           (resume->from == NULL ||
            checkpoint_open(&resume->checkpoint, resume->from, &resume->identity,
                            &session->settings, err));
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
