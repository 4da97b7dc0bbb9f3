/* The server of a run's page: what it serves, what it refuses, a hundred requests most of
 * which are malformed, and viewers that do not read. tests/cli/live.sh does the same
 * while a run goes. */

#include "live/http.h"
#include "live/site.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/text.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>
#include <cmocka.h>

#define LARGE ((size_t)8 << 20) /* bytes: more than sockets buffer */

static int port_of(const char *url)
{
    return atoi(strrchr(url, ':') + 1);
}

static int connect_to(int port)
{
    struct timeval patience = {.tv_sec = 10};
    struct sockaddr_in to = {.sin_family = AF_INET,
                             .sin_port = htons((uint16_t)port),
                             .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    int fd = socket(AF_INET, SOCK_STREAM, 0);
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    assert_int_equal(connect(fd, (struct sockaddr *)&to, sizeof to), 0);
    return fd;
}

/* The whole answer to a request that closes the connection; the caller owns it. */
static char *ask(int port, const char *request)
{
    struct text answer = {0};
    char block[4096];
    ssize_t n;
    int fd = connect_to(port);
    assert_int_equal(send(fd, request, strlen(request), MSG_NOSIGNAL), strlen(request));
    text_append(&answer, "%s", "");
    while ((n = read(fd, block, sizeof block)) > 0)
        text_append(&answer, "%.*s", (int)n, block);
    close(fd);
    return answer.data;
}

static void assert_answer(int port, const char *what, const char *begin, const char *end)
{
    char *request = text_format("%s HTTP/1.1\r\nHost: localhost\r\n"
                                "Connection: close\r\n\r\n",
                                what);
    char *answer = ask(port, request);
    size_t length = strlen(answer);
    assert_memory_equal(answer, begin, strlen(begin));
    assert_true(length >= strlen(end));
    assert_string_equal(answer + length - strlen(end), end);
    mem_free(request);
    mem_free(answer);
}

static void publish(struct http *http, const char *name, const char *content)
{
    struct text text = {0};
    text_append(&text, "%s", content);
    http_publish(http, name, "text/plain", &text);
    assert_null(text.data);
}

static void test_serves(void **state)
{
    (void)state;
    struct err err = {0};
    struct http *http = http_open("0", &err);
    assert_non_null(http);
    int port = port_of(http_url(http));
    publish(http, "index.html", "page");
    publish(http, "live.js", "first");
    assert_true(http_asked(http, "live.js") > 1e9);
    assert_answer(port, "GET /", "HTTP/1.1 200 OK\r\n", "\r\n\r\npage");
    assert_answer(port, "GET /index.html", "HTTP/1.1 200 OK\r\n", "\r\n\r\npage");
    assert_answer(port, "GET /live.js?17", "HTTP/1.1 200 OK\r\n", "\r\n\r\nfirst");
    publish(http, "live.js", "second");
    assert_answer(port, "GET /live.js", "HTTP/1.1 200 OK\r\n", "\r\n\r\nsecond");
    assert_true(http_asked(http, "live.js") < 10.0);
    assert_answer(port, "HEAD /live.js", "HTTP/1.1 200 OK\r\n", "\r\n\r\n");
    assert_answer(port, "GET /no.js", "HTTP/1.1 404 ", "no such page\n");
    assert_answer(port, "GET /../live.js", "HTTP/1.1 404 ", "no such page\n");
    assert_answer(port, "GET //etc/passwd", "HTTP/1.1 404 ", "no such page\n");
    assert_answer(port, "GET ?index.html", "HTTP/1.1 404 ", "no such page\n");
    assert_answer(port, "GET xindex.html", "HTTP/1.1 404 ", "no such page\n");
    assert_answer(port, "POST /live.js", "HTTP/1.1 405 ", "only to be read\n");
    assert_answer(port, "PUT /live.js", "HTTP/1.1 405 ", "only to be read\n");
    assert_answer(port, "DELETE /", "HTTP/1.1 405 ", "only to be read\n");
    http_close(http);
}

static void assert_host(int port, const char *host, const char *begin)
{
    char *request = text_format("GET / HTTP/1.1\r\nHost: %s\r\nConnection: close\r\n\r\n",
                                host);
    char *answer = ask(port, request);
    assert_memory_equal(answer, begin, strlen(begin));
    mem_free(request);
    mem_free(answer);
}

/* Whether anybody looks; and the end waits for a viewer no longer than it was told. */
static void test_watched(void **state)
{
    (void)state;
    static const char *const names[] = {"live.js", NULL};
    struct err err = {0};
    struct text text = {0};
    struct site *site = site_open("0", &err);
    assert_non_null(site);
    text_append(&text, "state");
    assert_true(site_publish(site, "live.js", "text/plain", &text, &err));
    assert_false(site_watched(site, "live.js", 1e9));
    double begin = clock_wall();
    site_linger(site, names, 0.1);
    assert_true(clock_wall() >= begin + 0.1 && clock_wall() < begin + 30.0);
    assert_answer(port_of(site_address(site)), "GET /live.js", "HTTP/1.1 200 OK\r\n",
                  "state");
    assert_true(site_watched(site, "live.js", 60.0));
    site_linger(site, names, 1e9); /* it has been sent */
    while (clock_wall() < begin + 0.2)
        ;
    assert_false(site_watched(site, "live.js", 1e-6));
    site_close(site);
}

/* At loopback other names are refused (DNS rebinding), elsewhere none is. */
static void test_hosts(void **state)
{
    (void)state;
    struct err err = {0};
    struct http *all = http_open("0.0.0.0:0", &err), *http = http_open("0", &err);
    static const char *const own[] = {"localhost", "LocalHost:80", "127.0.0.1:17",
                                      "[::1]:9"};
    static const char *const foreign[] = {"x", "localhost.example.com", "127.0.0.11",
                                          "example.com:80", "127.0.0.3"};
    int port = port_of(http_url(all));
    publish(all, "index.html", "page");
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        assert_host(port, own[i], "HTTP/1.1 200 ");
    for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++)
        assert_host(port, foreign[i], "HTTP/1.1 200 ");
    http_close(all);
    port = port_of(http_url(http));
    publish(http, "index.html", "page");
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        assert_host(port, own[i], "HTTP/1.1 200 ");
    for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++)
        assert_host(port, foreign[i], "HTTP/1.1 403 ");
    http_close(http);
}

