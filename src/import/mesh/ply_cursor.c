#include "import/mesh/ply_cursor.h"

#include "import/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A packed file's number in ascii lies in one piece if it is no longer than that. */
#define NUMBER_MOST 4096

void ply_cursor_init(struct ply_cursor *cursor, const char *data, size_t size,
                     struct gzip *packed, const char *file,
                     const struct ply_header *header)
{
    *cursor = (struct ply_cursor){.begin = data,
                                  .at = data + header->data_offset,
                                  .end = data + size,
                                  .packed = packed,
                                  .line_offset = header->data_offset,
                                  .file = file,
                                  .line = header->data_line,
                                  .format = header->format};
}

static size_t offset_of(const struct ply_cursor *c, const char *at)
{
    return c->begin_offset + (size_t)(at - c->begin);
}

/* Whether `need` more bytes are available; unpacks more of a packed file. A damaged file
 * sets *err, which later errors do not replace. */
static bool reach(struct ply_cursor *c, size_t need, struct err *err)
{
    while ((size_t)(c->end - c->at) < need) {
        size_t left = (size_t)(c->end - c->at), size = left;
        const char *data = c->packed ? gzip_more(c->packed, left, &size, err) : NULL;
        if (!c->packed)
            return false;
        c->begin_offset = offset_of(c, c->at);
        c->damaged = !data;
        c->begin = c->at = data ? data : ""; /* the piece before is gone */
        c->end = c->at + (data ? size : 0);
        if (!data || size == left)
            c->packed = NULL;
    }
    return true;
}

bool ply_cursor_fail(const struct ply_cursor *c, enum err_code code, const char *message,
                     struct err *err)
{
    struct place at = {c->file, 0, 0};
    if (c->format != PLY_ASCII)
        return err_set(err, code, &at, "%s, before byte %zu", message,
                       offset_of(c, c->at));
    at.line = c->line;
    at.col = (int)(offset_of(c, c->at) - c->line_offset) + 1;
    return err_set(err, code, &at, "%s", message);
}

static void skip_space(struct ply_cursor *c, struct err *err)
{
    for (; c->at < c->end || reach(c, 1, err); c->at++) {
        if (*c->at == '\n') {
            c->line++;
            c->line_offset = offset_of(c, c->at + 1);
        } else if (*c->at != ' ' && *c->at != '\t' && *c->at != '\r') {
            break;
        }
    }
}

/* Error that quotes the word at the cursor up to its first invalid byte. */
static bool not_a_number(const struct ply_cursor *c, struct err *err)
{
    char message[80];
    int length = 0;
    while (length < 40 && c->at + length < c->end && c->at[length] > ' ' &&
           c->at[length] <= '~')
        length++;
    snprintf(message, sizeof message, "expected a finite number, got '%.*s'", length,
             c->at);
    return ply_cursor_fail(c, ERR_SYNTAX, message, err);
}

static bool read_ascii(struct ply_cursor *c, double *value, struct err *err)
{
    skip_space(c, err);
    if (c->at == c->end)
        return ply_cursor_fail(c, ERR_SYNTAX, "the file ends before its data", err);
    if (c->packed)
        reach(c, NUMBER_MOST, err);
    const char *after = number_parse(c->at, value);
    if (!after) {
        after = number_skip_nonfinite(c->at);
        *value = (double)NAN;
    }
    bool ended = after &&
                 (after == c->end ? !c->packed : *after && strchr(" \t\r\n", *after));
    if (!ended)
        return not_a_number(c, err);
    c->at = after;
    return true;
}

static uint64_t load_bits(const char *at, size_t size, bool big)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++) {
        uint64_t byte = (unsigned char)at[big ? size - 1 - i : i];
        bits |= byte << (8 * i);
    }
    return bits;
}

static double signed_value(uint64_t bits, int width)
{
    uint64_t sign = UINT64_C(1) << (width - 1);
    return (double)bits - (bits & sign ? 2.0 * (double)sign : 0.0);
}

static double to_double(uint64_t bits, enum ply_type type)
{
    uint32_t low = (uint32_t)bits;
    float f;
    double d;
    switch (type) {
    case PLY_INT8:
        return signed_value(bits, 8);
    case PLY_INT16:
        return signed_value(bits, 16);
    case PLY_INT32:
        return signed_value(bits, 32);
    case PLY_FLOAT32:
        memcpy(&f, &low, sizeof f);
        return (double)f;
    case PLY_FLOAT64:
        memcpy(&d, &bits, sizeof d);
        return d;
    default:
        return (double)bits;
    }
}

bool ply_cursor_read(struct ply_cursor *c, enum ply_type type, double *value,
                     struct err *err)
{
    if (c->format == PLY_ASCII)
        return read_ascii(c, value, err);
    size_t size = ply_type_size(type);
    if (!reach(c, size, err))
        return ply_cursor_fail(c, ERR_SYNTAX, "the file ends before its data", err);
    uint64_t bits = load_bits(c->at, size, c->format == PLY_BIG_ENDIAN);
    *value = to_double(bits, type);
    c->at += size;
    return true;
}

bool ply_cursor_read_index(struct ply_cursor *c, enum ply_type type, double limit,
                           uint32_t *value, struct err *err)
{
    double d = 0.0;
    if (!ply_cursor_read(c, type, &d, err))
        return false;
    if (!(d >= 0.0 && d <= limit && d == trunc(d)))
        return ply_cursor_fail(c, ERR_VALUE, "an index or a count is out of range", err);
    *value = (uint32_t)d;
    return true;
}

bool ply_cursor_skip(struct ply_cursor *c, const struct ply_property *property,
                     struct err *err)
{
    uint32_t count = 1;
    double ignored;
    if (property->count_type &&
        !ply_cursor_read_index(c, property->count_type, UINT32_MAX, &count, err))
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!ply_cursor_read(c, property->type, &ignored, err))
            return false;
    return true;
}

bool ply_cursor_finish(struct ply_cursor *c, struct err *err)
{
    if (c->format == PLY_ASCII)
        skip_space(c, err);
    else {
        c->at += reach(c, 1, err) && *c->at == '\r';
        c->at += reach(c, 1, err) && *c->at == '\n';
    }
    if (!reach(c, 1, err))
        return !c->damaged;
    return ply_cursor_fail(c, ERR_SYNTAX, "more data than the header promises", err);
}
