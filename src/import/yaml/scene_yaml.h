#ifndef ETALON_IMPORT_SCENE_YAML_H
#define ETALON_IMPORT_SCENE_YAML_H

/* The parts of Etalon's own scene files; scenes/README.md describes the format. */

#include "base/doc.h"
#include "import/ahead.h"
#include "import/import.h"
#include "scene/scene_desc.h"

struct scene_yaml {
    struct scene_desc *desc;
    char *directory; /* file names start here */
    struct ahead *ahead;
    const char *file;     /* kept by the desc */
    const char **names;   /* of the materials, NULL-terminated; keys of the doc */
    int *indices;         /* of them in the desc; -1: it was in error */
    const char **objects; /* names, NULL-terminated; keys of the doc */
    int object;           /* the one that is read; 0: the scene itself */
    const struct import_options *options;
    struct err *first_error; /* the caller's */
    bool failed, stopped;    /* an error was told; one after which nothing is read */
    bool nameless;           /* materials or objects were not read: nobody has names */
};

/* The place of a node with a file name that outlives the document. */
struct place scene_yaml_place(const struct scene_yaml *s, const struct doc_node *node);

/* A map, with no keys but those allowed (NULL-terminated). */
bool scene_yaml_map(const struct doc_node *node, const char *what,
                    const char *const *allowed, struct err *err);
/* map[key] into *value, which is untouched if there is no such key. */
bool scene_yaml_double(const struct doc_node *map, const char *key, double *value,
                       struct err *err);
bool scene_yaml_int(const struct doc_node *map, const char *key, int min, int max,
                    int *value, struct err *err);
bool scene_yaml_to_int(const struct doc_node *node, const char *key, int min, int max,
                       int *value, struct err *err);
bool scene_yaml_bool(const struct doc_node *map, const char *key, bool *value,
                     struct err *err);
bool scene_yaml_vector(const struct doc_node *map, const char *key, double value[3],
                       struct err *err);
/* Three numbers, or one that stands for all three. */
bool scene_yaml_three(const struct doc_node *node, double v[3], struct err *err);

/* One number for grey, or a list of three; negative components are clamped and counted.
 */
bool scene_yaml_colour(struct scene_yaml *s, const struct doc_node *node,
                       struct rgb *value, struct err *err);
/* The value of a key that must be there; NULL after an error. */
const struct doc_node *scene_yaml_want(const struct doc_node *map, const char *key,
                                       struct err *err);

/* A list of steps (or one step), the first applied first. */
bool scene_yaml_transform(const struct doc_node *node, struct xform *out,
                          struct err *err);

/* Keeps an error, so that all that is wrong is told at once; whether to go on. ERR_NONE
 * stands for what follows from an error that was told. */
bool scene_yaml_tell(struct scene_yaml *s, const struct err *failure);
/* Reads each item of a list ("shapes wants a list"), or each value of a map, on its own;
 * fails where it is none. Whether an item failed stands in s alone. */
typedef bool scene_yaml_item(struct scene_yaml *s, const struct doc_node *item, int index,
                             struct err *err);
bool scene_yaml_list(struct scene_yaml *s, const struct doc_node *list, const char *what,
                     scene_yaml_item *read, struct err *err);
void scene_yaml_each(struct scene_yaml *s, const struct doc_node *node,
                     scene_yaml_item *read);

bool scene_yaml_camera(struct scene_yaml *s, const struct doc_node *map, struct err *err);
bool scene_yaml_materials(struct scene_yaml *s, const struct doc_node *map,
                          struct err *err);
bool scene_yaml_shapes(struct scene_yaml *s, const struct doc_node *list,
                       struct err *err);
bool scene_yaml_objects(struct scene_yaml *s, const struct doc_node *map,
                        struct err *err);
bool scene_yaml_instances(struct scene_yaml *s, const struct doc_node *list,
                          struct err *err);

#endif
