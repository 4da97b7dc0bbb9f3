/* Metrics against figures worked out by hand and against a slow second implementation. */
#include "image/metric.h"
#include "math/rng.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/near.h"

#include <math.h>
#include <string.h>

static struct image *filled(int width, int height, float r, float g, float b)
{
    struct image *image = image_create(width, height);
    for (int i = 0; i < width * height; i++) {
        image->pixels[3 * i] = r;
        image->pixels[3 * i + 1] = g;
        image->pixels[3 * i + 2] = b;
    }
    return image;
}

/* Two pixels, worked out by hand. */
static void known_pixels(void **state)
{
    (void)state;
    struct image *a = filled(2, 1, 1.0f, 0.5f, 0.0f);
    struct image *r = filled(2, 1, 0.5f, 0.5f, 0.25f);
    image_at(a, 1, 0)[0] = 0.5f;
    struct metric m;
    struct err err = {0};
    assert_true(metric_compare(a, r, &m, &err));
    assert_relative(m.mean_ratio_r, 1.5, 1e-15);
    assert_relative(m.mean_ratio_g, 1.0, 1e-15);
    assert_true(m.mean_ratio_b == 0.0);
    assert_relative(m.mean_ratio,
                    (0.2126 * 0.75 + 0.7152 * 0.5) /
                        (0.2126 * 0.5 + 0.7152 * 0.5 + 0.0722 * 0.25),
                    1e-14);
    /* Squares: 0.25 once, 0.0625 twice, of six. */
    assert_relative(m.rmse, sqrt(0.375 / 6.0), 1e-15);
    assert_relative(m.relmse, (0.25 / 0.26 + 2 * 0.0625 / 0.0725) / 6.0, 1e-14);
    assert_true(m.relmse_trimmed == m.relmse && m.nonfinite == 0);
    /* One channel 1 against .5, two 0 against .25, of six. */
    assert_relative(m.smape, (0.5 / 1.51 + 2 * 0.25 / 0.26) / 6.0, 1e-14);
    image_destroy(a);
    image_destroy(r);
}

static void equal_pictures_have_no_error(void **state)
{
    (void)state;
    struct image *a = filled(7, 5, 0.3f, 20.0f, 1e-4f);
    struct metric m;
    assert_true(metric_compare(a, a, &m, NULL));
    assert_true(m.rmse == 0.0 && m.relmse == 0.0 && m.relmse_trimmed == 0.0);
    assert_true(m.smape == 0.0);
    assert_true(m.mean_ratio == 1.0 && m.mean_ratio_b == 1.0);
    image_destroy(a);
}

static void trimming_drops_one_pixel_in_a_hundred(void **state)
{
    (void)state;
    static const struct {
        int width, height, dropped;
    } cases[] = {{99, 1, 0}, {100, 1, 1}, {20, 10, 2}, {199, 1, 1}};
    for (int c = 0; c < 4; c++) {
        struct image *r = filled(cases[c].width, cases[c].height, 0.3f, 0.3f, 0.3f);
        struct image *a = filled(cases[c].width, cases[c].height, 0.3f, 0.3f, 0.3f);
        int pixels = cases[c].width * cases[c].height;
        for (int f = 0; f < 4; f++) /* four fireflies, each ten times the last */
            a->pixels[3 * (pixels / 5 * f) + f % 3] += powf(10.0f, (float)f);
        struct metric m;
        assert_true(metric_compare(a, r, &m, NULL));
        double left = 0.0, all = 0.0;
        for (int f = 0; f < 4; f++) {
            double d = (double)(0.3f + powf(10.0f, (float)f)) - (double)0.3f;
            double e = d * d / ((double)0.3f * (double)0.3f + 0.01);
            all += e;
            left += f < 4 - cases[c].dropped ? e : 0.0;
        }
        assert_relative(m.relmse, all / 3.0 / pixels, 1e-13);
        assert_relative(m.relmse_trimmed, left / 3.0 / (pixels - cases[c].dropped),
                        1e-13);
        image_destroy(a);
        image_destroy(r);
    }
}

