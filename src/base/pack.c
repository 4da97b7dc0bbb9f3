#include "base/pack.h"

#include "base/mem.h"
#include "base/pack_array.h"

#include <assert.h>
#include <string.h>

#define NAME_MOST 32
/* Most bytes of a label: its header and the padded name. */
#define HEADER_MOST (PACK_WORD + NAME_MOST + PACK_WORD)

enum kind {
    KIND_INTEGER = 'i',
    KIND_WORD32 = 'u',
    KIND_DOUBLE = 'd',
    KIND_FLOAT = 'f',
    KIND_TEXT = 't',
};

void pack_refuse(struct pack *pack, const char *what)
{
    err_set(&pack->failure, ERR_VALUE, &(struct place){pack->path, 0, 0},
            "this is no state that a run can be in: %s; begin anew", what);
}

/* Kind, length of the name, whether zeros are left out, the name: padded. */
static size_t label(enum kind kind, const char *name, bool sparse,
                    unsigned char out[HEADER_MOST])
{
    size_t length = strlen(name);
    assert(length <= NAME_MOST);
    memset(out, 0, HEADER_MOST);
    out[0] = (unsigned char)kind;
    out[1] = (unsigned char)length;
    out[2] = sparse;
    memcpy(out + PACK_WORD, name, length + 1);
    return PACK_WORD + length;
}

/* The count of the field, which is the next one and so named, and whether it is sparse;
 * false if it is not. */
static bool get_label(struct pack *pack, enum kind kind, const char *name,
                      uint64_t *count, bool *sparse)
{
    unsigned char expected[HEADER_MOST];
    size_t size = label(kind, name, false, expected);
    const unsigned char *found = pack_file_get(pack, size);
    const unsigned char *number = pack_file_get(pack, sizeof *count);
    *sparse = found && found[2] == 1;
    label(kind, name, *sparse, expected);
    bool ok = found && number && memcmp(found, expected, size) == 0;
    if (ok)
        memcpy(count, number, sizeof *count);
    else
        pack_refuse(pack, name);
    return ok;
}

static void put_label(struct pack *pack, enum kind kind, const char *name, bool sparse,
                      uint64_t count)
{
    unsigned char bytes[HEADER_MOST];
    size_t size = label(kind, name, sparse, bytes);
    pack_file_put(pack, bytes, size);
    pack_file_put(pack, &count, sizeof count);
}

static void put_array(struct pack *pack, enum kind kind, const char *name,
                      const void *values, size_t count, size_t size)
{
    size_t stored = pack_array_stored(values, count, size);
    put_label(pack, kind, name, stored < count, count);
    pack_array_put(pack, values, count, size, stored);
}

/* The values of the next field, which stay in the file; false if it is another. */
static bool get_array(struct pack *pack, enum kind kind, const char *name, size_t count,
                      size_t size, struct pack_array *array)
{
    uint64_t found;
    bool sparse;
    if (!pack_ok(pack) || !get_label(pack, kind, name, &found, &sparse))
        return false;
    bool ok = found == count && pack_array_get(pack, count, size, sparse, array);
    if (!ok)
        pack_refuse(pack, name);
    return ok;
}

static void field(struct pack *pack, enum kind kind, const char *name, void *values,
                  size_t count, size_t size)
{
    struct pack_array array;
    if (pack_ok(pack) && !pack_reads(pack))
        put_array(pack, kind, name, values, count, size);
    else if (get_array(pack, kind, name, count, size, &array))
        pack_array_copy(&array, values);
}

void pack_long(struct pack *pack, const char *name, long *value, long least, long most)
{
    int64_t number = *value;
    field(pack, KIND_INTEGER, name, &number, 1, sizeof number);
    if (pack_ok(pack) && (number < least || number > most))
        pack_refuse(pack, name);
    else
        *value = (long)number;
}

void pack_int(struct pack *pack, const char *name, int *value, int least, int most)
{
    long number = *value;
    pack_long(pack, name, &number, least, most);
    *value = (int)number;
}

void pack_flag(struct pack *pack, const char *name, bool *value)
{
    long number = *value;
    pack_long(pack, name, &number, 0, 1);
    *value = number != 0;
}

void pack_double(struct pack *pack, const char *name, double *value)
{
    field(pack, KIND_DOUBLE, name, value, 1, sizeof *value);
}

