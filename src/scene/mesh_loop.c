/* Loop's subdivision surfaces: points by the usual masks (Warren's weights), at the end
 * moved to the limit, with the limit's normals from the usual tangent masks. */

#include "scene/mesh.h"

#include "base/mem.h"
#include "math/warp.h"

#include <stdlib.h>
#include <string.h>

#define NONE          UINT32_MAX
#define MAX_TRIANGLES (1u << 26)
/* Limits the growth, so that one line of a scene file cannot demand gigabytes: beyond
 * SMALL triangles, each triangle of the control mesh may become MAX_GROWTH. */
#define SMALL      (1u << 18)
#define MAX_GROWTH 256

struct point {
    double x[3];
};

/* One level of subdivision. Half-edge h = 3 f + k runs from corner[h] to the next corner
 * of f. */
struct level {
    uint32_t vertices, faces;
    struct point *p;  /* [vertices] */
    uint32_t *corner; /* [3 faces] */
    uint32_t *twin;   /* [3 faces]: the half-edge that runs back, or NONE */
    uint32_t *from;   /* [vertices]: a half-edge that leaves it; at a border the one that
                         has no twin on its right, so that turning left sees all */
    uint32_t *edge;   /* [3 faces]: number of the undirected edge */
    uint32_t edges;
};

static uint32_t next_of(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}

static uint32_t prev_of(uint32_t h)
{
    return h % 3 == 0 ? h + 2 : h - 1;
}

static void level_deinit(struct level *l)
{
    mem_free(l->p);
    mem_free(l->corner);
    mem_free(l->twin);
    mem_free(l->from);
    mem_free(l->edge);
}

struct half {
    uint32_t low, high, h;
};

static uint32_t low_of(const struct level *l, uint32_t h)
{
    uint32_t a = l->corner[h], b = l->corner[next_of(h)];
    return a < b ? a : b;
}

static uint32_t high_of(const struct level *l, uint32_t h)
{
    uint32_t a = l->corner[h], b = l->corner[next_of(h)];
    return a < b ? b : a;
}

static int by_edge(const void *a, const void *b)
{
    const struct half *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    if (x->high != y->high)
        return x->high < y->high ? -1 : 1;
    return x->h < y->h ? -1 : x->h > y->h;
}

/* All half-edges into halves, by_edge. By the lower vertex first, which takes no
 * comparisons; at a vertex there are but a few. */
static void sort_edges(const struct level *l, struct half *halves)
{
    uint32_t count = 3 * l->faces;
    uint32_t *end = mem_alloc((size_t)l->vertices + 1, sizeof *end);
    for (uint32_t h = 0; h < count; h++)
        end[low_of(l, h) + 1]++;
    for (uint32_t v = 0; v < l->vertices; v++)
        end[v + 1] += end[v];
    for (uint32_t h = 0; h < count; h++) {
        uint32_t low = low_of(l, h);
        halves[end[low]++] = (struct half){low, high_of(l, h), h};
    }
    for (uint32_t v = 0, begin = 0; v < l->vertices; begin = end[v++])
        qsort(halves + begin, end[v] - begin, sizeof *halves, by_edge);
    mem_free(end);
}

/* Pairs half-edges; false if an edge has more than two, or two that run the same way. */
static bool pair_edges(struct level *l, struct half *halves)
{
    uint32_t count = 3 * l->faces;
    for (uint32_t h = 0; h < count; h++)
        if (low_of(l, h) == high_of(l, h))
            return false;
    sort_edges(l, halves);
    for (uint32_t i = 0; i < count;) {
        uint32_t n = 1;
        while (i + n < count && halves[i + n].low == halves[i].low &&
               halves[i + n].high == halves[i].high)
            n++;
        uint32_t g = halves[i].h, h = n > 1 ? halves[i + 1].h : NONE;
        if (n > 2 || (n == 2 && l->corner[g] == l->corner[h]))
            return false;
        l->twin[g] = h;
        l->edge[g] = l->edges;
        if (n == 2) {
            l->twin[h] = g;
            l->edge[h] = l->edges;
        }
        l->edges++;
        i += n;
    }
    return true;
}

/* The next half-edge that leaves the same vertex, counter-clockwise; NONE at a border. */
static uint32_t turn(const struct level *l, uint32_t h)
{
    return l->twin[prev_of(h)];
}

