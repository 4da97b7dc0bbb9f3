/* Adaptive film sampling: passes of one sample a pixel measure the errors of pixels, from
 * which those after them have their numbers of samples (sample_map.h). */

#include "base/clock.h"
#include "chain/state.h"
#include "image/metric.h"
#include "integrator/passes_state.h"
#include "integrator/sample_map.h"

#include <string.h>

#define START_SHARE  0.2 /* of the samples, in the measured start */
#define SHARE_MOST   0.5 /* of a time budget: later there is too little left */
#define START_MOST   256 /* passes: parts of a run repeat them */
#define START_LEAST  8   /* passes */
#define PASSES_LEAST 8   /* after the start: one for each replica by default */
#define LEAST        (START_LEAST + PASSES_LEAST * SAMPLE_MAP_MEAN) /* samples a pixel */

static bool wanted(const struct settings *s, const struct passes_plan *plan)
{
    bool enough = s->seconds > 0.0 || s->mutations_per_pixel >= LEAST;
    return plan->may_adapt && settings_film_sampling(s) == FILM_SAMPLING_ADAPTIVE &&
           enough && !(s->layers & ~LAYER_FEATURES);
}

/* Passes of the start, such that those after it use up the budget. */
static long planned_start(long budget)
{
    long start = (long)ceil(START_SHARE * (double)budget);
    start = start < START_MOST ? start : START_MOST;
    start = start > START_LEAST ? start : START_LEAST;
    return start + (budget - start) % SAMPLE_MAP_MEAN;
}

void passes_adaptive_init(struct passes *p, const struct passes_plan *plan)
{
    struct adaptive *a = &p->adaptive;
    size_t pixels = (size_t)p->width * (size_t)p->height;
    *a = (struct adaptive){.light_weight = 1.0, .predicted = (double)NAN};
    if (!wanted(p->settings, plan))
        return;
    a->measuring = true;
    a->planned = p->budget > 0 ? planned_start(p->budget) : 0;
    a->squares = mem_alloc(pixels, sizeof *a->squares);
    a->work = mem_alloc(pixels, sizeof *a->work);
    for (int i = 0; i < p->threads; i++)
        passes_worker_count(&p->workers[i], true);
    if (p->light) {
        a->light = film_create(p->width, p->height);
        film_add_lanes(a->light, p->threads, FILM_LANES_BYTES);
    }
}

static void end_measuring(struct passes *p)
{
    struct adaptive *a = &p->adaptive;
    if (!a->squares)
        return;
    a->measuring = false;
    mem_free(a->squares);
    mem_free(a->work);
    film_destroy(a->light);
    a->squares = a->work = NULL;
    a->light = NULL;
    for (int i = 0; i < p->threads; i++)
        passes_worker_count(&p->workers[i], false);
}

void passes_adaptive_deinit(struct passes *p)
{
    end_measuring(p);
    mem_free(p->adaptive.each);
}

void passes_adaptive_memory(const struct scene *scene, const struct settings *settings,
                            const struct passes_plan *plan, struct run_memory *out)
{
    int width = scene->camera.width, height = scene->camera.height;
    double pixels = (double)width * height;
    double lanes = film_lanes_bytes(width, height, settings_threads(settings));
    if (!wanted(settings, plan))
        return;
    /* Squares and work; the map; errors, work and planes while it is made. */
    out->states += pixels * (3.0 * sizeof(uint32_t) + 10.0 * sizeof(double));
    if (plan->light_image) {
        out->films += film_bytes(width, height) +
                      (lanes <= FILM_LANES_BYTES ? lanes : 0.0);
        out->rare += film_rare_bytes(width, height);
    }
}

/* --- the measured start ------------------------------------------------------------ */

