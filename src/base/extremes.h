/* extremes.h - the smaller and the larger of two numbers, inline: fmin and fmax are calls, for the sake
 * of NaN, which these do not heed. */
#ifndef DALCS_EXTREMES_H
#define DALCS_EXTREMES_H

static inline double dalcs_smaller(double a, double b) {
    return a < b ? a : b;
}

static inline double dalcs_larger(double a, double b) {
    return a > b ? a : b;
}

#endif
