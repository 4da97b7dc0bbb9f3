#ifndef ETALON_CHAIN_PSS_JUMP_H
#define ETALON_CHAIN_PSS_JUMP_H

/* Primary sample space with one more local move, MOVE_JUMP: other numbers with the same
 * contribution [Bitterli18], or MOVE_STAY where the technique drawn is that of the path.
 * The target finds them (path/invert.h); so that the chain's density is kept, the move is
 * accepted with probability min(1, f(y)/f(x)), which is 1 but for rounding. Numbers that
 * the new sample does not use are drawn anew, as after a large step. A jump without an
 * inverse, or of which rounding made another sample, is rejected as FAILURE_INVERSE, with
 * no second stage. */

#include "chain/pss.h"

/* Largest difference of the targets before and after a jump, over the lesser. */
#define PSS_JUMP_TOLERANCE 0.1

/* Its options are struct pss_options, with `jump` and `invert`. A state of this type
 * begins with a struct pss. */
extern const struct state_type state_pss_jump;

#endif
