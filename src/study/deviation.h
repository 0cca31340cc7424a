/* deviation.h - how far waveforms are from the reference. */
#ifndef DALCS_DEVIATION_H
#define DALCS_DEVIATION_H

#include "reference.h"

struct dalcs_deviation {
    double *rms, *largest; /* [n_signals] over the measured times, over the signal's scale */
    double worst_rms, worst_largest; /* of all signals that the circuit determines */
    size_t worst;                    /* the signal with the worst rms */
};

/* value[n_times * n_signals] as in the reference's samples. A value that is not finite is an infinite
 * error. */
enum dalcs_status dalcs_deviation_measure(struct dalcs_deviation *deviation,
                                          const struct dalcs_reference *reference,
                                          const double *value) DALCS_MUST_CHECK;

/* Accepts a zeroed one. */
void dalcs_deviation_finish(struct dalcs_deviation *deviation);

#endif
