#include "image/layers.h"

#include "base/mem.h"
#include "base/text.h"

#include <assert.h>

float *layers_add(struct layers *layers, const char *name, size_t pixels)
{
    float *values = mem_alloc(pixels, sizeof *values);
    assert(layers->count < LAYERS_MOST);
    layers->list[layers->count++] = (struct layer){name, values, values};
    return values;
}

void layers_refer(struct layers *layers, const char *name, const float *values)
{
    assert(layers->count < LAYERS_MOST);
    if (values)
        layers->list[layers->count++] = (struct layer){name, values, NULL};
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
    layers->count = 0;
}
