#ifndef ETALON_PATH_COVERAGE_H
#define ETALON_PATH_COVERAGE_H

/* Alpha of a picture without the emitters that the camera sees directly
 * (scene.hide_emitters): how much of a pixel shows surfaces, so that the picture, whose
 * colours are premultiplied by it, can be laid over another. */

#include "scene/scene.h"

/* Side of the grid of camera rays in a pixel. */
#define COVERAGE_SIDE 4

/* alpha: [height][width]. The mean over COVERAGE_SIDE^2 camera rays, one at random in
 * each cell of the pixel, through random points of the lens, of 1 - T: T is the luminance
 * of the transmittance of all that a ray passes straight through before it leaves the
 * scene or meets the shining side of a lamp, and 0 if it ends on another surface. Numbers
 * come from the seed and the pixel alone. */
void coverage_picture(const struct scene *scene, uint64_t seed, int threads,
                      float *alpha);

#endif
