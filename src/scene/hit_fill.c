#include "scene/hit_fill.h"

/* Frame about n with s along dpdu, or any if dpdu is (nearly) parallel to n. */
static struct frame aligned_frame(struct vec3 n, struct vec3 dpdu)
{
    struct vec3 s = vec3_mad(dpdu, -vec3_dot(n, dpdu), n);
    float squared = vec3_dot(s, s);
    if (!(squared > 1e-10f * vec3_dot(dpdu, dpdu)) || !isfinite(squared))
        return frame_from_normal(n);
    s = vec3_scale(s, 1.0f / sqrtf(squared));
    return (struct frame){s, vec3_cross(n, s), n};
}

/* dp/du and dp/dv, both times a positive number in *scale (u and v may be the same
 * everywhere). Meshes without parameters take the corners (0,0), (1,0), (1,1). */
static void mesh_tangents(const struct triangle *t, struct vec3 *dpdu, struct vec3 *dpdv,
                          float *scale)
{
    if (!t->uv) {
        *dpdu = t->e1;
        *dpdv = vec3_sub(t->e2, t->e1);
        *scale = 1.0f;
        return;
    }
    const float *a = t->uv + 2 * (size_t)t->i0, *b = t->uv + 2 * (size_t)t->i1,
                *c = t->uv + 2 * (size_t)t->i2;
    float du1 = b[0] - a[0], dv1 = b[1] - a[1], du2 = c[0] - a[0], dv2 = c[1] - a[1];
    float determinant = du1 * dv2 - dv1 * du2, sign = determinant < 0.0f ? -1.0f : 1.0f;
    *dpdu = vec3_scale(vec3_mad(vec3_scale(t->e1, dv2), -dv1, t->e2), sign);
    *dpdv = vec3_scale(vec3_mad(vec3_scale(t->e2, du1), -du2, t->e1), sign);
    *scale = fabsf(determinant);
}

static struct vec3 mesh_dpdu(const struct triangle *t)
{
    struct vec3 dpdu, dpdv;
    float scale;
    mesh_tangents(t, &dpdu, &dpdv, &scale);
    return dpdu;
}

/* Meshes without parameters take the corners (0,0), (1,0), (1,1), as pbrt does. */
static void mesh_uv(const struct triangle *t, float b1, float b2, struct hit *hit)
{
    if (!t->uv) {
        hit->u = b1 + b2;
        hit->v = b2;
        return;
    }
    const float *a = t->uv + 2 * (size_t)t->i0, *b = t->uv + 2 * (size_t)t->i1,
                *c = t->uv + 2 * (size_t)t->i2;
    float b0 = 1.0f - b1 - b2;
    hit->u = b0 * a[0] + b1 * b[0] + b2 * c[0];
    hit->v = b0 * a[1] + b1 * b[1] + b2 * c[1];
}

/* Step in u and v of the finite differences of a bump map: half a texel of a thousand. */
#define BUMP_STEP 0.0005

static double bump_height(const struct shape *shape, const struct texture_point *at)
{
    return rgb_luminance(texture_eval(shape->bsdf->relief.texture, at));
}

/* The point a step on in the parameter whose dp/d. is `along`, over `scale`. */
static struct texture_point bump_step(const struct texture_point *at, double du,
                                      double dv, struct vec3 along, float scale)
{
    double step = scale > 0.0f ? BUMP_STEP / (double)scale : 0.0;
    return (struct texture_point){.u = at->u + du,
                                  .v = at->v + dv,
                                  .p = {at->p[0] + step * (double)along.x,
                                        at->p[1] + step * (double)along.y,
                                        at->p[2] + step * (double)along.z}};
}

/* The shading normal of the surface p + height n, to first order [Pharr16, section 9.3],
 * and its *tangent; false where the parameters have no derivatives. */
static bool bumped_normal(const struct shape *shape, const struct triangle *t,
                          const struct hit *hit, struct vec3 *normal,
                          struct vec3 *tangent)
{
    struct vec3 dpdu, dpdv, n = hit->shading.n;
    float scale;
    mesh_tangents(t, &dpdu, &dpdv, &scale);
    struct texture_point at = hit_texture_point(hit);
    struct texture_point at_u = bump_step(&at, BUMP_STEP, 0.0, dpdu, scale);
    struct texture_point at_v = bump_step(&at, 0.0, BUMP_STEP, dpdv, scale);
    double here = bump_height(shape, &at);
    double du = (bump_height(shape, &at_u) - here) / BUMP_STEP;
    double dv = (bump_height(shape, &at_v) - here) / BUMP_STEP;
    dpdu = vec3_mad(dpdu, scale * (float)du - vec3_dot(n, dpdu), n);
    dpdv = vec3_mad(dpdv, scale * (float)dv - vec3_dot(n, dpdv), n);
    struct vec3 bumped = vec3_cross(dpdu, dpdv);
    float square = vec3_dot(bumped, bumped);
    if (!(square > 0.0f) || !isfinite(square))
        return false;
    bumped = vec3_scale(bumped, 1.0f / sqrtf(square));
    *normal = vec3_dot(bumped, n) < 0.0f ? vec3_neg(bumped) : bumped;
    *tangent = dpdu;
    return true;
}

