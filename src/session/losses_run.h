/* losses_run.h - the losses of a transient while it runs, and into the report. */
#ifndef DALCS_SESSION_LOSSES_H
#define DALCS_SESSION_LOSSES_H

#include "audit_losses.h"
#include "device_map.h"
#include "losses_sum.h"
#include "session_internal.h"

/* Zero-initialise; without a start nothing is summed and nothing costs anything. */
struct dalcs_losses_run {
    bool wanted;
    struct dalcs_losses_sum sum;
    const struct dalcs_euler *engine;

    struct dalcs_loss_pair {
        int system, pair;
    } * forward; /* [n_devices] the pair of a switch or diode; system -1: none */

    struct dalcs_device_map devices;
    const struct dalcs_network *network;
    bool *on;   /* [n_devices] */
    bool *slid; /* [n_devices] has a switch or diode turned in a slide within the window? */
    bool is_euler;
    struct dalcs_audit_losses audit;
};

static inline bool dalcs_run_wants_losses(const struct dalcs_run *r) {
    return r->s->circuit.results.losses != NULL && r->s->circuit.results.losses->present;
}

/* Before the start of a transient; `near`: s, times that are the same. */
enum dalcs_status dalcs_losses_run_start(struct dalcs_losses_run *losses, struct dalcs_run *r,
                                         const struct dalcs_euler *e, bool is_euler,
                                         double near) DALCS_MUST_CHECK;
/* s: stretches are wanted from here on, so that one ends where the window begins. */
double dalcs_losses_run_begin(const struct dalcs_losses_run *losses);

void dalcs_losses_run_finish(struct dalcs_losses_run *losses);

/* Before an edge at the start: the sides of all there. */
void dalcs_losses_run_before_start(struct dalcs_losses_run *losses);

/* A jump that is told of. */
enum dalcs_status dalcs_losses_run_jump(struct dalcs_losses_run *losses,
                                        const struct dalcs_euler_jump *jump) DALCS_MUST_CHECK;

/* The stretch is filled and expanded; the engine is in the mode of it. */
void dalcs_losses_run_stretch(struct dalcs_losses_run *losses, const struct dalcs_stretch *stretch);

/* After a run that came to its end. */
enum dalcs_status dalcs_losses_run_report(struct dalcs_losses_run *losses,
                                          struct dalcs_run *r) DALCS_MUST_CHECK;

#endif
