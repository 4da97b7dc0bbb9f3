/* The parts of a run, added up. */

#include "base/mem.h"
#include "run/run_pack.h"
#include "run/run_state.h"

/* Parts have no rows of an error log. */
static bool add_parts(struct run *run, struct checkpoint *parts, int count,
                      struct err *err)
{
    int all = parts[0].head.part.count;
    bool *present = mem_alloc((size_t)all, sizeof *present), ok = true;
    for (int i = 0; ok && i < count; i++) {
        long rows = 0;
        struct pack *pack = parts[i].pack;
        parts[i].pack = NULL;
        present[parts[i].head.part.index] = true;
        pack_long(pack, "rows", &rows, 0, 0);
        ok = run_add_part(run, pack, parts[i].head.part, err);
    }
    if (ok)
        run_complete_parts(run, present, all);
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
