/* source_conflicts.h - loops of voltage sources and cutsets of current sources, before any number. */
#ifndef DALCS_SOURCE_CONFLICTS_H
#define DALCS_SOURCE_CONFLICTS_H

#include "circuit.h"

/* Loops of V sources and shorts, and parts that only I sources reach. Where the sources contradict each
 * other at all times: DALCS_E_NETLIST and an error for each. Where they agree at all times, what is not
 * determined is said in a warning. All else, as where a sine meets a battery, is left to the run. */
enum dalcs_status dalcs_source_conflicts(const struct dalcs_circuit *circuit,
                                         struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
