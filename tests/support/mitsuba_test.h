#ifndef ETALON_TESTS_SUPPORT_MITSUBA_TEST_H
#define ETALON_TESTS_SUPPORT_MITSUBA_TEST_H

/* Mitsuba scenes that a test writes, and what became of them. Wants cmocka included
 * before. */

#include "support/import_test.h"

#define OLD(body)   "<scene version=\"0.6.0\">\n" body "</scene>\n"
#define NEW(body)   "<scene version=\"3.0.0\">\n" body "</scene>\n"
#define SHAPE(body) NEW("<shape type=\"rectangle\">" body "</shape>\n")

static inline struct scene_desc *good(const char *text)
{
    return import_test_good("scene.xml", text);
}

static inline void rgb_is(const double *v, double r, double g, double b)
{
    import_test_near(v[0], r, 1e-6);
    import_test_near(v[1], g, 1e-6);
    import_test_near(v[2], b, 1e-6);
}

static inline void point_is(const float *p, double x, double y, double z)
{
    import_test_near((double)p[0], x, 1e-5);
    import_test_near((double)p[1], y, 1e-5);
    import_test_near((double)p[2], z, 1e-5);
}

/* What a shape's front is made of, whether its back is black or not. */
static inline const struct bsdf *front(const struct scene_desc *desc, int shape)
{
    const struct bsdf *bsdf = &desc->materials[desc->shapes[shape].material];
    return text_equal(bsdf->type->name, "sides") ? bsdf->child[0] : bsdf;
}

static inline const double *param_of(const struct bsdf *bsdf, const char *name)
{
    const struct bsdf_param *param = bsdf_param_find(bsdf->type, name);
    assert_non_null(param);
    return bsdf->param + param->offset;
}

static inline const double *front_param(const struct scene_desc *desc, int shape,
                                        const char *name)
{
    return param_of(front(desc, shape), name);
}

#endif
