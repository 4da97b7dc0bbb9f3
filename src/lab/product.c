#include "lab/product.h"

#include "base/mem.h"
#include "base/text.h"

static bool has_axis(const struct product *product, const char *name)
{
    for (size_t i = 0; i < product->count; i++)
        if (text_equal(product->axes[i]->name, name))
            return true;
    return false;
}

static void add_axes(struct product *product, const struct axes *axes)
{
    for (size_t i = 0; i < axes->count; i++) {
        if (has_axis(product, axes->items[i].name))
            continue;
        product->axes = mem_grow(product->axes, &product->capacity, product->count + 1,
                                 sizeof(const struct axis *));
        product->axes[product->count++] = &axes->items[i];
    }
}

void product_init(struct product *product, const struct experiment *e,
                  const struct experiment_scene *scene,
                  const struct experiment_variant *variant)
{
    *product = (struct product){0};
    add_axes(product, &variant->axes);
    add_axes(product, &scene->axes);
    add_axes(product, &e->axes);
    product->at = mem_alloc(product->count, sizeof *product->at);
}

void product_deinit(struct product *product)
{
    mem_free(product->axes);
    mem_free(product->at);
}

bool product_next(struct product *product)
{
    for (size_t i = product->count; i-- > 0;) {
        if (++product->at[i] < product->axes[i]->count)
            return true;
        product->at[i] = 0;
    }
    return false;
}

size_t product_size(const struct product *product, size_t most)
{
    size_t size = 1;
    for (size_t i = 0; i < product->count; i++)
        if (size <= most)
            size *= product->axes[i]->count; /* both below 2^32: no overflow */
    return size;
}

const struct choice *product_taken(const struct product *product, size_t axis)
{
    return &product->axes[axis]->choices[product->at[axis]];
}
