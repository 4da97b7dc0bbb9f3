#include "import/mitsuba/mitsuba_tree.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/mitsuba/mitsuba_parameter.h"

#include <expat.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define CHUNK (1 << 20) /* libexpat counts in int */

struct builder;

/* One open file. */
struct source {
    struct builder *builder;
    const struct source *outer; /* that includes this one, or NULL */
    XML_Parser parser;
    const char *name;
    char *real_path;
    int depth;    /* of open elements in this file */
    bool spliced; /* its <scene> is left out: the children go to the includer's element */
};

struct builder {
    struct scene_desc *desc;
    char *directory; /* of the outermost file */
    struct mitsuba_node *root;
    struct mitsuba_node *open[MITSUBA_NEST_DEPTH];
    int open_count;
    struct mitsuba_parameters parameters;
    int file_count;
    struct err *err;
    bool failed;
};

void mitsuba_tree_destroy(struct mitsuba_node *node)
{
    if (!node)
        return;
    for (size_t i = 0; i < node->child_count; i++)
        mitsuba_tree_destroy(node->children[i]);
    for (size_t i = 0; i < node->attribute_count; i++) {
        mem_free(node->attributes[i].name);
        mem_free(node->attributes[i].value);
    }
    mem_free(node->children);
    mem_free(node->attributes);
    mem_free(node->name);
    mem_free(node);
}

const char *mitsuba_attribute(const struct mitsuba_node *node, const char *name)
{
    for (size_t i = 0; i < node->attribute_count; i++)
        if (text_equal(node->attributes[i].name, name))
            return node->attributes[i].value;
    return NULL;
}

static struct place place_now(const struct source *s)
{
    return (struct place){s->name, (int)XML_GetCurrentLineNumber(s->parser),
                          (int)XML_GetCurrentColumnNumber(s->parser) + 1};
}

static void stop(struct source *s)
{
    s->builder->failed = true;
    XML_StopParser(s->parser, XML_FALSE);
}

static bool fill_attributes(const struct builder *b, struct mitsuba_node *node,
                            const char **pairs)
{
    size_t count = 0;
    while (pairs[2 * count])
        count++;
    node->attributes = mem_alloc(count + 1, sizeof *node->attributes);
    for (size_t i = 0; i < count; i++) {
        char *value = mitsuba_parameters_replace(&b->parameters, pairs[2 * i + 1],
                                                 &node->place, b->err);
        if (!value)
            return false;
        node->attributes[i] = (struct mitsuba_attribute){text_copy(pairs[2 * i]), value};
        node->attribute_count++;
    }
    return true;
}

static bool define(struct builder *b, struct mitsuba_node *node)
{
    const char *name = mitsuba_attribute(node, "name");
    const char *value = mitsuba_attribute(node, "value");
    node->used = true;
    if (!name || !*name || !value)
        return err_set(b->err, ERR_SYNTAX, &node->place,
                       "<default> wants a name and a value");
    mitsuba_parameters_default(&b->parameters, name, value);
    return true;
}

static bool read_source(struct builder *b, const struct source *outer, const char *path,
                        const struct place *at);

/* Relative to the outermost file as in Mitsuba, else to the including file. */
static bool include(struct source *s, struct mitsuba_node *node)
{
    struct stat info;
    const char *name = mitsuba_attribute(node, "filename");
    node->used = true;
    if (!name)
        return err_set(s->builder->err, ERR_SYNTAX, &node->place,
                       "<include> wants a filename");
    char *path = text_join(s->builder->directory, name);
    if (stat(path, &info) != 0) {
        char *directory = text_directory(s->name);
        mem_free(path);
        path = text_join(directory, name);
        mem_free(directory);
    }
    bool read = read_source(s->builder, s, path, &node->place);
    mem_free(path);
    return read;
}

static bool attach(struct source *s, struct mitsuba_node *node)
{
    struct builder *b = s->builder;
    if (b->open_count == MITSUBA_NEST_DEPTH)
        return err_set(b->err, ERR_SYNTAX, &node->place,
                       "more than %d elements inside one another", MITSUBA_NEST_DEPTH);
    if (b->open_count == 0 && !text_equal(node->name, "scene"))
        return err_set(b->err, ERR_SYNTAX, &node->place,
                       "this is no Mitsuba scene: the outermost element is <%s>, not "
                       "<scene>",
                       node->name);
    if (text_equal(node->name, "default") && !define(b, node))
        return false;
    if (text_equal(node->name, "include") && !include(s, node))
        return false;
    b->open[b->open_count++] = node;
    return true;
}

static void adopt(struct builder *b, struct mitsuba_node *node)
{
    if (b->open_count == 0) {
        b->root = node;
        return;
    }
    struct mitsuba_node *parent = b->open[b->open_count - 1];
    parent->children = mem_grow(parent->children, &parent->child_capacity,
                                parent->child_count + 1, sizeof(struct mitsuba_node *));
    parent->children[parent->child_count++] = node;
}

/* <spectrum type="plugin"> is an object, as <texture type="plugin"> is and may be one. */
static void name_object(struct mitsuba_node *node)
{
    if (!text_equal(node->name, "spectrum") || !mitsuba_attribute(node, "type"))
        return;
    mem_free(node->name);
    node->name = text_copy("texture");
}

