/* Pictures of earlier times: at any length one of a half to a quarter of it, and how much
 * more than luminance colours have moved since. */
#include "convergence/past_snapshots.h"
#include "math/rgb.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include <setjmp.h>
#include <cmocka.h>

enum { WIDTH = 3, HEIGHT = 2, VALUES = 3 * WIDTH * HEIGHT };

static void there_is_one_of_half_the_length(void **state)
{
    (void)state;
    struct past_snapshots e;
    int taken = 0;
    past_snapshots_init(&e, WIDTH, HEIGHT, 640.0);
    for (int length = 1; length <= 3000; length++) {
        struct image *wanted = past_snapshots_next(&e, length);
        if (wanted) {
            wanted->pixels[0] = (float)length;
            taken++;
        }
        const struct image *half = past_snapshots_latest(&e, length);
        if (length < 14)
            assert_null(half);
        if (length < 20)
            continue;
        assert_non_null(half);
        assert_true((double)half->pixels[0] <= 0.75 * length);
        assert_true((double)half->pixels[0] >= 0.25 * length);
    }
    assert_int_equal(taken, 9); /* at 10, 20, 40, ... 2560 */
    past_snapshots_deinit(&e);
}

/* What a checkpoint brings back goes on as if nothing had been. */
static void a_checkpoint_holds_them(void **state)
{
    (void)state;
    struct past_snapshots written, read;
    struct err err = {0};
    char path[] = "/tmp/etalon_earlier_XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    past_snapshots_init(&written, WIDTH, HEIGHT, 64.0);
    past_snapshots_init(&read, WIDTH, HEIGHT, 640.0);
    for (int length = 1; length < 4; length++) {
        struct image *wanted = past_snapshots_next(&written, length);
        if (wanted)
            wanted->pixels[VALUES - 1] = 0.1f * (float)length;
    }
    struct pack *pack = pack_create(path, 1, &err);
    past_snapshots_pack(pack, &written);
    assert_true(pack_close(pack, &err));
    pack = pack_open(path, 1, &err);
    assert_non_null(pack);
    past_snapshots_pack(pack, &read);
    assert_true(pack_close(pack, &err));
    assert_true(read.due == written.due && read.due == 4.0);
    for (int length = 1; length < 9; length++) {
        const struct image *a = past_snapshots_latest(&written, length),
                           *b = past_snapshots_latest(&read, length);
        assert_true((a == NULL) == (b == NULL));
        if (a)
            assert_memory_equal(a->pixels, b->pixels, VALUES * sizeof(float));
    }
    past_snapshots_deinit(&written);
    past_snapshots_deinit(&read);
    remove(path);
}

static void fill(struct image *image, float red, float green, float blue)
{
    const float values[3] = {red, green, blue};
    for (int i = 0; i < VALUES; i++)
        image->pixels[i] = values[i % 3];
}

static void colours_beside_luminance(void **state)
{
    (void)state;
    struct image *now = image_create(WIDTH, HEIGHT), *then = image_create(WIDTH, HEIGHT);
    double ratios[3];
    fill(now, 2.0f, 2.0f, 2.0f);
    fill(then, 2.0f, 2.0f, 2.0f);
    past_snapshots_colours(now, then, 0.01, ratios);
    for (int c = 0; c < 3; c++)
        assert_true(ratios[c] == 1.0);
    fill(then, 3.0f, 3.0f, 3.0f);
    past_snapshots_colours(now, then, 0.01, ratios);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(ratios[c] - 1.0) < 1e-6);
    fill(then, 2.0f, 2.0f, 3.0f);
    past_snapshots_colours(now, then, 0.01, ratios);
    double part = rgb_luminance(rgb(0.0, 0.0, 1.0));
    assert_true(ratios[0] == 0.0 && ratios[1] == 0.0);
    assert_true(fabs(ratios[2] * part * part - 1.0) < 1e-6);
    image_destroy(now);
    image_destroy(then);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(there_is_one_of_half_the_length),
        cmocka_unit_test(a_checkpoint_holds_them),
        cmocka_unit_test(colours_beside_luminance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
