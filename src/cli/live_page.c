#include "cli/live_page.h"

#include "base/mem.h"
#include "cli/summary.h"
#include "live/mailbox.h"
#include "live/site.h"
#include "report/report_live.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define POINT_RATIO 1.02 /* least ratio of the times of two points of the plot */
#define PATIENCE    10.0 /* s for the last look to be published */
#define ASK_MOST    1.0  /* s between two questions of a viewer, at most */
#define LATE        3.5  /* s by which a viewer that loads a picture asks later */
#define LINGER      1.5  /* s for viewers to see the end, at most */
#define SCRIPT      "text/javascript; charset=utf-8"

struct live_page {
    struct site *site;
    struct mailbox *mailbox;
    const struct session *session;
    const struct image *reference;
    char run[32]; /* tells this run from others that publish there */
    double ask;   /* s between two questions of a viewer */
    long looks;
    bool concluded; /* a look at the end was taken */
    /* Of the thread: */
    bool failed; /* an error was told: it is not repeated */
    long pictures[LIVE_PICTURES];
    struct verdict verdict; /* the last one, without its layers */
    double verdict_wall;
    /* Moments of the run for the plot, the newest replaced until it is far enough from
     * the one before. */
    struct report_live_point *points;
    size_t count, capacity;
};

/* A look at the run: its results, with a picture and error bars of its own. */
struct look {
    struct run_result result;
    long number;
    bool ended;
};

static void look_destroy(void *item)
{
    struct look *look = item;
    image_destroy(look->result.image);
    mem_free(look->result.verdict.se);
    mem_free(look);
}

static float *copy_of(const float *values, size_t count)
{
    float *copy = values ? mem_alloc(count, sizeof *copy) : NULL;
    if (values)
        memcpy(copy, values, count * sizeof *copy);
    return copy;
}

static struct look *look_create(const struct run_result *now)
{
    struct look *look = mem_alloc(1, sizeof *look);
    size_t pixels = (size_t)now->image->width * (size_t)now->image->height;
    look->result = *now;
    look->result.layers = (struct layers){0};
    look->result.image = image_copy(now->image);
    look->result.verdict.se = copy_of(now->verdict.se, pixels);
    look->result.verdict.rhat = look->result.verdict.ess = NULL;
    return look;
}

/* --- on the thread ----------------------------------------------------------------- */

static void publish(struct live_page *page, const char *name, struct text *text)
{
    struct err err = {0};
    if (site_publish(page->site, name, SCRIPT, text, &err) || page->failed)
        return;
    page->failed = true;
    fprintf(stderr, "warning: --live: %s\n", err.message);
}

static void publish_live(struct live_page *page, const struct report_live *live)
{
    struct text state = {0};
    report_live_state(live, &state);
    publish(page, REPORT_LIVE_STATE, &state);
}

static void add_point(struct live_page *page, const struct run_result *now,
                      const struct metric *metric)
{
    struct report_live_point *points = page->points;
    size_t count = page->count;
    bool close = count > 1 && now->seconds_total < POINT_RATIO * points[count - 2].wall;
    page->points = mem_grow(points, &page->capacity, count + 1, sizeof *points);
    page->count = close ? count : count + 1;
    page->points[page->count - 1] = (struct report_live_point){
        .wall = now->seconds_total,
        .bars = now->verdict.se ? now->verdict.relmse : (double)NAN,
        .measured = metric ? metric->relmse : (double)NAN,
    };
}

static char *status_of(const struct look *look, const struct settings *settings)
{
    const struct run_result *now = &look->result;
    double mpp = now->mutations_per_pixel;
    char *budget = settings->seconds > 0.0
                       ? text_format("%.0f s", settings->seconds)
                       : text_format("%.4g per pixel", settings->mutations_per_pixel);
    char *status = text_format(
        "%s: %.4g %s per pixel in %.3g s of rendering; the budget is %s. Look %ld.",
        look->ended ? "Ended" : "Running", mpp,
        now->statistics.chains > 0 ? "mutations" : "samples", now->seconds_total, budget,
        look->number);
    mem_free(budget);
    return status;
}

static char *summary_of(const struct statistics_record *record,
                        const struct metric *metric)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL)
        return NULL;
    summary_print(record, metric, out);
    fclose(out);
    return text;
}

static void publish_picture(struct live_page *page, const struct report_live_picture *p)
{
    struct text script = {0};
    report_live_picture(p, &script);
    page->pictures[p->shown] = p->number;
    publish(page, report_live_pictures[p->shown], &script);
}

/* What a verdict gives: error bars, and a point of the plot. */
static void take_verdict(struct live_page *page, const struct look *look,
                         const struct metric *metric)
{
    struct text bars = {0};
    const struct verdict *verdict = &look->result.verdict;
    page->verdict = *verdict;
    page->verdict.se = NULL;
    page->verdict_wall = look->result.seconds_total;
    add_point(page, &look->result, metric);
    if (verdict->se == NULL)
        return;
    report_live_bars(verdict->se, look->result.image, look->number, &bars);
    page->pictures[LIVE_BARS] = look->number;
    publish(page, report_live_pictures[LIVE_BARS], &bars);
}

static void publish_pictures(struct live_page *page, const struct look *look,
                             const struct statistics_record *record,
                             const struct metric *metric)
{
    struct report_live_picture picture = {
        .shown = LIVE_PICTURE,
        .number = look->number,
        .image = look->result.image,
        .relmse = metric ? metric->relmse : (double)NAN,
        .biased = record->biased,
        .referred = page->reference != NULL,
    };
    struct report_live_picture reference = {
        .shown = LIVE_REFERENCE,
        .number = 1,
        .image = page->reference,
    };
    publish_picture(page, &picture);
    if (page->reference && page->pictures[LIVE_REFERENCE] == 0)
        publish_picture(page, &reference);
}

