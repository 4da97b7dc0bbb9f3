/* Where pictures differ from a reference by more than noise.
 *
 *   regions REFERENCE.exr BLOCK MEAN.exr MAP.txt A.exr ...
 *
 * The mean of the pictures A is written to MEAN.exr and held against the reference in
 * square blocks of BLOCK pixels a side. The noise of a block's mean difference is taken
 * from the spread of the differences of its pixels, which are as good as independent in
 * pt and bdpt (not in chains). So it holds the noise of both sides, and what is no noise
 * but differs from pixel to pixel (an edge half a pixel off) too. Student's t then; the
 * family of all blocks and channels errs with the rate FALSE_ALARM. Bright outliers make
 * t too small, never too large. MAP.txt has a line for each block: x y ratio t, of
 * luminance. */

#include "program.h"

#include "base/mem.h"
#include "image/exr.h"
#include "math/accum.h"
#include "math/order.h"
#include "math/rgb.h"
#include "support/stat_test.h"

#define FALSE_ALARM 1e-2
#define KINDS       4 /* r, g, b, luminance */

static const char *const kind_name[KINDS] = {"r", "g", "b", "luminance"};

static struct image *read_picture(const char *path)
{
    struct err err = {0};
    struct image *image = exr_read(path, NULL, &err);
    if (image == NULL)
        program_die(&err);
    return image;
}

static struct image *read_mean(int count, char **paths, const struct image *like)
{
    struct image *mean = image_create(like->width, like->height);
    size_t values = 3 * (size_t)like->width * (size_t)like->height;
    double *sum = mem_alloc(values, sizeof *sum);
    for (int i = 0; i < count; i++) {
        struct image *a = read_picture(paths[i]);
        if (a->width != like->width || a->height != like->height) {
            fprintf(stderr, "regions: %s is %dx%d, the reference is %dx%d\n", paths[i],
                    a->width, a->height, like->width, like->height);
            exit(1);
        }
        for (size_t j = 0; j < values; j++)
            sum[j] += (double)a->pixels[j];
        image_destroy(a);
    }
    for (size_t j = 0; j < values; j++)
        mean->pixels[j] = (float)(sum[j] / count);
    mem_free(sum);
    return mean;
}

static double value_of(const float *pixel, int kind)
{
    if (kind < 3)
        return (double)pixel[kind];
    return rgb_luminance(rgb((double)pixel[0], (double)pixel[1], (double)pixel[2]));
}

struct region {
    double ratio, t;
};

static struct region measure(const struct image *a, const struct image *b, int x0, int y0,
                             int width, int height, int kind)
{
    struct welford difference = {0}, reference = {0};
    for (int y = y0; y < y0 + height; y++)
        for (int x = x0; x < x0 + width; x++) {
            double r = value_of(image_at(b, x, y), kind);
            welford_add(&difference, value_of(image_at(a, x, y), kind) - r);
            welford_add(&reference, r);
        }
    double se = welford_se(&difference);
    return (struct region){
        .ratio = 1.0 + difference.mean / reference.mean,
        .t = se > 0.0 ? difference.mean / se : 0.0,
    };
}

/* All blocks of one kind; `map` may be NULL. */
static void blocks(const struct image *a, const struct image *b, int side, int kind,
                   FILE *map)
{
    int across = a->width / side, count = across * (a->height / side), beyond = 0;
    int worst_x = 0, worst_y = 0, freedom = side * side - 1;
    double *u = mem_alloc((size_t)count, sizeof *u), squares = 0.0;
    double level = stat_sidak(FALSE_ALARM, count * KINDS);
    struct region worst = {0};
    for (int i = 0; i < count; i++) {
        int x = i % across * side, y = i / across * side;
        struct region r = measure(a, b, x, y, side, side, kind);
        u[i] = gsl_cdf_tdist_P(r.t, freedom);
        squares += r.t * r.t;
        beyond += stat_t_p(r.t, freedom) < level;
        if (fabs(r.t) > fabs(worst.t)) {
            worst = r;
            worst_x = x;
            worst_y = y;
        }
        if (map)
            fprintf(map, "%s%d %d %.6f %.3f\n", x == 0 && y > 0 ? "\n" : "", x + side / 2,
                    y + side / 2, r.ratio, r.t);
    }
    sort_ascending(u, (size_t)count);
    printf("%-10s %6d %9.3f %9.4f at %4d,%-4d %7.5f %6d %10.3g\n", kind_name[kind], count,
           sqrt(squares / count), worst.t, worst_x, worst_y, worst.ratio, beyond,
           stat_uniform_p(u, count));
    mem_free(u);
}

static void report(const struct image *a, const struct image *b, int side, FILE *map)
{
    int count = a->width / side * (a->height / side);
    printf("%-10s %10s %10s %8s\n", "whole", "ratio", "se", "t");
    for (int kind = 0; kind < KINDS; kind++) {
        struct region r = measure(a, b, 0, 0, a->width, a->height, kind);
        double se = r.t == 0.0 ? 0.0 : (r.ratio - 1.0) / r.t;
        printf("%-10s %10.5f %10.5f %8.2f\n", kind_name[kind], r.ratio, se, r.t);
    }
    printf(
        "blocks of %dx%d; |t| beyond %.2f is beyond noise (%g in all)\n", side, side,
        gsl_cdf_tdist_Qinv(stat_sidak(FALSE_ALARM, count * KINDS) / 2.0, side * side - 1),
        FALSE_ALARM);
    printf("%-10s %6s %9s %9s %12s %7s %6s %10s\n", "", "blocks", "rms t", "worst t", "",
           "ratio", "beyond", "p of t's");
    for (int kind = 0; kind < KINDS; kind++)
        blocks(a, b, side, kind, kind == KINDS - 1 ? map : NULL);
}

int main(int argc, char **argv)
{
    struct err err = {0};
    int side = argc > 5 ? atoi(argv[2]) : 0;
    if (side < 2) {
        fprintf(stderr,
                "usage: regions REFERENCE.exr BLOCK MEAN.exr MAP.txt A.exr ...\n");
        return 2;
    }
    struct image *reference = read_picture(argv[1]);
    struct image *mean = read_mean(argc - 5, argv + 5, reference);
    FILE *map = fopen(argv[4], "w");
    if (map == NULL) {
        fprintf(stderr, "regions: cannot write %s\n", argv[4]);
        return 1;
    }
    report(mean, reference, side, map);
    if (!exr_write(argv[3], mean, NULL, 0, NULL, &err))
        program_die(&err);
    fclose(map);
    image_destroy(mean);
    image_destroy(reference);
    return 0;
}
