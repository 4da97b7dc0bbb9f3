#ifndef ETALON_REPORT_REPORT_LIVE_H
#define ETALON_REPORT_REPORT_LIVE_H

/* The page of a run that is still going, from the parts of the report: the picture and
 * its error bars, error against time, the verdict and the statistics. It consists of
 * several documents, so that a browser fetches what is new alone, from a server or from
 * files: the page, once; the state, again and again; each picture, when it is another.
 * All but the first are scripts, as pages that are files may load no other data. */

#include "lab/statistics.h"

enum report_live_shown { LIVE_PICTURE, LIVE_REFERENCE, LIVE_BARS, LIVE_PICTURES };

/* Names of the documents. */
#define REPORT_LIVE_PAGE  "index.html"
#define REPORT_LIVE_STATE "live.js"
extern const char *const report_live_pictures[LIVE_PICTURES];

/* A moment of the run. */
struct report_live_point {
    double wall;     /* s of rendering */
    double bars;     /* relMSE by the run's own error bars; NAN: not known */
    double measured; /* relMSE against the reference; NAN: there is none */
};

struct report_live {
    /* The looks from which the pictures are, from 1 on; 0: there is none yet. */
    long pictures[LIVE_PICTURES];
    const char *run; /* differs between runs: a page shows one of them alone */
    bool ended;
    const char *status;  /* one line: how far it is */
    const char *summary; /* figures as the program prints them at the end */
    const struct statistics_record *record; /* NULL: nothing to see yet */
    double verdict_wall; /* s of rendering at the record's verdict; 0: there is none */
    /* Error against time; one that is not known is not drawn. */
    const struct report_live_point *points;
    size_t point_count;
};

/* name: of the run. every: s between two questions for the state. */
void report_live_page(const char *name, double every, struct text *html);
void report_live_state(const struct report_live *look, struct text *script);

/* A picture of a look. relmse: of the picture, to be told beside it, or NAN; biased: it
 * does not converge to the truth; referred: there is a reference. */
struct report_live_picture {
    enum report_live_shown shown;
    long number;
    const struct image *image;
    double relmse;
    bool biased, referred;
};
void report_live_picture(const struct report_live_picture *picture, struct text *script);
/* Error bars (standard errors of luminance, [height][width]) as a picture that is as
 * bright as `like`. */
void report_live_bars(const float *se, const struct image *like, long number,
                      struct text *script);

#endif
