/* How a run's error bars and verdict stand to the truth.
 *
 *   coverage SCENE REF.exr reference key=value ...   makes REF.exr and REF.exr.se.exr,
 *                                                    its standard errors
 *   coverage SCENE REF.exr SEEDS key=value ...       a row for every seed
 *
 * Columns, apart by tabs: seed; verdict; relMSE of the luminance as the run estimates it,
 * its standard error, and as it is, less what the reference's own noise adds; the share
 * of pixels whose 95 % bar covers the reference, of all and of those above a tenth of the
 * mean; tiles that disagree, of how many; the largest R-hat; the verdict's words; how
 * long the run was, per pixel, and what ended it; its mean brightness over the
 * reference's; paths that it is blind to. */

#include "program.h"

#include "base/mem.h"
#include "base/text.h"
#include "image/exr.h"

static void make_reference(const struct scene *scene, const struct settings *settings,
                           const char *path, const char *se_path)
{
    struct run_result r = program_render(scene, settings);
    struct err err = {0};
    struct image *se = image_create(r.image->width, r.image->height);
    for (long i = 0; i < (long)se->width * se->height; i++)
        for (int c = 0; c < 3; c++)
            se->pixels[3 * i + c] = r.verdict.se[i];
    char relmse[32];
    snprintf(relmse, sizeof relmse, "%.9g", r.verdict.relmse);
    struct exr_attribute floor = {"etalon:relmse_estimated", relmse};
    if (!exr_write(path, r.image, &floor, 1, NULL, &err) ||
        !exr_write(se_path, se, NULL, 0, NULL, &err))
        program_die(&err);
    printf("relMSE of the reference: %s\n", relmse);
    image_destroy(se);
    run_result_deinit(&r);
}

static double luminance(const struct image *image, long i)
{
    const float *p = image->pixels + 3 * i;
    return rgb_luminance(rgb((double)p[0], (double)p[1], (double)p[2]));
}

static double mean_luminance(const struct image *image)
{
    long n = (long)image->width * image->height;
    double mean = 0.0;
    for (long i = 0; i < n; i++)
        mean += luminance(image, i) / (double)n;
    return mean;
}

/* Shares of pixels covered: of all, and of those that are not dark. */
static void cover(const struct run_result *r, const struct image *reference,
                  const struct image *se, double *all, double *bright)
{
    long n = (long)reference->width * reference->height, covered[2] = {0}, count[2] = {0};
    double mean = mean_luminance(reference);
    for (long i = 0; r->verdict.se && i < n; i++) {
        double error = luminance(r->image, i) - luminance(reference, i);
        double bar = r->verdict.bar_95 *
                     hypot((double)r->verdict.se[i], (double)se->pixels[3 * i]);
        int light = luminance(reference, i) > 0.1 * mean;
        for (int j = 0; j <= light; j++) {
            count[j]++;
            covered[j] += fabs(error) <= bar;
        }
    }
    *all = (double)covered[0] / (double)count[0];
    *bright = (double)covered[1] / (double)count[1];
}

/* relMSE of the luminance, less `floor`. */
static double true_relmse(const struct image *image, const struct image *reference,
                          double floor)
{
    long n = (long)reference->width * reference->height;
    double sum = 0.0;
    for (long i = 0; i < n; i++) {
        double r = luminance(reference, i), d = luminance(image, i) - r;
        sum += d * d / (r * r + 0.01);
    }
    return sum / (double)n - floor;
}

static void print_row(const struct run_result *r, const struct image *reference,
                      const struct image *se, double floor, long seed)
{
    const struct verdict *v = &r->verdict;
    double all, bright;
    cover(r, reference, se, &all, &bright);
    printf("%ld\t%s\t%.3e\t%.1e\t%.3e\t%.3f\t%.3f\t%d\t%d\t%.3f\t%s\t%g\t%s\t%.4f\t%s\n",
           seed, verdict_name(v->call), v->relmse, v->relmse_se,
           true_relmse(r->image, reference, floor), all, bright, v->tiles_bad, v->tiles,
           v->rhat_max, v->words, r->mutations_per_pixel, run_end_name(r->end),
           mean_luminance(r->image) / mean_luminance(reference), r->blind_to);
    fflush(stdout);
}

static void measure(const struct scene *scene, struct settings *settings,
                    const char *path, const char *se_path, long seeds)
{
    struct err err = {0};
    struct image *reference = exr_read(path, NULL, &err);
    struct image *se = reference ? exr_read(se_path, NULL, &err) : NULL;
    char *floor = exr_read_attribute(path, "etalon:relmse_estimated");
    if (se == NULL || floor == NULL)
        program_die(&err);
    for (long seed = 1; seed <= seeds; seed++) {
        settings->seed = seed;
        struct run_result r = program_render(scene, settings);
        print_row(&r, reference, se, atof(floor), seed);
        run_result_deinit(&r);
    }
    mem_free(floor);
    image_destroy(se);
    image_destroy(reference);
}

int main(int argc, char **argv)
{
    struct settings settings;
    if (argc < 4) {
        fprintf(stderr,
                "usage: coverage SCENE REF.exr SEEDS|reference [key=value ...]\n");
        return 2;
    }
    settings_init(&settings);
    for (int i = 4; i < argc; i++)
        program_set(&settings, argv[i]);
    struct scene *scene = program_open_scene(argv[1], &settings);
    char *se_path = text_format("%s.se.exr", argv[2]);
    if (strcmp(argv[3], "reference") == 0)
        make_reference(scene, &settings, argv[2], se_path);
    else
        measure(scene, &settings, argv[2], se_path, strtol(argv[3], NULL, 10));
    mem_free(se_path);
    scene_destroy(scene);
    return 0;
}
