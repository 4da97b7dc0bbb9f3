#include "cli/curve_text.h"

#include <math.h>

#define BAR  40  /* characters, for MOST */
#define MOST 3.0 /* times the least error */

/* The point nearest to p on the scale of the table. */
static int point_of(double p)
{
    int best = 0;
    for (int i = 1; i < TOURS_POINTS; i++)
        if (fabs(log(tours_p[i] / p)) < fabs(log(tours_p[best] / p)))
            best = i;
    return best;
}

static void print_bar(double times, FILE *out)
{
    int length = (int)lrint((fmin(times, MOST) - 1.0) / (MOST - 1.0) * (BAR - 1)) + 1;
    for (int i = 0; i < BAR; i++)
        fputc(i >= length ? ' ' : times > MOST && i == BAR - 1 ? '>' : '=', out);
}

void curve_print(const struct run_statistics *s, FILE *out)
{
    const struct tours_choice *c = &s->tours;
    if (!c->found)
        return;
    fprintf(out,
            "# predicted relMSE at the end of the run by p_l; work: of a "
            "mutation;\n# times: relMSE at equal work over that of the chosen p_l\n");
    fprintf(out, "# %5s %10s %7s %7s\n", "p_l", "relMSE", "work", "times");
    for (int i = 0; i < TOURS_POINTS; i++) {
        double times = tours_regret(&c->curve, tours_p[i], s->plarge.p_l);
        fprintf(out, "# %5.2f %10.3g %7.2f %7.2f  ", tours_p[i], c->curve.relmse[i],
                c->curve.cost[i], times);
        print_bar(times, out);
        fprintf(out, "%s%s\n", point_of(s->plarge.p_l) == i ? "  <- chosen" : "",
                point_of(s->p_l_zsolnai2013) == i ? "  <- zsolnai2013" : "");
    }
}
