#ifndef ETALON_MATH_LAW_H
#define ETALON_MATH_LAW_H

/* The normal and the F distribution, for tests and error bars; Student's t is in
 * math/student.h. */

/* x with P(X <= x) = p of the standard normal law; p in (0,1). To a few units in the last
 * place. */
double law_normal_quantile(double p);
/* P(X > x) of the F law with these degrees of freedom, each > 0; 1 for x <= 0. Relative
 * error 1e-10. */
double law_f_upper(double x, double above, double below);

#endif
