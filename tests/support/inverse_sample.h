#ifndef ETALON_TESTS_SUPPORT_INVERSE_SAMPLE_H
#define ETALON_TESTS_SUPPORT_INVERSE_SAMPLE_H

/* Multiplexed paths with numbers that are kept, and paths made from numbers that inverse
 * sampling has found. */

#include "path/invert.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define PLACES (DIMS_LIGHT_VERTEX + 3 * 8)

/* The numbers of one stream; drawn where value[place] is below 0. */
struct tape_stream {
    struct ustream stream; /* must be first */
    struct rng *rng;
    double value[PLACES], asked[PLACES];
    const struct tape_stream *kept_from;
    int kept;
};

static inline const double *tape_take(struct ustream *self, int place, int count)
{
    struct tape_stream *s = (struct tape_stream *)self;
    assert_true(place >= 0 && place + count <= PLACES);
    for (int i = place; i < place + count; i++) {
        bool kept = i < s->kept && s->kept_from->asked[i] >= 0.0;
        s->asked[i] = s->value[i] >= 0.0 ? s->value[i]
                      : kept             ? s->kept_from->asked[i]
                                         : rng_double(s->rng);
        assert_true(s->asked[i] >= 0.0 && s->asked[i] < 1.0);
    }
    return s->asked + place;
}

struct sample {
    struct tape_stream streams[3];
    struct numbers numbers;
    struct subpaths paths;
    struct contrib out;
};

static inline void sample_init(struct sample *s, const struct scene *scene, int length,
                               struct rng *rng)
{
    subpaths_init(&s->paths, scene, length);
    contrib_init(&s->out, 1);
    for (int i = 0; i < 3; i++)
        s->streams[i] = (struct tape_stream){.stream = {tape_take}, .rng = rng};
    s->numbers = (struct numbers){&s->streams[0].stream, &s->streams[1].stream,
                                  &s->streams[2].stream};
}

static inline void sample_deinit(struct sample *s)
{
    subpaths_deinit(&s->paths);
    contrib_deinit(&s->out);
}

static inline void sample_clear(struct sample *s)
{
    for (int i = 0; i < 3; i++) {
        s->streams[i].kept = 0;
        for (int j = 0; j < PLACES; j++)
            s->streams[i].value[j] = s->streams[i].asked[j] = -1.0;
    }
}

static inline struct found found_of(struct sample *s)
{
    return (struct found){
        {0, s->streams[0].value}, {0, s->streams[1].value}, {0, s->streams[2].value}};
}

static inline void keep(struct sample *s, const struct sample *from,
                        const struct found *found)
{
    const struct found_numbers *of[3] = {&found->camera, &found->light, &found->connect};
    for (int i = 0; i < 3; i++) {
        s->streams[i].kept_from = &from->streams[i];
        s->streams[i].kept = of[i]->kept;
    }
}

#endif
