/* audit_currents.h - how well currents and the sources beside them are known. */
#ifndef DALCS_AUDIT_CURRENTS_H
#define DALCS_AUDIT_CURRENTS_H

#include "audit_internal.h"

/* laws.c: what rounding of the voltages at a resistor makes of its current, where that is made of them, and that of a current
 * itself. */
double audit_current_rounding(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                              int device);

/* ... the largest voltage along a resistor whose current is told, and what rounding of the voltages at its ends makes of it. That
 * of an ammeter is far below these: held to them, two beside each other could share their current in any way. */
struct audit_number audit_drop(const struct dalcs_audit *audit, const struct audit_part *part,
                               int device);

/* kirchhoff.c: how far the sources that hold the ends of a device move while times cannot be told apart. */
double audit_sources_move(struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *s, const struct dalcs_device *d);

#endif
