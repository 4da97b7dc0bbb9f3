/* Pictures as textures hold them: bytes with a table that decodes them, or floats. */

#include "surface/texture.h"

#include "base/mem.h"
#include "base/text.h"
#include "image/exr.h"
#include "surface/pfm.h"
#include "surface/png_check.h"

#include <errno.h>
#include <stb/stb_image.h>
#include <unistd.h>

/* Greatest number of pixel bytes that a byte of a file of these kinds can encode (deflate
 * of PNG): a header that claims more pixels is refused before anything is allocated. */
#define TEXTURE_BYTES_A_BYTE 1100.0
#define TEXTURE_SIZE_MAX     65536
#define TEXTURE_LINE         64 /* bytes of a cache line; pictures lie on huge pages */

static double decode_srgb(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static double decode(double v, enum texture_encoding encoding)
{
    return encoding == TEXTURE_LINEAR ? v : decode_srgb(v);
}

static bool unreadable(const char *path, const char *why, const struct place *at,
                       struct err *err)
{
    return err_set(err, ERR_SYNTAX, at, "cannot read the picture '%s': %s", path, why);
}

/* Adds the library's own reason, a word or two. */
static bool fail_stb(const char *path, const struct place *at, struct err *err)
{
    return err_set(err, ERR_SYNTAX, at,
                   "cannot read the picture '%s': it is damaged, or none of .png, .jpg, "
                   ".tga, .hdr, .pfm, .exr (%s)",
                   path, stbi_failure_reason());
}

/* Copies what stb allocated into our own memory. */
static void *adopt(void *pixels, size_t bytes)
{
    unsigned char *copy = mem_aligned(TEXTURE_LINE, bytes, 1);
    for (size_t i = 0; i < bytes; i++)
        copy[i] = ((unsigned char *)pixels)[i];
    stbi_image_free(pixels);
    return copy;
}

static void fill_decode(struct texture_image *image)
{
    for (int i = 0; i < 256; i++)
        image->decode[i] = (float)decode((double)i / 255.0, image->encoding);
}

static void fill_floats16(struct texture_image *image, const unsigned short *from,
                          size_t count)
{
    image->floats = mem_aligned(TEXTURE_LINE, count, sizeof(float));
    for (size_t i = 0; i < count; i++)
        image->floats[i] = (float)decode((double)from[i] / 65535.0, image->encoding);
}

/* Least bytes of a pixel before compression. */
static double pixel_bytes(const unsigned char *data, int size)
{
    int bits = png_bits(data, (size_t)size);
    return bits > 0 ? bits / 8.0 : 1.0;
}

static bool read_stb(struct texture_image *image, const unsigned char *data, int size,
                     const struct place *at, struct err *err)
{
    int x = 0, y = 0, channels;
    const char *damage = png_check(data, (size_t)size);
    if (damage)
        return unreadable(image->path, damage, at, err);
    if (!stbi_info_from_memory(data, size, &x, &y, &channels))
        return fail_stb(image->path, at, err);
    double pixels = (double)x * (double)y;
    if (x > TEXTURE_SIZE_MAX || y > TEXTURE_SIZE_MAX ||
        pixels * pixel_bytes(data, size) > TEXTURE_BYTES_A_BYTE * (double)size)
        return unreadable(image->path, "its header asks for more than it holds", at, err);
    void *read;
    if (stbi_is_hdr_from_memory(data, size))
        read = stbi_loadf_from_memory(data, size, &x, &y, &channels, 3);
    else if (stbi_is_16_bit_from_memory(data, size))
        read = stbi_load_16_from_memory(data, size, &x, &y, &channels, 3);
    else
        read = stbi_load_from_memory(data, size, &x, &y, &channels, 3);
    if (!read)
        return fail_stb(image->path, at, err);
    size_t count = 3 * (size_t)x * (size_t)y;
    image->width = x;
    image->height = y;
    if (stbi_is_hdr_from_memory(data, size)) {
        image->floats = adopt(read, count * sizeof(float));
    } else if (stbi_is_16_bit_from_memory(data, size)) {
        fill_floats16(image, read, count);
        stbi_image_free(read);
    } else {
        image->bytes = adopt(read, count);
        fill_decode(image);
    }
    return true;
}

static bool read_pfm(struct texture_image *image, const char *data, size_t size,
                     const struct place *at, struct err *err)
{
    const char *why;
    image->floats = pfm_read(data, size, TEXTURE_SIZE_MAX, &image->width, &image->height,
                             &why);
    if (!image->floats)
        return unreadable(image->path, why, at, err);
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count && image->encoding == TEXTURE_SRGB; i++)
        image->floats[i] = (float)decode_srgb((double)image->floats[i]);
    return true;
}

static bool read_exr(struct texture_image *image, const struct place *at, struct err *err)
{
    struct image *read = exr_read(image->path, at, err);
    if (!read)
        return false;
    size_t count = 3 * (size_t)read->width * (size_t)read->height;
    image->width = read->width;
    image->height = read->height;
    image->floats = mem_aligned(TEXTURE_LINE, count, sizeof(float));
    for (size_t i = 0; i < count; i++)
        image->floats[i] = image->encoding == TEXTURE_SRGB
                               ? (float)decode_srgb((double)read->pixels[i])
                               : read->pixels[i];
    image_destroy(read);
    return true;
}

