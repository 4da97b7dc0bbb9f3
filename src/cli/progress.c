#include "cli/progress.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define BAR 20

bool progress_wanted(void)
{
    return isatty(STDERR_FILENO) != 0;
}

/* 1234567 -> "1.23 M". */
static void scaled(double value, char *text, size_t size)
{
    static const char *const units[] = {"", " k", " M", " G", " T", " P"};
    size_t unit = 0;
    while (value >= 1000.0 && unit + 1 < sizeof units / sizeof units[0]) {
        value /= 1000.0;
        unit++;
    }
    snprintf(text, size, "%.3g%s", value, units[unit]);
}

static void remaining(const struct run_progress *p, char *text, size_t size)
{
    double seconds = p->share > 0.0 ? p->wall_s * (1.0 - p->share) / p->share
                                    : (double)NAN;
    if (!(seconds < 3600000.0))
        snprintf(text, size, "--:--");
    else if (seconds < 3600.0)
        snprintf(text, size, "%02d:%02d", (int)seconds / 60, (int)seconds % 60);
    else
        snprintf(text, size, "%d:%02d h", (int)seconds / 3600, (int)seconds / 60 % 60);
}

static void chain_figures(const struct run_progress *p, char *text, size_t size)
{
    text[0] = '\0';
    if (isnan(p->p_large))
        return;
    if (p->started)
        snprintf(text, size, "  acc %.3f  p_l %.3f", p->acceptance, p->p_large);
    else
        snprintf(text, size, "  measured start");
}

/* BAR characters and a zero. */
static void draw_bar(double share, char *bar)
{
    int full = (int)(share * BAR);
    memset(bar, '-', BAR);
    memset(bar, '#', (size_t)(full < 0 ? 0 : full > BAR ? BAR : full));
    bar[BAR] = '\0';
}

void progress_show(const struct run_progress *p)
{
    char bar[BAR + 1], paths[32], rate[32], eta[32], chains[64];
    draw_bar(p->share, bar);
    scaled(p->paths, paths, sizeof paths);
    scaled(p->wall_s > 0.0 ? p->paths / p->wall_s : 0.0, rate, sizeof rate);
    remaining(p, eta, sizeof eta);
    chain_figures(p, chains, sizeof chains);
    fprintf(stderr, "\r[%s] %3.0f %%  %s  %s/s%s  ETA %s\033[K", bar, 100.0 * p->share,
            paths, rate, chains, eta);
    fflush(stderr);
}

void progress_show_load(const char *what, long done, long count)
{
    char bar[BAR + 1];
    draw_bar(count > 0 ? (double)done / (double)count : 0.0, bar);
    if (count > 0)
        fprintf(stderr, "\r[%s] %s, %ld of %ld files\033[K", bar, what, done, count);
    else
        fprintf(stderr, "\r%s\033[K", what);
    fflush(stderr);
}

void progress_clear(void)
{
    fputs("\r\033[K", stderr);
    fflush(stderr);
}
