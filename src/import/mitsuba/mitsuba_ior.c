#include "import/mitsuba/mitsuba_ior.h"

#include "base/text.h"
#include "import/mitsuba/mitsuba_metal.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/mitsuba/mitsuba_texture.h"
#include "import/suggest.h"

#define ETA_AIR 1.000277

/* Refractive indices at the sodium line, as Mitsuba names the stuffs. */
static const struct {
    const char *name;
    double eta;
} stuffs[] = {
    {"vacuum", 1.0},
    {"helium", 1.000036},
    {"hydrogen", 1.000132},
    {"air", ETA_AIR},
    {"carbon dioxide", 1.00045},
    {"water", 1.333},
    {"acetone", 1.36},
    {"ethanol", 1.361},
    {"carbon tetrachloride", 1.461},
    {"glycerol", 1.4729},
    {"benzene", 1.501},
    {"silicone oil", 1.52045},
    {"bromine", 1.661},
    {"water ice", 1.31},
    {"fused quartz", 1.458},
    {"pyrex", 1.47},
    {"acrylic glass", 1.49},
    {"polypropylene", MITSUBA_IOR_POLYPROPYLENE},
    {"bk7", MITSUBA_IOR_BK7},
    {"sodium chloride", 1.544},
    {"amber", 1.55},
    {"pet", 1.575},
    {"diamond", 2.419},
};

#define STUFFS (sizeof stuffs / sizeof stuffs[0])

static bool read_named(const char *name, const struct mitsuba_node *node, double *eta,
                       struct err *err)
{
    const char *known[STUFFS + 1] = {0};
    for (size_t i = 0; i < STUFFS; i++) {
        known[i] = stuffs[i].name;
        if (text_equal(name, stuffs[i].name)) {
            *eta = stuffs[i].eta;
            return true;
        }
    }
    return suggest_fail(err, &node->place, "index of refraction", name, known);
}

/* A number or the name of a stuff. */
static bool read_index(struct mitsuba_node *object, const char *name, double *eta,
                       struct err *err)
{
    const struct mitsuba_node *node = mitsuba_property(object, name);
    const char *text = "";
    if (!node || !text_equal(node->name, "string"))
        return mitsuba_float(object, name, eta, err);
    return mitsuba_string(object, name, &text, err) && read_named(text, node, eta, err);
}

bool mitsuba_ior_ratio(struct mitsuba_node *object, double inside, double *eta,
                       struct err *err)
{
    double outside = ETA_AIR;
    if (!read_index(object, "int_ior", &inside, err) ||
        !read_index(object, "ext_ior", &outside, err))
        return false;
    if (!(inside > 0.0 && outside > 0.0))
        return err_set(err, ERR_VALUE, &object->place,
                       "an index of refraction is not positive");
    *eta = inside / outside;
    return true;
}

static void named_metal(struct mitsuba *m, const struct mitsuba_node *object,
                        const char *name, struct rgb *eta, struct rgb *k)
{
    if (mitsuba_metal_find(name, eta, k))
        return;
    const char *nearest = mitsuba_metal_nearest(name);
    log_note(&m->desc->log, &object->place, "unknown metal \"%s\"%s%s%s: taken as copper",
             name, nearest ? "; did you mean \"" : "", nearest ? nearest : "",
             nearest ? "\"?" : "");
    mitsuba_metal_find("Cu", eta, k);
}

bool mitsuba_ior_metal(struct mitsuba *m, struct mitsuba_node *object, struct rgb *eta,
                       struct rgb *k, bool *perfect, struct err *err)
{
    bool given = mitsuba_property(object, "eta") || mitsuba_property(object, "k");
    const char *name = m->old ? "Cu" : "none";
    double outside = m->old ? ETA_AIR : 1.0; /* Mitsuba 3 knows no outside of metals */
    if (!mitsuba_string(object, "material", &name, err) ||
        !read_index(object, "ext_eta", &outside, err))
        return false;
    *perfect = !given && text_equal(name, "none");
    if (!(outside > 0.0))
        return err_set(err, ERR_VALUE, &object->place, "ext_eta is not positive");
    if (*perfect)
        return true;
    named_metal(m, object, given ? "Cu" : name, eta, k);
    if (!mitsuba_colour(m, object, "eta", eta, err) ||
        !mitsuba_colour(m, object, "k", k, err))
        return false;
    *eta = rgb_scale(*eta, 1.0 / outside);
    *k = rgb_scale(*k, 1.0 / outside);
    return true;
}
