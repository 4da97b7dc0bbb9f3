/* Independent samples: layers by class of light, and of the samples themselves. */

#include "chain/state.h"
#include "integrator/passes_state.h"

/* The estimator that keeps techniques apart. */
static estimate_function by_technique(estimate_function estimate)
{
    return estimate == estimate_pt     ? estimate_pt_layers
           : estimate == estimate_bdpt ? estimate_bdpt_layers
                                       : estimate;
}

bool pass_layers_of_classes(const struct settings *settings)
{
    return (settings->layers & (LAYER_LENGTHS | LAYER_TECHNIQUES | LAYER_UNWEIGHTED)) !=
           0;
}

/* Beside chains, the maps are of these. */
static bool maps_samples(const struct settings *settings)
{
    return (settings->layers & (LAYER_FAILURES | LAYER_WORK)) != 0 &&
           !settings_uses(settings, "chains");
}

void pass_layers_create(struct pass_layers *layers, const struct scene *scene,
                        const struct settings *settings, int depth,
                        estimate_function *estimate)
{
    light_classes_init(&layers->classes, settings, depth);
    bool samples = maps_samples(settings);
    layers->each = 1 + layers->classes.unweighted;
    layers->count = layers->each * layers->classes.count + samples;
    layers->films = mem_alloc((size_t)layers->count, sizeof(struct film *));
    for (int i = 0; i < layers->count; i++)
        layers->films[i] = film_create(scene->camera.width, scene->camera.height);
    layers->samples = samples ? layers->films[layers->count - 1] : NULL;
    if (layers->classes.count > 0)
        *estimate = by_technique(*estimate);
}

void pass_layers_destroy(struct pass_layers *layers)
{
    for (int i = 0; i < layers->count; i++)
        film_destroy(layers->films[i]);
    mem_free(layers->films);
}

void pass_layers_memory(const struct scene *scene, const struct settings *settings,
                        int depth, struct run_memory *out)
{
    int width = scene->camera.width, height = scene->camera.height;
    struct light_classes classes;
    light_classes_init(&classes, settings, depth);
    int films = (1 + classes.unweighted) * classes.count + maps_samples(settings);
    out->films += films * film_bytes(width, height);
    out->rare += films * film_rare_bytes(width, height);
}

void pass_layers_add(const struct pass_layers *layers, struct worker *w, int pixel,
                     double unit)
{
    const struct contrib *c = &w->contrib;
    double work = state_work(w->numbers.events, c->connections);
    w->numbers.events = 0;
    if (layers->samples)
        film_splat(layers->samples, pixel, rgb(c->count == 0, 1.0, work), 1.0);
    for (int i = 0; layers->classes.count > 0 && i < c->count; i++) {
        const struct splat *s = &c->splats[i];
        int class = light_class(&layers->classes, s->s, s->t);
        if (class < 0)
            continue;
        struct film **films = &layers->films[(long)layers->each * class];
        film_splat(films[0], s->pixel, s->value, 1.0 / unit);
        if (layers->each > 1 && c->weights[i] > 0.0)
            film_splat(films[1], s->pixel, s->value, 1.0 / (unit * c->weights[i]));
    }
}

void pass_layers_clear(struct pass_layers *layers)
{
    for (int i = 0; i < layers->count; i++)
        film_clear(layers->films[i]);
}

void pass_layers_pack(struct pass_layers *layers, struct pack *pack)
{
    for (int i = 0; i < layers->count; i++)
        film_pack(pack, layers->films[i]);
}

/* The film of a class as passes_picture makes one of the sums of all. */
static void take_class(const struct passes *p, const struct film *film, int class,
                       double *rgb)
{
    double paths = passes_traced(p), pixels = passes_pixels(p);
    double unit = p->unit * p->scene->emission_scale;
    for (long i = 0; i < (long)pixels; i++) {
        double n = p->counts[i], scale = 0.0;
        if (n > 0.0)
            scale = p->layers.classes.list[class].t == 1 ? unit * pixels / paths
                                                         : unit / n;
        struct rgb v = film_value(film, (int)i);
        rgb[3 * i] = scale * v.r;
        rgb[3 * i + 1] = scale * v.g;
        rgb[3 * i + 2] = scale * v.b;
    }
}

void passes_light_layers(const struct passes *p, struct layers *out)
{
    size_t pixels = (size_t)passes_pixels(p);
    if (p->layers.classes.count == 0)
        return;
    double *rgb = mem_alloc(3 * pixels, sizeof *rgb);
    for (int i = 0; i < p->layers.classes.count; i++) {
        struct film *const *films = &p->layers.films[(long)p->layers.each * i];
        take_class(p, films[0], i, rgb);
        light_classes_add(&p->layers.classes, i, rgb, pixels, out);
        if (p->layers.each < 2)
            continue;
        take_class(p, films[1], i, rgb);
        light_classes_add_unweighted(&p->layers.classes, i, rgb, pixels, out);
    }
    mem_free(rgb);
}

/* Work over the mean; a pixel has as many samples as the others, but for an incomplete
 * pass. */
void passes_layers(void *self, struct layers *out)
{
    const struct passes *p = self;
    size_t pixels = (size_t)passes_pixels(p);
    double work = 0.0;
    for (size_t i = 0; p->layers.samples && i < pixels; i++)
        work += film_value(p->layers.samples, (int)i).b;
    float *failures = p->settings->layers & LAYER_FAILURES
                          ? layers_add(out, "failures.Y", pixels)
                          : NULL;
    float *costs = p->settings->layers & LAYER_WORK ? layers_add(out, "work.Y", pixels)
                                                    : NULL;
    for (size_t i = 0; p->layers.samples && i < pixels; i++) {
        struct rgb v = film_value(p->layers.samples, (int)i);
        if (failures)
            failures[i] = v.g > 0.0 ? (float)(v.r / v.g) : -1.0f;
        if (costs && work > 0.0)
            costs[i] = (float)(v.b * (double)pixels / work);
    }
    passes_light_layers(p, out);
}
