/* source_conflicts.h - loops of voltage sources and cutsets of current sources, before any number. */
#ifndef DALCS_SOURCE_CONFLICTS_H
#define DALCS_SOURCE_CONFLICTS_H

#include "circuit.h"

/* Loops of V sources and shorts, and parts that only I sources reach. Where the sources contradict each
 * other at all times: DALCS_E_NETLIST and an error for each. Where they agree at all times, a warning
 * names the one that is idle. Other conflicts, such as a sine in parallel with a battery, are found by the run. */
enum dalcs_status dalcs_source_conflicts(const struct dalcs_circuit *circuit,
                                         struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* idle[n_devices], zeroed by the caller: V sources, and shorts whose current wants_current[n_devices],
 * that close a loop of such elements whose voltages agree at all times. */
enum dalcs_status dalcs_source_mark_idle(const struct dalcs_circuit *circuit,
                                         const bool *wants_current, bool *idle) DALCS_MUST_CHECK;

#endif
