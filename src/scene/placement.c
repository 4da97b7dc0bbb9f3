#include "scene/placement.h"

#include "base/machine.h"
#include "base/mem.h"
#include "scene/scene.h"

/* What Embree takes for an instance beside the record, measured. */
#define PLACEMENT_BVH_BYTES 200.0
#define PLACEMENT_MOST      0x1p31 /* Embree numbers them by 32 bits */

/* One way in which an object lies in the scene. */
struct placed {
    struct xform to_world;
    const struct place *place; /* of its outermost instance */
    bool shared;               /* the object's shapes are kept in its space for it */
};

struct placed_list {
    struct placed *list;
    size_t count;
};

struct placing {
    struct scene *scene;
    struct scene_desc *desc;
    size_t objects; /* 0, the scene, included */
    size_t *first;  /* [objects + 1], of the instances whose parent it is, in */
    size_t *child;  /* [instances] */
    int *order;     /* [objects]: parents first */
    double *ways;   /* [objects] in which each lies in the scene */
    struct placed_list *placed;
    struct shape_desc *out; /* the description's new shapes */
    size_t out_count, out_capacity;
};

static bool check_number(int object, int least, int count, const struct place *at,
                         struct err *err)
{
    return (object >= least && object <= count) ||
           err_set(err, ERR_VALUE, at, "an instance names object %d of %d", object,
                   count);
}

static bool check_instances(const struct scene_desc *desc, struct err *err)
{
    int count = desc->object_count;
    for (size_t i = 0; i < desc->instances.count; i++) {
        const struct instance_desc *instance = &desc->instances.list[i];
        if (!check_number(instance->object, 1, count, &instance->place, err) ||
            !check_number(instance->parent, 0, count, &instance->place, err))
            return false;
        if (!xform_is_affine(&instance->to_world))
            return err_set(err, ERR_VALUE, &instance->place,
                           "the transform of an instance must be finite, affine and "
                           "invertible");
    }
    for (size_t i = 0; i < desc->shape_count; i++)
        if (!check_number(desc->shapes[i].object, 0, count, &desc->shapes[i].place, err))
            return false;
    return true;
}

/* Lists the instances by parent, in their order. */
static void list_children(struct placing *p)
{
    const struct instance_desc *list = p->desc->instances.list;
    size_t count = p->desc->instances.count;
    p->first = mem_alloc(p->objects + 2, sizeof *p->first);
    p->child = mem_alloc(count + 1, sizeof *p->child);
    for (size_t i = 0; i < count; i++)
        p->first[list[i].parent + 2]++;
    for (size_t o = 2; o <= p->objects; o++)
        p->first[o] += p->first[o - 1];
    for (size_t i = 0; i < count; i++)
        p->child[p->first[list[i].parent + 1]++] = i;
}

/* Every object that is left in `parents` has a parent that is left: going from parent to
 * parent ends in a circle. Returns an instance of it. */
static const struct place *find_circle(const struct placing *p, const size_t *parents)
{
    const struct instance_desc *list = p->desc->instances.list;
    size_t *from = mem_alloc(p->objects, sizeof *from), at = 0;
    for (size_t i = 0; i < p->desc->instances.count; i++)
        if (parents[list[i].object] > 0 && parents[list[i].parent] > 0) {
            at = (size_t)list[i].object;
            from[at] = i;
        }
    for (size_t k = 0; k < p->objects; k++)
        at = (size_t)list[from[at]].parent;
    const struct place *place = &list[from[at]].place;
    mem_free(from);
    return place;
}

/* Parents before what they contain; false if an object contains itself. */
static bool sort_objects(struct placing *p, struct err *err)
{
    const struct instance_desc *list = p->desc->instances.list;
    size_t ready = 0;
    size_t *parents = mem_alloc(p->objects, sizeof *parents); /* not yet in order */
    p->order = mem_alloc(p->objects, sizeof *p->order);
    for (size_t i = 0; i < p->desc->instances.count; i++)
        parents[list[i].object]++;
    for (size_t o = 0; o < p->objects; o++)
        if (parents[o] == 0)
            p->order[ready++] = (int)o;
    for (size_t done = 0; done < ready; done++) {
        size_t o = (size_t)p->order[done];
        for (size_t c = p->first[o]; c < p->first[o + 1]; c++) {
            int inside = list[p->child[c]].object;
            if (--parents[inside] == 0)
                p->order[ready++] = inside;
        }
    }
    bool good = ready == p->objects ||
                err_set(err, ERR_VALUE, find_circle(p, parents),
                        "an object contains itself, by way of this instance");
    mem_free(parents);
    return good;
}

