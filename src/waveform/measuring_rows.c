/* measuring_rows.c - what is between two rows of a sweep. */
#include "measuring_rows.h"

#include <complex.h>
#include <math.h>

/* Between two frequencies: a line over the logarithm of the frequency, in decibels and in phase. So each power of the
 * frequency is exact, where a chord of complex values is too small by far. Through 0, and around it by more than a right
 * angle, there is no such line: a chord. x: from 0 at a to 1 at b over the frequency; log_x: over its logarithm. */
static double complex between(double complex a, double complex b, double x, double log_x) {
    const bool turns = creal(a * conj(b)) <= 0.0;
    return turns ? a + x * (b - a) : a * cexp(log_x * clog(b / a));
}

void dalcs_measuring_fill_stretch(struct dalcs_measuring *m, double at, const double *re,
                                  const double *im) {
    struct dalcs_stretch *s = &m->stretch;
    const double first = (s->from - m->row_at) / (at - m->row_at);
    const double last = (s->to - m->row_at) / (at - m->row_at);
    double imaginary[DALCS_STRETCH_NODES];
    for (int k = 0; k < s->n_signals; k++) {
        for (int i = 0; i < DALCS_STRETCH_NODES; i++) {
            const double x = first + 0.5 * (1.0 + m->rule.node[i]) * (last - first);
            s->value[k][i] = m->row[k] + x * (re[k] - m->row[k]);
            if (s->imaginary != NULL) {
                const double ratio = m->row_at > 0.0 ? (at - m->row_at) / m->row_at : 0.0;
                const double log_x = ratio > 0.0 ? log1p(x * ratio) / log1p(ratio) : x;
                const double complex value =
                    between(m->row[k] + I * m->row_imaginary[k], re[k] + I * im[k], x, log_x);
                s->value[k][i] = creal(value);
                imaginary[i] = cimag(value);
            }
        }
        if (s->imaginary != NULL) {
            dalcs_stretch_expand(&m->rule, imaginary, s->imaginary[k]);
        }
    }
}
