/* Light from infinity: v3's maps are over longitude and latitude, v4's over the unfolded
 * octahedron. */
#include "import/pbrt/pbrt_light.h"

#include "base/mem.h"
#include "import/pbrt/pbrt_colour.h"
#include "math/warp.h"

/* Illuminance of a patch that faces the map's +z, for a factor of 1. */
static double illuminance(const struct texture_image *map)
{
    double sum = 0.0, d[3];
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            double u[2] = {(x + 0.5) / map->width, (y + 0.5) / map->height};
            warp_octahedron(u, d);
            if (d[2] > 0.0)
                sum += d[2] * rgb_luminance(texture_image_texel(map, x, y));
        }
    return sum * 4.0 * MATH_PI / ((double)map->width * map->height);
}

bool pbrt_light_picture(struct pbrt *p, const struct pbrt_param *name,
                        const struct texture_image **image, struct err *err)
{
    struct err failure = {0};
    char *path = pbrt_path(p, pbrt_params_text(&p->params, name));
    *image = texture_image_load(&p->desc->textures, path, TEXTURE_AUTO, &name->place,
                                &p->desc->log, &failure);
    mem_free(path);
    if (*image || failure.code == ERR_NONE)
        return true;
    *err = failure;
    return false;
}

/* v4 wants a square; what is none can only be meant as v3's. */
static bool is_octahedral(struct pbrt *p, const struct texture_image *map,
                          const struct place *at)
{
    if (map->width == map->height)
        return true;
    log_note(&p->desc->log, at,
             "a map of %d x %d is read as longitude and latitude: pbrt v4's are square",
             map->width, map->height);
    return false;
}

bool pbrt_light_infinite(struct pbrt *p, struct err *err)
{
    struct light_desc light = {
        .type = &light_environment, .intensity = rgb_grey(1.0), .to_world = p->state.ctm};
    double unscaled = MATH_PI;
    if (!pbrt_colour_light(p, "L", &light.intensity, err))
        return false;
    if (pbrt_params_find(&p->params, "portal", PBRT_POINT))
        log_note(&p->desc->log, &p->params.place,
                 "the portal of a light is not used: all of its map shines");
    const struct pbrt_param *name = pbrt_params_find(&p->params, "mapname", PBRT_STRING);
    bool v4 = !name && (name = pbrt_params_find(&p->params, "filename", PBRT_STRING));
    if (name && !pbrt_light_picture(p, name, &light.map, err))
        return false;
    light.octahedral = v4 && light.map && is_octahedral(p, light.map, &name->place);
    if (light.octahedral)
        unscaled = illuminance(light.map);
    return pbrt_light_measure(p, "illuminance", unscaled, &light.intensity, err) &&
           pbrt_light_add(p, &light, err);
}
