#include "image/exr.h"

#include "base/mem.h"
#include "base/text.h"

#include <openexr.h>
#include <stdio.h>
#include <string.h>

/* Limits of the number of pixels, in all and per byte of the file: a header that claims
 * more is not believed. */
#define EXR_MAX_PIXELS      (1L << 27)
#define EXR_PIXELS_PER_BYTE 4096L

/* A file in memory, so that a FIFO or a file that shrinks while it is read does no harm.
 */
struct source {
    const char *path;
    const struct place *at;
    char *data;
    size_t size;
    char message[256]; /* the library's first complaint */
};

struct exr_file {
    struct source source;
    exr_context_t ctxt;
};

/* The destination of the data window: the names of the three channels, and the picture.
 */
struct target {
    const char *layer;    /* NULL, or the one that is read */
    const char *names[3]; /* all the same for a grey picture */
    exr_attr_box2i_t window;
    int width, height;
    struct image *image;
};

static int64_t source_read(exr_const_context_t ctxt, void *user, void *buffer,
                           uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t fail)
{
    (void)ctxt;
    (void)fail;
    const struct source *source = user;
    if (offset >= source->size)
        return 0;
    uint64_t left = source->size - offset;
    uint64_t count = size < left ? size : left;
    memcpy(buffer, source->data + offset, (size_t)count);
    return (int64_t)count;
}

static int64_t source_size(exr_const_context_t ctxt, void *user)
{
    (void)ctxt;
    return (int64_t)((const struct source *)user)->size;
}

static void keep_message(exr_const_context_t ctxt, exr_result_t code, const char *message)
{
    (void)code;
    void *user = NULL;
    if (exr_get_user_data(ctxt, &user) != EXR_ERR_SUCCESS || !user)
        return;
    struct source *source = user;
    if (!source->message[0])
        snprintf(source->message, sizeof source->message, "%s", message);
}

static bool fail(const struct source *source, enum err_code code, const char *what,
                 struct err *err)
{
    return err_set(err, code, source->at, "cannot read '%s': %s", source->path, what);
}

static bool fail_library(const struct source *source, exr_result_t rv, struct err *err)
{
    return fail(source, ERR_SYNTAX,
                source->message[0] ? source->message : exr_get_default_error_message(rv),
                err);
}

/* Checked here, as the library reports it only as a number. */
static bool has_magic(const struct source *source)
{
    return source->size >= 4 && memcmp(source->data, "\x76\x2f\x31\x01", 4) == 0;
}

/* The whole file and its header; source->data stays the caller's to free. */
static exr_context_t source_open(struct source *source, struct err *err)
{
    source->data = text_read_file(source->path, &source->size, source->at, err);
    if (!source->data)
        return NULL;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.user_data = source;
    setup.read_fn = source_read;
    setup.size_fn = source_size;
    setup.error_handler_fn = keep_message;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_context_t ctxt = NULL;
    exr_result_t rv = exr_start_read(&ctxt, source->path, &setup);
    if (rv == EXR_ERR_SUCCESS)
        return ctxt;
    if (ctxt)
        exr_finish(&ctxt);
    if (!has_magic(source))
        fail(source, ERR_SYNTAX, "it is no OpenEXR file", err);
    else
        fail_library(source, rv, err);
    return NULL;
}

static const exr_attr_chlist_entry_t *find_channel(const exr_attr_chlist_t *list,
                                                   const char *name)
{
    for (int i = 0; i < list->num_channels; i++)
        if (text_equal(list->entries[i].name.str, name))
            return &list->entries[i];
    return NULL;
}

static bool is_layers(const char *name, size_t prefix, const char *rest)
{
    return prefix > 0 && name[prefix - 1] == '.' && text_equal(name + prefix, rest);
}

/* The first layer ("diffuse.") that has that channel; the length of its name, or 0. */
static size_t find_layer(const exr_attr_chlist_t *list, const char *channel,
                         const char **name)
{
    for (int i = 0; i < list->num_channels; i++) {
        const char *here = list->entries[i].name.str, *dot = strrchr(here, '.');
        size_t prefix = dot ? (size_t)(dot - here) + 1 : 0;
        *name = here;
        if (is_layers(here, prefix, channel))
            return prefix;
    }
    return 0;
}

