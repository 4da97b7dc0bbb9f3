#include "lab/fingerprint.h"

#include "base/mem.h"
#include "base/text.h"

#include <ctype.h>
#include <string.h>
#include <sys/stat.h>

#define MAX_NAME 1024

struct files {
    char *folder; /* of the scene: names may be relative to it */
    char **names; /* seen already */
    size_t count, capacity;
    struct hash *hash; /* NULL: names alone are wanted */
};

static bool is_file(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

static bool is_seen(const struct files *files, const char *path)
{
    for (size_t i = 0; i < files->count; i++)
        if (text_equal(files->names[i], path))
            return true;
    return false;
}

/* Whether the file may name other files. */
static bool is_text(const char *path)
{
    static const char *const endings[] = {".yaml", ".yml", ".pbrt", ".xml",
                                          ".lxs",  ".lxo", ".lxm",  NULL};
    for (int i = 0; endings[i]; i++)
        if (text_ends_with(path, endings[i]))
            return true;
    return false;
}

static bool add_file(struct files *files, const char *path, const struct place *at,
                     struct err *err);

/* A word without an ending that begins with a letter is no file name; this skips most
 * numbers of a scene without a disk access. */
static bool may_be_name(const char *word, size_t length)
{
    size_t dot = length;
    while (dot > 0 && word[dot - 1] != '.')
        dot--;
    return length < MAX_NAME && dot > 1 && dot < length &&
           isalpha((unsigned char)word[dot]);
}

static bool add_name(struct files *files, const char *folder, const char *word,
                     size_t length, struct err *err)
{
    if (!may_be_name(word, length))
        return true;
    char *name = text_copy_n(word, length);
    char *path = text_join(folder, name);
    if (!is_file(path)) {
        mem_free(path);
        path = text_join(files->folder, name);
    }
    bool ok = !is_file(path) || add_file(files, path, NULL, err);
    mem_free(path);
    mem_free(name);
    return ok;
}

/* Words end at blanks, brackets, commas and quotes; between double quotes, at the quote.
 */
static bool add_names(struct files *files, const char *path, const char *text,
                      struct err *err)
{
    static const char apart[] = " \t\r\n,[]{}()<>='\"";
    char *folder = text_directory(path);
    bool ok = true;
    while (ok && *text) {
        size_t length = strcspn(text, apart);
        ok = add_name(files, folder, text, length, err);
        text += length;
        if (*text == '"') {
            length = strcspn(text + 1, "\"\n");
            ok = ok && add_name(files, folder, text + 1, length, err);
        }
        text += *text != '\0';
    }
    mem_free(folder);
    return ok;
}

static bool add_file(struct files *files, const char *path, const struct place *at,
                     struct err *err)
{
    size_t size;
    if (is_seen(files, path))
        return true;
    files->names = mem_grow(files->names, &files->capacity, files->count + 1,
                            sizeof *files->names);
    files->names[files->count++] = text_copy(path);
    if (files->hash == NULL && !is_text(path))
        return true;
    char *text = text_read_file(path, &size, at, err);
    if (text == NULL)
        return false;
    if (files->hash) {
        hash_number(files->hash, size);
        hash_bytes(files->hash, text, size);
    }
    bool ok = !is_text(path) || add_names(files, path, text, err);
    mem_free(text);
    return ok;
}

static void release(struct files *files)
{
    for (size_t i = 0; i < files->count; i++)
        mem_free(files->names[i]);
    mem_free(files->names);
    mem_free(files->folder);
}

bool fingerprint_scene(const char *path, const struct place *at, struct hash *hash,
                       struct err *err)
{
    struct files files = {.folder = text_directory(path), .hash = hash};
    hash_init(hash);
    bool ok = add_file(&files, path, at, err);
    release(&files);
    return ok;
}

bool fingerprint_names(const char *scene, const char *file, bool *named, struct err *err)
{
    struct files files = {.folder = text_directory(scene)};
    bool ok = add_file(&files, scene, NULL, err);
    *named = false;
    for (size_t i = 0; i < files.count; i++)
        *named = *named || text_same_file(files.names[i], file);
    release(&files);
    return ok;
}

bool fingerprint_file(const char *path, const struct place *at, struct hash *hash,
                      struct err *err)
{
    size_t size;
    char *text = text_read_file(path, &size, at, err);
    if (text == NULL)
        return false;
    hash_number(hash, size);
    hash_bytes(hash, text, size);
    mem_free(text);
    return true;
}
