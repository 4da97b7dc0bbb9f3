#include "import/gzip.h"

#include "base/mem.h"
#include "base/text.h"

#include <stdint.h>
#include <string.h>
#include <zlib.h>

/* Deflate packs at most 1032 : 1, so that memory stays within that of the file. */
static bool unpack(const char *packed, size_t packed_size, struct text *out)
{
    z_stream z;
    memset(&z, 0, sizeof z);
    if (packed_size > UINT32_MAX || inflateInit2(&z, 16 + MAX_WBITS) != Z_OK)
        return false;
    z.next_in = (Bytef *)packed;
    z.avail_in = (uInt)packed_size;
    int status = Z_OK;
    while (status == Z_OK) {
        out->data = mem_grow(out->data, &out->capacity, out->length + 65537, 1);
        size_t room = out->capacity - out->length - 1;
        uInt step = room > 1u << 30 ? 1u << 30 : (uInt)room;
        z.next_out = (Bytef *)out->data + out->length;
        z.avail_out = step;
        status = inflate(&z, Z_NO_FLUSH);
        out->length += step - z.avail_out;
    }
    inflateEnd(&z);
    if (out->data)
        out->data[out->length] = '\0';
    return status == Z_STREAM_END;
}

char *gzip_read_file(const char *path, size_t *size, const struct place *at,
                     struct err *err)
{
    char *data = text_read_file(path, size, at, err);
    if (!data || !text_ends_with(path, ".gz"))
        return data;
    struct text out = {0};
    bool good = unpack(data, *size, &out);
    mem_free(data);
    if (good) {
        *size = out.length;
        return out.data;
    }
    mem_free(out.data);
    err_set(err, ERR_SYNTAX, at, "cannot unpack '%s': it is cut short or no gzip file",
            path);
    return NULL;
}