/* Asked for is not yet sent; and a new version is not sent by the old one. */
static void test_sent(void **state)
{
    (void)state;
    static const char request[] = "GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n";
    struct err err = {0};
    struct http *http = http_open("0", &err);
    int port = port_of(http_url(http));
    struct text large = {mem_alloc(LARGE, 1), LARGE, LARGE};
    http_publish(http, "large", "text/plain", &large);
    assert_false(http_sent(http, "large"));
    assert_true(http_cpu(http) == 0.0);
    int fd = connect_to(port);
    assert_int_equal(send(fd, request, strlen(request), 0), strlen(request));
    for (int i = 0; i < 1000 && http_asked(http, "large") > 1e9; i++)
        usleep(10000);
    usleep(50000);
    assert_false(http_sent(http, "large"));
    char block[65536];
    for (size_t got = 0; got < LARGE;) {
        ssize_t n = read(fd, block, sizeof block);
        assert_true(n > 0);
        got += (size_t)n;
    }
    for (int i = 0; i < 1000 && !http_sent(http, "large"); i++)
        usleep(10000);
    assert_true(http_sent(http, "large"));
    assert_true(http_cpu(http) > 0.0 && http_cpu(http) < clock_cpu());
    publish(http, "large", "small");
    assert_false(http_sent(http, "large"));
    close(fd);
    http_close(http);
}

/* The escapes of printf's %b in place: \r \n \t \0 \\ \xHH. Returns the length. */
static size_t unescape(char *line)
{
    static const char names[] = "rnt0\\", values[] = "\r\n\t\0\\";
    char *to = line;
    for (const char *at = line; *at; at++) {
        unsigned code;
        const char *name = at[0] == '\\' && at[1] ? strchr(names, at[1]) : NULL;
        if (name) {
            *to++ = values[name - names];
            at++;
        } else if (sscanf(at, "\\x%2x", &code) == 1) {
            *to++ = (char)code;
            at += 3;
        } else {
            *to++ = *at;
        }
    }
    return (size_t)(to - line);
}

/* The status of the answer to a request; 0: the server hung up, or waits for the rest of
 * a request that is cut short. */
