#ifndef ETALON_MATH_STUDENT_H
#define ETALON_MATH_STUDENT_H

/* Student's t distribution, by the incomplete beta function (math/beta.h). freedom > 0 is
 * its number of degrees of freedom; INFINITY is the standard normal distribution. NaN in,
 * NaN out. */

/* P(T > t); relative error below 1e-10 up to 10^4 degrees of freedom. */
double student_tail(double t, double freedom);
/* t with P(T <= t) = p; -INFINITY and INFINITY at 0 and 1, NaN outside [0,1]. */
double student_quantile(double p, double freedom);
/* Degrees of freedom of an estimate V of a variance whose own variance is `spread`:
 * chi-squared with its mean and variance, 2 V^2 / spread [Satterthwaite46]. Of a sum of
 * independent estimates v_i with f_i degrees, spread is the sum of 2 v_i^2 / f_i. */
double student_freedom(double variance, double spread);

#endif
