/* Parameters of a shape that are its material's: in pbrt v3 a Shape may say "rgb Kd",
 * which counts before that of the Material. */
#include "import/pbrt/pbrt_scene.h"

#include "base/mem.h"
#include "base/text.h"

void pbrt_material_keep(struct pbrt *p, int material, const char *type)
{
    if (p->lux || pbrt_is_v4(p) || material < 0)
        return;
    p->sources = mem_grow(p->sources, &p->source_capacity, p->source_count + 1,
                          sizeof *p->sources);
    struct pbrt_source_of *source = &p->sources[p->source_count++];
    *source = (struct pbrt_source_of){.material = material, .type = text_copy(type)};
    pbrt_params_append(&source->params, &p->params);
    source->params.own = source->params.count;
}

/* What v3 takes for a material's: anything that may be a colour, and single numbers. */
static bool may_be_of_material(const struct pbrt_param *param)
{
    bool single = param->count == 1 && (param->type & (PBRT_FLOAT | PBRT_BOOL));
    return !param->used && (single || (param->type & (PBRT_COLOUR | PBRT_TEXTURE)));
}

static bool says_something(const struct pbrt_params *params)
{
    for (size_t i = 0; i < params->own; i++)
        if (may_be_of_material(&params->list[i]))
            return true;
    return false;
}

static const struct pbrt_source_of *find_source(const struct pbrt *p, int material)
{
    for (size_t i = p->source_count; i-- > 0;)
        if (p->sources[i].material == material)
            return &p->sources[i];
    return NULL;
}

bool pbrt_material_of_shape(struct pbrt *p, int *material, struct err *err)
{
    if (p->lux || pbrt_is_v4(p) || !says_something(&p->params))
        return true;
    const struct pbrt_source_of *source = find_source(p, *material);
    if (source)
        pbrt_params_append(&p->params, &source->params);
    else if (*material != PBRT_MATERIAL_DEFAULT)
        return true;
    return pbrt_material(p, source ? source->type : "matte", &p->params.place, material,
                         err);
}
