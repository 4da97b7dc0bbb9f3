#ifndef ETALON_LIVE_ADDRESS_H
#define ETALON_LIVE_ADDRESS_H

/* HOST:PORT of the command line, as the addresses of sockets. */

#include "base/err.h"

#include <netdb.h>
#include <stdbool.h>

/* option: its name in messages. "127.0.0.1:80", "[::1]:80", "name:80"; with a
 * default `host` (to listen at; else NULL) "80" is a port of that, and port 0 stands for
 * any that is free. The result is released with freeaddrinfo; NULL after an error. */
struct addrinfo *address_find(const char *option, const char *text, const char *host,
                              struct err *err);

#endif
