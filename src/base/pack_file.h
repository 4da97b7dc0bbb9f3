#ifndef ETALON_BASE_PACK_FILE_H
#define ETALON_BASE_PACK_FILE_H

/* The file of a pack: words of 8 bytes between its marks, complete or absent. */

#include "base/hash.h"
#include "base/pack.h"

#define PACK_WORD 8

struct pack {
    char *path, *temporary; /* temporary: NULL if it is read */
    int fd;
    struct hash hash;
    unsigned char *buffer; /* not yet written */
    size_t buffered;
    const unsigned char *data; /* the file that is read */
    size_t size, at;           /* at: the next field */
    bool in_memory;            /* `data` is the caller's; written, the file has no name */
    struct run_part part;      /* whose state it holds */
    bool adds;                 /* the reader adds it to that of other parts */
    struct err failure;
};

/* Appends the bytes, padded to whole words. */
void pack_file_put(struct pack *pack, const void *bytes, size_t size);
/* Ends the file and, if it has a name, renames it. */
void pack_file_finish(struct pack *pack);

/* The next `size` bytes, padded in the file; NULL past its end. */
const unsigned char *pack_file_get(struct pack *pack, size_t size);
/* Bytes not read yet. */
size_t pack_file_left(const struct pack *pack);

#endif
