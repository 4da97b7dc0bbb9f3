/* Rays that leave a surface must not find it again, whatever its size and place, and must
 * still find what is near. One shape per triangle, so that a second hit of the same flat
 * (or, outward, convex) shape is an error beyond doubt. */

#include "math/rng.h"
#include "math/warp.h"
#include "support/instance_scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static const double scales[] = {1e-6, 1e-3, 1.0, 1e3, 1e6};
static const double shifts[] = {0.0, 1.0, 1e3, 1e6}; /* in units of the scale */

static struct vec3 random_direction(struct rng *rng)
{
    double u[2] = {rng_double(rng), rng_double(rng)};
    return warp_sphere(u);
}

/* A direction that leaves n's side at a grazing angle, down to 10^-powers rad. */
static struct vec3 grazing_down_to(struct rng *rng, struct vec3 n, double powers)
{
    struct frame f = frame_from_normal(n);
    double phi = 2.0 * MATH_PI * rng_double(rng);
    double z = pow(10.0, -powers * rng_double(rng));
    double r = sqrt(fmax(0.0, 1.0 - z * z));
    return frame_to_world(&f,
                          vec3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z));
}

static struct vec3 grazing(struct rng *rng, struct vec3 n)
{
    return grazing_down_to(rng, n, 5.0);
}

/* Triangles of all shapes down to a height of `thin` edges, in a cube of size `scale`. */
static struct scene *soup(struct rng *rng, double scale, double shift, double thin)
{
    struct scene_desc *desc = fixture_desc();
    fixture_point_light(desc);
    for (int i = 0; i < 64; i++) {
        double at[3], e1[3], e2[3], size = scale * pow(10.0, -2.0 * rng_double(rng));
        double skew = pow(thin, rng_double(rng));
        float p[9];
        for (int k = 0; k < 3; k++) {
            at[k] = scale * (rng_double(rng) + shift);
            e1[k] = size * (2.0 * rng_double(rng) - 1.0);
            e2[k] = rng_double(rng) * e1[k] + skew * size * (2.0 * rng_double(rng) - 1.0);
            p[k] = (float)at[k];
            p[k + 3] = (float)(at[k] + e1[k]);
            p[k + 6] = (float)(at[k] + e2[k]);
        }
        fixture_triangle(desc, p);
    }
    return fixture_build(desc);
}

static struct ray_endpoint random_start(struct rng *rng, const struct scene *scene,
                                        struct vec3 *w)
{
    struct vec3 lo = scene->bounds_min, hi = scene->bounds_max;
    struct vec3 p = {lo.x + (hi.x - lo.x) * (float)rng_double(rng),
                     lo.y + (hi.y - lo.y) * (float)rng_double(rng),
                     lo.z + (hi.z - lo.z) * (float)rng_double(rng)};
    *w = random_direction(rng);
    return (struct ray_endpoint){.p = p};
}

struct tally {
    long rays, self_hits;
};

static void count_self_hits(struct rng *rng, const struct scene *scene, int starts,
                            double powers, struct tally *tally)
{
    for (int i = 0; i < starts; i++) {
        struct vec3 w;
        struct ray_endpoint start = random_start(rng, scene, &w);
        struct hit hit, again;
        if (!accel_intersect(scene, &start, w, &hit))
            continue;
        for (int k = 0; k < 8; k++) {
            struct vec3 n = k & 1 ? hit.at.ng : vec3_neg(hit.at.ng);
            struct vec3 out = k & 2 ? grazing_down_to(rng, n, powers)
                                    : random_direction(rng);
            tally->rays++;
            if (accel_intersect(scene, &hit.at, out, &again) && again.shape == hit.shape)
                tally->self_hits++;
        }
    }
}

static void no_self_hits_of_triangles(void **state)
{
    (void)state;
    static const double thin[] = {1e-1, 1e-3};
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (size_t t = 0; t < 2; t++)
        for (size_t i = 0; i < 5; i++)
            for (size_t j = 0; j < 4; j++) {
                struct tally tally = {0};
                for (int k = 0; k < 4; k++) {
                    struct scene *scene = soup(&rng, scales[i], shifts[j], thin[t]);
                    count_self_hits(&rng, scene, 2000, 5.0, &tally);
                    scene_destroy(scene);
                }
                if (getenv("ETALON_LONG") || tally.self_hits)
                    printf("thin %g scale %g shift %g: %ld of %ld\n", thin[t], scales[i],
                           shifts[j], tally.self_hits, tally.rays);
                assert_int_equal(tally.self_hits, 0);
            }
}

