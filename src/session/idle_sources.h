/* idle_sources.h - V sources that carry nothing, as they agree with others in a loop: is that so with other values? */
#ifndef DALCS_IDLE_SOURCES_H
#define DALCS_IDLE_SOURCES_H

#include "circuit.h"

struct dalcs_idle_sources {
    bool *was, *is; /* [n_devices], heap; NULL: there are none */
};

/* Those of the circuit with its present values. */
enum dalcs_status dalcs_idle_sources_find(struct dalcs_idle_sources *idle,
                                          const struct dalcs_circuit *circuit) DALCS_MUST_CHECK;

/* Are others idle with the values that the circuit has now? Then a network of its own answers these. */
enum dalcs_status dalcs_idle_sources_compare(const struct dalcs_idle_sources *idle,
                                             const struct dalcs_circuit *circuit,
                                             bool *differ) DALCS_MUST_CHECK;

void dalcs_idle_sources_finish(struct dalcs_idle_sources *idle);

#endif
