#include "import/pbrt/pbrt_material_tables.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/pbrt/pbrt_bsdf.h"
#include "import/pbrt/pbrt_mixture.h"
#include "import/pbrt/pbrt_scene.h"
#include "import/suggest.h"

#include <assert.h>

static const struct pbrt_material_row of_both[] = {{"mix", pbrt_mixture_mix},
                                                   {NULL, NULL}};

/* Known materials that no reader supports; they are taken as diffuse. */
static const struct pbrt_material_row substituted[] = {
    {"hair", NULL},     {"subsurface", NULL}, {"kdsubsurface", NULL},
    {"measured", NULL}, {NULL, NULL},
};

static const struct pbrt_material_row *const tables[] = {
    pbrt_material_v3, pbrt_material_v4, pbrt_material_lux, of_both, substituted};

#define TABLES     (sizeof tables / sizeof tables[0])
#define NAMES_MOST 63

/* A material with a colour becomes diffuse with that colour. */
static bool substitute(struct pbrt *p, const char *name, const struct place *at,
                       struct bsdf *bsdf, struct err *err)
{
    static const char *const colours[] = {"Kd", "color", "reflectance", NULL};
    struct pbrt_value value = {.value = rgb_grey(0.5)};
    log_note(&p->desc->log, at, "material \"%s\" is taken as diffuse", name);
    for (int i = 0; colours[i]; i++)
        if (!pbrt_colour_value(p, colours[i], &value, err))
            return false;
    pbrt_ignored(p, err);
    return pbrt_bsdf_start(bsdf, "diffuse", at, err) &&
           pbrt_bsdf_set_value(bsdf, "reflectance", &value, at, err);
}

/* v4: a picture of normals, whose numbers are linear. */
static bool read_normal_map(struct pbrt *p, const struct pbrt_param *name,
                            struct bsdf_relief *relief, struct err *err)
{
    struct texture_set *set = &p->desc->textures;
    struct err failure = {0};
    char *path = pbrt_path(p, pbrt_params_text(&p->params, name));
    const struct texture_image *image = texture_image_load(
        set, path, TEXTURE_LINEAR, &name->place, &p->desc->log, &failure);
    mem_free(path);
    if (image)
        *relief = (struct bsdf_relief){texture_picture(set, image, TEXTURE_REPEAT), true};
    if (failure.code != ERR_NONE)
        *err = failure;
    return failure.code == ERR_NONE;
}

/* Of both maps v4 takes the bumps. */
static bool read_relief(struct pbrt *p, struct bsdf_relief *relief, struct err *err)
{
    struct pbrt_value bump = {0};
    const struct pbrt_param *normals = NULL;
    if (!pbrt_colour_float_value(p, "bumpmap", &bump, err) ||
        !pbrt_colour_float_value(p, "displacement", &bump, err))
        return false;
    if (pbrt_is_v4(p))
        normals = pbrt_params_find(&p->params, "normalmap", PBRT_STRING);
    /* A constant displacement moves no normal. */
    *relief = (struct bsdf_relief){.texture = bump.texture};
    return bump.texture || !normals || read_normal_map(p, normals, relief, err);
}

/* The relief of a mix is that of its parts; one has it for all of it. */
static void take_part_relief(struct pbrt *p, const struct place *at, struct bsdf *bsdf)
{
    for (int i = 0; i < 2 && !bsdf->relief.texture; i++)
        if (bsdf->child[i] && bsdf->child[i]->relief.texture) {
            bsdf->relief = bsdf->child[i]->relief;
            log_note(&p->desc->log, at,
                     "the bumps of one material count for all of a mix");
        }
}

static bool add(struct pbrt *p, const struct pbrt_material_row *row,
                const struct place *at, int *index, struct err *err)
{
    struct bsdf bsdf;
    if (row->read ? !row->read(p, at, &bsdf, err)
                  : !substitute(p, row->name, at, &bsdf, err))
        return false;
    if (!read_relief(p, &bsdf.relief, err))
        return false;
    take_part_relief(p, at, &bsdf);
    if (!bsdf_prepare(&bsdf, at, err))
        return false;
    *index = scene_desc_add_material(p->desc, &bsdf);
    return true;
}

/* Where the film did not tell the version, the first name of a material does. */
static void tell_version(struct pbrt *p, const struct pbrt_material_row *table)
{
    bool presumed = p->version == PBRT_V3_PRESUMED || p->version == PBRT_V4_PRESUMED;
    if (presumed && table == pbrt_material_v3)
        p->version = PBRT_V3;
    if (presumed && table == pbrt_material_v4)
        p->version = PBRT_V4;
}

bool pbrt_material(struct pbrt *p, const char *type, const struct place *at, int *index,
                   struct err *err)
{
    if (text_equal(type, "") || text_equal(type, "none") ||
        text_equal(type, "interface")) {
        *index = PBRT_MATERIAL_NONE;
        return true;
    }
    const char *known[NAMES_MOST + 1] = {"none"};
    size_t count = 1;
    for (size_t t = 0; t < TABLES; t++)
        for (const struct pbrt_material_row *row = tables[t]; row->name; row++) {
            if (text_equal(type, row->name)) {
                tell_version(p, tables[t]);
                return add(p, row, at, index, err);
            }
            assert(count < NAMES_MOST);
            known[count++] = row->name;
        }
    return suggest_fail(err, at, "material", type, known);
}

bool pbrt_material_default(struct pbrt *p, int *index, struct err *err)
{
    if (p->default_material < 0) {
        struct bsdf bsdf;
        if (!pbrt_bsdf_start(&bsdf, "diffuse", NULL, err) ||
            !pbrt_bsdf_set_rgb(&bsdf, "reflectance", rgb_grey(0.5), NULL, err) ||
            !bsdf_prepare(&bsdf, NULL, err))
            return false;
        p->default_material = scene_desc_add_material(p->desc, &bsdf);
    }
    *index = p->default_material;
    return true;
}

bool pbrt_material_set(struct pbrt *p, struct err *err)
{
    const char *type = pbrt_params_head(&p->params, 0);
    if (!pbrt_material(p, type, &p->params.head_places[0], &p->state.material, err))
        return false;
    pbrt_material_keep(p, p->state.material, type);
    return true;
}

bool pbrt_material_make(struct pbrt *p, struct err *err)
{
    const struct pbrt_param *type = pbrt_params_find(&p->params, "type", PBRT_STRING);
    if (!type || !type->is_string)
        return err_set(err, ERR_VALUE, &p->params.place,
                       "MakeNamedMaterial wants \"string type\"");
    int index;
    if (!pbrt_material(p, pbrt_params_text(&p->params, type), &type->place, &index, err))
        return false;
    pbrt_material_keep(p, index, pbrt_params_text(&p->params, type));
    pbrt_names_add(&p->materials, pbrt_params_head(&p->params, 0))->material = index;
    return true;
}

/* A name that nothing bears yet leaves the material as it is, in pbrt too; there are
 * scenes that do so. */
bool pbrt_material_named(struct pbrt *p, struct err *err)
{
    (void)err;
    struct err unknown = {0};
    const struct pbrt_named *found = pbrt_names_find(&p->materials, "named material",
                                                     pbrt_params_head(&p->params, 0),
                                                     &p->params.head_places[0], &unknown);
    if (found)
        p->state.material = found->material;
    else if (unknown.code != ERR_NONE)
        log_note(&p->desc->log, &p->params.head_places[0],
                 "%s; the material before it stays", unknown.message);
    return true;
}
