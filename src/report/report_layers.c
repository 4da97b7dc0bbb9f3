/* The layers of pictures (docs/layers.md) in the page: maps in false colours with a
 * legend, pictures of light as the whole picture is shown, features as they are. Each is
 * a PNG in the page, of full size: the limit of report_pictures.c does not count them. */

#include "base/mem.h"
#include "image/exr.h"
#include "image/preview.h"
#include "report/report_encode.h"
#include "report/report_html.h"
#include "report/report_parts.h"

#include <math.h>
#include <stdio.h>

/* How a layer is drawn. */
enum look {
    LOOK_SHARE,    /* a value in [0,1]; below 0: nothing was there */
    LOOK_RELATIVE, /* a value over its mean, logarithmic from 1/RELATIVE to RELATIVE */
    LOOK_LIGHT,    /* radiance, exposed like the whole picture */
    LOOK_COLOUR,   /* in [0,1] */
    LOOK_NORMAL,   /* in [-1,1] */
    LOOK_DEPTH,    /* up to its largest value */
};

#define RELATIVE 16.0

struct kind {
    const char *name, *caption;
    enum look look;
};

static const struct kind maps[] = {
    {"acceptance_small", "acceptance of small steps from here", LOOK_SHARE},
    {"acceptance_large", "acceptance of large steps from here", LOOK_SHARE},
    {"failures", "share of proposals or samples without light", LOOK_SHARE},
    {"visits", "where chains are, over the mean", LOOK_RELATIVE},
    {"work", "work, over the mean", LOOK_RELATIVE},
    {"albedo", "albedo", LOOK_COLOUR},
    {"normal", "normal, (n + 1)/2", LOOK_NORMAL},
    {"depth", "depth, black to white: 0 to the largest", LOOK_DEPTH},
};

/* Colours from low to high, linear between them; the legend (report.css) has these
 * and the middles between them, in sRGB. */
static const struct rgb ramp[] = {
    {0.00, 0.00, 0.01}, {0.10, 0.01, 0.18}, {0.50, 0.03, 0.13},
    {0.93, 0.20, 0.02}, {0.98, 0.98, 0.40},
};
#define RAMP ((int)(sizeof ramp / sizeof *ramp))

static struct rgb false_colour(double x)
{
    double at = fmin(fmax(x, 0.0), 1.0) * (RAMP - 1);
    int i = (int)fmin(at, RAMP - 2.0);
    double t = at - i;
    return rgb_add(rgb_scale(ramp[i], 1.0 - t), rgb_scale(ramp[i + 1], t));
}

static double largest(const struct image *image)
{
    double most = 0.0;
    for (long i = 0; i < 3L * image->width * image->height; i++)
        most = fmax(most, (double)image->pixels[i]);
    return most;
}

static struct rgb colour_of(enum look look, struct rgb v, double most)
{
    switch (look) {
    case LOOK_SHARE:
        return v.r < 0.0 ? rgb(0.05, 0.05, 0.12) : false_colour(v.r);
    case LOOK_RELATIVE:
        return false_colour(0.5 + 0.5 * log(fmax(v.r, 1e-9)) / log(RELATIVE));
    case LOOK_NORMAL:
        return rgb(0.5 * v.r + 0.5, 0.5 * v.g + 0.5, 0.5 * v.b + 0.5);
    case LOOK_DEPTH:
        return rgb_scale(v, most > 0.0 ? 1.0 / most : 0.0);
    default:
        return v;
    }
}

/* exposure: in stops, of pictures of light. */
static void append_picture(struct text *html, struct image *image, enum look look,
                           double exposure, const char *caption)
{
    double most = largest(image);
    struct text png = {0};
    for (long i = 0; i < (long)image->width * image->height; i++) {
        struct rgb c = colour_of(look, image_pixel(image, i), most);
        image->pixels[3 * i] = (float)c.r;
        image->pixels[3 * i + 1] = (float)c.g;
        image->pixels[3 * i + 2] = (float)c.b;
    }
    if (preview_append_png(&png, image, look == LOOK_LIGHT ? exposure : 0.0)) {
        text_append(html, "<figure><img alt=\"");
        html_text(html, caption);
        text_append(html,
                    "\" width=\"%d\" height=\"%d\" "
                    "src=\"data:image/png;base64,",
                    image->width, image->height);
        report_append_base64(html, (const unsigned char *)png.data, png.length);
        text_append(html, "\"><figcaption>");
        html_text(html, caption);
        text_append(html, "</figcaption></figure>\n");
    }
    mem_free(png.data);
}

