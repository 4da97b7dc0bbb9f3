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
    enum found_stream name;
    const struct found *found; /* NULL, or what value[] comes from */
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
    }
    if (s->found && s->found->correct && s->value[place] >= 0.0)
        s->found->correct(s->found->ctx, s->name, place, s->asked + place, count);
    for (int i = place; i < place + count; i++)
        assert_true(s->asked[i] >= 0.0 && s->asked[i] < 1.0);
    return s->asked + place;
}

struct sample {
    struct tape_stream streams[3];
    struct numbers numbers;
    struct subpaths paths;
    struct contrib out;
    struct inverted inverted;
    struct found found; /* of numbers that make this sample */
};

static inline void sample_init(struct sample *s, const struct scene *scene, int length,
                               struct rng *rng)
{
    subpaths_init(&s->paths, scene, length);
    contrib_init(&s->out, 1);
    for (int i = 0; i < 3; i++)
        s->streams[i] = (struct tape_stream){
            .stream = {tape_take}, .rng = rng, .name = (enum found_stream)i};
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
        s->streams[i].found = NULL;
        for (int j = 0; j < PLACES; j++)
            s->streams[i].value[j] = s->streams[i].asked[j] = -1.0;
    }
}

static inline struct found *found_of(struct sample *s)
{
    s->found = (struct found){
        .camera.value = s->streams[0].value,
        .light.value = s->streams[1].value,
        .connect.value = s->streams[2].value,
    };
    return &s->found;
}

/* The numbers found are those of a sample that was made of `from`. */
static inline void keep(struct sample *s, const struct sample *from)
{
    const struct found *found = &s->found;
    const struct found_numbers *of[3] = {&found->camera, &found->light, &found->connect};
    s->inverted.paths = &s->paths;
    for (int i = 0; i < 3; i++) {
        s->streams[i].found = found;
        s->streams[i].kept_from = &from->streams[i];
        s->streams[i].kept = of[i]->kept;
    }
}

#endif
