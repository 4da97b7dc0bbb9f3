/* Curves as meshes: tubes, and ribbons where normals say how they lie. */
#include "import/pbrt/pbrt_shape.h"

#include "base/text.h"
#include "import/suggest.h"
#include "math/warp.h"

#include <math.h>
#include <string.h>

#define STEPS         8 /* of each cubic */
#define SIDES         6 /* of a tube */
#define VERTICES_MOST ((size_t)1 << 27)

struct curve {
    const double *points;  /* [..][3] */
    const double *normals; /* [segments + 1][3] of a ribbon, or NULL */
    size_t segments;
    int degree;
    bool spline; /* B-spline, else Bezier */
    double width[2];
};

/* The segment's four Bezier points. */
static void control_points(const struct curve *c, size_t segment, double out[4][3])
{
    size_t first = c->spline ? segment : segment * (size_t)c->degree;
    for (int k = 0; k < 3; k++) {
        double p[4], b[4];
        for (int i = 0; i <= c->degree; i++)
            p[i] = c->points[3 * (first + (size_t)i) + (size_t)k];
        if (c->degree == 2) {
            double q[3] = {c->spline ? 0.5 * (p[0] + p[1]) : p[0], p[1],
                           c->spline ? 0.5 * (p[1] + p[2]) : p[2]};
            b[0] = q[0];
            b[1] = (q[0] + 2.0 * q[1]) / 3.0;
            b[2] = (2.0 * q[1] + q[2]) / 3.0;
            b[3] = q[2];
        } else if (c->spline) {
            b[0] = (p[0] + 4.0 * p[1] + p[2]) / 6.0;
            b[1] = (2.0 * p[1] + p[2]) / 3.0;
            b[2] = (p[1] + 2.0 * p[2]) / 3.0;
            b[3] = (p[1] + 4.0 * p[2] + p[3]) / 6.0;
        } else {
            memcpy(b, p, sizeof b);
        }
        for (int i = 0; i < 4; i++)
            out[i][k] = b[i];
    }
}

