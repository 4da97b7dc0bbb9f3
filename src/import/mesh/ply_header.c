#include "import/mesh/ply_header.h"

#include "base/text.h"

#include <string.h>

#define LINE_MAX_LENGTH 1024
#define WORDS           6

struct reader {
    const char *data, *file;
    size_t size, at;
    int line;
    char text[LINE_MAX_LENGTH]; /* the current line, cut into words */
    char *words[WORDS];
    int word_count;
};

static const struct {
    const char *name, *modern_name;
    size_t size;
} types[] = {
    [PLY_INT8] = {"char", "int8", 1},        [PLY_UINT8] = {"uchar", "uint8", 1},
    [PLY_INT16] = {"short", "int16", 2},     [PLY_UINT16] = {"ushort", "uint16", 2},
    [PLY_INT32] = {"int", "int32", 4},       [PLY_UINT32] = {"uint", "uint32", 4},
    [PLY_FLOAT32] = {"float", "float32", 4}, [PLY_FLOAT64] = {"double", "float64", 8},
};

size_t ply_type_size(enum ply_type type)
{
    return types[type].size;
}

bool ply_type_is_integer(enum ply_type type)
{
    return type >= PLY_INT8 && type <= PLY_UINT32;
}

static struct place here(const struct reader *r)
{
    return (struct place){r->file, r->line, 0};
}

static bool fail(const struct reader *r, struct err *err, const char *message)
{
    struct place at = here(r);
    return err_set(err, ERR_SYNTAX, &at, "%s", message);
}

static void cut_words(struct reader *r)
{
    char *save = NULL;
    r->word_count = 0;
    for (char *w = strtok_r(r->text, " \t\r", &save); w && r->word_count < WORDS;
         w = strtok_r(NULL, " \t\r", &save))
        r->words[r->word_count++] = w;
}

static bool next_line(struct reader *r, struct err *err)
{
    r->line++;
    const char *start = r->data + r->at;
    const char *newline = memchr(start, '\n', r->size - r->at);
    if (!newline)
        return fail(r, err, "the PLY header has no end_header");
    size_t length = (size_t)(newline - start);
    if (length >= sizeof r->text || memchr(start, '\0', length))
        return fail(r, err, "not a line of a PLY header");
    memcpy(r->text, start, length);
    r->text[length] = '\0';
    r->at += length + 1;
    cut_words(r);
    return true;
}

static bool parse_type(const struct reader *r, const char *name, enum ply_type *type,
                       struct err *err)
{
    for (int i = PLY_INT8; i <= PLY_FLOAT64; i++) {
        if (text_equal(name, types[i].name) || text_equal(name, types[i].modern_name)) {
            *type = (enum ply_type)i;
            return true;
        }
    }
    struct place at = here(r);
    return err_set(err, ERR_SYNTAX, &at, "unknown PLY type \"%.40s\"", name);
}

static bool parse_name(const struct reader *r, const char *word, char name[PLY_NAME],
                       struct err *err)
{
    size_t length = strlen(word);
    if (length >= PLY_NAME)
        return fail(r, err, "the name is too long");
    memcpy(name, word, length + 1);
    return true;
}

static bool parse_count(const char *word, uint64_t *count)
{
    *count = 0;
    if (*word == '\0' || strlen(word) > 18) /* far beyond any file's size */
        return false;
    for (; *word; word++) {
        if (*word < '0' || *word > '9')
            return false;
        *count = *count * 10 + (uint64_t)(*word - '0');
    }
    return true;
}

static bool parse_element(struct reader *r, struct ply_header *h, struct err *err)
{
    if (r->word_count != 3)
        return fail(r, err, "\"element <name> <count>\" wanted");
    if (h->element_count == PLY_ELEMENTS)
        return fail(r, err, "too many elements");
    for (int i = 0; i < h->element_count; i++)
        if (text_equal(h->elements[i].name, r->words[1]))
            return fail(r, err, "an element of this name stands above");
    struct ply_element *e = &h->elements[h->element_count++];
    e->line = r->line;
    e->col = (int)(r->words[2] - r->text) + 1;
    if (!parse_count(r->words[2], &e->count))
        return fail(r, err, "the element's count is not a count");
    return parse_name(r, r->words[1], e->name, err);
}