/* Returns whether the file has that layer. */
static bool append_layer(struct text *html, const struct exr_file *file, const char *name,
                         const char *caption, enum look look, double exposure)
{
    struct image *image = exr_layer(file, name);
    if (image == NULL)
        return false;
    append_picture(html, image, look, exposure, caption);
    image_destroy(image);
    return true;
}

/* Lengths that have a layer of their own begin at 1. */
static bool append_lengths(struct text *html, const struct exr_file *file,
                           double exposure)
{
    bool any = false, found = true;
    char name[64], caption[64];
    for (int k = 1; found; k++) {
        snprintf(name, sizeof name, "length_%d", k);
        snprintf(caption, sizeof caption, "light of paths of %d edges", k);
        found = append_layer(html, file, name, caption, LOOK_LIGHT, exposure);
        any |= found;
    }
    return append_layer(html, file, "length_rest", "light of longer paths", LOOK_LIGHT,
                        exposure) ||
           any;
}

/* The techniques of one length; whether there is any. */
static bool append_row(struct text *html, const struct exr_file *file, const char *prefix,
                       int length, double exposure)
{
    struct text row = {0};
    bool any = false;
    char name[64], caption[64];
    for (int s = 0; s <= length; s++) {
        int t = length + 1 - s;
        snprintf(name, sizeof name, "%s_s%d_t%d", prefix, s, t);
        snprintf(caption, sizeof caption, "%s, s = %d, t = %d", prefix, s, t);
        any |= append_layer(&row, file, name, caption, LOOK_LIGHT, exposure);
    }
    if (any)
        text_append(html, "<div class=\"layers\">\n%s</div>\n", row.data);
    mem_free(row.data);
    return any;
}

/* A row a length, as [Veach97] shows the pyramid. */
static bool append_pyramid(struct text *html, const struct exr_file *file,
                           const char *prefix, double exposure)
{
    int k = 1;
    while (append_row(html, file, prefix, k, exposure))
        k++;
    return k > 1;
}

static const char legend[] =
    "<p class=\"layers-legend\"><span>0</span><i></i><span>1</span> shares; <span>1/16"
    "</span><i></i><span>16</span> times the mean, logarithmic, 1 in the middle. Dark "
    "blue: nothing was proposed from there. Light is exposed like the whole picture.</p>";

static void append_cell(struct text *html, const struct report_picture *picture)
{
    struct exr_file *file = exr_open(picture->path);
    struct text body = {0};
    bool any = false;
    if (file == NULL)
        return;
    double exposure = log2(picture->scale);
    text_append(&body, "<h3>Layers: ");
    html_text(&body, picture->name);
    text_append(&body, "</h3>\n%s<div class=\"layers\">\n", legend);
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        any |= append_layer(&body, file, maps[i].name, maps[i].caption, maps[i].look,
                            0.0);
    any |= append_lengths(&body, file, exposure);
    text_append(&body, "</div>\n");
    any |= append_pyramid(&body, file, "technique", exposure);
    any |= append_pyramid(&body, file, "unweighted", exposure);
    if (any)
        text_append(html, "%s", body.data);
    mem_free(body.data);
    exr_close(file);
}

void report_append_layers(struct report *report, const char *scene)
{
    const struct report_pictures *pictures = &report->pictures;
    for (size_t i = 0; i < pictures->count; i++)
        if (pictures->items[i].cell && text_equal(pictures->items[i].scene, scene))
            append_cell(&report->html, &pictures->items[i]);
}
