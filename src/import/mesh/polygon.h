#ifndef ETALON_IMPORT_POLYGON_H
#define ETALON_IMPORT_POLYGON_H

/* Polygons to triangles. A polygon of n corners makes n - 2 triangles. Readers write it
 * as a fan about its first corner, which is right for convex polygons; concave ones are
 * triangulated again here. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Corners up to which a concave polygon is cut by ears: the time grows with the square of
 * their number. */
#define POLYGON_MOST 2048

struct polygon {
    double (*p)[3]; /* [count] corners, to be filled in */
    uint32_t *order, *triangles;
    size_t capacity;
};

/* Corner i of the polygon whose fan is at `fan`: triangles 0 1 2, 0 2 3, ... */
static inline uint32_t polygon_fan_corner(const uint32_t *fan, size_t i)
{
    return i < 2 ? fan[i] : fan[3 * (i - 2) + 2];
}

void polygon_deinit(struct polygon *polygon);
/* Room for `count` corners in polygon->p. */
void polygon_reserve(struct polygon *polygon, size_t count);

/* For the polygon with the corners polygon->p: keeps the fan of `count` corners if it is
 * convex, else triangulates it. False, and the fan stays, if that fails. */
bool polygon_mend_fan(struct polygon *polygon, size_t count, uint32_t *fan);

/* Whether the fan about corner 0 covers the polygon: it is convex, seen along its normal
 * by Newell's method, but for the rounding of its corners, or it has no area. */
bool polygon_is_convex(const struct polygon *polygon, size_t count);

/* Cuts ears off, n - 2 triangles in the order of the corners [Meisters75]: count - 2
 * triples of corner numbers in polygon->triangles. False if the polygon crosses itself so
 * that there is no ear, or has more than POLYGON_MOST corners; the fan stays then. */
bool polygon_cut_ears(struct polygon *polygon, size_t count);

#endif
