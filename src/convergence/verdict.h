#ifndef ETALON_CONVERGENCE_VERDICT_H
#define ETALON_CONVERGENCE_VERDICT_H

/* Whether a run has converged, and how large its error is. Both are estimated from
 * replicas, independent parts of the run that each give a whole picture, and from their
 * sequences in time by R-hat [Vehtari21, section 3]. The integrator supplies the
 * evidence; one rule judges it for all integrators. */

#include "image/image.h"
#include "convergence/time_spans.h"

/* BLIND: converged to a picture that may lack light, see evidence.blind_to. */
enum verdict_call {
    VERDICT_NONE,
    VERDICT_SHORT,
    VERDICT_NOT,
    VERDICT_BLIND,
    VERDICT_CONVERGED
};

#define VERDICT_REPLICAS_LEAST 4
#define VERDICT_SHARE          0.02 /* of the light; a length with less decides nothing */

/* False-alarm probability of one test: of all tiles, of the film's brightness, of all
 * blocks of missed light. */
#define VERDICT_FALSE_ALARM 1e-3

/* Share of the film that may be too dim for chains to resolve. */
#define VERDICT_DIM_SHARE 0.05

struct evidence {
    const char *missing; /* why there are no replicas; else NULL */
    bool no_light;       /* neither bootstrap paths nor samples found light */
    bool not_started;    /* the run ended before its chains or passes began */
    int replicas;
    /* Number asked for; `replicas` is less where they would take too much memory. */
    int replicas_wanted;
    const struct time_spans *spans; /* sequences that R-hat compares */
    /* Writes the deviations of the replicas' luminance from their mean at a pixel to
     * out[replicas]; their sum of squares over R (R - 1) estimates the variance of the
     * picture. Returns an additional variance that is common to all replicas. In the
     * units of the picture. */
    double (*deviations)(const void *self, long pixel, double *out);
    const void *self;
    /* Where passes are part of the picture: replicas with at least one; else all. */
    int replicas_with_pass;
    /* Least number of independent replicas over the path lengths that carry more than
     * VERDICT_SHARE. */
    int fewest_replicas;
    /* Share of the light in the brightest 0.1 % of splats; NAN: unknown. */
    double energy_top;
    double b_error; /* relative standard error of the mean brightness */
    /* Share of the light on lengths of fewer than VERDICT_REPLICAS_LEAST chains. */
    double few_chains_share;
    int few_chains_length;    /* the brightest of these lengths */
    double never_moved_share; /* share of the light on chains that never moved */
    /* Share of the light that a chain left at one state, the largest of any. */
    double stuck_share;
    double stuck_fraction; /* share of that chain's mutations without a move */
    /* Number of blocks in which large steps find more light than the chains show
     * (missed_light.h), tested at VERDICT_FALSE_ALARM over the number of blocks; middle
     * and side, in pixels, of the block with the least p-value. */
    int missed_places, missed_x, missed_y, missed_side;
    /* Share of the film that is too dim for plain chains (missed_light.h), and a place in
     * it. */
    double dim_share;
    int dim_x, dim_y;
    /* An earlier picture (past_snapshots.h), or NULL; and what to compare it with, NULL:
     * the picture. */
    const struct image *before, *now;
    double lost;      /* number of non-finite and of clamped values */
    double edges_cut; /* number of edges that pass too much to carry light */
    /* Not 0: bootstrap paths of more than this many edges found no light, so there are no
     * chains and all light is that of plain samples. */
    int plain_only_length;
    /* Path families that no sample can contain (path/blind.h); NULL or "". */
    const char *blind_to;
};

struct verdict {
    enum verdict_call call;
    char words[400]; /* reasons and notes, in one line */
    /* No reason but noise against convergence: relmse and relmse_se can be trusted. */
    bool error_bars_valid;
    int parts; /* number of independent parts behind relmse_se */
    int replicas, spans, tiles, tiles_bad;
    double tiles_bad_share; /* NAN where not known, as all below */
    double rhat_max, ess_min;
    int worst_x, worst_y; /* a pixel in the middle of the tile with rhat_max */
    double worst_p;       /* least p-value of a tile */
    double b_error;       /* relative standard error of the mean brightness */
    double agreement_p;   /* p-value of the test that all replicas are equally bright */
    double relmse,
        relmse_se; /* estimate of the picture's relMSE (metric.h) by the error bars */
    /* relMSE with the squared mean of the picture in the place of 0.01 if the mean is
     * below 0.1 (relmse_dark); that of the noisiest colour, 0 to 2, or of luminance, 3
     * (noise). */
    double relmse_dark, noise;
    int noise_channel;
    double energy_top, stuck_share, never_moved_share, few_chains_share;
    double bar_95;     /* factor of se for a 95 % error bar */
    float *rhat, *ess; /* of the pixel's tile, 0: unknown; [height][width], or NULL */
    float *se; /* standard error of the pixel's luminance, [height][width], or NULL */
};

const char *verdict_name(enum verdict_call call);
void verdict_find(const struct evidence *e, const struct image *picture,
                  struct verdict *v);
void verdict_deinit(struct verdict *v);

#endif