/* Point and direction at t of a cubic. */
static void cubic(double b[4][3], double t, double point[3], double along[3])
{
    double s = 1.0 - t;
    for (int k = 0; k < 3; k++) {
        point[k] = s * s * s * b[0][k] + 3.0 * s * s * t * b[1][k] +
                   3.0 * s * t * t * b[2][k] + t * t * t * b[3][k];
        along[k] = s * s * (b[1][k] - b[0][k]) + 2.0 * s * t * (b[2][k] - b[1][k]) +
                   t * t * (b[3][k] - b[2][k]);
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* a less its part along t, of length 1; or any direction across t. */
static void set_across(double a[3], const double t[3])
{
    double part = dot(a, t), length;
    for (int i = 0; i < 3; i++)
        a[i] -= part * t[i];
    length = sqrt(dot(a, a));
    if (!(length > 1e-6)) {
        const double axis[3] = {fabs(t[0]) < 0.6, fabs(t[0]) >= 0.6, 0.0};
        cross(axis, t, a);
        length = sqrt(dot(a, a));
    }
    for (int i = 0; i < 3; i++)
        a[i] /= length;
}

/* One cross-section at a time; `across` is carried along, so that a tube does not twist.
 */
struct frame3 {
    double t[3], across[3];
};

static void move_frame(struct frame3 *f, const double along[3])
{
    double length = sqrt(dot(along, along));
    for (int i = 0; length > 0.0 && i < 3; i++)
        f->t[i] = along[i] / length;
    set_across(f->across, f->t);
}

static void add_vertex(struct mesh *mesh, const double p[3], const double n[3], double u,
                       double v)
{
    size_t i = mesh->vertex_count++;
    for (size_t k = 0; k < 3; k++) {
        mesh->p[3 * i + k] = (float)p[k];
        mesh->n[3 * i + k] = (float)n[k];
    }
    mesh->uv[2 * i] = (float)u;
    mesh->uv[2 * i + 1] = (float)v;
}

static void add_section(struct mesh *mesh, const struct curve *c, struct frame3 *f,
                        const double p[3], double u)
{
    double radius = 0.5 * ((1.0 - u) * c->width[0] + u * c->width[1]), b[3], n[3], at[3];
    if (c->normals) { /* a ribbon, whose normal is t x across */
        size_t s = (size_t)fmin(u * (double)c->segments, (double)c->segments - 1.0);
        double x = u * (double)c->segments - (double)s;
        for (size_t k = 0; k < 3; k++)
            n[k] = (1.0 - x) * c->normals[3 * s + k] + x * c->normals[3 * s + 3 + k];
        cross(n, f->t, f->across);
        set_across(f->across, f->t);
    }
    cross(f->t, f->across, b);
    int corners = c->normals ? 2 : SIDES + 1;
    for (int j = 0; j < corners; j++) {
        double v = (double)j / (corners - 1), phi = j == SIDES ? 0.0 : 2.0 * MATH_PI * v;
        for (int k = 0; k < 3; k++) {
            double out = c->normals ? (1.0 - 2.0 * v) * f->across[k]
                                    : cos(phi) * f->across[k] + sin(phi) * b[k];
            at[k] = p[k] + radius * out;
            n[k] = c->normals ? b[k] : out;
        }
        add_vertex(mesh, at, n, u, v);
    }
}

static struct mesh *sweep(const struct curve *c)
{
    uint32_t cells = c->normals ? 1 : SIDES;
    size_t sections = c->segments * STEPS + 1;
    if (sections * (cells + 1) > VERTICES_MOST)
        return NULL;
    struct mesh *mesh = mesh_create((uint32_t)sections * (cells + 1),
                                    2 * (uint32_t)(sections - 1) * cells, true, true);
    struct frame3 frame = {{0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}};
    mesh->vertex_count = mesh->triangle_count = 0;
    for (size_t i = 0; i < sections; i++) {
        size_t segment = i < sections - 1 ? i / STEPS : c->segments - 1;
        double b[4][3], point[3], along[3];
        control_points(c, segment, b);
        cubic(b, (double)(i - segment * STEPS) / STEPS, point, along);
        move_frame(&frame, along);
        if (i > 0)
            pbrt_shape_add_cells(mesh, mesh->vertex_count - cells - 1, cells, 1);
        add_section(mesh, c, &frame, point, (double)i / (double)(sections - 1));
    }
    return mesh;
}

static bool read_word(struct pbrt *p, const char *name, const char *const *known,
                      const char **word, struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, name, PBRT_STRING);
    if (param)
        *word = pbrt_params_text(&p->params, param);
    for (int i = 0; known[i]; i++)
        if (text_equal(*word, known[i]))
            return true;
    return suggest_fail(err, &param->place, name, *word, known);
}

/* How many segments the points make; 0 if they make none. */
static size_t segments_of(const struct curve *c, size_t points)
{
    size_t degree = (size_t)c->degree;
    if (points <= degree)
        return 0;
    return c->spline               ? points - degree
           : (points - 1) % degree ? 0
                                   : (points - 1) / degree;
}

static bool read_shape(struct pbrt *p, struct curve *c, bool *ribbon, struct err *err)
{
    static const char *const types[] = {"flat", "ribbon", "cylinder", NULL};
    static const char *const bases[] = {"bezier", "bspline", NULL};
    const char *type = types[0], *basis = bases[0];
    double width = 1.0;
    c->degree = 3;
    if (!read_word(p, "type", types, &type, err) ||
        !read_word(p, "basis", bases, &basis, err) ||
        !pbrt_params_int(&p->params, "degree", &c->degree, err) ||
        !pbrt_params_float(&p->params, "width", &width, err))
        return false;
    c->width[0] = c->width[1] = width;
    c->spline = text_equal(basis, "bspline");
    *ribbon = text_equal(type, "ribbon");
    if (!pbrt_params_float(&p->params, "width0", &c->width[0], err) ||
        !pbrt_params_float(&p->params, "width1", &c->width[1], err))
        return false;
    return (c->degree == 2 || c->degree == 3) ||
           err_set(err, ERR_VALUE, &p->params.place, "the degree of a curve is 2 or 3");
}

bool pbrt_curve(struct pbrt *p, struct err *err)
{
    static const char *const ignored[] = {"splitdepth", NULL};
    const struct pbrt_param *points = pbrt_params_find(&p->params, "P", PBRT_POINT);
    const struct pbrt_param *normals = pbrt_params_find(&p->params, "N", PBRT_NORMAL);
    struct curve c = {0};
    bool ribbon;
    pbrt_params_ignore(&p->params, ignored);
    if (!read_shape(p, &c, &ribbon, err))
        return false;
    c.segments = points ? segments_of(&c, points->count / 3) : 0;
    if (c.segments == 0)
        return err_set(
            err, ERR_VALUE, &p->params.place,
            "Shape \"curve\" wants \"point3 P\": of a Bezier curve degree x n + "
            "1 points, of a B-spline degree + n");
    if (ribbon && normals && !pbrt_shape_count_is(normals, 3 * (c.segments + 1), err))
        return false;
    c.points = pbrt_params_numbers(&p->params, points);
    c.normals = ribbon && normals ? pbrt_params_numbers(&p->params, normals) : NULL;
    struct mesh *mesh = sweep(&c);
    if (!mesh)
        return err_set(err, ERR_VALUE, &points->place, "the curve is too long");
    log_note(
        &p->desc->log, &p->params.place,
        "curves are taken as meshes: ribbons, and tubes of %d sides, of %d steps for "
        "each cubic",
        SIDES, STEPS);
    return pbrt_shape_add_mesh(p, mesh, err);
}
