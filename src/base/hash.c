#include "base/hash.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define BASIS 0xcbf29ce484222325u
#define PRIME 0x100000001b3u

void hash_init(struct hash *hash)
{
    hash->value = BASIS;
}

void hash_bytes(struct hash *hash, const void *bytes, size_t size)
{
    const unsigned char *b = bytes;
    uint64_t value = hash->value;
    for (size_t i = 0; i < size; i++)
        value = (value ^ b[i]) * PRIME;
    hash->value = value;
}

/* Every step is invertible. The shift mixes the upper bits into the lower ones, which a
 * product does not do. */
void hash_words(struct hash *hash, const void *words, size_t count)
{
    const unsigned char *bytes = words;
    uint64_t value = hash->value, word;
    for (size_t i = 0; i < count; i++) {
        memcpy(&word, bytes + i * sizeof word, sizeof word);
        value = (value ^ word) * PRIME;
        value ^= value >> 32;
    }
    hash->value = value;
}

void hash_text(struct hash *hash, const char *text)
{
    hash_bytes(hash, text, strlen(text) + 1);
}

void hash_number(struct hash *hash, uint64_t number)
{
    unsigned char bytes[8];
    for (int i = 0; i < 8; i++)
        bytes[i] = (unsigned char)(number >> (8 * i));
    hash_bytes(hash, bytes, sizeof bytes);
}

void hash_digits(const struct hash *hash, char digits[HASH_DIGITS + 1])
{
    snprintf(digits, HASH_DIGITS + 1, "%016" PRIx64, hash->value);
}
