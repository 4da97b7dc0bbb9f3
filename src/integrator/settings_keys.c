/* The table of settings: how each is spelled, read and explained. */
#include "integrator/settings.h"

#include "base/mem.h"
#include "base/text.h"
#include "integrator/registry.h"

#include <stdio.h>
#include <string.h>

struct key;
typedef bool (*setting_reader)(const struct key *key, struct settings *s,
                               const char *value, const struct place *at,
                               struct err *err);

struct key {
    const char *name;
    setting_reader read;
    size_t offset;
    double min, max; /* numbers */
    const char *help;
};

#define AT(field) offsetof(struct settings, field)

static void *field(const struct key *key, struct settings *s)
{
    return (char *)s + key->offset;
}

static bool refuse(const struct key *key, const char *value, const struct place *at,
                   struct err *err)
{
    return err_set(err, ERR_USAGE, at, "%s: '%s' is not possible; give %s", key->name,
                   value, key->help);
}

static bool read_number(const struct key *key, struct settings *s, const char *value,
                        const struct place *at, struct err *err)
{
    double x;
    if (!text_to_double(value, &x) || !(x >= key->min && x <= key->max))
        return refuse(key, value, at, err);
    *(double *)field(key, s) = x;
    return true;
}

static bool read_count(const struct key *key, struct settings *s, const char *value,
                       const struct place *at, struct err *err)
{
    long x;
    if (!text_to_long(value, &x) || (double)x < key->min || (double)x > key->max)
        return refuse(key, value, at, err);
    *(long *)field(key, s) = x;
    return true;
}

static bool read_replicas(const struct key *key, struct settings *s, const char *value,
                          const struct place *at, struct err *err)
{
    if (text_equal(value, "1")) {
        s->replicas = 1;
        return true;
    }
    return read_count(key, s, value, at, err);
}

static bool read_flag(const struct key *key, struct settings *s, const char *value,
                      const struct place *at, struct err *err)
{
    bool yes = text_equal(value, "true");
    if (!yes && !text_equal(value, "false"))
        return refuse(key, value, at, err);
    *(bool *)field(key, s) = yes;
    return true;
}

static bool read_p_large(const struct key *key, struct settings *s, const char *value,
                         const struct place *at, struct err *err)
{
    if (text_equal(value, "auto")) {
        s->p_large = (double)NAN;
        return true;
    }
    return read_number(key, s, value, at, err);
}

static bool read_integrator(const struct key *key, struct settings *s, const char *value,
                            const struct place *at, struct err *err)
{
    const struct integrator_type *type = integrator_find(value);
    if (type == NULL)
        return refuse(key, value, at, err);
    s->integrator = type->name;
    return true;
}

static bool read_kernel(const struct key *key, struct settings *s, const char *value,
                        const struct place *at, struct err *err)
{
    const struct kernel_type *type = kernel_find(value);
    if (type == NULL)
        return refuse(key, value, at, err);
    s->kernel = type;
    return true;
}

static bool read_estimator(const struct key *key, struct settings *s, const char *value,
                           const struct place *at, struct err *err)
{
    bool kelemen = text_equal(value, "kelemen");
    if (!kelemen && !text_equal(value, "plain"))
        return refuse(key, value, at, err);
    s->estimator = kelemen ? ESTIMATOR_KELEMEN : ESTIMATOR_PLAIN;
    s->estimator_given = true;
    return true;
}

static bool read_builder(const struct key *key, struct settings *s, const char *value,
                         const struct place *at, struct err *err)
{
    bool pt = text_equal(value, "pt");
    if (!pt && !text_equal(value, "bdpt"))
        return refuse(key, value, at, err);
    s->builder = pt ? "pt" : "bdpt";
    return true;
}

static bool read_rule(const struct key *key, struct settings *s, const char *value,
                      const struct place *at, struct err *err)
{
    if (!text_equal(value, "zsolnai2013"))
        return refuse(key, value, at, err);
    s->rule = "zsolnai2013";
    return true;
}

static bool read_per(const struct key *key, struct settings *s, const char *value,
                     const struct place *at, struct err *err)
{
    bool per_length = text_equal(value, "length");
    if (!per_length && !text_equal(value, "all"))
        return refuse(key, value, at, err);
    s->per_length = per_length;
    return true;
}

