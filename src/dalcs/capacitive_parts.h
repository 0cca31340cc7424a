/* capacitive_parts.h - what an operating point does not determine, before any number. */
#ifndef DALCS_CAPACITIVE_PARTS_H
#define DALCS_CAPACITIVE_PARTS_H

#include "circuit.h"

/* Notes the parts that only capacitors tie to the rest, where an operating point is asked for. */
enum dalcs_status dalcs_capacitive_parts_note(const struct dalcs_circuit *circuit,
                                              struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
