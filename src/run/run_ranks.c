#include "run/run_ranks.h"

#include "base/mem.h"
#include "base/ranks.h"
#include "run/run_pack.h"
#include "run/run_rows.h"
#include "run/run_view.h"

bool run_ranks_agree(struct run *run, unsigned own, struct err *err)
{
    const struct checkpoint_options *checkpoint = run->options->checkpoint;
    run->due = own;
    if (ranks_agree(&run->due, run->options->stop))
        return true;
    return err_set(err, ERR_IO, NULL, "rank %d: another rank is gone; %s%s", ranks_own(),
                   checkpoint ? "the last checkpoint is " : "there is no checkpoint",
                   checkpoint ? checkpoint->path : "");
}

static bool pack_own(struct run *run, struct text *bytes, struct err *err)
{
    struct pack *pack = pack_create_memory(CHECKPOINT_LAYOUT, err);
    if (pack == NULL)
        return false;
    pack_set_part(pack, run->options->part, false);
    run_pack(run, pack);
    return pack_close_memory(pack, bytes, err);
}

struct adding {
    struct run *whole;
    int count;
    double bytes;
    struct err *err;
};

static bool add(void *ctx, int rank, const struct text *bytes)
{
    struct adding *adding = ctx;
    struct pack *pack = pack_open_memory(bytes, CHECKPOINT_LAYOUT, adding->err);
    if (pack == NULL)
        return false;
    adding->bytes += rank > 0 ? (double)bytes->length : 0.0;
    return run_add_part(adding->whole, pack, (struct run_part){rank, adding->count},
                        adding->err);
}

/* What rank 0 does with the sum of all; the rows of the error log stay with its own run.
 */
static bool serve_whole(struct run *run, struct run *whole, struct run_result *result,
                        struct err *err)
{
    bool last = result != NULL, ok = true;
    whole->rows = run->rows;
    whole->row_count = run->row_count;
    whole->row_capacity = run->row_capacity;
    whole->last_row = run->last_row;
    whole->wall = run->wall;
    if (!last && run->due & RANKS_VIEW)
        run_view(run, whole);
    if (last || run->due & RANKS_ROW)
        ok = run_error_row(whole, err);
    if (ok && whole->options->checkpoint && (last || run->due & RANKS_CHECKPOINT))
        ok = run_write_checkpoint(whole, last, err);
    run->rows = whole->rows;
    run->row_count = whole->row_count;
    run->row_capacity = whole->row_capacity;
    run->last_row = whole->last_row;
    run->next_checkpoint = whole->next_checkpoint;
    whole->rows = NULL;
    return ok;
}

static void complete(struct run *whole, int count)
{
    bool *present = mem_alloc((size_t)count, sizeof *present);
    for (int i = 0; i < count; i++)
        present[i] = true;
    run_complete_parts(whole, present, count);
    mem_free(present);
}

/* After a part that could not be added the sum is of no use: there is no picture. */
static bool serve_first(struct run *run, const struct text *own,
                        struct run_result *result, struct err *err)
{
    struct run_result scratch = {0};
    struct run_options options = *run->options;
    struct run whole = {.options = &options, .parts = true};
    struct adding adding = {.whole = &whole, .count = ranks_count(), .err = err};
    long *edges_cut = options.scene->edges_cut, own_cut = *edges_cut;
    options.part = (struct run_part){0};
    bool begun = run_begin(&whole, result ? result : &scratch, err);
    bool ok = begun && add(&adding, 0, own);
    bool added = ranks_gather(own, add, &adding) && ok;
    if (!begun)
        return false;
    ok = added;
    if (added) {
        complete(&whole, adding.count);
        ok = serve_whole(run, &whole, result, err);
    }
    if (added && result) {
        run_conclude(&whole, result);
        result->ranks_bytes = adding.bytes;
    } else {
        image_destroy(whole.picture);
    }
    run_end(&whole);
    *edges_cut = own_cut;
    return ok;
}

bool run_ranks_serve(struct run *run, struct run_result *result, struct err *err)
{
    struct text own = {0};
    if (!result && !(run->due & (RANKS_ROW | RANKS_CHECKPOINT | RANKS_VIEW)))
        return true;
    bool ok = pack_own(run, &own, err);
    if (ok && ranks_own() > 0)
        ok = ranks_gather(&own, NULL, NULL);
    else if (ok)
        ok = serve_first(run, &own, result, err);
    mem_free(own.data);
    return ok;
}
