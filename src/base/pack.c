#include "base/pack.h"

#include "base/hash.h"
#include "base/mem.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#define WORD        8
#define NAME_MOST   32
#define HEADER_MOST (WORD + NAME_MOST + WORD) /* of a label, with the name's end */
#define BUFFER      65536
#define ORDER_MARK  UINT32_C(0x01020304)
#define BEGIN_BYTES ((size_t)16) /* two words at either end of the file */
#define END_BYTES   ((size_t)16)

static const char magic[] = "etalonck";
static const char end_mark[] = "the end.";

enum kind { KIND_INTEGER = 'i', KIND_WORD32 = 'u', KIND_DOUBLE = 'd', KIND_TEXT = 't' };

struct pack {
    char *path, *temporary; /* temporary: NULL if it is read */
    int fd;
    struct hash hash;
    unsigned char *buffer; /* [BUFFER], not yet written */
    size_t buffered;
    const unsigned char *data; /* the file that is read */
    size_t size, at;           /* at: the next field */
    struct err failure;
};

bool pack_reads(const struct pack *pack)
{
    return pack->temporary == NULL;
}

bool pack_ok(const struct pack *pack)
{
    return pack->failure.code == ERR_NONE;
}

void pack_refuse(struct pack *pack, const char *what)
{
    err_set(&pack->failure, ERR_VALUE, &(struct place){pack->path, 0, 0},
            "this is no state that a run can be in: %s; begin anew", what);
}

/* --- writing ---------------------------------------------------------------------- */

static void cannot_write(struct pack *pack)
{
    err_set(&pack->failure, ERR_IO, NULL, "cannot write '%s': %s", pack->path,
            strerror(errno));
}

static void write_bytes(struct pack *pack, const unsigned char *bytes, size_t size)
{
    while (size > 0 && pack_ok(pack)) {
        ssize_t n = write(pack->fd, bytes, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0) {
            cannot_write(pack);
            return;
        }
        bytes += n;
        size -= (size_t)n;
    }
}

static void flush(struct pack *pack)
{
    write_bytes(pack, pack->buffer, pack->buffered);
    pack->buffered = 0;
}

static void put_words(struct pack *pack, const void *words, size_t size)
{
    if (size == 0)
        return;
    hash_words(&pack->hash, words, size / WORD);
    if (pack->buffered + size > BUFFER)
        flush(pack);
    if (size > BUFFER) {
        write_bytes(pack, words, size);
        return;
    }
    memcpy(pack->buffer + pack->buffered, words, size);
    pack->buffered += size;
}

/* Padded to whole words. */
static void put(struct pack *pack, const void *bytes, size_t size)
{
    unsigned char last[WORD] = {0};
    size_t whole = size - size % WORD;
    put_words(pack, bytes, whole);
    if (whole == size)
        return;
    memcpy(last, (const unsigned char *)bytes + whole, size - whole);
    put_words(pack, last, WORD);
}

static struct pack *create(const char *path)
{
    struct pack *pack = mem_alloc(1, sizeof *pack);
    pack->path = text_copy(path);
    pack->fd = -1;
    hash_init(&pack->hash);
    return pack;
}

/* Renaming would replace a device. */
static bool may_be_replaced(const char *path, struct err *err)
{
    struct stat info;
    if (stat(path, &info) != 0 || S_ISREG(info.st_mode))
        return true;
    return err_set(err, ERR_IO, NULL, "cannot write '%s': it is no regular file", path);
}

