#ifndef ETALON_MATH_BETA_H
#define ETALON_MATH_BETA_H

/* The regularised incomplete beta function I_x(a,b), a, b > 0, from which the tails of
 * Student's t and of F follow. y = 1 - x is given apart, so that neither end loses
 * digits. Relative error below 1e-10 for a, b up to 10^4. */
double beta_regularised(double a, double b, double x, double y);
/* ln Gamma(x), x > 0, safe on several threads at once. */
double beta_log_gamma(double x);

#endif