/* Slow and by definition: all sums in long double, the highest found by looking. */
static void compare_slowly(const struct image *a, const struct image *r, struct metric *m)
{
    enum { MOST = 4096 };
    static long double errors[MOST];
    long double sums[2][3] = {{0}}, squares = 0, total = 0, trimmed = 0;
    int count = 0;
    *m = (struct metric){0};
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            const float *p = image_at(a, x, y), *q = image_at(r, x, y);
            bool finite = true;
            for (int c = 0; c < 3; c++)
                finite = finite && isfinite(p[c]) && isfinite(q[c]);
            if (!finite) {
                m->nonfinite++;
                continue;
            }
            errors[count] = 0;
            for (int c = 0; c < 3; c++) {
                long double d = (long double)p[c] - (long double)q[c];
                sums[0][c] += (long double)p[c];
                sums[1][c] += (long double)q[c];
                squares += d * d;
                errors[count] += d * d / ((long double)q[c] * (long double)q[c] + 0.01L);
            }
            total += errors[count++];
        }
    for (int k = 0; k < count / 100; k++) {
        int worst = 0;
        for (int i = 1; i < count; i++)
            worst = errors[i] > errors[worst] ? i : worst;
        errors[worst] = -1;
    }
    for (int i = 0; i < count; i++)
        trimmed += errors[i] >= 0 ? errors[i] : 0;
    long double y[2];
    for (int i = 0; i < 2; i++)
        y[i] = 0.2126L * sums[i][0] + 0.7152L * sums[i][1] + 0.0722L * sums[i][2];
    m->mean_ratio = (double)(y[0] / y[1]);
    m->mean_ratio_r = (double)(sums[0][0] / sums[1][0]);
    m->mean_ratio_g = (double)(sums[0][1] / sums[1][1]);
    m->mean_ratio_b = (double)(sums[0][2] / sums[1][2]);
    m->rmse = (double)sqrtl(squares / (3 * count));
    m->relmse = (double)(total / (3 * count));
    m->relmse_trimmed = (double)(trimmed / (3 * (count - count / 100)));
}

static void both_implementations_agree(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int run = 0; run < 40; run++) {
        int width = 1 + (int)(rng_u64(&rng) % 64), height = 1 + (int)(rng_u64(&rng) % 64);
        struct image *a = image_create(width, height), *r = image_create(width, height);
        for (int i = 0; i < 3 * width * height; i++) {
            r->pixels[i] = (float)exp(12.0 * rng_double(&rng) - 8.0);
            a->pixels[i] = r->pixels[i] * (float)(2.0 * rng_double(&rng));
            if (run % 2 && rng_u64(&rng) % 100 == 0)
                a->pixels[i] = rng_u64(&rng) % 2 ? NAN : -INFINITY;
            if (run % 4 == 3 && rng_u64(&rng) % 100 == 0)
                r->pixels[i] = INFINITY;
        }
        a->pixels[0] = a->pixels[1] = a->pixels[2] = 1.0f; /* one finite pixel at least */
        r->pixels[0] = r->pixels[1] = r->pixels[2] = 2.0f;
        struct metric fast, slow;
        assert_true(metric_compare(a, r, &fast, NULL));
        compare_slowly(a, r, &slow);
        assert_true(fast.nonfinite == slow.nonfinite);
        assert_relative(fast.mean_ratio, slow.mean_ratio, 1e-14);
        assert_relative(fast.mean_ratio_r, slow.mean_ratio_r, 1e-14);
        assert_relative(fast.mean_ratio_g, slow.mean_ratio_g, 1e-14);
        assert_relative(fast.mean_ratio_b, slow.mean_ratio_b, 1e-14);
        assert_relative(fast.rmse, slow.rmse, 1e-14);
        assert_relative(fast.relmse, slow.relmse, 1e-13);
        assert_relative(fast.relmse_trimmed, slow.relmse_trimmed, 1e-13);
        image_destroy(a);
        image_destroy(r);
    }
}