/* After the pictures, which it names. */
static void publish_state(struct live_page *page, const struct look *look,
                          const struct statistics_record *record,
                          const struct metric *metric)
{
    char *status = status_of(look, &record->settings);
    char *summary = summary_of(record, metric);
    struct report_live live = {
        .run = page->run,
        .ended = look->ended,
        .status = status,
        .summary = summary,
        .record = record,
        .verdict_wall = page->verdict_wall,
        .points = page->points,
        .point_count = page->count,
    };
    memcpy(live.pictures, page->pictures, sizeof live.pictures);
    publish_live(page, &live);
    mem_free(status);
    free(summary);
}

static void work(void *ctx, void *item)
{
    struct live_page *page = ctx;
    struct look *look = item;
    const struct session *session = page->session;
    struct statistics_record record;
    struct metric metric;
    struct err err = {0};
    const struct metric *measured = NULL;
    if (page->reference &&
        metric_compare(look->result.image, page->reference, &metric, &err))
        measured = &metric;
    if (look->result.verdict.words[0] || look->result.verdict.call != VERDICT_NONE)
        take_verdict(page, look, measured);
    statistics_record_init(&record, &look->result, &session->settings, session->scene,
                           session->left_out);
    record.seconds_load = session->load_seconds;
    record.run.verdict = page->verdict;
    record.verdict = verdict_name(page->verdict.call);
    publish_pictures(page, look, &record, measured);
    publish_state(page, look, &record, measured);
    look_destroy(look);
}

/* --- for the run -------------------------------------------------------------------- */

/* The page before there is anything to see; fails if it cannot be published. */
static bool publish_first(struct live_page *page, const char *name, struct err *err)
{
    struct text html = {0}, state = {0};
    struct report_live none = {.run = page->run, .status = "The scene is being read."};
    report_live_page(name, page->ask, &html);
    if (!site_publish(page->site, REPORT_LIVE_PAGE, "text/html; charset=utf-8", &html,
                      err))
        return false;
    report_live_state(&none, &state);
    return site_publish(page->site, REPORT_LIVE_STATE, SCRIPT, &state, err);
}

struct live_page *live_page_open(const char *where, const char *name, double every,
                                 struct err *err)
{
    struct live_page *page = mem_alloc(1, sizeof *page);
    struct mailbox_work job = {work, look_destroy, page, 0.0};
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    snprintf(page->run, sizeof page->run, "%llx.%lx", (unsigned long long)now.tv_sec,
             (unsigned long)now.tv_nsec);
    page->ask = fmin(every, ASK_MOST);
    page->site = site_open(where, err);
    if (page->site && publish_first(page, name, err))
        page->mailbox = mailbox_create(&job, err);
    if (page->mailbox)
        return page;
    live_page_close(page, NULL);
    return NULL;
}

const char *live_page_address(const struct live_page *page)
{
    return site_address(page->site);
}

void live_page_begin(struct live_page *page, const struct session *session,
                     const struct image *reference)
{
    struct report_live none = {.run = page->run,
                               .status = "Running; there is no picture yet: looks at the "
                                         "run may take less than 1 % of its time."};
    page->session = session;
    page->reference = reference;
    publish_live(page, &none);
}

/* Somebody looks at the page, as far as can be known. */
static bool watched(struct live_page *page)
{
    return site_watched(page->site, REPORT_LIVE_STATE, page->ask + LATE);
}

bool live_page_ready(struct live_page *page)
{
    return mailbox_idle(page->mailbox) && watched(page);
}

void live_page_show(struct live_page *page, const struct run_result *now, bool ended)
{
    page->concluded = ended;
    if (!watched(page)) /* at the end: it goes with the server */
        return;
    struct look *look = look_create(now);
    look->number = ++page->looks;
    look->ended = ended;
    mailbox_put(page->mailbox, look);
}

double live_page_cpu(struct live_page *page)
{
    return mailbox_cpu(page->mailbox) + site_cpu(page->site);
}

/* The end of a run that has no result. */
static void publish_failure(struct live_page *page, const struct err *why)
{
    char line[sizeof why->file + sizeof why->message + 64];
    err_format(why, line, (int)sizeof line);
    char *status = text_format("Failed: %s", line);
    struct report_live failed = {.run = page->run, .ended = true, .status = status};
    memcpy(failed.pictures, page->pictures, sizeof failed.pictures);
    publish_live(page, &failed);
    mem_free(status);
}

/* Until a viewer has what the last look changed. */
static void linger(struct live_page *page)
{
    const char *names[LIVE_PICTURES + 2] = {REPORT_LIVE_STATE};
    int count = 1;
    for (int i = 0; i < LIVE_PICTURES; i++)
        if (page->looks > 0 && page->pictures[i] == page->looks)
            names[count++] = report_live_pictures[i];
    site_linger(page->site, names, LINGER);
}

bool live_page_close(struct live_page *page, const struct err *failure)
{
    if (page == NULL)
        return true;
    if (!mailbox_destroy(page->mailbox, PATIENCE)) {
        fprintf(stderr,
                "warning: --live: the last look took more than %g s and is left "
                "out\n",
                PATIENCE);
        return false;
    }
    if (failure && page->site && !page->concluded)
        publish_failure(page, failure);
    if (page->site && watched(page))
        linger(page);
    site_close(page->site);
    mem_free(page->points);
    mem_free(page);
    return true;
}
