#ifndef ETALON_IMPORT_PBRT_STATE_H
#define ETALON_IMPORT_PBRT_STATE_H

/* The state that a pbrt file's directives act on: the graphics state with its stack, and
 * the tables of names. */

#include "import/ahead.h"
#include "import/import.h"
#include "import/pbrt/pbrt_lexer.h"
#include "import/pbrt/pbrt_params.h"
#include "scene/scene_desc.h"

#define PBRT_MATERIAL_DEFAULT (-1) /* matte of reflectance .5, made when first used */
#define PBRT_MATERIAL_NONE    (-2) /* a border that light passes through */

/* Which of the two ends of the shutter transforms apply to. */
enum pbrt_active { PBRT_START_TIME = 1, PBRT_END_TIME = 2, PBRT_ALL_TIMES = 3 };

struct pbrt_state {
    struct xform ctm;      /* at the start of the shutter: nothing moves */
    struct place singular; /* line > 0: ctm had no inverse from there on */
    unsigned active;       /* enum pbrt_active */
    int colour_space;      /* pbrt_colour_space.h */
    bool reverse_orientation;
    int material; /* of the desc, or PBRT_MATERIAL_* */
    bool emits;   /* an area light is on */
    bool two_sided;
    struct rgb radiance;
    double power; /* > 0: of the lamp, if radiance had luminance 1: lm, or W */
    size_t named_count, texture_count; /* entries visible here: v3 scopes names */
    size_t attribute_count;            /* parameters of Attribute that hold here */
};

struct pbrt_frame {
    struct pbrt_state state;
    bool transform_only;
    struct place place;
};

struct pbrt_named { /* material, texture, coordinate system or object */
    char *name;
    int material;
    bool is_colour;
    struct rgb value;              /* of a constant texture; a float's in all three */
    const struct texture *texture; /* of any other */
    size_t first, count;           /* shapes of an object, in the desc */
    int object;                    /* its number there */
    struct xform ctm;
    bool unread; /* what it names was in error */
};

struct pbrt_names {
    struct pbrt_named *list;
    size_t count, capacity;
    bool incomplete; /* a file that may hold names was not read */
};

/* LuxRender's objects without a material take that of the instance: a second object, with
 * that material. */
struct pbrt_variant {
    int object, material; /* material: what instances say */
    int placed;           /* the object with it */
};

/* Parameters that the directive Attribute gave to all directives of a kind. */
struct pbrt_attribute {
    const char *target; /* "shape", ... */
    struct pbrt_params params;
};

/* What a material was made of. */
struct pbrt_source_of {
    int material; /* of the desc */
    char *type;
    struct pbrt_params params;
};

/* v3 until something that only v4 has stands in the file. */
enum pbrt_version { PBRT_V3_PRESUMED, PBRT_V4_PRESUMED, PBRT_V3, PBRT_V4 };

struct pbrt {
    struct scene_desc *desc;
    char *directory; /* relative names start in the main file's folder */
    struct ahead *ahead;
    struct pbrt_lexer lexer;
    struct pbrt_params params;
    struct pbrt_state state;
    struct pbrt_frame *stack;
    size_t depth, stack_capacity;
    struct pbrt_names materials, textures, systems, objects;
    int in_object;                 /* number of the object that is open; 0: none */
    struct pbrt_variant *variants; /* of objects that take their instances' materials */
    size_t variant_count, variant_capacity;
    struct pbrt_attribute *attributes;
    size_t attribute_count, attribute_capacity;
    struct pbrt_source_of *sources; /* of v3's materials */
    size_t source_count, source_capacity;
    double film_scale; /* a factor of all emission */
    bool has_filter;
    double shutter; /* v4: seconds that it is open, another such factor */
    enum pbrt_version version;
    bool lux;             /* LuxRender's file: what names and numbers mean differs */
    double lux_index;     /* of the volume named last */
    int default_material; /* -1 until made */
    uint64_t given;       /* bits of the directives, by their rows, of which one counts */
    bool in_world, world_done;
    struct place world_place;
    const struct import_options *options;
    struct err *first_error; /* the caller's */
    bool failed, stopped;    /* an error was told; one after which nothing is read */
    bool uncertain; /* something was passed over that may open and close blocks */
};

void pbrt_state_init(struct pbrt *p, struct scene_desc *desc,
                     const struct import_options *options, struct err *first_error);
void pbrt_state_deinit(struct pbrt *p);
void pbrt_state_push(struct pbrt *p, bool transform_only, const struct place *at);
bool pbrt_state_pop(struct pbrt *p, bool transform_only, const struct place *at,
                    struct err *err);
/* Transforms of the end of the shutter alone are counted and left out. */
bool pbrt_state_moves(struct pbrt *p);
/* CTM = CTM * next, as all of pbrt's transforms; and CTM = next. */
void pbrt_state_concat(struct pbrt *p, const struct xform *next);
void pbrt_state_set(struct pbrt *p, const struct xform *next);
/* An error if the CTM has no inverse: for whatever is placed by it, but told once. */
bool pbrt_state_check(struct pbrt *p, struct err *err);

static inline bool pbrt_is_v4(const struct pbrt *p)
{
    return p->version == PBRT_V4 || p->version == PBRT_V4_PRESUMED;
}

/* The path of a file that the scene names: in the main file's folder or, where there is
 * none, in the current one. To be freed. */
char *pbrt_path(const struct pbrt *p, const char *name);

/* Adds an entry; the newest of a name hides older ones. */
struct pbrt_named *pbrt_names_add(struct pbrt_names *names, const char *name);
void pbrt_names_truncate(struct pbrt_names *names, size_t count);
/* The newest entry, or NULL after an error that suggests the nearest. NULL and no error
 * (ERR_NONE) where an error that was told is the cause. */
const struct pbrt_named *pbrt_names_find(const struct pbrt_names *names, const char *what,
                                         const char *name, const struct place *at,
                                         struct err *err);

#endif