static void pictures_that_cannot_be_compared_are_errors(void **state)
{
    (void)state;
    struct image *a = filled(3, 2, 1.0f, 1.0f, 1.0f), *b = filled(2, 3, 1.0f, 1.0f, 1.0f);
    struct image *bad = filled(3, 2, NAN, 1.0f, 1.0f);
    struct metric m;
    struct err err = {0};
    assert_false(metric_compare(a, b, &m, &err));
    assert_int_equal(err.code, ERR_VALUE);
    assert_non_null(strstr(err.message, "3x2 against 2x3"));
    err = (struct err){0};
    assert_false(metric_compare(a, bad, &m, &err));
    assert_true(err.code == ERR_VALUE && m.nonfinite == 6);
    struct image *left = filled(3, 2, 1.0f, 1.0f, 1.0f);
    struct image *right = filled(3, 2, 1.0f, 1.0f, 1.0f);
    left->whole_width = right->whole_width = 6; /* crops of one film */
    right->x = 3;
    err = (struct err){0};
    assert_false(metric_compare(left, right, &m, &err));
    assert_non_null(strstr(err.message, "different crops, from (0, 0) and (3, 0)"));
    assert_true(metric_compare(right, right, &m, NULL));
    assert_true(metric_compare(a, right, &m, NULL)); /* the first says no place */
    image_destroy(left);
    image_destroy(right);
    assert_null(metric_difference(a, b, 1.0, NULL));
    assert_null(metric_difference(a, a, 0.0, NULL));
    assert_null(metric_difference(a, a, (double)NAN, NULL));
    image_destroy(a);
    image_destroy(b);
    image_destroy(bad);
}

static void check_pixel(const struct image *image, int x, double r, double g, double b)
{
    const float *p = image_at(image, x, 0);
    assert_true(fabs((double)p[0] - r) < 1e-6 && fabs((double)p[1] - g) < 1e-6 &&
                fabs((double)p[2] - b) < 1e-6);
}

static void differences_are_red_and_blue(void **state)
{
    (void)state;
    struct image *b = filled(6, 1, 1.0f, 1.0f, 1.0f), *a = filled(6, 1, 1.0f, 1.0f, 1.0f);
    const float values[6] = {1.0f, 1.55f, 0.45f, 30.0f, -30.0f, 1.0f};
    for (int x = 0; x < 6; x++)
        for (int c = 0; c < 3; c++)
            image_at(a, x, 0)[c] = values[x];
    image_at(a, 5, 0)[2] = NAN;
    struct image *d = metric_difference(a, b, 2.0, NULL);
    assert_non_null(d);
    check_pixel(d, 0, 0.0, 0.0, 0.0);
    check_pixel(d, 1, 0.25, 0.0, 0.0); /* 0.55 / (1 + 0.1) / 2 */
    check_pixel(d, 2, 0.0, 0.0, 0.25);
    check_pixel(d, 3, 1.0, 0.0, 0.0);
    check_pixel(d, 4, 0.0, 0.0, 1.0);
    check_pixel(d, 5, 0.0, 1.0, 0.0);
    image_destroy(d);
    struct image *black = image_create(6, 1);
    d = metric_difference(black, black, 1.0, NULL);
    check_pixel(d, 3, 0.0, 0.0, 0.0);
    image_destroy(d);
    image_destroy(black);
    image_destroy(a);
    image_destroy(b);
}

static void reducing_takes_means_of_blocks(void **state)
{
    (void)state;
    struct image *image = image_create(6, 4);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 6; x++)
            for (int c = 0; c < 3; c++)
                image_at(image, x, y)[c] = (float)(100 * c + 10 * y + x);
    struct image *half = image_reduce(image, 2);
    assert_non_null(half);
    assert_true(half->width == 3 && half->height == 2);
    assert_true(image_at(half, 0, 0)[0] == 5.5f);
    assert_true(image_at(half, 2, 1)[1] == 100.0f + 25.0f + 4.5f);
    struct image *same = image_reduce(image, 1);
    assert_memory_equal(same->pixels, image->pixels, 72 * sizeof(float));
    assert_null(image_reduce(image, 3));
    assert_null(image_reduce(image, 0));
    image_destroy(half);
    image_destroy(same);
    image_destroy(image);
    image_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_pixels),
        cmocka_unit_test(equal_pictures_have_no_error),
        cmocka_unit_test(trimming_drops_one_pixel_in_a_hundred),
        cmocka_unit_test(both_implementations_agree),
        cmocka_unit_test(pictures_that_cannot_be_compared_are_errors),
        cmocka_unit_test(differences_are_red_and_blue),
        cmocka_unit_test(reducing_takes_means_of_blocks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
