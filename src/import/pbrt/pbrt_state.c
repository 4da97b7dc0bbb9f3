#include "import/pbrt/pbrt_state.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/suggest.h"

#include <unistd.h>

void pbrt_state_init(struct pbrt *p, struct scene_desc *desc,
                     const struct import_options *options, struct err *first_error)
{
    *p = (struct pbrt){.desc = desc,
                       .options = options,
                       .first_error = first_error,
                       .default_material = -1,
                       .film_scale = 1.0,
                       .shutter = 1.0,
                       .lux_index = 1.5,
                       .lux = text_ends_with(desc->path, ".lxs")};
    p->directory = text_directory(desc->path);
    p->state.ctm = xform_identity();
    p->state.material = PBRT_MATERIAL_DEFAULT;
    p->state.active = PBRT_ALL_TIMES;
}

static void drop_attributes(struct pbrt *p, size_t count)
{
    while (p->attribute_count > count)
        pbrt_params_deinit(&p->attributes[--p->attribute_count].params);
}

static void drop_sources(struct pbrt *p)
{
    for (size_t i = 0; i < p->source_count; i++) {
        mem_free(p->sources[i].type);
        pbrt_params_deinit(&p->sources[i].params);
    }
    mem_free(p->sources);
}

void pbrt_state_deinit(struct pbrt *p)
{
    pbrt_names_truncate(&p->materials, 0);
    pbrt_names_truncate(&p->textures, 0);
    pbrt_names_truncate(&p->systems, 0);
    mem_free(p->materials.list);
    mem_free(p->textures.list);
    pbrt_names_truncate(&p->objects, 0);
    mem_free(p->systems.list);
    mem_free(p->objects.list);
    mem_free(p->variants);
    drop_attributes(p, 0);
    drop_sources(p);
    mem_free(p->attributes);
    mem_free(p->stack);
    mem_free(p->directory);
    pbrt_params_deinit(&p->params);
    pbrt_lexer_deinit(&p->lexer);
}

void pbrt_state_push(struct pbrt *p, bool transform_only, const struct place *at)
{
    p->stack = mem_grow(p->stack, &p->stack_capacity, p->depth + 1, sizeof *p->stack);
    p->state.named_count = p->materials.count;
    p->state.texture_count = p->textures.count;
    p->state.attribute_count = p->attribute_count;
    p->stack[p->depth++] = (struct pbrt_frame){p->state, transform_only, *at};
}

bool pbrt_state_pop(struct pbrt *p, bool transform_only, const struct place *at,
                    struct err *err)
{
    const char *what = transform_only ? "Transform" : "Attribute";
    if (p->depth == 0)
        return err_set(err, ERR_SYNTAX, at, "%sEnd without %sBegin", what, what);
    const struct pbrt_frame *top = &p->stack[p->depth - 1];
    if (top->transform_only != transform_only)
        return err_set(err, ERR_SYNTAX, at, "%sEnd closes the %sBegin of line %d", what,
                       transform_only ? "Attribute" : "Transform", top->place.line);
    p->depth--;
    if (transform_only) {
        p->state.ctm = top->state.ctm;
        p->state.singular = top->state.singular;
        p->state.active = top->state.active;
        return true;
    }
    p->state = top->state;
    drop_attributes(p, p->state.attribute_count);
    if (pbrt_is_v4(p)) /* its names hold for the whole file */
        return true;
    pbrt_names_truncate(&p->materials, p->state.named_count);
    pbrt_names_truncate(&p->textures, p->state.texture_count);
    return true;
}

bool pbrt_state_moves(struct pbrt *p)
{
    if (p->state.active & PBRT_START_TIME)
        return true;
    log_note(&p->desc->log, &p->params.place,
             "a transform of EndTime is left out: nothing moves, everything stands as at "
             "the start of the shutter");
    return false;
}

void pbrt_state_concat(struct pbrt *p, const struct xform *next)
{
    if (pbrt_state_moves(p))
        p->state.ctm = xform_mul(&p->state.ctm, next);
}

void pbrt_state_set(struct pbrt *p, const struct xform *next)
{
    if (!pbrt_state_moves(p))
        return;
    p->state.ctm = *next;
    p->state.singular = (struct place){0};
}

bool pbrt_state_check(struct pbrt *p, struct err *err)
{
    struct place at = p->state.singular;
    p->state.singular = (struct place){0};
    return at.line == 0 ||
           err_set(err, ERR_VALUE, &at,
                   "this transform has no inverse, and a %s stands under it in line %d",
                   pbrt_params_head(&p->params, 0), p->params.place.line);
}

char *pbrt_path(const struct pbrt *p, const char *name)
{
    char *path = text_join(p->directory, name);
    if (access(path, F_OK) == 0 || access(name, F_OK) != 0)
        return path;
    mem_free(path);
    return text_copy(name);
}

struct pbrt_named *pbrt_names_add(struct pbrt_names *names, const char *name)
{
    names->list = mem_grow(names->list, &names->capacity, names->count + 1,
                           sizeof *names->list);
    struct pbrt_named *entry = &names->list[names->count++];
    *entry = (struct pbrt_named){.name = text_copy(name)};
    return entry;
}

void pbrt_names_truncate(struct pbrt_names *names, size_t count)
{
    while (names->count > count)
        mem_free(names->list[--names->count].name);
}

const struct pbrt_named *pbrt_names_find(const struct pbrt_names *names, const char *what,
                                         const char *name, const struct place *at,
                                         struct err *err)
{
    for (size_t i = names->count; i-- > 0;)
        if (text_equal(names->list[i].name, name))
            return names->list[i].unread ? NULL : &names->list[i];
    if (names->incomplete)
        return NULL;
    const char **known = mem_alloc(names->count + 1, sizeof *known);
    for (size_t i = 0; i < names->count; i++)
        known[i] = names->list[i].name;
    suggest_fail(err, at, what, name, known);
    mem_free(known);
    return NULL;
}
