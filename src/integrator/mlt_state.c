#include "integrator/mlt_state.h"

#include "base/pack.h"
#include "integrator/mlt_numbers.h"

#include <limits.h>
#include <math.h>

/* A path with what its choice of mutations depends on. */
struct candidate {
    struct full_path path;
    bool known;    /* the next is */
    unsigned suit; /* bit i: move MOVE_LOCAL + i suits it */
};

struct mlt {
    struct state state; /* must be first */
    const struct mlt_options *options;
    struct candidate candidates[2];
    struct candidate *current, *proposed;
    bool current_empty, proposed_empty; /* a path without a contribution */
    struct mutation_random random;
    struct mlt_numbers numbers;
    long rays; /* of the last proposal */
};

static struct mlt *mlt_of(struct state *state)
{
    return (struct mlt *)state;
}

const struct full_path *mlt_state_current(const struct state *state)
{
    const struct mlt *m = (const struct mlt *)state;
    return m->current_empty ? NULL : &m->current->path;
}

const struct full_path *mlt_state_proposed(const struct state *state)
{
    const struct mlt *m = (const struct mlt *)state;
    return m->proposed_empty ? NULL : &m->proposed->path;
}

static void init(struct state *state, const void *options)
{
    struct mlt *m = mlt_of(state);
    m->options = options;
    for (int i = 0; i < 2; i++)
        full_path_init(&m->candidates[i].path, m->options->depth);
    m->current = &m->candidates[0];
    m->proposed = &m->candidates[1];
    m->current_empty = m->proposed_empty = true;
    m->random.rng = state->rng;
}

static void rng_changed(struct state *state)
{
    mlt_of(state)->random.film = (struct film_points){state->seed, state->chain, 0};
    mlt_numbers_drop(&mlt_of(state)->numbers);
}

static void deinit(struct state *state)
{
    for (int i = 0; i < 2; i++)
        full_path_deinit(&mlt_of(state)->candidates[i].path);
}

static double bytes(const void *options)
{
    const struct mlt_options *o = options;
    return 2.0 * (o->depth + 1) * (double)sizeof(struct full_vertex);
}

/* --- proposals ---------------------------------------------------------------------- */

static void find_suitable(struct path_space *space, const struct mlt_options *o,
                          struct candidate *c)
{
    if (c->known)
        return;
    c->known = true;
    c->suit = o->weights[MUTATIONS] > 0.0 ? 1u << MUTATIONS : 0;
    for (int i = 0; i < MUTATIONS; i++)
        if (o->weights[i] > 0.0 && mutation_types[i]->suits(space, &c->path))
            c->suit |= 1u << i;
}

/* Sum of the weights of the moves that suit it. */
static double weight_of(const struct mlt_options *o, const struct candidate *c)
{
    double sum = 0.0;
    for (int i = 0; i < MLT_MOVES; i++)
        sum += c->suit & 1u << i ? o->weights[i] : 0.0;
    return sum;
}

/* One of the moves that suit the current path, by weight; -1 if none does. */
static int choose(const struct mlt *m)
{
    double u = rng_double(m->state.rng) * weight_of(m->options, m->current);
    int choice = -1;
    for (int i = 0; i < MLT_MOVES; i++) {
        if (!(m->current->suit & 1u << i))
            continue;
        choice = i;
        if (u < m->options->weights[i])
            break;
        u -= m->options->weights[i];
    }
    return choice;
}

/* Makes y of x by a mutation of paths; *ratio as path/mutation.h has it. */
static void mutate(struct mlt *m, struct path_space *space, int choice,
                   struct scaled *ratio, struct contrib *out)
{
    struct candidate *y = m->proposed;
    out->failure = mutation_propose(mutation_types[choice], space, &m->options->mutation,
                                    &m->current->path, &m->random, &y->path, ratio);
    if (out->failure != FAILURE_NONE)
        return;
    full_path_weigh(space, &y->path);
    find_suitable(space, m->options, y);
    if (!(y->suit & 1u << choice)) { /* there is no way back */
        out->failure = FAILURE_CLASS;
        return;
    }
    out->failure = FAILURE_ZERO;
    full_path_contribute(&y->path, out);
    /* With respect to the law of independent paths (chain/state.h). */
    *ratio = scaled_mul(*ratio, scaled_div(y->path.pdf, m->current->path.pdf));
}

