#ifndef ETALON_LIVE_TEV_LINK_H
#define ETALON_LIVE_TEV_LINK_H

/* The connection to a viewer that speaks tev's protocol (live/tev.h), on a thread of its
 * own. A viewer that is absent is looked for every few seconds; one that goes away, or
 * takes no byte for some seconds, is dropped, and looked for again. */

#include "base/err.h"
#include "image/image.h"

#include <stdbool.h>

struct tev_link;

/* address: HOST:PORT. name: of the picture in the viewer. Fails if the host has no
 * address, not if nobody listens there. */
struct tev_link *tev_link_open(const char *address, const char *name, struct err *err);
/* The viewer is there, and has taken the last picture. */
bool tev_link_ready(struct tev_link *link);
/* Sends a copy of the picture, in the place of one that waits. */
void tev_link_send(struct tev_link *link, const struct image *image);
double tev_link_cpu(struct tev_link *link); /* CPU time so far, in s */
/* Sends what waits, if the viewer takes it within seconds, and disconnects. Returns the
 * number of pictures that were sent whole. */
long tev_link_close(struct tev_link *link);

#endif
