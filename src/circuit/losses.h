/* losses.h - the contents of .losses and .switchloss. */
#ifndef DALCS_LOSSES_CARD_H
#define DALCS_LOSSES_CARD_H

#include "diag.h"

/* J at one turning on or off of a switch or diode, over voltage and current. */
struct dalcs_loss_table {
    bool is_off;
    int n_v, n_i;
    const double *v, *i; /* [n_v] V, [n_i] A; ascending */
    const double *e;     /* [n_v * n_i] all currents of the first voltage come first */
    struct dalcs_location where;
};

struct dalcs_losses_card {
    bool present;
    double from, to; /* s; INFINITY: the end of the run */
    int n_in, n_out;
    int *in, *out; /* devices that are named */

    struct dalcs_loss_device {
        int voltage, current; /* among the measured signals; -1: a wire, which takes nothing */
        int table[2];         /* turning on, off; -1: none */
    } * device;               /* [n_devices] */

    int n_tables;
    struct dalcs_loss_table *table;
    struct dalcs_location where;
};

/* J, bilinear between the four entries around; outside the table the value at its edge, and *clamped. */
double dalcs_loss_table_at(const struct dalcs_loss_table *table, double volt, double ampere,
                           bool *clamped);

#endif