static struct xform place_at(double scale, double shift)
{
    struct xform grow = xform_scale(scale, scale, scale);
    struct xform turn = xform_rotate(33.0, 1.0, 2.0, 3.0);
    struct xform move = xform_translate(scale * shift, 0.7 * scale * shift,
                                        -0.3 * scale * shift);
    struct xform both = xform_mul(&grow, &turn);
    return xform_mul(&move, &both);
}

/* Outward of a sphere, cylinder (from outside) and both sides of a disk: nothing is hit.
 * Into the sphere: it is hit again, at the other end of the chord. */
static void quadrics_keep_sides(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    for (int kind = SHAPE_SPHERE; kind <= SHAPE_CYLINDER; kind++)
        for (size_t i = 0; i < 5; i++)
            for (size_t j = 0; j < 4; j++) {
                struct scene_desc *desc = fixture_desc();
                struct shape_desc *shape = fixture_quadric(
                    desc, (enum shape_kind)kind, place_at(scales[i], shifts[j]));
                shape->emits = true;
                shape->radiance = rgb(1.0, 1.0, 1.0);
                struct scene *scene = fixture_build(desc);
                long self = 0, lost = 0;
                for (int k = 0; k < 4000; k++) {
                    double u[2] = {rng_double(&rng), rng_double(&rng)};
                    struct hit sampled, hit;
                    light_sample(scene, 0.5, u, &sampled);
                    struct ray_endpoint a = sampled.at;
                    struct vec3 n = a.ng;
                    struct vec3 w = k & 1 ? grazing(&rng, n) : random_direction(&rng);
                    if (!(k & 1) && vec3_dot(w, n) < 0.0f)
                        w = vec3_neg(w);
                    self += accel_intersect(scene, &a, w, &hit);
                    if (kind == SHAPE_SPHERE && shifts[j] < 1e5 && !(k & 1))
                        lost += !accel_intersect(scene, &a, vec3_neg(w), &hit);
                }
                if (self || lost)
                    printf("kind %d scale %g shift %g: %ld self, %ld lost\n", kind,
                           scales[i], shifts[j], self, lost);
                assert_int_equal(self, 0);
                /* A grazing chord shorter than the offsets is rightly lost: cos below
                 * 8 2^-24 shift. */
                assert_true((double)lost <= 4.0 + 4000.0 * 8.0 * 0x1p-22 * shifts[j]);
                scene_destroy(scene);
            }
}

/* A small patch near the origin of the world, lit from far away: the segment's far end is
 * rounded relative to its length, not to the patch. */
static void far_lights_see_small_things(void **state)
{
    (void)state;
    static const double sizes[] = {1.0, 1e-2, 1e-4, 1e-6};
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    for (size_t s = 0; s < 4; s++) {
        struct scene_desc *desc = fixture_desc();
        struct mesh *patch = mesh_rectangle();
        struct xform turn = xform_rotate(20.0, 1.0, 0.3, 0.0);
        struct xform grow = xform_scale(sizes[s], sizes[s], sizes[s]);
        struct xform both = xform_mul(&turn, &grow);
        mesh_transform(patch, &both);
        fixture_mesh(desc, patch);
        struct xform up = xform_translate(1.0, 2.0, 7.0);
        struct mesh *lamp = mesh_rectangle();
        mesh_transform(lamp, &up);
        struct shape_desc *light = fixture_mesh(desc, lamp);
        light->emits = light->two_sided = true;
        light->radiance = rgb(1.0, 1.0, 1.0);
        struct scene *scene = fixture_build(desc);
        long blocked = 0, asymmetric = 0;
        for (int k = 0; k < 20000; k++) {
            double u[2] = {rng_double(&rng), rng_double(&rng)};
            struct hit sampled;
            light_sample(scene, 0.5, u, &sampled);
            struct ray_endpoint a = sampled.at, b;
            b = triangle_point(&scene->shapes[0].triangles, (uint32_t)(k & 1),
                               0.5f * (float)rng_double(&rng),
                               0.5f * (float)rng_double(&rng));
            bool ab = accel_visible(scene, &a, &b);
            blocked += !ab;
            asymmetric += ab != accel_visible(scene, &b, &a);
        }
        if (blocked || asymmetric)
            printf("size %g: %ld blocked, %ld asymmetric\n", sizes[s], blocked,
                   asymmetric);
        assert_int_equal(blocked, 0);
        assert_int_equal(asymmetric, 0);
        scene_destroy(scene);
    }
}

