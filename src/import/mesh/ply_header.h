#ifndef ETALON_IMPORT_PLY_HEADER_H
#define ETALON_IMPORT_PLY_HEADER_H

/* The header of a PLY file: its elements and the layout of their properties. */

#include "base/err.h"

#include <stddef.h>
#include <stdint.h>

#define PLY_NAME       48
#define PLY_ELEMENTS   8
#define PLY_PROPERTIES 48

enum ply_format { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN };

enum ply_type {
    PLY_NONE,
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64,
};

struct ply_property {
    char name[PLY_NAME];
    enum ply_type type;
    enum ply_type count_type; /* of a list; PLY_NONE for a scalar */
};

struct ply_element {
    char name[PLY_NAME];
    uint64_t count;
    int line, col; /* of the count */
    int property_count;
    struct ply_property properties[PLY_PROPERTIES];
};

struct ply_header {
    enum ply_format format;
    int element_count;
    struct ply_element elements[PLY_ELEMENTS];
    size_t data_offset; /* of the first byte after the header */
    int data_line;      /* of the line that begins there */
};

/* Fails too if the elements' counts cannot fit into the bytes that follow the header.
 * data is zero-terminated; of the file, which has at most size_most bytes, it need not be
 * more than the header. file is its name, for messages. */
bool ply_header_parse(const char *data, size_t size, size_t size_most, const char *file,
                      struct ply_header *header, struct err *err);

size_t ply_type_size(enum ply_type type); /* bytes in a binary file */
bool ply_type_is_integer(enum ply_type type);

#endif
