#ifndef ETALON_BASE_HASH_H
#define ETALON_BASE_HASH_H

/* 64-bit hashes: FNV-1a, a byte at a time, the same on every machine. For names of
 * results and caches; not secure against attacks. */

#include <stddef.h>
#include <stdint.h>

struct hash {
    uint64_t value;
};

#define HASH_DIGITS 16

void hash_init(struct hash *hash);
void hash_bytes(struct hash *hash, const void *bytes, size_t size);
/* Eight bytes at a time, in the machine's byte order, for long data that stay on this
 * machine. A change of any single word changes the value. */
void hash_words(struct hash *hash, const void *words, size_t count);
/* Includes the terminator, so that "ab","c" and "a","bc" differ. */
void hash_text(struct hash *hash, const char *text);
void hash_number(struct hash *hash, uint64_t number);
/* Lower-case hexadecimal, zero-terminated. */
void hash_digits(const struct hash *hash, char digits[HASH_DIGITS + 1]);

#endif
