#include "import/import.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/pbrt/pbrt_lux.h"
#include "import/pbrt/pbrt_scene.h"
#include "import/suggest.h"

enum scope { OPTIONS = 1, WORLD = 2, ANYWHERE = 3 };

/* How the rest of a directive looks. */
enum syntax {
    BARE,    /* the handler reads what follows, if anything */
    NAME,    /* one quoted name */
    LIST,    /* one quoted name and parameters */
    TEXTURE, /* three quoted names and parameters */
    VOLUME,  /* two quoted names and parameters */
};

struct directive {
    const char *name;
    enum scope scope;
    enum syntax syntax;
    bool (*run)(struct pbrt *p, struct err *err); /* NULL: no */
};

static bool world_begin(struct pbrt *p, struct err *err)
{
    if (p->depth > 0)
        return err_set(err, ERR_SYNTAX, &p->stack[p->depth - 1].place,
                       "this Begin is still open at WorldBegin");
    p->in_world = true;
    p->world_place = p->params.place;
    p->state.ctm = xform_identity();
    pbrt_names_add(&p->systems, "world")->ctm = p->state.ctm;
    return true;
}

static bool world_end(struct pbrt *p, struct err *err)
{
    if (p->depth > 0)
        return err_set(err, ERR_SYNTAX, &p->stack[p->depth - 1].place,
                       "this Begin is still open at WorldEnd");
    p->in_world = false;
    p->world_done = true;
    return true;
}

static bool attribute_begin(struct pbrt *p, struct err *err)
{
    (void)err;
    pbrt_state_push(p, false, &p->params.place);
    return true;
}

static bool attribute_end(struct pbrt *p, struct err *err)
{
    return pbrt_state_pop(p, false, &p->params.place, err);
}

static bool transform_begin(struct pbrt *p, struct err *err)
{
    (void)err;
    pbrt_state_push(p, true, &p->params.place);
    return true;
}

static bool transform_end(struct pbrt *p, struct err *err)
{
    return pbrt_state_pop(p, true, &p->params.place, err);
}

static bool reverse_orientation(struct pbrt *p, struct err *err)
{
    (void)err;
    p->state.reverse_orientation = !p->state.reverse_orientation;
    return true;
}

static bool include(struct pbrt *p, struct err *err)
{
    char *path = text_join(p->directory, pbrt_params_head(&p->params, 0));
    bool opened = pbrt_lexer_include(&p->lexer, path, &p->params.head_places[0], err);
    mem_free(path);
    return opened;
}

static bool material(struct pbrt *p, struct err *err)
{
    return pbrt_material(p, pbrt_params_head(&p->params, 0), &p->params.head_places[0],
                         &p->state.material, err);
}

static bool make_named_material(struct pbrt *p, struct err *err)
{
    const struct pbrt_param *type = pbrt_params_find(&p->params, "type", PBRT_STRING);
    if (!type || !type->is_string)
        return err_set(err, ERR_VALUE, &p->params.place,
                       "MakeNamedMaterial wants \"string type\"");
    int index;
    if (!pbrt_material(p, pbrt_params_text(&p->params, type), &type->place, &index, err))
        return false;
    pbrt_names_add(&p->materials, pbrt_params_head(&p->params, 0))->material = index;
    return true;
}

/* A name that nothing bears yet leaves the material as it is, in pbrt too; there are
 * scenes that do so. */
static bool named_material(struct pbrt *p, struct err *err)
{
    (void)err;
    struct err unknown = {0};
    const struct pbrt_named *found = pbrt_names_find(&p->materials, "named material",
                                                     pbrt_params_head(&p->params, 0),
                                                     &p->params.head_places[0], &unknown);
    if (found)
        p->state.material = found->material;
    else
        log_note(&p->desc->log, &p->params.head_places[0],
                 "%s; the material before it stays", unknown.message);
    return true;
}

static bool coordinate_system(struct pbrt *p, struct err *err)
{
    (void)err;
    pbrt_names_add(&p->systems, pbrt_params_head(&p->params, 0))->ctm = p->state.ctm;
    return true;
}

static bool coord_sys_transform(struct pbrt *p, struct err *err)
{
    const struct pbrt_named *found = pbrt_names_find(&p->systems, "coordinate system",
                                                     pbrt_params_head(&p->params, 0),
                                                     &p->params.head_places[0], err);
    if (found)
        p->state.ctm = found->ctm;
    return found != NULL;
}

