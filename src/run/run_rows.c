#include "run/run_rows.h"

#include "base/mem.h"

#include <limits.h>
#include <math.h>

#define SNAPSHOT_RATIO 1.25 /* next over last, in time */

/* A checkpoint contains the rows so far: rows that an interrupted run wrote after its
 * last checkpoint are dropped on resume. */
static bool report_row(struct run *run, const struct error_row *row)
{
    const struct run_options *o = run->options;
    if (o->checkpoint || o->resume) {
        run->rows = mem_grow(run->rows, &run->row_capacity, run->row_count + 1,
                             sizeof *run->rows);
        run->rows[run->row_count++] = *row;
    }
    run->last_row = row->wall_s;
    return o->on_error_row(o->hook_ctx, row);
}

static void take_figures(const struct run *run, const struct run_statistics *s,
                         struct error_row *row)
{
    row->paths = s->paths;
    row->mutations_per_pixel = s->paths / run_pixels(run);
    row->b = s->b;
    row->b_se = s->b_se;
    row->eta_s = run->type->methods->chains ? s->whole.eta_s : (double)NAN;
    row->eta_l = run->type->methods->chains ? s->whole.eta_l : (double)NAN;
    row->eta_0 = run->type->methods->chains ? s->whole.eta_0 : (double)NAN;
    row->acceptance = s->acceptance;
    row->failure_rate = s->failure_rate;
    row->nonfinite = s->nonfinite;
    row->saturated = s->saturated;
}

/* Measures the picture against the reference; false stops the run. */
bool run_error_row(struct run *run, struct err *err)
{
    const struct run_options *o = run->options;
    struct run_statistics s;
    struct error_row row = {.wall_s = run->wall, .cpu_s = run->cpu};
    if (o->reference == NULL || o->on_error_row == NULL || run->last_row == run->wall)
        return true;
    run->type->methods->picture(run->integrator, run->picture);
    run->type->methods->statistics(run->integrator, &s);
    take_figures(run, &s, &row);
    return metric_compare(run->picture, o->reference, &row.metric, err) &&
           report_row(run, &row);
}

void run_plan_row(struct run *run)
{
    double every = run->options->rows_every;
    if (every > 0.0)
        run->next_snapshot = run->wall + every - fmod(run->wall, every);
    while (every <= 0.0 && run->next_snapshot <= run->wall)
        run->next_snapshot *= SNAPSHOT_RATIO;
}

static void pack_row(struct pack *pack, struct error_row *row)
{
    struct metric *m = &row->metric;
    double *const values[] = {
        &row->wall_s,       &row->cpu_s,
        &row->paths,        &row->mutations_per_pixel,
        &m->mean_ratio,     &m->mean_ratio_r,
        &m->mean_ratio_g,   &m->mean_ratio_b,
        &m->rmse,           &m->relmse,
        &m->relmse_trimmed, &row->b,
        &row->b_se,         &row->eta_s,
        &row->eta_l,        &row->eta_0,
        &row->acceptance,   &row->failure_rate,
        &row->nonfinite,    &row->saturated,
    };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        pack_double(pack, "row", values[i]);
    pack_long(pack, "nonfinite", &m->nonfinite, 0, LONG_MAX);
}

bool run_rows_pack(struct run *run, struct pack *pack, bool write)
{
    const struct run_options *o = run->options;
    struct error_row row;
    bool ok = true;
    long rows = write ? (long)run->row_count : 0;
    pack_long(pack, "rows", &rows, 0, write ? rows : LONG_MAX);
    for (long i = 0; ok && pack_ok(pack) && i < rows; i++) {
        if (write)
            row = run->rows[i];
        pack_row(pack, &row);
        if (!write)
            ok = !pack_ok(pack) || o->on_error_row == NULL || report_row(run, &row);
    }
    return ok;
}
