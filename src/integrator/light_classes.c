#include "integrator/light_classes.h"

#include <stdio.h>
#include <string.h>

static void add_class(struct light_classes *c, int length, int s, int t, bool technique)
{
    c->list[c->count] = (struct light_class){length, s, t, technique};
    c->of[s][t] = (int8_t)c->count++;
}

/* Of techniques first; lengths beyond them, or all, have two classes each. */
static void add_length(struct light_classes *c, int length)
{
    bool apart = c->techniques && length <= LIGHT_TECHNIQUES_MOST;
    if (!apart && !c->lengths)
        return;
    if (length > 1) /* (1,1) is left to (0,2) */
        add_class(c, length, length, 1, apart);
    if (!apart)
        add_class(c, length, 0, length + 1, false);
    for (int t = 2; t <= length + 1; t++) {
        if (apart)
            add_class(c, length, length + 1 - t, t, true);
        else
            c->of[length + 1 - t][t] = c->of[0][length + 1];
    }
}

void light_classes_init(struct light_classes *classes, const struct settings *settings,
                        int depth)
{
    long layers = settings->layers;
    *classes = (struct light_classes){
        .depth = depth,
        .lengths = (layers & LAYER_LENGTHS) != 0,
        .techniques = (layers & (LAYER_TECHNIQUES | LAYER_UNWEIGHTED)) != 0,
        .unweighted = (layers & LAYER_UNWEIGHTED) != 0,
    };
    memset(classes->of, -1, sizeof classes->of);
    for (int k = 1; k <= depth && k <= LIGHT_LENGTHS_MOST; k++)
        add_length(classes, k);
}

static void add(struct layers *layers, const char *name, const double *rgb, size_t pixels)
{
    for (int c = 0; c < 3; c++) {
        char channel[LAYER_NAME_SIZE];
        snprintf(channel, sizeof channel, "%s.%c", name, "RGB"[c]);
        float *values = layers_add(layers, channel, pixels);
        for (size_t i = 0; i < pixels; i++)
            values[i] += (float)rgb[3 * i + (size_t)c];
    }
}

void light_classes_add(const struct light_classes *classes, int class, const double *rgb,
                       size_t pixels, struct layers *layers)
{
    const struct light_class *c = &classes->list[class];
    char name[LAYER_NAME_SIZE - 2];
    snprintf(name, sizeof name, "length_%d", c->length);
    if (classes->lengths)
        add(layers, name, rgb, pixels);
    snprintf(name, sizeof name, "technique_s%d_t%d", c->s, c->t);
    if (c->technique)
        add(layers, name, rgb, pixels);
}

void light_classes_add_unweighted(const struct light_classes *classes, int class,
                                  const double *rgb, size_t pixels, struct layers *layers)
{
    const struct light_class *c = &classes->list[class];
    char name[LAYER_NAME_SIZE - 2];
    snprintf(name, sizeof name, "unweighted_s%d_t%d", c->s, c->t);
    if (c->technique)
        add(layers, name, rgb, pixels);
}

static void add_rest(const char *prefix, const struct image *picture,
                     struct layers *layers)
{
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    for (size_t c = 0; c < 3; c++) {
        char channel[LAYER_NAME_SIZE];
        snprintf(channel, sizeof channel, "%srest.%c", prefix, "RGB"[c]);
        float *rest = layers_add(layers, channel, pixels);
        for (size_t i = 0; i < pixels; i++) {
            double left = (double)picture->pixels[3 * i + c];
            for (int k = 0; k < layers->count; k++) {
                const struct layer *layer = &layers->list[k];
                size_t length = strlen(layer->name);
                if (layer->values != rest &&
                    strncmp(layer->name, prefix, strlen(prefix)) == 0 &&
                    layer->name[length - 1] == "RGB"[c])
                    left -= (double)layer->values[i];
            }
            rest[i] = (float)left;
        }
    }
}

void light_classes_add_rest(const struct light_classes *classes,
                            const struct image *picture, struct layers *layers)
{
    if (classes->lengths && classes->depth > LIGHT_LENGTHS_MOST)
        add_rest("length_", picture, layers);
    if (classes->techniques && classes->depth > LIGHT_TECHNIQUES_MOST)
        add_rest("technique_", picture, layers);
}
