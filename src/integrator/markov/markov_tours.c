/* The rule `tours` in a run. The tapes hold at most TAPES_MOST mutations: the chains of a
 * long start are recorded at its beginning. Pixels are weighed by the picture that the
 * tapes contain: for one half of the chains by the picture of the other half, as a
 * picture that shares its errors with the splats would hide what is rare and bright. */

#include "integrator/markov/markov_tours.h"

#include "base/mem.h"
#include "base/par.h"
#include "base/text.h"
#include "chain/tours_light.h"
#include "image/metric.h"
#include "integrator/markov/markov_group.h"

#include <math.h>
#include <string.h>

#define TAPES_MOST 0x1p17

static bool is_asked(const struct markov *m)
{
    return settings_auto(m->settings) && text_equal(settings_rule(m->settings), "tours");
}

const char *markov_tours_bar(const struct markov *m)
{
    const struct settings *s = m->settings;
    double budget = s->mutations_per_pixel * markov_pixels(m) / m->chain_count;
    if (m->chain_count < TOURS_CHAINS_FEW)
        return "there are too few chains";
    if (s->seconds <= 0.0 && s->start_cap * ceil(budget) < MARKOV_TOURS_LEAST)
        return "the run is too short";
    return "";
}

static bool is_wanted(const struct markov *m)
{
    return is_asked(m) && !*markov_tours_bar(m);
}

/* --- tapes ------------------------------------------------------------------------- */

static long tape_length(const struct markov *m)
{
    double most = TAPES_MOST / m->chain_count;
    return most < 1.0 ? 1 : (long)most;
}

void markov_tours_memory(const struct markov *m, struct run_memory *out)
{
    double pixels = markov_pixels(m), untouched;
    long splats = tape_splats_most(tape_length(m), m->design.max_splats);
    if (!is_wanted(m))
        return;
    double scratch = tours_scratch_bytes((long)pixels, splats, &untouched);
    double tapes = m->chain_count * tape_bytes(tape_length(m), m->design.max_splats);
    out->states += tapes + m->chain_count *
                               (double)(sizeof(struct tape) + sizeof(struct tours_sums));
    out->states += m->group_count *
                   ((double)sizeof(struct large_acceptance) + tours_end_bytes());
    out->states += m->threads * scratch;
    out->extra += tapes + m->threads * untouched;
    out->states += 2.0 *
                   tours_light_bytes(m->scene->camera.width, m->scene->camera.height);
    out->states += m->direct ? 3.0 * pixels * sizeof(float) : 0.0;
}

static void create(struct markov *m)
{
    struct markov_tours *t = m->tours = mem_alloc(1, sizeof *t);
    t->tapes = mem_alloc((size_t)m->chain_count, sizeof *t->tapes);
    t->acceptance = mem_alloc((size_t)m->group_count, sizeof *t->acceptance);
    for (int i = 0; i < m->chain_count; i++)
        tape_init(&t->tapes[i], tape_length(m), m->design.max_splats);
}

void markov_tours_begin(struct markov *m)
{
    if (!is_wanted(m))
        return;
    create(m);
    for (int i = 0; i < m->group_count; i++)
        large_acceptance_build(&m->tours->acceptance[i], m->groups[i].bootstrap.targets,
                               m->groups[i].bootstrap.count);
    for (int i = 0; i < m->chain_count; i++)
        tape_begin(&m->tours->tapes[i], m->chains[i].current);
}

bool markov_tours_full(const struct markov *m)
{
    for (int i = 0; i < m->chain_count; i++)
        if (!m->tours->tapes[i].full)
            return false;
    return true;
}

void markov_tours_destroy(struct markov *m)
{
    if (!m->tours)
        return;
    for (int i = 0; i < m->chain_count; i++)
        tape_deinit(&m->tours->tapes[i]);
    mem_free(m->tours->tapes);
    mem_free(m->tours->acceptance);
    mem_free(m->tours);
    m->tours = NULL;
}

void markov_tours_pack(struct markov *m, struct pack *pack)
{
    bool tapes = m->tours != NULL;
    tours_choice_pack(pack, &m->start.tours);
    pack_flag(pack, "tapes", &tapes);
    if (!tapes || !pack_ok(pack))
        return;
    if (pack_reads(pack) && !is_asked(m)) {
        pack_refuse(pack, "tapes");
        return;
    }
    if (!m->tours)
        create(m);
    for (int i = 0; i < m->group_count && pack_ok(pack); i++)
        large_acceptance_pack(pack, &m->tours->acceptance[i]);
    for (int i = 0; i < m->chain_count && pack_ok(pack); i++)
        tape_pack(pack, &m->tours->tapes[i], (long)markov_pixels(m));
}