static bool link_level(struct level *l)
{
    uint32_t count = 3 * l->faces;
    struct half *halves = mem_alloc((size_t)count + 1, sizeof *halves);
    l->twin = mem_alloc((size_t)count + 1, sizeof *l->twin);
    l->edge = mem_alloc((size_t)count + 1, sizeof *l->edge);
    l->from = mem_alloc((size_t)l->vertices + 1, sizeof *l->from);
    l->edges = 0;
    bool good = pair_edges(l, halves);
    mem_free(halves);
    memset(l->from, 0xff, (size_t)l->vertices * sizeof *l->from);
    for (uint32_t h = 0; good && h < count; h++)
        if (l->from[l->corner[h]] == NONE || l->twin[h] == NONE)
            l->from[l->corner[h]] = h;
    return good;
}

static void add_to(double sum[3], const struct point *p, double weight)
{
    for (int k = 0; k < 3; k++)
        sum[k] += weight * p->x[k];
}

/* Neighbours of v counter-clockwise into ring (as many as fit); returns how many there
 * are. *border: the first and the last lie on the border. */
static uint32_t ring_of(const struct level *l, uint32_t v, uint32_t *ring, uint32_t room,
                        bool *border)
{
    uint32_t start = l->from[v], h = start, n = 0;
    *border = false;
    if (start == NONE)
        return 0;
    do {
        if (n < room)
            ring[n] = l->corner[next_of(h)];
        n++;
        uint32_t next = turn(l, h);
        if (next == NONE) {
            if (n < room)
                ring[n] = l->corner[prev_of(h)];
            n++;
            *border = true;
            break;
        }
        h = next;
    } while (h != start && n <= l->edges);
    return n;
}

static double beta_of(uint32_t n)
{
    return n == 3 ? 3.0 / 16.0 : 3.0 / (8.0 * n);
}

/* (1 - sum of weights) v and `weight` of each neighbour, or `border_weight` of the two on
 * the border. */
static struct point smooth(const struct level *l, uint32_t v, const uint32_t *ring,
                           uint32_t n, bool border, double weight, double border_weight)
{
    struct point out = {{0.0, 0.0, 0.0}};
    if (border) {
        add_to(out.x, &l->p[v], 1.0 - 2.0 * border_weight);
        add_to(out.x, &l->p[ring[0]], border_weight);
        add_to(out.x, &l->p[ring[n - 1]], border_weight);
        return out;
    }
    add_to(out.x, &l->p[v], 1.0 - n * weight);
    for (uint32_t i = 0; i < n; i++)
        add_to(out.x, &l->p[ring[i]], weight);
    return out;
}

static void old_points(const struct level *l, uint32_t *ring, struct point *out)
{
    for (uint32_t v = 0; v < l->vertices; v++) {
        bool border;
        uint32_t n = ring_of(l, v, ring, l->edges + 1, &border);
        out[v] = n == 0 ? l->p[v]
                        : smooth(l, v, ring, n, border, border ? 0.0 : beta_of(n), 0.125);
    }
}

static void new_points(const struct level *l, struct point *out)
{
    for (uint32_t h = 0; h < 3 * l->faces; h++) {
        uint32_t g = l->twin[h];
        const struct point *a = &l->p[l->corner[h]], *b = &l->p[l->corner[next_of(h)]];
        struct point *mid = &out[l->vertices + l->edge[h]];
        *mid = (struct point){{0.0, 0.0, 0.0}};
        if (g == NONE) {
            add_to(mid->x, a, 0.5);
            add_to(mid->x, b, 0.5);
            continue;
        }
        add_to(mid->x, a, 0.375);
        add_to(mid->x, b, 0.375);
        add_to(mid->x, &l->p[l->corner[prev_of(h)]], 0.125);
        add_to(mid->x, &l->p[l->corner[prev_of(g)]], 0.125);
    }
}

static bool too_many(uint64_t triangles, uint64_t control)
{
    return triangles > MAX_TRIANGLES ||
           (triangles > SMALL && triangles > MAX_GROWTH * control);
}

static bool subdivide(struct level *l, uint32_t control)
{
    if (too_many(4 * (uint64_t)l->faces, control))
        return false;
    struct level out = {.vertices = l->vertices + l->edges, .faces = 4 * l->faces};
    out.p = mem_alloc(out.vertices, sizeof *out.p);
    out.corner = mem_alloc(3 * (size_t)out.faces, sizeof *out.corner);
    uint32_t *ring = mem_alloc((size_t)l->edges + 1, sizeof *ring);
    old_points(l, ring, out.p);
    mem_free(ring);
    new_points(l, out.p);
    for (uint32_t f = 0; f < l->faces; f++) {
        const uint32_t *c = l->corner + 3 * (size_t)f, *e = l->edge + 3 * (size_t)f;
        uint32_t m[3] = {l->vertices + e[0], l->vertices + e[1], l->vertices + e[2]};
        const uint32_t corners[12] = {c[0], m[0], m[2], m[0], c[1], m[1],
                                      m[2], m[1], c[2], m[0], m[1], m[2]};
        memcpy(out.corner + 12 * (size_t)f, corners, sizeof corners);
    }
    level_deinit(l);
    *l = out;
    return link_level(l);
}