static void move_numbers(struct mlt *m, struct path_space *space, struct contrib *out)
{
    mlt_numbers_propose(&m->numbers, &m->options->kernel, m->state.rng, space,
                        &m->current->path, out);
    if (!(out->target > 0.0))
        return;
    full_path_copy(&m->proposed->path, &space->sampled);
    find_suitable(space, m->options, m->proposed);
}

static struct proposal propose_local(struct mlt *m, struct path_space *space,
                                     struct contrib *out)
{
    struct proposal proposal = {MOVE_LOCAL, 0.0};
    struct scaled ratio = {1.0, 0};
    m->proposed_empty = true;
    contrib_clear(out);
    if (m->current_empty)
        return proposal;
    find_suitable(space, m->options, m->current);
    int choice = choose(m);
    if (choice < 0)
        return proposal;
    proposal.move = MOVE_LOCAL + choice;
    m->proposed->known = false;
    if (choice < MUTATIONS)
        mutate(m, space, choice, &ratio, out);
    else
        move_numbers(m, space, out);
    if (!(out->target > 0.0))
        return proposal;
    m->proposed_empty = false;
    /* Of the choice as well. */
    double choices = weight_of(m->options, m->current) /
                     weight_of(m->options, m->proposed);
    proposal.log_ratio = scaled_log(scaled_by(ratio, choices));
    return proposal;
}

static struct proposal propose_large(struct mlt *m, const struct target *target,
                                     struct path_space *space, struct contrib *out)
{
    struct ustream_random stream;
    ustream_random_init(&stream, m->state.rng);
    struct numbers numbers = {&stream.stream, &stream.stream, &stream.stream};
    target->eval(target->ctx, &numbers, out);
    m->proposed_empty = !(out->target > 0.0);
    m->proposed->known = false;
    if (!m->proposed_empty)
        full_path_copy(&m->proposed->path, &space->sampled);
    return (struct proposal){MOVE_LARGE, 0.0};
}

static struct proposal propose(struct state *state, const struct target *target,
                               enum move move, struct contrib *out)
{
    struct mlt *m = mlt_of(state);
    struct path_space *space = target->ctx;
    space->rays = 0;
    struct proposal p = move == MOVE_LARGE ? propose_large(m, target, space, out)
                                           : propose_local(m, space, out);
    m->rays = space->rays;
    return p;
}

static void accept(struct state *state)
{
    struct mlt *m = mlt_of(state);
    struct candidate *replaced = m->current;
    m->current = m->proposed;
    m->proposed = replaced;
    m->current_empty = m->proposed_empty;
    m->proposed_empty = true;
}

static void reject(struct state *state)
{
    mlt_of(state)->proposed_empty = true;
}

static double work(const struct state *state, const struct contrib *proposed)
{
    (void)proposed;
    return WORK_EVENT * (1.0 + (double)((const struct mlt *)state)->rays);
}

/* --- checkpoints -------------------------------------------------------------------- */

static void pack_rgb(struct pack *pack, const char *name, struct rgb *c)
{
    double v[3] = {c->r, c->g, c->b};
    pack_doubles(pack, name, v, 3);
    *c = rgb(v[0], v[1], v[2]);
}

static void pack_vectors(struct pack *pack, struct vec3 *const vectors[], int count)
{
    double v[3 * 8];
    for (long i = 0; i < count; i++) {
        v[3 * i] = (double)vectors[i]->x;
        v[3 * i + 1] = (double)vectors[i]->y;
        v[3 * i + 2] = (double)vectors[i]->z;
    }
    pack_doubles(pack, "vectors", v, 3 * (size_t)count);
    for (long i = 0; i < count; i++)
        *vectors[i] = vec3((float)v[3 * i], (float)v[3 * i + 1], (float)v[3 * i + 2]);
}

