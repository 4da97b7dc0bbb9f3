#include "run/run_pack.h"

#include "base/clock.h"
#include "run/run_rows.h"

#include <math.h>

/* Parts run side by side: the longest counts, and the sum of their processor times. */
static void pack_times(struct run *run, struct pack *pack)
{
    double wall = run->wall, cpu = run->cpu;
    pack_double(pack, "wall", &wall);
    pack_double(pack, "cpu", &cpu);
    run->wall = pack_adds(pack) ? fmax(run->wall, wall) : wall;
    run->cpu = pack_adds(pack) ? run->cpu + cpu : cpu;
}

static void pack_edges_cut(struct run *run, struct pack *pack)
{
    pack_sum_long(pack, "edges_cut", run->options->scene->edges_cut);
}

/* A part keeps snapshots as sums, which can be added up; so the file has sums where parts
 * were computed, and else pictures. Who wants sums and finds pictures goes on without; a
 * part other than the first forgets those of the whole. */
static void pack_past(struct run *run, struct pack *pack)
{
    struct past_snapshots other;
    int width = run->picture->width, height = run->picture->height;
    int count = run->past.count;
    pack_int(pack, "past_sums", &count, 0, FIXED_SUMS);
    if (count == run->past.count || !pack_ok(pack)) {
        past_snapshots_pack(pack, &run->past);
        return;
    }
    past_snapshots_init(&other, width, height, 0.0, count);
    past_snapshots_pack(pack, &other);
    past_snapshots_complete(&other, 1.0);
    if (run->past.count == 0)
        past_snapshots_take_pictures(&run->past, &other);
    else
        run->past.due = other.due;
    past_snapshots_deinit(&other);
}

void run_pack(struct run *run, struct pack *pack)
{
    pack_times(run, pack);
    pack_edges_cut(run, pack);
    pack_double(pack, "next_snapshot", &run->next_snapshot);
    pack_flag(pack, "more", &run->more);
    pack_past(run, pack);
    until_pack(pack, &run->until);
    run->type->methods->pack(run->integrator, pack);
}

bool run_add_part(struct run *run, struct pack *pack, struct run_part part,
                  struct err *err)
{
    pack_set_part(pack, part, true);
    run_pack(run, pack);
    return pack_close(pack, err);
}

void run_complete_parts(struct run *run, const bool *present, int all)
{
    int count = 0;
    for (int i = 0; i < all; i++)
        count += present[i];
    run->type->methods->complete(run->integrator, present, all);
    past_snapshots_complete(&run->past, (double)all / count);
}

bool run_write_checkpoint(struct run *run, bool last, struct err *err)
{
    const struct settings *settings = run->options->settings;
    struct run_statistics s;
    run->type->methods->statistics(run->integrator, &s);
    struct checkpoint_head head = {
        .budget_seconds = settings->seconds,
        .budget_mutations = settings->mutations_per_pixel,
        .seconds = run->wall,
        .mutations = s.paths / run_pixels(run),
        .started = run->type->methods->started(run->integrator),
        .finished = last && !(run->options->stop && *run->options->stop),
        .part = run->options->part,
    };
    struct pack *pack = checkpoint_create(run->options->checkpoint, &head, err);
    if (pack == NULL)
        return false;
    run_rows_pack(run, pack, true);
    run_pack(run, pack);
    bool ok = pack_close(pack, err);
    run->next_checkpoint = clock_wall() + run->options->checkpoint->every;
    return ok;
}

bool run_serve_checkpoint(struct run *run, bool last, struct err *err)
{
    bool due = run->options->checkpoint && (last || clock_wall() >= run->next_checkpoint);
    return !due || run_write_checkpoint(run, last, err);
}

bool run_resume(struct run *run, struct err *err)
{
    const struct run_options *o = run->options;
    struct pack *pack = o->resume->pack;
    bool ok = run_rows_pack(run, pack, false);
    run_pack(run, pack);
    o->resume->pack = NULL;
    if (!pack_close(pack, err) || !ok)
        return false;
    if (part_is_whole(o->resume->head.part) && o->part.index > 0)
        run->cpu = 0.0; /* the first part has that of the whole */
    if (o->resume->other_budget)
        run->more = run->type->methods->progress(run->integrator) < 1.0;
    return true;
}