static void to_limit(struct level *l, uint32_t *ring)
{
    struct point *out = mem_alloc((size_t)l->vertices + 1, sizeof *out);
    for (uint32_t v = 0; v < l->vertices; v++) {
        bool border;
        uint32_t n = ring_of(l, v, ring, l->edges + 1, &border);
        double gamma = border || n == 0 ? 0.0 : 1.0 / (n + 3.0 / (8.0 * beta_of(n)));
        out[v] = n == 0 ? l->p[v] : smooth(l, v, ring, n, border, gamma, 0.2);
    }
    mem_free(l->p);
    l->p = out;
}

/* The tangent across a border, inwards, from the ring's points. */
static void border_tangent(const struct level *l, uint32_t v, const uint32_t *ring,
                           uint32_t n, double t[3])
{
    if (n == 2) {
        add_to(t, &l->p[ring[0]], 1.0);
        add_to(t, &l->p[ring[1]], 1.0);
        add_to(t, &l->p[v], -2.0);
    } else if (n == 3) {
        add_to(t, &l->p[ring[1]], 1.0);
        add_to(t, &l->p[v], -1.0);
    } else {
        double theta = MATH_PI / (n - 1);
        add_to(t, &l->p[ring[0]], -sin(theta));
        add_to(t, &l->p[ring[n - 1]], -sin(theta));
        for (uint32_t k = 1; k + 1 < n; k++)
            add_to(t, &l->p[ring[k]], (2.0 - 2.0 * cos(theta)) * sin(k * theta));
    }
}

/* Not unit; zero where the tangents vanish, which mesh_check repairs. */
static void limit_normal(const struct level *l, uint32_t v, uint32_t *ring, float out[3])
{
    double s[3] = {0.0, 0.0, 0.0}, t[3] = {0.0, 0.0, 0.0};
    bool border;
    uint32_t n = ring_of(l, v, ring, l->edges + 1, &border);
    if (border) {
        add_to(s, &l->p[ring[0]], 1.0);
        add_to(s, &l->p[ring[n - 1]], -1.0);
        border_tangent(l, v, ring, n, t);
    }
    for (uint32_t i = 0; !border && i < n; i++) {
        add_to(s, &l->p[ring[i]], cos(2.0 * MATH_PI * i / n));
        add_to(t, &l->p[ring[i]], sin(2.0 * MATH_PI * i / n));
    }
    double c[3], length = 0.0;
    for (int k = 0; k < 3; k++) {
        c[k] = s[(k + 1) % 3] * t[(k + 2) % 3] - s[(k + 2) % 3] * t[(k + 1) % 3];
        length += c[k] * c[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; k++)
        out[k] = length > 0.0 ? (float)(c[k] / length) : 0.0f;
}

static struct mesh *to_mesh(const struct level *l, uint32_t *ring)
{
    struct mesh *mesh = mesh_create(l->vertices, l->faces, true, false);
    memcpy(mesh->index, l->corner, 3 * (size_t)l->faces * sizeof *mesh->index);
    for (uint32_t v = 0; v < l->vertices; v++) {
        for (int k = 0; k < 3; k++)
            mesh->p[3 * (size_t)v + (size_t)k] = (float)l->p[v].x[k];
        limit_normal(l, v, ring, mesh->n + 3 * (size_t)v);
    }
    return mesh;
}

struct mesh *mesh_loop(const struct mesh *control, int levels)
{
    if (too_many(control->triangle_count, control->triangle_count))
        return NULL;
    struct level l = {.vertices = control->vertex_count,
                      .faces = control->triangle_count};
    l.p = mem_alloc((size_t)l.vertices + 1, sizeof *l.p);
    l.corner = mem_alloc(3 * (size_t)l.faces + 1, sizeof *l.corner);
    memcpy(l.corner, control->index, 3 * (size_t)l.faces * sizeof *l.corner);
    for (size_t i = 0; i < 3 * (size_t)l.vertices; i++)
        l.p[i / 3].x[i % 3] = (double)control->p[i];
    bool good = link_level(&l);
    for (int i = 0; good && i < levels; i++)
        good = subdivide(&l, control->triangle_count);
    struct mesh *mesh = NULL;
    if (good) {
        uint32_t *ring = mem_alloc((size_t)l.edges + 1, sizeof *ring);
        to_limit(&l, ring);
        mesh = to_mesh(&l, ring);
        mem_free(ring);
    }
    level_deinit(&l);
    return mesh;
}
