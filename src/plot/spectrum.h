/* spectrum.h - amplitudes over frequency of what is drawn over time. */
#ifndef DALCS_SPECTRUM_H
#define DALCS_SPECTRUM_H

#include "selection.h"

/* The Fourier coefficients of the selection's signals over its range T, at all multiples of 1 / T up to `highest` in Hz: the
 * magnitude of the mean, and amplitudes. Exact for straight lines between rows, whatever their distances. Makes a table
 * with a needle for each; finish it. Errors come with a message. */
enum dalcs_status dalcs_spectrum_make(struct dalcs_waveforms *spectrum,
                                      const struct dalcs_selection *selection, double highest,
                                      struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
