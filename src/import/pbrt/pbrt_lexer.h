#ifndef ETALON_IMPORT_PBRT_LEXER_H
#define ETALON_IMPORT_PBRT_LEXER_H

/* Tokens of pbrt's scene language, each with its place, through included files. */

#include "base/err.h"

#include <stdbool.h>
#include <stddef.h>

#define PBRT_INCLUDE_DEPTH 32
#define PBRT_INCLUDES_MAX  10000

enum pbrt_token_kind {
    PBRT_TOKEN_END,
    PBRT_TOKEN_WORD,
    PBRT_TOKEN_STRING,
    PBRT_TOKEN_NUMBER,
    PBRT_TOKEN_OPEN,
    PBRT_TOKEN_CLOSE,
};

struct pbrt_token {
    enum pbrt_token_kind kind;
    const char *text; /* words and strings, unescaped; until the next token is read */
    double number;    /* finite and within the range of float */
    struct place place;
};

struct pbrt_source {
    char *data, *real_path;
    const char *at, *end, *line_start;
    const char *name; /* kept by the desc */
    int line;
};

struct scene_desc;

struct pbrt_lexer {
    struct scene_desc *desc; /* keeps the file names */
    struct pbrt_source sources[PBRT_INCLUDE_DEPTH];
    int depth;
    int included; /* files so far */
    struct pbrt_token peeked;
    bool has_peeked;
    char *buffer;
    size_t buffer_capacity;
};

bool pbrt_lexer_init(struct pbrt_lexer *lexer, struct scene_desc *desc, const char *path,
                     struct err *err);
void pbrt_lexer_deinit(struct pbrt_lexer *lexer);

/* At the end of an included file it goes on in the including one. */
bool pbrt_lexer_next(struct pbrt_lexer *lexer, struct pbrt_token *token, struct err *err);
bool pbrt_lexer_peek(struct pbrt_lexer *lexer, const struct pbrt_token **token,
                     struct err *err);
/* Whether the file that the lexer is in has this text behind the place that it reached.
 */
bool pbrt_lexer_has_ahead(const struct pbrt_lexer *lexer, const char *text);
/* The next token comes from the file, which gzip may have packed; it may not already be
 * open. Nothing may be peeked. */
bool pbrt_lexer_include(struct pbrt_lexer *lexer, const char *path,
                        const struct place *at, struct err *err);

/* "number 3", "word Foo", ... for messages; text holds size bytes. */
void pbrt_token_describe(const struct pbrt_token *token, char *text, size_t size);

#endif
