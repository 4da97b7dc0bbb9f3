#ifndef ETALON_IMPORT_PLY_CURSOR_H
#define ETALON_IMPORT_PLY_CURSOR_H

/* Values after a PLY header, one by one, in any of the three formats. */

#include "import/gzip.h"
#include "import/mesh/ply_header.h"

struct ply_cursor {
    const char *begin, *at, *end; /* zero-terminated */
    struct gzip *packed;          /* from which more comes at the end, or NULL */
    bool damaged;                 /* no more came, and *err says why */
    size_t begin_offset;          /* in the file, unpacked */
    size_t line_offset;           /* of the line's start; ascii */
    const char *file;
    int line;
    enum ply_format format;
};

/* packed: NULL, or where data is the first piece of. */
void ply_cursor_init(struct ply_cursor *cursor, const char *data, size_t size,
                     struct gzip *packed, const char *file,
                     const struct ply_header *header);
bool ply_cursor_read(struct ply_cursor *cursor, enum ply_type type, double *value,
                     struct err *err);
/* An integer in [0, limit]. */
bool ply_cursor_read_index(struct ply_cursor *cursor, enum ply_type type, double limit,
                           uint32_t *value, struct err *err);
bool ply_cursor_skip(struct ply_cursor *cursor, const struct ply_property *property,
                     struct err *err);
/* Fails unless only white space follows (one line end in binary files). */
bool ply_cursor_finish(struct ply_cursor *cursor, struct err *err);
/* Fails at the value read last: line and column, or the byte offset in the message. */
bool ply_cursor_fail(const struct ply_cursor *cursor, enum err_code code,
                     const char *message, struct err *err);

#endif
