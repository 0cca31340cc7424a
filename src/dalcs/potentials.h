/* potentials.h - voltages that sources alone fix. Private to src/dalcs. */
#ifndef DALCS_POTENTIALS_H
#define DALCS_POTENTIALS_H

#include "topology.h"

enum dalcs_status dalcs_commanding_potentials_find(struct dalcs_topology *t,
                                                   const struct dalcs_circuit *c) DALCS_MUST_CHECK;

#endif
