#include "report/report.h"

#include "base/mem.h"
#include "build_info.h"
#include "image/exr.h"
#include "report/report_assets.h"
#include "report/report_html.h"
#include "report/report_parts.h"
#include "report/report_reference.h"

#include <string.h>

void report_append_lines(struct text *html, const char *const *lines)
{
    for (; *lines; lines++)
        text_append(html, "%s", *lines);
}

/* The experiment's name from an attribute of a picture; else the name of the folder. */
static char *name_of(const struct report *report)
{
    for (size_t i = 0; i < report->pictures.count; i++) {
        char *name = exr_read_attribute(report->pictures.items[i].path,
                                        "etalon:experiment");
        if (name)
            return name;
    }
    const char *folder = report->results->folder;
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    size_t begin = length;
    while (begin > 0 && folder[begin - 1] != '/')
        begin--;
    return text_copy_n(folder + begin, length - begin);
}

void report_append_head(struct text *html, const char *name, const char *kind)
{
    text_append(html, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n"
                      "<meta charset=\"utf-8\">\n"
                      "<meta name=\"viewport\" content=\"width=device-width, "
                      "initial-scale=1\">\n"
                      "<link rel=\"icon\" href=\"data:,\">\n<title>");
    html_text(html, name);
    text_append(html, " \u00b7 Etalon</title>\n<style>\n");
    report_append_lines(html, report_style);
    text_append(html,
                "</style>\n</head>\n<body>\n<header><div><p class=\"kind\">%s</p><h1>",
                kind);
    html_text(html, name);
    text_append(html, "</h1></div><button type=\"button\" id=\"theme\" hidden>"
                      "Colours: <span>system</span></button></header>\n");
}

void report_append_end(struct text *html, const char *maker,
                       const struct report_pictures *pictures, const char *const *more)
{
    text_append(html, "</main>\n<footer>%s, version ", maker);
    html_text(html, BUILD_COMMIT);
    text_append(html, ".</footer>\n");
    report_append_lines(html, report_comparer);
    report_pictures_append(pictures, html);
    text_append(html, "<script>\n\"use strict\";\n");
    report_append_lines(html, report_script);
    if (more)
        report_append_lines(html, more);
    text_append(html, "</script>\n</body>\n</html>\n");
}

static void append_navigation(struct report *report)
{
    struct text *html = &report->html;
    const struct results *results = report->results;
    int number = 0;
    text_append(html, "<nav aria-label=\"sections\"><a href=\"#outcome\">Outcome</a>"
                      "<a href=\"#run\">What was run</a>");
    for (size_t i = 0; i < results->cell_count; i++)
        if (report_begins_scene(results, i)) {
            text_append(html, "<a href=\"#scene-%d\">", number++);
            html_text(html, results->cells[i].scene);
            text_append(html, "</a>");
        }
    text_append(html, "</nav>\n<main>\n");
}

static void append_scenes(struct report *report)
{
    struct text *html = &report->html;
    const struct results *results = report->results;
    int number = 0;
    for (size_t i = 0; i < results->cell_count; i++) {
        const char *scene = results->cells[i].scene;
        if (!report_begins_scene(results, i))
            continue;
        text_append(html, "<section id=\"scene-%d\"><h2>", number++);
        html_text(html, scene);
        text_append(html, "</h2>\n");
        report_append_plots(report, scene);
        report_append_cells(report, scene);
        report_append_comparers(report, scene);
        report_append_layers(report, scene);
        text_append(html, "</section>\n");
    }
}

static void append_notes(struct report *report)
{
    struct text *html = &report->html;
    if (report->log->count == 0)
        return;
    text_append(html, "<section id=\"notes\"><h2>Notes</h2>\n<ul>\n");
    for (size_t i = 0; i < report->log->count; i++) {
        const struct log_note *note = &report->log->notes[i];
        text_append(html, "<li>");
        html_text(html, note->text);
        if (note->count > 1)
            text_append(html, " (%ld times)", note->count);
        text_append(html, "</li>\n");
    }
    text_append(html, "</ul></section>\n");
}