/* --- from tapes to p_l ------------------------------------------------------------- */

/* Half of the chains of its group that a chain is in; neighbours may share a seed. */
static int half_of(const struct markov *m, int chain)
{
    const struct group *group = &m->groups[m->group_of[chain]];
    return 2 * (chain - group->first_chain) / group->chain_count;
}

struct analysis {
    struct markov *m;
    struct tours_target targets[DIMS_MAX_DEPTH]; /* [group_count] */
    struct image *plain;                         /* of plain samples; NULL: none */
    struct tours_light *light[2];                /* by half */
    struct tours_scratch **scratch;              /* [threads] */
    struct tours_sums *sums;                     /* [chain_count] */
    struct tours_part parts[DIMS_MAX_DEPTH];
    struct tours_run run;
};

/* Speed of the second stages after large steps, tours_target.speed. */
static double speed_of(const struct markov *m, const struct group *group)
{
    double sums[2][2] = {{0.0}}, width = 1.0 / m->design.pss.kernel.second_stage;
    for (int i = group->first_chain; i < group->first_chain + group->chain_count; i++)
        tours_add_moves(&m->tours->tapes[i], width, sums);
    if (!(sums[0][1] > 0.0 && sums[1][0] > 0.0))
        return 1.0;
    return sums[1][1] / sums[1][0] * sums[0][0] / sums[0][1];
}

static void set_targets(struct analysis *a)
{
    const struct markov *m = a->m;
    for (int g = 0; g < m->group_count; g++) {
        const struct large_acceptance *acceptance = &m->tours->acceptance[g];
        double hits = acceptance->below[LARGE_ACCEPTANCE_BINS][0];
        a->targets[g] = (struct tours_target){
            .acceptance = acceptance,
            .estimator = m->groups[g].params.estimator,
            .b = m->groups[g].bootstrap.b,
            .p0 = m->groups[g].params.p_large,
            .failing = m->design.step->stages > 1 ? 1.0 - hits / acceptance->count : 0.0,
            .speed = speed_of(m, &m->groups[g]),
        };
    }
}

/* Adds the tapes of the chains in one half. */
static void add_tapes(const struct analysis *a, int half)
{
    const struct markov *m = a->m;
    for (int g = 0; g < m->group_count; g++) {
        const struct group *group = &m->groups[g];
        int end = group->first_chain + group->chain_count;
        double mutations = 0.0;
        for (int i = group->first_chain; i < end; i++)
            if (half_of(m, i) == half)
                mutations += (double)(m->tours->tapes[i].count - 1);
        double factor = markov_pixels(m) * group->bootstrap.b / fmax(mutations, 1.0);
        for (int i = group->first_chain; i < end; i++)
            if (half_of(m, i) == half)
                tours_light_add(a->light[half], &m->tours->tapes[i], &a->targets[g],
                                factor);
    }
}

static struct image *plain_picture(const struct markov *m)
{
    struct image *plain = image_create(m->scene->camera.width, m->scene->camera.height);
    passes_picture(m->direct, plain);
    return plain;
}

static void add_plain(const struct analysis *a, struct tours_light *light)
{
    long pixels = (long)a->plain->width * a->plain->height;
    for (long i = 0; i < pixels; i++) {
        const float *v = a->plain->pixels + 3 * i;
        double y = rgb_luminance(rgb((double)v[0], (double)v[1], (double)v[2]));
        tours_light_add_pixel(light, (int32_t)i, y / a->m->scene->emission_scale);
    }
}

/* Weights of the pixels from the picture of one half; returns the picture's mean. */
static double weigh_half(struct analysis *a, int half)
{
    const struct markov *m = a->m;
    double scale = m->scene->emission_scale;
    a->light[half] = tours_light_create(m->scene->camera.width, m->scene->camera.height);
    add_tapes(a, half);
    if (a->plain)
        add_plain(a, a->light[half]);
    return tours_light_weigh(a->light[half], METRIC_RELATIVE_FLOOR / (scale * scale));
}

