#include "report/report_live.h"

#include "base/json.h"
#include "base/mem.h"
#include "image/preview.h"
#include "report/report_assets.h"
#include "report/report_html.h"
#include "report/report_parts.h"

#include <math.h>
#include <string.h>

/* --- the page --------------------------------------------------------------------- */

void report_live_page(const char *name, double every, struct text *html)
{
    report_append_head(html, name, "Etalon run");
    text_append(html, "<main id=\"live\" data-every=\"%.9g\">\n", every);
    report_append_lines(html, report_live_body);
    report_append_end(html, "Etalon", &(struct report_pictures){0}, report_live_script);
}

/* --- the state -------------------------------------------------------------------- */

static void append_statistics(struct text *html, const struct statistics_record *record)
{
    int count;
    struct exr_attribute *attributes = statistics_attributes(record, &count);
    text_append(html, "<table><thead><tr><th scope=\"col\">name</th>"
                      "<th scope=\"col\">value</th></tr></thead><tbody>\n");
    for (int i = 0; i < count; i++) {
        const char *colon = strchr(attributes[i].name, ':');
        text_append(html, "<tr><td>");
        html_text(html, colon ? colon + 1 : attributes[i].name);
        text_append(html, "</td>");
        html_cell_sentence(html, attributes[i].value);
        text_append(html, "</tr>\n");
    }
    text_append(html, "</tbody></table>\n");
    statistics_attributes_destroy(attributes, count);
}

static void append_verdict(struct text *html, const struct report_live *look)
{
    const struct verdict *v = &look->record->run.verdict;
    if (look->verdict_wall == 0.0) {
        text_append(html, "None yet.");
        return;
    }
    text_append(html, "At %.3g s: <b>", look->verdict_wall);
    html_text(html, look->record->verdict);
    text_append(html, "</b>%s", v->words[0] ? ": " : "");
    html_text(html, v->words);
    if (!(v->relmse > 0.0))
        return;
    text_append(html, "%srelMSE ", v->words[0] ? ". " : ": ");
    html_figure(html, v->relmse, HTML_SIGNIFICANT);
    text_append(html, " \u00b1 ");
    html_figure(html, v->relmse_se, HTML_SIGNIFICANT);
    text_append(html, " by %d parts of the run.", v->replicas);
}

static void add_html(struct json *json, const char *key, struct text *html)
{
    json_text(json, key, html->data ? html->data : "");
    mem_free(html->data);
    *html = (struct text){0};
}

static void append_point(struct json *json, const struct report_live_point *point)
{
    json_open(json, NULL, '[');
    json_number(json, NULL, point->wall);
    json_number(json, NULL, point->bars);
    json_number(json, NULL, point->measured);
    json_close(json, '[');
}

static void append_state(struct json *json, const struct report_live *look)
{
    struct text html = {0};
    append_verdict(&html, look);
    add_html(json, "verdict", &html);
    append_statistics(&html, look->record);
    add_html(json, "statistics", &html);
    json_text(json, "summary", look->summary);
    json_open(json, "points", '[');
    for (size_t i = 0; i < look->point_count; i++)
        append_point(json, &look->points[i]);
    json_close(json, '[');
}

void report_live_state(const struct report_live *look, struct text *script)
{
    struct json json = {0};
    json_open(&json, NULL, '{');
    json_text(&json, "run", look->run);
    json_flag(&json, "ended", look->ended);
    json_text(&json, "status", look->status);
    json_open(&json, "pictures", '[');
    for (int i = 0; i < LIVE_PICTURES; i++)
        json_count(&json, NULL, look->pictures[i]);
    json_close(&json, '[');
    if (look->record)
        append_state(&json, look);
    json_close(&json, '{');
    text_append(script, "etalonState(%s);\n", json.text.data);
    mem_free(json.text.data);
}

/* --- pictures --------------------------------------------------------------------- */

const char *const report_live_pictures[LIVE_PICTURES] = {
    [LIVE_PICTURE] = "picture.js",
    [LIVE_REFERENCE] = "reference.js",
    [LIVE_BARS] = "bars.js",
};

/* As small as they get while a difference of 0.4 % is still seen. */
static void append_picture(enum report_live_shown shown, long number, const char *name,
                           const struct image *image, const struct results_cell *cell,
                           int reference, struct text *script)
{
    struct report_pictures one = {.factor = 1, .shift = REPORT_COARSE_SHIFT};
    report_pictures_add(&one, name, image, cell, reference);
    text_append(script, "etalonPicture(%d, %ld, ", (int)shown, number);
    report_pictures_script(&one, script);
    text_append(script, ");\n");
    report_pictures_deinit(&one);
}

void report_live_picture(const struct report_live_picture *p, struct text *script)
{
    struct results_run run = {.error[RESULTS_RELMSE] = p->relmse};
    struct results_cell cell = {.scene = "", .runs = &run, .is_biased = p->biased};
    bool reference = p->shown == LIVE_REFERENCE;
    append_picture(p->shown, p->number, reference ? "reference" : "picture", p->image,
                   reference ? NULL : &cell, p->referred ? LIVE_REFERENCE : -1, script);
}

/* A power of two by which error bars are shown as bright as the picture. */
static double gain_of(const struct image *bars, const struct image *picture)
{
    double ratio = preview_scale(bars) / preview_scale(picture);
    return ratio > 0.0 && isfinite(ratio) ? exp2(rint(log2(ratio))) : 1.0;
}

void report_live_bars(const float *se, const struct image *like, long number,
                      struct text *script)
{
    struct results_run run = {.error[RESULTS_RELMSE] = (double)NAN};
    struct results_cell cell = {.scene = "", .runs = &run};
    struct image *bars = image_create_like(like);
    long values = 3L * bars->width * bars->height;
    for (long i = 0; i < values; i++)
        bars->pixels[i] = se[i / 3];
    double gain = gain_of(bars, like);
    for (long i = 0; i < values; i++)
        bars->pixels[i] *= (float)gain;
    char *name = text_format("standard error \u00d7 %g", gain);
    append_picture(LIVE_BARS, number, name, bars, &cell, -1, script);
    mem_free(name);
    image_destroy(bars);
}
