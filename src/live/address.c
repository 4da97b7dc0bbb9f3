#include "live/address.h"

#include "base/mem.h"
#include "base/text.h"

#include <string.h>
#include <sys/socket.h>

/* The host without the brackets of an IPv6 address, owned by the caller. */
static char *host_of(const char *text, const char *colon)
{
    size_t length = (size_t)(colon - text);
    bool bracketed = length > 2 && text[0] == '[' && colon[-1] == ']';
    return bracketed ? text_copy_n(text + 1, length - 2) : text_copy_n(text, length);
}

static struct addrinfo *resolve(const char *option, const char *text, const char *host,
                                const char *port, struct err *err)
{
    struct addrinfo hints = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM};
    struct addrinfo *found = NULL;
    int status = getaddrinfo(host, port, &hints, &found);
    if (status == 0)
        return found;
    err_set(err, ERR_VALUE, NULL, "%s '%s': no address of '%s': %s", option, text, host,
            gai_strerror(status));
    return NULL;
}

struct addrinfo *address_find(const char *option, const char *text, const char *host,
                              struct err *err)
{
    const char *colon = strrchr(text, ':');
    const char *port = colon ? colon + 1 : text;
    long number;
    if ((colon == NULL && host == NULL) || colon == text) {
        err_set(err, ERR_USAGE, NULL, "%s '%s': give HOST:PORT", option, text);
        return NULL;
    }
    if (!text_to_long(port, &number) || number < (host ? 0 : 1) || number > 65535) {
        err_set(err, ERR_USAGE, NULL, "%s '%s': a port is a number from 1 to 65535",
                option, text);
        return NULL;
    }
    char *named = colon ? host_of(text, colon) : text_copy(host);
    struct addrinfo *found = resolve(option, text, named, port, err);
    mem_free(named);
    return found;
}
