#include "live/http.h"

#include "base/clock.h"
#include "base/mem.h"
#include "live/address.h"

#include <errno.h>
#include <math.h>
#include <microhttpd.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#define DOCUMENTS     8
#define CONNECTIONS   32    /* at a time; a further one is refused */
#define IDLE_SECONDS  15    /* until one that neither asks nor reads is closed */
#define REQUEST_BYTES 16384 /* memory of a connection: a longer request is refused */

struct document {
    const char *name;
    struct MHD_Response *response; /* NULL: no such document */
    double asked;                  /* clock_wall() */
    long version;                  /* 1, 2, ... */
    bool sent;                     /* this version to a viewer, whole */
};

/* What a connection is being sent. */
struct request {
    struct document *document; /* NULL: none of them */
    long version;
};

struct http {
    struct MHD_Daemon *daemon;
    char *url, *host; /* host: as a browser names it, "[::1]" */
    bool loopback;
    struct MHD_Response *missing, *refused, *foreign;
    pthread_mutex_t lock; /* of: */
    double cpu;           /* of the server's thread, at its last answer, s */
    struct document documents[DOCUMENTS];
};

/* --- answers ---------------------------------------------------------------------- */

/* The state of the run is for this page alone, not for scripts of other sites. */
static void add_headers(struct MHD_Response *response, const char *type)
{
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, type);
    MHD_add_response_header(response, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
    MHD_add_response_header(response, "X-Content-Type-Options", "nosniff");
    MHD_add_response_header(response, "Cross-Origin-Resource-Policy", "same-origin");
}

static struct MHD_Response *short_answer(const char *words)
{
    struct MHD_Response *response = MHD_create_response_from_buffer(
        strlen(words), (void *)words, MHD_RESPMEM_PERSISTENT);
    add_headers(response, "text/plain; charset=utf-8");
    return response;
}

/* The lock is held. */
static struct document *find(struct http *http, const char *name)
{
    for (int i = 0; i < DOCUMENTS; i++)
        if (http->documents[i].name && strcmp(http->documents[i].name, name) == 0)
            return &http->documents[i];
    return NULL;
}

static enum MHD_Result send_document(struct http *http, struct MHD_Connection *connection,
                                     const char *name, struct request *request)
{
    enum MHD_Result result;
    pthread_mutex_lock(&http->lock);
    struct document *document = find(http, name);
    if (document) {
        document->asked = clock_wall();
        *request = (struct request){document, document->version};
        result = MHD_queue_response(connection, MHD_HTTP_OK, document->response);
    } else {
        result = MHD_queue_response(connection, MHD_HTTP_NOT_FOUND, http->missing);
    }
    pthread_mutex_unlock(&http->lock);
    return result;
}

/* At loopback only names of this machine: a page of another site whose name is made to
 * lead here (DNS rebinding) would otherwise read the run. */
static bool is_for_us(const struct http *http, struct MHD_Connection *connection)
{
    const char *const names[] = {"localhost", "127.0.0.1", "[::1]", http->host};
    const char *host = MHD_lookup_connection_value(connection, MHD_HEADER_KIND,
                                                   MHD_HTTP_HEADER_HOST);
    for (size_t i = 0; host && i < sizeof names / sizeof *names; i++) {
        size_t length = strlen(names[i]);
        if (strncasecmp(host, names[i], length) == 0 &&
            (host[length] == '\0' || host[length] == ':'))
            return true;
    }
    return !http->loopback;
}

/* When a request has ended, answered or not. */
static void on_completed(void *ctx, struct MHD_Connection *connection, void **state,
                         enum MHD_RequestTerminationCode how)
{
    struct http *http = ctx;
    struct request *request = *state;
    (void)connection;
    pthread_mutex_lock(&http->lock);
    http->cpu = clock_cpu_thread();
    if (request && request->document && how == MHD_REQUEST_TERMINATED_COMPLETED_OK &&
        request->document->version == request->version)
        request->document->sent = true;
    pthread_mutex_unlock(&http->lock);
    mem_free(request);
    *state = NULL;
}

/* Called first without a body, then for each piece of one, at last without. */
static enum MHD_Result answer(void *ctx, struct MHD_Connection *connection,
                              const char *url, const char *method, const char *version,
                              const char *body, size_t *body_size, void **state)
{
    struct http *http = ctx;
    (void)version;
    (void)body;
    if (strcmp(method, MHD_HTTP_METHOD_GET) != 0 &&
        strcmp(method, MHD_HTTP_METHOD_HEAD) != 0)
        return MHD_queue_response(connection, MHD_HTTP_METHOD_NOT_ALLOWED, http->refused);
    if (*state == NULL) {
        *state = mem_alloc(1, sizeof(struct request));
        return MHD_YES;
    }
    if (*body_size > 0) /* nothing here takes a body: hang up */
        return MHD_NO;
    if (!is_for_us(http, connection))
        return MHD_queue_response(connection, MHD_HTTP_FORBIDDEN, http->foreign);
    if (*url != '/')
        return MHD_queue_response(connection, MHD_HTTP_NOT_FOUND, http->missing);
    return send_document(http, connection, url[1] ? url + 1 : "index.html", *state);
}

/* --- the socket ------------------------------------------------------------------- */

