#include "lab/reference_noise.h"

#include "base/doc.h"
#include "base/mem.h"
#include "base/text.h"
#include "image/exr.h"
#include "image/metric.h"
#include "lab/scalar.h"

#include <math.h>
#include <unistd.h>

#define TRIM_KEY   "relmse_trim"
#define WEIGHT_KEY "relmse_weight"
#define WEIGHT     "neighbours"

struct noise reference_noise_unknown(void)
{
    const double nan = (double)NAN;
    return (struct noise){nan, nan, nan, nan};
}

/* --- writing --------------------------------------------------------------------- */

static void append_figure(struct text *text, const char *key, double value)
{
    text_append(text, "%s: ", key);
    scalar_append_number(text, value);
    text_append(text, "\n");
}

bool reference_noise_write(const char *folder, const struct noise *noise, struct err *err)
{
    struct text text = {0};
    append_figure(&text, "rmse", noise->rmse);
    append_figure(&text, "relmse", noise->relmse);
    append_figure(&text, "relmse_se", noise->relmse_se);
    append_figure(&text, "relmse_trimmed", noise->relmse_trimmed);
    append_figure(&text, TRIM_KEY, 1.0 / METRIC_TRIM);
    text_append(&text, WEIGHT_KEY ": " WEIGHT "\n");
    char *path = text_join(folder, "noise.yaml");
    bool ok = text_write_file(path, text.data, text.length, err);
    mem_free(path);
    mem_free(text.data);
    return ok;
}

/* --- reading --------------------------------------------------------------------- */

static bool read_figure(const struct doc *doc, const char *key, double *value,
                        struct err *err)
{
    const struct doc_node *node = doc_get(doc_root(doc), key);
    struct place at = doc_place(doc_root(doc));
    if (node == NULL)
        return err_set(err, ERR_VALUE, &at,
                       "'%s' is missing: this is no noise of a "
                       "reference; remove its folder",
                       key);
    return doc_to_double(node, value, err);
}

/* Whether the figures are by the definition of this program. */
static bool is_todays(const struct doc *doc)
{
    double trim;
    const struct doc_node *share = doc_get(doc_root(doc), TRIM_KEY);
    const struct doc_node *weight = doc_get(doc_root(doc), WEIGHT_KEY);
    const char *text = weight ? doc_text(weight) : NULL;
    return share && doc_to_double(share, &trim, NULL) && trim == 1.0 / METRIC_TRIM &&
           text && text_equal(text, WEIGHT);
}

static bool take_from_half(const char *folder, const struct image *mean,
                           struct noise *noise, struct err *err)
{
    char *path = text_join(folder, "half1.exr");
    bool there = access(path, F_OK) == 0;
    struct image *half = there ? exr_read(path, NULL, err) : NULL;
    bool ok = !there || (half && noise_of_mean(half, mean, noise, err));
    image_destroy(half);
    mem_free(path);
    return ok;
}

bool reference_noise_read(const char *folder, const struct image *mean,
                          struct reference_noise *noise, struct err *err)
{
    struct noise *figures = &noise->noise;
    char *path = text_join(folder, "noise.yaml");
    struct doc *doc = doc_load(path, err);
    *noise = (struct reference_noise){.noise = reference_noise_unknown()};
    bool ok = doc && read_figure(doc, "rmse", &figures->rmse, err) &&
              read_figure(doc, "relmse", &figures->relmse, err);
    if (ok && is_todays(doc)) {
        ok = read_figure(doc, "relmse_se", &figures->relmse_se, err) &&
             read_figure(doc, "relmse_trimmed", &figures->relmse_trimmed, err);
    } else if (ok) {
        *noise = (struct reference_noise){reference_noise_unknown(), true};
        ok = take_from_half(folder, mean, figures, err);
    }
    doc_destroy(doc);
    mem_free(path);
    return ok;
}
