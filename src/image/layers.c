#include "image/layers.h"

#include "base/mem.h"
#include "base/text.h"

#include <assert.h>
#include <string.h>

static void append(struct layers *layers, const char *name, const float *values,
                   float *owned)
{
    layers->list = mem_grow(layers->list, &layers->capacity, (size_t)layers->count + 1,
                            sizeof *layers->list);
    struct layer *layer = &layers->list[layers->count++];
    *layer = (struct layer){.values = values, .owned = owned};
    assert(strlen(name) < LAYER_NAME_SIZE);
    memcpy(layer->name, name, strlen(name) + 1);
}

float *layers_add(struct layers *layers, const char *name, size_t pixels)
{
    for (int i = 0; i < layers->count; i++)
        if (layers->list[i].owned && text_equal(layers->list[i].name, name))
            return layers->list[i].owned;
    float *values = mem_alloc(pixels, sizeof *values);
    append(layers, name, values, values);
    return values;
}

void layers_refer(struct layers *layers, const char *name, const float *values)
{
    if (values)
        append(layers, name, values, NULL);
}

const float *layers_find(const struct layers *layers, const char *name)
{
    for (int i = 0; i < layers->count; i++)
        if (text_equal(layers->list[i].name, name))
            return layers->list[i].values;
    return NULL;
}

void layers_deinit(struct layers *layers)
{
    for (int i = 0; i < layers->count; i++)
        mem_free(layers->list[i].owned);
    mem_free(layers->list);
    *layers = (struct layers){0};
}
