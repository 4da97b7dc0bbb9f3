#include "run/run_pack.h"

#include "base/clock.h"
#include "run/run_rows.h"

static void pack_run(struct run *run, struct pack *pack)
{
    pack_double(pack, "wall", &run->wall);
    pack_double(pack, "cpu", &run->cpu);
    pack_double(pack, "next_snapshot", &run->next_snapshot);
    pack_flag(pack, "more", &run->more);
    past_snapshots_pack(pack, &run->past);
    until_pack(pack, &run->until);
    run->type->methods->pack(run->integrator, pack);
}

static bool write_checkpoint(struct run *run, struct err *err)
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
    };
    struct pack *pack = checkpoint_create(run->options->checkpoint, &head, err);
    if (pack == NULL)
        return false;
    run_rows_pack(run, pack, true);
    pack_run(run, pack);
    bool ok = pack_close(pack, err);
    run->next_checkpoint = clock_wall() + run->options->checkpoint->every;
    return ok;
}

bool run_serve_checkpoint(struct run *run, bool last, struct err *err)
{
    bool due = run->options->checkpoint && (last || clock_wall() >= run->next_checkpoint);
    return !due || write_checkpoint(run, err);
}

bool run_resume(struct run *run, struct err *err)
{
    const struct run_options *o = run->options;
    struct pack *pack = o->resume->pack;
    bool ok = run_rows_pack(run, pack, false);
    pack_run(run, pack);
    o->resume->pack = NULL;
    if (!pack_close(pack, err) || !ok)
        return false;
    if (o->resume->other_budget)
        run->more = run->type->methods->progress(run->integrator) < 1.0;
    return true;
}
