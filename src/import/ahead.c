#include "import/ahead.h"

#include "base/mem.h"
#include "base/par.h"
#include "base/text.h"

#include <stdlib.h>
#include <string.h>

#define SCENE_FILES 256 /* looked through at most */

struct entry {
    char *path;
    ahead_reader read; /* of a mesh; NULL: a picture */
    long uses;
    struct mesh *mesh;
    struct texture_image *image;
};

struct ahead {
    struct entry *entries; /* by path, once collected */
    size_t count, capacity;
    char *scenes[SCENE_FILES];
    size_t scene_count;
    const char *directory, *separators;
    struct texture_set *textures;
    const struct import_options *options;
    long done; /* atomic */
};

/* --- what there is to read --------------------------------------------------------- */

static const struct {
    const char *ending;
    bool scene;
    ahead_reader read;
} endings[] = {
    {".ply", false, import_ply}, {".ply.gz", false, import_ply},
    {".obj", false, import_obj}, {".png", false, NULL},
    {".jpg", false, NULL},       {".jpeg", false, NULL},
    {".tga", false, NULL},       {".hdr", false, NULL},
    {".pfm", false, NULL},       {".exr", false, NULL},
    {".pbrt", true, NULL},       {".lxs", true, NULL},
    {".lxo", true, NULL},        {".lxm", true, NULL},
    {".xml", true, NULL},
};

static void add_scene(struct ahead *a, const char *path)
{
    for (size_t i = 0; i < a->scene_count; i++)
        if (text_equal(a->scenes[i], path))
            return;
    if (a->scene_count < SCENE_FILES)
        a->scenes[a->scene_count++] = text_copy(path);
}

static void add_file(struct ahead *a, const char *name)
{
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        if (!text_ends_with(name, endings[i].ending))
            continue;
        char *path = text_join(a->directory, name);
        if (endings[i].scene) {
            add_scene(a, path);
            mem_free(path);
            return;
        }
        a->entries = mem_grow(a->entries, &a->capacity, a->count + 1, sizeof *a->entries);
        a->entries[a->count++] = (struct entry){
            .path = path, .read = endings[i].read, .uses = 1};
        return;
    }
}

/* Cuts the text into pieces, in place. */
static void scan(struct ahead *a, char *text, const char *end)
{
    while (text < end) {
        size_t length = strcspn(text, a->separators);
        char *after = text + length;
        bool named = length > 4 && length < 4096;
        *after = '\0';
        if (named)
            add_file(a, text);
        text = after + 1;
    }
}

static void scan_scenes(struct ahead *a)
{
    for (size_t i = 0; i < a->scene_count; i++) {
        size_t size;
        char *text = text_read_file(a->scenes[i], &size, NULL, NULL);
        if (text)
            scan(a, text, text + size);
        mem_free(text);
    }
}

static int compare(const void *a, const void *b)
{
    return strcmp(((const struct entry *)a)->path, ((const struct entry *)b)->path);
}

static void sort_entries(struct ahead *a)
{
    size_t kept = 0;
    if (a->count == 0)
        return;
    qsort(a->entries, a->count, sizeof *a->entries, compare);
    for (size_t i = 1; i < a->count; i++) {
        if (compare(&a->entries[i], &a->entries[kept]) != 0) {
            a->entries[++kept] = a->entries[i];
            continue;
        }
        a->entries[kept].uses++;
        mem_free(a->entries[i].path);
    }
    a->count = kept + 1;
}

/* --- reading ----------------------------------------------------------------------- */

static void read_one(void *ctx, long index, int thread)
{
    struct ahead *a = ctx;
    struct entry *entry = &a->entries[index];
    const struct import_options *options = a->options;
    struct err ignored = {0};
    if (entry->read)
        entry->mesh = entry->read(entry->path, NULL, &ignored);
    else
        entry->image = texture_image_prepare(entry->path);
    long done = __atomic_add_fetch(&a->done, 1, __ATOMIC_RELAXED);
    if (thread == 0 && options->progress)
        options->progress(options->progress_ctx, done, (long)a->count);
}

struct ahead *ahead_read(const char *path, const char *directory, const char *separators,
                         struct texture_set *textures,
                         const struct import_options *options)
{
    if (!options || (options->threads < 2 && !options->progress))
        return NULL;
    struct ahead *a = mem_alloc(1, sizeof *a);
    a->directory = directory;
    a->separators = separators;
    a->textures = textures;
    a->options = options;
    add_scene(a, path);
    scan_scenes(a);
    sort_entries(a);
    par_for((long)a->count, options->threads, read_one, a);
    if (options->progress)
        options->progress(options->progress_ctx, a->done, (long)a->count);
    for (size_t i = 0; i < a->count; i++)
        if (a->entries[i].image)
            texture_set_prepare(textures, a->entries[i].image);
    return a;
}

void ahead_destroy(struct ahead *a)
{
    if (!a)
        return;
    texture_set_drop_prepared(a->textures);
    for (size_t i = 0; i < a->count; i++) {
        mem_free(a->entries[i].path);
        mesh_destroy(a->entries[i].mesh);
    }
    for (size_t i = 0; i < a->scene_count; i++)
        mem_free(a->scenes[i]);
    mem_free(a->entries);
    mem_free(a);
}

struct mesh *ahead_mesh(struct ahead *a, ahead_reader read, const char *path,
                        const struct place *at, struct err *err)
{
    char *wanted = text_copy(path);
    struct entry key = {.path = wanted}, *found = NULL;
    if (a && a->count > 0)
        found = bsearch(&key, a->entries, a->count, sizeof *a->entries, compare);
    mem_free(wanted);
    if (!found || found->read != read || !found->mesh)
        return read(path, at, err);
    if (--found->uses > 0)
        return mesh_copy(found->mesh);
    struct mesh *mesh = found->mesh;
    found->mesh = NULL;
    return mesh;
}
