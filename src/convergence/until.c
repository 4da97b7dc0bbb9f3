#include "convergence/until.h"

#include "math/student.h"

#define UNTIL_LOOKS_MOST 1000 /* no run has 1.5^1000 mutations per pixel */

void until_init(struct until *until, bool wants_converged, double wants_relmse)
{
    *until = (struct until){
        .wants_converged = wants_converged,
        .wants_relmse = wants_relmse,
        .next = UNTIL_FIRST,
        .bound = (double)NAN,
    };
}

bool until_wanted(const struct until *until)
{
    return until->wants_converged || until->wants_relmse > 0.0;
}

bool until_due(const struct until *until, double mutations_per_pixel)
{
    return until_wanted(until) && mutations_per_pixel >= until->next;
}

/* One-sided upper bound of relMSE: Student's t with parts - 1 degrees of freedom, at the
 * level of look k (alpha spending). */
static double upper_bound(const struct until *until, const struct verdict *v)
{
    /* Alpha spending: the levels of all looks sum to UNTIL_LEVEL. */
    double k = until->looks, level = UNTIL_LEVEL / (k * (k + 1.0));
    if (!v->error_bars_valid || v->parts < 2)
        return (double)NAN;
    return v->relmse + v->relmse_se * student_quantile(1.0 - level, v->parts - 1.0);
}

bool until_look(struct until *until, double mutations_per_pixel, const struct verdict *v)
{
    until->looks++;
    until->agreed = v->call >= VERDICT_BLIND ? until->agreed + 1 : 0;
    until->bound = upper_bound(until, v);
    bool converged = until->agreed >= UNTIL_CONFIRMED;
    bool below = until->bound < until->wants_relmse;
    until->reached = (converged || !until->wants_converged) &&
                     (below || !(until->wants_relmse > 0.0));
    while (until->next <= mutations_per_pixel)
        until->next *= UNTIL_RATIO;
    return until->reached;
}

void until_pack(struct pack *pack, struct until *until)
{
    bool converged = until->wants_converged;
    double relmse = until->wants_relmse;
    pack_flag(pack, "until_converged", &converged);
    pack_double(pack, "until_relmse", &relmse);
    pack_double(pack, "until_next", &until->next);
    pack_int(pack, "until_looks", &until->looks, 0, UNTIL_LOOKS_MOST);
    pack_int(pack, "until_agreed", &until->agreed, 0, UNTIL_LOOKS_MOST);
    pack_double(pack, "until_bound", &until->bound);
    pack_flag(pack, "until_reached", &until->reached);
    if (!(until->next >= UNTIL_FIRST))
        pack_refuse(pack, "the next look is due before the first one");
    until->reached = until->reached && converged == until->wants_converged &&
                     relmse == until->wants_relmse;
}
