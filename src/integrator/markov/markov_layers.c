/* The layers of a run of chains. */

#include "integrator/markov/markov_result.h"

#include "base/mem.h"
#include "integrator/markov/markov_group.h"

static struct rgb value_of(const struct film *film, long pixel)
{
    return film ? film_value(film, (int)pixel) : rgb_grey(0.0);
}

/* r / g of the film; -1 where no proposal was made. */
static void add_ratio(const struct markov *m, const struct film *film, const char *name,
                      struct layers *out)
{
    float *shares = layers_add(out, name, (size_t)markov_pixels(m));
    for (long i = 0; i < (long)markov_pixels(m); i++) {
        struct rgb v = value_of(film, i);
        shares[i] = v.g > 0.0 ? (float)(v.r / v.g) : -1.0f;
    }
}

/* A channel of the map of steps over its mean. */
static void add_relative(const struct markov *m, int channel, const char *name,
                         struct layers *out)
{
    double sum = 0.0, pixels = markov_pixels(m);
    float *values = layers_add(out, name, (size_t)pixels);
    for (int pass = 0; pass < 2; pass++)
        for (long i = 0; i < (long)pixels; i++) {
            struct rgb v = value_of(m->films.steps, i);
            double value = channel == 1 ? v.g : v.b;
            if (pass == 0)
                sum += value;
            else if (sum > 0.0)
                values[i] = (float)(value * pixels / sum);
        }
}

static void add_steps(const struct markov *m, struct layers *out)
{
    long layers = m->settings->layers;
    if (m->design.failure_map || (layers & LAYER_FAILURES))
        add_ratio(m, m->films.steps, "failures.Y", out);
    if (layers & LAYER_WORK)
        add_relative(m, 2, "work.Y", out);
    if (layers & LAYER_VISITS)
        add_relative(m, 1, "visits.Y", out);
    if (layers & LAYER_ACCEPTANCE) {
        add_ratio(m, m->films.small_steps, "acceptance_small.Y", out);
        add_ratio(m, m->films.large_steps, "acceptance_large.Y", out);
    }
}

/* The group whose chains have that path length. */
static const struct group *group_of_length(const struct markov *m, int length)
{
    for (int i = 0; i < m->group_count; i++)
        if (m->groups[i].length == 0 || m->groups[i].length == length)
            return &m->groups[i];
    return NULL;
}

/* As markov_picture does it for all classes at once. A length that is of plain samples
 * has no group. */
static void add_class(const struct markov *m, int class, double *sum, struct layers *out)
{
    const struct markov_films *f = &m->films;
    const struct group *group = group_of_length(m, f->light.list[class].length);
    long pixels = (long)markov_pixels(m);
    double variance, unit = m->scene->emission_scale * (double)pixels;
    for (long i = 0; i < 3 * pixels; i++)
        sum[i] = 0.0;
    if (group && f->class_states[class] && markov_states(m, group) > 0.0)
        markov_add_film(sum, f->class_states[class], pixels,
                        unit * group_brightness(m, group, &variance) /
                            markov_states(m, group));
    if (f->class_large[class] && m->done > 0)
        markov_add_film(sum, f->class_large[class], pixels,
                        unit * m->b0 / markov_large_count(m));
    light_classes_add(&f->light, class, sum, (size_t)pixels, out);
}

static void add_classes(const struct markov *m, struct layers *out)
{
    if (m->films.light.count == 0)
        return;
    double *sum = mem_alloc(3 * (size_t)markov_pixels(m), sizeof *sum);
    for (int i = 0; i < m->films.light.count; i++)
        add_class(m, i, sum, out);
    mem_free(sum);
}

void markov_layers(void *self, struct layers *out)
{
    struct markov *m = self;
    add_steps(m, out);
    add_classes(m, out);
    if (m->direct)
        passes_light_layers(m->direct, out);
}
