#include "report/report_pictures.h"

#include "base/json.h"
#include "base/mem.h"
#include "image/exr.h"
#include "image/preview.h"
#include "report/report_encode.h"
#include "report/report_reference.h"

#include <math.h>
#include <string.h>

/* Limit of the base64 text of all pictures: a page of 30 MB can still be mailed. */
#define MOST_BYTES ((size_t)24 << 20)

struct loader {
    const struct results *results;
    const char *references;
    struct report_pictures *pictures;
    struct log *log;
    size_t bytes;
};

static struct report_picture *add(struct report_pictures *pictures)
{
    pictures->items = mem_grow(pictures->items, &pictures->capacity, pictures->count + 1,
                               sizeof *pictures->items);
    struct report_picture *picture = &pictures->items[pictures->count++];
    *picture = (struct report_picture){.reference = -1};
    return picture;
}

/* Returns the length of its text. */
static size_t encode(const struct report_pictures *pictures,
                     struct report_picture *picture, const struct image *image)
{
    struct text base64 = {0};
    struct image *reduced = pictures->factor > 1 ? report_reduce(image, pictures->factor)
                                                 : NULL;
    const struct image *shown = reduced ? reduced : image;
    report_encode(shown, pictures->shift, &base64, &picture->exponent);
    picture->width = image->width;
    picture->height = image->height;
    picture->shown_width = shown->width;
    picture->shown_height = shown->height;
    picture->scale = preview_scale(image);
    picture->base64 = base64.data;
    image_destroy(reduced);
    return base64.length;
}

static struct image *read(struct loader *l, const char *path)
{
    struct err err = {0};
    struct image *image = exr_read(path, NULL, &err);
    if (image == NULL)
        log_note(l->log, NULL, "%s: the report does not show it", err.message);
    return image;
}

/* The index of the reference among the pictures, which are few; -1 if it has none. */
static int find_reference(struct loader *l, const struct results_cell *cell,
                          const struct results_run *run, const struct image *image)
{
    struct report_pictures *pictures = l->pictures;
    char *path = report_reference_find(l->results, cell, run, image, l->references);
    for (size_t i = 0; path && i < pictures->count; i++)
        if (pictures->items[i].cell == NULL &&
            text_equal(pictures->items[i].path, path)) {
            mem_free(path);
            return (int)i;
        }
    struct image *reference = path ? read(l, path) : NULL;
    if (reference == NULL || reference->width != image->width ||
        reference->height != image->height) {
        pictures->stranded += isfinite(run->error[RESULTS_RELMSE]) ? 1 : 0;
        image_destroy(reference);
        mem_free(path);
        return -1;
    }
    struct report_picture *picture = add(pictures);
    picture->name = text_copy("reference");
    picture->path = path;
    picture->scene = cell->scene;
    l->bytes += encode(pictures, picture, reference);
    image_destroy(reference);
    return (int)pictures->count - 1;
}

static void load_cell(struct loader *l, const struct results_cell *cell)
{
    const struct results_run *run = &cell->runs[0];
    char *path = results_picture(l->results, run);
    struct image *image = read(l, path);
    if (image == NULL) {
        l->pictures->missing++;
        mem_free(path);
        return;
    }
    int reference = find_reference(l, cell, run, image);
    char *budget = results_budget(cell);
    struct report_picture *picture = add(l->pictures);
    picture->name = text_format("%s, %s, seed %ld", cell->label, budget, run->seed);
    picture->path = path;
    picture->scene = cell->scene;
    picture->cell = cell;
    picture->reference = reference;
    l->bytes += encode(l->pictures, picture, image);
    mem_free(budget);
    image_destroy(image);
}

/* False if they exceed the limit; *bytes is then the extrapolated size of all. */
static bool load_all(struct loader *l, double *bytes)
{
    size_t done = 0, count = l->results->cell_count;
    while (done < count && l->bytes <= MOST_BYTES)
        load_cell(l, &l->results->cells[done++]);
    *bytes = (double)l->bytes * (double)count / (double)done;
    return l->bytes <= MOST_BYTES;
}

