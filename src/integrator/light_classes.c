#include "integrator/light_classes.h"

#include "base/mem.h"

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
    bool apart = (c->techniques || c->unweighted) && length <= LIGHT_TECHNIQUES_MOST;
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
        .techniques = (layers & LAYER_TECHNIQUES) != 0,
        .unweighted = (layers & LAYER_UNWEIGHTED) != 0,
    };
    memset(classes->of, -1, sizeof classes->of);
    for (int k = 1; k <= depth && k <= LIGHT_LENGTHS_MOST; k++)
        add_length(classes, k);
}

/* Techniques of all lengths up to most. */
static int techniques_up_to(int most)
{
    return most < 1 ? 0 : 1 + (most + 4) * (most - 1) / 2; /* 1 + 3 + 4 + ... */
}

int light_classes_channels(const struct settings *settings, int depth)
{
    bool far = depth > LIGHT_TECHNIQUES_MOST;
    int techniques = techniques_up_to(far ? LIGHT_TECHNIQUES_MOST : depth), layers = 0;
    if (settings->layers & LAYER_LENGTHS)
        layers += depth > LIGHT_LENGTHS_MOST ? LIGHT_LENGTHS_MOST + 1 : depth;
    if (settings->layers & LAYER_TECHNIQUES)
        layers += techniques + far;
    if (settings->layers & LAYER_UNWEIGHTED)
        layers += techniques;
    return 3 * layers;
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
    if (c->technique && classes->techniques)
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

/* The layers of a channel whose names begin so, but for `rest`; how many. */
static int find_parts(const struct layers *layers, const char *prefix, char channel,
                      const float *rest, const float **parts)
{
    int count = 0;
    for (int k = 0; k < layers->count; k++) {
        const struct layer *layer = &layers->list[k];
        if (layer->values != rest && strncmp(layer->name, prefix, strlen(prefix)) == 0 &&
            layer->name[strlen(layer->name) - 1] == channel)
            parts[count++] = layer->values;
    }
    return count;
}

static void add_rest(const char *prefix, const struct image *picture,
                     struct layers *layers)
{
    const float **parts = mem_alloc((size_t)layers->count + 3, sizeof *parts);
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    for (size_t c = 0; c < 3; c++) {
        char channel[LAYER_NAME_SIZE];
        snprintf(channel, sizeof channel, "%srest.%c", prefix, "RGB"[c]);
        float *rest = layers_add(layers, channel, pixels);
        int count = find_parts(layers, prefix, "RGB"[c], rest, parts);
        for (size_t i = 0; i < pixels; i++) {
            double left = (double)picture->pixels[3 * i + c];
            for (int k = 0; k < count; k++)
                left -= (double)parts[k][i];
            rest[i] = (float)left;
        }
    }
    mem_free(parts);
}

void light_classes_add_rest(const struct light_classes *classes,
                            const struct image *picture, struct layers *layers)
{
    if (classes->lengths && classes->depth > LIGHT_LENGTHS_MOST)
        add_rest("length_", picture, layers);
    if (classes->techniques && classes->depth > LIGHT_TECHNIQUES_MOST)
        add_rest("technique_", picture, layers);
}
