/* file_jumps.c - what holds across two rows at one time, and at the first row: as crossing.c has it, of what the file
 * shows. */
#include "file_internal.h"

#include "union_find.h"

/* May an impulse of current pass? Where the file does not say, it may. */
static bool passes_charge(const struct file_audit *a, const struct file_row *left,
                          const struct file_row *right, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const struct file_number u = right->u[device];
    switch (d->kind) {
    case DALCS_VSOURCE:
    case DALCS_VCVS:
    case DALCS_CCVS:
    case DALCS_CCCS:
        return true;
    case DALCS_VCCS:
        return d->behaviour != NULL;
    case DALCS_SWITCH:
        return a->circuit->models.of_switch[d->model].ron == 0.0 &&
               ((left->position[device] | right->position[device]) & FILE_CLOSED) != 0;
    case DALCS_DIODE: {
        const struct dalcs_diode_model *m = &a->circuit->models.of_diode[d->model];
        const double margin = file_volts(a, device) + u.error;
        return !u.known || (m->ron == 0.0 && u.value >= m->vfwd - margin) ||
               (m->rrev == 0.0 && u.value <= -m->vrev + margin);
    }
    case DALCS_CAPACITOR:
        return !left->u[device].known || !u.known;
    default:
        return false;
    }
}

/* Does a finite voltage stand across it, whatever happens? */
static bool bounds_voltage(const struct file_audit *a, const struct file_row *left,
                           const struct file_row *right, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const struct file_number i = right->i[device];
    switch (d->kind) {
    case DALCS_RESISTOR:
    case DALCS_CAPACITOR:
    case DALCS_VSOURCE:
        return true;
    case DALCS_SWITCH:
        return isfinite(a->circuit->models.of_switch[d->model].roff) ||
               (left->position[device] == FILE_CLOSED && right->position[device] == FILE_CLOSED);
    case DALCS_DIODE: {
        const struct dalcs_diode_model *m = &a->circuit->models.of_diode[d->model];
        return isfinite(m->roff) || isfinite(m->vrev) ||
               (i.known && !right->is_assumed[device] &&
                i.value > file_amperes(a, device) + i.error);
    }
    default:
        return false;
    }
}

typedef bool joins(const struct file_audit *, const struct file_row *, const struct file_row *,
                   int);

static void join_nodes(struct file_audit *a, const struct file_row *left,
                       const struct file_row *right, joins *join) {
    dalcs_union_reset(a->sets.cluster, a->circuit->n_nodes);
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const int *node = a->circuit->device[d].node;
        if (join(a, left, right, d)) {
            dalcs_union_join(a->sets.cluster, a->nodes.of[node[0]], a->nodes.of[node[1]]);
        }
    }
}

static void check_charges(struct file_audit *a, const struct file_row *left,
                          const struct file_row *right) {
    join_nodes(a, left, right, passes_charge);
    for (int d = 0; d < a->circuit->n_devices; d++) {
        a->charges.charge[d] = (struct file_number){.known = true};
        if (a->circuit->device[d].kind == DALCS_CAPACITOR) {
            a->charges.charge[d] =
                file_add(file_stored(a, right, d), -1.0, file_stored(a, left, d));
            a->charges.charge[d].error += 2.0 * a->circuit->device[d].value * file_volts(a, d);
        }
    }
    file_sum_sets(a, a->charges.charge);
    file_describe_sets(a, NULL);
    for (int n = 1; n < a->circuit->n_nodes; n++) {
        if (a->sets.count[n] > 0 && a->sets.sum[n].known && a->sets.sum[n].error > 0.0) {
            file_find_set(a, n, "C", fabs(a->sets.sum[n].value),
                          a->sets.sum[n].error + 2.0 * right->t_error * a->scale.amperes, right->t,
                          right->t);
        }
    }
}

void file_check_jump(struct file_audit *a, const struct file_row *left,
                     const struct file_row *right) {
    bool any = false;
    check_charges(a, left, right);
    join_nodes(a, left, right, bounds_voltage);
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const struct dalcs_device *device = &a->circuit->device[d];
        const bool is_coil = device->kind == DALCS_INDUCTOR;
        if (!is_coil && device->kind != DALCS_CAPACITOR) {
            continue;
        }
        const struct file_window_law law = file_law_of(a, d);
        const struct file_number change =
            file_add(file_stored(a, right, d), -1.0, file_stored(a, left, d));
        const double allowed = change.error + 2.0 * law.end_tolerance +
                               2.0 * right->t_error * (is_coil ? a->scale.volts : a->scale.amperes);
        const bool is_held =
            is_coil && dalcs_union_find(a->sets.cluster, a->nodes.of[device->node[0]]) ==
                           dalcs_union_find(a->sets.cluster, a->nodes.of[device->node[1]]);
        if (is_held && change.known) {
            file_find(a, DALCS_AUDIT_BRANCH, d, "Wb", fabs(change.value), allowed, right->t,
                      right->t);
        }
        const bool jumps = !change.known || fabs(change.value) > allowed;
        any = any || (jumps && !is_coil);
        a->window.of_device[d].n = jumps ? 0 : a->window.of_device[d].n;
        a->window.of_device[d].now.residual += change.value;
        a->window.of_device[d].now.moved += change.value;
    }
    for (int n = 0; n < a->circuit->n_nodes && any; n++) {
        a->window.of_node[n].n = 0;
    }
}

/* With uic a run begins with what IC= says, and may jump from there: a row at 0 that is on the other side. What
 * .ic says of nodes is not followed to the elements between them. */
void file_check_start(struct file_audit *a, const struct file_row *first, struct file_row *before) {
    const struct dalcs_circuit *c = a->circuit;
    if (first->t != 0.0 || !c->analyses.transient.use_initial_conditions ||
        c->n_initial_conditions > 0) {
        return;
    }
    for (int d = 0; d < c->n_devices; d++) {
        const struct dalcs_device *device = &c->device[d];
        const struct file_number initial =
            file_exactly(device->has_initial ? device->initial : 0.0);
        before->u[d] = device->kind == DALCS_CAPACITOR ? initial : first->u[d];
        before->i[d] = device->kind == DALCS_INDUCTOR ? initial : first->i[d];
        before->position[d] = first->position[d];
    }
    file_check_jump(a, before, first);
}