static const char *find_in_layer(const exr_attr_chlist_t *list, const char *layer,
                                 size_t prefix, const char *channel)
{
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str;
        if (strncmp(name, layer, prefix) == 0 && is_layers(name, prefix, channel))
            return name;
    }
    return NULL;
}

static void choose_grey(struct target *target, const char *name)
{
    for (int c = 0; c < 3; c++)
        target->names[c] = name;
}

/* R, G, B; or Y; or those of the first layer that has them; or the one channel that there
 * is beside alpha. */
static void choose_names(const exr_attr_chlist_t *list, struct target *target)
{
    static const char *const rgb[3] = {"R", "G", "B"};
    const char *layer, *only = NULL;
    size_t prefix;
    int others = 0;
    for (int c = 0; c < 3; c++)
        target->names[c] = rgb[c];
    if (find_channel(list, "R") && (find_channel(list, "G") || find_channel(list, "B")))
        return;
    for (int i = 0; i < list->num_channels; i++)
        if (!text_equal(list->entries[i].name.str, "A")) {
            only = list->entries[i].name.str;
            others++;
        }
    if (find_channel(list, "Y"))
        choose_grey(target, "Y");
    else if ((prefix = find_layer(list, "R", &layer)) > 0)
        for (int c = 0; c < 3; c++) {
            const char *name = find_in_layer(list, layer, prefix, rgb[c]);
            target->names[c] = name ? name : rgb[c];
        }
    else if (find_layer(list, "Y", &layer) > 0)
        choose_grey(target, layer);
    else if (others == 1)
        choose_grey(target, only);
}

/* The channels of target->layer; false if there is none. */
static bool choose_layer(const exr_attr_chlist_t *list, struct target *target)
{
    static const char *const sets[][3] = {
        {"R", "G", "B"}, {"X", "Y", "Z"}, {"Y", "Y", "Y"}, {"Z", "Z", "Z"}};
    char *layer = text_format("%s.", target->layer);
    bool found = false;
    for (int i = 0; i < 4 && !found; i++) {
        found = true;
        for (int c = 0; c < 3; c++) {
            target->names[c] = find_in_layer(list, layer, strlen(layer), sets[i][c]);
            found = found && target->names[c];
        }
    }
    mem_free(layer);
    return found;
}

static bool choose_channels(const struct source *source, exr_const_context_t ctxt,
                            struct target *target, struct err *err)
{
    const exr_attr_chlist_t *list = NULL;
    exr_result_t rv = exr_get_channels(ctxt, 0, &list);
    if (rv != EXR_ERR_SUCCESS)
        return fail_library(source, rv, err);
    bool colour = find_channel(list, "R") || find_channel(list, "G");
    if (!colour && (find_channel(list, "RY") || find_channel(list, "BY")))
        return fail(source, ERR_UNSUPPORTED, "luminance/chroma channels; want R, G, B",
                    err);
    if (target->layer && !choose_layer(list, target))
        return false;
    if (!target->layer)
        choose_names(list, target);
    for (int c = 0; c < 3; c++) {
        const exr_attr_chlist_entry_t *channel = find_channel(list, target->names[c]);
        if (!channel)
            return fail(source, ERR_UNSUPPORTED, "no channels R, G, B (or Y)", err);
        if (channel->pixel_type != EXR_PIXEL_HALF &&
            channel->pixel_type != EXR_PIXEL_FLOAT)
            return fail(source, ERR_UNSUPPORTED, "channels must be half or float", err);
        if (channel->x_sampling != 1 || channel->y_sampling != 1)
            return fail(source, ERR_UNSUPPORTED, "subsampled channels", err);
    }
    return true;
}

static bool check_window(const struct source *source, exr_const_context_t ctxt,
                         struct target *target, struct err *err)
{
    exr_attr_box2i_t *w = &target->window;
    exr_result_t rv = exr_get_data_window(ctxt, 0, w);
    if (rv != EXR_ERR_SUCCESS)
        return fail_library(source, rv, err);
    int64_t width = (int64_t)w->max.x - w->min.x + 1;
    int64_t height = (int64_t)w->max.y - w->min.y + 1;
    int64_t most = EXR_PIXELS_PER_BYTE * (int64_t)source->size;
    most = most < EXR_MAX_PIXELS ? most : EXR_MAX_PIXELS;
    if (width < 1 || height < 1 || width > most || height > most / width)
        return fail(source, ERR_SYNTAX, "the size of the data window cannot be true",
                    err);
    target->width = (int)width;
    target->height = (int)height;
    return true;
}

