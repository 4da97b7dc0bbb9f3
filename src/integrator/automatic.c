/* Until the race is over there is no picture. From then on every method is that of the
 * chosen integrator, whose budget is what the race has left. */

#include "integrator/automatic.h"

#include "base/clock.h"
#include "base/mem.h"
#include "integrator/race.h"
#include "integrator/registry.h"

struct automatic {
    const struct scene *scene;
    const struct settings *settings;
    struct race *race; /* NULL once it is over */
    struct race_figures choice;
    double seconds;         /* used up when the chosen integrator began */
    struct settings chosen; /* settings of the inner integrator */
    const struct integrator_methods *methods; /* NULL before there is one */
    void *inner;
    struct run_part part;
};

static void *create(const struct integrator_type *type, const struct scene *scene,
                    const struct settings *settings)
{
    struct automatic *a = mem_alloc(1, sizeof *a);
    (void)type;
    a->scene = scene;
    a->settings = settings;
    a->race = race_create(scene, settings);
    return a;
}

static void destroy(void *self)
{
    struct automatic *a = self;
    race_destroy(a->race);
    if (a->inner)
        a->methods->destroy(a->inner);
    mem_free(a);
}

/* The greatest of the candidates, each of which may be chosen. */
static void memory(const struct integrator_type *type, const struct scene *scene,
                   const struct settings *settings, struct run_memory *out)
{
    struct run_memory most = {0};
    (void)type;
    for (int i = 0; race_candidate(scene, i); i++) {
        const struct integrator_type *candidate = integrator_find(
            race_candidate(scene, i));
        struct settings s = *settings;
        struct run_memory own = {0};
        s.film_sampling = settings_film_sampling(settings);
        s.integrator = candidate->name;
        candidate->methods->memory(candidate, scene, &s, &own);
        if (own.films + own.states > most.films + most.states)
            most = own;
    }
    out->films += most.films;
    out->rare += most.rare;
    out->states += most.states;
    out->extra += most.extra;
    out->pictures += most.pictures;
    race_memory(scene, out);
}

/* --- the chosen integrator --------------------------------------------------------- */

static void begin_chosen(struct automatic *a)
{
    const struct integrator_type *type = integrator_find(a->choice.chosen);
    double pixels = (double)a->scene->camera.width * a->scene->camera.height;
    a->chosen = *a->settings;
    a->chosen.film_sampling = settings_film_sampling(a->settings);
    a->chosen.integrator = type->name;
    a->chosen.layers &= ~settings_layers_lacking(&a->chosen);
    if (a->chosen.seconds > 0.0)
        a->chosen.seconds = fmax(a->chosen.seconds - a->seconds, 1e-3);
    else
        a->chosen.mutations_per_pixel -= a->choice.equal_paths / pixels;
    a->methods = type->methods;
    a->inner = a->methods->create(type, a->scene, &a->chosen);
    if (!part_is_whole(a->part))
        a->methods->set_part(a->inner, a->part);
}

static void set_part(void *self, struct run_part part)
{
    struct automatic *a = self;
    a->part = part;
    if (a->inner)
        a->methods->set_part(a->inner, part);
}

static void race_round(struct automatic *a, const struct round_limits *limits)
{
    if (race_advance(a->race, limits))
        return;
    race_result(a->race, &a->choice);
    race_destroy(a->race);
    a->race = NULL;
    a->seconds = limits->seconds_used + clock_wall() - limits->begin;
    begin_chosen(a);
}

static bool advance(void *self, const struct round_limits *limits)
{
    struct automatic *a = self;
    struct round_limits own = *limits;
    if (a->race) {
        race_round(a, limits);
        return true;
    }
    own.seconds_used -= a->seconds;
    return a->methods->advance(a->inner, &own);
}

static bool started(const void *self)
{
    const struct automatic *a = self;
    return a->inner && a->methods->started(a->inner);
}

/* --- results ----------------------------------------------------------------------- */

static void picture(void *self, struct image *out)
{
    struct automatic *a = self;
    if (a->inner)
        a->methods->picture(a->inner, out);
    else
        for (long i = 0; i < 3L * out->width * out->height; i++)
            out->pixels[i] = 0.0f;
}

static void add_nothing(const void *self, long pixel, exact_sum sums[FIXED_SUMS])
{
    (void)self;
    (void)pixel;
    (void)sums;
}

