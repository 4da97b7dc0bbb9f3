/* Pictures of earlier times: at any length one of a half to a quarter of it, and how much
 * more than luminance colours have moved since. */
#include "base/mem.h"
#include "base/text.h"
#include "convergence/past_snapshots.h"
#include "math/rgb.h"
#include "support/test_file.h"

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <setjmp.h>
#include <cmocka.h>

enum { WIDTH = 3, HEIGHT = 2, VALUES = 3 * WIDTH * HEIGHT };

/* A picture whose pixels hold `value`, as sums in steps of `scale`. */
struct plain {
    double value, scale;
};

static void add(const void *self, long pixel, exact_sum sums[FIXED_SUMS])
{
    const struct plain *plain = self;
    for (int c = 0; c < 3; c++)
        sums[c] = exact_add(
            sums[c], exact_of(plain->value / plain->scale * (double)(pixel + 1 + c)));
}

static void take(struct past_snapshots *past, double length, double value, double scale)
{
    struct plain plain = {value, scale};
    struct fixed_picture picture = {&plain, add, {scale}, 3};
    past_snapshots_take(past, length, &picture);
}

static void there_is_one_of_half_the_length(void **state)
{
    (void)state;
    struct past_snapshots e;
    int taken = 0;
    past_snapshots_init(&e, WIDTH, HEIGHT, 640.0, 0);
    for (int length = 1; length <= 3000; length++) {
        if (past_snapshots_due(&e, length)) {
            take(&e, length, length, 0.5);
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

static void write_file(const char *path, struct past_snapshots *from)
{
    struct err err = {0};
    struct pack *pack = pack_create(path, 1, &err);
    past_snapshots_pack(pack, from);
    assert_true(pack_close(pack, &err));
}

static void read_file(const char *path, struct past_snapshots *into, bool adds)
{
    struct err err = {0};
    struct pack *pack = pack_open(path, 1, &err);
    assert_non_null(pack);
    pack_set_part(pack, (struct run_part){0, 2}, adds);
    past_snapshots_pack(pack, into);
    assert_true(pack_close(pack, &err));
}

/* What a checkpoint brings back goes on as if nothing had been. */
static void a_checkpoint_holds_them(void **state)
{
    (void)state;
    struct past_snapshots written, read;
    char *path = test_file("past_snapshots");
    past_snapshots_init(&written, WIDTH, HEIGHT, 64.0, 0);
    past_snapshots_init(&read, WIDTH, HEIGHT, 640.0, 0);
    for (int length = 1; length < 4; length++)
        if (past_snapshots_due(&written, length))
            take(&written, length, 0.1 * length, 1.0);
    write_file(path, &written);
    read_file(path, &read, false);
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
    mem_free(path);
}

/* Those of two parts, of which the clock may have ended one later, so that its sums have
 * another scale, are those of the whole. */
static void parts_add_up(void **state)
{
    (void)state;
    char *path = test_file("past_snapshots");
    for (int timed = 0; timed < 2; timed++) {
        struct past_snapshots whole, sum, part;
        past_snapshots_init(&whole, WIDTH, HEIGHT, 64.0, 0);
        past_snapshots_init(&sum, WIDTH, HEIGHT, 64.0, 3);
        take(&whole, 1.0, 0.3, 0.25);
        for (int i = 0; i < 2; i++) {
            past_snapshots_init(&part, WIDTH, HEIGHT, 64.0, 3);
            take(&part, 1.0, i == 0 ? 0.1 : 0.2, timed && i == 1 ? 0.125 : 0.25);
            write_file(path, &part);
            read_file(path, &sum, true);
            past_snapshots_deinit(&part);
        }
        past_snapshots_complete(&sum, 1.0);
        for (int i = 0; i < VALUES; i++)
            assert_true(fabs((double)(sum.pictures[0]->pixels[i] -
                                      whole.pictures[0]->pixels[i])) < 1e-6);
        past_snapshots_clear(&sum);
        past_snapshots_complete(&sum, 1.0);
        assert_true(sum.pictures[0]->pixels[0] == 0.0f);
        past_snapshots_deinit(&whole);
        past_snapshots_deinit(&sum);
    }
    remove(path);
    mem_free(path);
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
        cmocka_unit_test(parts_add_up),
        cmocka_unit_test(colours_beside_luminance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
