#ifndef ETALON_IMAGE_FLIP_COLOUR_H
#define ETALON_IMAGE_FLIP_COLOUR_H

/* The colours in which FLIP compares [Andersson20]. rgb: linear Rec. 709. */

/* YCxCz, in which the eye's contrast sensitivity is known. */
void flip_opponent(const double rgb[3], double out[3]);

/* The way back, to what a screen shows of it, clamped to [0,1]. */
struct flip_screen {
    double from_xyz[3][3], white[3];
};
void flip_screen_init(struct flip_screen *screen);
void flip_screen_rgb(const struct flip_screen *screen, const double opponent[3],
                     double rgb[3]);

/* L*a*b* with the chroma times .01 L*: a difference in colour is seen less where it is
 * dark. */
void flip_hunt(const double rgb[3], double out[3]);
/* HyAB distance of two such colours. */
double flip_distance(const double a[3], const double b[3]);

#endif