static bool parse_property(struct reader *r, struct ply_header *h, struct err *err)
{
    bool list = r->word_count > 1 && text_equal(r->words[1], "list");
    if (r->word_count != (list ? 5 : 3))
        return fail(r, err,
                    "\"property <type> <name>\" or \"property list <type> <type> "
                    "<name>\" wanted");
    if (h->element_count == 0)
        return fail(r, err, "a property before any element");
    struct ply_element *e = &h->elements[h->element_count - 1];
    if (e->property_count == PLY_PROPERTIES)
        return fail(r, err, "too many properties");
    struct ply_property *p = &e->properties[e->property_count];
    if (!parse_name(r, r->words[r->word_count - 1], p->name, err) ||
        !parse_type(r, r->words[r->word_count - 2], &p->type, err) ||
        (list && !parse_type(r, r->words[2], &p->count_type, err)))
        return false;
    for (int i = 0; i < e->property_count; i++)
        if (text_equal(e->properties[i].name, p->name))
            return fail(r, err, "a property of this name stands above");
    if (list && !ply_type_is_integer(p->count_type))
        return fail(r, err, "the length of a list must be of an integer type");
    e->property_count++;
    return true;
}

static bool parse_format(struct reader *r, struct ply_header *h, struct err *err)
{
    static const char *const names[] = {"ascii", "binary_little_endian",
                                        "binary_big_endian"};
    if (r->word_count == 3 && text_equal(r->words[0], "format") &&
        text_equal(r->words[2], "1.0")) {
        for (int i = 0; i < 3; i++) {
            if (text_equal(r->words[1], names[i])) {
                h->format = (enum ply_format)i;
                return true;
            }
        }
    }
    return fail(r, err,
                "\"format ascii|binary_little_endian|binary_big_endian 1.0\" wanted");
}

/* The least number of bytes that one row of the element takes. */
static uint64_t row_bytes(const struct ply_header *h, const struct ply_element *e)
{
    uint64_t bytes = 0;
    for (int i = 0; i < e->property_count; i++) {
        const struct ply_property *p = &e->properties[i];
        if (h->format == PLY_ASCII)
            bytes += 2; /* a digit and what parts it from the next */
        else
            bytes += ply_type_size(p->count_type ? p->count_type : p->type);
    }
    return bytes;
}

static bool check_counts(const struct reader *r, const struct ply_header *h,
                         size_t size_most, struct err *err)
{
    size_t follow = size_most - r->at;
    /* The last number of an ascii file may lack its newline. */
    uint64_t left = follow + (h->format == PLY_ASCII);
    for (int i = 0; i < h->element_count; i++) {
        const struct ply_element *e = &h->elements[i];
        uint64_t bytes = row_bytes(h, e);
        struct place at = {r->file, e->line, e->col};
        if (e->property_count == 0 && e->count > 0)
            return err_set(err, ERR_SYNTAX, &at, "element \"%s\" has no properties",
                           e->name);
        if (bytes > 0 && e->count > left / bytes)
            return err_set(err, ERR_VALUE, &at,
                           "the header promises %llu rows of \"%s\", but %s %zu bytes "
                           "follow it",
                           (unsigned long long)e->count, e->name,
                           size_most == r->size ? "only" : "at most", follow);
        left -= bytes * e->count;
    }
    return true;
}

static bool parse_lines(struct reader *r, struct ply_header *h, struct err *err)
{
    if (r->size < 4 || memcmp(r->data, "ply", 3) != 0 || !next_line(r, err) ||
        r->word_count != 1 || !text_equal(r->words[0], "ply"))
        return fail(r, err, "not a PLY file: it does not begin with \"ply\"");
    bool has_format = false;
    for (;;) {
        if (!next_line(r, err))
            return false;
        const char *word = r->word_count ? r->words[0] : "comment";
        if (text_equal(word, "comment") || text_equal(word, "obj_info"))
            continue;
        if (!has_format) {
            if (!parse_format(r, h, err))
                return false;
            has_format = true;
        } else if (text_equal(word, "end_header"))
            return true;
        else if (text_equal(word, "element")) {
            if (!parse_element(r, h, err))
                return false;
        } else if (!text_equal(word, "property"))
            return fail(r, err, "\"element\", \"property\" or \"end_header\" wanted");
        else if (!parse_property(r, h, err))
            return false;
    }
}

bool ply_header_parse(const char *data, size_t size, size_t size_most, const char *file,
                      struct ply_header *header, struct err *err)
{
    struct reader r = {.data = data, .file = file, .size = size};
    memset(header, 0, sizeof *header);
    if (!parse_lines(&r, header, err))
        return false;
    header->data_offset = r.at;
    header->data_line = r.line + 1;
    return check_counts(&r, header, size_most, err);
}
