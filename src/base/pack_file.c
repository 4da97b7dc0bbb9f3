#include "base/pack_file.h"

#include "base/mem.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#define WORD        PACK_WORD
#define BUFFER      65536
#define ORDER_MARK  UINT32_C(0x01020304)
#define BEGIN_BYTES ((size_t)16) /* two words at either end of the file */
#define END_BYTES   ((size_t)16)

static const char magic[] = "etalonck";
static const char end_mark[] = "the end.";

bool pack_reads(const struct pack *pack)
{
    return pack->temporary == NULL;
}

bool pack_ok(const struct pack *pack)
{
    return pack->failure.code == ERR_NONE;
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

void pack_file_put(struct pack *pack, const void *bytes, size_t size)
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

static void begin(struct pack *pack, uint32_t layout)
{
    const uint32_t marks[2] = {ORDER_MARK, layout};
    pack->buffer = mem_alloc(BUFFER, 1);
    pack_file_put(pack, magic, WORD);
    pack_file_put(pack, marks, sizeof marks);
}

struct pack *pack_create_memory(uint32_t layout, struct err *err)
{
    struct pack *pack = create("(memory)");
    pack->temporary = text_copy("(memory)");
    pack->in_memory = true;
    pack->fd = memfd_create("pack", MFD_CLOEXEC);
    if (pack->fd < 0) {
        err_set(err, ERR_IO, NULL, "cannot keep a state in memory: %s", strerror(errno));
        pack_destroy(pack);
        return NULL;
    }
    begin(pack, layout);
    return pack;
}

struct pack *pack_create(const char *path, uint32_t layout, struct err *err)
{
    struct pack *pack = create(path);
    if (!open_to_write(pack, err)) {
        pack_destroy(pack);
        return NULL;
    }
    begin(pack, layout);
    return pack;
}

bool pack_writable(const char *path, struct err *err)
{
    struct pack *pack = create(path);
    bool ok = open_to_write(pack, err);
    pack_destroy(pack);
    return ok;
}

void pack_file_finish(struct pack *pack)
{
    pack_file_put(pack, end_mark, WORD);
    uint64_t hash = pack->hash.value;
    pack_file_put(pack, &hash, sizeof hash);
    flush(pack);
    if (!pack_ok(pack) || pack->in_memory)
        return;
    int fd = pack->fd;
    pack->fd = -1;
    if (text_commit_file(fd, pack->temporary, pack->path))
        return;
    cannot_write(pack);
    unlink(pack->temporary);
}

bool pack_close_memory(struct pack *pack, struct text *bytes, struct err *err)
{
    if (pack_ok(pack))
        pack_file_finish(pack);
    off_t size = lseek(pack->fd, 0, SEEK_END);
    if (pack_ok(pack))
        bytes->data = mem_grow(bytes->data, &bytes->capacity, (size_t)size + 1, 1);
    while (pack_ok(pack) && bytes->length < (size_t)size) {
        ssize_t n = pread(pack->fd, bytes->data + bytes->length,
                          (size_t)size - bytes->length, (off_t)bytes->length);
        if (n <= 0 && errno != EINTR)
            cannot_write(pack);
        bytes->length += n > 0 ? (size_t)n : 0;
    }
    bool ok = pack_ok(pack);
    if (!ok && err && err->code == ERR_NONE)
        *err = pack->failure;
    pack_destroy(pack);
    return ok;
}

/* --- reading ---------------------------------------------------------------------- */

static bool map(struct pack *pack, struct err *err)
{
    struct place at = {pack->path, 0, 0};
    size_t size;
    pack->fd = text_open_file(pack->path, &size, NULL, err);
    if (pack->fd < 0)
        return false;
    if (size < BEGIN_BYTES + END_BYTES)
        return err_set(err, ERR_SYNTAX, &at, "this is no checkpoint");
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

struct pack *pack_open_memory(const struct text *bytes, uint32_t layout, struct err *err)
{
    struct pack *pack = create("(memory)");
    pack->in_memory = true;
    pack->data = (const unsigned char *)bytes->data;
    pack->size = bytes->length;
    if (pack->size < BEGIN_BYTES + END_BYTES)
        err_set(err, ERR_SYNTAX, NULL, "the state of a part is cut short: %zu bytes",
                pack->size);
    else if (check(pack, layout, err))
        return pack;
    pack_destroy(pack);
    return NULL;
}

struct pack *pack_open(const char *path, uint32_t layout, struct err *err)
{
    struct pack *pack = create(path);
    if (map(pack, err) && check(pack, layout, err))
        return pack;
    pack_destroy(pack);
    return NULL;
}

size_t pack_file_left(const struct pack *pack)
{
    return pack->size - END_BYTES - pack->at;
}

const unsigned char *pack_file_get(struct pack *pack, size_t size)
{
    size_t padded = size + (WORD - size % WORD) % WORD;
    if (!pack_ok(pack) || size > pack_file_left(pack) || padded > pack_file_left(pack))
        return NULL;
    const unsigned char *bytes = pack->data + pack->at;
    pack->at += padded;
    return bytes;
}

void pack_destroy(struct pack *pack)
{
    if (pack == NULL)
        return;
    if (pack->temporary && pack->fd >= 0 && !pack->in_memory)
        unlink(pack->temporary);
    if (pack->fd >= 0)
        close(pack->fd);
    if (pack->data && !pack->in_memory)
        munmap((void *)pack->data, pack->size);
    mem_free(pack->temporary);
    mem_free(pack->buffer);
    mem_free(pack->path);
    mem_free(pack);
}
