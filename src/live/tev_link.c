#include "live/tev_link.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/text.h"
#include "live/address.h"
#include "live/mailbox.h"
#include "live/tev.h"

#include <errno.h>
#include <poll.h>
#include <stdatomic.h>
#include <sys/socket.h>
#include <unistd.h>

/* All in seconds. */
#define RETRY    3.0 /* between two attempts to connect */
#define CONNECT  3.0 /* until an attempt is given up */
#define STALLED  5.0 /* until a viewer that takes nothing is dropped */
#define PATIENCE 2.0 /* with it at the end */

struct tev_link {
    struct addrinfo *addresses;
    char *name;
    struct mailbox *mailbox;
    atomic_bool connected, closing;
    /* Of the thread: */
    int socket; /* -1: none */
    double next_attempt;
    int width, height; /* of the picture that the viewer has; 0: none */
    uint8_t *packet;
    atomic_long sent;
};

/* --- the socket ------------------------------------------------------------------- */

static void disconnect(struct tev_link *link)
{
    if (link->socket >= 0)
        close(link->socket);
    link->socket = -1;
    link->width = link->height = 0;
    link->next_attempt = clock_wall() + RETRY;
    atomic_store(&link->connected, false);
}

/* Until the socket can be written to; false after `seconds`, or at the end of the run. */
static bool wait_writable(const struct tev_link *link, int fd, double seconds)
{
    double end = clock_wall() + seconds, closing = 0.0;
    while (clock_wall() < end) {
        struct pollfd poll_of = {.fd = fd, .events = POLLOUT};
        if (poll(&poll_of, 1, 100) > 0)
            return true;
        double now = clock_wall();
        if (closing == 0.0 && atomic_load(&link->closing))
            closing = now;
        if (closing > 0.0 && now >= closing + PATIENCE / 2.0)
            return false;
    }
    return false;
}

static int connect_to(const struct tev_link *link, const struct addrinfo *a)
{
    int cause = 0;
    socklen_t size = sizeof cause;
    int fd = socket(a->ai_family, a->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd < 0)
        return -1;
    if (connect(fd, a->ai_addr, a->ai_addrlen) == 0)
        return fd;
    if (errno == EINPROGRESS && wait_writable(link, fd, CONNECT) &&
        getsockopt(fd, SOL_SOCKET, SO_ERROR, &cause, &size) == 0 && cause == 0)
        return fd;
    close(fd);
    return -1;
}

static void attempt(struct tev_link *link)
{
    if (link->socket >= 0 || clock_wall() < link->next_attempt)
        return;
    const struct addrinfo *a = link->addresses;
    for (; a && link->socket < 0; a = a->ai_next)
        link->socket = connect_to(link, a);
    link->next_attempt = clock_wall() + RETRY;
    atomic_store(&link->connected, link->socket >= 0);
}

static bool send_packet(struct tev_link *link, size_t size)
{
    const uint8_t *at = link->packet;
    while (size > 0) {
        ssize_t n = send(link->socket, at, size, MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK) &&
            wait_writable(link, link->socket, STALLED))
            continue;
        if (n < 0)
            return false;
        at += n;
        size -= (size_t)n;
    }
    return true;
}

/* --- pictures --------------------------------------------------------------------- */

static bool create_picture(struct tev_link *link, const struct image *image)
{
    if (link->width == image->width && link->height == image->height)
        return true;
    link->width = image->width;
    link->height = image->height;
    return send_packet(
        link, tev_create_image(link->packet, link->name, image->width, image->height));
}

static bool send_tiles(struct tev_link *link, const struct image *image)
{
    for (int y = 0; y < image->height; y += TEV_TILE)
        for (int x = 0; x < image->width; x += TEV_TILE)
            for (int c = 0; c < 3; c++)
                if (!send_packet(
                        link, tev_update_image(link->packet, link->name, image, c, x, y)))
                    return false;
    return true;
}

static void work(void *ctx, void *item)
{
    struct tev_link *link = ctx;
    struct image *image = item;
    attempt(link);
    if (image && link->socket >= 0) {
        if (create_picture(link, image) && send_tiles(link, image))
            atomic_fetch_add(&link->sent, 1);
        else
            disconnect(link);
    }
    image_destroy(image);
}

static void discard(void *image)
{
    image_destroy(image);
}

/* --- open and close --------------------------------------------------------------- */

static void release(struct tev_link *link)
{
    if (link->socket >= 0)
        close(link->socket);
    freeaddrinfo(link->addresses);
    mem_free(link->packet);
    mem_free(link->name);
    mem_free(link);
}

struct tev_link *tev_link_open(const char *address, const char *name, struct err *err)
{
    struct addrinfo *addresses = address_find("--tev", address, NULL, err);
    if (addresses == NULL)
        return NULL;
    struct tev_link *link = mem_alloc(1, sizeof *link);
    link->addresses = addresses;
    link->name = text_copy(name);
    link->packet = mem_alloc(tev_packet_most(name), 1);
    link->socket = -1;
    struct mailbox_work job = {work, discard, link, 0.5};
    link->mailbox = mailbox_create(&job, err);
    if (link->mailbox)
        return link;
    release(link);
    return NULL;
}

bool tev_link_ready(struct tev_link *link)
{
    return atomic_load(&link->connected) && mailbox_idle(link->mailbox);
}

void tev_link_send(struct tev_link *link, const struct image *image)
{
    mailbox_put(link->mailbox, image_copy(image));
}

double tev_link_cpu(struct tev_link *link)
{
    return mailbox_cpu(link->mailbox);
}

long tev_link_close(struct tev_link *link)
{
    if (link == NULL)
        return 0;
    atomic_store(&link->closing, true);
    bool ended = mailbox_destroy(link->mailbox, PATIENCE);
    long sent = atomic_load(&link->sent);
    if (ended)
        release(link);
    return sent;
}
