/* measures_impulses.c - the impulses of measured signals. */
#include "measures.h"

#include <math.h>

bool dalcs_measures_find_impulses(struct dalcs_measures *measures, double t) {
    struct dalcs_measuring *m = &measures->measuring;
    const struct dalcs_circuit_results *results = &m->circuit->results;
    if (measures->impulses == NULL || !dalcs_impulses_at(measures->impulses, t)) {
        return false;
    }
    for (int k = 0; k < results->n_measured; k++) {
        m->impulse[k] =
            dalcs_impulses_of(measures->impulses, &results->signal[results->measured[k]]);
        m->row[k] =
            dalcs_impulses_change(measures->impulses, &results->signal[results->measured[k]]);
    }
    return true;
}

bool dalcs_measures_find_blurred(struct dalcs_measures *measures) {
    struct dalcs_measuring *m = &measures->measuring;
    struct dalcs_impulses *impulses = measures->impulses;
    if (impulses == NULL || !impulses->is_noted ||
        !dalcs_measures_find_impulses(measures, impulses->time)) {
        return false;
    }
    for (int k = 0; k < m->circuit->results.n_measured; k++) {
        m->impulse[k] = m->impulse[k] != 0.0 ? (double)NAN : 0.0;
    }
    return true;
}
