#include "math/xform.h"

#include "math/warp.h"

#include <string.h>

struct xform xform_identity(void)
{
    return xform_scale(1.0, 1.0, 1.0);
}

struct xform xform_translate(double x, double y, double z)
{
    return (struct xform){
        .m = {{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}, {0, 0, 0, 1}},
        .inv = {{1, 0, 0, -x}, {0, 1, 0, -y}, {0, 0, 1, -z}, {0, 0, 0, 1}},
    };
}

struct xform xform_scale(double x, double y, double z)
{
    return (struct xform){
        .m = {{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}, {0, 0, 0, 1}},
        .inv = {{1.0 / x, 0, 0, 0}, {0, 1.0 / y, 0, 0}, {0, 0, 1.0 / z, 0}, {0, 0, 0, 1}},
    };
}

static bool normalize3(const double v[3], double out[3])
{
    double max = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(max > 0.0) || isinf(max))
        return false;
    double x = v[0] / max, y = v[1] / max, z = v[2] / max;
    double length = sqrt(x * x + y * y + z * z);
    out[0] = x / length;
    out[1] = y / length;
    out[2] = z / length;
    return isfinite(length);
}

static void cross3(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static struct xform from_rotation(const double r[3][3])
{
    struct xform x = {0};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            x.m[i][j] = r[i][j];
            x.inv[j][i] = r[i][j];
        }
    }
    x.m[3][3] = x.inv[3][3] = 1.0;
    return x;
}

struct xform xform_rotate(double degrees, double x, double y, double z)
{
    double a[3], rest = remainder(degrees, 360.0);
    if (!normalize3((const double[3]){x, y, z}, a))
        return xform_identity();
    struct vec2 turn = warp_circle((rest < 0.0 ? rest + 360.0 : rest) / 360.0);
    double c = turn.x, s = turn.y, k = 1.0 - c;
    return from_rotation((const double[3][3]){
        {c + a[0] * a[0] * k, a[0] * a[1] * k - a[2] * s, a[0] * a[2] * k + a[1] * s},
        {a[1] * a[0] * k + a[2] * s, c + a[1] * a[1] * k, a[1] * a[2] * k - a[0] * s},
        {a[2] * a[0] * k - a[1] * s, a[2] * a[1] * k + a[0] * s, c + a[2] * a[2] * k},
    });
}

bool xform_look_at(const double eye[3], const double target[3], const double up[3],
                   struct xform *camera_to_world)
{
    double forward[3], up_unit[3], right[3], above[3];
    double gaze[3] = {target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]};
    if (!normalize3(gaze, forward) || !normalize3(up, up_unit))
        return false;
    cross3(up_unit, forward, right);
    double sine = sqrt(right[0] * right[0] + right[1] * right[1] + right[2] * right[2]);
    if (!(sine > 1e-12) || !normalize3(right, right))
        return false;
    cross3(forward, right, above);
    struct xform rotation = from_rotation((const double[3][3]){
        {right[0], above[0], forward[0]},
        {right[1], above[1], forward[1]},
        {right[2], above[2], forward[2]},
    });
    struct xform move = xform_translate(eye[0], eye[1], eye[2]);
    *camera_to_world = xform_mul(&move, &rotation);
    return isfinite(eye[0] + eye[1] + eye[2]);
}

/* Inverse of the leading n x n block by Gauss-Jordan, pivots chosen and judged in
 * proportion to their row's largest element, so that a strong but regular scaling is no
 * singularity. False if singular. */
static bool invert_block(struct xform *x, int n)
{
    double a[4][8] = {{0}}, largest[4];
    for (int i = 0; i < n; i++) {
        largest[i] = 0.0;
        for (int j = 0; j < n; j++) {
            a[i][j] = x->m[i][j];
            largest[i] = fmax(largest[i], fabs(a[i][j]));
        }
        a[i][n + i] = 1.0;
        if (!(largest[i] > 0.0))
            return false;
    }
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i][k]) / largest[i] > fabs(a[pivot][k]) / largest[pivot])
                pivot = i;
        if (!(fabs(a[pivot][k]) > 1e-14 * largest[pivot]))
            return false;
        for (int j = 0; j < 2 * n; j++) {
            double swap = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = swap;
        }
        largest[pivot] = largest[k];
        double scale = a[k][k];
        for (int j = 0; j < 2 * n; j++)
            a[k][j] /= scale;
        for (int i = 0; i < n; i++) {
            double factor = i == k ? 0.0 : a[i][k];
            for (int j = 0; factor != 0.0 && j < 2 * n; j++)
                a[i][j] -= factor * a[k][j];
        }
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            x->inv[i][j] = a[i][n + j];
    return true;
}

static bool is_finite(const struct xform *x)
{
    bool finite = true;
    for (int i = 0; i < 16; i++)
        finite = finite && isfinite(x->m[i / 4][i % 4]) && isfinite(x->inv[i / 4][i % 4]);
    return finite;
}

