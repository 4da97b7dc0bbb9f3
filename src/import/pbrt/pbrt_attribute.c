/* v4's directives that set something for what follows: Option and Attribute. */
#include "import/pbrt/pbrt_scene.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/suggest.h"

/* The directives that an Attribute of that target serves. */
static const struct {
    const char *target, *directive;
} served[] = {
    {"shape", "Shape"},
    {"light", "LightSource"},
    {"light", "AreaLightSource"},
    {"material", "Material"},
    {"material", "MakeNamedMaterial"},
    {"medium", "MakeNamedMedium"},
    {"texture", "Texture"},
};

#define SERVED (sizeof served / sizeof served[0])

bool pbrt_attribute(struct pbrt *p, struct err *err)
{
    const char *known[SERVED + 1] = {0}, *name = pbrt_params_head(&p->params, 0);
    p->version = PBRT_V4;
    for (size_t i = 0; i < SERVED; i++) {
        known[i] = served[i].target;
        if (!text_equal(name, served[i].target))
            continue;
        size_t count = p->attribute_count++;
        p->attributes = mem_grow(p->attributes, &p->attribute_capacity, count + 1,
                                 sizeof *p->attributes);
        p->attributes[count] = (struct pbrt_attribute){.target = served[i].target};
        pbrt_params_append(&p->attributes[count].params, &p->params);
        p->attributes[count].params.own = p->attributes[count].params.count;
        return pbrt_ignored(p, err);
    }
    return suggest_fail(err, &p->params.head_places[0], "kind of Attribute", name, known);
}

void pbrt_attribute_apply(struct pbrt *p, const char *directive)
{
    for (size_t s = 0; s < SERVED; s++)
        for (size_t i = 0; i < p->attribute_count; i++)
            if (text_equal(directive, served[s].directive) &&
                text_equal(p->attributes[i].target, served[s].target))
                pbrt_params_append(&p->params, &p->attributes[i].params);
}

/* What changes no expected value is passed over, the rest is counted. */
static const struct {
    const char *name, *note;
} options[] = {
    {"disablepixeljitter", "light is gathered over whole pixels, always"},
    {"disabletexturefiltering", NULL},
    {"disablewavelengthjitter", NULL},
    {"displacementedgescale", NULL},
    {"forcediffuse", "all materials stay as they are"},
    {"msereferenceimage", NULL},
    {"msereferenceout", NULL},
    {"pixelstats", NULL},
    {"rendercoordsys", NULL},
    {"seed", NULL},
    {"wavefront", NULL},
};

#define OPTIONS (sizeof options / sizeof options[0])

static bool is_off(const struct pbrt_params *params, const struct pbrt_param *param)
{
    return param->type == PBRT_BOOL && param->count == 1 &&
           pbrt_params_numbers(params, param)[0] == 0.0;
}

bool pbrt_option(struct pbrt *p, struct err *err)
{
    const char *known[OPTIONS + 1] = {0};
    p->version = PBRT_V4;
    if (p->params.count != 1)
        return err_set(err, ERR_SYNTAX, &p->params.place,
                       "Option wants one parameter, there are %zu", p->params.count);
    const struct pbrt_param *param = &p->params.list[0];
    const char *name = pbrt_params_name(&p->params, param);
    for (size_t i = 0; i < OPTIONS; i++) {
        known[i] = options[i].name;
        if (!text_equal(name, options[i].name))
            continue;
        if (options[i].note && !is_off(&p->params, param))
            log_note(&p->desc->log, &param->place, "the option \"%s\" is not used: %s",
                     name, options[i].note);
        return pbrt_ignored(p, err);
    }
    return suggest_fail(err, &param->place, "option", name, known);
}
