/* surface/png_check: any one bit of a PNG file that is flipped is seen. */
#include "surface/png_check.h"

#include "base/text.h"
#include "base/mem.h"
#include "image/preview.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>
#include <unistd.h>

/* The file of a small picture. */
static unsigned char *make(size_t *size)
{
    char path[] = "/tmp/etalon_png_XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    close(fd);
    struct image *image = image_create(5, 3);
    for (int i = 0; i < 45; i++)
        image->pixels[i] = (float)i / 45.0f;
    assert_true(preview_write_png(path, image, 0.0, NULL));
    image_destroy(image);
    char *data = text_read_file(path, size, NULL, NULL);
    assert_non_null(data);
    unlink(path);
    return (unsigned char *)data;
}

static void damage_is_seen(void **state)
{
    (void)state;
    size_t size;
    unsigned char *data = make(&size);
    assert_null(png_check(data, size));
    for (size_t at = 8; at < size; at++)
        for (int bit = 0; bit < 8; bit++) {
            data[at] ^= (unsigned char)(1 << bit);
            assert_non_null(png_check(data, size));
            data[at] ^= (unsigned char)(1 << bit);
        }
    for (size_t cut = 8; cut < size; cut++)
        assert_non_null(png_check(data, cut));
    assert_null(png_check(data, size));
    mem_free(data);
}

static void others_are_not_its_business(void **state)
{
    (void)state;
    assert_null(png_check((const unsigned char *)"P6 1 1 255", 10));
    assert_null(png_check((const unsigned char *)"", 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damage_is_seen),
        cmocka_unit_test(others_are_not_its_business),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
