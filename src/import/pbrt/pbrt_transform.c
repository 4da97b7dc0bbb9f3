#include "import/pbrt/pbrt_scene.h"

#include "base/text.h"

static bool fail(const struct pbrt *p, const char *message, struct err *err)
{
    return err_set(err, ERR_VALUE, &p->params.place, "%s", message);
}

/* Not an error until something stands under it: exporters write such matrices for what
 * they have hidden. */
static void mark_singular(struct pbrt *p)
{
    if (pbrt_state_moves(p))
        p->state.singular = p->params.place;
}

bool pbrt_transform_identity(struct pbrt *p, struct err *err)
{
    (void)err;
    struct xform identity = xform_identity();
    pbrt_state_set(p, &identity);
    return true;
}

bool pbrt_transform_translate(struct pbrt *p, struct err *err)
{
    double v[3];
    if (!pbrt_params_read_numbers(&p->lexer, 3, v, err))
        return false;
    struct xform x = xform_translate(v[0], v[1], v[2]);
    pbrt_state_concat(p, &x);
    return true;
}

bool pbrt_transform_scale(struct pbrt *p, struct err *err)
{
    double v[3];
    if (!pbrt_params_read_numbers(&p->lexer, 3, v, err))
        return false;
    if (v[0] == 0.0 || v[1] == 0.0 || v[2] == 0.0) {
        mark_singular(p);
        return true;
    }
    struct xform x = xform_scale(v[0], v[1], v[2]);
    pbrt_state_concat(p, &x);
    return true;
}

bool pbrt_transform_rotate(struct pbrt *p, struct err *err)
{
    double v[4];
    if (!pbrt_params_read_numbers(&p->lexer, 4, v, err))
        return false;
    if (v[1] == 0.0 && v[2] == 0.0 && v[3] == 0.0)
        return fail(p, "Rotate wants an axis that is not zero", err);
    struct xform x = xform_rotate(v[0], v[1], v[2], v[3]);
    pbrt_state_concat(p, &x);
    return true;
}

bool pbrt_transform_look_at(struct pbrt *p, struct err *err)
{
    double v[9];
    struct xform camera;
    if (!pbrt_params_read_numbers(&p->lexer, 9, v, err))
        return false;
    if (!xform_look_at(v, v + 3, v + 6, &camera))
        return fail(p, "LookAt: eye and target coincide, or up points along the view",
                    err);
    struct xform x = xform_inverse(&camera);
    pbrt_state_concat(p, &x);
    return true;
}

/* pbrt lists the columns one after the other. *usable: it has an inverse. */
static bool read_matrix(struct pbrt *p, struct xform *x, bool *usable, struct err *err)
{
    double v[16], m[16];
    if (!pbrt_params_read_numbers(&p->lexer, 16, v, err))
        return false;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            m[4 * i + j] = v[4 * j + i];
    *usable = xform_from_matrix(m, x);
    return true;
}

bool pbrt_transform_set(struct pbrt *p, struct err *err)
{
    struct xform x;
    bool usable;
    if (!read_matrix(p, &x, &usable, err))
        return false;
    if (usable)
        pbrt_state_set(p, &x);
    else
        mark_singular(p);
    return true;
}

bool pbrt_transform_concat(struct pbrt *p, struct err *err)
{
    struct xform x;
    bool usable;
    if (!read_matrix(p, &x, &usable, err))
        return false;
    if (usable)
        pbrt_state_concat(p, &x);
    else
        mark_singular(p);
    return true;
}

bool pbrt_transform_name(struct pbrt *p, struct err *err)
{
    if (!pbrt_state_check(p, err))
        return false;
    pbrt_names_add(&p->systems, pbrt_params_head(&p->params, 0))->ctm = p->state.ctm;
    return true;
}

bool pbrt_transform_to_named(struct pbrt *p, struct err *err)
{
    const struct pbrt_named *found = pbrt_names_find(&p->systems, "coordinate system",
                                                     pbrt_params_head(&p->params, 0),
                                                     &p->params.head_places[0], err);
    if (!found)
        return false;
    p->state.ctm = found->ctm;
    p->state.singular = (struct place){0};
    return true;
}

bool pbrt_transform_active(struct pbrt *p, struct err *err)
{
    static const char *const known[] = {"StartTime", "EndTime", "All", NULL};
    static const unsigned active[] = {PBRT_START_TIME, PBRT_END_TIME, PBRT_ALL_TIMES};
    struct pbrt_token token;
    if (!pbrt_lexer_next(&p->lexer, &token, err))
        return false;
    for (int i = 0; token.kind == PBRT_TOKEN_WORD && known[i]; i++)
        if (text_equal(token.text, known[i])) {
            p->state.active = active[i];
            return true;
        }
    char text[80];
    pbrt_token_describe(&token, text, sizeof text);
    return err_set(err, ERR_SYNTAX, &token.place,
                   "expected StartTime, EndTime or All, got %s", text);
}

/* When the transforms of StartTime and EndTime hold; the start is all that is used. */
bool pbrt_transform_times(struct pbrt *p, struct err *err)
{
    double times[2];
    return pbrt_params_read_numbers(&p->lexer, 2, times, err);
}
