#include "import/pbrt/pbrt_lexer.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/gzip.h"
#include "import/number.h"
#include "scene/scene_desc.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* No scene's text is that long; a file of a thousandth of it could unpack to it. */
#define TEXT_MOST ((size_t)1 << 31)

static char *unpack(struct gzip *gzip, const char *path, size_t *size,
                    const struct place *at, struct err *err)
{
    char *text = NULL;
    size_t capacity = 0, got;
    *size = 0;
    for (;;) {
        const char *piece = gzip_more(gzip, 0, &got, err);
        if (piece && *size + got > TEXT_MOST)
            err_set(err, ERR_VALUE, at, "'%s' unpacks to more than 2 GiB", path);
        if (!piece || *size + got > TEXT_MOST) {
            mem_free(text);
            return NULL;
        }
        text = mem_grow(text, &capacity, *size + got + 1, 1);
        memcpy(text + *size, piece, got);
        *size += got;
        text[*size] = '\0';
        if (got == 0)
            return text;
    }
}

static char *read_text(const char *path, size_t *size, const struct place *at,
                       struct err *err)
{
    if (!text_ends_with(path, ".gz"))
        return text_read_file(path, size, at, err);
    struct gzip *gzip = gzip_open(path, at, err);
    char *text = gzip ? unpack(gzip, path, size, at, err) : NULL;
    gzip_close(gzip);
    return text;
}

static bool push_source(struct pbrt_lexer *lexer, const char *path,
                        const struct place *at, struct err *err)
{
    struct pbrt_source s = {0};
    size_t size;
    s.data = read_text(path, &size, at, err);
    if (!s.data)
        return false;
    char *real = realpath(path, NULL);
    s.real_path = text_copy(real ? real : path);
    free(real);
    for (int i = 0; i < lexer->depth; i++) {
        if (text_equal(lexer->sources[i].real_path, s.real_path)) {
            mem_free(s.data);
            mem_free(s.real_path);
            return err_set(err, ERR_VALUE, at, "\"%s\" includes itself", path);
        }
    }
    s.at = s.line_start = text_skip_mark(s.data);
    s.end = s.data + size;
    s.name = scene_desc_keep(lexer->desc, path);
    s.line = 1;
    lexer->sources[lexer->depth++] = s;
    return true;
}

static void pop_source(struct pbrt_lexer *lexer)
{
    struct pbrt_source *s = &lexer->sources[--lexer->depth];
    mem_free(s->data);
    mem_free(s->real_path);
}

bool pbrt_lexer_init(struct pbrt_lexer *lexer, struct scene_desc *desc, const char *path,
                     struct err *err)
{
    *lexer = (struct pbrt_lexer){.desc = desc};
    return push_source(lexer, path, NULL, err);
}

void pbrt_lexer_deinit(struct pbrt_lexer *lexer)
{
    while (lexer->depth > 0)
        pop_source(lexer);
    mem_free(lexer->buffer);
    *lexer = (struct pbrt_lexer){0};
}

bool pbrt_lexer_has_ahead(const struct pbrt_lexer *lexer, const char *text)
{
    return strstr(lexer->sources[lexer->depth - 1].at, text) != NULL;
}