static void start_element(void *context, const char *name, const char **attributes)
{
    struct source *s = context;
    struct builder *b = s->builder;
    if (b->failed)
        return;
    if (s->depth++ == 0 && s->outer && text_equal(name, "scene")) {
        s->spliced = true;
        return;
    }
    struct mitsuba_node *node = mem_alloc(1, sizeof *node);
    node->name = text_copy(name);
    node->place = place_now(s);
    node->material[0] = node->material[1] = -1;
    adopt(b, node); /* the tree owns it, come what may */
    if (!fill_attributes(b, node, attributes) || !attach(s, node))
        stop(s);
    else
        name_object(node);
}

static void end_element(void *context, const char *name)
{
    struct source *s = context;
    (void)name;
    if (s->builder->failed)
        return;
    if (--s->depth > 0 || !s->spliced)
        s->builder->open_count--;
}

static void character_data(void *context, const char *text, int length)
{
    struct source *s = context;
    for (int i = 0; i < length; i++) {
        if (strchr(" \t\r\n", text[i]))
            continue;
        struct place at = place_now(s);
        log_note(&s->builder->desc->log, &at, "text between elements is not read");
        return;
    }
}

/* Entities are refused: Mitsuba's files need none, and they can expand a kilobyte to a
 * gigabyte. */
static void entity_declaration(void *context, const char *name, int is_parameter,
                               const char *value, int length, const char *base,
                               const char *system, const char *public, const char *kind)
{
    struct source *s = context;
    struct place at = place_now(s);
    (void)is_parameter, (void)value, (void)length;
    (void)base, (void)system, (void)public, (void)kind;
    err_set(s->builder->err, ERR_UNSUPPORTED, &at,
            "the entity \"%.80s\" is declared here; entities are not read", name);
    stop(s);
}

static bool parse(struct source *s, const char *data, size_t size)
{
    XML_SetUserData(s->parser, s);
    XML_SetElementHandler(s->parser, start_element, end_element);
    XML_SetCharacterDataHandler(s->parser, character_data);
    XML_SetEntityDeclHandler(s->parser, entity_declaration);
    for (bool last = false; !last;) {
        int length = size < CHUNK ? (int)size : CHUNK;
        last = size <= CHUNK;
        if (XML_Parse(s->parser, data, length, last) == XML_STATUS_OK) {
            data += length;
            size -= (size_t)length;
            continue;
        }
        struct place at = place_now(s);
        if (s->builder->failed)
            return false;
        s->builder->failed = true;
        return err_set(s->builder->err, ERR_SYNTAX, &at, "not well-formed XML: %s",
                       XML_ErrorString(XML_GetErrorCode(s->parser)));
    }
    return true;
}

static bool check_loop(const struct source *s, const struct place *at, struct err *err)
{
    int depth = 0;
    for (const struct source *o = s->outer; o; o = o->outer, depth++)
        if (text_equal(o->real_path, s->real_path))
            return err_set(err, ERR_VALUE, at, "\"%s\" includes itself", s->name);
    if (depth > MITSUBA_INCLUDE_DEPTH)
        return err_set(err, ERR_VALUE, at, "more than %d files include one another",
                       MITSUBA_INCLUDE_DEPTH);
    return ++s->builder->file_count <= MITSUBA_INCLUDES_MAX ||
           err_set(err, ERR_VALUE, at, "more than %d files are included",
                   MITSUBA_INCLUDES_MAX);
}

/* XML forbids -- within a comment; the first dash of such becomes a blank. */
static void mend_comments(char *data)
{
    for (char *c = data; (c = strstr(c, "<!--"));) {
        char *dashes = c + 4;
        while ((dashes = strstr(dashes, "--")) && dashes[2] != '>')
            *dashes++ = ' ';
        if (!dashes)
            return; /* it has no end: for the parser to say */
        c = dashes + 3;
    }
}

static bool read_source(struct builder *b, const struct source *outer, const char *path,
                        const struct place *at)
{
    size_t size;
    char *data = text_read_file(path, &size, at, b->err);
    if (!data)
        return false;
    mend_comments(data);
    char *real = realpath(path, NULL);
    struct source s = {.builder = b, .outer = outer};
    s.name = scene_desc_keep(b->desc, path);
    s.real_path = text_copy(real ? real : path);
    free(real);
    bool read = check_loop(&s, at, b->err);
    if (read) {
        s.parser = XML_ParserCreate(NULL);
        read = s.parser ? parse(&s, data, size)
                        : err_set(b->err, ERR_IO, at, "no memory for an XML parser");
        XML_ParserFree(s.parser);
    }
    mem_free(s.real_path);
    mem_free(data);
    return read;
}

struct mitsuba_node *mitsuba_tree_read(struct scene_desc *desc, const char *path,
                                       const struct import_options *options,
                                       struct err *err)
{
    struct builder b = {.desc = desc, .err = err, .directory = text_directory(path)};
    bool read = mitsuba_parameters_define(&b.parameters, options, err) &&
                read_source(&b, NULL, path, NULL) &&
                mitsuba_parameters_check(&b.parameters, path, err);
    mitsuba_parameters_deinit(&b.parameters);
    mem_free(b.directory);
    if (read)
        return b.root;
    mitsuba_tree_destroy(b.root);
    return NULL;
}