static int status_of(int port, const char *request, size_t size)
{
    struct timeval patience = {.tv_usec = 300000};
    char answer[13] = {0};
    int fd = connect_to(port), status = 0;
    ssize_t n = send(fd, request, size, MSG_NOSIGNAL);
    (void)n; /* it may have hung up already */
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    shutdown(fd, SHUT_WR);
    n = recv(fd, answer, 12, MSG_WAITALL);
    assert_true(n >= 0 || errno == ECONNRESET || errno == EAGAIN);
    close(fd);
    sscanf(answer, "HTTP/1.%*1d %3d", &status);
    return n == 12 ? status : 0;
}

static void test_malformed(void **state)
{
    (void)state;
    struct err err = {0};
    struct http *http = http_open("0", &err);
    int port = port_of(http_url(http)), requests = 0, refused = 0;
    publish(http, "index.html", "page");
    FILE *file = fopen("tests/data/http_requests.txt", "r");
    char *line = NULL;
    size_t capacity = 0;
    assert_non_null(file);
    for (ssize_t n; (n = getline(&line, &capacity, file)) > 0; requests++) {
        line[n - 1] = '\0';
        int status = status_of(port, line, unescape(line));
        assert_true(status == 0 || status == 100 || status == 200 ||
                    (status >= 400 && status <= 505));
        refused += status >= 400;
    }
    fclose(file);
    free(line);
    assert_int_equal(requests, 103);
    assert_true(refused >= 30);
    assert_answer(port, "GET /", "HTTP/1.1 200 OK\r\n", "\r\n\r\npage");
    http_close(http);
}

/* Half of the connections are held by viewers that never read; others are answered. */
static void test_never_reads(void **state)
{
    (void)state;
    static const char request[] = "GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n";
    struct err err = {0};
    struct http *http = http_open("127.0.0.1:0", &err);
    int port = port_of(http_url(http)), sockets[16];
    struct text large = {mem_alloc(LARGE, 1), LARGE, LARGE};
    http_publish(http, "large", "text/plain", &large);
    for (int i = 0; i < 16; i++) {
        sockets[i] = connect_to(port);
        assert_int_equal(send(sockets[i], request, strlen(request), 0), strlen(request));
    }
    publish(http, "live.js", "state");
    double begin = clock_wall();
    publish(http, "large", "small");
    assert_answer(port, "GET /live.js", "HTTP/1.1 200 OK\r\n", "\r\n\r\nstate");
    assert_answer(port, "GET /large", "HTTP/1.1 200 OK\r\n", "\r\n\r\nsmall");
    http_close(http);
    assert_true(clock_wall() - begin < 5.0);
    for (int i = 0; i < 16; i++)
        close(sockets[i]);
}

static void assert_refused(const char *where, const char *words)
{
    struct err err = {0};
    assert_null(site_open(where, &err));
    assert_non_null(strstr(err.message, words));
}

static void test_refusals(void **state)
{
    (void)state;
    struct err err = {0};
    struct http *http = http_open("0", &err);
    char *taken = text_format("%d", port_of(http_url(http)));
    assert_refused(taken, "in use; give another port");
    assert_refused("65536", "a number from 1 to 65535");
    assert_refused("no.such.host.invalid:8080", "no address of 'no.such.host.invalid'");
    assert_refused("192.0.2.1:8080", "cannot listen there"); /* TEST-NET-1 */
    assert_refused(":8080", "neither PORT nor HOST:PORT");
    assert_refused("localhost:http", "neither PORT nor HOST:PORT");
    assert_refused("/dev/null", "this is no folder");
    assert_refused("/no/such/folder", "cannot make this folder");
    mem_free(taken);
    http_close(http);
}

static void test_folder(void **state)
{
    (void)state;
    struct err err = {0};
    char *folder = text_format("%s/etalon-site-%ld",
                               getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp",
                               (long)getpid());
    struct site *site = site_open(folder, &err);
    struct text text = {0};
    size_t size;
    assert_non_null(site);
    text_append(&text, "%s", "state");
    assert_true(site_publish(site, "live.js", "text/javascript", &text, &err));
    char *path = text_format("%s/live.js", folder);
    char *content = text_read_file(path, &size, NULL, &err);
    assert_string_equal(content, "state");
    site_close(site);
    unlink(path);
    rmdir(folder);
    mem_free(content);
    mem_free(path);
    mem_free(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_serves),      cmocka_unit_test(test_malformed),
        cmocka_unit_test(test_never_reads), cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_folder),      cmocka_unit_test(test_hosts),
        cmocka_unit_test(test_sent),        cmocka_unit_test(test_watched),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
