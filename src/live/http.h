#ifndef ETALON_LIVE_HTTP_H
#define ETALON_LIVE_HTTP_H

/* A server of a few documents that change (the only user of libmicrohttpd), on a thread
 * of its own. It answers GET and HEAD, knows no other file, and takes nothing in. At an
 * address of loopback it answers 403 to requests whose Host is neither this nor
 * localhost, 127.0.0.1 or [::1].
 *
 * A viewer that reads slowly keeps the version of the document that it is being sent. So
 * at most 32 versions are in memory, as many as there may be connections, and one that
 * reads nothing for 15 s is closed. */

#include "base/text.h"

#include <stdbool.h>

struct http;

/* address: PORT, of 127.0.0.1, or HOST:PORT. Fails if the port is in use. */
struct http *http_open(const char *address, struct err *err);
/* "http://127.0.0.1:8080/" */
const char *http_url(const struct http *http);
/* Publishes a document in the place of the one of that name, and takes its text. name: a
 * string that stays, for example "index.html", which is "/" too. type: of its content. */
void http_publish(struct http *http, const char *name, const char *type,
                  struct text *text);
/* Seconds since the document of that name was last asked for; INFINITY: never. */
double http_asked(struct http *http, const char *name);
/* A viewer has been sent the document as it was last published, whole. */
bool http_sent(struct http *http, const char *name);
/* CPU time of the server's thread up to the last request that ended, s. */
double http_cpu(struct http *http);
void http_close(struct http *http);

#endif
