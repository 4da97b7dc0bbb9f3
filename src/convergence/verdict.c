#include "convergence/verdict.h"

#include "base/mem.h"
#include "image/metric.h"
#include "convergence/past_snapshots.h"
#include "math/student.h"
#include "math/rgb.h"
#include "math/rhat.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* With fewer spans R-hat has hardly any power. */
#define SPANS_LEAST 8

/* Thresholds of the R-hat tests. A tile is bad if its p-value is below TILE_LEVEL. Under
 * convergence 1 % of the tiles are bad, and neighbouring tiles are correlated; the rule
 * asks for more than 5 % and more than two tiles. No run with independent proposals was
 * rejected by it (bench/verdict.sh). A single tile counts by itself if its p-value times
 * the number of tiles is below VERDICT_FALSE_ALARM. */
#define TILE_LEVEL      0.01
#define TILES_BAD       0.05
#define TILES_BAD_LEAST 2
#define ROUNDING        1e-6 /* relative differences up to this are rounding errors */

/* A picture with more noise than this has not converged even if its parts agree. Nor has
 * one whose error comes mostly from one part (RELMSE_ERROR, relative standard error of
 * relMSE) or whose brightness is uncertain (B_ERROR, relative). */
#define RELMSE_MOST  0.1
#define RELMSE_ERROR 0.5
#define B_ERROR      0.05

/* Largest share of the light on chains that never moved; and largest share that one chain
 * may leave at one state (half a run of one of 256 chains). */
#define NEVER_MOVED_SHARE 0.005
#define STUCK_SHARE       0.002

/* The variance of a pixel is smoothed over 3 x 3 pixels, each with R - 1 degrees of
 * freedom. If they were equal and independent, the mean had 9 (R - 1); with 3 (R - 1) the
 * error bars cover about 95 % (bench/verdict.sh). */
#define BLUR_RADIUS         1
#define FREEDOM_PER_REPLICA 3.0

const char *verdict_name(enum verdict_call call)
{
    static const char *const names[] = {"none", "too short", "not converged",
                                        "converged, but blind", "converged"};
    return names[call];
}

static long pixel_count(const struct image *picture)
{
    return (long)picture->width * picture->height;
}

/* --- tiles ------------------------------------------------------------------------ */

static void fill_tile(const struct time_spans *spans, int tile, int width, int height,
                      float *map, double value)
{
    int left = tile % spans->columns * spans->tile,
        top = tile / spans->columns * spans->tile;
    for (int y = top; y < top + spans->tile && y < height; y++)
        for (int x = left; x < left + spans->tile && x < width; x++)
            map[(long)y * width + x] = isnan(value) ? 0.0f : (float)value;
}

/* P-value of the sequences' R-hat under convergence. 1 where the sequences differ by
 * rounding alone, as where a plain chain's total is known beforehand. */
static double tail_of(const double *x, const struct time_spans *spans, double value)
{
    if (spans->count == 0) /* the run was too short to have spans */
        return 1.0;
    double low = x[0], high = x[0];
    for (int i = 1; i < spans->replicas * spans->count; i++) {
        low = fmin(low, x[i]);
        high = fmax(high, x[i]);
    }
    return high - low > ROUNDING * high ? rhat_tail(value, spans->replicas, spans->count)
                                        : 1.0;
}

static void judge_tile(const struct time_spans *spans, int tile,
                       const struct image *picture, struct verdict *v, double *p)
{
    double x[TIME_SPANS_MOST * REPLICAS_MOST];
    time_spans_sequences(spans, tile, x);
    /* R-hat and ESS of the tile [Vehtari21, sections 3 and 4]. */
    double value = rhat(x, spans->replicas, spans->count);
    double effective = rhat_effective(x, spans->replicas, spans->count);
    *p = tail_of(x, spans, value);
    fill_tile(spans, tile, picture->width, picture->height, v->rhat, value);
    fill_tile(spans, tile, picture->width, picture->height, v->ess, effective);
    v->tiles_bad += *p < TILE_LEVEL;
    v->ess_min = fmin(v->ess_min, effective); /* fmin and > ignore a NaN */
    if (value > v->rhat_max || isnan(v->rhat_max)) {
        v->rhat_max = value;
        v->worst_x = tile % spans->columns * spans->tile + spans->tile / 2;
        v->worst_y = tile / spans->columns * spans->tile + spans->tile / 2;
    }
}