/* In how many ways each object lies in the scene; refuses what memory would not hold. */
static bool count_ways(struct placing *p, struct err *err)
{
    const struct instance_desc *list = p->desc->instances.list;
    double sum = 0.0, available = machine_memory_available();
    p->ways = mem_alloc(p->objects, sizeof *p->ways);
    p->ways[0] = 1.0;
    for (size_t k = 0; k < p->objects; k++) {
        size_t o = (size_t)p->order[k];
        sum += o > 0 ? p->ways[o] : 0.0;
        for (size_t c = p->first[o]; c < p->first[o + 1]; c++)
            p->ways[list[p->child[c]].object] += p->ways[o];
    }
    double bytes = sum * ((double)(sizeof(struct placed) + sizeof(struct instance)) +
                          PLACEMENT_BVH_BYTES);
    return (bytes <= available && sum <= PLACEMENT_MOST) ||
           err_set(err, ERR_MEMORY, sum > 0.0 ? &list[0].place : NULL,
                   "%.4g instances, those within others multiplied out, take about %.0f "
                   "MB; %.0f MB are available",
                   sum, bytes / 0x1p20, available / 0x1p20);
}

static void multiply_out(struct placing *p)
{
    p->placed = mem_alloc(p->objects, sizeof *p->placed);
    for (size_t o = 0; o < p->objects; o++)
        p->placed[o].list = mem_alloc((size_t)p->ways[o], sizeof(struct placed));
    p->placed[0].list[p->placed[0].count++].to_world = xform_identity();
    for (size_t k = 0; k < p->objects; k++) {
        size_t o = (size_t)p->order[k];
        for (size_t w = 0; w < p->placed[o].count; w++)
            for (size_t c = p->first[o]; c < p->first[o + 1]; c++) {
                const struct instance_desc *i = &p->desc->instances.list[p->child[c]];
                const struct placed *outer = &p->placed[o].list[w];
                struct placed_list *inner = &p->placed[i->object];
                inner->list[inner->count++] = (struct placed){
                    .to_world = xform_mul(&outer->to_world, &i->to_world),
                    .place = o == 0 ? &i->place : outer->place,
                };
            }
    }
}

static void add_out(struct placing *p, const struct shape_desc *shape)
{
    p->out = mem_grow(p->out, &p->out_capacity, p->out_count + 1, sizeof *p->out);
    p->out[p->out_count++] = *shape;
}

/* A copy in the world's space. A mesh's winding, which a mirror turns, has a say where
 * there are no shading normals. */
static void add_copy(struct placing *p, const struct shape_desc *shape,
                     const struct placed *way)
{
    struct shape_desc copy = *shape;
    copy.object = 0;
    copy.place = *way->place;
    if (shape->mesh) {
        copy.mesh = mesh_copy(shape->mesh);
        mesh_transform(copy.mesh, &way->to_world);
        copy.reverse_orientation ^= !shape->mesh->n &&
                                    xform_swaps_handedness(&way->to_world);
    } else {
        copy.to_world = xform_mul(&way->to_world, &shape->to_world);
    }
    add_out(p, &copy);
}

static double copy_bytes(const struct shape_desc *shape)
{
    double bytes = sizeof *shape + sizeof(struct shape) + sizeof(struct light);
    if (!shape->mesh)
        return bytes + sizeof(struct quadric);
    return bytes + 32.0 * shape->mesh->vertex_count +
           (16.0 + ACCEL_TRIANGLE_BYTES) * shape->mesh->triangle_count;
}

static bool check_copies(const struct placing *p, struct err *err)
{
    double bytes = 0.0, copies = 0.0, available = machine_memory_available();
    const struct place *at = NULL;
    for (size_t i = 0; i < p->desc->shape_count; i++) {
        const struct shape_desc *shape = &p->desc->shapes[i];
        size_t o = (size_t)shape->object;
        for (size_t w = 0; o > 0 && w < p->placed[o].count; w++) {
            if (!shape->emits && p->placed[o].list[w].shared)
                continue;
            bytes += copy_bytes(shape);
            copies += 1.0;
            at = at ? at : p->placed[o].list[w].place;
        }
    }
    return bytes <= available ||
           err_set(err, ERR_MEMORY, at,
                   "%.4g copies of shapes in instances (lamps are not shared) take about "
                   "%.0f MB; %.0f MB are available",
                   copies, bytes / 0x1p20, available / 0x1p20);
}

/* Copies what is not shared of one object's shape; *shared: some instance wants it. */
static void copy_shape(struct placing *p, const struct shape_desc *shape, bool *shared)
{
    size_t o = (size_t)shape->object;
    const struct placed_list *ways = &p->placed[o];
    *shared = false;
    for (size_t w = 0; w < ways->count; w++) {
        if (!shape->emits && ways->list[w].shared)
            *shared = true;
        else
            add_copy(p, shape, &ways->list[w]);
    }
    if (ways->count == 0)
        log_note(&p->desc->log, &shape->place,
                 "a shape of an object that is put nowhere is left out");
}

/* The scene's own shapes and copies into p->out; what is in nobody's space any more has
 * its mesh freed and its object set to -1. */
static void collect_world(struct placing *p)
{
    struct scene_desc *desc = p->desc;
    for (size_t i = 0; i < desc->shape_count; i++)
        if (desc->shapes[i].object == 0)
            add_out(p, &desc->shapes[i]);
    for (size_t i = 0; i < desc->shape_count; i++) {
        struct shape_desc *shape = &desc->shapes[i];
        bool shared = true;
        if (shape->object > 0)
            copy_shape(p, shape, &shared);
        if (shared)
            continue;
        mesh_destroy(shape->mesh);
        shape->object = -1;
    }
}

