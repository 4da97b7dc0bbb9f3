#include "import/pbrt/pbrt_params.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/suggest.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <string.h>

struct type_row {
    const char *name;
    enum pbrt_type type;
    size_t width; /* numbers that make one value */
};

static const struct type_row type_rows[] = {
    {"float", PBRT_FLOAT, 1},       {"integer", PBRT_INTEGER, 1},
    {"bool", PBRT_BOOL, 1},         {"string", PBRT_STRING, 1},
    {"point2", PBRT_POINT2, 2},     {"vector2", PBRT_VECTOR2, 2},
    {"point", PBRT_POINT, 3},       {"point3", PBRT_POINT, 3},
    {"vector", PBRT_VECTOR, 3},     {"vector3", PBRT_VECTOR, 3},
    {"normal", PBRT_NORMAL, 3},     {"normal3", PBRT_NORMAL, 3},
    {"rgb", PBRT_RGB, 3},           {"color", PBRT_RGB, 3},
    {"xyz", PBRT_XYZ, 3},           {"blackbody", PBRT_BLACKBODY, 1},
    {"spectrum", PBRT_SPECTRUM, 2}, {"texture", PBRT_TEXTURE, 1},
};

#define TYPE_ROWS (sizeof type_rows / sizeof type_rows[0])

void pbrt_params_deinit(struct pbrt_params *params)
{
    mem_free(params->list);
    mem_free(params->numbers);
    mem_free(params->chars);
    *params = (struct pbrt_params){0};
}

static size_t keep_text(struct pbrt_params *params, const char *text, size_t length)
{
    size_t start = params->char_count;
    params->char_count += length + 1;
    params->chars = mem_grow(params->chars, &params->char_capacity, params->char_count,
                             1);
    memcpy(params->chars + start, text, length);
    params->chars[start + length] = '\0';
    return start;
}

static void keep_number(struct pbrt_params *params, double number)
{
    size_t i = params->number_count++;
    params->numbers = mem_grow(params->numbers, &params->number_capacity,
                               params->number_count, sizeof *params->numbers);
    params->numbers[i] = number;
}

static bool wanted(const struct pbrt_token *token, const char *what, struct err *err)
{
    char text[80];
    pbrt_token_describe(token, text, sizeof text);
    return err_set(err, ERR_SYNTAX, &token->place, "expected %s, got %s", what, text);
}

static bool unknown_type(const struct place *at, const char *name, struct err *err)
{
    const char *known[TYPE_ROWS + 1] = {0};
    for (size_t i = 0; i < TYPE_ROWS; i++)
        known[i] = type_rows[i].name;
    return suggest_fail(err, at, "parameter type", name, known);
}

/* "float radius" into its row and its name. */
static bool split_declaration(struct pbrt_params *params, const struct pbrt_token *token,
                              const struct type_row **row, size_t *name, struct err *err)
{
    const char *blank = " \t";
    const char *type = token->text + strspn(token->text, blank);
    size_t type_length = strcspn(type, blank);
    const char *word = type + type_length + strspn(type + type_length, blank);
    size_t word_length = strcspn(word, blank);
    if (type_length == 0 || word_length == 0 ||
        word[word_length + strspn(word + word_length, blank)] != '\0')
        return err_set(err, ERR_SYNTAX, &token->place,
                       "parameter \"%.80s\" is not of the form \"type name\"",
                       token->text);
    *name = keep_text(params, word, word_length);
    for (size_t i = 0; i < TYPE_ROWS; i++) {
        if (strlen(type_rows[i].name) == type_length &&
            memcmp(type_rows[i].name, type, type_length) == 0) {
            *row = &type_rows[i];
            return true;
        }
    }
    size_t start = keep_text(params, type, type_length);
    return unknown_type(&token->place, params->chars + start, err);
}

static bool take_bool(struct pbrt_params *params, const struct pbrt_token *token,
                      struct err *err)
{
    bool is_true = text_equal(token->text, "true");
    bool is_text = token->kind == PBRT_TOKEN_STRING || token->kind == PBRT_TOKEN_WORD;
    if (!is_text || (!is_true && !text_equal(token->text, "false")))
        return wanted(token, "\"true\" or \"false\"", err);
    keep_number(params, is_true ? 1.0 : 0.0);
    return true;
}

/* The materials of v4's mix; of anything else a second string would be dropped. */
static bool may_hold_many(const struct pbrt_params *params,
                          const struct pbrt_param *param)
{
    return param->type == PBRT_STRING &&
           text_equal(params->chars + param->name, "materials");
}

static bool take_string(struct pbrt_params *params, struct pbrt_param *param,
                        const struct pbrt_token *token, struct err *err)
{
    if (token->kind != PBRT_TOKEN_STRING)
        return wanted(token, "a string", err);
    if (param->count > 0 && !may_hold_many(params, param))
        return err_set(err, ERR_SYNTAX, &token->place,
                       "expected one string here, this is another");
    size_t start = keep_text(params, token->text, strlen(token->text));
    param->first = param->count > 0 ? param->first : start;
    param->is_string = true;
    return true;
}