static struct scene *closed_room(const struct xform *place, bool robust)
{
    struct scene_desc *desc = fixture_desc();
    fixture_point_light(desc);
    struct mesh *room = mesh_box();
    mesh_transform(room, place);
    fixture_mesh(desc, room);
    struct scene_options options = {.threads = 1, .keep_all = robust};
    struct err err = {0};
    struct scene *scene = scene_build(desc, &options, &err);
    assert_non_null(scene);
    return scene;
}

/* How often a walk inside finds no wall; a fourth of its steps graze. */
static long count_leaks(struct rng *rng, const struct scene *scene, struct vec3 centre,
                        int steps)
{
    struct ray_endpoint at = {.p = centre};
    struct vec3 w = random_direction(rng);
    long leaks = 0;
    for (int k = 0; k < steps; k++) {
        struct hit hit;
        if (!accel_intersect(scene, &at, w, &hit)) {
            leaks++;
            at = (struct ray_endpoint){.p = centre};
            w = random_direction(rng);
            continue;
        }
        at = hit.at;
        w = k % 4 ? random_direction(rng) : grazing(rng, vec3_neg(at.ng));
        if (vec3_dot(w, at.ng) > 0.0f)
            w = vec3_neg(w);
    }
    return leaks;
}

/* A closed room of half-width 1. With the robust flag a walk inside gets out only from
 * places nearer to an edge than the rounding of coordinates, 4 2^-24 shift: at most 12
 * edges' strips of the 24 of wall. The fast test has cracks along edges and diagonals
 * besides; measured 1e-7 of uniform rays, and of grazing ones some 1e-6. */
static void rooms_do_not_leak(void **state)
{
    (void)state;
    const int steps = 40000;
    long fast = 0, rays = 0;
    struct rng rng;
    rng_init(&rng, 4, RNG_TEST, 0);
    for (int robust = 0; robust < 2; robust++)
        for (size_t i = 0; i < 5; i++)
            for (size_t j = 0; j < 3; j++) {
                struct xform place = place_at(scales[i], shifts[j]);
                struct vec3 centre = xform_point(&place, vec3(0.0f, 0.0f, 0.0f));
                struct scene *scene = closed_room(&place, robust);
                long leaks = count_leaks(&rng, scene, centre, steps);
                scene_destroy(scene);
                if (robust)
                    assert_true((double)leaks <= steps * 8.0 * 0x1p-24 * shifts[j]);
                fast += robust ? 0 : leaks;
                rays += robust ? 0 : steps;
            }
    printf("fast test: %ld leaks of %ld rays\n", fast, rays);
    assert_true((double)fast <= 2e-5 * (double)rays);
}

/* --- instances --------------------------------------------------------------------- */

/* Each triangle of the soup a shape of the object, which lies in its own space at
 * `inside` and comes into the world by the first of two ways; the other is far away. */
static struct scene *soup_instance(struct rng *rng, double thin, double inside,
                                   double shift, const struct xform *way)
{
    struct scene *made = soup(rng, inside, shift, thin);
    struct scene_desc *desc = fixture_desc();
    int object = scene_desc_add_object(desc);
    fixture_point_light(desc);
    for (size_t i = 0; i < made->desc->shape_count; i++)
        fixture_mesh(desc, mesh_copy(made->desc->shapes[i].mesh))->object = object;
    scene_destroy(made);
    struct xform away = xform_translate(0.0, 0.0, 1e4 * inside * (1.0 + shift));
    struct xform far = xform_mul(way, &away);
    parts_add_instance(desc, object, 0, way);
    parts_add_instance(desc, object, 0, &far);
    struct scene *scene = fixture_build(desc);
    assert_int_equal(scene->instance_count, 2);
    /* Rays start in the first one's box. */
    const float *lower = scene->instances[0].lower, *upper = scene->instances[0].upper;
    scene->bounds_min = vec3(lower[0], lower[1], lower[2]);
    scene->bounds_max = vec3(upper[0], upper[1], upper[2]);
    return scene;
}

/* Where the object lies in its space, how large it is there, how unevenly it is scaled on
 * its way and where it ends (first at the origin, so that only what was rounded inside
 * counts): each makes roundings of its own. */
