#include "image/exr.h"

#include "base/mem.h"
#include "base/text.h"

#include <openexr.h>
#include <stdio.h>
#include <string.h>

/* The file grows in memory; it reaches the disk whole or not at all. */
struct sink {
    char *data;
    size_t size, capacity;
    char message[256]; /* the library's first complaint */
};

static int64_t sink_write(exr_const_context_t ctxt, void *user, const void *buffer,
                          uint64_t size, uint64_t offset,
                          exr_stream_error_func_ptr_t fail)
{
    (void)ctxt;
    (void)fail;
    struct sink *sink = user;
    size_t end = (size_t)(offset + size);
    sink->data = mem_grow(sink->data, &sink->capacity, end, 1);
    if (offset > sink->size)
        memset(sink->data + sink->size, 0, (size_t)offset - sink->size);
    memcpy(sink->data + offset, buffer, (size_t)size);
    sink->size = end > sink->size ? end : sink->size;
    return (int64_t)size;
}

static void keep_message(exr_const_context_t ctxt, exr_result_t code, const char *message)
{
    (void)code;
    void *user = NULL;
    if (exr_get_user_data(ctxt, &user) != EXR_ERR_SUCCESS || !user)
        return;
    struct sink *sink = user;
    if (!sink->message[0])
        snprintf(sink->message, sizeof sink->message, "%s", message);
}

/* The picture to be written. */
struct picture {
    const struct image *image;
    const struct exr_attribute *attributes;
    int attribute_count;
    struct layers layers;
};

static bool has_long_name(const struct picture *p)
{
    size_t longest = 0;
    for (int i = 0; i < p->attribute_count; i++) {
        size_t length = strlen(p->attributes[i].name);
        longest = length > longest ? length : longest;
    }
    for (int i = 0; i < p->layers.count; i++) {
        size_t length = strlen(p->layers.list[i].name);
        longest = length > longest ? length : longest;
    }
    return longest > 31; /* older readers stop at longer names: only when needed */
}

static exr_result_t add_channel(exr_context_t ctxt, const char *name)
{
    return exr_add_channel(ctxt, 0, name, EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC,
                           1, 1);
}

static exr_result_t write_windows(exr_context_t ctxt, const struct image *image)
{
    exr_attr_box2i_t whole, data;
    exr_attr_v2f_t centre;
    centre.x = centre.y = 0.0f;
    whole.min.x = whole.min.y = 0;
    whole.max.x = image->whole_width - 1;
    whole.max.y = image->whole_height - 1;
    data.min.x = image->x;
    data.min.y = image->y;
    data.max.x = image->x + image->width - 1;
    data.max.y = image->y + image->height - 1;
    return exr_initialize_required_attr(ctxt, 0, &whole, &data, 1.0f, &centre, 1.0f,
                                        EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP);
}

static exr_result_t write_header(exr_context_t ctxt, const struct picture *p)
{
    int part = 0;
    exr_result_t rv = exr_set_longname_support(ctxt, has_long_name(p));
    if (rv == EXR_ERR_SUCCESS)
        rv = exr_add_part(ctxt, "main", EXR_STORAGE_SCANLINE, &part);
    if (rv == EXR_ERR_SUCCESS)
        rv = write_windows(ctxt, p->image);
    for (int c = 0; c < 3 && rv == EXR_ERR_SUCCESS; c++)
        rv = add_channel(ctxt, (const char *[]){"R", "G", "B"}[c]);
    for (int i = 0; i < p->layers.count && rv == EXR_ERR_SUCCESS; i++)
        rv = add_channel(ctxt, p->layers.list[i].name);
    for (int i = 0; i < p->attribute_count && rv == EXR_ERR_SUCCESS; i++)
        rv = exr_attr_set_string(ctxt, 0, p->attributes[i].name, p->attributes[i].value);
    return rv == EXR_ERR_SUCCESS ? exr_write_header(ctxt) : rv;
}

/* Points the channel at row y of its values. */
static void bind_channel(exr_coding_channel_info_t *channel, const struct picture *p,
                         int y)
{
    const float *from = NULL;
    int stride = 3;
    for (int c = 0; c < 3; c++)
        if (strcmp(channel->channel_name, (const char *[]){"R", "G", "B"}[c]) == 0)
            from = image_at(p->image, 0, y) + c;
    for (int i = 0; !from && i < p->layers.count; i++) {
        if (strcmp(channel->channel_name, p->layers.list[i].name) != 0)
            continue;
        from = p->layers.list[i].values + (size_t)y * (size_t)p->image->width;
        stride = 1;
    }
    channel->encode_from_ptr = (const uint8_t *)from;
    channel->user_pixel_stride = stride * (int)sizeof(float);
    channel->user_line_stride = stride * p->image->width * (int)sizeof(float);
    channel->user_bytes_per_element = sizeof(float);
    channel->user_data_type = EXR_PIXEL_FLOAT;
}

