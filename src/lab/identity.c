#include "lab/identity.h"

#include "build_info.h"
#include "lab/fingerprint.h"
#include "scene/accel.h"

static void add_program(struct identity *identity, const struct scene *scene)
{
    identity_add(identity, "commit", "%s", BUILD_COMMIT);
    identity_add(identity, "compiler", "%s", BUILD_COMPILER);
    identity_add(identity, "flags", "%s", BUILD_FLAGS);
    identity_add(identity, "rays", "%s", accel_description(scene->accel));
}

static void add_number(struct identity *identity, const char *name, double value)
{
    identity_add(identity, name, "%.17g", value);
}

static void add_kernel(struct identity *identity, const struct settings *s)
{
    struct kernel kernel;
    kernel_init(&kernel, settings_kernel(s), s->sigma, s->s1, s->s2);
    identity_add(identity, "kernel", "%s", kernel.type->name);
    add_number(identity, "sigma", kernel.sigma);
    add_number(identity, "s1", kernel.s1);
    add_number(identity, "s2", kernel.s2);
}

static void add_large_steps(struct identity *identity, const struct settings *s)
{
    if (settings_auto(s))
        identity_add(identity, "large_step_probability", "auto");
    else
        add_number(identity, "large_step_probability", s->p_large);
    identity_add(identity, "rule", "%s", s->rule);
    identity_add(identity, "per", "%s", s->per_length ? "length" : "all");
    add_number(identity, "start", s->start);
    add_number(identity, "start_cap", s->start_cap);
    identity_add(identity, "start_mutations", "%ld", s->start_mutations);
}

/* Elsewhere `direct` does nothing, and as it follows from the budget unless it is given,
 * it would bind a run to that. */
static bool has_direct(const struct settings *s)
{
    return text_equal(s->integrator, "mmlt") || text_equal(s->integrator, "pfmlt");
}

static void add_settings(struct identity *identity, const struct settings *s,
                         const struct scene *scene)
{
    int depth = settings_depth(s, scene);
    bool kelemen = settings_estimator(s) == ESTIMATOR_KELEMEN;
    bool separate = has_direct(s) && settings_plain_lengths(s, depth) > 0;
    identity_add(identity, "integrator", "%s", s->integrator);
    identity_add(identity, "mode", "%s", s->mode);
    identity_add(identity, "builder", "%s", s->builder);
    identity_add(identity, "estimator", "%s", kelemen ? "kelemen" : "plain");
    identity_add(identity, "direct", "%s",
                 !has_direct(s) ? ""
                 : separate     ? "separate"
                                : "joint");
    identity_add(identity, "allocation", "%s", s->by_brightness ? "brightness" : "error");
    identity_add(identity, "chains", "%ld", s->chains);
    identity_add(identity, "bootstrap", "%ld", s->bootstrap);
    identity_add(identity, "max_depth", "%d", depth);
    identity_add(identity, "size", "%dx%d", scene->camera.width, scene->camera.height);
    identity_add(identity, "compact", "%s",
                 accel_is_compact(scene->accel) ? "true" : "false");
    identity_add(identity, "keep_all", "%s", s->keep_all ? "true" : "false");
    identity_add(identity, "seed", "%ld", s->seed);
    identity_add(identity, "replicas", "%ld", s->replicas);
    add_kernel(identity, s);
    add_large_steps(identity, s);
}

static void add_hash(struct identity *identity, const char *name, const struct hash *hash)
{
    char digits[HASH_DIGITS + 1];
    hash_digits(hash, digits);
    identity_add(identity, name, "%s", digits);
}

bool identity_init(struct identity *identity, const char *scene_path,
                   const struct scene *scene, const struct settings *settings,
                   const char *reference, struct err *err)
{
    struct hash hash;
    *identity = (struct identity){0};
    add_program(identity, scene);
    if (!fingerprint_scene(scene_path, NULL, &hash, err))
        return false;
    add_hash(identity, "content of the scene", &hash);
    add_settings(identity, settings, scene);
    if (reference == NULL) {
        identity_add(identity, "reference of the error log", "none");
        return true;
    }
    hash_init(&hash);
    if (!fingerprint_file(reference, NULL, &hash, err))
        return false;
    add_hash(identity, "reference of the error log", &hash);
    return true;
}
