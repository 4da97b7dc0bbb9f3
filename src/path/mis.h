#ifndef ETALON_PATH_MIS_H
#define ETALON_PATH_MIS_H

/* The balance heuristic [Veach97 Eq. 9.8] over the techniques of bidirectional path
 * tracing, by ratios of their densities [Veach97 Eq. 10.9]; path/vertex.h derives the
 * recurrence. */

#include "path/vertex.h"

/* The techniques that share the weight of a path: all (s,t); or those of a path tracer,
 * s <= 1, where no sub-path starts at a light. */
enum mis_set { MIS_BIDIRECTIONAL, MIS_UNIDIRECTIONAL };

/* S_e: the summed densities of all techniques that give vertices of this side to the
 * other one, over that of the technique at hand. q: density per area of the end vertex v
 * from the other side; q_dir: density per solid angle, at v and from the other side, of
 * the direction to the vertex before v; end: chance that a walk from the other side
 * ends at v. */
static inline double mis_side(const struct vertex *v, double q, double q_dir, double end)
{
    /* S_e = r_e (d_e + q_dir mis_tail_e) of path/vertex.h [Veach97 Eq. 10.9]. */
    return q / v->pdf_fwd * (end * v->prev_connects + q_dir * v->mis_tail);
}

/* p_s / sum p_i = 1 / (1 + S_light + S_camera) [Veach97 Eq. 9.8]. */
static inline double mis_weight(double light_side, double camera_side)
{
    return 1.0 / (1.0 + light_side + camera_side);
}

#endif
