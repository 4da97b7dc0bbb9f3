#include "import/suggest.h"

#include "base/mem.h"
#include "base/text.h"

#define LIST_LENGTH 400 /* of a message of 512 */

bool suggest_fail(struct err *err, const struct place *at, const char *what,
                  const char *name, const char *const *known)
{
    const char *nearest = text_nearest(name, known);
    if (nearest)
        return err_set(err, ERR_VALUE, at, "unknown %s \"%s\"; did you mean \"%s\"?",
                       what, name, nearest);
    struct text list = {0};
    int i = 0;
    for (; known[i] && list.length < LIST_LENGTH; i++)
        text_append(&list, "%s%s", i ? ", " : "", known[i]);
    err_set(err, ERR_VALUE, at, "unknown %s \"%s\" (known: %s%s)", what, name,
            list.data ? list.data : "none", known[i] ? ", ..." : "");
    mem_free(list.data);
    return false;
}