static void no_self_hits_on_instances(void **state)
{
    (void)state;
    static const double insides[] = {1e-2, 1.0, 1e2}, uneven[] = {1.0, -0.02};
    struct rng rng;
    rng_init(&rng, 5, RNG_TEST, 0);
    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++)
            for (size_t k = 0; k < 3; k++)
                for (size_t u = 0; u < 2; u++) {
                    double middle = -insides[i] * (shifts[k] + 0.5);
                    struct xform home = xform_translate(middle, middle, middle);
                    struct xform place = place_at(1.0 / insides[i], shifts[j]);
                    struct xform squash = xform_scale(1.0, uneven[u], 1.0);
                    struct xform back = xform_rotate(-70.0, 0.3, 1.0, -2.0);
                    struct xform way = xform_mul(&squash, &back);
                    way = xform_mul(&place, &way);
                    if (j == 0)
                        way = xform_mul(&way, &home);
                    struct tally tally = {0};
                    struct scene *scene = soup_instance(&rng, 1e-2, insides[i], shifts[k],
                                                        &way);
                    count_self_hits(&rng, scene, 6000, 9.0, &tally);
                    scene_destroy(scene);
                    if (getenv("ETALON_LONG") || tally.self_hits)
                        printf("inside %g, shift %g, of the object %g, uneven %g: %ld of "
                               "%ld\n",
                               insides[i], shifts[j], shifts[k], uneven[u],
                               tally.self_hits, tally.rays);
                    assert_int_equal(tally.self_hits, 0);
                }
}

/* Two ways for one quadric: into the scene, and far away. */
static struct scene *quadric_instance(int kind, const struct xform *inside,
                                      const struct xform *way)
{
    struct scene_desc *desc = fixture_desc();
    struct xform away = xform_translate(0.0, 0.0, 1e7), far = xform_mul(way, &away);
    int object = scene_desc_add_object(desc);
    fixture_point_light(desc);
    fixture_quadric(desc, (enum shape_kind)kind, *inside)->object = object;
    parts_add_instance(desc, object, 0, way);
    parts_add_instance(desc, object, 0, &far);
    return fixture_build(desc);
}

/* Whether rays that leave a quadric on an instance on its normal's side find it again; of
 * a disk, on the other side too. Half of the places lie within 1e-6 of what u = (.5,.5)
 * gives, the middle of a disk; there, where the disk goes through both origins, only the
 * directions are rounded. */
static void quadrics_on_instances_keep_sides(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 6, RNG_TEST, 0);
    for (int kind = SHAPE_SPHERE; kind <= SHAPE_CYLINDER; kind++)
        for (size_t i = 0; i < 3; i++)
            for (size_t j = 0; j < 3; j++) {
                struct xform inside = place_at(1.0, shifts[i]);
                struct xform squash = xform_scale(3.0, -0.7, 0.2);
                struct xform way = place_at(1.0, shifts[j]);
                way = xform_mul(&way, &squash);
                struct scene *scene = quadric_instance(kind, &inside, &way);
                long self = 0, rays = 0;
                for (int k = 0; k < 8000; k++) {
                    double spread = k & 2 ? 1e-6 : 1.0;
                    double at[2] = {0.5 + spread * (rng_double(&rng) - 0.5),
                                    0.5 + spread * (rng_double(&rng) - 0.5)};
                    struct ray_endpoint start = quadric_sample(scene->shapes[0].quadric,
                                                               at);
                    struct vec3 w = vec3_normalize(xform_normal(&way, start.ng));
                    struct hit hit, again;
                    start = (struct ray_endpoint){
                        .p = vec3_mad(xform_point(&way, start.p), 0.5f, w)};
                    if (!accel_intersect(scene, &start, vec3_neg(w), &hit))
                        continue;
                    struct vec3 out = grazing_down_to(&rng, hit.at.ng, 9.0);
                    if (vec3_dot(out, hit.at.ng) <= 0.0f)
                        continue; /* as rounded it does not leave */
                    if (kind == SHAPE_DISK && (k & 1))
                        out = vec3_neg(out);
                    rays++;
                    self += accel_intersect(scene, &hit.at, out, &again);
                }
                scene_destroy(scene);
                if (self)
                    printf("kind %d inside %g shift %g: %ld of %ld\n", kind, shifts[i],
                           shifts[j], self, rays);
                assert_true(rays > 4000);
                assert_int_equal(self, 0);
            }
}

/* A small patch in the plane z = 0 of the world, where it is at rest as seen from a lamp
 * just above that plane: along the world's components nothing is rounded. It lies askew
 * in its object's space, which is squashed on its way. */
