#ifndef ETALON_MATH_BOX_BLUR_H
#define ETALON_MATH_BOX_BLUR_H

/* Replaces each of [height][width] values, none below 0, by the mean over the square of
 * 2 radius + 1 values a side around it, as far as that lies within the array. */
void box_blur(double *values, int width, int height, int radius);

#endif
