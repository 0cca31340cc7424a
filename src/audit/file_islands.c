/* file_islands.c - Kirchhoff's current law of parts that only sources feed, at rest.
 *
 * No law gives the potential of such a part, and the currents of its resistors are known to the rounding of that: at 1e17 V
 * KCL at its nodes proves nothing. What enters the part as a whole does not depend on its potential. It is the sum of the
 * branches that are no conductance, and each of these is known to its own size. */
#include "file_internal.h"

static struct file_number held(const struct file_audit *a, struct file_number flow) {
    flow.error += a->promise.tolerance * fabs(flow.value);
    return flow;
}

/* F reads the current of a branch, which is held to its scale. */
static struct file_number of_current(const struct file_audit *a, const struct file_row *row,
                                     const struct dalcs_device *d) {
    struct file_number read = row->i[d->control];
    read.error += file_amperes(a, d->control);
    return file_add(file_exactly(0.0), d->value, read);
}

/* One that blocks and has no conductance carries nothing; the file may say that it carries a little. */
static struct file_number of_pair(const struct file_audit *a, const struct file_row *row,
                                  int device) {
    struct file_number flow = {0};
    if (!isfinite(dalcs_device_roff(a->circuit, &a->circuit->device[device]))) {
        flow = file_blocked(a, row, device);
        flow.error += a->promise.tolerance * a->scale.i[device];
    }
    return flow;
}

/* Not known: a branch that joins both of its ends to one part. */
static struct file_number flow_of(struct file_audit *a, const struct file_row *row, int device,
                                  bool with_controlled) {
    const struct dalcs_device *d = &a->circuit->device[device];
    switch (d->kind) {
    case DALCS_ISOURCE:
        return held(a, file_stimulus(a, row, d->stimulus));
    case DALCS_CAPACITOR:
        return file_exactly(0.0);
    case DALCS_DIODE:
    case DALCS_SWITCH:
        return of_pair(a, row, device);
    case DALCS_VCCS:
        return with_controlled ? held(a, file_output(a, row, device)) : (struct file_number){0};
    case DALCS_CCCS:
        return with_controlled ? held(a, of_current(a, row, d)) : (struct file_number){0};
    default:
        return (struct file_number){0};
    }
}

/* A controlled source that reads its own part is a conductance in it: its current is known to the rounding of that potential.
 * One that reads another part feeds this one. So both are asked. */
void file_check_islands(struct file_audit *a, const struct file_row *row) {
    struct file_number *flow = a->charges.charge;
    for (int with_controlled = 0; with_controlled < 2; with_controlled++) {
        for (int d = 0; d < a->circuit->n_devices; d++) {
            flow[d] = flow_of(a, row, d, with_controlled);
        }
        file_cluster(a, flow);
        file_sum_sets(a, flow);
        file_describe_sets(a, NULL);
        for (int n = 1; n < a->circuit->n_nodes; n++) {
            const struct file_number *sum = &a->sets.sum[n];
            if (a->sets.count[n] > 0 && sum->known) {
                file_find_set(a, n, "A", fabs(sum->value), sum->error + a->promise.abstol, row->t,
                              row->t);
            }
        }
    }
}