static void judge_tiles(const struct time_spans *spans, const struct image *picture,
                        struct verdict *v)
{
    double x[TIME_SPANS_MOST * REPLICAS_MOST];
    size_t pixels = (size_t)pixel_count(picture);
    v->rhat = mem_alloc(pixels, sizeof *v->rhat);
    v->ess = mem_alloc(pixels, sizeof *v->ess);
    v->tiles = spans->tiles;
    v->spans = spans->count;
    v->worst_p = 1.0;
    for (int i = 0; i < spans->tiles; i++) {
        double p;
        judge_tile(spans, i, picture, v, &p);
        v->worst_p = fmin(v->worst_p, p);
    }
    v->tiles_bad_share = (double)v->tiles_bad / v->tiles;
    time_spans_sequences(spans, -1, x);
    v->agreement_p = tail_of(x, spans, rhat(x, spans->replicas, spans->count));
}

/* --- error bars ------------------------------------------------------------------- */

/* Mean over the square of (2 radius + 1)^2 pixels around each pixel, clipped to the film.
 */
static void blur(const double *from, int width, int height, int radius, double *to)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double sum = 0.0;
            int count = 0;
            for (int v = y - radius; v <= y + radius; v++)
                for (int u = x - radius; u <= x + radius; u++) {
                    if (u < 0 || v < 0 || u >= width || v >= height)
                        continue;
                    sum += from[(long)v * width + u];
                    count++;
                }
            to[(long)y * width + x] = sum / count;
        }
}

/* The floor e^2 of relMSE's denominator r^2 + e^2 treats values far below 0.1 as black.
 * If the whole picture is darker than that, the square of its mean is the floor instead.
 */
static double floor_of(const struct image *picture)
{
    double mean = 0.0;
    for (long i = 0; i < pixel_count(picture); i++)
        mean += rgb_luminance(image_pixel(picture, i)) / (double)pixel_count(picture);
    return mean > 0.0 ? fmin(METRIC_RELATIVE_FLOOR, mean * mean) : METRIC_RELATIVE_FLOOR;
}

/* Computes the variance of every pixel, and the estimate of relMSE with its standard
 * error from the contributions of the replicas. The denominator of replica r's term is
 * the mean of the other replicas, so that it is independent of the deviation in the
 * numerator. */
static void measure_errors(const struct evidence *e, const struct image *picture,
                           double *variances, struct verdict *v)
{
    long n = pixel_count(picture);
    int replicas = e->replicas;
    double parts[REPLICAS_MOST] = {0.0}, common = 0.0, mean = 0.0, squares = 0.0;
    const double floor = METRIC_RELATIVE_FLOOR, low = floor_of(picture);
    v->relmse_dark = 0.0;
    for (long i = 0; i < n; i++) {
        double deviations[REPLICAS_MOST], sum = 0.0;
        double y = rgb_luminance(image_pixel(picture, i));
        double extra = e->deviations(e->self, i, deviations);
        for (int r = 0; r < replicas; r++) {
            double square = deviations[r] * deviations[r] / (replicas - 1.0);
            sum += square / replicas;
            double others = y - deviations[r] / (replicas - 1.0);
            parts[r] += square / (others * others + floor) / (double)n;
            v->relmse_dark += square / (others * others + low) / replicas / (double)n;
        }
        common += extra / (y * y + floor) / (double)n;
        v->relmse_dark += extra / (y * y + low) / (double)n;
        variances[i] = sum + extra;
    }
    for (int r = 0; r < replicas; r++)
        mean += parts[r] / replicas;
    for (int r = 0; r < replicas; r++)
        squares += (parts[r] - mean) * (parts[r] - mean);
    v->relmse = mean + common;
    v->relmse_se = sqrt(squares / (replicas * (replicas - 1.0)));
}

/* Noise of luminance or of the noisiest colour, whichever is larger. */
static void find_noise(const struct evidence *e, const struct image *picture,
                       struct verdict *v)
{
    double colours[3] = {1.0, 1.0, 1.0}, most = 1.0;
    if (e->before)
        past_snapshots_colours(e->now ? e->now : picture, e->before, floor_of(picture),
                               colours);
    v->noise_channel = 3;
    for (int c = 0; c < 3; c++)
        if (colours[c] > most) {
            most = colours[c];
            v->noise_channel = c;
        }
    v->noise = most * v->relmse_dark;
}

