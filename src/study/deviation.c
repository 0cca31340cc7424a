/* deviation.c - rms and largest error by signal. */
#include "deviation.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>

enum dalcs_status dalcs_deviation_measure(struct dalcs_deviation *d,
                                          const struct dalcs_reference *reference,
                                          const double *value) {
    size_t n = reference->n_signals;
    *d = (struct dalcs_deviation){.rms = dalcs_alloc(n, sizeof *d->rms),
                                  .largest = dalcs_alloc(n, sizeof *d->largest)};
    if (!d->rms || !d->largest) {
        dalcs_deviation_finish(d);
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < reference->times.n; i++) {
        for (size_t s = 0; s < n && reference->times.is_measured[i]; s++) {
            double error = fabs(value[i * n + s] - reference->samples.value[i * n + s]);
            error = isfinite(error) ? error / reference->scale[s] : INFINITY;
            d->rms[s] += error * error;
            d->largest[s] = fmax(d->largest[s], error);
        }
    }
    for (size_t s = 0; s < n; s++) {
        d->rms[s] = reference->times.n_measured > 0
                        ? sqrt(d->rms[s] / (double)reference->times.n_measured)
                        : 0.0;
        if (!reference->is_open[s]) {
            d->worst = d->rms[s] > d->worst_rms ? s : d->worst;
            d->worst_rms = fmax(d->worst_rms, d->rms[s]);
            d->worst_largest = fmax(d->worst_largest, d->largest[s]);
        }
    }
    return DALCS_OK;
}

void dalcs_deviation_finish(struct dalcs_deviation *d) {
    free(d->rms);
    free(d->largest);
    *d = (struct dalcs_deviation){0};
}
