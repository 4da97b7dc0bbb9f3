#ifndef ETALON_IMPORT_PBRT_PARAMS_H
#define ETALON_IMPORT_PBRT_PARAMS_H

/* The tail of a pbrt directive: quoted heads (names, kinds), then typed parameters. Each
 * parameter knows its place and whether anybody asked for it. */

#include "base/log.h"
#include "import/pbrt/pbrt_lexer.h"

enum pbrt_type {
    PBRT_FLOAT = 1,
    PBRT_INTEGER = 2,
    PBRT_BOOL = 4,
    PBRT_STRING = 8,
    PBRT_POINT2 = 16,
    PBRT_VECTOR2 = 32,
    PBRT_POINT = 64,
    PBRT_VECTOR = 128,
    PBRT_NORMAL = 256,
    PBRT_RGB = 512,
    PBRT_XYZ = 1024,
    PBRT_BLACKBODY = 2048,
    PBRT_SPECTRUM = 4096, /* numbers in pairs, or a file name */
    PBRT_TEXTURE = 8192,
};

#define PBRT_COLOUR (PBRT_RGB | PBRT_XYZ | PBRT_BLACKBODY | PBRT_SPECTRUM)

struct pbrt_param {
    enum pbrt_type type;
    const char *type_name; /* as written, for messages */
    size_t name;           /* offset into chars */
    size_t first, count; /* numbers (bools are 0 and 1), or offset of the first string */
    bool is_string;
    bool used;
    struct place place;
};

#define PBRT_HEADS 3

struct pbrt_params {
    struct pbrt_param *list;
    size_t count, capacity;
    size_t own; /* of them, those of the directive itself; others stand behind */
    double *numbers;
    size_t number_count, number_capacity;
    char *chars;
    size_t char_count, char_capacity;
    size_t heads[PBRT_HEADS];
    struct place head_places[PBRT_HEADS];
    struct place place; /* of the directive */
};

void pbrt_params_deinit(struct pbrt_params *params);

/* Reads `heads` quoted strings, then (if with_list) parameters up to the next word. What
 * was held before is forgotten. */
bool pbrt_params_parse(struct pbrt_params *params, struct pbrt_lexer *lexer, int heads,
                       bool with_list, const struct place *at, struct err *err);
/* Adds those of another list behind one's own, which hide those of the same name; they
 * count as used. */
void pbrt_params_append(struct pbrt_params *params, const struct pbrt_params *more);
/* One list of numbers, "[1 2 3]" or exactly `count` bare ones, into values. */
bool pbrt_params_read_numbers(struct pbrt_lexer *lexer, int count, double *values,
                              struct err *err);

const char *pbrt_params_head(const struct pbrt_params *params, int index);
/* The parameter of that name and one of the types (a mask), marked as used; or NULL. Of
 * two the later counts. */
const struct pbrt_param *pbrt_params_find(struct pbrt_params *params, const char *name,
                                          unsigned types);
const char *pbrt_params_name(const struct pbrt_params *params,
                             const struct pbrt_param *param);
const double *pbrt_params_numbers(const struct pbrt_params *params,
                                  const struct pbrt_param *param);
const char *pbrt_params_text(const struct pbrt_params *params,
                             const struct pbrt_param *param);
/* A text of the list "string materials"; all other lists hold one at most. index <
 * param->count. */
const char *pbrt_params_text_at(const struct pbrt_params *params,
                                const struct pbrt_param *param, size_t index);

/* Single values; *value is untouched if the parameter is absent. An error if it holds
 * another count of values. */
bool pbrt_params_float(struct pbrt_params *params, const char *name, double *value,
                       struct err *err);
/* The same of one point; *found: there is such a parameter. */
bool pbrt_params_point(struct pbrt_params *params, const char *name, double value[3],
                       bool *found, struct err *err);
bool pbrt_params_int(struct pbrt_params *params, const char *name, int *value,
                     struct err *err);
bool pbrt_params_bool(struct pbrt_params *params, const char *name, bool *value,
                      struct err *err);

/* Marks all of a NULL-terminated list of names as used: known to mean nothing here. */
void pbrt_params_ignore(struct pbrt_params *params, const char *const *names);
/* Notes what nobody asked for: unused parameter "float foo" of Shape "sphere". */
void pbrt_params_report(const struct pbrt_params *params, const char *directive,
                        struct log *log);

#endif
