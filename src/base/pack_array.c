#include "base/pack_array.h"

#include <string.h>

#define BITS  64
#define CHUNK 512 /* values, or words of bits, put at once */

static bool is_zero(const unsigned char *value, size_t size)
{
    uint64_t word = 0;
    if (size == sizeof word)
        memcpy(&word, value, sizeof word);
    else
        memcpy(&word, value, sizeof(uint32_t));
    return word == 0;
}

static size_t words_of_bits(size_t count)
{
    return count / BITS + (count % BITS != 0);
}

size_t pack_array_stored(const void *values, size_t count, size_t size)
{
    const unsigned char *value = values;
    size_t present = 0;
    for (size_t i = 0; i < count; i++)
        present += !is_zero(value + i * size, size);
    bool shorter = (1 + words_of_bits(count)) * PACK_WORD + present * size < count * size;
    return shorter ? present : count;
}

/* --- writing ---------------------------------------------------------------------- */

static void put_bits(struct pack *pack, const unsigned char *values, size_t count,
                     size_t size)
{
    uint64_t words[CHUNK];
    size_t used = 0;
    for (size_t first = 0; first < count; first += BITS) {
        words[used] = 0;
        for (size_t i = first; i < count && i < first + BITS; i++)
            if (!is_zero(values + i * size, size))
                words[used] |= UINT64_C(1) << (i - first);
        if (++used == CHUNK) {
            pack_file_put(pack, words, sizeof words);
            used = 0;
        }
    }
    pack_file_put(pack, words, used * sizeof *words);
}

static void put_present(struct pack *pack, const unsigned char *values, size_t count,
                        size_t size)
{
    unsigned char chunk[CHUNK * PACK_WORD];
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        if (is_zero(values + i * size, size))
            continue;
        memcpy(chunk + used, values + i * size, size);
        used += size;
        if (used == sizeof chunk) {
            pack_file_put(pack, chunk, used);
            used = 0;
        }
    }
    pack_file_put(pack, chunk, used);
}

void pack_array_put(struct pack *pack, const void *values, size_t count, size_t size,
                    size_t stored)
{
    uint64_t present = stored;
    if (stored == count) {
        pack_file_put(pack, values, count * size);
        return;
    }
    pack_file_put(pack, &present, sizeof present);
    put_bits(pack, values, count, size);
    put_present(pack, values, count, size);
}

/* --- reading ---------------------------------------------------------------------- */

static uint64_t word_at(const struct pack_array *array, size_t word)
{
    uint64_t bits;
    memcpy(&bits, array->present + word * sizeof bits, sizeof bits);
    return bits;
}

/* Whether as many bits are set as there are values, and none beyond the last. */
static bool bits_agree(const struct pack_array *array, uint64_t present)
{
    size_t words = words_of_bits(array->count);
    uint64_t set = 0;
    for (size_t w = 0; w < words; w++)
        set += (uint64_t)__builtin_popcountll(word_at(array, w));
    size_t used = array->count % BITS;
    bool beyond = used != 0 && word_at(array, words - 1) >> used != 0;
    return set == present && !beyond;
}

bool pack_array_get(struct pack *pack, size_t count, size_t size, bool sparse,
                    struct pack_array *array)
{
    uint64_t present = count;
    *array = (struct pack_array){.count = count, .size = size};
    if (count > pack_file_left(pack) * BITS)
        return false;
    if (sparse) {
        const unsigned char *number = pack_file_get(pack, sizeof present);
        array->present = pack_file_get(pack, words_of_bits(count) * PACK_WORD);
        if (number == NULL || array->present == NULL)
            return false;
        memcpy(&present, number, sizeof present);
        if (present > count || !bits_agree(array, present))
            return false;
    }
    if (present > pack_file_left(pack) / size)
        return false;
    array->values = pack_file_get(pack, (size_t)present * size);
    return array->values != NULL;
}

static void put_value(const struct pack_array *array, unsigned char *to,
                      const unsigned char *from, bool adds)
{
    uint64_t words[2] = {0, 0};
    uint32_t halves[2] = {0, 0};
    if (!adds) {
        memcpy(to, from, array->size);
    } else if (array->size == sizeof *words) {
        memcpy(&words[0], to, sizeof *words);
        memcpy(&words[1], from, sizeof *words);
        words[0] += words[1];
        memcpy(to, words, sizeof *words);
    } else {
        memcpy(&halves[0], to, sizeof *halves);
        memcpy(&halves[1], from, sizeof *halves);
        halves[0] += halves[1];
        memcpy(to, halves, sizeof *halves);
    }
}

/* To the places of those that are present. */
static void put_present_values(const struct pack_array *array, unsigned char *to,
                               bool adds)
{
    const unsigned char *from = array->values;
    size_t size = array->size;
    for (size_t w = 0; w < words_of_bits(array->count); w++)
        for (uint64_t bits = word_at(array, w); bits; bits &= bits - 1) {
            size_t i = w * BITS + (size_t)__builtin_ctzll(bits);
            put_value(array, to + i * size, from, adds);
            from += size;
        }
}

static int64_t value_at(const struct pack_array *array, size_t stored)
{
    const unsigned char *at = array->values + stored * array->size;
    int64_t value = 0;
    uint32_t half = 0;
    if (array->size == sizeof value) {
        memcpy(&value, at, sizeof value);
        return value;
    }
    memcpy(&half, at, sizeof half);
    return half;
}

void pack_array_each(const struct pack_array *array, pack_take take, void *ctx)
{
    size_t stored = 0;
    for (size_t i = 0; !array->present && i < array->count; i++) {
        int64_t value = value_at(array, i);
        if (value != 0)
            take(ctx, i, value);
    }
    for (size_t w = 0; array->present && w < words_of_bits(array->count); w++)
        for (uint64_t bits = word_at(array, w); bits; bits &= bits - 1)
            take(ctx, w * BITS + (size_t)__builtin_ctzll(bits),
                 value_at(array, stored++));
}

void pack_array_copy(const struct pack_array *array, void *to)
{
    if (array->count == 0)
        return;
    if (!array->present) {
        memcpy(to, array->values, array->count * array->size);
        return;
    }
    memset(to, 0, array->count * array->size);
    put_present_values(array, to, false);
}

void pack_array_add(const struct pack_array *array, void *to)
{
    if (array->present) {
        put_present_values(array, to, true);
        return;
    }
    for (size_t i = 0; i < array->count; i++)
        put_value(array, (unsigned char *)to + i * array->size,
                  array->values + i * array->size, true);
}
