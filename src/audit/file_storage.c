/* file_storage.c - coils and capacitors: flux and charge between rows, and across two rows at one time. */
#include "file_internal.h"

#include "union_find.h"

/* Four rows, the interval is between the middle ones. */
static void take(struct file_row *const row[4], struct file_number x[4], bool is_current,
                 int device) {
    for (int k = 0; k < 4; k++) {
        const struct file_number none = {0};
        x[k] = row[k] == NULL ? none : is_current ? row[k]->i[device] : row[k]->u[device];
    }
}

/* ---- What is stored ----------------------------------------------------------------------------- */

/* Wb, with what other coils add. */
static struct file_number flux_of(const struct file_audit *a, const struct file_row *row,
                                  int device) {
    const struct dalcs_circuit *c = a->circuit;
    struct file_number flux = file_add(file_exactly(0.0), c->device[device].value, row->i[device]);
    for (int k = 0; k < c->n_couplings; k++) {
        const struct dalcs_coupling *m = &c->coupling[k];
        for (int e = 0; e < 2; e++) {
            if (m->inductor[e] == device) {
                const int other = m->inductor[1 - e];
                const double mutual = m->k * sqrt(c->device[device].value * c->device[other].value);
                flux = file_add(flux, mutual, row->i[other]);
            }
        }
    }
    return flux;
}

/* What the tolerance of all these currents makes of it. */
static double flux_tolerance(const struct file_audit *a, int device) {
    const struct dalcs_circuit *c = a->circuit;
    double sum = c->device[device].value * file_amperes(a, device);
    for (int k = 0; k < c->n_couplings; k++) {
        const struct dalcs_coupling *m = &c->coupling[k];
        for (int e = 0; e < 2; e++) {
            if (m->inductor[e] == device) {
                const int other = m->inductor[1 - e];
                sum += fabs(m->k) * sqrt(c->device[device].value * c->device[other].value) *
                       file_amperes(a, other);
            }
        }
    }
    return sum;
}

static struct file_number stored(const struct file_audit *a, const struct file_row *row,
                                 int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    return d->kind == DALCS_INDUCTOR ? flux_of(a, row, device)
                                     : file_add(file_exactly(0.0), d->value, row->u[device]);
}

static struct file_window_law law_of(const struct file_audit *a, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const bool is_coil = d->kind == DALCS_INDUCTOR;
    return (struct file_window_law){
        .law = DALCS_AUDIT_BRANCH,
        .index = device,
        .unit = is_coil ? "Wb" : "C",
        .end_tolerance = is_coil ? flux_tolerance(a, device) : d->value * file_volts(a, device),
        .rate_tolerance = is_coil ? file_volts(a, device) : file_amperes(a, device)};
}

/* ---- Over an interval --------------------------------------------------------------------------- */

static void check_element(struct file_audit *a, struct file_row *const row[4], int device) {
    struct file_window *w = &a->of_device[device];
    const struct file_window_law law = law_of(a, device);
    struct file_number x[4];
    take(row, x, a->circuit->device[device].kind == DALCS_CAPACITOR, device);
    const struct file_number before = stored(a, row[1], device);
    const struct file_number after = stored(a, row[2], device);
    const struct file_number brought = file_trapezoid(row, x);
    const bool is_known = before.known && after.known && brought.known;
    if (!is_known || w->n == 0) {
        file_window_begin(w, before.error);
    }
    if (is_known) {
        const struct file_number residual = {after.value - before.value - brought.value,
                                             brought.error, true};
        file_window_add(a, w, &law, residual, after.value - before.value, row[2]->t - row[1]->t,
                        after.error, row[2]->t);
    }
}

/* Charges that devices brought over the interval. Of a capacitor without a current, what it took up. */
static bool find_charges(struct file_audit *a, struct file_row *const row[4]) {
    bool any = false;
    for (int d = 0; d < a->circuit->n_devices; d++) {
        struct file_number x[4];
        take(row, x, true, d);
        a->charge[d] = file_trapezoid(row, x);
        a->takes_charge[d] = a->circuit->device[d].kind == DALCS_CAPACITOR && !a->charge[d].known;
        if (a->takes_charge[d]) {
            a->charge[d] = file_add(stored(a, row[2], d), -1.0, stored(a, row[1], d));
            a->charge[d].error = 0.0; /* that of what is stored counts at the ends of windows */
            any = any || a->charge[d].known;
        }
    }
    return any;
}

static void gather(struct file_audit *a, const struct file_row *row, struct file_set_law *law) {
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        law[n] = (struct file_set_law){0};
    }
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        const unsigned long spread = 0x9e3779b97f4a7c15u; /* 2^64 over the golden ratio */
        law[dalcs_union_find(a->cluster, n)].signature += ((unsigned long)n + 1) * spread;
    }
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const struct dalcs_device *device = &a->circuit->device[d];
        const int end[2] = {dalcs_union_find(a->cluster, a->node_of[device->node[0]]),
                            dalcs_union_find(a->cluster, a->node_of[device->node[1]])};
        for (int e = 0; e < 2 && end[0] != end[1]; e++) {
            struct file_set_law *l = &law[end[e]];
            if (a->takes_charge[d]) {
                l->ends += device->value * file_volts(a, d);
                l->end_error += stored(a, row, d).error;
                l->has_charge = true;
            } else {
                l->rate = fmax(l->rate, file_amperes(a, d));
            }
        }
    }
}

