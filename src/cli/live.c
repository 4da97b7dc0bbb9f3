#include "cli/live.h"

#include "base/mem.h"
#include "base/text.h"
#include "cli/live_page.h"
#include "live/tev_link.h"

#include <stdio.h>

#define EVERY_DEFAULT 2.0     /* s */
#define EVERY_MOST    86400.0 /* s */
/* Of the run's CPU time, for each of two kinds of looks: they take below 1 % together. */
#define SHARE 0.004

struct live {
    struct tev_link *tev;   /* NULL: none */
    struct live_page *page; /* NULL: none */
    struct run_viewer viewer;
};

/* --- as the run calls --------------------------------------------------------------- */

static bool wanted(void *ctx)
{
    struct live *live = ctx;
    return (live->tev && tev_link_ready(live->tev)) ||
           (live->page && live_page_ready(live->page));
}

static void show(void *ctx, const struct run_result *now)
{
    struct live *live = ctx;
    if (live->tev && tev_link_ready(live->tev))
        tev_link_send(live->tev, now->image);
    if (live->page && live_page_ready(live->page))
        live_page_show(live->page, now, false);
}

static double cpu(void *ctx)
{
    struct live *live = ctx;
    return (live->tev ? tev_link_cpu(live->tev) : 0.0) +
           (live->page ? live_page_cpu(live->page) : 0.0);
}

/* --- begin and end ------------------------------------------------------------------ */

static bool read_every(const char *text, double *every, struct err *err)
{
    *every = EVERY_DEFAULT;
    return text == NULL ||
           (text_to_double(text, every) && *every > 0.0 && *every <= EVERY_MOST) ||
           err_set(err, ERR_USAGE, NULL,
                   "--view-every '%s': give a number of seconds above 0, at most a day "
                   "(%.0f)",
                   text, EVERY_MOST);
}

bool live_open(struct live **live, const struct args *args, const char *out,
               struct err *err)
{
    const char *tev = args_value(args, "tev"), *where = args_value(args, "live");
    const char *text = args_value(args, "view-every");
    double every;
    if (!read_every(text, &every, err))
        return false;
    if (tev == NULL && where == NULL)
        return text == NULL || err_set(err, ERR_USAGE, NULL,
                                       "--view-every needs a viewer: --tev HOST:PORT, or "
                                       "--live DIR|PORT");
    *live = mem_alloc(1, sizeof **live);
    (*live)->viewer = (struct run_viewer){every, SHARE, where != NULL, wanted,
                                          show,  cpu,   *live};
    if (tev && ((*live)->tev = tev_link_open(tev, out, err)) == NULL)
        return false;
    if (where && ((*live)->page = live_page_open(where, out, every, err)) == NULL)
        return false;
    if (where)
        fprintf(stderr, "live: %s\n", live_page_address((*live)->page));
    return true;
}

void live_give(struct live *live, const struct session *session,
               const struct image *reference, struct run_options *options)
{
    if (live == NULL)
        return;
    options->viewer = &live->viewer;
    if (live->page)
        live_page_begin(live->page, session, reference);
}

void live_conclude(struct live *live, const struct run_result *result)
{
    if (live && live->tev)
        tev_link_send(live->tev, result->image);
    if (live && live->page)
        live_page_show(live->page, result, true);
}

bool live_close(struct live *live, const struct err *failure)
{
    if (live == NULL)
        return true;
    if (live->tev)
        fprintf(stderr, "tev: %ld pictures sent\n", tev_link_close(live->tev));
    bool ended = live_page_close(live->page, failure);
    mem_free(live);
    return ended;
}
