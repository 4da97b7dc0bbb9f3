/* The parts of a run, added up. */

#include "base/mem.h"
#include "run/run_pack.h"
#include "run/run_state.h"

static bool add_part(struct run *run, struct checkpoint *part, struct err *err)
{
    struct pack *pack = part->pack;
    long rows = 0;
    pack_set_part(pack, part->head.part, true);
    pack_long(pack, "rows", &rows, 0, 0);
    run_pack(run, pack);
    part->pack = NULL;
    return pack_close(pack, err);
}

static bool add_parts(struct run *run, struct checkpoint *parts, int count,
                      struct err *err)
{
    int all = parts[0].head.part.count;
    bool *present = mem_alloc((size_t)all, sizeof *present), ok = true;
    for (int i = 0; ok && i < count; i++) {
        present[parts[i].head.part.index] = true;
        ok = add_part(run, &parts[i], err);
    }
    if (ok) {
        run->type->methods->complete(run->integrator, present, all);
        past_snapshots_complete(&run->past, (double)all / count);
    }
    mem_free(present);
    return ok;
}

bool run_merge(const struct run_options *options, struct checkpoint *parts, int count,
               struct run_result *result, struct err *err)
{
    struct run run = {.options = options, .parts = true};
    if (!run_begin(&run, result, err))
        return false;
    bool ok = add_parts(&run, parts, count, err);
    mem_release_reserve();
    if (ok)
        run_conclude(&run, result);
    else
        image_destroy(run.picture);
    run_end(&run);
    return ok;
}
