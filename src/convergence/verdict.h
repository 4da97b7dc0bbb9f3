#ifndef ETALON_CONVERGENCE_VERDICT_H
#define ETALON_CONVERGENCE_VERDICT_H

/* Whether a run has converged, and how large its error is: from replicas, independent
 * parts of the run that each give a whole picture, and from their sequences in time
 * [Vehtari21]. The integrator says what it knows (evidence); the rule is the same for
 * all. */

#include "image/image.h"
#include "convergence/time_spans.h"

/* BLIND: converged, to a picture that may lack light, see evidence.blind_to. */
enum verdict_call {
    VERDICT_NONE,
    VERDICT_SHORT,
    VERDICT_NOT,
    VERDICT_BLIND,
    VERDICT_CONVERGED
};

#define VERDICT_REPLICAS_LEAST 4
#define VERDICT_SHARE          0.02 /* of the light: less of it does not decide a verdict */

/* False-alarm probability of the test of one place of the film. */
#define VERDICT_FALSE_ALARM 1e-3

/* Of the film: as much may be too dim for chains to resolve it. */
#define VERDICT_DIM_SHARE 0.05

struct evidence {
    const char *missing; /* why there are no replicas; else NULL */
    bool no_light;       /* no light was found */
    bool not_started;    /* the run ended before there was anything to judge */
    int replicas;
    int replicas_wanted;            /* more would take too much memory */
    const struct time_spans *spans; /* of what could fail to mix */
    /* Deviations of the replicas' luminance from their mean at a pixel, out[replicas],
     * such that their sum of squares over R (R - 1) estimates the variance of the
     * picture; returns variance that comes on top, as it is common to all replicas. In
     * the units of the picture. */
    double (*deviations)(const void *self, long pixel, double *out);
    const void *self;
    int replicas_with_pass; /* replicas that have a pass, where passes are part of the
                               picture */
    int fewest_replicas;    /* replicas that have their own share of all that carries
                               VERDICT_SHARE */
    double energy_top;      /* share of the brightest 0.1 % of splats; NAN: not known */
    double b_error;         /* relative standard error of the mean brightness */
    double
        few_chains_share; /* of brightness, on fewer than VERDICT_REPLICAS_LEAST chains */
    int few_chains_length;    /* the brightest of them */
    double never_moved_share; /* of brightness, on chains that never moved */
    double stuck_share;       /* most brightness that one chain's longest stay carries */
    double stuck_fraction;    /* of that chain, relative to its length */
    /* Squares of pixels in which independent large steps find more light than the chains
     * have shown, each at VERDICT_FALSE_ALARM over the number of those that were looked
     * at; middle and side of the surest. */
    int missed_places, missed_x, missed_y, missed_side;
    /* Part of the film that is so dim that plain chains have fewer than ten states on any
     * VERDICT_DIM_SHARE of it; and a place there. */
    double dim_share;
    int dim_x, dim_y;
    const struct image *before; /* the picture of an earlier time, or NULL */
    double lost; /* values that were no numbers, or too large to be counted */
    /* Not 0: beyond so many edges independent paths found no light, and there are no
     * chains; all light is that of plain samples. */
    int plain_only_length;
    const char *blind_to; /* paths that no sample can be of (path/blind.h); NULL or "" */
};

struct verdict {
    enum verdict_call call;
    char words[400];       /* why, and what was left out, in one line */
    bool error_bars_valid; /* nothing but noise speaks against it: its error bars hold */
    int parts;             /* that relmse_se rests on */
    int replicas, spans, tiles, tiles_bad;
    double tiles_bad_share; /* NAN where not known, as all below */
    double rhat_max, ess_min;
    int worst_x, worst_y;     /* a pixel in the middle of the tile with rhat_max */
    double worst_p;           /* least p-value of a tile */
    double b_error;           /* relative standard error of the mean brightness */
    double agreement_p;       /* p-value: replicas are equally bright */
    double relmse, relmse_se; /* as metric.h defines it, from the error bars */
    /* The same, where the mean of the picture is below 0.1 with its square in the place
     * of 0.01; and of the noisiest colour then, 0 to 2, or of luminance, 3. */
    double relmse_dark, noise;
    int noise_channel;
    double energy_top, stuck_share, never_moved_share, few_chains_share;
    double bar_95;     /* what se is multiplied by for a 95 % bar */
    float *rhat, *ess; /* of the pixel's tile, 0: cannot tell; [height][width], or NULL */
    float *se;         /* of the pixel's luminance, [height][width], or NULL */
};

const char *verdict_name(enum verdict_call call);
void verdict_find(const struct evidence *e, const struct image *picture,
                  struct verdict *v);
void verdict_deinit(struct verdict *v);

#endif
