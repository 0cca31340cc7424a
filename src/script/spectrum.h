/* spectrum.h - discrete Fourier transforms of any length, and the windows before them. */
#ifndef DALCS_SPECTRUM_H
#define DALCS_SPECTRUM_H

#include "memory.h"

#include <complex.h>
#include <stdbool.h>

/* "none" and "rectangular", "hanning" ("hann", "cosine"), "hamming", "blackman", "blackmanharris", "flattop",
 * "triangle" ("bartlett"), "gaussian" of an order. weight[n] has a mean of 1 and is periodic: the value that
 * would follow the last one is the first. false: there is no such window. */
bool dalcs_spectrum_window(const char *name, int order, double *weight, size_t n);

/* to[k] = sum of x[j] exp(-2 pi i j k/n), for k < n; by a fast transform of a power of 2, and for other n by
 * Bluestein's convolution of three of these. */
enum dalcs_status dalcs_spectrum_transform(double complex *to, const double *x,
                                           size_t n) DALCS_MUST_CHECK;

#endif
