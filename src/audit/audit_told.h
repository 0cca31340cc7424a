/* audit_told.h - what is told of an instant, against the states on both sides of it. */
#ifndef DALCS_AUDIT_TOLD_H
#define DALCS_AUDIT_TOLD_H

#include "claims.h"

/* The states that the checks below compare: where the part's segment ended (is_same: it did not, and went on), and where
 * the present one has begun. */
void dalcs_audit_look_before(struct dalcs_audit *audit, int part, bool is_same);
void dalcs_audit_look_behind(struct dalcs_audit *audit, int part, double t);

/* Told of a switch or a diode: it is on, or off, at the time that was looked at behind. */
void dalcs_audit_check_event(struct dalcs_audit *audit, int device, bool is_on, double t);

/* Told of a capacitor (V) or a coil (A) in a jump of its part; what is not known is not asked. */
struct dalcs_audit_jump {
    int device;
    double before, after;
    bool knows_before, knows_after;
    bool is_alone;      /* no other jump was at that time: */
    double energy_lost; /* J, by all that the part stores */
};

void dalcs_audit_check_told_jump(struct dalcs_audit *audit, int part,
                                 const struct dalcs_audit_jump *jump, double t);

#endif
