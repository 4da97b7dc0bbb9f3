/* The one table of settings. Whoever adds a field to struct settings adds its row here;
 * tests/unit/test_settings_table.c fails until there is one. */
#include "settings/setting.h"

#include "base/mem.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#define ALL      0
#define CHAINS   SETTING_CHAINS
#define LENGTHS  SETTING_LENGTHS
#define PRIMARY  SETTING_PRIMARY
#define MLT      SETTING_MLT
#define CONNECTS SETTING_CONNECTS

#define AT(field)    offsetof(struct settings, field)
#define FIELD(field) AT(field), sizeof(((struct settings *)NULL)->field)

/* --- words ------------------------------------------------------------------------- */

static const struct setting_word integrators[] = {
    {"pssmlt", SETTING_CHAINS | PRIMARY | SETTING_BUILDER | SETTING_SPLIT |
                   SETTING_GUESS | SETTING_CONNECTS},
    {"mmlt", SETTING_CHAINS | PRIMARY | SETTING_LENGTHS | SETTING_DIRECT | SETTING_SPLIT |
                 SETTING_GUESS},
    {"pfmlt",
     SETTING_CHAINS | PRIMARY | SETTING_LENGTHS | SETTING_DIRECT | SETTING_MODES},
    {"rjmlt", SETTING_CHAINS | PRIMARY | SETTING_LENGTHS | SETTING_DIRECT |
                  SETTING_MODES | SETTING_RJMLT},
    {"smlt", SETTING_CHAINS | PRIMARY | SETTING_BUILDER | SETTING_LENGTHS |
                 SETTING_SPLIT | SETTING_SMLT},
    {"mlt", SETTING_CHAINS | SETTING_DIRECT | SETTING_MLT},
    {"bdpt", SETTING_CONNECTS | SETTING_PASSES},
    {"pt", SETTING_PASSES},
    {"auto",
     SETTING_CHAINS | PRIMARY | SETTING_LENGTHS | SETTING_DIRECT | SETTING_PASSES},
    {0},
};

static const struct setting_word p_larges[] = {{"auto", (double)NAN}, {0}};
static const struct setting_word rules[] = {{"tours", 0}, {"zsolnai2013", 0}, {0}};
static const struct setting_word pers[] = {{"all", PER_ALL}, {"length", PER_LENGTH}, {0}};
static const struct setting_word allocations[] = {
    {"error", ALLOCATION_ERROR}, {"brightness", ALLOCATION_BRIGHTNESS}, {0}};
static const struct setting_word deletions[] = {
    {"uniform", DELETION_UNIFORM}, {"weighted", DELETION_WEIGHTED}, {0}};
static const struct setting_word weights[] = {
    {"given", WEIGHTS_GIVEN}, {"measured", WEIGHTS_MEASURED}, {0}};
static const struct setting_word directs[] = {
    {"separate", DIRECT_SEPARATE}, {"joint", DIRECT_JOINT}, {0}};
static const struct setting_word film_samplings[] = {
    {"uniform", FILM_SAMPLING_UNIFORM}, {"adaptive", FILM_SAMPLING_ADAPTIVE}, {0}};
static const struct setting_word modes[] = {
    {"exact", 0}, {"counted", 0}, {"paper", 0}, {0}};
static const struct setting_word kernels[] = {{"exponential", 0}, {"gaussian", 0}, {0}};
static const struct setting_word estimators[] = {{"kelemen", 0}, {"plain", 0}, {0}};
static const struct setting_word builders[] = {{"bdpt", 0}, {"pt", 0}, {0}};
static const struct setting_word metropolises[] = {{"pssmlt", 0}, {"mmlt", 0}, {0}};
static const struct setting_word shares[] = {{"auto", (double)NAN}, {0}};
static const struct setting_word shadow_rays[] = {{"all", 0.0}, {0}};
static const struct setting_word ceilings[] = {
    {"auto", (double)NAN}, {"none", (double)INFINITY}, {0}};
