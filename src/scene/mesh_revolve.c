#include "math/warp.h"
#include "scene/mesh.h"

#include <math.h>
#include <string.h>

static void set_vertex(struct mesh *mesh, size_t v, const struct mesh_ring *ring,
                       double phi, const double uv[2])
{
    double c = cos(phi), s = sin(phi);
    double length = hypot(ring->normal_radius, ring->normal_z);
    const double p[3] = {ring->radius * c, ring->radius * s, ring->z};
    const double n[3] = {ring->normal_radius / length * c,
                         ring->normal_radius / length * s, ring->normal_z / length};
    for (size_t i = 0; i < 3; i++) {
        mesh->p[3 * v + i] = (float)p[i];
        mesh->n[3 * v + i] = (float)n[i];
    }
    mesh->uv[2 * v] = (float)uv[0];
    mesh->uv[2 * v + 1] = (float)uv[1];
}

/* Two triangles between two rings, or the one that is left where a ring is a point. */
static void add_cell(struct mesh *mesh, const struct mesh_ring *rings, uint32_t below,
                     uint32_t above)
{
    const uint32_t corners[2][3] = {{below, below + 1, above + 1},
                                    {below, above + 1, above}};
    const bool whole[2] = {rings[0].radius > 0.0, rings[1].radius > 0.0};
    for (int t = 0; t < 2; t++) {
        if (!whole[t])
            continue;
        memcpy(mesh->index + 3 * (size_t)mesh->triangle_count++, corners[t],
               sizeof corners[t]);
    }
}

struct mesh *mesh_revolve(const struct mesh_ring *rings, int count, double phi_max)
{
    uint32_t around = (uint32_t)fmax(
        8.0, ceil(MESH_REVOLVE_AROUND * phi_max / (2.0 * MATH_PI)));
    uint32_t rows = (uint32_t)count;
    struct mesh *mesh = mesh_create(rows * (around + 1), 2 * (rows - 1) * around, true,
                                    true);
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j <= around; j++) {
            const double uv[2] = {(double)j / around, (double)i / (rows - 1)};
            double phi = j == around && phi_max >= 2.0 * MATH_PI ? 0.0 : phi_max * uv[0];
            set_vertex(mesh, i * (around + 1) + j, &rings[i], phi, uv);
        }
    mesh->triangle_count = 0;
    for (uint32_t i = 0; i + 1 < rows; i++)
        for (uint32_t j = 0; j < around; j++)
            add_cell(mesh, rings + i, i * (around + 1) + j, (i + 1) * (around + 1) + j);
    return mesh;
}