static void find_errors(const struct evidence *e, const struct image *picture,
                        struct verdict *v)
{
    size_t n = (size_t)pixel_count(picture);
    double *variances = mem_alloc(n, sizeof *variances);
    double *smooth = mem_alloc(n, sizeof *smooth);
    measure_errors(e, picture, variances, v);
    find_noise(e, picture, v);
    blur(variances, picture->width, picture->height, BLUR_RADIUS, smooth);
    v->se = mem_alloc(n, sizeof *v->se);
    for (size_t i = 0; i < n; i++)
        v->se[i] = (float)sqrt(smooth[i]);
    v->bar_95 = student_quantile(
        0.975,
        FREEDOM_PER_REPLICA * fmax(e->fewest_replicas - 1.0, 1.0 / FREEDOM_PER_REPLICA));
    mem_free(smooth);
    mem_free(variances);
}

/* --- the rule --------------------------------------------------------------------- */

static void add_words(struct verdict *v, const char *format, va_list args)
{
    size_t used = strlen(v->words);
    if (used > 0 && used < sizeof v->words)
        used += (size_t)snprintf(v->words + used, sizeof v->words - used, "; ");
    if (used < sizeof v->words)
        vsnprintf(v->words + used, sizeof v->words - used, format, args);
}

/* Appends a reason against convergence. */
__attribute__((format(printf, 2, 3))) static void add_reason(struct verdict *v,
                                                             const char *format, ...)
{
    va_list args;
    va_start(args, format);
    add_words(v, format, args);
    va_end(args);
    v->call = VERDICT_NOT;
}

/* Appends a note that does not change the verdict. */
__attribute__((format(printf, 2, 3))) static void add_note(struct verdict *v,
                                                           const char *format, ...)
{
    va_list args;
    va_start(args, format);
    add_words(v, format, args);
    va_end(args);
}

static bool too_short(const struct evidence *e, struct verdict *v)
{
    if (v->spans < SPANS_LEAST)
        add_reason(v, "%d spans of time to compare, %d are needed", v->spans,
                   SPANS_LEAST);
    if (e->replicas_with_pass < VERDICT_REPLICAS_LEAST)
        add_reason(v, "%d passes to compare, %d are needed", e->replicas_with_pass,
                   VERDICT_REPLICAS_LEAST);
    if (v->call == VERDICT_NOT)
        v->call = VERDICT_SHORT;
    return v->call == VERDICT_SHORT;
}

/* Whether the replicas agree with each other and with themselves over time: R-hat by tile
 * and of the whole film [Vehtari21, section 3]. */
static void judge_mixing(struct verdict *v)
{
    bool many = v->tiles_bad > TILES_BAD_LEAST && v->tiles_bad_share > TILES_BAD;
    bool one = v->worst_p * v->tiles < VERDICT_FALSE_ALARM;
    if (many || one)
        add_reason(v, "%.*f %% of %d tiles disagree, worst at (%d,%d)",
                   v->tiles_bad_share < 0.1 ? 1 : 0, 100.0 * v->tiles_bad_share, v->tiles,
                   v->worst_x, v->worst_y);
    if (v->agreement_p < VERDICT_FALSE_ALARM)
        add_reason(v, "the parts differ in brightness (p = %.1g)", v->agreement_p);
}

static void judge_noise(struct verdict *v)
{
    static const char *const channels[] = {"red", "green", "blue", "luminance"};
    if (v->relmse > RELMSE_MOST)
        add_reason(v, "the noise is large, relMSE %.2g", v->relmse);
    else if (v->relmse_dark > RELMSE_MOST)
        add_reason(v, "the noise is large for so dark a picture, relMSE %.2g",
                   v->relmse_dark);
    else if (v->noise > RELMSE_MOST)
        add_reason(v, "the noise of %s is large, relMSE %.2g", channels[v->noise_channel],
                   v->noise);
}

