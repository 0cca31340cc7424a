/* audit_crossing.h - what holds from one side of an event to the other: who is joined while it takes place, and what charge and
 * flux may do. */
#ifndef DALCS_AUDIT_CROSSING_H
#define DALCS_AUDIT_CROSSING_H

#include "audit_internal.h"

/* Does a device join its two nodes, from one state to another in no time? */
typedef bool audit_joins(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after, int device);

/* crossing.c: of the nodes of a part, into audit->crossing.cluster. */
void audit_find_clusters(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after, audit_joins *join);
audit_joins audit_passes_charge;

/* positions_between.c: the positions, open and closed, that a switch may have while states jump. */
void audit_find_positions(const struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *before,
                          const struct dalcs_audit_state *after, int device, bool may_be[2]);

/* crossing.c: how charge may pass through a branch while an event takes place; from its first node to its second is
 * forward. */
enum { AUDIT_FORWARD = 1, AUDIT_BACKWARD = 2 };

int audit_ways_of_charge(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after, int device);

/* crossing.c: what the first plate of a capacitor gained across an event, and what that is held to. */
double audit_charge_gained(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *after, int device, double *scale);

/* Is a node of a device among those that `root` names? */
typedef bool audit_has_node(const struct dalcs_audit *audit, int node, int root);
bool audit_is_in_cluster(const struct dalcs_audit *audit, int node, int root);

/* What hangs on such nodes: all capacitances, and the largest conductance. */
struct audit_hanging {
    double farad, siemens;
};
struct audit_hanging audit_find_hanging(const struct dalcs_audit *audit,
                                        const struct audit_part *part,
                                        const struct dalcs_audit_state *at, audit_has_node *has,
                                        int root);

/* S: the largest conductance that a coil with so many H follows within the present step, or the least one. */
double audit_find_damping(const struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *at, double henry);

/* C, what that conductance moves in a time that the run does not resolve: an event is no better known. */
double audit_charge_unresolved(const struct dalcs_audit *audit, const struct audit_part *part,
                               const struct dalcs_audit_state *after, audit_has_node *has,
                               int root);

/* directions.c: where diodes let it pass one way only. */
void audit_check_directions(struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_audit_state *before,
                            const struct dalcs_audit_state *after);

/* fluxes.c: fluxes of coils, and the way that diodes let them pass. */
void audit_check_fluxes(struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *before,
                        const struct dalcs_audit_state *after);

/* corners.c: from here on, until audit->crossing.corners.later is NULL, corners are as wide as they are known. */
void audit_widen_corners(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *after);
double audit_volts_off_corner(const struct dalcs_audit *audit,
                              const struct dalcs_audit_state *after, int device);
double audit_amperes_off_corner(const struct dalcs_audit *audit,
                                const struct dalcs_audit_state *after, int device);

/* impulses.c: nodes whose potential may be an impulse, as what reads a current that is one makes it. */
void audit_find_impulses(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after);

void audit_forget_impulses(struct dalcs_audit *audit, const struct audit_part *part);

/* Is such a node at one of its ends, or in what controls it? */
bool audit_has_impulse(const struct dalcs_audit *audit, const struct dalcs_device *d);

/* crossing.c: charges and fluxes, from audit->crossing.stored on. `before` is `after` where nothing else was before. */
void audit_check_jump(struct dalcs_audit *audit, const struct audit_part *part,
                      const struct dalcs_audit_state *before,
                      const struct dalcs_audit_state *after);

/* crossing.c: what holds from one side of an event to the other. */
void audit_check_crossing(struct dalcs_audit *audit, struct audit_part *part,
                          const struct dalcs_audit_state *before,
                          const struct dalcs_audit_state *after);

#endif