static struct scene *grazed_patch(double size, double squash)
{
    struct scene_desc *desc = fixture_desc();
    struct parts parts = {.count = 0};
    struct xform turn = xform_rotate(40.0, 1.0, 0.3, 0.4);
    struct xform press = xform_scale(squash, 1.0, 1.0);
    struct xform grow = xform_scale(size, size, size);
    const struct xform ways[] = {xform_mul(&press, &turn),
                                 xform_translate(0.0, 0.0, -500.0)};
    struct xform askew = xform_inverse(&ways[0]);
    askew = xform_mul(&askew, &grow);
    parts_add(&parts, mesh_rectangle(), SHAPE_MESH, &askew, 0);
    parts_put(desc, false, &parts, NULL, 0, ways, 2);
    parts_deinit(&parts);
    struct xform up = xform_translate(7.0, 2.0, 0.0);
    struct xform tiny = xform_scale(1e-2, 1e-2, 1e-2);
    struct mesh *lamp = mesh_box();
    up = xform_mul(&up, &tiny);
    mesh_transform(lamp, &up);
    struct shape_desc *light = fixture_mesh(desc, lamp);
    light->emits = true;
    light->radiance = rgb(1.0, 1.0, 1.0);
    return fixture_build(desc);
}

/* As far_lights_see_small_things: the far end is rounded along components that are others
 * inside, the more the more uneven the transform is. */
static void far_lights_see_instances(void **state)
{
    (void)state;
    static const double sizes[] = {1.0, 1e-1, 1e-2}, squashes[] = {1.0, 0.1, 1e-3};
    struct rng rng;
    rng_init(&rng, 7, RNG_TEST, 0);
    for (size_t s = 0; s < 3; s++)
        for (size_t e = 0; e < 3; e++) {
            struct scene *scene = grazed_patch(sizes[s], squashes[e]);
            assert_int_equal(scene->instance_count, 2);
            long blocked = 0, asymmetric = 0, seen = 0;
            for (int k = 0; k < 20000; k++) {
                double u[2] = {rng_double(&rng), rng_double(&rng)};
                float reach = 1.8f * (float)sizes[s];
                struct vec3 to = {reach * ((float)rng_double(&rng) - 0.5f),
                                  reach * ((float)rng_double(&rng) - 0.5f), 0.0f};
                struct ray_endpoint start = {.p = vec3(-1.0f, 0.5f, 3.0f)};
                struct hit sampled, hit;
                light_sample(scene, 0.5, u, &sampled);
                struct ray_endpoint a = sampled.at;
                struct vec3 w = vec3_normalize(vec3_sub(to, start.p));
                if (a.p.z < 1e-3f || a.ng.x > -0.5f ||
                    !accel_intersect(scene, &start, w, &hit) || hit.at.p.z < -100.0f)
                    continue;
                seen++;
                bool ab = accel_visible(scene, &a, &hit.at);
                blocked += !ab;
                asymmetric += ab != accel_visible(scene, &hit.at, &a);
            }
            scene_destroy(scene);
            if (blocked || asymmetric)
                printf("size %g squash %g: %ld of %ld blocked, %ld asymmetric\n",
                       sizes[s], squashes[e], blocked, seen, asymmetric);
            assert_true(seen > 500);
            assert_int_equal(blocked, 0);
            assert_int_equal(asymmetric, 0);
        }
}

/* Offsets and what the far end adds, of an instance of the unit square, are some
 * roundings: nothing near is lost to them. */
static void instance_offsets_are_small(void **state)
{
    (void)state;
    struct scene_desc *desc = fixture_desc();
    struct parts parts = {.count = 0};
    const struct xform one = xform_identity();
    const struct xform ways[] = {place_at(3.0, 0.5), xform_translate(0.0, 0.0, -500.0)};
    fixture_point_light(desc);
    parts_add(&parts, mesh_rectangle(), SHAPE_MESH, &one, 0);
    parts_put(desc, false, &parts, NULL, 0, ways, 2);
    parts_deinit(&parts);
    struct scene *scene = fixture_build(desc);
    struct vec3 p = xform_point(&ways[0], vec3(0.3f, 0.2f, 0.0f));
    struct vec3 n = vec3_normalize(xform_normal(&ways[0], vec3(0.0f, 0.0f, 1.0f)));
    struct ray_endpoint from = {.p = vec3_mad(p, 2.0f, n)};
    struct hit hit;
    assert_true(accel_intersect(scene, &from, vec3_neg(n), &hit));
    assert_true((double)hit.at.offset < 100.0 * 0x1p-24 * 3.0);
    assert_true((double)hit.at.far_offset < 32.0 * 0x1p-24);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_self_hits_of_triangles),
        cmocka_unit_test(quadrics_keep_sides),
        cmocka_unit_test(far_lights_see_small_things),
        cmocka_unit_test(rooms_do_not_leak),
        cmocka_unit_test(no_self_hits_on_instances),
        cmocka_unit_test(quadrics_on_instances_keep_sides),
        cmocka_unit_test(far_lights_see_instances),
        cmocka_unit_test(instance_offsets_are_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
