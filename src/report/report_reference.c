#include "report/report_reference.h"

#include "base/doc.h"
#include "base/hash.h"
#include "base/mem.h"
#include "image/exr.h"
#include "image/metric.h"

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

static bool read_noise(const struct doc_node *root, double noise[RESULTS_ERRORS])
{
    double rmse;
    const struct doc_node *relmse = doc_get(root, "relmse");
    const struct doc_node *trimmed = doc_get(root, "relmse_trimmed");
    const struct doc_node *root_mean = doc_get(root, "rmse");
    if (!relmse || !trimmed || !root_mean ||
        !doc_to_double(relmse, &noise[RESULTS_RELMSE], NULL) ||
        !doc_to_double(trimmed, &noise[RESULTS_RELMSE_TRIMMED], NULL) ||
        !doc_to_double(root_mean, &rmse, NULL))
        return false;
    noise[RESULTS_MSE] = rmse * rmse;
    return true;
}

bool report_reference_noise(const char *reference, double noise[RESULTS_ERRORS])
{
    char *folder = text_directory(reference), *path = text_join(folder, "noise.yaml");
    struct doc *doc = access(path, R_OK) == 0 ? doc_load(path, NULL) : NULL;
    bool known = doc && doc_kind(doc_root(doc)) == DOC_MAP &&
                 read_noise(doc_root(doc), noise);
    doc_destroy(doc);
    mem_free(folder);
    mem_free(path);
    return known;
}