void pack_doubles(struct pack *pack, const char *name, double *values, size_t count)
{
    field(pack, KIND_DOUBLE, name, values, count, sizeof *values);
}

void pack_floats(struct pack *pack, const char *name, float *values, size_t count)
{
    field(pack, KIND_FLOAT, name, values, count, sizeof *values);
}

void pack_int64s(struct pack *pack, const char *name, int64_t *values, size_t count)
{
    field(pack, KIND_INTEGER, name, values, count, sizeof *values);
}

void pack_uint32s(struct pack *pack, const char *name, uint32_t *values, size_t count)
{
    field(pack, KIND_WORD32, name, values, count, sizeof *values);
}

/* --- parts ------------------------------------------------------------------------ */

void pack_set_part(struct pack *pack, struct run_part part, bool adds)
{
    pack->part = part;
    pack->adds = adds;
}

struct run_part pack_part(const struct pack *pack)
{
    return pack->part;
}

bool pack_adds(const struct pack *pack)
{
    return pack->adds;
}

static void sum_field(struct pack *pack, enum kind kind, const char *name, void *values,
                      size_t count, size_t size)
{
    struct pack_array array;
    if (!pack->adds)
        field(pack, kind, name, values, count, size);
    else if (get_array(pack, kind, name, count, size, &array))
        pack_array_add(&array, values);
}

void pack_sum_int64s(struct pack *pack, const char *name, int64_t *values, size_t count)
{
    sum_field(pack, KIND_INTEGER, name, values, count, sizeof *values);
}

void pack_sum_uint32s(struct pack *pack, const char *name, uint32_t *values, size_t count)
{
    sum_field(pack, KIND_WORD32, name, values, count, sizeof *values);
}

static void each(struct pack *pack, enum kind kind, const char *name, size_t count,
                 size_t size, pack_take take, void *ctx)
{
    struct pack_array array;
    if (get_array(pack, kind, name, count, size, &array))
        pack_array_each(&array, take, ctx);
}

void pack_each_int64(struct pack *pack, const char *name, size_t count, pack_take take,
                     void *ctx)
{
    each(pack, KIND_INTEGER, name, count, sizeof(int64_t), take, ctx);
}

void pack_each_uint32(struct pack *pack, const char *name, size_t count, pack_take take,
                      void *ctx)
{
    each(pack, KIND_WORD32, name, count, sizeof(uint32_t), take, ctx);
}

void pack_sum_long(struct pack *pack, const char *name, long *value)
{
    int64_t number = *value;
    pack_sum_int64s(pack, name, &number, 1);
    if (pack_ok(pack) && number < 0)
        pack_refuse(pack, name);
    else
        *value = (long)number;
}

void pack_blob(struct pack *pack, const char *name, struct text *blob)
{
    uint64_t count = blob->length;
    bool sparse;
    if (!pack_ok(pack))
        return;
    if (!pack_reads(pack)) {
        put_label(pack, KIND_TEXT, name, false, count);
        pack_file_put(pack, blob->data, blob->length);
        return;
    }
    if (!get_label(pack, KIND_TEXT, name, &count, &sparse))
        return;
    const unsigned char *bytes = sparse ? NULL : pack_file_get(pack, count);
    if (bytes == NULL) {
        pack_refuse(pack, name);
        return;
    }
    blob->data = mem_grow(blob->data, &blob->capacity, count + 1, 1);
    memcpy(blob->data, bytes, count);
    blob->data[count] = '\0';
    blob->length = count;
}

void pack_text(struct pack *pack, const char *name, char *text, size_t size)
{
    struct text blob = {0};
    if (!pack_reads(pack))
        blob = (struct text){.data = text, .length = strlen(text)};
    pack_blob(pack, name, &blob);
    if (!pack_reads(pack) || !pack_ok(pack))
        return;
    if (blob.data && blob.length < size && strlen(blob.data) == blob.length)
        memcpy(text, blob.data, blob.length + 1);
    else
        pack_refuse(pack, name);
    mem_free(blob.data);
}

bool pack_close(struct pack *pack, struct err *err)
{
    if (pack_ok(pack) && !pack_reads(pack))
        pack_file_finish(pack);
    else if (pack_ok(pack) && pack_file_left(pack) > 0)
        pack_refuse(pack, "there is more in it than expected");
    bool ok = pack_ok(pack);
    if (!ok && err && err->code == ERR_NONE)
        *err = pack->failure;
    pack_destroy(pack);
    return ok;
}