typedef exr_result_t (*compressor)(exr_encode_pipeline_t *encoder);

/* The library's compressor is kept in the user data. Readers take a chunk whose length
 * equals that of its pixels as uncompressed, but the library (3.1.5) may write compressed
 * chunks of exactly that length. */
static exr_result_t compress_or_not(exr_encode_pipeline_t *encoder)
{
    compressor compress;
    memcpy(&compress, encoder->encoding_user_data, sizeof compress);
    exr_result_t rv = compress(encoder);
    if (rv == EXR_ERR_SUCCESS && encoder->compressed_bytes == encoder->packed_bytes)
        memcpy(encoder->compressed_buffer, encoder->packed_buffer, encoder->packed_bytes);
    return rv;
}

static exr_result_t write_chunk(exr_context_t ctxt, const struct picture *p, int y)
{
    exr_chunk_info_t chunk;
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t rv = exr_write_scanline_chunk_info(ctxt, 0, p->image->y + y, &chunk);
    if (rv == EXR_ERR_SUCCESS)
        rv = exr_encoding_initialize(ctxt, 0, &chunk, &encoder);
    for (int i = 0; rv == EXR_ERR_SUCCESS && i < encoder.channel_count; i++)
        bind_channel(&encoder.channels[i], p, y);
    if (rv == EXR_ERR_SUCCESS)
        rv = exr_encoding_choose_default_routines(ctxt, 0, &encoder);
    compressor compress = encoder.compress_fn;
    encoder.encoding_user_data = &compress;
    if (compress)
        encoder.compress_fn = compress_or_not;
    if (rv == EXR_ERR_SUCCESS)
        rv = exr_encoding_run(ctxt, 0, &encoder);
    exr_encoding_destroy(ctxt, &encoder);
    return rv;
}

static exr_result_t encode(struct sink *sink, const char *path, const struct picture *p)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.user_data = sink;
    setup.write_fn = sink_write;
    setup.error_handler_fn = keep_message;
    exr_context_t ctxt = NULL;
    exr_result_t rv = exr_start_write(&ctxt, path, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (rv != EXR_ERR_SUCCESS)
        return rv;
    rv = write_header(ctxt, p);
    int32_t lines = 1;
    if (rv == EXR_ERR_SUCCESS)
        rv = exr_get_scanlines_per_chunk(ctxt, 0, &lines);
    for (int y = 0; rv == EXR_ERR_SUCCESS && y < p->image->height; y += lines)
        rv = write_chunk(ctxt, p, y);
    exr_result_t finished = exr_finish(&ctxt);
    return rv == EXR_ERR_SUCCESS ? finished : rv;
}

/* The library would confuse a layer called "R" with the picture's channel. */
static bool check_names(const char *path, const struct picture *p, struct err *err)
{
    for (int i = 0; i < p->layers.count; i++) {
        const char *name = p->layers.list[i].name;
        bool taken = text_equal(name, "R") || text_equal(name, "G") ||
                     text_equal(name, "B") || !name[0];
        for (int j = 0; j < i; j++)
            taken = taken || text_equal(name, p->layers.list[j].name);
        if (taken)
            return err_set(err, ERR_VALUE, NULL,
                           "cannot write '%s': the name '%s' of layer %d is empty or "
                           "in use",
                           path, name, i + 1);
    }
    return true;
}

bool exr_write(const char *path, const struct image *image,
               const struct exr_attribute *attributes, int attribute_count,
               const struct layers *layers, struct err *err)
{
    struct picture p = {image, attributes, attribute_count, {.count = 0}};
    struct sink sink = {0};
    if (layers)
        p.layers = *layers;
    if (!check_names(path, &p, err))
        return false;
    exr_result_t rv = encode(&sink, path, &p);
    bool ok = rv == EXR_ERR_SUCCESS
                  ? text_write_file(path, sink.data, sink.size, err)
                  : err_set(err, ERR_IO, NULL, "cannot write '%s': %s", path,
                            sink.message[0] ? sink.message
                                            : exr_get_default_error_message(rv));
    mem_free(sink.data);
    return ok;
}
