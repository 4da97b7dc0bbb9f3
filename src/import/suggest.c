#include "import/suggest.h"

#include "base/mem.h"
#include "base/text.h"

bool suggest_fail(struct err *err, const struct place *at, const char *what,
                  const char *name, const char *const *known)
{
    struct text list = {0};
    for (int i = 0; known[i]; i++)
        text_append(&list, "%s%s", i ? ", " : "", known[i]);
    const char *nearest = text_nearest(name, known);
    const char *all = list.data ? list.data : "none";
    if (nearest)
        err_set(err, ERR_VALUE, at, "unknown %s \"%s\"; did you mean \"%s\"? (known: %s)",
                what, name, nearest, all);
    else
        err_set(err, ERR_VALUE, at, "unknown %s \"%s\" (known: %s)", what, name, all);
    mem_free(list.data);
    return false;
}
