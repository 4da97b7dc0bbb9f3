#ifndef ETALON_REPORT_REPORT_PICTURES_H
#define ETALON_REPORT_REPORT_PICTURES_H

/* The pictures of the page: of each cell the one of its first seed, and its reference. */

#include "base/log.h"
#include "analysis/results.h"
#include "image/image.h"

struct report_picture {
    char *name;                      /* "pssmlt p_l=0.3, 5 s, seed 1"; "reference" */
    char *path;                      /* of the file */
    const char *scene;               /* label */
    const struct results_cell *cell; /* NULL: it is a reference */
    int reference;                   /* index of the picture to compare with; -1: none */
    int width, height;               /* of the file */
    int shown_width, shown_height;   /* in the page */
    double scale;                    /* to what preview.h shows */
    int exponent;                    /* of report/report_encode.h */
    char *base64;
};

/* A `shift` that leaves 7 bits, which resolve 0.4 %. */
#define REPORT_COARSE_SHIFT 4

/* Zero-initialise. */
struct report_pictures {
    struct report_picture *items; /* references stand before the first that needs them */
    size_t count, capacity;
    int shift;       /* bits of 11 that are left out */
    int factor;      /* blocks of factor x factor pixels are shown as one */
    size_t missing;  /* cells whose picture cannot be read */
    size_t stranded; /* pictures whose reference is missing */
};

/* references: folder of rendered references. Pictures that cannot be read are counted and
 * noted. */
void report_pictures_load(const struct results *results, const char *references,
                          struct report_pictures *pictures, struct log *log);
void report_pictures_deinit(struct report_pictures *pictures);
/* Adds one that is no file, and has no scene; `factor` is set. cell: of one run, whose
 * relMSE is shown beside the name, NULL: it is a reference. reference: index, or -1. */
void report_pictures_add(struct report_pictures *pictures, const char *name,
                         const struct image *image, const struct results_cell *cell,
                         int reference);

/* The script elements that hold them, and what the page's script is to know of them as an
 * element of JSON. */
void report_pictures_append(const struct report_pictures *pictures, struct text *html);
/* The same as two arguments of a function of a script: descriptions, contents. */
void report_pictures_script(const struct report_pictures *pictures, struct text *script);

#endif
