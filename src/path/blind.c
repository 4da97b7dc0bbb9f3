#include "path/blind.h"

#include <assert.h>
#include <stdio.h>

/* Paths LS... have no LD. The first two families have neither DD nor DE; of the others,
 * those that end in DE are sampled by t = 1 and the rest by DD alone. */
static const struct blind_family families[BLIND_FAMILIES] = {
    {"LE", "the lights themselves, out of focus", 1, true, false, false, 0},
    {"LS+E", "their images in mirrors and glass", 2, false, true, false, 0},
    {"LS+(DS+)+E", "caustics seen in mirrors and through glass", 4, false, true, true, 0},
    {"LS(S|D)*DE", "caustics, light through glass", 3, false, true, true,
     TECHNIQUE_CAMERA},
    {"LS(S|D)*DD(S|D)*SE", "what these light, seen in mirrors and through glass", 5,
     false, true, true, TECHNIQUE_SURFACES},
};

int blind_find(const struct needs *needs, unsigned techniques, int max_depth,
               const struct blind_family *found[BLIND_FAMILIES])
{
    int count = 0;
    assert((techniques & TECHNIQUES_PT) == TECHNIQUES_PT);
    assert(!(techniques & TECHNIQUE_SURFACES) || techniques & TECHNIQUE_CAMERA);
    if (!needs->point_lights && !needs->distant_lights)
        return 0;
    for (int i = 0; i < BLIND_FAMILIES; i++) {
        const struct blind_family *f = &families[i];
        bool there = f->edges <= max_depth && (!f->lens || needs->lens) &&
                     (!f->specular || needs->delta_bsdfs) &&
                     (!f->rough || needs->rough_bsdfs);
        if (there && !(f->seen_by & techniques))
            found[count++] = f;
    }
    return count;
}

void blind_text(const struct needs *needs, unsigned techniques, int max_depth,
                char text[BLIND_TEXT])
{
    const struct blind_family *found[BLIND_FAMILIES];
    int count = blind_find(needs, techniques, max_depth, found), used = 0;
    text[0] = '\0';
    for (int i = 0; i < count; i++)
        used += snprintf(text + used, (size_t)(BLIND_TEXT - used), "%s%s", i ? ", " : "",
                         found[i]->paths);
    assert(used < BLIND_TEXT);
}
