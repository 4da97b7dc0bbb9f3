#ifndef ETALON_CLI_RESUME_H
#define ETALON_CLI_RESUME_H

/* The options of checkpoints: --checkpoint FILE --every S, --resume FILE, --part I/N. */

#include "cli/args.h"
#include "cli/session.h"
#include "run/run.h"

struct resume {
    const char *from;                  /* NULL: from the beginning */
    struct checkpoint_options options; /* path NULL: none is written */
    struct identity identity;
    struct checkpoint checkpoint;
    struct run_part part; /* --part */
};

/* Reads the options, and checks what can be checked before the scene is read. */
bool resume_take_args(struct resume *resume, const struct args *args, struct err *err);
/* Opens the checkpoint to resume from; fails if it is of another run. reference: of the
 * error log, or NULL. */
bool resume_open(struct resume *resume, const char *scene_path,
                 const struct session *session, const char *reference, struct err *err);
/* Prints to stderr where the run resumes. */
void resume_tell(const struct resume *resume);
void resume_give(struct resume *resume, struct run_options *options);
void resume_close(struct resume *resume);

#endif