static bool medium(struct pbrt *p, struct err *err)
{
    log_note(&p->desc->log, &p->params.place, "media are left out: space is empty");
    return pbrt_ignored(p, err);
}

static const struct directive directives[] = {
    {"Identity", ANYWHERE, BARE, pbrt_transform_identity},
    {"Translate", ANYWHERE, BARE, pbrt_transform_translate},
    {"Scale", ANYWHERE, BARE, pbrt_transform_scale},
    {"Rotate", ANYWHERE, BARE, pbrt_transform_rotate},
    {"LookAt", ANYWHERE, BARE, pbrt_transform_look_at},
    {"Transform", ANYWHERE, BARE, pbrt_transform_set},
    {"ConcatTransform", ANYWHERE, BARE, pbrt_transform_concat},
    {"CoordinateSystem", ANYWHERE, NAME, coordinate_system},
    {"CoordSysTransform", ANYWHERE, NAME, coord_sys_transform},
    {"TransformBegin", ANYWHERE, BARE, transform_begin},
    {"TransformEnd", ANYWHERE, BARE, transform_end},
    {"AttributeBegin", ANYWHERE, BARE, attribute_begin},
    {"AttributeEnd", ANYWHERE, BARE, attribute_end},
    {"ReverseOrientation", ANYWHERE, BARE, reverse_orientation},
    {"Include", ANYWHERE, NAME, include},
    {"Import", ANYWHERE, NAME, include},
    {"Camera", OPTIONS, LIST, pbrt_camera},
    {"Film", OPTIONS, LIST, pbrt_film},
    {"Integrator", OPTIONS, LIST, pbrt_integrator},
    {"PixelFilter", OPTIONS, LIST, pbrt_filter},
    {"Sampler", OPTIONS, LIST, pbrt_ignored},
    {"Accelerator", OPTIONS, LIST, pbrt_ignored},
    {"WorldBegin", OPTIONS, BARE, world_begin},
    {"WorldEnd", WORLD, BARE, world_end},
    {"Material", WORLD, LIST, material},
    {"MakeNamedMaterial", WORLD, LIST, make_named_material},
    {"NamedMaterial", WORLD, NAME, named_material},
    {"Texture", WORLD, TEXTURE, pbrt_colour_texture},
    {"AreaLightSource", WORLD, LIST, pbrt_light_area},
    {"LightSource", WORLD, LIST, pbrt_light_source},
    {"Shape", WORLD, LIST, pbrt_shape},
    {"ObjectBegin", WORLD, NAME, pbrt_object_begin},
    {"ObjectEnd", WORLD, BARE, pbrt_object_end},
    {"ObjectInstance", WORLD, NAME, pbrt_object_instance},
    {"MakeNamedMedium", ANYWHERE, LIST, medium},
    {"MediumInterface", ANYWHERE, LIST, NULL},
    {"ActiveTransform", ANYWHERE, BARE, NULL},
    /* LuxRender's. */
    {"Renderer", OPTIONS, LIST, pbrt_lux_nothing},
    {"SurfaceIntegrator", OPTIONS, LIST, pbrt_lux_integrator},
    {"VolumeIntegrator", OPTIONS, LIST, pbrt_lux_nothing},
    {"LightGroup", WORLD, NAME, pbrt_lux_nothing},
    {"MakeNamedVolume", WORLD, VOLUME, pbrt_lux_volume},
    {"Interior", WORLD, NAME, pbrt_lux_nothing},
    {"Exterior", WORLD, NAME, pbrt_lux_nothing},
    {"PortalShape", WORLD, LIST, pbrt_lux_nothing},
    {"TransformTimes", OPTIONS, BARE, NULL},
};

#define DIRECTIVES (sizeof directives / sizeof directives[0])

_Static_assert(DIRECTIVES <= 64, "each has a bit of pbrt.given");

static const struct directive *find_directive(const struct pbrt_token *token,
                                              struct err *err)
{
    const char *known[DIRECTIVES + 1] = {0};
    if (token->kind != PBRT_TOKEN_WORD) {
        char text[80];
        pbrt_token_describe(token, text, sizeof text);
        err_set(err, ERR_SYNTAX, &token->place, "expected a directive, got %s", text);
        return NULL;
    }
    for (size_t i = 0; i < DIRECTIVES; i++) {
        if (text_equal(token->text, directives[i].name))
            return &directives[i];
        known[i] = directives[i].name;
    }
    suggest_fail(err, &token->place, "directive", token->text, known);
    return NULL;
}