bool pbrt_lexer_include(struct pbrt_lexer *lexer, const char *path,
                        const struct place *at, struct err *err)
{
    assert(!lexer->has_peeked);
    if (lexer->depth == PBRT_INCLUDE_DEPTH)
        return err_set(err, ERR_VALUE, at, "more than %d files include one another",
                       PBRT_INCLUDE_DEPTH);
    if (++lexer->included > PBRT_INCLUDES_MAX)
        return err_set(err, ERR_VALUE, at, "more than %d files are included",
                       PBRT_INCLUDES_MAX);
    return push_source(lexer, path, at, err);
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_number_start(char c)
{
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

static bool is_separator(char c)
{
    return c == '\0' || is_space(c) || c == '"' || c == '[' || c == ']' || c == '#';
}

static void skip_blank(struct pbrt_source *s)
{
    while (s->at < s->end) {
        if (*s->at == '\n') {
            s->line++;
            s->line_start = s->at + 1;
        } else if (*s->at == '#') {
            while (s->at < s->end && *s->at != '\n')
                s->at++;
            continue;
        } else if (!is_space(*s->at)) {
            break;
        }
        s->at++;
    }
}

static struct place place_of(const struct pbrt_source *s)
{
    return (struct place){s->name, s->line, (int)(s->at - s->line_start) + 1};
}

static char *buffer_room(struct pbrt_lexer *lexer, size_t need)
{
    lexer->buffer = mem_grow(lexer->buffer, &lexer->buffer_capacity, need, 1);
    return lexer->buffer;
}

static bool unescape(char c, char *out)
{
    static const char from[] = "bfnrt\\'\"", to[] = "\b\f\n\r\t\\'\"";
    const char *found = c ? strchr(from, c) : NULL;
    if (found)
        *out = to[found - from];
    return found != NULL;
}

static bool read_string(struct pbrt_lexer *lexer, struct pbrt_source *s,
                        struct pbrt_token *token, struct err *err)
{
    token->kind = PBRT_TOKEN_STRING;
    size_t length = 0;
    for (s->at++; s->at < s->end && *s->at != '\n'; s->at++) {
        char c = *s->at;
        if (c == '"') {
            buffer_room(lexer, length + 1)[length] = '\0';
            token->text = lexer->buffer;
            s->at++;
            return true;
        }
        if (c == '\\') {
            struct place at = place_of(s);
            if (++s->at == s->end || !unescape(*s->at, &c))
                return err_set(err, ERR_SYNTAX, &at, "unknown escape in a string");
        }
        if (c == '\0')
            break;
        buffer_room(lexer, length + 1)[length] = c;
        length++;
    }
    return err_set(err, ERR_SYNTAX, &token->place,
                   "string without a closing quote on its line");
}

static bool read_word(struct pbrt_lexer *lexer, struct pbrt_source *s,
                      struct pbrt_token *token)
{
    token->kind = PBRT_TOKEN_WORD;
    const char *start = s->at;
    while (!is_separator(*s->at))
        s->at++;
    size_t length = (size_t)(s->at - start);
    memcpy(buffer_room(lexer, length + 1), start, length);
    lexer->buffer[length] = '\0';
    token->text = lexer->buffer;
    return true;
}

static bool read_number(struct pbrt_source *s, struct pbrt_token *token, struct err *err)
{
    token->kind = PBRT_TOKEN_NUMBER;
    token->text = "";
    const char *start = s->at;
    const char *after = number_parse(start, &token->number);
    if (after && is_separator(*after)) {
        s->at = after;
        if (fabs(token->number) <= (double)FLT_MAX)
            return true;
        return err_set(err, ERR_VALUE, &token->place,
                       "number beyond the range of float (%.8g)", (double)FLT_MAX);
    }
    while (!is_separator(*s->at))
        s->at++;
    return err_set(err, ERR_VALUE, &token->place, "\"%.*s\" is not a number",
                   s->at - start < 40 ? (int)(s->at - start) : 40, start);
}

static bool read_token(struct pbrt_lexer *lexer, struct pbrt_token *token,
                       struct err *err)
{
    struct pbrt_source *s = &lexer->sources[lexer->depth - 1];
    for (skip_blank(s); s->at == s->end && lexer->depth > 1; skip_blank(s)) {
        pop_source(lexer);
        s = &lexer->sources[lexer->depth - 1];
    }
    *token = (struct pbrt_token){.text = "", .place = place_of(s)};
    if (s->at == s->end)
        return true;
    char c = *s->at;
    if (c == '"')
        return read_string(lexer, s, token, err);
    if (is_letter(c))
        return read_word(lexer, s, token);
    if (is_number_start(c))
        return read_number(s, token, err);
    if (c != '[' && c != ']')
        return err_set(err, ERR_SYNTAX, &token->place, "unexpected byte 0x%02x%s",
                       (unsigned)(unsigned char)c,
                       c == '\'' ? "; strings stand in double quotes" : "");
    token->kind = c == '[' ? PBRT_TOKEN_OPEN : PBRT_TOKEN_CLOSE;
    s->at++;
    return true;
}

bool pbrt_lexer_next(struct pbrt_lexer *lexer, struct pbrt_token *token, struct err *err)
{
    if (!lexer->has_peeked)
        return read_token(lexer, token, err);
    *token = lexer->peeked;
    lexer->has_peeked = false;
    return true;
}

bool pbrt_lexer_peek(struct pbrt_lexer *lexer, const struct pbrt_token **token,
                     struct err *err)
{
    if (!lexer->has_peeked && !read_token(lexer, &lexer->peeked, err))
        return false;
    lexer->has_peeked = true;
    *token = &lexer->peeked;
    return true;
}

void pbrt_token_describe(const struct pbrt_token *token, char *text, size_t size)
{
    switch (token->kind) {
    case PBRT_TOKEN_END:
        snprintf(text, size, "the end of the file");
        break;
    case PBRT_TOKEN_WORD:
        snprintf(text, size, "%.60s", token->text);
        break;
    case PBRT_TOKEN_STRING:
        snprintf(text, size, "\"%.60s\"", token->text);
        break;
    case PBRT_TOKEN_NUMBER:
        snprintf(text, size, "%g", token->number);
        break;
    case PBRT_TOKEN_OPEN:
        snprintf(text, size, "[");
        break;
    case PBRT_TOKEN_CLOSE:
        snprintf(text, size, "]");
        break;
    }
}