/* One chunk at (x, y) of the data window into the picture. */
static exr_result_t read_chunk(exr_const_context_t ctxt, const exr_chunk_info_t *chunk,
                               const struct target *target, int x, int y)
{
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t rv = EXR_ERR_CORRUPT_CHUNK;
    if (chunk->width < 1 || chunk->height < 1 || chunk->width > target->width - x ||
        chunk->height > target->height - y)
        return rv;
    rv = exr_decoding_initialize(ctxt, 0, chunk, &decoder);
    for (int i = 0; rv == EXR_ERR_SUCCESS && i < decoder.channel_count; i++) {
        exr_coding_channel_info_t *channel = &decoder.channels[i];
        int c = 0;
        while (c < 3 && !text_equal(channel->channel_name, target->names[c]))
            c++;
        if (c == 3)
            continue;
        channel->decode_to_ptr = (uint8_t *)(image_at(target->image, x, y) + c);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_pixel_stride = 3 * (int)sizeof(float);
        channel->user_line_stride = 3 * target->width * (int)sizeof(float);
        if (channel->width != chunk->width || channel->height != chunk->height)
            rv = EXR_ERR_CORRUPT_CHUNK;
    }
    if (rv == EXR_ERR_SUCCESS)
        rv = exr_decoding_choose_default_routines(ctxt, 0, &decoder);
    if (rv == EXR_ERR_SUCCESS)
        rv = exr_decoding_run(ctxt, 0, &decoder);
    exr_decoding_destroy(ctxt, &decoder);
    return rv;
}

static exr_result_t read_scanlines(exr_const_context_t ctxt, const struct target *target)
{
    int32_t lines = 1;
    exr_result_t rv = exr_get_scanlines_per_chunk(ctxt, 0, &lines);
    for (int y = 0; rv == EXR_ERR_SUCCESS && y < target->height; y += lines) {
        exr_chunk_info_t chunk;
        rv = exr_read_scanline_chunk_info(ctxt, 0, target->window.min.y + y, &chunk);
        if (rv == EXR_ERR_SUCCESS)
            rv = read_chunk(ctxt, &chunk, target, 0, y);
    }
    return rv;
}

static exr_result_t read_tiles(exr_const_context_t ctxt, const struct target *target)
{
    int32_t width = 0, height = 0;
    exr_result_t rv = exr_get_tile_sizes(ctxt, 0, 0, 0, &width, &height);
    if (rv == EXR_ERR_SUCCESS && (width < 1 || height < 1))
        rv = EXR_ERR_INVALID_ATTR;
    for (int y = 0; rv == EXR_ERR_SUCCESS && y < target->height; y += height)
        for (int x = 0; rv == EXR_ERR_SUCCESS && x < target->width; x += width) {
            exr_chunk_info_t chunk;
            rv = exr_read_tile_chunk_info(ctxt, 0, x / width, y / height, 0, 0, &chunk);
            if (rv == EXR_ERR_SUCCESS)
                rv = read_chunk(ctxt, &chunk, target, x, y);
        }
    return rv;
}

static void spread_grey(struct image *image)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (float *p = image->pixels; p < image->pixels + 3 * pixels; p += 3)
        p[1] = p[2] = p[0];
}

static bool read_pixels(const struct source *source, exr_const_context_t ctxt,
                        struct target *target, struct err *err)
{
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    exr_result_t rv = exr_get_storage(ctxt, 0, &storage);
    if (rv == EXR_ERR_SUCCESS && storage != EXR_STORAGE_SCANLINE &&
        storage != EXR_STORAGE_TILED)
        return fail(source, ERR_UNSUPPORTED, "deep data", err);
    target->image = image_create(target->width, target->height);
    if (rv == EXR_ERR_SUCCESS)
        rv = storage == EXR_STORAGE_TILED ? read_tiles(ctxt, target)
                                          : read_scanlines(ctxt, target);
    if (rv == EXR_ERR_FEATURE_NOT_IMPLEMENTED)
        return fail(source, ERR_UNSUPPORTED, "its compression is not supported", err);
    if (rv != EXR_ERR_SUCCESS)
        return fail_library(source, rv, err);
    if (text_equal(target->names[0], target->names[1]))
        spread_grey(target->image);
    return true;
}