static bool check_scope(const struct pbrt *p, const struct directive *d,
                        const struct place *at, struct err *err)
{
    if (!d->run)
        return err_set(err, ERR_UNSUPPORTED, at, "%s is not read yet", d->name);
    if (p->world_done)
        return err_set(err, ERR_UNSUPPORTED, at,
                       "%s after WorldEnd: one picture in a file", d->name);
    if (d->scope & (p->in_world ? WORLD : OPTIONS))
        return true;
    return err_set(err, ERR_SYNTAX, at, "%s belongs %s WorldBegin", d->name,
                   d->scope == WORLD ? "after" : "before");
}

/* Camera, Film and the like: of several the last counts, as in pbrt. */
static void note_second(struct pbrt *p, const struct directive *d, const struct place *at)
{
    uint64_t bit = UINT64_C(1) << (d - directives);
    if (d->scope != OPTIONS || d->syntax != LIST)
        return;
    if (p->given & bit)
        log_note(&p->desc->log, at, "a second %s: it takes the place of the first",
                 d->name);
    p->given |= bit;
}

static bool run_directive(struct pbrt *p, const struct pbrt_token *token, struct err *err)
{
    static const int heads[] = {
        [BARE] = 0, [NAME] = 1, [LIST] = 1, [TEXTURE] = 3, [VOLUME] = 2};
    const struct directive *d = find_directive(token, err);
    bool with_list = d && d->syntax >= LIST;
    if (!d || !check_scope(p, d, &token->place, err) ||
        !pbrt_params_parse(&p->params, &p->lexer, heads[d->syntax], with_list,
                           &token->place, err) ||
        !d->run(p, err))
        return false;
    note_second(p, d, &token->place);
    pbrt_params_report(&p->params, d->name, &p->desc->log);
    return true;
}

static bool run_file(struct pbrt *p, struct err *err)
{
    struct pbrt_token token;
    for (;;) {
        if (!pbrt_lexer_next(&p->lexer, &token, err))
            return false;
        if (token.kind == PBRT_TOKEN_END)
            break;
        if (!run_directive(p, &token, err))
            return false;
    }
    if (p->in_world)
        return err_set(err, ERR_SYNTAX, &token.place,
                       "the file ends before the WorldEnd of the WorldBegin in line %d",
                       p->world_place.line);
    if (!p->world_done)
        return err_set(err, ERR_SYNTAX, &token.place, "the file has no WorldBegin");
    if (p->desc->camera.place.line == 0)
        log_note(
            &p->desc->log, &p->world_place,
            "no Camera before this: pbrt's own is taken, at the origin, with fov 90");
    return true;
}

/* What pbrt v3 takes where a file says nothing. */
static void set_defaults(struct pbrt *p)
{
    struct scene_desc *desc = p->desc;
    desc->camera.to_world = xform_identity();
    desc->camera.fov = 90.0;
    desc->camera.fov_axis = FOV_SMALLER;
    desc->camera.focus_distance = 1e6;
    desc->camera.crop[1] = desc->camera.crop[3] = 1.0;
    desc->width = 1280;
    desc->height = 720;
    desc->max_depth = 6;
}

/* The film's own factor, as one of all light. */
static void scale_emission(struct scene_desc *desc, double scale)
{
    for (size_t i = 0; i < desc->shape_count; i++)
        desc->shapes[i].radiance = rgb_scale(desc->shapes[i].radiance, scale);
    for (size_t i = 0; i < desc->light_count; i++)
        desc->lights[i].intensity = rgb_scale(desc->lights[i].intensity, scale);
}

struct scene_desc *import_pbrt(const char *path, const struct import_options *options,
                               struct err *err)
{
    struct scene_desc *desc = scene_desc_create(path);
    struct pbrt p;
    pbrt_state_init(&p, desc);
    set_defaults(&p);
    p.ahead = ahead_read(path, p.directory, "\"\n", &desc->textures, options);
    bool read = pbrt_lexer_init(&p.lexer, desc, path, err) && run_file(&p, err);
    pbrt_object_finish(&p);
    scale_emission(desc, p.film_scale);
    ahead_destroy(p.ahead);
    pbrt_state_deinit(&p);
    if (read)
        return desc;
    scene_desc_destroy(desc);
    return NULL;
}