static void check_sets(struct file_audit *a, struct file_row *const row[4]) {
    struct file_set_law *law = a->set_law;
    file_cluster(a, a->charge);
    file_sum_sets(a, a->charge);
    file_describe_sets(a, NULL);
    gather(a, row[2], law);
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        a->is_checked[n] = false;
    }
    for (int n = 1; n < a->circuit->n_nodes; n++) {
        struct file_window *w = &a->of_node[n];
        const struct file_window_law of = {DALCS_AUDIT_KCL, n, "C", law[n].ends, law[n].rate};
        const bool is_law = a->count[n] > 0 && law[n].has_charge && a->sum[n].known;
        if (w->n > 0 && (!is_law || w->signature != law[n].signature)) {
            w->n = 0; /* another set: the windows of this one were judged on the way */
        }
        if (!is_law) {
            continue;
        }
        if (w->n == 0) {
            w->signature = law[n].signature;
            file_window_begin(w, law[n].end_error);
        }
        a->is_checked[n] = true;
        file_window_add(a, w, &of, a->sum[n], 0.0, row[2]->t - row[1]->t, law[n].end_error,
                        row[2]->t);
    }
    file_note_covered(a);
}

void file_check_interval(struct file_audit *a, struct file_row *const row[4]) {
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const enum dalcs_device_kind kind = a->circuit->device[d].kind;
        if (kind == DALCS_INDUCTOR || kind == DALCS_CAPACITOR) {
            check_element(a, row, d);
        }
    }
    if (find_charges(a, row)) {
        check_sets(a, row);
    }
}

/* ---- Two rows at one time ------------------------------------------------------------------------ */

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
        return a->circuit->switch_model[d->model].ron == 0.0 &&
               ((left->position[device] | right->position[device]) & FILE_CLOSED) != 0;
    case DALCS_DIODE: {
        const struct dalcs_diode_model *m = &a->circuit->diode_model[d->model];
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
        return isfinite(a->circuit->switch_model[d->model].roff) ||
               (left->position[device] == FILE_CLOSED && right->position[device] == FILE_CLOSED);
    case DALCS_DIODE: {
        const struct dalcs_diode_model *m = &a->circuit->diode_model[d->model];
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
    dalcs_union_reset(a->cluster, a->circuit->n_nodes);
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const int *node = a->circuit->device[d].node;
        if (join(a, left, right, d)) {
            dalcs_union_join(a->cluster, a->node_of[node[0]], a->node_of[node[1]]);
        }
    }
}

static void check_charges(struct file_audit *a, const struct file_row *left,
                          const struct file_row *right) {
    join_nodes(a, left, right, passes_charge);
    for (int d = 0; d < a->circuit->n_devices; d++) {
        a->charge[d] = (struct file_number){.known = true};
        if (a->circuit->device[d].kind == DALCS_CAPACITOR) {
            a->charge[d] = file_add(stored(a, right, d), -1.0, stored(a, left, d));
            a->charge[d].error += 2.0 * a->circuit->device[d].value * file_volts(a, d);
        }
    }
    file_sum_sets(a, a->charge);
    file_describe_sets(a, NULL);
    for (int n = 1; n < a->circuit->n_nodes; n++) {
        if (a->count[n] > 0 && a->sum[n].known && a->sum[n].error > 0.0) {
            file_find_set(a, n, "C", fabs(a->sum[n].value),
                          a->sum[n].error + 2.0 * right->t_error * a->amperes, right->t, right->t);
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
        const struct file_window_law law = law_of(a, d);
        const struct file_number change = file_add(stored(a, right, d), -1.0, stored(a, left, d));
        const double allowed = change.error + 2.0 * law.end_tolerance +
                               2.0 * right->t_error * (is_coil ? a->volts : a->amperes);
        const bool is_held =
            is_coil && dalcs_union_find(a->cluster, a->node_of[device->node[0]]) ==
                           dalcs_union_find(a->cluster, a->node_of[device->node[1]]);
        if (is_held && change.known) {
            file_find(a, DALCS_AUDIT_BRANCH, d, "Wb", fabs(change.value), allowed, right->t,
                      right->t);
        }
        const bool jumps = !change.known || fabs(change.value) > allowed;
        any = any || (jumps && !is_coil);
        a->of_device[d].n = jumps ? 0 : a->of_device[d].n;
        a->of_device[d].now.residual += change.value;
        a->of_device[d].now.moved += change.value;
    }
    for (int n = 0; n < a->circuit->n_nodes && any; n++) {
        a->of_node[n].n = 0;
    }
}

/* With uic a run begins with what IC= says, and may jump from there: a row at 0 that is on the other side. What
 * .ic says of nodes is not followed to the elements between them. */
void file_check_start(struct file_audit *a, const struct file_row *first, struct file_row *before) {
    const struct dalcs_circuit *c = a->circuit;
    if (first->t != 0.0 || !c->transient.use_initial_conditions || c->n_initial_conditions > 0) {
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