static void clamp_floats(struct texture_image *image, const struct place *at,
                         struct log *log)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height, bad = 0;
    for (size_t i = 0; image->floats && i < count; i++)
        if (!(image->floats[i] >= 0.0f && isfinite(image->floats[i]))) {
            image->floats[i] = 0.0f;
            bad++;
        }
    if (bad > 0)
        log_note(log, at,
                 "%zu values of the picture '%s' are negative or not finite and "
                 "were set to 0",
                 bad, image->path);
}

static bool read_image(struct texture_image *image, const struct place *at,
                       struct log *log, struct err *err)
{
    size_t size;
    bool good;
    if (text_ends_with(image->path, ".exr")) {
        good = read_exr(image, at, err);
    } else {
        char *data = text_read_file(image->path, &size, at, err);
        if (!data)
            return false;
        if (pfm_is((unsigned char *)data, size))
            good = read_pfm(image, data, size, at, err);
        else
            good = size <= INT32_MAX
                       ? read_stb(image, (unsigned char *)data, (int)size, at, err)
                       : unreadable(image->path, "it is too large", at, err);
        mem_free(data);
    }
    if (!good)
        return false;
    clamp_floats(image, at, log);
    return true;
}

static void add_image(struct texture_set *set, struct texture_image *image)
{
    image->size = 3 * (size_t)image->width * (size_t)image->height *
                  (image->bytes ? 1 : sizeof(float));
    set->images = mem_grow(set->images, &set->image_capacity, set->image_count + 1,
                           sizeof(struct texture_image *));
    set->images[set->image_count++] = image;
}

struct texture_image *texture_image_create(struct texture_set *set, int width, int height)
{
    struct texture_image *image = mem_alloc(1, sizeof *image);
    image->path = text_copy("");
    image->encoding = TEXTURE_LINEAR;
    image->width = width;
    image->height = height;
    image->floats = mem_alloc(3 * (size_t)width * (size_t)height, sizeof(float));
    add_image(set, image);
    return image;
}

void texture_image_destroy(struct texture_image *image)
{
    if (!image)
        return;
    mem_free(image->path);
    mem_free(image->bytes);
    mem_free(image->floats);
    mem_free(image);
}

static struct texture_image *image_open(const char *path, enum texture_encoding encoding,
                                        const struct place *at, struct log *log,
                                        struct err *err)
{
    struct texture_image *image = mem_alloc(1, sizeof *image);
    image->path = text_copy(path);
    image->encoding = encoding;
    if (read_image(image, at, log, err))
        return image;
    texture_image_destroy(image);
    return NULL;
}

struct texture_image *texture_image_prepare(const char *path)
{
    struct err err = {0};
    struct log log;
    log_init(&log);
    struct texture_image *image = image_open(path, TEXTURE_AUTO, NULL, &log, &err);
    if (log.count > 0) {
        texture_image_destroy(image);
        image = NULL;
    }
    log_deinit(&log);
    return image;
}

void texture_set_prepare(struct texture_set *set, struct texture_image *image)
{
    set->prepared = mem_grow(set->prepared, &set->prepared_capacity,
                             set->prepared_count + 1, sizeof(struct texture_image *));
    set->prepared[set->prepared_count++] = image;
}

void texture_set_drop_prepared(struct texture_set *set)
{
    for (size_t i = 0; i < set->prepared_count; i++)
        texture_image_destroy(set->prepared[i]);
    mem_free(set->prepared);
    set->prepared = NULL;
    set->prepared_count = set->prepared_capacity = 0;
}

/* Bytes fit any encoding, floats only that with which they were read. */
static struct texture_image *take_prepared(struct texture_set *set, const char *path,
                                           enum texture_encoding encoding)
{
    for (size_t i = 0; i < set->prepared_count; i++) {
        struct texture_image *image = set->prepared[i];
        if (!text_equal(image->path, path) ||
            (!image->bytes && encoding != image->encoding))
            continue;
        set->prepared[i] = set->prepared[--set->prepared_count];
        image->encoding = encoding;
        if (image->bytes)
            fill_decode(image);
        return image;
    }
    return NULL;
}

const struct texture_image *texture_image_load(struct texture_set *set, const char *path,
                                               enum texture_encoding encoding,
                                               const struct place *at, struct log *log,
                                               struct err *err)
{
    for (size_t i = 0; i < set->image_count; i++)
        if (set->images[i]->encoding == encoding &&
            text_equal(set->images[i]->path, path))
            return set->images[i];
    if (access(path, F_OK) != 0 && (errno == ENOENT || errno == ENOTDIR)) {
        log_note(log, at, "there is no picture '%s'; a constant takes its place", path);
        return NULL;
    }
    struct texture_image *image = take_prepared(set, path, encoding);
    if (!image)
        image = image_open(path, encoding, at, log, err);
    if (image)
        add_image(set, image);
    return image;
}
