#include "chain/tape.h"

#include "base/mem.h"
#include "base/pack.h"

#include <limits.h>

/* Splats that a record has on average at most; with more the tape is full earlier. */
#define SPLATS_MEAN 8

long tape_splats_most(long mutations, int splats)
{
    return (mutations + 1) * (splats < SPLATS_MEAN ? splats : SPLATS_MEAN) + splats;
}

static void arrays(struct tape *tape, long mutations, int splats, struct mem_plan *plan)
{
    tape->capacity = mutations + 1;
    tape->splat_capacity = tape_splats_most(mutations, splats);
    tape->records = mem_take(plan, 0, (size_t)tape->capacity, sizeof *tape->records);
    tape->splats = mem_take(plan, 0, (size_t)tape->splat_capacity, sizeof *tape->splats);
}

void tape_init(struct tape *tape, long mutations, int splats)
{
    *tape = (struct tape){0};
    arrays(tape, mutations, splats, &(struct mem_plan){.take = true});
}

void tape_deinit(struct tape *tape)
{
    mem_free(tape->records);
    mem_free(tape->splats);
    *tape = (struct tape){0};
}

double tape_bytes(long mutations, int splats)
{
    struct mem_plan plan = {.take = false};
    arrays(&(struct tape){0}, mutations, splats, &plan);
    return plan.bytes;
}

/* Splats on the same pixel become one. */
static int add_splats(struct tape *tape, const struct contrib *y)
{
    struct tape_splat *begin = tape->splats + tape->splat_count;
    int count = 0;
    for (int i = 0; i < y->count; i++) {
        const struct splat *s = &y->splats[i];
        int k = 0;
        while (k < count && begin[k].pixel != s->pixel)
            k++;
        if (k == count)
            begin[count++] = (struct tape_splat){s->pixel, 0.0f};
        begin[k].luminance += (float)rgb_luminance(s->value);
    }
    tape->splat_count += count;
    return count;
}

static void add(struct tape *tape, struct tape_record r, const struct contrib *y)
{
    if (tape->count >= tape->capacity ||
        tape->splat_count + y->count > tape->splat_capacity) {
        tape->full = true;
        return;
    }
    r.target = y->target;
    r.splats = (uint16_t)add_splats(tape, y);
    tape->records[tape->count++] = r;
}

void tape_begin(struct tape *tape, const struct contrib *state)
{
    add(tape, (struct tape_record){.event = TAPE_LOCAL, .accepted = true}, state);
}

void tape_record(struct tape *tape, enum tape_event event, const struct contrib *y,
                 double a, bool accepted)
{
    if (!tape->full)
        add(tape, (struct tape_record){0.0, (float)a, (uint8_t)event, accepted, 0}, y);
}

void tape_work(struct tape *tape, bool large, double count, double work)
{
    if (tape->full)
        return;
    tape->mutations[large] += count;
    tape->work[large] += work;
}

/* --- checkpoints ------------------------------------------------------------------- */

static void pack_record(struct pack *pack, struct tape_record *r)
{
    double acceptance = (double)r->acceptance;
    int event = r->event, splats = r->splats;
    pack_double(pack, "target", &r->target);
    pack_double(pack, "acceptance", &acceptance);
    pack_int(pack, "event", &event, 0, TAPE_AFTER_LARGE);
    pack_flag(pack, "accepted", &r->accepted);
    pack_int(pack, "splats", &splats, 0, UINT16_MAX);
    r->acceptance = (float)acceptance;
    r->event = (uint8_t)event;
    r->splats = (uint16_t)splats;
}

static void pack_splat(struct pack *pack, struct tape_splat *s, long pixels)
{
    long pixel = s->pixel;
    double luminance = (double)s->luminance;
    pack_long(pack, "pixel", &pixel, 0, pixels - 1);
    pack_double(pack, "luminance", &luminance);
    *s = (struct tape_splat){(int32_t)pixel, (float)luminance};
}

void tape_pack(struct pack *pack, struct tape *tape, long pixels)
{
    long splats = 0;
    pack_long(pack, "tape_records", &tape->count, 0, tape->capacity);
    pack_long(pack, "tape_splats", &tape->splat_count, 0, tape->splat_capacity);
    pack_flag(pack, "tape_full", &tape->full);
    for (int i = 0; i < 2; i++) {
        pack_double(pack, "tape_mutations", &tape->mutations[i]);
        pack_double(pack, "tape_work", &tape->work[i]);
    }
    for (long i = 0; i < tape->count && pack_ok(pack); i++) {
        pack_record(pack, &tape->records[i]);
        splats += tape->records[i].splats;
    }
    for (long i = 0; i < tape->splat_count && pack_ok(pack); i++)
        pack_splat(pack, &tape->splats[i], pixels);
    if (pack_ok(pack) && splats != tape->splat_count)
        pack_refuse(pack, "tape_splats");
}