static bool read_allocation(const struct key *key, struct settings *s, const char *value,
                            const struct place *at, struct err *err)
{
    bool by_brightness = text_equal(value, "brightness");
    if (!by_brightness && !text_equal(value, "error"))
        return refuse(key, value, at, err);
    s->by_brightness = by_brightness;
    return true;
}

static bool read_direct(const struct key *key, struct settings *s, const char *value,
                        const struct place *at, struct err *err)
{
    bool separate = text_equal(value, "separate");
    if (!separate && !text_equal(value, "joint"))
        return refuse(key, value, at, err);
    s->direct = separate ? DIRECT_SEPARATE : DIRECT_JOINT;
    return true;
}

static bool read_mode(const struct key *key, struct settings *s, const char *value,
                      const struct place *at, struct err *err)
{
    static const char *const modes[] = {"exact", "counted", "paper"};
    for (int i = 0; i < 3; i++)
        if (text_equal(modes[i], value)) {
            s->mode = modes[i];
            return true;
        }
    return refuse(key, value, at, err);
}

static bool read_compact(const struct key *key, struct settings *s, const char *value,
                         const struct place *at, struct err *err)
{
    bool yes = text_equal(value, "true"), no = text_equal(value, "false");
    if (!yes && !no && !text_equal(value, "auto"))
        return refuse(key, value, at, err);
    s->compact = yes ? ACCEL_COMPACT : no ? ACCEL_FULL : ACCEL_AUTO;
    return true;
}

static bool read_size(const struct key *key, struct settings *s, const char *value,
                      const struct place *at, struct err *err)
{
    int width = 0, height = 0, end = 0;
    if (strspn(value, "0123456789x") != strlen(value) ||
        sscanf(value, "%6dx%6d%n", &width, &height, &end) != 2 ||
        (size_t)end != strlen(value) || width < 1 || height < 1 || width > 65536 ||
        height > 65536)
        return refuse(key, value, at, err);
    s->width = width;
    s->height = height;
    return true;
}

/* max_depth -1 is Mitsuba's "no limit". */
static bool read_depth(const struct key *key, struct settings *s, const char *value,
                       const struct place *at, struct err *err)
{
    long depth;
    if (!text_to_long(value, &depth) || depth == 0 || depth < -1 ||
        depth > SETTINGS_MAX_DEPTH)
        return refuse(key, value, at, err);
    s->max_depth = depth < 0 ? SETTINGS_MAX_DEPTH : depth;
    return true;
}

/* The last budget given counts: setting one kind clears the other. */
static bool read_budget(const struct key *key, struct settings *s, const char *value,
                        const struct place *at, struct err *err)
{
    static const char seconds[] = "seconds=", mutations[] = "mutations_per_pixel=";
    const char *name = key->name;
    if (strncmp(value, seconds, sizeof seconds - 1) == 0)
        return settings_set(s, "seconds", value + sizeof seconds - 1, at, err);
    if (strncmp(value, mutations, sizeof mutations - 1) == 0)
        return settings_set(s, "mutations_per_pixel", value + sizeof mutations - 1, at,
                            err);
    if (text_equal(name, "budget") || !read_number(key, s, value, at, err))
        return refuse(key, value, at, err);
    *(key->offset == AT(seconds) ? &s->mutations_per_pixel : &s->seconds) = 0.0;
    return true;
}

