#ifndef ETALON_LIVE_HTTP_H
#define ETALON_LIVE_HTTP_H

/* A server of a few documents that change (the only user of libmicrohttpd), on a thread
 * of its own. It answers GET and HEAD, knows no other file, and takes nothing in. */

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
void http_close(struct http *http);

#endif
