/* Selectively Metropolised Monte Carlo [Bitterli19], with a share that is relative to the
 * pixel and has a ceiling. F(u) are the splats of a sample u, uniform in primary sample
 * space, so that the picture is E_u[F]. Let
 *
 *     rho(u) = sum over splats of luminance / sqrt(I_j^2 + e^2)
 *     s(rho) = rho / (rho + c) * min(1, W / rho)
 *
 * with any I_j, e, c >= 0 and W > 0. As E[F] = E[s F] + E[(1 - s) F] whatever s is, the
 * sum of unbiased estimates of both parts is unbiased, if s does not depend on the
 * samples of these estimates: guess, c and W are fixed beforehand, from other samples.
 *
 *   Chains estimate E[s F]. Their target is T = rho s, a scalar like any other: where
 *   rho > 0, s > 0, so T > 0 wherever s F is not 0, and the density T / E[T] with the
 *   splats s F / T has the mean E[s F] / E[T] [Kelemen02]. estimator.h combines states
 *   with large steps.
 *
 *   Independent samples estimate E[(1 - s) F]: passes with a sample a pixel, and the
 * large steps of the chains. With a constant v the mean of large steps times v and that
 * of passes times 1 - v add up to one unbiased estimate; v is least in variance if the
 *   weights are inverse to the variances of the two means.
 *
 * Chains may sample one technique of n at a time, with F = n f_t. Then E[F] = E over the
 * numbers of the mean over t of n f_t = E[sum of f_t], and s is a function of n f_t. A
 * sample of the passes has all f_t; it leaves (1 - s(rho(n f_t))) f_t of each, so both
 * split the same sum.
 *
 * Of a chain that never has a target above W, a large step is accepted with probability
 * E_u min(1, T(u)/T(x)) >= E[T] / W from any state x, so a stay ends after W / (E[T] p_l)
 * mutations on average at the latest. What is left above the ceiling is a single bright
 * sample of the passes, as it would be in plain bdpt. c -> infinity is bdpt; c = 0, W =
 * infinity is a chain alone, with a target relative to the guess: two-stage MLT
 * [Veach97, chapter 11], [Hoberock10]. */

#include "integrator/split.h"

static double relative(const struct split *split, const struct splat *splat)
{
    return rgb_luminance(splat->value) * (double)split->inverse[splat->pixel];
}

double split_relative(const struct split *split, const struct contrib *sample)
{
    double rho = 0.0;
    for (int i = 0; i < sample->count; i++)
        rho += relative(split, &sample->splats[i]);
    return rho;
}

static void scale(struct contrib *sample, double factor)
{
    for (int i = 0; i < sample->count; i++)
        sample->splats[i].value = rgb_scale(sample->splats[i].value, factor);
}

/* The share of a length's samples. */
static double share_of(const struct split *split, int length, double rho)
{
    enum split_only only = split->only[length];
    return only == SPLIT_BOTH ? split_share(split, rho) : only == SPLIT_CHAINS;
}

void split_for_chain(const struct split *split, int length, struct contrib *sample)
{
    if (sample->count == 0)
        return;
    double rho = split_relative(split, sample), s = share_of(split, length, rho);
    double target = split->unit * rho * s;
    if (!(target > 0.0)) {
        contrib_clear(sample);
        return;
    }
    scale(sample, s);
    sample->target = target;
    sample->rest = (1.0 - s) / s;
}

static void split_techniques(const struct split *split, struct contrib *sample)
{
    sample->target = 0.0;
    for (int i = 0; i < sample->count; i++) {
        struct splat *splat = &sample->splats[i];
        int length = splat->s + splat->t - 1;
        double rho = split->techniques[length] * relative(split, splat);
        double s = share_of(split, length, rho);
        double left = (1.0 - s) * (1.0 - split->large[length]);
        splat->value = rgb_scale(splat->value, left);
        sample->target += rgb_luminance(splat->value);
    }
}

void split_for_passes(const struct split *split, struct contrib *sample)
{
    if (split->by_technique) {
        split_techniques(split, sample);
        return;
    }
    if (sample->count == 0)
        return;
    double s = share_of(split, 0, split_relative(split, sample));
    double left = (1.0 - s) * (1.0 - split->large[0]);
    scale(sample, left);
    sample->target *= left;
}
