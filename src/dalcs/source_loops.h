/* source_loops.h - loops of V sources and shorts. Private to src/dalcs. */
#ifndef DALCS_SOURCE_LOOPS_H
#define DALCS_SOURCE_LOOPS_H

#include "circuit.h"

enum dalcs_status dalcs_source_loops_check(const struct dalcs_circuit *c, struct dalcs_arena *arena,
                                           struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
