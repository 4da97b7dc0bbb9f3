#include "import/import.h"

#include "base/text.h"

static bool is_same(const struct err *a, const struct err *b)
{
    return a->line == b->line && a->col == b->col && text_equal(a->file, b->file) &&
           text_equal(a->message, b->message);
}

bool import_failure_add(const struct import_options *options, const struct err *failure,
                        struct err *err)
{
    struct import_failure *all = options ? options->failure : NULL;
    if (err->code == ERR_NONE)
        *err = *failure;
    for (int i = 0; all && i < all->error_count; i++)
        if (is_same(&all->errors[i], failure))
            return true;
    if (all && all->error_count < IMPORT_ERRORS_MAX)
        all->errors[all->error_count++] = *failure;
    return all && all->error_count < IMPORT_ERRORS_MAX;
}

struct scene_desc *import_failure_give_up(const struct import_options *options,
                                          struct scene_desc *desc)
{
    if (options && options->failure)
        log_merge(&options->failure->log, &desc->log);
    scene_desc_destroy(desc);
    return NULL;
}

void import_failure_deinit(struct import_failure *failure)
{
    log_deinit(&failure->log);
}
