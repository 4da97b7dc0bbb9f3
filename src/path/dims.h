#ifndef ETALON_PATH_DIMS_H
#define ETALON_PATH_DIMS_H

/* The dimension table: every random event has a fixed place in one of three streams, so
 * that a number keeps its meaning when the path changes length. */

#include "math/ustream.h"
#include "surface/bsdf.h"

#define DIMS_MAX_DEPTH 64 /* edges of the longest path */

enum dims_camera {
    DIMS_FILM = 0,          /* 2: position on the film */
    DIMS_LENS = 2,          /* 2: point on the lens */
    DIMS_CAMERA_VERTEX = 4, /* 3 a vertex: lobe, direction */
};

enum dims_light {
    DIMS_LIGHT_PICK = 0,      /* 1: which light */
    DIMS_LIGHT_POINT = 1,     /* 2: where on it */
    DIMS_LIGHT_DIRECTION = 3, /* 2: into which direction */
    DIMS_LIGHT_VERTEX = 5,    /* 3 a vertex: lobe, direction */
};

enum dims_connect {
    DIMS_TECHNIQUE = 0, /* 1: (s,t) of multiplexed chains */
    DIMS_ROULETTE = 0,  /* 1: which connections of bdpt are tested for visibility */
    DIMS_DIRECT = 1,    /* 3 a camera vertex: light pick, point */
};

/* Places a stream needs for paths of at most max_depth edges. */
static inline int dims_camera_capacity(int max_depth)
{
    return DIMS_CAMERA_VERTEX + 3 * max_depth;
}

static inline int dims_light_capacity(int max_depth)
{
    return DIMS_LIGHT_VERTEX + 3 * max_depth;
}

static inline int dims_connect_capacity(int max_depth)
{
    return DIMS_DIRECT + 3 * max_depth;
}

/* Point on the lens; a pinhole draws none. */
static inline void dims_lens(struct ustream *stream, bool lens, double u[2])
{
    u[0] = u[1] = 0.5;
    if (!lens)
        return;
    const double *x = ustream_take(stream, DIMS_LENS, 2);
    u[0] = x[0], u[1] = x[1];
}

/* Position on the film. */
static inline void dims_film(struct ustream *stream, double u[2])
{
    const double *x = ustream_take(stream, DIMS_FILM, 2);
    u[0] = x[0], u[1] = x[1];
}

/* Numbers of a scattering event at vertex 1, 2, ... whose block starts at `first`; what
 * the BSDF does not read (and `keep` does not force) is not drawn. */
static inline void dims_scatter(struct ustream *stream, int first, int vertex,
                                unsigned flags, double u[3])
{
    int place = first + 3 * (vertex - 1);
    const double *x;
    switch (flags & (BSDF_U_LOBE | BSDF_U_DIRECTION)) {
    case BSDF_U_LOBE | BSDF_U_DIRECTION:
        x = ustream_take(stream, place, 3);
        u[0] = x[0], u[1] = x[1], u[2] = x[2];
        break;
    case BSDF_U_DIRECTION:
        x = ustream_take(stream, place + 1, 2);
        u[0] = 0.0, u[1] = x[0], u[2] = x[1];
        break;
    case BSDF_U_LOBE:
        x = ustream_take(stream, place, 1);
        u[0] = x[0], u[1] = u[2] = 0.0;
        break;
    default:
        u[0] = u[1] = u[2] = 0.0;
    }
}

/* Light pick and point; the pick is not drawn where there is one light only. */
static inline void dims_light(struct ustream *stream, int place, bool pick, double u[3])
{
    const double *x = ustream_take(stream, pick ? place : place + 1, pick ? 3 : 2);
    u[0] = pick ? x[0] : 0.0;
    u[1] = x[pick], u[2] = x[pick + 1];
}

#endif