/* The normal 2c - 1 of a normal map in the frame of the shading normal and dp/du; false
 * without a direction of u, or a direction in c. */
static bool mapped_normal(const struct shape *shape, const struct triangle *t,
                          const struct hit *hit, struct vec3 *normal,
                          struct vec3 *tangent)
{
    struct vec3 dpdv;
    float scale;
    mesh_tangents(t, tangent, &dpdv, &scale);
    const struct texture_point at = hit_texture_point(hit);
    struct rgb c = texture_eval(shape->bsdf->relief.texture, &at);
    double x = 2.0 * c.r - 1.0, y = 2.0 * c.g - 1.0, z = 2.0 * c.b - 1.0;
    double square = x * x + y * y + z * z;
    if (!(scale > 0.0f) || !(square > 0.0) || !isfinite(square))
        return false;
    double inverse = 1.0 / sqrt(square);
    struct vec3 local = {(float)(x * inverse), (float)(y * inverse),
                         (float)(z * inverse)};
    struct frame frame = aligned_frame(hit->shading.n, *tangent);
    *normal = frame_to_world(&frame, local);
    return true;
}

/* Turns the shading normal by the material's map, unless that would turn it to the other
 * side of the surface. */
static void turn_normal(const struct shape *shape, const struct triangle *t,
                        struct hit *hit)
{
    struct vec3 n, tangent;
    bool turned = shape->bsdf->relief.normals
                      ? mapped_normal(shape, t, hit, &n, &tangent)
                      : bumped_normal(shape, t, hit, &n, &tangent);
    if (!turned || !(vec3_dot(n, hit->at.ng) > 0.0f))
        return;
    hit->shading = shape->aligned ? aligned_frame(n, tangent) : frame_from_normal(n);
}

/* Frame and parameters; t and n in the world's space. */
static inline void fill_triangle(const struct shape *shape, const struct triangle *t,
                                 struct vec3 n, float b1, float b2, bool uv,
                                 struct hit *hit)
{
    if (shape->aligned && t->uv)
        hit->shading = aligned_frame(n, mesh_dpdu(t));
    else
        hit->shading = frame_from_normal(n);
    hit->u = hit->v = 0.0f;
    if (uv)
        mesh_uv(t, b1, b2, hit);
    if (uv && shape->bsdf->relief.texture)
        turn_normal(shape, t, hit);
}

void hit_fill_triangle(const struct shape *shape, uint32_t triangle, float b1, float b2,
                       bool uv, struct hit *hit)
{
    struct triangle t = triangle_load(&shape->triangles, triangle);
    struct vec3 n;
    hit->at = triangle_place(&shape->triangles, triangle, &t, b1, b2, &n);
    fill_triangle(shape, &t, n, b1, b2, uv, hit);
}

void hit_fill_triangle_instance(const struct instance *instance,
                                const struct shape *shape, uint32_t triangle, float b1,
                                float b2, bool uv, struct hit *hit)
{
    struct triangle t = triangle_load(&shape->triangles, triangle);
    struct vec3 n;
    hit->at = triangle_place(&shape->triangles, triangle, &t, b1, b2, &n);
    t.e1 = instance_vector(instance, t.e1);
    t.e2 = instance_vector(instance, t.e2);
    instance_place(instance, triangle_extent(&t), &hit->at, &n);
    fill_triangle(shape, &t, n, b1, b2, uv, hit);
}

/* Parameters and frame; instance: NULL in the world's space. */
static inline void fill_quadric(const struct instance *instance,
                                const struct shape *shape, const struct quadric_hit *q,
                                bool uv, struct hit *hit)
{
    hit->u = hit->v = 0.0f;
    if (uv || shape->aligned) {
        float at[2];
        struct vec3 dpdu;
        quadric_parameters(shape->quadric, q->p, at, &dpdu);
        hit->u = at[0];
        hit->v = at[1];
        if (shape->aligned) {
            hit->shading = aligned_frame(
                hit->at.ng, instance ? instance_vector(instance, dpdu) : dpdu);
            return;
        }
    }
    hit->shading = frame_from_normal(hit->at.ng);
}

void hit_fill_quadric(const struct shape *shape, const struct quadric_hit *q, bool uv,
                      struct hit *hit)
{
    hit->at = quadric_endpoint(shape->quadric, q->p);
    fill_quadric(NULL, shape, q, uv, hit);
}

void hit_fill_quadric_instance(const struct instance *instance, const struct shape *shape,
                               const struct quadric_hit *q, bool uv, struct hit *hit)
{
    hit->at = quadric_endpoint(shape->quadric, q->p);
    hit->at.offset += QUADRIC_DRIFT * shape->quadric->reach;
    struct vec3 n = hit->at.ng;
    instance_place(instance, instance_extent(instance, shape->quadric->reach), &hit->at,
                   &n);
    fill_quadric(instance, shape, q, uv, hit);
}