/* Always with all sums: how many the chosen integrator has is not known beforehand. */
static void fixed_picture(void *self, struct fixed_picture *out)
{
    struct automatic *a = self;
    if (a->inner)
        a->methods->fixed_picture(a->inner, out);
    else
        *out = (struct fixed_picture){.self = a, .add = add_nothing};
    out->count = FIXED_SUMS;
}

static void layers(void *self, struct layers *out)
{
    struct automatic *a = self;
    if (a->inner && a->methods->layers)
        a->methods->layers(a->inner, out);
}

static void statistics(const void *self, struct run_statistics *out)
{
    const struct automatic *a = self;
    const double none = (double)NAN;
    if (a->inner)
        a->methods->statistics(a->inner, out);
    else
        *out = (struct run_statistics){
            .plarge = {.p_l = none, .p_l_lo = none, .p_l_hi = none},
            .split = split_figures_none,
            .adaptive = adaptive_figures_none,
            .acceptance = none,
            .failure_rate = none,
            .most_rejections_in_row = none,
            .chains_never_moved = none,
        };
    out->race = a->choice;
    if (a->race) {
        out->race = (struct race_figures){.used = true, .relmse = none};
        out->race.paths = race_paths(a->race);
    }
    out->race.chains = !a->methods || a->methods->chains;
    out->paths += out->race.paths;
}

static void counts(const void *self, struct run_counts *out)
{
    const struct automatic *a = self;
    *out = (struct run_counts){0.0, (double)NAN, (double)NAN};
    if (a->inner)
        a->methods->counts(a->inner, out);
    out->paths += a->race ? race_paths(a->race) : a->choice.paths;
}

static double progress(const void *self)
{
    const struct automatic *a = self;
    double budget = a->settings->mutations_per_pixel;
    double pixels = (double)a->scene->camera.width * a->scene->camera.height;
    double paths = a->race ? race_paths(a->race) : a->choice.equal_paths;
    double own = a->inner ? a->methods->progress(a->inner) : 0.0;
    if (own >= 1.0)
        return own;
    return (paths / pixels + own * a->chosen.mutations_per_pixel) / budget;
}

static void complete(void *self, const bool *present, int count)
{
    struct automatic *a = self;
    if (a->inner)
        a->methods->complete(a->inner, present, count);
}

static void evidence(void *self, struct evidence *out)
{
    struct automatic *a = self;
    if (a->inner)
        a->methods->evidence(a->inner, out);
    else
        *out = (struct evidence){.not_started = true, .energy_top = (double)NAN};
}

/* --- checkpoints ------------------------------------------------------------------- */

/* A race that is not over is run again: its checkpoint holds nothing. */
static void pack(void *self, struct pack *pack)
{
    struct automatic *a = self;
    bool begun = a->inner != NULL;
    pack_flag(pack, "race_over", &begun);
    if (!begun || !pack_ok(pack))
        return;
    pack_text(pack, "race_chosen", a->choice.chosen, sizeof a->choice.chosen);
    pack_text(pack, "race_reason", a->choice.reason, sizeof a->choice.reason);
    pack_double(pack, "race_paths", &a->choice.paths);
    pack_double(pack, "race_equal_paths", &a->choice.equal_paths);
    pack_double(pack, "race_relmse", &a->choice.relmse);
    pack_double(pack, "race_seconds", &a->seconds);
    if (pack_reads(pack) && !a->inner) {
        a->choice.used = true;
        if (!pack_ok(pack) || !integrator_find(a->choice.chosen)) {
            pack_refuse(pack, "race_chosen");
            return;
        }
        race_destroy(a->race);
        a->race = NULL;
        begin_chosen(a);
    }
    a->methods->pack(a->inner, pack);
}

/* pt is a candidate only where it can sample all that bdpt can. */
static unsigned techniques(const struct settings *settings)
{
    (void)settings;
    return TECHNIQUES_BDPT;
}

static const struct integrator_methods methods = {
    .chains = true,
    .memory = memory,
    .create = create,
    .set_part = set_part,
    .advance = advance,
    .started = started,
    .picture = picture,
    .fixed_picture = fixed_picture,
    .layers = layers,
    .statistics = statistics,
    .counts = counts,
    .progress = progress,
    .pack = pack,
    .complete = complete,
    .evidence = evidence,
    .destroy = destroy,
};

const struct integrator_type integrator_auto = {
    .name = "auto",
    .summary = "pt, bdpt, pssmlt or mmlt, whichever has the least error in short pilots",
    .methods = &methods,
    .techniques = techniques,
};
