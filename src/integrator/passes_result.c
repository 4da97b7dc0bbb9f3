/* Independent samples: the picture so far, figures, checkpoints and evidence. */

#include "integrator/passes_state.h"

#include <assert.h>
#include <limits.h>

double passes_paths(const struct passes *p)
{
    const struct adaptive *a = &p->adaptive;
    double pixels = passes_pixels(p);
    double paths = (double)a->start * pixels +
                   (double)passes_alike(p) * (a->each ? a->total : pixels);
    for (long y = 0; y < p->height; y++)
        for (long x = 0; x < p->under_way[y].done; x++)
            paths += (double)passes_each(p, y * p->width + x);
    return paths;
}

long passes_whole(const struct passes *p)
{
    return p->pass;
}

double passes_traced(const struct passes *p)
{
    double paths = 0.0;
    for (long i = 0; i < (long)p->width * p->height; i++)
        paths += p->counts[i];
    return paths;
}

/* Camera samples of a pixel are divided by their number, which in an incomplete pass, or
 * without a part of the run, differs between pixels.
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
    double paths = passes_traced(p), pixels = passes_pixels(p);
    for (long i = 0; i < (long)p->width * p->height; i++) {
        double n = p->counts[i];
        struct rgb v = rgb_scale(rgb(exact_value(p->sums[3 * i]),
                                     exact_value(p->sums[3 * i + 1]),
                                     exact_value(p->sums[3 * i + 2])),
                                 p->scale);
        if (p->light && n > 0.0)
            v = rgb_add(v, rgb_scale(film_value(p->light, (int)i),
                                     p->unit * (n * pixels / paths)));
        v = rgb_scale(v, n > 0.0 ? p->scene->emission_scale / n : 0.0);
        out->pixels[3 * i] = (float)v.r;
        out->pixels[3 * i + 1] = (float)v.g;
        out->pixels[3 * i + 2] = (float)v.b;
    }
}

/* Light splats in the scale of the camera's; the factor is rounded to 2^-16. Camera
 * samples of a pixel are weighted by the mean number over its own. */
#define FIXED_BITS 16

static int64_t camera_weight(const struct passes *p, long pixel)
{
    const struct adaptive *a = &p->adaptive;
    double start = (double)a->start, alike = (double)passes_alike(p);
    if (!a->each)
        return 1 << FIXED_BITS;
    double mean = start + alike * a->total / passes_pixels(p);
    return (int64_t)ldexp(mean / (start + alike * a->each[pixel]), FIXED_BITS);
}

void passes_add_fixed(const struct passes *p, long pixel, exact_sum sums[3])
{
    if (p->unit == 0.0) /* nothing is traced */
        return;
    int64_t light = (int64_t)ldexp(p->unit / p->scale, FIXED_BITS);
    int64_t camera = camera_weight(p, pixel);
    for (int i = 0; i < 3; i++) {
        exact_sum sum = exact_times(p->sums[3 * pixel + i], camera);
        if (p->light)
            sum = exact_add(sum, exact_times(film_exact(p->light, (int)pixel, i), light));
        sums[i] = exact_add(sums[i], sum);
    }
}

static void add_fixed(const void *self, long pixel, exact_sum sums[FIXED_SUMS])
{
    passes_add_fixed(self, pixel, sums);
}

void passes_fixed_picture(void *self, struct fixed_picture *out)
{
    const struct passes *p = self;
    double passes = passes_paths(p) / passes_pixels(p);
    *out = (struct fixed_picture){
        .self = p,
        .add = add_fixed,
        .scales = {passes > 0.0
                       ? ldexp(p->scale, -FIXED_BITS) * p->scene->emission_scale / passes
                       : 0.0},
        .count = 3,
    };
}

/* Variance of the mean of a row over its passes, in units of scale^2. */
static double row_variance(const struct row_sums *row)
{
    long double n = (long double)row->passes, sum = (long double)row->targets,
                squares = (long double)row->squares;
    sum = ldexpl(sum, -EXACT_BITS);
    squares = ldexpl(squares, -EXACT_BITS) / (long double)ROW_SQUARES;
    if (row->passes < 2)
        return 0.0;
    return fmax((double)((squares - sum * sum / n) / (n * (n - 1.0L))), 0.0);
}

/* Mean over the film in emission units. Every pixel has one sample a pass, so differences
 * between pixels are no error; the variance is that of a row's mean between passes. In an
 * incomplete pass only complete rows count. During the first pass the complete rows stand
 * for all. */
void passes_brightness(const struct passes *p, double *b, double *b_se)
{
    double sum = 0.0, variance = 0.0, rows = 0.0;
    for (int y = 0; y < p->height; y++) {
        const struct row_sums *row = &p->rows[y];
        if (row->passes == 0)
            continue;
        rows += 1.0;
        sum += exact_value(row->targets) / (double)row->passes;
        variance += row_variance(row);
    }
    *b = rows > 0.0 ? p->scale * sum / rows : p->adaptive.start_b;
    *b_se = passes_alike(p) < 2 ? (double)INFINITY
                                : p->scale * sqrt(variance) / p->height;
}

static double unsampled(const struct passes *p)
{
    double none = 0.0;
    for (long i = 0; i < (long)p->width * p->height; i++)
        none += p->counts[i] == 0;
    return none / passes_pixels(p);
}

