#ifndef ETALON_BASE_JSON_H
#define ETALON_BASE_JSON_H

/* Writes JSON (RFC 8259), indented, piece by piece. `key` is NULL within a list. Zero-
 * initialise; release text.data with mem_free. */

#include "base/text.h"

struct json {
    struct text text;
    int depth;
    bool follows; /* another value stands before, on this level */
};

/* bracket: '{' or '['. */
void json_open(struct json *json, const char *key, char bracket);
void json_close(struct json *json, char bracket);
/* Invalid UTF-8 becomes U+FFFD; NULL is written as null. */
void json_text(struct json *json, const char *key, const char *value);
void json_number(struct json *json, const char *key,
                 double value); /* null if not finite */
void json_count(struct json *json, const char *key, long value);
void json_flag(struct json *json, const char *key, bool value);

#endif