/* The shape gives the material again. */
static void pack_hit(struct pack *pack, const struct scene *scene, struct hit *hit)
{
    int shape = hit->shape, light = hit->light;
    int64_t triangle = hit->triangle;
    struct vec3 *const vectors[] = {&hit->at.p, &hit->at.ng, &hit->shading.s,
                                    &hit->shading.t, &hit->shading.n};
    float floats[] = {hit->at.offset, hit->at.far_offset, hit->u, hit->v};
    pack_int(pack, "shape", &shape, -1, (int)scene->desc->shape_count - 1);
    pack_int64s(pack, "triangle", &triangle, 1);
    pack_int(pack, "hit_light", &light, -1, scene->light_count - 1);
    pack_vectors(pack, vectors, 5);
    pack_floats(pack, "floats", floats, 4);
    hit->at.offset = floats[0];
    hit->at.far_offset = floats[1];
    hit->u = floats[2];
    hit->v = floats[3];
    hit->shape = shape;
    hit->triangle = (uint32_t)triangle;
    hit->light = light;
    hit->bsdf = shape >= 0 && pack_ok(pack) ? scene->shapes[shape].bsdf : &bsdf_nothing;
}

static void pack_vertex(struct pack *pack, const struct scene *scene,
                        struct full_vertex *v)
{
    int kind = (int)v->kind, light = v->light;
    struct vec3 *const w[] = {&v->edge.w};
    pack_int(pack, "kind", &kind, VERTEX_CAMERA, VERTEX_SURFACE);
    pack_int(pack, "light", &light, -1, scene->light_count - 1);
    pack_flag(pack, "delta", &v->delta);
    pack_flag(pack, "transmits", &v->transmits);
    v->kind = (enum vertex_kind)kind;
    v->light = light;
    pack_hit(pack, scene, &v->hit);
    pack_vectors(pack, w, 1);
    pack_double(pack, "inverse_square", &v->edge.inverse_square);
    pack_rgb(pack, "transmittance", &v->transmittance);
    pack_double(pack, "chance", &v->chance);
    pack_int(pack, "crossed", &v->crossed, 0, INT_MAX);
    pack_rgb(pack, "value", &v->value);
    pack_double(pack, "pdf_to_light", &v->pdf_to_light);
    pack_double(pack, "pdf_to_camera", &v->pdf_to_camera);
    pack_doubles(pack, "cos", v->cos, 2);
    pack_doubles(pack, "end", v->end, 2);
    pack_doubles(pack, "lobe", v->lobe, 2);
}

static void pack_path(struct pack *pack, const struct mlt_options *o,
                      struct full_path *path)
{
    int pixel = path->pixel;
    pack_int(pack, "edges", &path->edges, 1, o->depth);
    pack_doubles(pack, "film", path->film, 2);
    pack_int(pack, "pixel", &pixel, 0, o->scene->camera.width * o->scene->camera.height);
    path->pixel = pixel;
    pack_double(pack, "pdf_film", &path->pdf_film);
    pack_rgb(pack, "emission", &path->emission);
    pack_double(pack, "pdf_point", &path->pdf_point);
    pack_double(pack, "pdf_direction", &path->pdf_direction);
    pack_rgb(pack, "ratio", &path->ratio);
    pack_double(pack, "pdf", &path->pdf.m);
    pack_long(pack, "pdf_exponent", &path->pdf.e, LONG_MIN, LONG_MAX);
    for (int i = 0; pack_ok(pack) && i <= path->edges; i++)
        pack_vertex(pack, o->scene, &path->x[i]);
}

static void pack_state(struct pack *pack, struct state *state)
{
    struct mlt *m = mlt_of(state);
    struct film_points *film = &m->random.film;
    int64_t points[3] = {(int64_t)film->seed, (int64_t)film->chain, film->drawn};
    pack_int64s(pack, "film_points", points, 3);
    *film = (struct film_points){(uint64_t)points[0], (uint64_t)points[1], points[2]};
    mlt_numbers_pack(pack, &m->numbers);
    pack_flag(pack, "empty", &m->current_empty);
    if (pack_ok(pack) && !m->current_empty)
        pack_path(pack, m->options, &m->current->path);
}

const struct state_type state_mlt = {
    .moves = {[MOVE_LARGE] = "large",
              [MLT_LENS] = "lens",
              [MLT_CAUSTIC] = "caustic",
              [MLT_MULTICHAIN] = "multichain",
              [MLT_BIDIRECTIONAL] = "bidirectional",
              [MLT_LENS_SUBPATH] = "lens_subpath",
              [MLT_NUMBERS] = "numbers"},
    .size = sizeof(struct mlt),
    .init = init,
    .deinit = deinit,
    .bytes = bytes,
    .rng_changed = rng_changed,
    .propose = propose,
    .accept = accept,
    .reject = reject,
    .work = work,
    .tallies_work = true,
    .pack = pack_state,
};
