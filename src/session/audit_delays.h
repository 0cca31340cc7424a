/* audit_delays.h - what delayed sources put out, against what their signals were: by samples of its own. */
#ifndef DALCS_AUDIT_DELAYS_H
#define DALCS_AUDIT_DELAYS_H

#include "audit.h"
#include "radau.h"

struct dalcs_audit_delays {
    const struct dalcs_circuit *circuit;
    struct dalcs_radau *radau;
    const struct dalcs_readout *readout;
    struct audit_delay *delay; /* [n_delayed]; NULL: there are none */
};

/* Does nothing where the circuit has no delayed sources. */
enum dalcs_status dalcs_audit_delays_start(struct dalcs_audit_delays *a,
                                           const struct dalcs_circuit *circuit,
                                           struct dalcs_radau *radau,
                                           const struct dalcs_readout *readout) DALCS_MUST_CHECK;
void dalcs_audit_delays_finish(struct dalcs_audit_delays *a);

/* The part's present segment ends at `to`: samples that are due in it are compared, and, where `samples`, one is taken at
 * the fraction `at` of it. Findings go to audit. */
enum dalcs_status dalcs_audit_delays_leave(struct dalcs_audit_delays *a, struct dalcs_audit *audit,
                                           int part, double to, bool samples,
                                           double at) DALCS_MUST_CHECK;

#endif