static void add_one(void *ctx, long chain, int thread)
{
    struct analysis *a = ctx;
    const struct tours_target *target = &a->targets[a->m->group_of[chain]];
    const struct tours_light *light = a->light[1 - half_of(a->m, (int)chain)];
    struct tours_pixels pixels = tours_light_pixels(light);
    tours_add(&a->m->tours->tapes[chain], target, &pixels,
              tours_light_square(light) * target->share * target->share,
              a->scratch[thread], &a->sums[chain]);
}

static void sum_tapes(struct analysis *a)
{
    const struct markov *m = a->m;
    a->plain = m->direct ? plain_picture(m) : NULL;
    double mean = 0.5 * (weigh_half(a, 0) + weigh_half(a, 1));
    image_destroy(a->plain);
    for (int g = 0; g < m->group_count; g++)
        a->targets[g].share = mean > 0.0 ? fmin(a->targets[g].b / mean, 1.0) : 0.0;
    long splats = tape_splats_most(tape_length(m), m->design.max_splats);
    a->sums = mem_alloc((size_t)m->chain_count, sizeof *a->sums);
    a->scratch = mem_alloc((size_t)m->threads, sizeof(struct tours_scratch *));
    for (int i = 0; i < m->threads; i++)
        a->scratch[i] = tours_scratch_create((long)markov_pixels(m), splats);
    par_for(m->chain_count, m->threads, add_one, a);
    for (int i = 0; i < m->threads; i++)
        tours_scratch_destroy(a->scratch[i]);
    mem_free(a->scratch);
    for (int h = 0; h < 2; h++)
        tours_light_destroy(a->light[h]);
}

static double longest_stay(const struct large_acceptance *table)
{
    double a, square;
    large_acceptance_at(table, ldexp(1.0, table->top), &a, &square);
    return a > 0.0 ? 1.0 / a : HUGE_VAL;
}

static void set_part(struct analysis *a, int g, double planned)
{
    const struct markov *m = a->m;
    const struct group *group = &m->groups[g];
    double mutations[2] = {0.0}, work[2] = {0.0}, recorded = 0.0;
    for (int i = group->first_chain; i < group->first_chain + group->chain_count; i++) {
        const struct tape *tape = &m->tours->tapes[i];
        recorded += (double)(tape->count - 1) / group->chain_count;
        for (int k = 0; k < 2; k++) {
            mutations[k] += tape->mutations[k];
            work[k] += tape->work[k];
        }
    }
    a->parts[g] = (struct tours_part){
        .chains = a->sums + group->first_chain,
        .count = group->chain_count,
        .share = (double)group->chain_count / m->chain_count,
        .stay = longest_stay(&m->tours->acceptance[g]),
        .recorded = recorded,
        .planned = planned,
    };
    for (int k = 0; k < 2; k++)
        a->parts[g].work[k] = mutations[k] > 0.0 ? work[k] / mutations[k] : 0.0;
}

/* Sets the p_l of each length: by its own curve, by the common one where its own is
 * unsure, and none where both are. Returns whether a length with enough of the light asks
 * for a longer start. */
static bool choose_per_length(struct analysis *a, const struct tours_choice *common)
{
    struct markov *m = a->m;
    bool longer = false;
    for (int g = 0; g < m->group_count; g++) {
        struct tours_choice own;
        tours_choose(&a->parts[g], 1, &a->run, &own);
        bool doubtful = *tours_doubt(&own);
        if (!doubtful)
            m->groups[g].plarge = own.plarge;
        else if (!*tours_doubt(common))
            m->groups[g].plarge = common->plarge;
        longer = longer || (tours_wants_more(&own) && group_matters(m, &m->groups[g]));
    }
    return longer;
}

bool markov_tours_choose(struct markov *m, double planned, double fixed_work,
                         double p_zsolnai, struct tours_choice *out)
{
    struct analysis *a = mem_alloc(1, sizeof *a);
    a->m = m;
    a->run = (struct tours_run){planned * m->chain_count, fixed_work, p_zsolnai};
    set_targets(a);
    sum_tapes(a);
    for (int g = 0; g < m->group_count; g++)
        set_part(a, g, planned);
    tours_choose(a->parts, m->group_count, &a->run, out);
    bool longer = tours_wants_more(out);
    if (m->settings->per == PER_LENGTH)
        longer = choose_per_length(a, out);
    else
        for (int g = 0; g < m->group_count && !*tours_doubt(out); g++)
            m->groups[g].plarge = out->plarge;
    mem_free(a->sums);
    mem_free(a);
    return longer;
}
