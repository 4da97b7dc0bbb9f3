#ifndef ETALON_LIVE_SITE_H
#define ETALON_LIVE_SITE_H

/* Where the documents of a page stand while a run goes: in a folder, as files that are
 * whole at any time, or at a port of this machine. */

#include "base/text.h"

#include <stdbool.h>

struct site;

/* where: PORT or HOST:PORT, served from there (live/http.h), at 127.0.0.1 unless a host
 * is given; anything else is the path of a folder, which is made. Fails if the port is in
 * use, if the folder cannot be written to, or if a name has a colon and no slash. */
struct site *site_open(const char *where, struct err *err);
/* Where a browser finds it: a URL, or the path of a file. */
const char *site_address(const struct site *site);
/* A string that stays, and the document's type, for example "text/html". Takes the text.
 * Files: false if it cannot be written. */
bool site_publish(struct site *site, const char *name, const char *type,
                  struct text *text, struct err *err);
/* The document was asked for in the last `seconds`. Files: true, as nobody knows. */
bool site_watched(struct site *site, const char *name, double seconds);
/* Waits until a viewer has been sent these documents (NULL-terminated) whole, as they
 * were last published, at most `seconds`. Files need no waiting. */
void site_linger(struct site *site, const char *const *names, double seconds);
/* CPU time that serving took, s; of files 0. */
double site_cpu(struct site *site);
void site_close(struct site *site);

#endif
