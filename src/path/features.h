#ifndef ETALON_PATH_FEATURES_H
#define ETALON_PATH_FEATURES_H

/* What a denoiser asks for beside a picture: the colour and the direction of surfaces, in
 * the camera's pixels, without any light. As the guide of Open Image Denoise advises,
 * albedo and normal are those of the first surface that is not a mirror or clear glass:
 * the camera's path is followed through delta lobes, FEATURES_EDGES edges at most, and
 * the albedo is multiplied by what these let pass. The depth is that of the first surface
 * of all. */

#include "image/layers.h"
#include "scene/scene.h"

#define FEATURES_SIDE  4 /* side of the grid of camera paths in a pixel */
#define FEATURES_EDGES 9

/* Adds the layers, means over FEATURES_SIDE^2 camera paths, one at random in each cell of
 * the pixel, through random points of the lens; numbers come from the seed and the pixel
 * alone:
 *   albedo.R, .G, .B  in [0,1], the share of light from the camera's direction that the
 *                     surface reflects or transmits, by one sample of the BSDF a path; 1
 *                     where a lamp is black otherwise; 0 without a surface
 *   normal.X, .Y, .Z  of length 1 or less, in the scene's space, shading normals towards
 *                     the camera's side; 0 without a surface
 *   depth.Z           distance from the lens to the first surface, scene units, over the
 *                     paths that meet one; 0 if none does */
void features_add(const struct scene *scene, uint64_t seed, int threads,
                  struct layers *layers);

#endif
