/* source_products.h - integrals over time of products of sources, in closed form from edge to edge.
 *
 * Where sources alone decide voltages and currents, no step follows them, and their energies are such
 * integrals: exact for any frequency, and no dearer for a high one. */
#ifndef DALCS_SOURCE_PRODUCTS_H
#define DALCS_SOURCE_PRODUCTS_H

#include "stimulus.h"

/* integral[n][n] of stimulus[i] stimulus[j] from 0 to stop (s), symmetric. */
void dalcs_source_products(
    int n, const struct dalcs_stimulus *const *stimulus, double stop,
    struct dalcs_stimulus_piece *piece /* work [n], each with room for its terms */,
    double *integral);

#endif
