/* Independent samples: the picture so far, figures, checkpoints and evidence. */

#include "integrator/passes_state.h"

#include <assert.h>
#include <limits.h>

double passes_paths(const struct passes *p)
{
    double paths = (double)p->pass * passes_pixels(p);
    for (int y = 0; y < p->height; y++)
        paths += p->under_way[y].done;
    return paths;
}

long passes_whole(const struct passes *p)
{
    return p->pass;
}

/* Camera samples of a pixel are divided by their number, which in an incomplete pass
 * differs between pixels.
 *
 * Light splats (t = 1) have another count. The light sub-path of a sample is drawn,
 * connected to the lens and weighted [Veach97, section 10.3.4] independently of the
 * camera sub-path, so the expectation v_j at pixel j is the same for every path,
 * whichever pixel it was traced for. Splats are scaled such that one path for each of the
 * N pixels sums to I_j: E[v_j] = I_j / N. After P paths, I_j is estimated by N / P times
 * the sum of the splats. A pixel with n samples gets n N / P of the sum before it is
 * divided by n; the factor is exactly 1 after whole passes.
 *
 * When the clock ends a pass, the number of samples of a pixel depends on the time that
 * earlier samples took, as for any average that a clock ends. No sample that was begun is
 * dropped. */
void passes_picture(void *self, struct image *out)
{
    const struct passes *p = self;
    double paths = passes_paths(p), pixels = passes_pixels(p);
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            long i = (long)y * p->width + x, samples = passes_samples(p, x, y);
            double n = (double)samples;
            struct rgb v = rgb(p->sums[3 * i], p->sums[3 * i + 1], p->sums[3 * i + 2]);
            if (p->light && samples > 0)
                v = rgb_add(v, rgb_scale(film_value(p->light, (int)i),
                                         p->unit * (n * pixels / paths)));
            v = rgb_scale(v, samples > 0 ? p->scene->emission_scale / n : 0.0);
            out->pixels[3 * i] = (float)v.r;
            out->pixels[3 * i + 1] = (float)v.g;
            out->pixels[3 * i + 2] = (float)v.b;
        }
}

/* Mean over the film in emission units. Every pixel has one sample a pass, so differences
 * between pixels are no error; the variance is that of a row's sum between passes. In an
 * incomplete pass only complete rows count. During the first pass the complete rows stand
 * for all. */
static void brightness(const struct passes *p, double *b, double *b_se)
{
    double sum = 0.0, variance = 0.0, pixels = passes_pixels(p), rows = 0.0;
    for (int y = 0; y < p->height; y++) {
        const struct welford *row = &p->rows[y];
        rows += row->count > 0.0;
        sum += row->mean;
        if (p->pass > 0) /* variance of the mean, times the number of passes */
            variance += welford_variance(row) * ((double)p->pass / row->count);
    }
    *b = rows > 0.0 ? sum * (p->height / rows) / pixels : 0.0;
    *b_se = p->pass < 2 ? (double)INFINITY : sqrt(variance / (double)p->pass) / pixels;
}

void passes_statistics(const void *self, struct run_statistics *out)
{
    const struct passes *p = self;
    const double none = (double)NAN;
    double b, b_se;
    brightness(p, &b, &b_se);
    *out = (struct run_statistics){
        .paths = passes_paths(p),
        .unsampled = p->pass > 0 ? 0.0 : 1.0 - passes_paths(p) / passes_pixels(p),
        .b = b * p->scene->emission_scale,
        .b_se = b_se * p->scene->emission_scale,
        .plarge = {.p_l = none, .p_l_lo = none, .p_l_hi = none},
        .acceptance = none,
        .failure_rate = none,
        .most_rejections_in_row = none,
        .chains_never_moved = none,
        .saturated = p->light ? (double)film_saturated(p->light) : 0.0,
    };
    for (int i = 0; i < p->threads; i++)
        out->nonfinite += (double)p->workers[i].contrib.nonfinite;
}

