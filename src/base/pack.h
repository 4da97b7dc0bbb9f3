#ifndef ETALON_BASE_PACK_H
#define ETALON_BASE_PACK_H

/* A file of named fields that is either complete or does not exist: the format of
 * checkpoints.
 *
 * The same calls write and read. So a module has one function x_pack(pack, x) for its
 * state, which writes x to the file or, on a newly made x, reads it; writing and reading
 * cannot diverge. After a failure all further calls do nothing; pack_ok and pack_close
 * report it.
 *
 * The file, in words of 8 bytes and the machine's byte order: "etalonck"; a mark of that
 * order and the layout; the fields, each its kind, name, count and values, padded to
 * words, zeros left out where there are many; an end mark; a hash of everything before
 * it. A file in which one word differs from what was written is always refused; other
 * damage is missed with probability 2^-64.
 */

#include "base/part.h"
#include "base/text.h"

#include <stdint.h>

struct pack;

/* Opens a file to write, under "PATH.part", which pack_close renames. layout: version of
 * the set of fields, raised by whoever changes it. NULL on failure. */
struct pack *pack_create(const char *path, uint32_t layout, struct err *err);
/* Opens a file to read; fails if it is incomplete, no pack, or of another layout. */
struct pack *pack_open(const char *path, uint32_t layout, struct err *err);
/* The same without a file: pack_close_memory ends and frees it and appends its bytes to
 * an empty text; pack_open_memory reads them, which must outlive the pack. */
struct pack *pack_create_memory(uint32_t layout, struct err *err);
bool pack_close_memory(struct pack *pack, struct text *bytes, struct err *err);
struct pack *pack_open_memory(const struct text *bytes, uint32_t layout, struct err *err);
/* Whether pack_create would succeed; leaves no file. */
bool pack_writable(const char *path, struct err *err);

bool pack_reads(const struct pack *pack);
bool pack_ok(const struct pack *pack);
/* For a reader: rejects impossible values. */
void pack_refuse(struct pack *pack, const char *what);

/* Names have at most 32 characters. A count that differs is refused, and so is an integer
 * outside [least, most]. */
void pack_int(struct pack *pack, const char *name, int *value, int least, int most);
void pack_long(struct pack *pack, const char *name, long *value, long least, long most);
void pack_flag(struct pack *pack, const char *name, bool *value);
void pack_double(struct pack *pack, const char *name, double *value);
void pack_doubles(struct pack *pack, const char *name, double *values, size_t count);
void pack_floats(struct pack *pack, const char *name, float *values, size_t count);
void pack_int64s(struct pack *pack, const char *name, int64_t *values, size_t count);
void pack_uint32s(struct pack *pack, const char *name, uint32_t *values, size_t count);
/* Zero-terminated, in a buffer of that size. */
void pack_text(struct pack *pack, const char *name, char *text, size_t size);
/* Any bytes; read, they are appended to an empty text. */
void pack_blob(struct pack *pack, const char *name, struct text *blob);

/* The part of a run whose state the file holds (base/part.h); whole unless it is set.
 * What a part does not own is not in its file. */
struct run_part pack_part(const struct pack *pack);
/* adds: for a reader. The file's state is added to what other parts' files gave, instead
 * of replacing it: pack_sum_... adds, the functions above replace. */
void pack_set_part(struct pack *pack, struct run_part part, bool adds);
bool pack_adds(const struct pack *pack);
/* Sums over the parts of a run: read into what is there if the pack adds. */
void pack_sum_long(struct pack *pack, const char *name, long *value);
void pack_sum_int64s(struct pack *pack, const char *name, int64_t *values, size_t count);
void pack_sum_uint32s(struct pack *pack, const char *name, uint32_t *values,
                      size_t count);
/* Reads the values of a field that are not 0, one by one, without room for all. */
typedef void (*pack_take)(void *ctx, size_t i, int64_t value);
void pack_each_int64(struct pack *pack, const char *name, size_t count, pack_take take,
                     void *ctx);
void pack_each_uint32(struct pack *pack, const char *name, size_t count, pack_take take,
                      void *ctx);

/* Ends and frees the pack. After writing, the file is on the disk under its name; after
 * reading, all fields must have been read. False if this or anything before failed; then
 * an older file of the name is kept. */
bool pack_close(struct pack *pack, struct err *err);
/* Frees an unfinished pack and removes its temporary file. NULL is legal. */
void pack_destroy(struct pack *pack);

#endif
