/* audit_losses.h - .losses, looked on by the auditor: what a stretch adds to a device's sums, and what is told of it. */
#ifndef DALCS_AUDIT_LOSSES_H
#define DALCS_AUDIT_LOSSES_H

#include "losses_sum.h"

struct dalcs_audit_run;
struct dalcs_element_losses;

/* Zero-initialise. */
struct dalcs_audit_losses {
    struct dalcs_audit_run *run; /* NULL: no audit */
    int n_looked;                /* devices that were looked at, one after the other at first */
    int device;                  /* that is looked at in this stretch; -1: none */
    struct dalcs_loss before;    /* of it */
    double credit, threshold;    /* instructions */
};

/* Around a stretch. */
void dalcs_audit_losses_begin(struct dalcs_audit_losses *a, const struct dalcs_losses_sum *sum,
                              const struct dalcs_stretch *stretch);
void dalcs_audit_losses_end(struct dalcs_audit_losses *a, const struct dalcs_losses_sum *sum,
                            const struct dalcs_stretch *stretch);

/* The values of device k. */
void dalcs_audit_losses_told(const struct dalcs_audit_losses *a, const struct dalcs_losses_sum *sum,
                             int k, const struct dalcs_element_losses *told);

/* The laws that bind those of all that are told of, in their order; work[2 * n_nodes] is 0. */
void dalcs_audit_losses_laws(const struct dalcs_audit_losses *a, const struct dalcs_losses_sum *sum,
                             const struct dalcs_element_losses *told, double *work);

#endif