static bool take_value(struct pbrt_params *params, struct pbrt_param *param,
                       const struct pbrt_token *token, struct err *err)
{
    bool stringy = (param->type & (PBRT_STRING | PBRT_TEXTURE)) ||
                   (param->type == PBRT_SPECTRUM && token->kind == PBRT_TOKEN_STRING);
    if (param->is_string && !stringy)
        return wanted(token, "a string", err);
    bool taken;
    if (param->type == PBRT_BOOL)
        taken = take_bool(params, token, err);
    else if (stringy)
        taken = take_string(params, param, token, err);
    else if (token->kind != PBRT_TOKEN_NUMBER)
        return wanted(token, "a number", err);
    else if (param->type == PBRT_INTEGER &&
             (token->number != trunc(token->number) || token->number > INT_MAX ||
              token->number < INT_MIN))
        return wanted(token, "an integer of 32 bits", err);
    else {
        keep_number(params, token->number);
        taken = true;
    }
    param->count++;
    return taken;
}

/* One bare value, or any number of them in brackets. */
static bool read_values(struct pbrt_params *params, struct pbrt_param *param,
                        struct pbrt_lexer *lexer, struct err *err)
{
    struct pbrt_token token;
    if (!pbrt_lexer_next(lexer, &token, err))
        return false;
    if (token.kind != PBRT_TOKEN_OPEN)
        return take_value(params, param, &token, err);
    for (;;) {
        if (!pbrt_lexer_next(lexer, &token, err))
            return false;
        if (token.kind == PBRT_TOKEN_CLOSE)
            return true;
        if (token.kind == PBRT_TOKEN_END)
            return err_set(err, ERR_SYNTAX, &param->place,
                           "the brackets of this parameter are never closed");
        if (!take_value(params, param, &token, err))
            return false;
    }
}

static bool read_param(struct pbrt_params *params, struct pbrt_lexer *lexer,
                       struct err *err)
{
    struct pbrt_token token;
    if (!pbrt_lexer_next(lexer, &token, err))
        return false;
    const struct type_row *row = NULL;
    struct pbrt_param param = {.place = token.place};
    if (!split_declaration(params, &token, &row, &param.name, err))
        return false;
    assert(row);
    param.type = row->type;
    param.type_name = row->name;
    param.first = params->number_count;
    if (!read_values(params, &param, lexer, err))
        return false;
    const char *name = params->chars + param.name;
    if (!param.is_string && param.count % row->width != 0)
        return err_set(err, ERR_VALUE, &param.place,
                       "\"%s %s\" holds %zu numbers, which is no multiple of %zu",
                       row->name, name, param.count, row->width);
    params->count++;
    params->list = mem_grow(params->list, &params->capacity, params->count,
                            sizeof *params->list);
    params->list[params->count - 1] = param;
    return true;
}

bool pbrt_params_parse(struct pbrt_params *params, struct pbrt_lexer *lexer, int heads,
                       bool with_list, const struct place *at, struct err *err)
{
    params->count = params->own = params->number_count = params->char_count = 0;
    params->place = *at;
    for (int i = 0; i < heads; i++) {
        struct pbrt_token token;
        if (!pbrt_lexer_next(lexer, &token, err))
            return false;
        if (token.kind != PBRT_TOKEN_STRING)
            return wanted(&token, "a quoted name", err);
        params->heads[i] = keep_text(params, token.text, strlen(token.text));
        params->head_places[i] = token.place;
    }
    while (with_list) {
        const struct pbrt_token *token;
        if (!pbrt_lexer_peek(lexer, &token, err))
            return false;
        if (token->kind == PBRT_TOKEN_WORD || token->kind == PBRT_TOKEN_END)
            break;
        if (token->kind != PBRT_TOKEN_STRING)
            return wanted(token, "a parameter (\"type name\") or a directive", err);
        if (!read_param(params, lexer, err))
            return false;
    }
    params->own = params->count;
    return true;
}

/* Takes a copy of its values too. */
static void append(struct pbrt_params *params, const struct pbrt_params *from,
                   struct pbrt_param param)
{
    const char *name = pbrt_params_name(from, &param);
    size_t first = param.is_string ? params->char_count : params->number_count;
    for (size_t i = 0; i < param.count; i++) {
        if (param.is_string) {
            const char *text = pbrt_params_text_at(from, &param, i);
            keep_text(params, text, strlen(text));
        } else {
            keep_number(params, pbrt_params_numbers(from, &param)[i]);
        }
    }
    param.first = first;
    param.name = keep_text(params, name, strlen(name));
    param.used = true;
    params->count++;
    params->list = mem_grow(params->list, &params->capacity, params->count,
                            sizeof *params->list);
    params->list[params->count - 1] = param;
}