/* A display window that is too large to be true has no place for the picture. */
static void place_in(const exr_attr_box2i_t *display, int x, int y, struct image *image)
{
    int64_t width = (int64_t)display->max.x - display->min.x + 1;
    int64_t height = (int64_t)display->max.y - display->min.y + 1;
    if (width > INT32_MAX || height > INT32_MAX)
        return;
    image->x = x - display->min.x;
    image->y = y - display->min.y;
    image->whole_width = (int)width;
    image->whole_height = (int)height;
}

/* Overscan, the data beyond the display window, is no part of the picture. */
static bool crop(const struct source *source, exr_const_context_t ctxt,
                 struct target *target, struct err *err)
{
    exr_attr_box2i_t d, w = target->window;
    exr_result_t rv = exr_get_display_window(ctxt, 0, &d);
    if (rv != EXR_ERR_SUCCESS)
        return fail_library(source, rv, err);
    int x0 = d.min.x > w.min.x ? d.min.x : w.min.x;
    int y0 = d.min.y > w.min.y ? d.min.y : w.min.y;
    int x1 = d.max.x < w.max.x ? d.max.x : w.max.x;
    int y1 = d.max.y < w.max.y ? d.max.y : w.max.y;
    if (x0 > x1 || y0 > y1)
        return fail(source, ERR_VALUE, "no data inside the display window", err);
    struct image *whole = target->image, *part = image_create(x1 - x0 + 1, y1 - y0 + 1);
    for (int y = 0; y < part->height; y++)
        memcpy(image_at(part, 0, y), image_at(whole, x0 - w.min.x, y0 - w.min.y + y),
               (size_t)part->width * 3 * sizeof(float));
    place_in(&d, x0, y0, part);
    image_destroy(whole);
    target->image = part;
    return true;
}

static bool file_open(struct exr_file *file, struct err *err)
{
    int parts = 0;
    file->ctxt = source_open(&file->source, err);
    if (!file->ctxt)
        return false;
    if (exr_get_count(file->ctxt, &parts) != EXR_ERR_SUCCESS || parts != 1)
        return fail(&file->source, ERR_UNSUPPORTED, "more than one part", err);
    return true;
}

static void file_close(struct exr_file *file)
{
    if (file->ctxt)
        exr_finish(&file->ctxt);
    mem_free(file->source.data);
}

static struct image *file_read(const struct exr_file *file, const char *layer,
                               struct err *err)
{
    const struct source *source = &file->source;
    struct target target = {.layer = layer};
    if (choose_channels(source, file->ctxt, &target, err) &&
        check_window(source, file->ctxt, &target, err) &&
        read_pixels(source, file->ctxt, &target, err) &&
        crop(source, file->ctxt, &target, err))
        return target.image;
    image_destroy(target.image);
    return NULL;
}

struct image *exr_read(const char *path, const struct place *at, struct err *err)
{
    struct exr_file file = {.source = {.path = path, .at = at}};
    struct image *image = file_open(&file, err) ? file_read(&file, NULL, err) : NULL;
    file_close(&file);
    return image;
}

struct exr_file *exr_open(const char *path)
{
    struct exr_file *file = mem_alloc(1, sizeof *file);
    file->source.path = path;
    if (file_open(file, NULL))
        return file;
    exr_close(file);
    return NULL;
}

struct image *exr_layer(const struct exr_file *file, const char *layer)
{
    return file_read(file, layer, NULL);
}

void exr_close(struct exr_file *file)
{
    if (file == NULL)
        return;
    file_close(file);
    mem_free(file);
}

char *exr_read_attribute(const char *path, const char *name)
{
    struct source source = {.path = path};
    exr_context_t ctxt = source_open(&source, NULL);
    char *value = NULL;
    if (ctxt) {
        const char *text = NULL;
        int32_t length = 0;
        if (exr_attr_get_string(ctxt, 0, name, &length, &text) == EXR_ERR_SUCCESS && text)
            value = text_copy_n(text, (size_t)length);
        exr_finish(&ctxt);
    }
    mem_free(source.data);
    return value;
}
