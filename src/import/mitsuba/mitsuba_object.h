#ifndef ETALON_IMPORT_MITSUBA_OBJECT_H
#define ETALON_IMPORT_MITSUBA_OBJECT_H

/* An object (<shape>, <bsdf>, ...) is an element with a type and properties, and may hold
 * other objects or references to them. */

#include "import/ahead.h"
#include "import/mitsuba/mitsuba_tree.h"

struct mitsuba_id {
    const char *name;
    struct mitsuba_node *node;
};

struct mitsuba {
    struct scene_desc *desc;
    char *directory; /* file names start here */
    struct ahead *ahead;
    struct mitsuba_node *root;
    struct mitsuba_id *ids; /* sorted by name */
    size_t id_count, id_capacity;
    struct mitsuba_id *aliases; /* until they are ids, too */
    size_t alias_count, alias_capacity;
    int major;       /* of the version */
    bool old;        /* 0.x: other defaults */
    int entered;     /* objects that are being read, one inside the other */
    int two_sided;   /* depth of "twosided" around the material that is being read */
    int in_group;    /* the desc's number of the shapegroup that is being read, or 0 */
    int defaults[2]; /* materials of shapes without one: [emits]; -1 before */
};

/* The object whose id the node's attribute "id" names; NULL after an error. */
struct mitsuba_node *mitsuba_find(struct mitsuba *m, struct mitsuba_node *node,
                                  struct err *err);
/* The object that a <ref> refers to (another node: itself); NULL after an error. */
struct mitsuba_node *mitsuba_resolve(struct mitsuba *m, struct mitsuba_node *node,
                                     struct err *err);
/* The first child that is an object of this element, or a reference to one; *child is
 * NULL if there is none. False only if a reference leads nowhere. */
bool mitsuba_child(struct mitsuba *m, const struct mitsuba_node *object,
                   const char *element, struct mitsuba_node **child, struct err *err);
/* Called when the reading of an object that may contain others begins and ends: fails if
 * it contains itself or references are nested too deeply. */
bool mitsuba_enter(struct mitsuba *m, struct mitsuba_node *object, struct err *err);
void mitsuba_leave(struct mitsuba *m, struct mitsuba_node *object);
/* The "type" of an object; "" if it has none. */
const char *mitsuba_type(const struct mitsuba_node *object);
/* A counted note for each property and child that nobody asked for. */
void mitsuba_report(struct mitsuba *m, const struct mitsuba_node *object);
/* Notes an unknown plugin, with the nearest known name (NULL-terminated list) and what
 * comes in its place. */
void mitsuba_unknown(struct mitsuba *m, const struct mitsuba_node *object,
                     const char *const *known, const char *instead);

#endif
