#include "report/report_reference.h"

#include "base/hash.h"
#include "base/mem.h"
#include "image/exr.h"
#include "image/metric.h"
#include "lab/reference.h"

#include <dirent.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

/* The same pixels give the same error except for the order of sums. */
#define SAME_ERROR 1e-9

static char *named(const struct results *results, const struct results_cell *cell)
{
    if (cell->reference[0] == '\0')
        return NULL;
    char *below = text_join(results->folder, cell->reference);
    if (access(below, R_OK) == 0)
        return below;
    mem_free(below);
    return access(cell->reference, R_OK) == 0 ? text_copy(cell->reference) : NULL;
}

/* SCENE-KEY */
static bool is_folder_of(const char *name, const char *scene)
{
    size_t length = strlen(scene);
    return strncmp(name, scene, length) == 0 && name[length] == '-' &&
           strlen(name + length + 1) == HASH_DIGITS &&
           strspn(name + length + 1, "0123456789abcdef") == HASH_DIGITS;
}

static bool fits(const char *path, const struct image *image, double relmse)
{
    struct metric metric;
    struct image *reference = access(path, R_OK) == 0 ? exr_read(path, NULL, NULL) : NULL;
    bool same = reference && metric_compare(image, reference, &metric, NULL) &&
                fabs(metric.relmse - relmse) <= SAME_ERROR * relmse;
    image_destroy(reference);
    return same;
}

char *report_reference_find(const struct results *results,
                            const struct results_cell *cell,
                            const struct results_run *run, const struct image *image,
                            const char *folder)
{
    char *found = named(results, cell);
    double relmse = run->error[RESULTS_RELMSE];
    DIR *directory = found || !isfinite(relmse) ? NULL : opendir(folder);
    for (struct dirent *entry; directory && !found && (entry = readdir(directory));) {
        if (!is_folder_of(entry->d_name, cell->scene))
            continue;
        char *path = text_format("%s/%s/mean.exr", folder, entry->d_name);
        if (fits(path, image, relmse))
            found = path;
        else
            mem_free(path);
    }
    if (directory)
        closedir(directory);
    return found;
}

bool report_reference_noise(const char *path, double noise[RESULTS_ESTIMATED])
{
    struct reference reference;
    if (!reference_read(path, NULL, &reference, NULL))
        return false;
    noise[RESULTS_RELMSE] = reference.noise.relmse;
    noise[RESULTS_RELMSE_TRIMMED] = reference.noise.relmse_trimmed;
    noise[RESULTS_MSE] = reference.noise.rmse * reference.noise.rmse;
    bool known = isfinite(reference.noise.relmse);
    reference_deinit(&reference);
    return known;
}