void passes_measure(struct passes *p, int x, int y, int thread)
{
    struct worker *w = &p->workers[thread];
    const struct contrib *c = &w->contrib;
    double camera = 0.0;
    int colour = sample_map_colour(x, y);
    struct adaptive *a = &p->adaptive;
    struct film *light = a->light ? film_lane(a->light, thread) : NULL;
    for (int i = 0; i < c->count; i++) {
        const struct splat *splat = &c->splats[i];
        int at_x = splat->pixel % p->width, at_y = splat->pixel / p->width;
        if (splat->t != 1)
            camera += rgb_luminance(splat->value);
        else if (sample_map_colour(at_x, at_y) == colour)
            film_splat(light, splat->pixel, splat->value, 1.0 / p->unit);
    }
    a->squares[(long)y * p->width + x] += camera * camera;
    a->work[(long)y * p->width + x] += state_work(w->numbers.events, c->connections);
    w->numbers.events = 0;
}

/* Luminance of a pixel from the start's samples of its own colour: camera's, and all. */
static double camera_mean(const struct passes *p, long i)
{
    const exact_sum *sums = p->sums + 3 * i;
    struct rgb v = rgb(exact_value(sums[0]), exact_value(sums[1]), exact_value(sums[2]));
    return rgb_luminance(v) * p->scale / (double)p->pass;
}

static double whole_mean(const struct passes *p, long i, double share)
{
    double light = 0.0;
    if (p->adaptive.light)
        light = rgb_luminance(film_value(p->adaptive.light, (int)i)) * p->unit /
                ((double)p->pass * share);
    return camera_mean(p, i) + light;
}

/* Relative variances of a sample of each pixel of a colour, as relMSE has them; in a
 * darker picture its floor is the squared mean. */
static void find_errors(const struct passes *p, int colour, float *errors)
{
    double n = (double)p->pass, sum = 0.0, count = 0.0;
    for (int y = 0; y < p->height; y++)
        for (int x = sample_map_first(colour, y); x < p->width; x += 2)
            count += 1.0;
    double share = count / passes_pixels(p);
    for (int y = 0; y < p->height; y++)
        for (int x = sample_map_first(colour, y); x < p->width; x += 2)
            sum += whole_mean(p, (long)y * p->width + x, share);
    double mean = sum / fmax(count, 1.0), scale = p->scene->emission_scale;
    double floor = fmin(METRIC_RELATIVE_FLOOR / (scale * scale), mean * mean);
    for (int y = 0; y < p->height; y++)
        for (int x = sample_map_first(colour, y); x < p->width; x += 2) {
            long i = (long)y * p->width + x;
            double camera = camera_mean(p, i), whole = whole_mean(p, i, share);
            double squares = p->adaptive.squares[i] - n * camera * camera;
            double error = fmax(squares, 0.0) / ((n - 1.0) * (whole * whole + floor));
            errors[i] = isfinite(error) ? (float)error : 0.0f;
        }
}

/* What follows from the map and from the length of the start. */
static void apply_map(struct passes *p)
{
    struct adaptive *a = &p->adaptive;
    a->total = 0.0;
    for (long i = 0; i < (long)passes_pixels(p); i++)
        a->total += a->each[i];
    a->light_weight = passes_pixels(p) / a->total;
    if (p->budget > 0)
        p->budget = a->start + (p->budget - a->start) / SAMPLE_MAP_MEAN;
}

/* Replicas, spans of time and b are those of passes that are alike: they begin anew. */
static void begin_anew(struct passes *p)
{
    double b_se;
    passes_brightness(p, &p->adaptive.start_b, &b_se);
    memset(p->rows, 0, (size_t)p->height * sizeof *p->rows);
    if (!p->replicas)
        return;
    replicas_clear(p->replicas);
    memset(p->replica_rows, 0,
           (size_t)p->replicas->count * (size_t)p->height * sizeof *p->replica_rows);
    time_spans_deinit(&p->spans);
    time_spans_init(&p->spans, p->replicas, p->replicas->count);
}

