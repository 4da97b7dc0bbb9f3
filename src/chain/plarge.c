#include "chain/plarge.h"

#include "base/pack.h"
#include "math/student.h"

#include <math.h>
#include <stdio.h>

#define INTERVAL 0.99
#define R_FLAT   0.1  /* flattened integrand from here on [Zsolnai13, section 2.2] */
#define P_PEAKED 0.25 /* [Zsolnai13, section 2.2] */
#define P_DARK   0.5  /* p_l of the measured start */

/* eta_s / (2 (eta_s - eta_l)), at most 1: argmax of E[D] [Zsolnai13, section 2.1], as a
 * monotone function of q = eta_l/eta_s. */
static double flat_rule(double q)
{
    return q < 0.5 ? 0.5 / (1.0 - fmax(q, 0.0)) : 1.0;
}

/* The interval of q, mapped by the rule. p_l has a pole at eta_s = eta_l, where the
 * interval of q is still well defined. */
static void flat_interval(const struct statistics *s, double *lo, double *hi)
{
    *lo = flat_rule(0.0);
    *hi = flat_rule(1.0);
    if (!(s->q_se < HUGE_VAL))
        return;
    double half = student_quantile(0.5 * (1.0 + INTERVAL), s->q_freedom) * s->q_se;
    *lo = flat_rule(s->q - half);
    *hi = flat_rule(s->q + half);
}

static void decide(struct plarge *p, const struct statistics *s)
{
    if (!(s->eta_0 > 0.0)) {
        p->branch = PLARGE_DARK;
        p->p_l = P_DARK;
    } else if (s->r < R_FLAT) {
        /* High variation of the integrand [Zsolnai13, section 2.2]. */
        p->branch = PLARGE_PEAKED;
        p->p_l = P_PEAKED;
    } else if (s->eta_s <= s->eta_l || s->eta_s > 2.0 * (s->eta_s - s->eta_l)) {
        /* The formula exceeds 1 [Zsolnai13, section 2.1]. */
        p->branch = PLARGE_FLAT_ONE;
        p->p_l = 1.0;
    } else {
        /* argmax of E[D] [Zsolnai13, section 2.1]. */
        p->branch = PLARGE_FLAT;
        p->p_l = s->eta_s / (2.0 * (s->eta_s - s->eta_l));
    }
}

/* If the branch is unsure, the interval covers both branches; without light it covers all
 * that the rule can return. */
static void bound(struct plarge *p, const struct statistics *s)
{
    p->p_l_lo = p->p_l_hi = p->p_l;
    if (p->branch != PLARGE_PEAKED || p->unsure)
        flat_interval(s, &p->p_l_lo, &p->p_l_hi);
    if (p->branch == PLARGE_DARK)
        p->p_l_hi = 1.0;
    if (p->branch == PLARGE_PEAKED || p->branch == PLARGE_DARK || p->unsure)
        p->p_l_lo = P_PEAKED;
}

/* Standard error of p_l = 1 / (2 (1 - q)) by its derivative; where p_l is cut off at 1,
 * from its interval, which ends there. If the branch is unsure or the error of q unknown,
 * and as an upper bound in all cases: the greatest standard deviation within the interval
 * [Popoviciu35]. */
static void set_error(struct plarge *p, const struct statistics *s)
{
    /* [Popoviciu35] */
    double most = 0.5 * (p->p_l_hi - p->p_l_lo);
    bool flat = p->branch == PLARGE_FLAT || p->branch == PLARGE_FLAT_ONE;
    p->p_l_freedom = p->unsure ? s->r_freedom : s->q_freedom;
    if (p->unsure || (flat && !(s->q_se < HUGE_VAL)))
        p->p_l_se = most;
    else if (p->branch == PLARGE_FLAT)
        p->p_l_se = fmin(s->q_se * 0.5 / ((1.0 - s->q) * (1.0 - s->q)), most);
    else if (flat)
        p->p_l_se = most /
                    student_quantile(0.5 * (1.0 + INTERVAL), fmax(p->p_l_freedom, 1.0));
    else
        p->p_l_se = 0.0;
}

static void explain(struct plarge *p, const struct statistics *s)
{
    char formula[160] = "";
    switch (p->branch) {
    case PLARGE_DARK:
        snprintf(
            p->reason, sizeof p->reason,
            "no light-carrying path found in %lld large steps (eta_0 = 0): p_l stays "
            "%.2f",
            (long long)s->large, p->p_l);
        return;
    case PLARGE_PEAKED:
        snprintf(formula, sizeof formula, "peaked integrand, p_l = %.2f", p->p_l);
        break;
    case PLARGE_FLAT_ONE:
        snprintf(formula, sizeof formula,
                 "flat integrand, eta_s/(2(eta_s-eta_l)) with eta_s = %.4g, eta_l = %.4g "
                 "is not below 1, p_l = 1",
                 s->eta_s, s->eta_l);
        break;
    case PLARGE_FLAT:
        snprintf(formula, sizeof formula,
                 "flat integrand, p_l = eta_s/(2(eta_s-eta_l)) = %.3f with eta_s = %.4g, "
                 "eta_l = %.4g",
                 p->p_l, s->eta_s, s->eta_l);
        break;
    case PLARGE_TOURS: /* not by this rule */
        break;
    }
    snprintf(
        p->reason, sizeof p->reason,
        "r = eta_l/eta_0 = %.4g in [%.4g, %.4g] is %s %.1f: %s (99 %%: [%.3f, %.3f])%s",
        s->r, s->r_lo, s->r_hi, s->r < R_FLAT ? "below" : "at least", R_FLAT, formula,
        p->p_l_lo, p->p_l_hi, p->unsure ? "; unsure, the interval of r holds 0.1" : "");
}

struct plarge plarge_zsolnai2013(const struct statistics *s)
{
    struct plarge p = {.unsure = s->eta_0 > 0.0 && s->r_lo < R_FLAT && s->r_hi >= R_FLAT};
    decide(&p, s);
    bound(&p, s);
    set_error(&p, s);
    explain(&p, s);
    return p;
}

double plarge_of_rates(double eta_s, double eta_l, double eta_0)
{
    struct statistics s = {.eta_s = eta_s, .eta_l = eta_l, .eta_0 = eta_0};
    struct plarge p = {0};
    s.r = eta_0 > 0.0 ? eta_l / eta_0 : 0.0;
    decide(&p, &s);
    return p.p_l;
}

double plarge_counted(const struct statistics *s)
{
    struct statistics counted = *s;
    if (!(s->eta_0 > 0.0 && s->z_small > 0.0))
        return (double)NAN;
    counted.eta_s = s->eta_s / s->z_small;
    counted.eta_l = s->eta_l / s->eta_0;
    return plarge_zsolnai2013(&counted).p_l;
}

void plarge_pack(struct pack *pack, struct plarge *plarge)
{
    int branch = (int)plarge->branch;
    pack_double(pack, "p_l", &plarge->p_l);
    pack_double(pack, "p_l_se", &plarge->p_l_se);
    pack_double(pack, "p_l_freedom", &plarge->p_l_freedom);
    pack_double(pack, "p_l_lo", &plarge->p_l_lo);
    pack_double(pack, "p_l_hi", &plarge->p_l_hi);
    pack_int(pack, "branch", &branch, 0, PLARGE_TOURS);
    pack_flag(pack, "unsure", &plarge->unsure);
    pack_text(pack, "reason", plarge->reason, sizeof plarge->reason);
    plarge->branch = (enum plarge_branch)branch;
}