static void append_all(struct report *report)
{
    struct text *html = &report->html;
    char *name = name_of(report);
    report_append_head(html, name, "Etalon experiment");
    append_navigation(report);
    report_append_outcome(report);
    report_append_run(report);
    report_append_families(report);
    append_scenes(report);
    append_notes(report);
    report_append_end(html, "Written by <code>etalon report</code>", &report->pictures,
                      NULL);
    mem_free(name);
}

/* --- making it -------------------------------------------------------------------- */

static bool check(const struct report *report, struct err *err)
{
    const struct results *results = report->results;
    const char *baseline = report->options->baseline;
    if (results->cell_count == 0)
        return err_set(err, ERR_VALUE, &(struct place){results->runs->path, 0, 0},
                       "there are no finished runs in it yet");
    for (size_t i = 0; baseline && i < results->cell_count; i++)
        if (text_equal(results->cells[i].label, baseline))
            return true;
    return baseline == NULL ||
           err_set(err, ERR_USAGE, NULL,
                   "no cell has the label '%s'; labels are a column of '%s'", baseline,
                   results->runs->path);
}

static void note_what_is_left_out(const struct report *report)
{
    const struct results *results = report->results;
    if (results->superseded > 0)
        log_note(report->log, NULL,
                 "%zu rows of runs.csv are left out: later rows have the same cell and "
                 "seed, or other contents (scene, settings, reference)",
                 results->superseded);
    if (results->unreadable > 0)
        log_note(report->log, NULL,
                 "%zu rows of runs.csv are left out: they have no job or no seed",
                 results->unreadable);
    if (results->other_trim > 0)
        log_note(
            report->log, NULL,
            "the trimmed errors of %zu runs are left out: they are of a program that "
            "left out another share of the pixels (today 1 %%)",
            results->other_trim);
    if (results->curves == NULL)
        log_note(report->log, NULL, "there is no curves.csv: no error against time");
    if (report->pictures.stranded > 0)
        log_note(report->log, NULL,
                 "for %zu pictures the reference that they were measured against was not "
                 "found",
                 report->pictures.stranded);
    if (report->pictures.shift > 0)
        log_note(
            report->log, NULL,
            "the values of the page's pictures are rounded to %d bits, or it would be "
            "too large",
            11 - report->pictures.shift);
    if (report->pictures.factor > 1)
        log_note(report->log, NULL,
                 "the pictures of the page are smaller by %d in width and height, or the "
                 "page would be too large",
                 report->pictures.factor);
}

static void draw(struct report *report)
{
    struct err err = {0};
    report_queue_plots(report);
    if (!panels_draw(&report->panels, &err))
        log_note(report->log, NULL, "%s: the report has no plots", err.message);
}

/* Fills in the noise of references for tables that do not have it. */
static void fill_in_noise(struct report *report)
{
    for (size_t i = 0; i < report->pictures.count; i++) {
        const struct report_picture *picture = &report->pictures.items[i];
        if (picture->cell == NULL || picture->reference < 0)
            continue;
        struct results *results = report->results;
        struct results_cell *cell = &results->cells[picture->cell - results->cells];
        const char *path = report->pictures.items[picture->reference].path;
        double noise[RESULTS_ESTIMATED];
        if (cell->reference[0] != '\0' || !report_reference_noise(path, noise))
            continue;
        for (int e = 0; e < RESULTS_ESTIMATED; e++) {
            cell->noise[e] = noise[e];
            cell->noise_is_known[e] = true;
        }
    }
}

char *report_html(struct results *results, const struct report_options *options,
                  struct log *log, struct err *err)
{
    struct report report = {.options = options, .results = results, .log = log};
    if (!check(&report, err))
        return NULL;
    char *beside = text_join(results->folder, "../references");
    families_make(results, &report.families);
    report_pictures_load(results, options->references ? options->references : beside,
                         &report.pictures, log);
    fill_in_noise(&report);
    note_what_is_left_out(&report);
    draw(&report);
    append_all(&report);
    panels_deinit(&report.panels);
    report_pictures_deinit(&report.pictures);
    families_deinit(&report.families);
    mem_free(beside);
    return report.html.data;
}