/* Shapes of the scene itself, then those of each object. */
static void sort_shapes(struct placing *p)
{
    struct scene_desc *desc = p->desc;
    struct object *objects = mem_alloc(p->objects, sizeof *objects);
    collect_world(p);
    for (size_t i = 0; i < desc->shape_count; i++)
        if (desc->shapes[i].object > 0)
            objects[desc->shapes[i].object].shape_count++;
    objects[0].shape_count = p->out_count;
    for (size_t o = 1; o < p->objects; o++)
        objects[o].first_shape = objects[o - 1].first_shape + objects[o - 1].shape_count;
    const struct object *last = &objects[p->objects - 1];
    size_t *next = mem_alloc(p->objects, sizeof *next);
    for (size_t o = 0; o < p->objects; o++)
        next[o] = objects[o].first_shape;
    p->out_count = last->first_shape + last->shape_count;
    p->out = mem_resize(p->out, p->out_count + 1, sizeof *p->out);
    for (size_t i = 0; i < desc->shape_count; i++)
        if (desc->shapes[i].object > 0)
            p->out[next[desc->shapes[i].object]++] = desc->shapes[i];
    mem_free(next);
    mem_free(desc->shapes);
    desc->shapes = p->out;
    desc->shape_count = p->out_count;
    desc->shape_capacity = p->out_count;
    p->scene->objects = objects;
}

static void list_instances(struct placing *p)
{
    struct scene *scene = p->scene;
    size_t total = 0;
    for (size_t o = 1; o < p->objects; o++)
        if (scene->objects[o].shape_count > 0)
            total += p->placed[o].count;
    scene->instances = mem_alloc(total + 1, sizeof *scene->instances);
    for (size_t o = 1; o < p->objects; o++)
        for (size_t w = 0; scene->objects[o].shape_count && w < p->placed[o].count; w++) {
            const struct placed *way = &p->placed[o].list[w];
            if (way->shared)
                instance_init(&scene->instances[scene->instance_count++], (int)o,
                              &way->to_world, way->place);
        }
}

static void placing_deinit(struct placing *p)
{
    for (size_t o = 0; p->placed && o < p->objects; o++)
        mem_free(p->placed[o].list);
    mem_free(p->placed);
    mem_free(p->first);
    mem_free(p->child);
    mem_free(p->order);
    mem_free(p->ways);
}

static bool is_sharing(const struct placing *p, enum scene_instances instances)
{
    double triangles = 0.0;
    for (size_t i = 0; i < p->desc->shape_count; i++) {
        const struct shape_desc *shape = &p->desc->shapes[i];
        double one = 16.0 + (shape->mesh ? shape->mesh->triangle_count : 0.0);
        if (shape->object > 0)
            triangles += one * (double)p->placed[shape->object].count;
    }
    return instances == INSTANCES_SHARED ||
           (instances == INSTANCES_AUTO && triangles > PLACEMENT_COPIES);
}

static void share_objects(struct placing *p, enum scene_instances instances)
{
    bool sharing = is_sharing(p, instances);
    for (size_t o = 1; o < p->objects; o++)
        for (size_t w = 0; w < p->placed[o].count; w++)
            p->placed[o].list[w].shared = sharing && p->placed[o].count > 1 &&
                                          instance_fits(&p->placed[o].list[w].to_world);
}

bool placement_resolve(struct scene *scene, const struct scene_options *options,
                       struct err *err)
{
    struct scene_desc *desc = scene->desc;
    struct placing p = {
        .scene = scene, .desc = desc, .objects = (size_t)desc->object_count + 1};
    scene->object_count = desc->object_count + 1;
    if (!check_instances(desc, err))
        return false;
    if (desc->object_count == 0) {
        scene->objects = mem_alloc(1, sizeof *scene->objects);
        scene->objects[0].shape_count = desc->shape_count;
        return true;
    }
    list_children(&p);
    bool good = sort_objects(&p, err) && count_ways(&p, err);
    if (good) {
        multiply_out(&p);
        share_objects(&p, options->instances);
    }
    good = good && check_copies(&p, err);
    if (good) {
        sort_shapes(&p);
        list_instances(&p);
    }
    placing_deinit(&p);
    return good;
}

void placement_bound(struct scene *scene)
{
    size_t at = 0;
    for (int o = 1; o < scene->object_count; o++) {
        float lower[3] = {INFINITY, INFINITY, INFINITY};
        float upper[3] = {-INFINITY, -INFINITY, -INFINITY};
        const struct object *object = &scene->objects[o];
        for (size_t i = 0; i < object->shape_count; i++) {
            size_t id = object->first_shape + i;
            float box[2][3];
            shape_bounds(&scene->shapes[id], scene->desc->shapes[id].mesh, box[0],
                         box[1]);
            for (int k = 0; k < 3; k++) {
                lower[k] = fminf(lower[k], box[0][k]);
                upper[k] = fmaxf(upper[k], box[1][k]);
            }
        }
        for (; at < scene->instance_count && scene->instances[at].object == o; at++)
            instance_bound(&scene->instances[at], lower, upper);
    }
}