/* It does not matter which worker counted a non-finite value: the first gets the sum. */
static void pack_nonfinite(struct passes *p, struct pack *pack)
{
    long nonfinite = 0;
    for (int i = 0; i < p->threads; i++)
        nonfinite += p->workers[i].contrib.nonfinite;
    pack_long(pack, "nonfinite", &nonfinite, 0, LONG_MAX);
    if (pack_reads(pack))
        p->workers[0].contrib.nonfinite = nonfinite;
}

/* Points the lanes to the replica of the incomplete pass. */
static void pack_under_way(struct passes *p, struct pack *pack)
{
    for (int y = 0; y < p->height && pack_ok(pack); y++) {
        struct pass_row *row = &p->under_way[y];
        pack_uint32s(pack, "done", &row->done, 1);
        pack_double(pack, "targets", &row->targets);
        if (row->done > (uint32_t)p->width)
            pack_refuse(pack, "samples of a row");
    }
    pack_long(pack, "turn", &p->turn, 0, p->height - 1);
    if (p->replicas) {
        replicas_pack(pack, p->pending);
        passes_assign_replica(p);
    }
}

void passes_pack(void *self, struct pack *pack)
{
    struct passes *p = self;
    size_t pixels = (size_t)p->width * (size_t)p->height;
    pack_long(pack, "pass", &p->pass, 0, LONG_MAX);
    pack_doubles(pack, "sums", p->sums, 3 * pixels);
    welford_pack(pack, "rows", p->rows, (size_t)p->height);
    pack_nonfinite(p, pack);
    pack_double(pack, "unit", &p->unit);
    if (p->light)
        film_pack(pack, p->light);
    if (p->replicas) {
        replicas_pack(pack, p->replicas);
        time_spans_pack(pack, &p->spans);
    }
    pack_under_way(p, pack);
}

/* --- evidence --------------------------------------------------------------------- */

int passes_replicas_with_pass(const struct passes *p, int replicas)
{
    return p->pass < replicas ? (int)p->pass : replicas;
}

/* Replicas without a pass stay at the mean; the deviations of the others are scaled up.
 */
void passes_add_deviations(const struct passes *p, long pixel, int replicas, double *out)
{
    double values[REPLICAS_MOST], mean = 0.0;
    int used = p->pass < replicas ? (int)p->pass : replicas;
    assert(p->replicas->count == replicas);
    for (int r = 0; r < used; r++) {
        long passes = (p->pass - r + replicas - 1) / replicas;
        values[r] = replicas_value(p->replicas, r, pixel) / (double)passes;
        mean += values[r] / used;
    }
    if (used < 2)
        return;
    double scale = p->unit * p->scene->emission_scale *
                   sqrt(replicas * (replicas - 1.0) / (used * (used - 1.0)));
    for (int r = 0; r < used; r++)
        out[r] += scale * (values[r] - mean);
}

static double deviations(const void *self, long pixel, double *out)
{
    const struct passes *p = self;
    for (int r = 0; r < p->replicas->count; r++)
        out[r] = 0.0;
    passes_add_deviations(p, pixel, p->replicas->count, out);
    return 0.0;
}

void passes_evidence(void *self, struct evidence *out)
{
    struct passes *p = self;
    double b, b_se;
    *out = (struct evidence){.energy_top = (double)NAN};
    brightness(p, &b, &b_se);
    out->no_light = !(b > 0.0) && p->pass > 0;
    if (p->settings->replicas < VERDICT_REPLICAS_LEAST)
        out->missing = "replicas=1";
    else if (!p->replicas)
        out->missing = "the replicas of so large a film take too much memory";
    if (out->missing || out->no_light)
        return;
    out->replicas = p->replicas->count;
    out->replicas_wanted = (int)p->settings->replicas;
    out->spans = &p->spans;
    out->deviations = deviations;
    out->self = p;
    out->energy_top = replicas_top(p->replicas, 1e-3);
    out->replicas_with_pass = out->fewest_replicas = passes_replicas_with_pass(
        p, out->replicas);
    out->b_error = b_se / b;
}