static const struct setting_word depths[] = {{"-1", SETTINGS_MAX_DEPTH}, {0}};
static const struct setting_word replica_counts[] = {{"1", 1}, {0}};
static const struct setting_word compacts[] = {
    {"auto", ACCEL_AUTO}, {"true", ACCEL_COMPACT}, {"false", ACCEL_FULL}, {0}};

/* --- values of several fields ------------------------------------------------------ */

static bool read_size(const struct setting *setting, struct settings *s,
                      const char *value, const struct place *at, struct err *err)
{
    int width = 0, height = 0, end = 0;
    (void)setting, (void)at, (void)err;
    if (strspn(value, "0123456789x") != strlen(value) ||
        sscanf(value, "%6dx%6d%n", &width, &height, &end) != 2 ||
        (size_t)end != strlen(value) || width < 1 || height < 1 || width > 65536 ||
        height > 65536)
        return false;
    s->width = width;
    s->height = height;
    return true;
}

static void print_size(const struct setting *setting, const struct settings *s,
                       struct text *text)
{
    (void)setting;
    if (s->width > 0)
        text_append(text, "%ldx%ld", s->width, s->height);
}

static bool read_budget(const struct setting *setting, struct settings *s,
                        const char *value, const struct place *at, struct err *err)
{
    static const char *const kinds[] = {"seconds", "mutations_per_pixel"};
    (void)setting;
    for (int i = 0; i < 2; i++) {
        size_t length = strlen(kinds[i]);
        if (strncmp(value, kinds[i], length) == 0 && value[length] == '=')
            return settings_set(s, kinds[i], value + length + 1, at, err);
    }
    return false;
}

/* LAYER_... by name. */
static const struct setting_word layer_words[] = {
    {"acceptance", LAYER_ACCEPTANCE},
    {"failures", LAYER_FAILURES},
    {"work", LAYER_WORK},
    {"visits", LAYER_VISITS},
    {"lengths", LAYER_LENGTHS},
    {"techniques", LAYER_TECHNIQUES},
    {"unweighted", LAYER_UNWEIGHTED},
    {"features", LAYER_FEATURES},
    {0},
};

/* "none", or words with commas between them. */
static bool read_layers(const struct setting *setting, struct settings *s,
                        const char *value, const struct place *at, struct err *err)
{
    long layers = 0;
    (void)setting, (void)at, (void)err;
    if (text_equal(value, "none")) {
        s->layers = 0;
        return true;
    }
    for (const char *word = value;; word++) {
        size_t length = strcspn(word, ",");
        const struct setting_word *w = layer_words;
        while (w->word &&
               (strlen(w->word) != length || strncmp(w->word, word, length) != 0))
            w++;
        if (!w->word)
            return false;
        layers |= (long)w->value;
        word += length;
        if (*word == '\0')
            break;
    }
    s->layers = layers;
    return true;
}

static void print_layers(const struct setting *setting, const struct settings *s,
                         struct text *text)
{
    const char *between = "";
    (void)setting;
    for (const struct setting_word *w = layer_words; w->word; w++)
        if (s->layers & (long)w->value) {
            text_append(text, "%s%s", between, w->word);
            between = ",";
        }
    if (s->layers == 0)
        text_append(text, "none");
}

/* --- the table --------------------------------------------------------------------- */

