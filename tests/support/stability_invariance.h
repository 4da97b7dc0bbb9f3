#ifndef ETALON_TESTS_SUPPORT_STABILITY_INVARIANCE_H
#define ETALON_TESTS_SUPPORT_STABILITY_INVARIANCE_H

/* What must not change by a bit: emission times 2^k, and a scene 2^k as large. Every
 * decision of every chain is then the same, so that all statistics and pixels are. */

#include "support/stability_room.h"

/* A room with lights of each kind, smooth and rough glass, metal and a lens. */
static inline struct scene *stability_invariant(double emission, double scale)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 4);
    struct rgb dark = rgb_grey(0.0);
    test_room(desc);
    test_lamp(desc, 0.35, rgb(12.0 * emission, 10.0 * emission, 8.0 * emission));
    int glass = stability_glass(desc, "dielectric", 1.5);
    int frosted = stability_glass(desc, "roughdielectric", 1.3);
    test_sphere(desc, vec3(-0.45f, 0.45f, -0.3f), 0.4, glass, dark, false);
    test_sphere(desc, vec3(0.45f, 0.4f, 0.25f), 0.35, frosted, dark, false);
    test_sphere(desc, vec3(0.5f, 1.5f, -0.5f), 0.1, stability_black(desc),
                rgb_grey(3.0 * emission), false);
    int metal = test_material(desc, "roughconductor", NULL, dark, "alpha", 0.2);
    test_sphere(desc, vec3(-0.4f, 1.2f, -0.4f), 0.2, metal, dark, false);
    test_point_light(desc, vec3(-0.6f, 1.6f, 0.6f), rgb_grey(0.5 * emission));
    struct light_desc sun = test_beam(&light_distant, vec3(0.5f, 2.5f, 3),
                                      vec3(0, 0.6f, -0.4f), rgb_grey(emission));
    struct light_desc spot = test_beam(&light_spot, vec3(-0.3f, 1.7f, 0.6f),
                                       vec3(0.5f, 0.2f, -0.2f), rgb_grey(emission));
    scene_desc_add_light(desc, &sun);
    scene_desc_add_light(desc, &spot);
    test_sky(desc, 0.25 * emission);
    desc->camera.lens_radius = 0.0625 * scale;
    desc->camera.focus_distance = 4.5 * scale;
    stability_scale(desc, scale);
    return test_build(desc, false);
}

static inline struct run_result stability_replay(const struct stability_setup *setup,
                                                 double emission, double scale)
{
    const struct stability_sweep small = {.depth = 5};
    struct settings settings = stability_settings(&small, 0.0, setup, 0.5);
    struct scene *scene = stability_invariant(emission, scale);
    struct run_result result = test_run(scene, &settings);
    scene_destroy(scene);
    return result;
}

static inline bool stability_same_bits(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* NULL, or what differs. */
static inline const char *stability_difference(const struct run_result *a,
                                               const struct run_result *b, double factor)
{
    const struct run_statistics *x = &a->statistics, *y = &b->statistics;
    if (!(x->b > 0.0))
        return "b is 0";
    if (memcmp(&x->start, &y->start, sizeof x->start) != 0 ||
        memcmp(&x->whole, &y->whole, sizeof x->whole) != 0)
        return "eta_s, eta_l or eta_0 differ";
    if (!stability_same_bits(x->acceptance, y->acceptance) ||
        !stability_same_bits(x->plarge.p_l, y->plarge.p_l))
        return "acceptance or p_l differ";
    if (memcmp(&x->counters, &y->counters, sizeof x->counters) != 0)
        return "counters differ";
    if (x->b * factor != y->b || !stability_same_bits(x->b_se * factor, y->b_se))
        return "b differs";
    for (int i = 0; i < 3 * STABILITY_FILM * STABILITY_FILM; i++)
        if (a->image->pixels[i] * (float)factor != b->image->pixels[i])
            return "a pixel differs";
    return NULL;
}

/* All powers from -x to x. */
static const struct stability_sweep stability_emission_bits = {
    .category = "invariance", .name = "emission 2^-x to 2^x", .x = {100}};
static const struct stability_sweep stability_scale_bits = {
    .category = "invariance", .name = "scale 2^-x to 2^x", .x = {20}};

/* Every `stride`-th power of the sweep for one setup, from its ends inward. */
static inline struct stability_row
stability_invariance(const struct stability_sweep *sweep,
                     const struct stability_setup *setup, int stride)
{
    bool scales = sweep == &stability_scale_bits;
    int most = (int)sweep->x[0];
    struct run_result one = stability_replay(setup, 1.0, 1.0);
    struct stability_row row = {.of = sweep,
                                .x = most,
                                .setup = setup->name,
                                .p = 1.0,
                                .value = one.statistics.b};
    row.reference = row.value;
    for (int k = most; k >= -most; k -= stride) {
        double factor = exp2(k);
        struct run_result other = stability_replay(setup, scales ? 1.0 : factor,
                                                   scales ? factor : 1.0);
        const char *what = stability_difference(&one, &other, scales ? 1.0 : factor);
        if (what) {
            char text[80];
            snprintf(text, sizeof text, "2^%d: %s", k, what);
            stability_note(&row, FAILED, text);
        }
        run_result_deinit(&other);
    }
    run_result_deinit(&one);
    return row;
}

#endif
