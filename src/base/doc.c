#include "base/doc_node.h"

#include "base/mem.h"
#include "base/text.h"

#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#define DOC_MAX_DEPTH 64
/* Limit of expanded nodes. Aliases share nodes, so a small file can describe a huge tree,
 * of which a reader would visit every copy. */
#define DOC_MAX_EXPANDED 10000000L

static struct place mark_place(const struct doc *doc, yaml_mark_t mark)
{
    return (struct place){doc->name, (int)mark.line + 1, (int)mark.column + 1};
}

/* Reader errors (bad encoding) come with a byte offset alone. */
static struct place offset_place(const struct doc *doc, const char *text, size_t size,
                                 size_t offset)
{
    struct place at = {doc->name, 1, 1};
    for (size_t i = 0; i < offset && i < size; i++) {
        at.col++;
        if (text[i] == '\n') {
            at.line++;
            at.col = 1;
        }
    }
    return at;
}

static bool parser_error(const struct doc *doc, const yaml_parser_t *parser,
                         const char *text, size_t size, struct err *err)
{
    if (parser->error == YAML_MEMORY_ERROR)
        return err_set(err, ERR_SYNTAX, &(struct place){doc->name, 0, 0},
                       "the document is too large");
    if (parser->error == YAML_READER_ERROR) {
        struct place at = offset_place(doc, text, size, parser->problem_offset);
        return err_set(err, ERR_SYNTAX, &at, "%s", parser->problem);
    }
    struct place at = mark_place(doc, parser->problem_mark);
    return err_set(err, ERR_SYNTAX, &at, "%s%s%s", parser->context ? parser->context : "",
                   parser->context ? ": " : "", parser->problem);
}

static bool copy_scalar(struct doc_node *node, const yaml_node_t *from, struct err *err)
{
    const char *text = (const char *)from->data.scalar.value;
    size_t length = from->data.scalar.length;
    struct place at = doc_place(node);
    if (memchr(text, '\0', length))
        return err_set(err, ERR_SYNTAX, &at, "text with a zero byte in it");
    node->kind = DOC_SCALAR;
    node->text = text_copy_n(text, length);
    node->plain = from->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    return true;
}

static void copy_list(struct doc *doc, struct doc_node *node, const yaml_node_t *from)
{
    const yaml_node_item_t *item = from->data.sequence.items.start;
    node->kind = DOC_LIST;
    node->count = (int)(from->data.sequence.items.top - item);
    /* NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are meant */
    node->values = mem_alloc((size_t)node->count, sizeof *node->values);
    for (int i = 0; i < node->count; i++)
        node->values[i] = &doc->nodes[item[i] - 1];
}

static void copy_map(struct doc *doc, struct doc_node *node, const yaml_node_t *from)
{
    const yaml_node_pair_t *pair = from->data.mapping.pairs.start;
    node->kind = DOC_MAP;
    node->count = (int)(from->data.mapping.pairs.top - pair);
    /* NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are meant */
    node->keys = mem_alloc((size_t)node->count, sizeof *node->keys);
    /* NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are meant */
    node->values = mem_alloc((size_t)node->count, sizeof *node->values);
    for (int i = 0; i < node->count; i++) {
        node->keys[i] = &doc->nodes[pair[i].key - 1];
        node->values[i] = &doc->nodes[pair[i].value - 1];
    }
}

static int compare_keys(const void *a, const void *b)
{
    const struct doc_node *x = *(const struct doc_node *const *)a;
    const struct doc_node *y = *(const struct doc_node *const *)b;
    int order = strcmp(x->text, y->text);
    if (order == 0)
        order = (x > y) - (x < y); /* libyaml numbers nodes in file order */
    return order;
}

static bool check_map(const struct doc_node *map, struct err *err)
{
    for (int i = 0; i < map->count; i++) {
        struct place at = doc_place(map->keys[i]);
        if (map->keys[i]->kind != DOC_SCALAR)
            return err_set(err, ERR_SYNTAX, &at, "a key must be plain text");
    }
    /* NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are meant */
    size_t size = sizeof *map->keys;
    struct doc_node **sorted = mem_alloc((size_t)map->count, size);
    memcpy(sorted, map->keys, (size_t)map->count * size);
    qsort(sorted, (size_t)map->count, size, compare_keys);
    bool ok = true;
    for (int i = 1; ok && i < map->count; i++) {
        struct place at = doc_place(sorted[i]);
        if (text_equal(sorted[i - 1]->text, sorted[i]->text))
            ok = err_set(err, ERR_SYNTAX, &at, "key '%s' is already given at line %d",
                         sorted[i]->text, sorted[i - 1]->line);
    }
    mem_free(sorted);
    return ok;
}

/* Depth-first over the graph, each node once: no cycles, not too deep, not too large.
 * The recursion is bounded by check_nesting. */
