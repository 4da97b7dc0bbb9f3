#include "import/pbrt/pbrt_scene.h"

static bool fail(const struct pbrt *p, const char *message, struct err *err)
{
    return err_set(err, ERR_VALUE, &p->params.place, "%s", message);
}

bool pbrt_transform_identity(struct pbrt *p, struct err *err)
{
    (void)err;
    p->state.ctm = xform_identity();
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
    if (v[0] == 0.0 || v[1] == 0.0 || v[2] == 0.0)
        return fail(p, "a Scale by 0 has no inverse", err);
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

/* pbrt lists the columns one after the other. */
static bool read_matrix(struct pbrt *p, struct xform *x, struct err *err)
{
    double v[16], m[16];
    if (!pbrt_params_read_numbers(&p->lexer, 16, v, err))
        return false;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            m[4 * i + j] = v[4 * j + i];
    if (!xform_from_matrix(m, x))
        return fail(p, "the matrix has no inverse", err);
    return true;
}

bool pbrt_transform_set(struct pbrt *p, struct err *err)
{
    return read_matrix(p, &p->state.ctm, err);
}

bool pbrt_transform_concat(struct pbrt *p, struct err *err)
{
    struct xform x;
    if (!read_matrix(p, &x, err))
        return false;
    pbrt_state_concat(p, &x);
    return true;
}