/* If the pictures take too much: first coarser values, then smaller pictures. */
void report_pictures_load(const struct results *results, const char *references,
                          struct report_pictures *pictures, struct log *log)
{
    int factor = 1, shift = 0;
    for (bool fits = false; !fits;) {
        struct log notes;
        double bytes;
        log_init(&notes);
        struct loader loader = {results, references, pictures, &notes, 0};
        report_pictures_deinit(pictures);
        pictures->factor = factor;
        pictures->shift = shift;
        fits = load_all(&loader, &bytes);
        if (shift > 0)
            factor += (int)ceil(factor * (sqrt(bytes / (double)MOST_BYTES) - 1.0));
        shift = REPORT_COARSE_SHIFT;
        if (fits)
            log_merge(log, &notes);
        log_deinit(&notes);
    }
}

void report_pictures_add(struct report_pictures *pictures, const char *name,
                         const struct image *image, const struct results_cell *cell,
                         int reference)
{
    struct report_picture *picture = add(pictures);
    picture->name = text_copy(name);
    picture->scene = "";
    picture->cell = cell;
    picture->reference = reference;
    encode(pictures, picture, image);
}

void report_pictures_deinit(struct report_pictures *pictures)
{
    for (size_t i = 0; i < pictures->count; i++) {
        mem_free(pictures->items[i].name);
        mem_free(pictures->items[i].path);
        mem_free(pictures->items[i].base64);
    }
    mem_free(pictures->items);
    *pictures = (struct report_pictures){0};
}

/* --- in the page ----------------------------------------------------------------- */

static void describe(struct json *json, const struct report_picture *picture, int shift)
{
    const struct results_cell *cell = picture->cell;
    double unknown = (double)NAN;
    json_open(json, NULL, '{');
    json_text(json, "name", picture->name);
    json_text(json, "scene", picture->scene);
    json_flag(json, "isReference", cell == NULL);
    json_flag(json, "biased", cell && cell->is_biased);
    json_count(json, "reference", picture->reference);
    json_count(json, "width", picture->shown_width);
    json_count(json, "height", picture->shown_height);
    json_count(json, "exponent", picture->exponent);
    json_count(json, "shift", shift);
    json_number(json, "scale", picture->scale);
    json_number(json, "relmse", cell ? cell->runs[0].error[RESULTS_RELMSE] : unknown);
    json_close(json, '{');
}

/* '<' occurs in strings alone, where it may be written thus; so no end tag can. */
static void append_guarded(struct text *html, const char *json)
{
    while (*json) {
        size_t plain = strcspn(json, "<");
        text_append(html, "%.*s", (int)plain, json);
        json += plain;
        if (*json) {
            text_append(html, "\\u003c");
            json++;
        }
    }
}

static struct json describe_all(const struct report_pictures *pictures)
{
    struct json json = {0};
    json_open(&json, NULL, '[');
    for (size_t i = 0; i < pictures->count; i++)
        describe(&json, &pictures->items[i], pictures->shift);
    json_close(&json, '[');
    return json;
}

void report_pictures_append(const struct report_pictures *pictures, struct text *html)
{
    struct json json = describe_all(pictures);
    text_append(html, "<script type=\"application/json\" id=\"pictures\">\n");
    append_guarded(html, json.text.data);
    text_append(html, "</script>\n");
    mem_free(json.text.data);
    for (size_t i = 0; i < pictures->count; i++)
        text_append(html,
                    "<script type=\"application/octet-stream\" id=\"picture-%zu\">%s"
                    "</script>\n",
                    i, pictures->items[i].base64);
}

void report_pictures_script(const struct report_pictures *pictures, struct text *script)
{
    struct json json = describe_all(pictures);
    text_append(script, "%s, [", json.text.data);
    mem_free(json.text.data);
    for (size_t i = 0; i < pictures->count; i++)
        text_append(script, "%s\"%s\"", i ? ",\n" : "", pictures->items[i].base64);
    text_append(script, "]");
}
