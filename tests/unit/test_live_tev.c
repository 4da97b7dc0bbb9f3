/* tev's protocol, byte for byte, by a receiver of its own that was written from the
 * published description (tev's README and src/Ipc.cpp, pbrt v4's display.cpp), and what
 * viewers that are absent, gone or slow do to a run: nothing. */

#include "live/tev.h"
#include "live/tev_link.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/text.h"

#include <math.h>
#include <netinet/in.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>
#include <cmocka.h>

/* More than one tile each way, with a rest. */
#define WIDTH  150
#define HEIGHT 130

static void nap(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
}

static struct image *make_image(float first)
{
    struct image *image = image_create(WIDTH, HEIGHT);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image->pixels[i] = first + (float)i;
    return image;
}

/* --- the receiver ------------------------------------------------------------------ */

struct receiver {
    int listener, socket;
    int port;
    uint8_t *packet; /* the last one, without its length */
    size_t size, at;
    int created;
    char name[64];
    struct image *image; /* as it was told */
};

static void receiver_listen(struct receiver *r)
{
    struct sockaddr_in own = {.sin_family = AF_INET,
                              .sin_port = htons((uint16_t)r->port),
                              .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof own;
    int yes = 1;
    r->listener = socket(AF_INET, SOCK_STREAM, 0);
    setsockopt(r->listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    assert_int_equal(bind(r->listener, (struct sockaddr *)&own, sizeof own), 0);
    assert_int_equal(listen(r->listener, 1), 0);
    getsockname(r->listener, (struct sockaddr *)&own, &size);
    r->port = ntohs(own.sin_port);
}

static void receiver_accept(struct receiver *r)
{
    struct timeval patience = {.tv_sec = 10};
    setsockopt(r->listener, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    r->socket = accept(r->listener, NULL, NULL);
    assert_true(r->socket >= 0);
    setsockopt(r->socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
}

static void receiver_hang_up(struct receiver *r)
{
    close(r->socket);
    close(r->listener);
    mem_free(r->packet);
    image_destroy(r->image);
    r->packet = NULL;
    r->image = NULL;
}

static bool read_all(int fd, uint8_t *to, size_t size)
{
    ssize_t n = 1;
    for (; size > 0 && n > 0; to += n, size -= (size_t)n)
        n = read(fd, to, size);
    return size == 0;
}

static uint32_t u32(const uint8_t *at)
{
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static int take_int(struct receiver *r)
{
    assert_true(r->at + 4 <= r->size);
    r->at += 4;
    return (int)u32(r->packet + r->at - 4);
}

static int take_byte(struct receiver *r)
{
    assert_true(r->at < r->size);
    return r->packet[r->at++];
}

static const char *take_text(struct receiver *r)
{
    const char *text = (const char *)r->packet + r->at;
    size_t length = strnlen(text, r->size - r->at);
    assert_true(r->at + length < r->size);
    r->at += length + 1;
    return text;
}

static void take_creation(struct receiver *r)
{
    assert_int_equal(take_byte(r), 1);
    snprintf(r->name, sizeof r->name, "%s", take_text(r));
    int width = take_int(r), height = take_int(r);
    assert_int_equal(take_int(r), 3);
    assert_string_equal(take_text(r), "R");
    assert_string_equal(take_text(r), "G");
    assert_string_equal(take_text(r), "B");
    image_destroy(r->image);
    r->image = image_create(width, height);
    r->created++;
}

static void take_tile(struct receiver *r)
{
    assert_int_equal(take_byte(r), 0);
    assert_string_equal(take_text(r), r->name);
    const char *channel = take_text(r);
    int c = (int)(strchr("RGB", channel[0]) - "RGB");
    int x = take_int(r), y = take_int(r), width = take_int(r), height = take_int(r);
    assert_true(r->image && x >= 0 && y >= 0 && width > 0 && height > 0 &&
                x + width <= r->image->width && y + height <= r->image->height);
    for (int v = y; v < y + height; v++)
        for (int u = x; u < x + width; u++) {
            uint32_t bits = (uint32_t)take_int(r);
            memcpy(&image_at(r->image, u, v)[c], &bits, sizeof bits);
        }
}

/* Reads a packet; false at the end of the connection. */
static bool receive(struct receiver *r)
{
    uint8_t length[4];
    if (!read_all(r->socket, length, 4))
        return false;
    r->size = u32(length) - 4;
    assert_in_range(r->size, 3, 1 << 20);
    mem_free(r->packet);
    r->packet = mem_alloc(r->size, 1);
    r->at = 0;
    assert_true(read_all(r->socket, r->packet, r->size));
    int kind = take_byte(r);
    assert_true(kind == 4 || kind == 3);
    (kind == 4 ? take_creation : take_tile)(r);
    assert_int_equal(r->at, r->size);
    return true;
}

static void receive_picture(struct receiver *r)
{
    int tiles = 3 * ((WIDTH + TEV_TILE - 1) / TEV_TILE) *
                ((HEIGHT + TEV_TILE - 1) / TEV_TILE);
    int packets = tiles + (r->created == 0);
    for (int i = 0; i < packets; i++)
        assert_true(receive(r));
}

/* The picture, after at most two that had waited. */
static void receive_this(struct receiver *r, const struct image *expected)
{
    size_t bytes = 3 * WIDTH * HEIGHT * sizeof(float);
    receive_picture(r);
    for (int i = 0; i < 2 && memcmp(r->image->pixels, expected->pixels, bytes) != 0; i++)
        receive_picture(r);
    assert_memory_equal(r->image->pixels, expected->pixels, bytes);
}

/* --- tests ------------------------------------------------------------------------- */

static void test_bytes(void **state)
{
    (void)state;
    static const uint8_t creation[] = {28, 0, 0,   0, 4,   1, 'a', '.', 'x', 0,
                                       44, 1, 0,   0, 2,   0, 0,   0,   3,   0,
                                       0,  0, 'R', 0, 'G', 0, 'B', 0};
    static const uint8_t update[] = {34, 0, 0, 0, 3,    0,    'a', 0, 'G', 0,   0, 0,
                                     0,  0, 0, 0, 0,    0,    2,   0, 0,   0,   1, 0,
                                     0,  0, 0, 0, 0x80, 0x3f, 0,   0, 0,   0xc0};
    uint8_t *packet = mem_alloc(tev_packet_most("a.x"), 1);
    struct image *image = image_create(2, 1);
    image->pixels[1] = 1.0f;
    image->pixels[4] = -2.0f;
    size_t size = tev_create_image(packet, "a.x", 300, 2);
    assert_int_equal(size, sizeof creation);
    assert_memory_equal(packet, creation, size);
    size = tev_update_image(packet, "a", image, 1, 0, 0);
    assert_int_equal(size, sizeof update);
    assert_memory_equal(packet, update, size);
    image_destroy(image);
    mem_free(packet);
}

static struct tev_link *open_link(const struct receiver *r)
{
    struct err err = {0};
    char *address = text_format("localhost:%d", r->port);
    struct tev_link *link = tev_link_open(address, "out.exr", &err);
    assert_non_null(link);
    mem_free(address);
    return link;
}

static void wait_ready(struct tev_link *link)
{
    for (double end = clock_wall() + 10.0; !tev_link_ready(link); nap())
        assert_true(clock_wall() < end);
}

/* Absent at first, then there, then gone, then there again. */
static void test_comes_and_goes(void **state)
{
    (void)state;
    struct receiver r = {0};
    struct image *one = make_image(0.0f), *two = make_image(0.5f);
    receiver_listen(&r);
    close(r.listener);
    struct tev_link *link = open_link(&r);
    tev_link_send(link, one); /* nobody hears it */
    assert_false(tev_link_ready(link));
    receiver_listen(&r);
    wait_ready(link);
    receiver_accept(&r);
    tev_link_send(link, one);
    receive_this(&r, one);
    tev_link_send(link, two);
    receive_this(&r, two);
    assert_int_equal(r.created, 1);
    receiver_hang_up(&r);
    for (double end = clock_wall() + 10.0; tev_link_ready(link); nap()) {
        tev_link_send(link, one);
        assert_true(clock_wall() < end);
    }
    r.created = 0;
    receiver_listen(&r);
    wait_ready(link);
    receiver_accept(&r);
    tev_link_send(link, two);
    receive_this(&r, two);
    assert_true(tev_link_close(link) >= 3);
    assert_false(receive(&r));
    receiver_hang_up(&r);
    image_destroy(one);
    image_destroy(two);
}

/* One that never reads: pictures are dropped, no call waits. */
static void test_never_reads(void **state)
{
    (void)state;
    struct receiver r = {0};
    struct image *large = image_create(1024, 1024);
    receiver_listen(&r);
    struct tev_link *link = open_link(&r);
    wait_ready(link);
    receiver_accept(&r);
    for (int i = 0; i < 3; i++)
        tev_link_send(link, large);
    assert_false(tev_link_ready(link));
    double begin = clock_wall();
    assert_int_equal(tev_link_close(link), 0);
    assert_true(clock_wall() - begin < 4.5); /* gave up before STALLED */
    receiver_hang_up(&r);
    image_destroy(large);
}

static void test_refusals(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"14158", "give HOST:PORT"},
        {":14158", "give HOST:PORT"},
        {"localhost:0", "a number from 1 to 65535"},
        {"localhost:65536", "a number from 1 to 65535"},
        {"localhost:tev", "a number from 1 to 65535"},
        {"no.such.host.invalid:14158", "no address of 'no.such.host.invalid'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct err err = {0};
        assert_null(tev_link_open(cases[i][0], "out.exr", &err));
        assert_non_null(strstr(err.message, cases[i][1]));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_comes_and_goes),
        cmocka_unit_test(test_never_reads),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