static bool check_graph(struct doc_node *node, int depth, struct err *err)
{
    struct place at = doc_place(node);
    if (node->state == OPEN)
        return err_set(err, ERR_SYNTAX, &at, "this node contains itself by an alias");
    if (node->state == DONE) {
        /* an alias adds the height of its node */
        return depth + node->height - 1 <= DOC_MAX_DEPTH ||
               err_set(err, ERR_SYNTAX, &at, "nested deeper than %d levels",
                       DOC_MAX_DEPTH);
    }
    node->state = OPEN;
    node->height = 1;
    node->expanded = 1 + (node->kind == DOC_MAP ? node->count : 0);
    for (int i = 0; i < node->count; i++) {
        struct doc_node *child = node->values[i];
        if (!check_graph(child, depth + 1, err))
            return false;
        if (node->height < child->height + 1)
            node->height = child->height + 1;
        node->expanded += child->expanded;
        if (node->expanded > DOC_MAX_EXPANDED)
            return err_set(err, ERR_SYNTAX, &at,
                           "aliases make this node stand for more than %ld nodes",
                           DOC_MAX_EXPANDED);
    }
    node->state = DONE;
    return node->kind != DOC_MAP || check_map(node, err);
}

static bool build(struct doc *doc, yaml_document_t *from, struct err *err)
{
    const yaml_node_t *nodes = from->nodes.start;
    doc->node_count = (int)(from->nodes.top - nodes);
    if (doc->node_count == 0)
        return err_set(err, ERR_SYNTAX, &(struct place){doc->name, 0, 0},
                       "the file is empty");
    doc->nodes = mem_alloc((size_t)doc->node_count, sizeof *doc->nodes);
    for (int i = 0; i < doc->node_count; i++) {
        struct doc_node *node = &doc->nodes[i];
        struct place at = mark_place(doc, nodes[i].start_mark);
        node->doc = doc;
        node->line = at.line;
        node->col = at.col;
        if (nodes[i].type == YAML_SEQUENCE_NODE)
            copy_list(doc, node, &nodes[i]);
        else if (nodes[i].type == YAML_MAPPING_NODE)
            copy_map(doc, node, &nodes[i]);
        else if (!copy_scalar(node, &nodes[i], err))
            return false;
    }
    doc->root = &doc->nodes[0];
    return check_graph(&doc->nodes[0], 1, err);
}

static bool no_more(const struct doc *doc, yaml_parser_t *parser, const char *text,
                    size_t size, struct err *err)
{
    yaml_document_t document;
    if (!yaml_parser_load(parser, &document))
        return parser_error(doc, parser, text, size, err);
    struct place at = mark_place(doc, document.start_mark);
    bool empty = !yaml_document_get_root_node(&document);
    yaml_document_delete(&document);
    return empty || err_set(err, ERR_SYNTAX, &at, "a second document begins here");
}

/* Checks the nesting before libyaml builds its tree: libyaml's time is quadratic in the
 * depth of brackets, so a small hostile file could block the program for minutes. */
static bool check_nesting(const struct doc *doc, const char *text, size_t size,
                          struct err *err)
{
    yaml_parser_t parser;
    yaml_event_t event;
    bool ok = true, more = true;
    int depth = 0;
    if (!yaml_parser_initialize(&parser))
        return err_set(err, ERR_IO, NULL, "no memory for the YAML parser");
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
    while (more && yaml_parser_parse(&parser, &event)) {
        struct place at = mark_place(doc, event.start_mark);
        bool opens = event.type == YAML_SEQUENCE_START_EVENT ||
                     event.type == YAML_MAPPING_START_EVENT;
        bool closes = event.type == YAML_SEQUENCE_END_EVENT ||
                      event.type == YAML_MAPPING_END_EVENT;
        depth += opens - closes;
        if (depth > DOC_MAX_DEPTH)
            ok = err_set(err, ERR_SYNTAX, &at, "nested deeper than %d levels",
                         DOC_MAX_DEPTH);
        more = ok && event.type != YAML_STREAM_END_EVENT;
        yaml_event_delete(&event);
    }
    yaml_parser_delete(&parser);
    return ok; /* the second reading reports a syntax error */
}

/* Reads the one document of `parser` into doc. */
static bool load(struct doc *doc, yaml_parser_t *parser, const char *text, size_t size,
                 struct err *err)
{
    yaml_document_t document;
    yaml_parser_set_input_string(parser, (const unsigned char *)text, size);
    if (!yaml_parser_load(parser, &document))
        return parser_error(doc, parser, text, size, err);
    bool ok = build(doc, &document, err) && no_more(doc, parser, text, size, err);
    yaml_document_delete(&document);
    return ok;
}

struct doc *doc_parse(const char *text, size_t size, const char *name, struct err *err)
{
    struct doc *doc = mem_alloc(1, sizeof *doc);
    doc->name = text_copy(name);
    yaml_parser_t parser;
    bool ok = yaml_parser_initialize(&parser)
                  ? check_nesting(doc, text, size, err) &&
                        load(doc, &parser, text, size, err)
                  : err_set(err, ERR_IO, NULL, "no memory for the YAML parser");
    yaml_parser_delete(&parser);
    if (ok)
        return doc;
    doc_destroy(doc);
    return NULL;
}

struct doc *doc_load(const char *path, struct err *err)
{
    size_t size;
    char *text = text_read_file(path, &size, NULL, err);
    if (!text)
        return NULL;
    struct doc *doc = doc_parse(text, size, path, err);
    mem_free(text);
    return doc;
}

void doc_destroy(struct doc *doc)
{
    if (!doc)
        return;
    for (int i = 0; i < doc->node_count; i++) {
        mem_free(doc->nodes[i].text);
        mem_free(doc->nodes[i].keys);
        mem_free(doc->nodes[i].values);
    }
    mem_free(doc->nodes);
    mem_free(doc->name);
    mem_free(doc);
}
