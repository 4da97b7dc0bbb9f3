#ifndef ETALON_IMPORT_MITSUBA_TREE_H
#define ETALON_IMPORT_MITSUBA_TREE_H

/* A Mitsuba scene file as a tree of its elements, each with its place: <include>d files
 * stand where they are included, $parameters are replaced by what the options define,
 * else by the first <default> of that name. -- within a comment, which XML forbids and
 * Mitsuba 3 passes over, is passed over. The only user of libexpat. */

#include "import/import.h"

#define MITSUBA_INCLUDE_DEPTH 16 /* as Mitsuba 3 */
#define MITSUBA_NEST_DEPTH    100
#define MITSUBA_INCLUDES_MAX  10000

struct mitsuba_attribute {
    char *name, *value;
};

struct mitsuba_node {
    char *name; /* of the element */
    struct mitsuba_attribute *attributes;
    size_t attribute_count;
    struct mitsuba_node **children;
    size_t child_count, child_capacity;
    struct place place;            /* of its <; the file name is the desc's */
    bool used;                     /* somebody asked for it */
    bool busy;                     /* being read: a reference back to it is a loop */
    const struct texture *texture; /* once it was read as one */
    int object;                    /* of the desc, once it was read as a shapegroup */
    int material[2]; /* indices in the desc once it was read as a BSDF, alone or within
                        "twosided"; -1 before */
};

/* The <scene> element; NULL after an error. options: NULL, or whose definitions count. */
struct mitsuba_node *mitsuba_tree_read(struct scene_desc *desc, const char *path,
                                       const struct import_options *options,
                                       struct err *err);
void mitsuba_tree_destroy(struct mitsuba_node *node);

/* An attribute's value, NULL if it is not there. */
const char *mitsuba_attribute(const struct mitsuba_node *node, const char *name);

#endif
