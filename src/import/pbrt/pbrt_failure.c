#include "import/pbrt/pbrt_failure.h"

#include "base/text.h"

static void mark_files_names(struct pbrt *p)
{
    p->materials.incomplete = p->textures.incomplete = true;
    p->systems.incomplete = p->objects.incomplete = true;
    p->uncertain = true;
}

void pbrt_failure_mark(struct pbrt *p, const char *directive)
{
    if (!directive) {
        p->uncertain = true;
        return;
    }
    if (text_equal(directive, "Include") || text_equal(directive, "Import"))
        mark_files_names(p);
    if (text_equal(directive, "Camera"))
        pbrt_names_add(&p->systems, "camera")->unread = true;
    struct pbrt_names *names = text_equal(directive, "MakeNamedMaterial") ? &p->materials
                               : text_equal(directive, "Texture")         ? &p->textures
                                                                          : NULL;
    if (names && p->params.char_count > 0) /* else its name is in error */
        pbrt_names_add(names, pbrt_params_head(&p->params, 0))->unread = true;
}

bool pbrt_failure_tell(struct pbrt *p, const struct err *failure)
{
    bool grammar = failure->code == ERR_SYNTAX;
    bool follows = failure->code == ERR_NONE || (grammar && p->uncertain);
    if (p->stopped) /* within an imported file: told already */
        return false;
    p->failed = true;
    p->stopped = (!follows && !import_failure_add(p->options, failure, p->first_error)) ||
                 grammar || p->world_done;
    return !p->stopped;
}

bool pbrt_failure_stop(struct pbrt *p, const struct err *failure)
{
    pbrt_failure_tell(p, failure);
    p->stopped = true;
    return false;
}