static bool open_to_write(struct pack *pack, struct err *err)
{
    pack->temporary = text_format("%s.part", pack->path);
    if (!may_be_replaced(pack->path, err) || !may_be_replaced(pack->temporary, err))
        return false;
    pack->fd = open(pack->temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    return pack->fd >= 0 || err_set(err, ERR_IO, NULL, "cannot write '%s': %s",
                                    pack->temporary, strerror(errno));
}

struct pack *pack_create(const char *path, uint32_t layout, struct err *err)
{
    const uint32_t marks[2] = {ORDER_MARK, layout};
    struct pack *pack = create(path);
    if (!open_to_write(pack, err)) {
        pack_destroy(pack);
        return NULL;
    }
    pack->buffer = mem_alloc(BUFFER, 1);
    put(pack, magic, WORD);
    put(pack, marks, sizeof marks);
    return pack;
}

bool pack_writable(const char *path, struct err *err)
{
    struct pack *pack = create(path);
    bool ok = open_to_write(pack, err);
    pack_destroy(pack);
    return ok;
}

static void finish(struct pack *pack)
{
    put(pack, end_mark, WORD);
    uint64_t hash = pack->hash.value;
    put(pack, &hash, sizeof hash);
    flush(pack);
    if (!pack_ok(pack))
        return;
    /* On the disk before it takes the place of an older one. */
    bool written = fsync(pack->fd) == 0;
    written = close(pack->fd) == 0 && written;
    pack->fd = -1;
    if (!written || rename(pack->temporary, pack->path) != 0)
        cannot_write(pack);
}

/* --- reading ---------------------------------------------------------------------- */

static bool map(struct pack *pack, struct err *err)
{
    struct stat info;
    struct place at = {pack->path, 0, 0};
    pack->fd = open(pack->path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (pack->fd < 0 || fstat(pack->fd, &info) != 0)
        return err_set(err, ERR_IO, NULL, "cannot open '%s': %s", pack->path,
                       strerror(errno));
    if (!S_ISREG(info.st_mode))
        return err_set(err, ERR_IO, NULL, "cannot read '%s': not a regular file%s",
                       pack->path, S_ISDIR(info.st_mode) ? " but a directory" : "");
    if ((size_t)info.st_size < BEGIN_BYTES + END_BYTES)
        return err_set(err, ERR_SYNTAX, &at, "this is no checkpoint");
    size_t size = (size_t)info.st_size;
    void *data = mmap(NULL, size, PROT_READ, MAP_PRIVATE, pack->fd, 0);
    if (data == MAP_FAILED)
        return err_set(err, ERR_IO, NULL, "cannot read '%s': %s", pack->path,
                       strerror(errno));
    pack->data = data;
    pack->size = size;
    return true;
}

static bool is_whole(struct pack *pack)
{
    uint64_t hash;
    if (pack->size % WORD != 0)
        return false;
    size_t hashed = pack->size - sizeof hash;
    memcpy(&hash, pack->data + hashed, sizeof hash);
    hash_words(&pack->hash, pack->data, hashed / WORD);
    return hash == pack->hash.value &&
           memcmp(pack->data + pack->size - END_BYTES, end_mark, WORD) == 0;
}

static bool check(struct pack *pack, uint32_t layout, struct err *err)
{
    struct place at = {pack->path, 0, 0};
    uint32_t marks[2];
    memcpy(marks, pack->data + WORD, sizeof marks);
    if (memcmp(pack->data, magic, WORD) != 0)
        return err_set(err, ERR_SYNTAX, &at, "this is no checkpoint");
    if (!is_whole(pack))
        return err_set(err, ERR_SYNTAX, &at,
                       "the checkpoint is damaged or cut short; give another, or begin "
                       "anew");
    if (marks[0] != ORDER_MARK)
        return err_set(err, ERR_UNSUPPORTED, &at,
                       "the checkpoint was made on a machine with another byte order");
    if (marks[1] != layout)
        return err_set(err, ERR_UNSUPPORTED, &at,
                       "the checkpoint has layout %u, and this version reads %u: give "
                       "it to the version that made it, or begin anew",
                       (unsigned)marks[1], (unsigned)layout);
    pack->at = BEGIN_BYTES;
    return true;
}

struct pack *pack_open(const char *path, uint32_t layout, struct err *err)
{
    struct pack *pack = create(path);
    if (map(pack, err) && check(pack, layout, err))
        return pack;
    pack_destroy(pack);
    return NULL;
}

static size_t left(const struct pack *pack)
{
    return pack->size - END_BYTES - pack->at;
}

/* The next `size` bytes of the file, NULL past its end. */
static const unsigned char *get(struct pack *pack, size_t size)
{
    size_t padded = size + (WORD - size % WORD) % WORD;
    if (!pack_ok(pack) || size > left(pack) || padded > left(pack))
        return NULL;
    const unsigned char *bytes = pack->data + pack->at;
    pack->at += padded;
    return bytes;
}

/* --- fields ----------------------------------------------------------------------- */

/* Kind, length of the name, the name: padded. */
static size_t label(enum kind kind, const char *name, unsigned char out[HEADER_MOST])
{
    size_t length = strlen(name);
    assert(length <= NAME_MOST);
    memset(out, 0, HEADER_MOST);
    out[0] = (unsigned char)kind;
    out[1] = (unsigned char)length;
    memcpy(out + WORD, name, length + 1);
    return WORD + length;
}

/* The count of the field, which is the next one and so named; false if it is not. */
static bool get_label(struct pack *pack, enum kind kind, const char *name,
                      uint64_t *count)
{
    unsigned char expected[HEADER_MOST];
    size_t size = label(kind, name, expected);
    const unsigned char *found = get(pack, size), *number = get(pack, sizeof *count);
    bool ok = found && number && memcmp(found, expected, size) == 0;
    if (ok)
        memcpy(count, number, sizeof *count);
    else
        pack_refuse(pack, name);
    return ok;
}

static void put_label(struct pack *pack, enum kind kind, const char *name, uint64_t count)
{
    unsigned char bytes[HEADER_MOST];
    size_t size = label(kind, name, bytes);
    put(pack, bytes, size);
    put(pack, &count, sizeof count);
}

static void field(struct pack *pack, enum kind kind, const char *name, void *values,
                  size_t count, size_t size)
{
    uint64_t found;
    if (!pack_ok(pack))
        return;
    if (!pack_reads(pack)) {
        put_label(pack, kind, name, count);
        put(pack, values, count * size);
        return;
    }
    if (!get_label(pack, kind, name, &found))
        return;
    const unsigned char *bytes = found == count ? get(pack, count * size) : NULL;
    if (bytes == NULL)
        pack_refuse(pack, name);
    else if (count > 0)
        memcpy(values, bytes, count * size);
}

void pack_long(struct pack *pack, const char *name, long *value, long least, long most)
{
    int64_t number = *value;
    field(pack, KIND_INTEGER, name, &number, 1, sizeof number);
    if (pack_ok(pack) && (number < least || number > most))
        pack_refuse(pack, name);
    else
        *value = (long)number;
}

void pack_int(struct pack *pack, const char *name, int *value, int least, int most)
{
    long number = *value;
    pack_long(pack, name, &number, least, most);
    *value = (int)number;
}

void pack_flag(struct pack *pack, const char *name, bool *value)
{
    long number = *value;
    pack_long(pack, name, &number, 0, 1);
    *value = number != 0;
}

void pack_double(struct pack *pack, const char *name, double *value)
{
    field(pack, KIND_DOUBLE, name, value, 1, sizeof *value);
}

void pack_doubles(struct pack *pack, const char *name, double *values, size_t count)
{
    field(pack, KIND_DOUBLE, name, values, count, sizeof *values);
}

void pack_int64s(struct pack *pack, const char *name, int64_t *values, size_t count)
{
    field(pack, KIND_INTEGER, name, values, count, sizeof *values);
}

void pack_uint32s(struct pack *pack, const char *name, uint32_t *values, size_t count)
{
    field(pack, KIND_WORD32, name, values, count, sizeof *values);
}

void pack_blob(struct pack *pack, const char *name, struct text *blob)
{
    uint64_t count = blob->length;
    if (!pack_ok(pack))
        return;
    if (!pack_reads(pack)) {
        put_label(pack, KIND_TEXT, name, count);
        put(pack, blob->data, blob->length);
        return;
    }
    if (!get_label(pack, KIND_TEXT, name, &count))
        return;
    const unsigned char *bytes = get(pack, count);
    if (bytes == NULL) {
        pack_refuse(pack, name);
        return;
    }
    blob->data = mem_grow(blob->data, &blob->capacity, count + 1, 1);
    memcpy(blob->data, bytes, count);
    blob->data[count] = '\0';
    blob->length = count;
}

void pack_text(struct pack *pack, const char *name, char *text, size_t size)
{
    struct text blob = {0};
    if (!pack_reads(pack))
        blob = (struct text){.data = text, .length = strlen(text)};
    pack_blob(pack, name, &blob);
    if (!pack_reads(pack) || !pack_ok(pack))
        return;
    if (blob.data && blob.length < size && strlen(blob.data) == blob.length)
        memcpy(text, blob.data, blob.length + 1);
    else
        pack_refuse(pack, name);
    mem_free(blob.data);
}

/* --- the end ---------------------------------------------------------------------- */

bool pack_close(struct pack *pack, struct err *err)
{
    if (pack_ok(pack) && !pack_reads(pack))
        finish(pack);
    else if (pack_ok(pack) && left(pack) > 0)
        pack_refuse(pack, "there is more in it than expected");
    bool ok = pack_ok(pack);
    if (!ok && err && err->code == ERR_NONE)
        *err = pack->failure;
    pack_destroy(pack);
    return ok;
}

void pack_destroy(struct pack *pack)
{
    if (pack == NULL)
        return;
    if (pack->temporary && pack->fd >= 0)
        unlink(pack->temporary);
    if (pack->fd >= 0)
        close(pack->fd);
    if (pack->data)
        munmap((void *)pack->data, pack->size);
    mem_free(pack->temporary);
    mem_free(pack->buffer);
    mem_free(pack->path);
    mem_free(pack);
}
