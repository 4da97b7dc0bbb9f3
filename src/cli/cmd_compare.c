/* etalon compare: one picture against another. */

#include "base/mem.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/output.h"
#include "image/exr.h"
#include "image/flip.h"
#include "image/metric.h"
#include "image/preview.h"
#include "lab/scalar.h"

#include <math.h>
#include <stdio.h>

#define DEFAULT_RANGE 0.5

static void print_number(const char *key, double value)
{
    struct text text = {0};
    scalar_append_number(&text, value);
    printf("%s: %s\n", key, text.data);
    mem_free(text.data);
}

/* flip: NULL if it was not asked for. */
static void print_metric(const struct metric *m, const struct flip *flip)
{
    print_number("mean_ratio", m->mean_ratio);
    print_number("mean_ratio_r", m->mean_ratio_r);
    print_number("mean_ratio_g", m->mean_ratio_g);
    print_number("mean_ratio_b", m->mean_ratio_b);
    print_number("rmse", m->rmse);
    print_number("relmse", m->relmse);
    print_number("relmse_trimmed", m->relmse_trimmed);
    printf("n_nonfinite: %ld\n", m->nonfinite);
    print_number("smape", m->smape);
    if (flip == NULL)
        return;
    print_number("flip", flip->hdr);
    print_number("flip_ldr", flip->ldr);
    printf("flip_exposures: %d\n", flip->exposures);
    print_number("flip_exposure_first", flip->exposure_first);
    print_number("flip_exposure_last", flip->exposure_last);
}

static bool write_difference(const char *path, const struct image *a,
                             const struct image *b, double range, struct err *err)
{
    struct image *difference = metric_difference(a, b, range, err);
    bool ok = difference != NULL &&
              (text_ends_with(path, ".png")
                   ? preview_write_png(path, difference, 0.0, err)
                   : exr_write(path, difference, NULL, 0, NULL, err));
    image_destroy(difference);
    return ok;
}

/* The mean names its halves; their other attributes are not copied. */
static bool write_mean(const struct args *args, const struct image *a,
                       const struct image *b, struct err *err)
{
    const struct exr_attribute attributes[] = {
        {"etalon:mean_of", args->operands[0]},
        {"etalon:mean_and", args->operands[1]},
    };
    struct image *mean = image_mean(a, b);
    bool ok = exr_write(args_value(args, "mean"), mean, attributes,
                        (int)(sizeof attributes / sizeof attributes[0]), NULL, err);
    image_destroy(mean);
    return ok;
}

struct request {
    const char *out; /* NULL: no difference picture */
    double range, reduce;
};

static bool check_args(const struct args *args, struct request *request, struct err *err)
{
    const char *text = args_value(args, "range"), *mean = args_value(args, "mean");
    const char *reduce = args_value(args, "reduce"), **out = &request->out;
    double *range = &request->range;
    *request = (struct request){args_value(args, "output"), DEFAULT_RANGE, 1.0};
    if (*out && !text_ends_with(*out, ".png") && !text_ends_with(*out, ".exr"))
        return err_set(err, ERR_USAGE, NULL,
                       "-o '%s': a difference picture's name ends in .png or .exr", *out);
    if (text && (!text_to_double(text, range) || !(*range > 0.0)))
        return err_set(err, ERR_USAGE, NULL,
                       "--range: '%s' is not possible; give a number above 0", text);
    if (reduce && (!text_to_double(reduce, &request->reduce) || request->reduce < 1.0 ||
                   request->reduce > 64.0 || floor(request->reduce) != request->reduce))
        return err_set(err, ERR_USAGE, NULL,
                       "--reduce: '%s' is not possible; give a whole number from 1 to 64",
                       reduce);
    if (mean && !text_ends_with(mean, ".exr"))
        return err_set(err, ERR_USAGE, NULL,
                       "--mean '%s': the picture's name ends in .exr", mean);
    const struct output_file written[] = {{"-o", *out}, {"--mean", mean}, {0}};
    const struct output_file read[] = {
        {"A", args->operands[0]}, {"B", args->operands[1]}, {0}};
    return output_check(*out, err) && output_check(mean, err) &&
           output_apart(written, read, err);
}

/* The picture in blocks of `factor` pixels each way. */
static struct image *read_reduced(const char *path, int factor, struct err *err)
{
    struct image *image = exr_read(path, NULL, err);
    if (image == NULL || factor == 1)
        return image;
    struct image *reduced = image_reduce(image, factor);
    if (reduced == NULL)
        err_set(err, ERR_USAGE, NULL, "--reduce %d: '%s' has %dx%d pixels, no multiple",
                factor, path, image->width, image->height);
    image_destroy(image);
    return reduced;
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct metric metric;
    struct flip flip;
    struct image *a = NULL, *b = NULL;
    struct request r;
    bool seen = args_value(args, "no-flip") == NULL;
    bool ok = check_args(args, &r, &err) &&
              (a = exr_read(args->operands[0], NULL, &err)) != NULL &&
              (b = read_reduced(args->operands[1], (int)r.reduce, &err)) != NULL &&
              metric_compare(a, b, &metric, &err) &&
              (!seen || flip_compare(a, b, &flip, &err)) &&
              (r.out == NULL || write_difference(r.out, a, b, r.range, &err)) &&
              (args_value(args, "mean") == NULL || write_mean(args, a, b, &err));
    if (ok)
        print_metric(&metric, seen ? &flip : NULL);
    image_destroy(a);
    image_destroy(b);
    return ok ? 0 : fail(&err);
}

static const struct arg_option own[] = {
    {"output", 'o', "DIFF.png", NULL,
     "relative difference (.png or .exr): red where A is brighter, blue where B is"},
    {"mean", 0, "MEAN.exr", NULL,
     "(A+B)/2; if they are alike but for the seed, comparing A with it gives the mean's "
     "own noise"},
    {"reduce", 0, "N", NULL, "means of N x N pixels of B stand for B, which is larger"},
    {"no-flip", 0, NULL, NULL,
     "leaves FLIP out, which takes most of the time (3 us a pixel)"},
    {"range", 0, "R", NULL, "relative difference that is shown in full colour (0.5)"},
    {0},
};

const struct command command_compare = {
    .name = "compare",
    .summary = "measures picture A against picture B, the reference",
    .operands = "A.exr B.exr [options]",
    .operand_count = 2,
    .groups = {own},
    .notes =
        "Prints mean_ratio (luminance of A over B), mean_ratio_r, _g, _b, rmse, relmse "
        "(the mean\nof d^2/(r^2+0.01)), relmse_trimmed (without the 1 % highest "
        "pixels), n_nonfinite, smape\n(the mean of |d|/(|a|+|r|+0.01)), flip (HDR-FLIP "
        "at 67 pixels per degree, over\nflip_exposures exposures) and flip_ldr (LDR-FLIP "
        "of both pictures clamped to [0,1]).",
    .run = run,
};