static int listen_at(const struct addrinfo *a)
{
    int yes = 1;
    int fd = socket(a->ai_family, a->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd < 0)
        return -1;
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (bind(fd, a->ai_addr, a->ai_addrlen) == 0 && listen(fd, CONNECTIONS) == 0)
        return fd;
    int cause = errno;
    close(fd);
    errno = cause;
    return -1;
}

/* Sets url, host and loopback. */
static void name_self(struct http *http, int fd)
{
    struct sockaddr_storage own;
    socklen_t size = sizeof own;
    char host[NI_MAXHOST], port[NI_MAXSERV];
    getsockname(fd, (struct sockaddr *)&own, &size);
    getnameinfo((struct sockaddr *)&own, size, host, sizeof host, port, sizeof port,
                NI_NUMERICHOST | NI_NUMERICSERV);
    http->host = strchr(host, ':') ? text_format("[%s]", host) : text_copy(host);
    http->url = text_format("http://%s:%s/", http->host, port);
    http->loopback = strncmp(host, "127.", 4) == 0 || strcmp(host, "::1") == 0;
}

static void keep_quiet(void *ctx, const char *format, va_list args)
{
    (void)ctx;
    (void)format;
    (void)args;
}

/* Signals are for the thread that renders. */
static struct MHD_Daemon *start(struct http *http, int fd)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    struct MHD_Daemon *daemon = MHD_start_daemon(
        MHD_USE_AUTO | MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_ERROR_LOG, 0, NULL, NULL,
        answer, http, MHD_OPTION_EXTERNAL_LOGGER, keep_quiet, NULL,
        MHD_OPTION_NOTIFY_COMPLETED, on_completed, http, MHD_OPTION_LISTEN_SOCKET, fd,
        MHD_OPTION_CONNECTION_LIMIT, (unsigned)CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT,
        (unsigned)IDLE_SECONDS, MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)REQUEST_BYTES,
        MHD_OPTION_END);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return daemon;
}

static struct http *create(int fd, const char *address, struct err *err)
{
    struct http *http = mem_alloc(1, sizeof *http);
    pthread_mutex_init(&http->lock, NULL);
    name_self(http, fd);
    http->missing = short_answer("no such page\n");
    http->refused = short_answer("this page is only to be read\n");
    http->foreign = short_answer("the name of this server is another\n");
    MHD_add_response_header(http->refused, MHD_HTTP_HEADER_ALLOW, "GET, HEAD");
    http->daemon = start(http, fd);
    if (http->daemon)
        return http;
    http_close(http);
    err_set(err, ERR_IO, NULL, "--live '%s': the server does not start", address);
    return NULL;
}

struct http *http_open(const char *address, struct err *err)
{
    struct addrinfo *found = address_find("--live", address, "127.0.0.1", err);
    int fd = -1;
    if (found == NULL)
        return NULL;
    for (const struct addrinfo *a = found; a && fd < 0; a = a->ai_next)
        fd = listen_at(a);
    int cause = errno;
    freeaddrinfo(found);
    if (fd >= 0)
        return create(fd, address, err);
    err_set(err, ERR_IO, NULL, "--live '%s': cannot listen there: %s%s", address,
            strerror(cause), cause == EADDRINUSE ? "; give another port" : "");
    return NULL;
}

const char *http_url(const struct http *http)
{
    return http->url;
}

double http_cpu(struct http *http)
{
    pthread_mutex_lock(&http->lock);
    double cpu = http->cpu;
    pthread_mutex_unlock(&http->lock);
    return cpu;
}

void http_close(struct http *http)
{
    if (http == NULL)
        return;
    if (http->daemon)
        MHD_stop_daemon(http->daemon);
    for (int i = 0; i < DOCUMENTS; i++)
        if (http->documents[i].response)
            MHD_destroy_response(http->documents[i].response);
    MHD_destroy_response(http->missing);
    MHD_destroy_response(http->refused);
    MHD_destroy_response(http->foreign);
    pthread_mutex_destroy(&http->lock);
    mem_free(http->url);
    mem_free(http->host);
    mem_free(http);
}

/* --- documents -------------------------------------------------------------------- */

/* Viewers that are still being sent the old one keep it until they have it. */
void http_publish(struct http *http, const char *name, const char *type,
                  struct text *text)
{
    struct MHD_Response *response = MHD_create_response_from_buffer_with_free_callback(
        text->length, text->data, mem_free);
    add_headers(response, type);
    *text = (struct text){0};
    pthread_mutex_lock(&http->lock);
    struct document *document = find(http, name);
    for (int i = 0; document == NULL && i < DOCUMENTS; i++)
        if (http->documents[i].name == NULL) {
            document = &http->documents[i];
            *document = (struct document){.name = name, .asked = -HUGE_VAL};
        }
    struct MHD_Response *old = document->response;
    document->response = response;
    document->version++;
    document->sent = false;
    pthread_mutex_unlock(&http->lock);
    if (old)
        MHD_destroy_response(old);
}

double http_asked(struct http *http, const char *name)
{
    pthread_mutex_lock(&http->lock);
    const struct document *document = find(http, name);
    double asked = document ? document->asked : -HUGE_VAL;
    pthread_mutex_unlock(&http->lock);
    return clock_wall() - asked;
}

bool http_sent(struct http *http, const char *name)
{
    pthread_mutex_lock(&http->lock);
    const struct document *document = find(http, name);
    bool sent = document && document->sent;
    pthread_mutex_unlock(&http->lock);
    return sent;
}