/* An affine matrix is inverted without its translation, so that a large translation costs
 * no accuracy. */
static bool invert(struct xform *x)
{
    double(*m)[4] = x->m, (*inv)[4] = x->inv;
    bool affine = m[3][0] == 0.0 && m[3][1] == 0.0 && m[3][2] == 0.0 && m[3][3] != 0.0;
    if (!affine)
        return invert_block(x, 4) && is_finite(x);
    for (int i = 0; m[3][3] != 1.0 && i < 12; i++)
        m[i / 4][i % 4] /= m[3][3];
    m[3][3] = inv[3][3] = 1.0;
    if (!invert_block(x, 3))
        return false;
    for (int i = 0; i < 3; i++)
        inv[i][3] = -(inv[i][0] * m[0][3] + inv[i][1] * m[1][3] + inv[i][2] * m[2][3]);
    return is_finite(x);
}

bool xform_from_matrix(const double m[16], struct xform *out)
{
    struct xform x = {0};
    memcpy(x.m, m, sizeof x.m);
    if (!is_finite(&x) || !invert(&x))
        return false;
    *out = x;
    return true;
}

static void mul(const double a[4][4], const double b[4][4], double out[4][4])
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] +
                        a[i][3] * b[3][j];
}

struct xform xform_mul(const struct xform *a, const struct xform *b)
{
    struct xform x;
    mul(a->m, b->m, x.m);
    mul(b->inv, a->inv, x.inv);
    /* cppcheck-suppress uninitvar; the loops fill it */
    return x;
}

struct xform xform_inverse(const struct xform *a)
{
    struct xform x;
    memcpy(x.m, a->inv, sizeof x.m);
    memcpy(x.inv, a->m, sizeof x.inv);
    return x;
}

struct vec3 xform_point(const struct xform *a, struct vec3 p)
{
    double in[4] = {(double)p.x, (double)p.y, (double)p.z, 1.0}, out[4];
    for (int i = 0; i < 4; i++)
        out[i] = a->m[i][0] * in[0] + a->m[i][1] * in[1] + a->m[i][2] * in[2] +
                 a->m[i][3];
    double w = out[3];
    return vec3((float)(out[0] / w), (float)(out[1] / w), (float)(out[2] / w));
}

struct vec3 xform_vector(const struct xform *a, struct vec3 v)
{
    double in[3] = {(double)v.x, (double)v.y, (double)v.z}, out[3];
    for (int i = 0; i < 3; i++)
        out[i] = a->m[i][0] * in[0] + a->m[i][1] * in[1] + a->m[i][2] * in[2];
    return vec3((float)out[0], (float)out[1], (float)out[2]);
}

struct vec3 xform_normal(const struct xform *a, struct vec3 n)
{
    double in[3] = {(double)n.x, (double)n.y, (double)n.z}, out[3];
    for (int i = 0; i < 3; i++)
        out[i] = a->inv[0][i] * in[0] + a->inv[1][i] * in[1] + a->inv[2][i] * in[2];
    return vec3((float)out[0], (float)out[1], (float)out[2]);
}

static double determinant(const double m[4][4])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

bool xform_is_affine(const struct xform *a)
{
    double sum = 0.0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            sum += fabs(a->m[i][j]) + fabs(a->inv[i][j]);
    return isfinite(sum) && a->m[3][0] == 0.0 && a->m[3][1] == 0.0 && a->m[3][2] == 0.0 &&
           a->m[3][3] == 1.0;
}

bool xform_swaps_handedness(const struct xform *a)
{
    return determinant(a->m) < 0.0;
}

bool xform_is_similarity(const struct xform *a, double *scale)
{
    const double(*m)[4] = a->m;
    if (m[3][0] != 0.0 || m[3][1] != 0.0 || m[3][2] != 0.0 || m[3][3] != 1.0)
        return false;
    /* By squares, not by the determinant: cbrt is not exact for powers of two, and a
     * scene that is scaled by two must give exactly the same paths. */
    double squares = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            squares += m[i][j] * m[i][j];
    double factor = sqrt(squares / 3.0);
    for (int i = 0; i < 3; i++) {
        for (int j = i; j < 3; j++) {
            double dot = 0.0;
            for (int k = 0; k < 3; k++)
                dot += (m[k][i] / factor) * (m[k][j] / factor);
            if (!(fabs(dot - (i == j)) <= 1e-4))
                return false;
        }
    }
    *scale = factor;
    return true;
}

bool xform_is_stretch(const struct xform *a, double scale[3])
{
    struct xform even = *a;
    double one;
    for (int j = 0; j < 3; j++) {
        const double(*m)[4] = a->m;
        scale[j] = sqrt(m[0][j] * m[0][j] + m[1][j] * m[1][j] + m[2][j] * m[2][j]);
        for (int i = 0; i < 3; i++)
            even.m[i][j] /= scale[j];
    }
    return xform_is_similarity(&even, &one);
}