void pbrt_params_append(struct pbrt_params *params, const struct pbrt_params *more)
{
    for (size_t i = 0; i < more->own; i++)
        append(params, more, more->list[i]);
}

bool pbrt_params_read_numbers(struct pbrt_lexer *lexer, int count, double *values,
                              struct err *err)
{
    struct pbrt_token token;
    if (!pbrt_lexer_next(lexer, &token, err))
        return false;
    bool open = token.kind == PBRT_TOKEN_OPEN;
    for (int i = 0; i < count; i++) {
        if ((open || i > 0) && !pbrt_lexer_next(lexer, &token, err))
            return false;
        if (token.kind != PBRT_TOKEN_NUMBER) {
            char what[64];
            snprintf(what, sizeof what, "number %d of %d", i + 1, count);
            return wanted(&token, what, err);
        }
        values[i] = token.number;
    }
    if (open && !pbrt_lexer_next(lexer, &token, err))
        return false;
    if (open && token.kind != PBRT_TOKEN_CLOSE)
        return wanted(&token, "]", err);
    return true;
}

const char *pbrt_params_head(const struct pbrt_params *params, int index)
{
    return params->chars + params->heads[index];
}

static struct pbrt_param *find_from(struct pbrt_params *params, size_t first, size_t end,
                                    const char *name, unsigned types)
{
    for (size_t i = end; i-- > first;) {
        struct pbrt_param *p = &params->list[i];
        if ((p->type & types) && text_equal(params->chars + p->name, name)) {
            p->used = true;
            return p;
        }
    }
    return NULL;
}

const struct pbrt_param *pbrt_params_find(struct pbrt_params *params, const char *name,
                                          unsigned types)
{
    struct pbrt_param *own = find_from(params, 0, params->own, name, types);
    return own ? own : find_from(params, params->own, params->count, name, types);
}

const char *pbrt_params_name(const struct pbrt_params *params,
                             const struct pbrt_param *param)
{
    return params->chars + param->name;
}

const double *pbrt_params_numbers(const struct pbrt_params *params,
                                  const struct pbrt_param *param)
{
    return param->is_string ? NULL : params->numbers + param->first;
}

const char *pbrt_params_text(const struct pbrt_params *params,
                             const struct pbrt_param *param)
{
    return param->is_string ? params->chars + param->first : "";
}

const char *pbrt_params_text_at(const struct pbrt_params *params,
                                const struct pbrt_param *param, size_t index)
{
    const char *text = pbrt_params_text(params, param);
    assert(index < param->count);
    while (index-- > 0)
        text += strlen(text) + 1;
    return text;
}

static bool find_one(struct pbrt_params *params, const char *name, unsigned types,
                     const double **value, struct err *err)
{
    const struct pbrt_param *p = pbrt_params_find(params, name, types);
    *value = NULL;
    if (!p)
        return true;
    if (p->count != 1)
        return err_set(err, ERR_VALUE, &p->place,
                       "\"%s %s\" holds %zu values, one is wanted", p->type_name, name,
                       p->count);
    *value = pbrt_params_numbers(params, p);
    return true;
}

bool pbrt_params_float(struct pbrt_params *params, const char *name, double *value,
                       struct err *err)
{
    const double *found;
    if (!find_one(params, name, PBRT_FLOAT, &found, err))
        return false;
    if (found)
        *value = *found;
    return true;
}

bool pbrt_params_int(struct pbrt_params *params, const char *name, int *value,
                     struct err *err)
{
    const double *found;
    if (!find_one(params, name, PBRT_INTEGER, &found, err))
        return false;
    if (found)
        *value = (int)*found;
    return true;
}

bool pbrt_params_bool(struct pbrt_params *params, const char *name, bool *value,
                      struct err *err)
{
    const double *found;
    if (!find_one(params, name, PBRT_BOOL, &found, err))
        return false;
    if (found)
        *value = *found != 0.0;
    return true;
}

void pbrt_params_ignore(struct pbrt_params *params, const char *const *names)
{
    for (; *names; names++)
        pbrt_params_find(params, *names, ~0u);
}

void pbrt_params_report(const struct pbrt_params *params, const char *directive,
                        struct log *log)
{
    for (size_t i = 0; i < params->count; i++) {
        const struct pbrt_param *p = &params->list[i];
        if (!p->used)
            log_note(log, &p->place, "unused parameter \"%s %s\" of %s \"%s\"",
                     p->type_name, params->chars + p->name, directive,
                     pbrt_params_head(params, 0));
    }
}

bool pbrt_params_point(struct pbrt_params *params, const char *name, double value[3],
                       bool *found, struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(params, name, PBRT_POINT);
    *found = param != NULL;
    if (!param)
        return true;
    if (param->count != 3)
        return err_set(err, ERR_VALUE, &param->place, "\"point %s\" is one point", name);
    for (int i = 0; i < 3; i++)
        value[i] = pbrt_params_numbers(params, param)[i];
    return true;
}
