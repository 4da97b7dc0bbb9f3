#include "import/mitsuba/mitsuba_scene.h"

#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"

#include <stdio.h>

/* max_depth as edges, which some count from another end. */
static bool take_depth(struct mitsuba *m, const struct mitsuba_node *object, int depth,
                       int more, struct err *err)
{
    if (depth < -1 || depth == 0 || depth > 100000)
        return err_set(err, ERR_VALUE, &object->place,
                       "max_depth %d is out of range: at least 1, or -1 for no limit",
                       depth);
    int edges = depth < 0 ? MITSUBA_DEPTH_MAX : depth + more;
    if (edges > MITSUBA_DEPTH_MAX)
        log_note(&m->desc->log, &object->place, "max_depth %d is taken as %d", depth,
                 MITSUBA_DEPTH_MAX);
    m->desc->max_depth = edges > MITSUBA_DEPTH_MAX ? MITSUBA_DEPTH_MAX : edges;
    return true;
}

/* A large-step probability, which is ours where the command line gives none. */
static bool read_large_step(struct mitsuba *m, struct mitsuba_node *object,
                            const char *name, struct err *err)
{
    double probability = -1.0;
    char text[32];
    const struct mitsuba_node *node = mitsuba_property(object, name);
    if (!node)
        return true;
    if (!mitsuba_float(object, name, &probability, err))
        return false;
    if (!(probability > 0.0 && probability <= 1.0))
        return err_set(err, ERR_VALUE, &node->place,
                       "the large-step probability %g is not in (0,1]", probability);
    snprintf(text, sizeof text, "%.9g", probability);
    scene_desc_add_setting(m->desc, "large_step_probability", text, &node->place);
    return true;
}

static bool read_depth(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    static const char *const known[] = {
        "path",   "bdpt", "volpath",  "volpath_simple", "volpathmis", "mlt",
        "pssmlt", "erpt", "ptracer",  "photonmapper",   "ppm",        "sppm",
        "vpl",    "aov",  "adaptive", "irrcache",       "moment",     NULL};
    /* How Mitsuba samples; what it computes is the same. */
    static const char *const ignored[] = {"rr_depth",
                                          "strict_normals",
                                          "samples_per_pass",
                                          "block_size",
                                          "timeout",
                                          "shading_samples",
                                          "emitter_samples",
                                          "bsdf_samples",
                                          "light_image",
                                          "sample_direct",
                                          "direct_samples",
                                          "glossy_samples",
                                          "global_photons",
                                          "caustic_photons",
                                          "volume_photons",
                                          "global_lookup_radius",
                                          "caustic_lookup_radius",
                                          "lookup_size",
                                          "granularity",
                                          "photon_count",
                                          "initial_radius",
                                          "alpha",
                                          "max_passes",
                                          "bidirectional",
                                          "luminance_samples",
                                          "two_stage",
                                          "bidirectional_mutation",
                                          "lens_perturbation",
                                          "multi_chain_perturbation",
                                          "caustic_perturbation",
                                          "manifold_perturbation",
                                          "lambda",
                                          "num_chains",
                                          "max_chains",
                                          "chain_length",
                                          "brute_force",
                                          "shadow_map_resolution",
                                          NULL};
    static const char *const partial[] = {"direct", "ao", NULL};
    const char *type = mitsuba_type(object);
    int depth = mitsuba_one_of(type, partial) ? 2 : -1;
    if (mitsuba_one_of(type, partial))
        log_note(&m->desc->log, &object->place,
                 "integrator \"%s\" is taken as a depth limit of 2", type);
    else if (!mitsuba_one_of(type, known))
        mitsuba_unknown(m, object, known, "its depth limit is used, the rest is not");
    if (!mitsuba_integer(object, "max_depth", &depth, err))
        return false;
    mitsuba_ignore(object, ignored);
    if (!take_depth(m, object, depth, 0, err) ||
        !read_large_step(m, object, "p_large", err))
        return false;
    mitsuba_report(m, object);
    return true;
}

/* Some integrators hold another that does the work. */
bool mitsuba_integrator(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    struct mitsuba_node *inner;
    if (!mitsuba_boolean(object, "hide_emitters", &m->desc->hide_emitters, err) ||
        !mitsuba_enter(m, object, err))
        return false;
    bool read = mitsuba_child(m, object, "integrator", &inner, err) &&
                (inner ? mitsuba_integrator(m, inner, err) : read_depth(m, object, err));
    mitsuba_leave(m, object);
    return read;
}

/* Dialects have elements of their own for what an integrator says; `more`: what their
 * depth lacks of edges. */
static const struct {
    const char *element;
    int more;
} dialects[] = {{"dpt", 1}};

bool mitsuba_dialect(struct mitsuba *m, struct mitsuba_node *object, bool *read,
                     struct err *err)
{
    int depth = -1, more = 0;
    *read = mitsuba_property(object, "max_depth") != NULL;
    if (!*read)
        return true;
    for (size_t i = 0; i < sizeof dialects / sizeof dialects[0]; i++)
        if (text_equal(object->name, dialects[i].element))
            more = dialects[i].more;
    if (!mitsuba_integer(object, "max_depth", &depth, err) ||
        !take_depth(m, object, depth, more, err) ||
        !read_large_step(m, object, "largestepprob", err))
        return false;
    log_remark(&m->desc->log, &object->place,
               "of <%s> only the depth, %d edges, and a large-step probability are read",
               object->name, m->desc->max_depth);
    return true;
}