/* One row a setting, one line a property. */
/* clang-format off */
static const struct setting rows[] = {
    {"integrator", SETTING_NAME, ALL, FIELD(integrator),
     .words = integrators, .initial = "pssmlt",
     .help = "the algorithm",
     .resume = RESUME_SAME, .column = "integrator"},
    {"large_step_probability", SETTING_NUMBER, CHAINS, FIELD(p_large), 0, 1,
     .words = p_larges, .initial = "auto",
     .values = "auto or a number in (0,1]",
     .help = "p_l; auto measures it; 0 only with allow_zero=true",
     .resume = RESUME_SAME, .seen = "p_l"},
    {"allow_zero", SETTING_FLAG, CHAINS, FIELD(allow_zero),
     .initial = "false",
     .help = "true permits large_step_probability 0, with which the chain is not "
             "ergodic",
     .resume = RESUME_FREE, .seen = "p_l"},
    {"rule", SETTING_NAME, CHAINS, FIELD(rule),
     .words = rules, .unset = "tours, for mode paper zsolnai2013",
     .help = "how auto computes p_l from the measured start: as the minimum of the "
             "error predicted for every p_l, or by the formula of [Zsolnai13]",
     .resume = RESUME_SAME, .column = "rule"},
    {"per", SETTING_CHOICE, LENGTHS, FIELD(per),
     .words = pers, .initial = "all",
     .help = "one automatic p_l for all path lengths, or one for each",
     .resume = RESUME_SAME, .column = "per"},
    {"allocation", SETTING_CHOICE, LENGTHS, FIELD(allocation),
     .words = allocations, .initial = "error",
     .help = "how chains are divided among the path lengths: by the relative error "
             "that each length causes, or by brightness",
     .resume = RESUME_SAME, .column = "allocation"},
    {"direct", SETTING_CHOICE, SETTING_DIRECT, FIELD(direct),
     .words = directs, .unset = "separate, with 8 mutations per pixel or more",
     .help = "path lengths 1 and 2 by independent samples, which take a quarter of all "
             "paths, or by chains, as other renderers do",
     .resume = RESUME_SAME, .column = "direct"},
    {"mode", SETTING_NAME, SETTING_MODES, FIELD(mode),
     .words = modes, .unset = "exact, for rjmlt counted",
     .help = "what happens after a failed proposal; paper is biased",
     .resume = RESUME_SAME, .column = "mode"},
    {"jump_probability", SETTING_NUMBER, SETTING_RJMLT, FIELD(jump), 0, 0.9,
     .initial = "0.1",
     .help = "share of the mutations other than large steps that change the technique "
             "and keep the path",
     .resume = RESUME_SAME, .column = "jump_probability"},
    {"kernel", SETTING_NAME, PRIMARY, FIELD(kernel),
     .words = kernels,
     .unset = "exponential; gaussian for pfmlt, and for rjmlt unless in mode counted",
     .help = "distribution of small steps",
     .resume = RESUME_SAME, .column = "kernel"},
    {"sigma", SETTING_NUMBER, PRIMARY, FIELD(sigma), 1e-9, 1,
     .unset = "0.64 times the default of s2",
     .help = "standard deviation of the Gaussian kernel",
     .resume = RESUME_SAME, .column = "sigma"},
    {"s1", SETTING_NUMBER, PRIMARY, FIELD(s1), 1e-12, 1,
     .initial = "0.0009765625",
     .help = "smallest step of the exponential kernel; by default 1/1024",
     .resume = RESUME_SAME, .column = "s1"},
    {"s2", SETTING_NUMBER, PRIMARY, FIELD(s2), 1e-12, 1,
     .unset = "4 pixels, that is 4/sqrt(width height), within 1/256 and 1/8; 1/64 with rule "
              "zsolnai2013",
     .help = "largest step of the exponential kernel",
     .resume = RESUME_SAME, .column = "s2"},
    {"estimator", SETTING_NAME, CHAINS, FIELD(estimator),
     .words = estimators, .unset = "kelemen, for mode paper plain",
     .help = "kelemen also uses large steps as independent samples; mode paper has "
             "plain only",
     .resume = RESUME_SAME, .column = "estimator"},
    {"builder", SETTING_NAME, SETTING_BUILDER, FIELD(builder),
     .words = builders, .initial = "bdpt",
     .help = "the path sampler whose random numbers the chain mutates",
     .resume = RESUME_SAME, .column = "builder"},
    {"lens_radius", SETTING_NUMBER, MLT, FIELD(lens_radius), 1e-6, 1e6,
     .initial = "0.1",
     .help = "least distance that the lens perturbation moves a path on the film, in "
             "pixels: r1 of [Veach97]",
     .resume = RESUME_SAME, .column = "lens_radius"},
    {"lens_area", SETTING_NUMBER, MLT, FIELD(lens_area), 1e-9, 1,
     .initial = "0.05",
     .help = "share of the film in a disk whose radius is the greatest distance, r2",
     .resume = RESUME_SAME, .column = "lens_area"},
    {"angle_least", SETTING_NUMBER, MLT, FIELD(angle_least), 1e-9, 90,
     .initial = "0.01",
     .help = "least angle, in degrees, by which caustic and multi-chain perturbations "
             "turn a direction",
     .resume = RESUME_SAME, .column = "angle_least"},
    {"angle_most", SETTING_NUMBER, MLT, FIELD(angle_most), 1e-9, 90,
     .initial = "5",
     .help = "greatest angle of these, in degrees",
     .resume = RESUME_SAME, .column = "angle_most"},
    {"weight_lens", SETTING_NUMBER, MLT, FIELD(weight_lens), 0, 1e6,
     .initial = "1",
     .help = "weight of the lens perturbation in the choice among the mutations that "
             "suit a path",
     .resume = RESUME_SAME, .column = "weight_lens"},
    {"weight_caustic", SETTING_NUMBER, MLT, FIELD(weight_caustic), 0, 1e6,
     .initial = "1",
     .help = "weight of the caustic perturbation",
     .resume = RESUME_SAME, .column = "weight_caustic"},
    {"weight_multichain", SETTING_NUMBER, MLT, FIELD(weight_multichain), 0, 1e6,
     .initial = "1",
     .help = "weight of the multi-chain perturbation",
     .resume = RESUME_SAME, .column = "weight_multichain"},
    {"weight_bidirectional", SETTING_NUMBER, MLT, FIELD(weight_bidirectional), 0, 1e6,
     .initial = "1",
     .help = "weight of the bidirectional mutation",
     .resume = RESUME_SAME, .column = "weight_bidirectional"},
    {"deletion", SETTING_CHOICE, MLT, FIELD(deletion),
     .words = deletions, .initial = "uniform",
     .help = "by what the bidirectional mutation chooses the vertices that it deletes: "
             "uniformly, or by the weights of [CMU17]",
     .resume = RESUME_SAME, .column = "deletion"},
    {"weight_lens_subpath", SETTING_NUMBER, MLT, FIELD(weight_lens_subpath), 0, 1e6,
     .initial = "1",
     .help = "weight of the lens sub-path mutation",
     .resume = RESUME_SAME, .column = "weight_lens_subpath"},
    {"weight_numbers", SETTING_NUMBER, MLT, FIELD(weight_numbers), 0, 1e6,
     .initial = "0",
     .help = "weight of small steps of the random numbers with which a technique makes "
             "the path",
     .resume = RESUME_SAME, .column = "weight_numbers"},
    {"mutation_weights", SETTING_CHOICE, MLT, FIELD(mutation_weights),
     .words = weights, .initial = "given",
     .help = "after the measured start: the weights as they were given, or times each "
             "mutation's mean acceptance over its mean cost in the start",
     .resume = RESUME_SAME, .column = "mutation_weights"},
    {"metropolis", SETTING_NAME, SETTING_SMLT, FIELD(metropolis),
     .words = metropolises, .initial = "pssmlt",
     .help = "whose chains take their share of the light",
     .resume = RESUME_SAME, .column = "metropolis"},
    {"share_floor", SETTING_NUMBER, SETTING_SMLT, FIELD(share_floor), 0, 1e12,
     .words = shares, .initial = "auto",
     .values = "auto or a number in [0,1e12]",
     .help = "chains take the share r/(r+floor) of a sample, r its brightness relative "
             "to its pixel",
     .resume = RESUME_SAME, .seen = "split_floor"},
    {"ceiling", SETTING_NUMBER, SETTING_SPLIT, FIELD(ceiling), 1e-6, 1e12,
     .words = ceilings, .unset = "auto for smlt, else none",
     .values = "auto, none or a number in [1e-6,1e12]",
     .help = "greatest target of a state, relative to the mean; independent samples "
             "render what is above",
     .resume = RESUME_SAME, .seen = "split_ceiling"},
    {"passes_share", SETTING_NUMBER, SETTING_SMLT, FIELD(passes_share), 0, 0.999,
     .words = shares, .initial = "auto",
     .values = "auto or a number in [0,0.999]",
     .help = "share of independent samples in all paths; at least two are taken a pixel",
     .resume = RESUME_SAME, .seen = "split_passes"},
    {"two_stage", SETTING_FLAG, SETTING_GUESS, FIELD(two_stage),
     .initial = "false",
     .help = "true divides targets by a blurred picture from independent paths, so that "
             "chains visit dark pixels as often as bright ones [Veach97]",
     .resume = RESUME_SAME, .column = "two_stage"},
    {"shadow_rays", SETTING_NUMBER, CONNECTS, FIELD(shadow_rays), 1, 1e6,
     .words = shadow_rays, .initial = "all",
     .values = "all or a number in [1,1e6]",
     .help = "of bdpt's connections, about so many of a sample are tested for visibility, "
             "chosen by their share of its light (Russian roulette); all: every one",
     .resume = RESUME_SAME, .column = "shadow_rays"},
    {"film_sampling", SETTING_CHOICE, SETTING_PASSES, FIELD(film_sampling),
     .words = film_samplings, .unset = "uniform; adaptive where auto has chosen",
     .help = "samples of a pixel: the same number for all, or by the error that a start "
             "of a fifth of them measured; with 40 samples a pixel or more",
     .resume = RESUME_SAME, .column = "film_sampling"},
    {"chains", SETTING_COUNT, CHAINS, FIELD(chains), 1, 1e6,
     .initial = "256",
     .help = "number of Markov chains; mmlt, pfmlt and rjmlt use at least two for each "
             "path length",
     .resume = RESUME_SAME, .seen = "chains"},
    {"bootstrap", SETTING_COUNT, CHAINS, FIELD(bootstrap), 1, 1e9,
     .initial = "100000", .noun = "a count of paths",
     .help = "independent paths before the chains start; more while these would begin "
             "at too few of them, fewer where they would take too much of the time",
     .resume = RESUME_SAME, .seen = "bootstrap_paths"},
    {"start", SETTING_NUMBER, CHAINS, FIELD(start), 0, 1,
     .initial = "0.02",
     .help = "share of the budget that the measured start takes",
     .resume = RESUME_SAME, .column = "start"},
    {"start_cap", SETTING_NUMBER, CHAINS, FIELD(start_cap), 0, 1,
     .initial = "0.2",
     .help = "largest share of the budget that the measured start may take",
     .resume = RESUME_SAME, .column = "start_cap"},
    {"start_mutations", SETTING_COUNT, CHAINS, FIELD(start_mutations), 1, 1e9,
     .initial = "64",
     .help = "mutations of each chain in the measured start, at least",
     .resume = RESUME_SAME, .seen = "start_mutations"},
    {"max_depth", SETTING_COUNT, ALL, FIELD(max_depth), 1, SETTINGS_MAX_DEPTH,
     .words = depths, .noun = "a count of edges",
     .unset = "what the scene file says, else 12",
     .help = "longest path from camera to light; -1 means 64",
     .resume = RESUME_SAME, .seen = "max_depth"},
    {"budget", SETTING_OWN, ALL,
     .values = "seconds=S or mutations_per_pixel=N",
     .help = "another spelling of the next two; the last one given counts",
     .resume = RESUME_BUDGET, .seen = "budget_seconds",
     .read = read_budget},
    {"seconds", SETTING_NUMBER, ALL, FIELD(seconds), 1e-3, 1e9,
     .noun = "a number of seconds",
     .help = "budget of wall time",
     .resume = RESUME_BUDGET, .column = "budget_seconds",
     .clears = AT(mutations_per_pixel)},
    {"mutations_per_pixel", SETTING_NUMBER, ALL, FIELD(mutations_per_pixel), 1e-6, 1e12,
     .initial = "64",
     .help = "budget in mutations per pixel, for pt and bdpt in samples per pixel",
     .resume = RESUME_BUDGET, .column = "budget_mutations_per_pixel",
     .clears = AT(seconds)},
    {"until_converged", SETTING_FLAG, ALL, FIELD(until_converged),
     .initial = "false",
     .help = "the run ends before its budget once its verdict is \"converged\" at two "
             "looks in succession",
     .resume = RESUME_FREE, .column = "until_converged"},
    {"until_relmse", SETTING_NUMBER, ALL, FIELD(until_relmse), 0, 1e6,
     .initial = "0",
     .help = "the run ends before its budget once its relMSE is below this value by "
             "its own error bars; 0 means never",
     .resume = RESUME_FREE, .column = "until_relmse"},
    {"size", SETTING_OWN, ALL, AT(width), 2 * sizeof(long),
     .values = "WIDTHxHEIGHT in pixels, each in [1,65536]",
     .unset = "what the scene file says",
     .help = "size of the picture",
     .resume = RESUME_SAME, .seen = "width",
     .read = read_size, .print = print_size},
    {"keep_all", SETTING_FLAG, ALL, FIELD(keep_all),
     .initial = "false",
     .help = "true keeps computations that the scene does not need; for tests",
     .resume = RESUME_SAME, .column = "keep_all"},
    {"seed", SETTING_COUNT, ALL, FIELD(seed), 0, 9e15,
     .initial = "1", .noun = "a whole number",
     .help = "the same seed gives the same picture",
     .resume = RESUME_SAME, .column = "seed"},
    {"threads", SETTING_COUNT, ALL, FIELD(threads), 0, 1024,
     .initial = "0",
     .help = "number of threads; 0 means all",
     .resume = RESUME_FREE, .seen = "threads"},
    {"replicas", SETTING_COUNT, ALL, FIELD(replicas), 4, 64,
     .words = replica_counts, .initial = "8",
     .help = "independent parts of a run, from which error bars and the verdict come; "
             "1 means neither",
     .resume = RESUME_SAME, .seen = "replicas"},
    {"layers", SETTING_OWN, ALL, FIELD(layers),
     .values = "none, or some of acceptance, failures, work, visits, lengths, "
               "techniques, unweighted, features",
     .initial = "none",
     .help = "layers of the picture's file that explain the run, with commas between "
             "them",
     .resume = RESUME_SAME, .column = "layers",
     .read = read_layers, .print = print_layers},
    {"compact", SETTING_CHOICE, ALL, FIELD(compact),
     .words = compacts, .initial = "auto",
     .help = "whether rays use a compact BVH; auto: if memory is short; hits may "
             "differ in their last bits",
     .resume = RESUME_SAME, .seen = "rays"},
};
/* clang-format on */

