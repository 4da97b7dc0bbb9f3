#include "import/import.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/pbrt/pbrt_failure.h"
#include "import/pbrt/pbrt_lux.h"
#include "import/pbrt/pbrt_scene.h"
#include "import/suggest.h"

enum scope { OPTIONS = 1, WORLD = 2, ANYWHERE = 3 };

/* How the rest of a directive looks. */
enum syntax {
    BARE,    /* the handler reads what follows, if anything */
    NAME,    /* one quoted name */
    LIST,    /* one quoted name and parameters */
    PARAMS,  /* parameters alone */
    TEXTURE, /* three quoted names and parameters */
    VOLUME,  /* two quoted names and parameters */
};

struct directive {
    const char *name;
    enum scope scope;
    enum syntax syntax;
    bool (*run)(struct pbrt *p, struct err *err);
};

/* v3's world has an end, v4's is that of the file. */
static void guess_version(struct pbrt *p)
{
    if (p->version == PBRT_V3_PRESUMED && !p->lux &&
        !pbrt_lexer_has_ahead(&p->lexer, "WorldEnd"))
        p->version = PBRT_V4_PRESUMED;
}

static bool world_begin(struct pbrt *p, struct err *err)
{
    if (p->depth > 0)
        return err_set(err, ERR_SYNTAX, &p->stack[p->depth - 1].place,
                       "this Begin is still open at WorldBegin");
    p->in_world = true;
    p->world_place = p->params.place;
    p->state.ctm = xform_identity();
    p->state.singular = (struct place){0};
    p->state.active = PBRT_ALL_TIMES;
    guess_version(p);
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

/* Import and the directives of the imported file call each other. */
static bool import(struct pbrt *p, struct err *err);

static bool include(struct pbrt *p, struct err *err)
{
    char *path = pbrt_path(p, pbrt_params_head(&p->params, 0));
    bool opened = pbrt_lexer_include(&p->lexer, path, &p->params.head_places[0], err);
    mem_free(path);
    return opened;
}

static bool medium(struct pbrt *p, struct err *err)
{
    log_note(&p->desc->log, &p->params.place, "media are left out: space is empty");
    return pbrt_ignored(p, err);
}

/* The second name may be absent: then both sides have the first. */
static bool medium_interface(struct pbrt *p, struct err *err)
{
    const struct pbrt_token *next;
    struct pbrt_token second;
    if (!pbrt_lexer_peek(&p->lexer, &next, err) ||
        (next->kind == PBRT_TOKEN_STRING && !pbrt_lexer_next(&p->lexer, &second, err)))
        return false;
    return medium(p, err);
}

static const struct directive directives[] = {
    {"Identity", ANYWHERE, BARE, pbrt_transform_identity},
    {"Translate", ANYWHERE, BARE, pbrt_transform_translate},
    {"Scale", ANYWHERE, BARE, pbrt_transform_scale},
    {"Rotate", ANYWHERE, BARE, pbrt_transform_rotate},
    {"LookAt", ANYWHERE, BARE, pbrt_transform_look_at},
    {"Transform", ANYWHERE, BARE, pbrt_transform_set},
    {"ConcatTransform", ANYWHERE, BARE, pbrt_transform_concat},
    {"CoordinateSystem", ANYWHERE, NAME, pbrt_transform_name},
    {"CoordSysTransform", ANYWHERE, NAME, pbrt_transform_to_named},
    {"ActiveTransform", ANYWHERE, BARE, pbrt_transform_active},
    {"TransformTimes", OPTIONS, BARE, pbrt_transform_times},
    {"TransformBegin", ANYWHERE, BARE, transform_begin},
    {"TransformEnd", ANYWHERE, BARE, transform_end},
    {"AttributeBegin", ANYWHERE, BARE, attribute_begin},
    {"AttributeEnd", ANYWHERE, BARE, attribute_end},
    {"ReverseOrientation", ANYWHERE, BARE, reverse_orientation},
    {"Include", ANYWHERE, NAME, include},
    {"Import", ANYWHERE, NAME, import},
    {"Option", OPTIONS, PARAMS, pbrt_option},
    {"ColorSpace", ANYWHERE, NAME, pbrt_colour_space},
    {"Attribute", ANYWHERE, LIST, pbrt_attribute},
    {"Camera", OPTIONS, LIST, pbrt_camera},
    {"Film", OPTIONS, LIST, pbrt_film},
    {"Integrator", OPTIONS, LIST, pbrt_integrator},
    {"PixelFilter", OPTIONS, LIST, pbrt_filter},
    {"Sampler", OPTIONS, LIST, pbrt_ignored},
    {"Accelerator", OPTIONS, LIST, pbrt_ignored},
    {"WorldBegin", OPTIONS, BARE, world_begin},
    {"WorldEnd", WORLD, BARE, world_end},
    {"Material", WORLD, LIST, pbrt_material_set},
    {"MakeNamedMaterial", WORLD, LIST, pbrt_material_make},
    {"NamedMaterial", WORLD, NAME, pbrt_material_named},
    {"Texture", WORLD, TEXTURE, pbrt_colour_texture},
    {"AreaLightSource", WORLD, LIST, pbrt_light_area},
    {"LightSource", WORLD, LIST, pbrt_light_source},
    {"Shape", WORLD, LIST, pbrt_shape},
    {"ObjectBegin", WORLD, NAME, pbrt_object_begin},
    {"ObjectEnd", WORLD, BARE, pbrt_object_end},
    {"ObjectInstance", WORLD, NAME, pbrt_object_instance},
    {"MakeNamedMedium", ANYWHERE, LIST, medium},
    {"MediumInterface", ANYWHERE, NAME, medium_interface},
    /* LuxRender's. */
    {"Renderer", OPTIONS, LIST, pbrt_lux_nothing},
    {"SurfaceIntegrator", OPTIONS, LIST, pbrt_lux_integrator},
    {"VolumeIntegrator", OPTIONS, LIST, pbrt_lux_nothing},
    {"LightGroup", WORLD, NAME, pbrt_lux_nothing},
    {"MakeNamedVolume", WORLD, VOLUME, pbrt_lux_volume},
    {"Interior", WORLD, NAME, pbrt_lux_nothing},
    {"Exterior", WORLD, NAME, pbrt_lux_nothing},
    {"PortalShape", WORLD, LIST, pbrt_lux_nothing},
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

static bool run_directive(struct pbrt *p, const struct directive *d,
                          const struct place *at, struct err *err)
{
    static const int heads[] = {
        [BARE] = 0, [NAME] = 1, [LIST] = 1, [PARAMS] = 0, [TEXTURE] = 3, [VOLUME] = 2};
    bool with_list = d->syntax >= LIST;
    if (!check_scope(p, d, at, err) ||
        !pbrt_params_parse(&p->params, &p->lexer, heads[d->syntax], with_list, at, err))
        return false;
    pbrt_attribute_apply(p, d->name);
    if (!d->run(p, err))
        return false;
    note_second(p, d, at);
    pbrt_params_report(&p->params, d->name, &p->desc->log);
    return true;
}

/* Behind what is left of a directive in error; its words are values of bools, and further
 * numbers in error are not told. */
static bool skip_to_directive(struct pbrt *p, struct err *err)
{
    const struct pbrt_token *next;
    struct pbrt_token token;
    do {
        *err = (struct err){0};
        while (pbrt_lexer_peek(&p->lexer, &next, err)) {
            bool word = next->kind == PBRT_TOKEN_WORD &&
                        !text_equal(next->text, "true") &&
                        !text_equal(next->text, "false");
            if (word || next->kind == PBRT_TOKEN_END)
                return true;
            pbrt_lexer_next(&p->lexer, &token, err); /* what was peeked at */
        }
    } while (err->code == ERR_VALUE);
    return false;
}

/* Keeps the error and passes over the rest of the directive. Whether to go on. */
static bool go_on_after(struct pbrt *p, const struct err *failure)
{
    struct err unread = {0};
    return pbrt_failure_tell(p, failure) &&
           (skip_to_directive(p, &unread) || pbrt_failure_stop(p, &unread));
}

/* Whether to go on. */
static bool run_next(struct pbrt *p)
{
    struct pbrt_token token;
    struct err failure = {0};
    const struct directive *d = NULL;
    if (pbrt_lexer_next(&p->lexer, &token, &failure) &&
        (d = find_directive(&token, &failure)) != NULL &&
        run_directive(p, d, &token.place, &failure))
        return true;
    bool goes_on = go_on_after(p, &failure);
    pbrt_failure_mark(p, d ? d->name : NULL);
    return goes_on;
}

/* Runs what the lexer gives while it is at least that many files deep. */
static void run_while(struct pbrt *p, int depth)
{
    const struct pbrt_token *next;
    bool goes_on = true;
    while (goes_on) {
        struct err failure = {0};
        if (!pbrt_lexer_peek(&p->lexer, &next, &failure))
            goes_on = go_on_after(p, &failure);
        else
            goes_on = next->kind != PBRT_TOKEN_END && p->lexer.depth >= depth &&
                      run_next(p);
    }
}

/* Include, but for what it does to the graphics state, which is forgotten. */
static bool import(struct pbrt *p, struct err *err)
{
    struct place at = p->params.place;
    size_t depth = p->depth;
    pbrt_state_push(p, false, &at);
    if (!include(p, err)) {
        pbrt_state_pop(p, false, &at, err);
        return false;
    }
    run_while(p, p->lexer.depth);
    if (p->stopped)
        return false;
    if (p->depth != depth + 1)
        return err_set(err, ERR_SYNTAX, &at,
                       "the imported file closes a Begin that it did not open, or opens "
                       "one that it does not close");
    return pbrt_state_pop(p, false, &at, err);
}

static bool end_of_file(struct pbrt *p, struct err *err)
{
    struct pbrt_token end;
    if (!pbrt_lexer_next(&p->lexer, &end, err))
        return false;
    if (p->in_world && !pbrt_is_v4(p))
        return err_set(err, ERR_SYNTAX, &end.place,
                       "the file ends before the WorldEnd of the WorldBegin in line %d",
                       p->world_place.line);
    if (p->depth > 0)
        return err_set(err, ERR_SYNTAX, &p->stack[p->depth - 1].place,
                       "this Begin is still open at the end of the file");
    if (pbrt_is_v4(p) && !(p->shutter > 0.0))
        return err_set(
            err, ERR_VALUE, &p->desc->camera.place,
            "the shutter does not open: shutterclose is not after shutteropen");
    return p->in_world || p->world_done ||
           err_set(err, ERR_SYNTAX, &end.place, "the file has no WorldBegin");
}

static void note_absent(struct pbrt *p)
{
    if (pbrt_is_v4(p) && !p->has_filter)
        log_remark(&p->desc->log, &p->world_place,
                   "no PixelFilter before this: pbrt v4's gaussian is not used, "
                   "reconstruction is a box of one pixel, always");
    if (p->desc->camera.place.line == 0)
        log_note(
            &p->desc->log, &p->world_place,
            "no Camera before this: pbrt's own is taken, at the origin, with fov 90");
}

static bool run_file(struct pbrt *p)
{
    struct err failure = {0};
    run_while(p, 1);
    if (!p->stopped && !end_of_file(p, &failure))
        pbrt_failure_tell(p, &failure);
    if (!p->failed)
        note_absent(p);
    return !p->failed;
}

/* Defaults of pbrt v3. */
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

/* Applies the film's scale factor to all emission. */
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
    pbrt_state_init(&p, desc, options, err);
    set_defaults(&p);
    p.ahead = ahead_read(path, p.directory, "\"\n", &desc->textures, options);
    bool read = pbrt_lexer_init(&p.lexer, desc, path, err) && run_file(&p);
    pbrt_object_finish(&p);
    scale_emission(desc, p.film_scale * (pbrt_is_v4(&p) ? p.shutter : 1.0));
    ahead_destroy(p.ahead);
    pbrt_state_deinit(&p);
    return read ? desc : import_failure_give_up(options, desc);
}