/* Whether the error bars can be trusted. */
static void judge_bars(const struct evidence *e, struct verdict *v)
{
    if (e->missed_places > 0)
        add_reason(v,
                   "in %d places large steps find more light than the chains show, "
                   "most clearly in %dx%d pixels about (%d,%d)",
                   e->missed_places, e->missed_side, e->missed_side, e->missed_x,
                   e->missed_y);
    if (e->dim_share >= VERDICT_DIM_SHARE)
        add_reason(v,
                   "%.0f %% of the film, about (%d,%d), is too dim for plain chains: "
                   "fewer than ten states fall on each twentieth of the film",
                   100.0 * e->dim_share, e->dim_x, e->dim_y);
    if (v->relmse_se > RELMSE_ERROR * v->relmse)
        add_reason(v, "the error of one part exceeds that of all others");
    if (e->lost > 0.0)
        add_reason(v, "%.0f values were not finite or too large", e->lost);
    if (e->edges_cut > 0.0)
        add_reason(v, "%.0f edges pass too many panes or masks and count as black",
                   e->edges_cut);
    if (v->b_error > B_ERROR)
        add_reason(v, "brightness is known to %.0f %%", 100.0 * v->b_error);
    if (e->few_chains_share > VERDICT_SHARE)
        add_reason(v,
                   "%.2g %% of the light is on lengths of fewer than %d chains, most on "
                   "%d edges",
                   100.0 * e->few_chains_share, VERDICT_REPLICAS_LEAST,
                   e->few_chains_length);
    if (e->never_moved_share > NEVER_MOVED_SHARE)
        add_reason(v, "chains with %.2g %% of the light never moved",
                   100.0 * e->never_moved_share);
    if (e->stuck_share > STUCK_SHARE)
        add_reason(v, "a chain did not move for %.0f %% of its mutations",
                   100.0 * e->stuck_fraction);
}

static void set_call(struct verdict *v, enum verdict_call what, const char *words)
{
    v->call = what;
    snprintf(v->words, sizeof v->words, "%s", words);
}

static void judge(const struct evidence *e, struct verdict *v)
{
    if (e->missing)
        set_call(v, VERDICT_NONE, e->missing);
    else if (e->no_light)
        set_call(v, VERDICT_NOT, "no light was found");
    else if (e->not_started)
        set_call(v, VERDICT_SHORT, "the run ended before its chains moved");
    else if (!too_short(e, v)) {
        v->call = VERDICT_CONVERGED;
        judge_mixing(v);
        judge_bars(e, v);
        v->error_bars_valid = v->call == VERDICT_CONVERGED;
        judge_noise(v);
    }
    if (v->call == VERDICT_CONVERGED && e->blind_to && e->blind_to[0])
        v->call = VERDICT_BLIND;
    if (e->plain_only_length > 0)
        add_note(v, "no chain is needed: no light was found on more than %d edge%s",
                 e->plain_only_length, e->plain_only_length == 1 ? "" : "s");
    if (e->replicas > 0 && e->replicas < e->replicas_wanted)
        add_note(v, "by %d parts of the run: %d would take more than %.0f MB",
                 e->replicas, e->replicas_wanted, REPLICAS_BYTES / 0x1p20);
}

void verdict_find(const struct evidence *e, const struct image *picture,
                  struct verdict *v)
{
    const double none = (double)NAN;
    *v = (struct verdict){
        .replicas = e->replicas,
        .parts = e->fewest_replicas < e->replicas ? e->fewest_replicas : e->replicas,
        .tiles_bad_share = none,
        .rhat_max = none,
        .ess_min = none,
        .agreement_p = none,
        .relmse = none,
        .relmse_se = none,
        .relmse_dark = none,
        .noise = none,
        .energy_top = e->energy_top,
        .stuck_share = e->stuck_share,
        .never_moved_share = e->never_moved_share,
        .few_chains_share = e->few_chains_share,
        .b_error = e->b_error,
        .bar_95 = none,
    };
    if (!e->missing && !e->no_light && !e->not_started) {
        find_errors(e, picture, v);
        judge_tiles(e->spans, picture, v);
    }
    judge(e, v);
}

void verdict_deinit(struct verdict *v)
{
    mem_free(v->rhat);
    mem_free(v->ess);
    mem_free(v->se);
    *v = (struct verdict){0};
}