void passes_statistics(const void *self, struct run_statistics *out)
{
    const struct passes *p = self;
    const double none = (double)NAN;
    double b, b_se;
    passes_brightness(p, &b, &b_se);
    *out = (struct run_statistics){
        .paths = passes_traced(p),
        .unsampled = unsampled(p),
        .b = b * p->scene->emission_scale,
        .b_se = b_se * p->scene->emission_scale,
        .plarge = {.p_l = none, .p_l_lo = none, .p_l_hi = none},
        .split = split_figures_none,
        .race = race_figures_none,
        .adaptive = {.start = p->adaptive.each ? (double)p->adaptive.start : none,
                     .predicted = p->adaptive.predicted},
        .acceptance = none,
        .failure_rate = none,
        .most_rejections_in_row = none,
        .chains_never_moved = none,
        .saturated = (double)p->clamped +
                     (p->light ? (double)film_saturated(p->light) : 0.0),
    };
    for (int i = 0; i < p->threads; i++)
        out->nonfinite += (double)p->workers[i].contrib.nonfinite;
}

void passes_counts(const void *self, struct run_counts *out)
{
    const struct passes *p = self;
    *out = (struct run_counts){
        .paths = part_is_whole(p->part) ? passes_paths(p) : passes_traced(p),
        .acceptance = (double)NAN,
        .p_large = (double)NAN,
    };
}

/* It does not matter which worker counted a non-finite value: the first gets the sum. */
static void pack_nonfinite(struct passes *p, struct pack *pack)
{
    long nonfinite = 0;
    for (int i = 0; i < p->threads; i++)
        nonfinite += p->workers[i].contrib.nonfinite;
    pack_sum_long(pack, "nonfinite", &nonfinite);
    if (pack_reads(pack))
        for (int i = 0; i < p->threads; i++)
            p->workers[i].contrib.nonfinite = i == 0 ? nonfinite : 0;
}

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
    if (p->replicas)
        replicas_pack(pack, p->pending);
}

/* What the parts of a run have in common. The number of passes differs between them under
 * a time budget. */
static void pack_common(struct passes *p, struct pack *pack)
{
    long pass = p->pass;
    double unit = p->unit;
    pack_long(pack, "pass", &pass, 0, LONG_MAX);
    pack_double(pack, "unit", &unit);
    if (!pack_reads(pack) || !pack_ok(pack))
        return;
    if (pack_adds(pack) && p->unit > 0.0 && unit != p->unit)
        pack_refuse(pack, "the unit of its sums is not that of the other parts");
    p->pass = pack_adds(pack) && p->pass > pass ? p->pass : pass;
    p->unit = unit;
    passes_set_scale(p);
}

static void pack_rows(struct passes *p, struct pack *pack)
{
    for (int y = 0; y < p->height; y++) {
        exact_pack(pack, "targets", &p->rows[y].targets, 1);
        exact_pack(pack, "squares", &p->rows[y].squares, 1);
        pack_sum_int64s(pack, "passes", &p->rows[y].passes, 1);
    }
}

void passes_pack(void *self, struct pack *pack)
{
    struct passes *p = self;
    size_t height = (size_t)p->height, pixels = (size_t)p->width * height;
    pack_common(p, pack);
    if (pack_reads(pack) && !pack_adds(pack))
        p->part = pack_part(pack);
    exact_pack(pack, "sums", p->sums, 3 * pixels);
    pack_sum_uint32s(pack, "counts", p->counts, pixels);
    pack_rows(p, pack);
    pack_nonfinite(p, pack);
    pack_sum_long(pack, "clamped", &p->clamped);
    if (p->light)
        film_pack(pack, p->light);
    pass_layers_pack(&p->layers, pack);
    if (p->replicas) {
        replicas_pack(pack, p->replicas);
        pack_sum_uint32s(pack, "replica_rows", p->replica_rows,
                         (size_t)p->replicas->count * height);
        time_spans_pack(pack, &p->spans);
    }
    pack_under_way(p, pack);
    passes_adaptive_pack(p, pack);
}

/* --- evidence --------------------------------------------------------------------- */

int passes_replicas_with_pass(const struct passes *p, int replicas)
{
    long passes = passes_alike(p);
    return passes < replicas ? (int)passes : replicas;
}

/* Of a pixel's samples, those after the measured start, from which its replicas are. */
static double share_alike(const struct passes *p, long pixel)
{
    double alike = (double)passes_alike(p) * (double)passes_each(p, pixel);
    return alike > 0.0 ? alike / (alike + (double)p->adaptive.start) : 1.0;
}

/* Replicas without a pass stay at the mean; the deviations of the others are scaled up.
 */
void passes_add_deviations(const struct passes *p, long pixel, int replicas, double *out)
{
    double values[REPLICAS_MOST], mean = 0.0, used = 0.0;
    long y = pixel / p->width;
    assert(p->replicas->count == replicas);
    for (int r = 0; r < replicas; r++) {
        uint32_t passes = p->replica_rows[(long)r * p->height + y];
        values[r] = (double)NAN;
        if (passes == 0)
            continue;
        values[r] = replicas_value(p->replicas, r, pixel) / passes;
        mean += values[r];
        used += 1.0;
    }
    if (used < 2.0)
        return;
    double scale = p->unit * p->scene->emission_scale *
                   sqrt(replicas * (replicas - 1.0) / (used * (used - 1.0)) *
                        share_alike(p, pixel));
    for (int r = 0; r < replicas; r++)
        if (!isnan(values[r]))
            out[r] += scale * (values[r] - mean / used);
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
    passes_brightness(p, &b, &b_se);
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