/* share: of the start in the run. */
static void adapt(struct passes *p, double share)
{
    struct adaptive *a = &p->adaptive;
    size_t pixels = (size_t)p->width * (size_t)p->height;
    float *errors = mem_alloc(pixels, sizeof *errors);
    float *work = mem_alloc(pixels, sizeof *work);
    for (int colour = 0; colour < 2; colour++)
        find_errors(p, colour, errors);
    for (size_t i = 0; i < pixels; i++)
        work[i] = (float)a->work[i];
    struct sample_start start = {p->width, p->height,       errors,
                                 work,     (double)p->pass, share};
    begin_anew(p);
    a->each = mem_alloc(pixels, sizeof *a->each);
    a->predicted = sample_map_make(&start, a->each);
    a->start = p->pass;
    mem_free(errors);
    mem_free(work);
    end_measuring(p);
    apply_map(p);
    if (!part_is_whole(a->part))
        passes_set_part(p, a->part);
}

/* Under a time budget a start that would leave too few passes is given up: nothing
 * differs from uniform samples then. */
void passes_adaptive_end_pass(struct passes *p)
{
    struct adaptive *a = &p->adaptive;
    if (!a->measuring)
        return;
    double passes = (double)p->pass;
    double used = (clock_wall() - a->time_began) / p->settings->seconds;
    if (p->budget == 0 && (passes < LEAST * used || used > SHARE_MOST)) {
        end_measuring(p);
        passes_set_part(p, a->part);
    } else if (p->budget > 0 ? p->pass == a->planned
                             : passes >= START_LEAST &&
                                   (used >= START_SHARE || passes >= START_MOST)) {
        adapt(p, p->budget > 0 ? passes / (double)p->budget : used);
    }
}

/* All parts of a run have made the same start. */
static void read_map(struct passes *p, struct pack *pack)
{
    struct adaptive *a = &p->adaptive;
    size_t pixels = (size_t)p->width * (size_t)p->height;
    uint32_t *each = mem_alloc(pixels, sizeof *each);
    pack_uint32s(pack, "each", each, pixels);
    if (a->each && memcmp(a->each, each, pixels * sizeof *each) != 0)
        pack_refuse(pack, "its numbers of samples are not those of the other parts");
    if (a->each || !pack_ok(pack)) {
        mem_free(each);
        return;
    }
    a->each = each;
    apply_map(p);
}

static void pack_map(struct passes *p, struct pack *pack)
{
    if (pack_reads(pack))
        read_map(p, pack);
    else
        pack_uint32s(pack, "each", p->adaptive.each,
                     (size_t)p->width * (size_t)p->height);
}

void passes_adaptive_pack(struct passes *p, struct pack *pack)
{
    struct adaptive *a = &p->adaptive;
    size_t pixels = (size_t)p->width * (size_t)p->height;
    bool measuring = a->measuring, adapted = a->each != NULL;
    struct adaptive before = *a;
    pack_flag(pack, "measuring", &measuring);
    pack_flag(pack, "adapted", &adapted);
    pack_long(pack, "start", &a->start, 0, p->pass);
    pack_double(pack, "start_b", &a->start_b);
    pack_double(pack, "predicted", &a->predicted);
    if (measuring != before.measuring && (measuring || before.each))
        pack_refuse(pack, "the measured start");
    if (pack_adds(pack) && !before.measuring &&
        (a->start != before.start || adapted != (before.each != NULL)))
        pack_refuse(pack, "its start is not that of the other parts");
    if (adapted && pack_ok(pack))
        pack_map(p, pack);
    if (measuring && pack_ok(pack)) {
        pack_doubles(pack, "squares", a->squares, pixels);
        pack_doubles(pack, "start_work", a->work, pixels);
        if (a->light)
            film_pack(pack, a->light);
    } else if (pack_reads(pack) && pack_ok(pack)) {
        end_measuring(p);
    }
    passes_assign_replica(p);
}