static const struct key keys[] = {
    {"integrator", read_integrator, 0, 0, 0,
     "pssmlt, mmlt, pfmlt, bdpt or pt (default pssmlt)"},
    {"large_step_probability", read_p_large, AT(p_large), 0, 1,
     "auto or a number in (0,1] (default auto)"},
    {"allow_zero", read_flag, AT(allow_zero), 0, 0,
     "true or false: large_step_probability 0 is let through (default false)"},
    {"rule", read_rule, 0, 0, 0, "zsolnai2013"},
    {"per", read_per, 0, 0, 0,
     "all or length: one p_l for all path lengths of mmlt and pfmlt, or one for each "
     "(default all)"},
    {"allocation", read_allocation, 0, 0, 0,
     "error or brightness: what mmlt and pfmlt share out their chains among the path "
     "lengths by, least relative error or brightness (default error)"},
    {"direct", read_direct, 0, 0, 0,
     "separate or joint: plain samples for path lengths 1 and 2 of mmlt and pfmlt, or "
     "chains as for all others (default separate, with 8 mutations per pixel or more)"},
    {"mode", read_mode, 0, 0, 0,
     "exact, counted or paper: what pfmlt does about failed proposals (default exact)"},
    {"kernel", read_kernel, 0, 0, 0,
     "exponential or gaussian (default exponential, for pfmlt gaussian)"},
    {"sigma", read_number, AT(sigma), 1e-9, 1, "a number in [1e-9,1] (default 0.01)"},
    {"s1", read_number, AT(s1), 1e-12, 1, "a number in [1e-12,1] (default 1/1024)"},
    {"s2", read_number, AT(s2), 1e-12, 1, "a number in [1e-12,1] (default 1/64)"},
    {"estimator", read_estimator, 0, 0, 0,
     "kelemen or plain (default kelemen; pfmlt in mode paper has plain alone)"},
    {"builder", read_builder, 0, 0, 0, "bdpt or pt: the paths of pssmlt (default bdpt)"},
    {"chains", read_count, AT(chains), 1, 1e6, "a count in [1,1e6] (default 256)"},
    {"bootstrap", read_count, AT(bootstrap), 1, 1e9,
     "a count of paths in [1,1e9] (default 100000)"},
    {"start", read_number, AT(start), 0, 1,
     "a number in [0,1]: share of the budget (default 0.02)"},
    {"start_cap", read_number, AT(start_cap), 0, 1,
     "a number in [0,1]: share of the budget (default 0.2)"},
    {"start_mutations", read_count, AT(start_mutations), 1, 1e9,
     "a count in [1,1e9]: mutations a chain, at least (default 64)"},
    {"max_depth", read_depth, 0, 0, 0, "edges in [1,64], or -1 for 64"},
    {"budget", read_budget, 0, 0, 0, "seconds=S or mutations_per_pixel=N"},
    {"seconds", read_budget, AT(seconds), 1e-3, 1e9, "a number of seconds in [1e-3,1e9]"},
    {"mutations_per_pixel", read_budget, AT(mutations_per_pixel), 1e-6, 1e12,
     "a number in [1e-6,1e12] (default 64)"},
    {"until_converged", read_flag, AT(until_converged), 0, 0,
     "true or false: the run ends before its budget once its verdict is \"converged\", "
     "at "
     "two looks in succession (default false)"},
    {"until_relmse", read_number, AT(until_relmse), 0, 1e6,
     "a number in [0,1e6]: the run ends before its budget once relMSE is below it by its "
     "own error bars; 0 is never (default 0)"},
    {"size", read_size, 0, 0, 0, "WIDTHxHEIGHT in pixels, each in [1,65536]"},
    {"keep_all", read_flag, AT(keep_all), 0, 0, "true or false (default false)"},
    {"seed", read_count, AT(seed), 0, 9e15, "a whole number in [0,9e15] (default 1)"},
    {"threads", read_count, AT(threads), 0, 1024,
     "a count in [0,1024]; 0 = all (default 0)"},
    {"replicas", read_replicas, AT(replicas), 4, 64,
     "a count in [4,64], or 1: independent parts of a run, for error bars and the "
     "verdict; 1 does without (default 8)"},
    {"compact", read_compact, 0, 0, 0,
     "auto, true or false: a BVH that takes less memory; hits may differ in last bits "
     "(default auto: if memory is short)"},
};

#define KEY_COUNT ((int)(sizeof keys / sizeof keys[0]))

static bool unknown_key(const char *name, const struct place *at, struct err *err)
{
    const char *names[KEY_COUNT + 1] = {NULL};
    struct text list = {0};
    for (int i = 0; i < KEY_COUNT; i++) {
        names[i] = keys[i].name;
        text_append(&list, "%s%s", i ? ", " : "", keys[i].name);
    }
    const char *near = text_nearest(name, names);
    err_set(err, ERR_USAGE, at, "unknown setting '%s'%s%s%s; settings are: %s", name,
            near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "",
            list.data);
    mem_free(list.data);
    return false;
}

bool settings_set(struct settings *settings, const char *name, const char *value,
                  const struct place *at, struct err *err)
{
    for (int i = 0; i < KEY_COUNT; i++)
        if (text_equal(keys[i].name, name))
            return keys[i].read(&keys[i], settings, value, at, err);
    return unknown_key(name, at, err);
}

bool settings_help(int index, const char **name, const char **help)
{
    if (index < 0 || index >= KEY_COUNT)
        return false;
    *name = keys[index].name;
    *help = keys[index].help;
    return true;
}
