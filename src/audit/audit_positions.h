/* audit_positions.h - where switches stand, against what controls them. Private to src/audit. */
#ifndef DALCS_AUDIT_POSITIONS_H
#define DALCS_AUDIT_POSITIONS_H

#include "audit_internal.h"

/* What controls a switch, less its threshold, and half the width of its hysteresis. */
double audit_control(const struct dalcs_audit *audit, const struct dalcs_audit_state *s, int device,
                     double *half_width);

/* ... and what it is held to, in V or A. */
double audit_control_scale(const struct dalcs_audit *audit, const struct audit_part *part,
                           int device);

/* How far a control moves while times cannot be told apart, at a state that can be read. */
double audit_control_slack(struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, int device);

/* parts.c: is it a switch with hysteresis? */
bool audit_remembers(const struct dalcs_circuit *circuit, int device);

/* parts.c: do sources alone decide what controls a switch? Not of one whose valve may open it. */
static inline bool audit_is_commanded(const struct dalcs_audit *audit, int switch_device) {
    const struct dalcs_device *d = &audit->circuit->device[switch_device];
    return d->control < 0 && d->valve < 0 && audit->net.is_held[d->node[2]] &&
           audit->net.is_held[d->node[3]];
}

/* changes.c: does a switch with hysteresis stand on another side than in the stretch before? Screens tell no change within
 * a hysteresis. key: of its polynomials, the same only in the same mode; 0: there are none. */
bool audit_latches_turn(struct dalcs_audit *audit, struct audit_part *part, uint64_t key);

/* One position of a switch has been compared with its control. */
static inline void audit_count_position(struct dalcs_audit *audit, const struct audit_part *part) {
    audit->count.positions += part->at.is_coarse ? 0 : 1;
    audit->count.unjudged += part->at.is_coarse ? 1 : 0;
}

/* changes.c: at the end of a step of implicit Euler behind another one. Where no position agrees with its control a switch
 * may be late by a step: it goes to and fro. One that stays against it over two whole steps is wrong. */
void audit_check_obeyed(struct dalcs_audit *audit, struct audit_part *part,
                        const struct dalcs_audit_state *end);

/* At the end of a step of implicit Euler: a switch may stand as it was commanded until the next step, but a jump of a
 * formula is a function of its argument and has no command. */
void audit_check_commutators(struct dalcs_audit *audit, struct audit_part *part,
                             const struct dalcs_audit_state *end);

/* changes.c: those of them that have turned, where the stretch begins. */
void audit_check_turns(struct dalcs_audit *audit, const struct audit_part *part, double t);

/* changes.c: switches that are on other sides. */
void audit_check_changes(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after);

#endif