_Static_assert(AT(height) == AT(width) + sizeof(long), "size is both");

#define ROW_COUNT ((int)(sizeof rows / sizeof rows[0]))

const struct setting *settings_row(int index)
{
    return index >= 0 && index < ROW_COUNT ? &rows[index] : NULL;
}

const struct setting *settings_find(const char *name)
{
    for (int i = 0; i < ROW_COUNT; i++)
        if (text_equal(rows[i].name, name))
            return &rows[i];
    return NULL;
}

void settings_init(struct settings *settings)
{
    memset(settings, 0, sizeof *settings);
    for (int i = 0; i < ROW_COUNT; i++) {
        const char *initial = rows[i].initial;
        bool ok = !initial || setting_read(&rows[i], settings, initial, NULL, NULL);
        assert(ok);
        (void)ok;
    }
}

bool setting_used(const struct setting *setting, const struct settings *s)
{
    for (const struct setting_word *w = integrators; w->word; w++)
        if (text_equal(w->word, s->integrator))
            return setting->readers == ALL || (setting->readers & (int)w->value) != 0;
    return false;
}

static bool unknown_key(const char *name, const struct place *at, struct err *err)
{
    const char *names[ROW_COUNT + 1] = {NULL};
    struct text list = {0};
    for (int i = 0; i < ROW_COUNT; i++) {
        names[i] = rows[i].name;
        text_append(&list, "%s%s", i ? ", " : "", rows[i].name);
    }
    const char *near = text_nearest(name, names);
    err_set(err, ERR_USAGE, at, "unknown setting '%s'%s%s%s; settings are: %s", name,
            near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "",
            list.data);
    mem_free(list.data);
    return false;
}

bool settings_set(struct settings *settings, const char *name, const char *value,
                  const struct place *at, struct err *err)
{
    const struct setting *setting = settings_find(name);
    return setting ? setting_read(setting, settings, value, at, err)
                   : unknown_key(name, at, err);
}
