#include "import/instance.h"

void instance_place(struct scene_desc *desc, const struct shape_desc *part,
                    const struct xform *to_world, const struct place *at)
{
    struct shape_desc shape = *part;
    bool winding = part->mesh && !part->mesh->n;
    shape.reverse_orientation ^= winding && xform_swaps_handedness(to_world);
    shape.place = *at;
    if (part->mesh) {
        shape.mesh = mesh_copy(part->mesh);
        mesh_transform(shape.mesh, to_world);
    } else {
        shape.to_world = xform_mul(to_world, &part->to_world);
    }
    scene_desc_add_shape(desc, &shape);
}
