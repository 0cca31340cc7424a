/* audit_held.h - what laws are held to: scales, and what rounding and leaks explain. */
#ifndef DALCS_AUDIT_HELD_H
#define DALCS_AUDIT_HELD_H

#include "audit_internal.h"

/* kirchhoff.c: A that the current of a branch is held to. */
double audit_branch_amperes(const struct dalcs_audit *audit, const struct audit_part *part,
                            int device);

/* ... of a state: audit->sums.largest_volt. */
void audit_see_volts(struct dalcs_audit *audit, const struct audit_part *part,
                     const struct dalcs_audit_state *s);

/* ... what rounding of these voltages makes of the current of a branch, in A. */
double audit_branch_rounding(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                             int device, double current);

/* S, of a resistor, or a switch or diode that conducts; 0: it is ideal, does not, or is something else. */
double audit_conductance(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                         int device);

/* ... and what all nodes that ideal branches join with one have of that. Overwrites audit->crossing.cluster. */
double audit_rounding_around(struct dalcs_audit *audit, const struct audit_part *part,
                             const struct dalcs_audit_state *s, int node);

/* ... and what a current of any node may have, in A, where one cannot be told from rounding. */
double audit_rounding_of_part(struct dalcs_audit *audit, const struct audit_part *part,
                              const struct dalcs_audit_state *s);

/* V and A that the two branches of a diode are held to. */
void audit_diode_scale(const struct dalcs_audit *audit, const struct audit_part *part, int device,
                       double scale[2]);

/* Wb: what the currents that make a coil's flux are held to. */
double audit_flux_scale(const struct dalcs_audit *audit, const struct audit_part *part, int device);

/* leaks.c: A that a coil's current may be off by, as leaks alone feed it; 0: they do not, or a step follows them. */
double audit_leak_of(const struct dalcs_audit *audit, const struct audit_part *part,
                     const struct dalcs_audit_state *s, int coil);
/* ... of all coils at a node. */
double audit_leaks_at(const struct dalcs_audit *audit, const struct audit_part *part,
                      const struct dalcs_audit_state *s, int node);

/* intervals.c: is a law of charge, flux or energy over an interval, or over none? Its scale is of that, too, and this is what
 * it is with the largest values so far. */
bool audit_is_of_storage(const struct dalcs_audit *audit, enum dalcs_audit_law law, int index);
double audit_storage_scale(const struct dalcs_audit *audit, const struct audit_part *part,
                           enum dalcs_audit_law law, int index, double duration);

#endif
