/* file_storage.c - coils and capacitors: flux and charge between rows. */
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

struct file_number file_stored(const struct file_audit *a, const struct file_row *row, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    return d->kind == DALCS_INDUCTOR ? flux_of(a, row, device)
                                     : file_add(file_exactly(0.0), d->value, row->u[device]);
}

struct file_window_law file_law_of(const struct file_audit *a, int device) {
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
    struct file_window *w = &a->window.of_device[device];
    const struct file_window_law law = file_law_of(a, device);
    struct file_number x[4];
    take(row, x, a->circuit->device[device].kind == DALCS_CAPACITOR, device);
    const struct file_number before = file_stored(a, row[1], device);
    const struct file_number after = file_stored(a, row[2], device);
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
        a->charges.charge[d] = file_trapezoid(row, x);
        a->charges.is_taken[d] =
            a->circuit->device[d].kind == DALCS_CAPACITOR && !a->charges.charge[d].known;
        if (a->charges.is_taken[d]) {
            a->charges.charge[d] =
                file_add(file_stored(a, row[2], d), -1.0, file_stored(a, row[1], d));
            a->charges.charge[d].error =
                0.0; /* that of what is stored counts at the ends of windows */
            any = any || a->charges.charge[d].known;
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
        law[dalcs_union_find(a->sets.cluster, n)].signature += ((unsigned long)n + 1) * spread;
    }
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const struct dalcs_device *device = &a->circuit->device[d];
        const int end[2] = {dalcs_union_find(a->sets.cluster, a->nodes.of[device->node[0]]),
                            dalcs_union_find(a->sets.cluster, a->nodes.of[device->node[1]])};
        for (int e = 0; e < 2 && end[0] != end[1]; e++) {
            struct file_set_law *l = &law[end[e]];
            if (a->charges.is_taken[d]) {
                l->ends += device->value * file_volts(a, d);
                l->end_error += file_stored(a, row, d).error;
                l->has_charge = true;
            } else {
                l->rate = fmax(l->rate, file_amperes(a, d));
            }
        }
    }
}

static void check_sets(struct file_audit *a, struct file_row *const row[4]) {
    struct file_set_law *law = a->sets.law;
    file_cluster(a, a->charges.charge);
    file_sum_sets(a, a->charges.charge);
    file_describe_sets(a, NULL);
    gather(a, row[2], law);
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        a->coverage.is_checked[n] = false;
    }
    for (int n = 1; n < a->circuit->n_nodes; n++) {
        struct file_window *w = &a->window.of_node[n];
        const struct file_window_law of = {DALCS_AUDIT_KCL, n, "C", law[n].ends, law[n].rate};
        const bool is_law = a->sets.count[n] > 0 && law[n].has_charge && a->sets.sum[n].known;
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
        a->coverage.is_checked[n] = true;
        file_window_add(a, w, &of, a->sets.sum[n], 0.0, row[2]->t - row[1]->t, law[n].end_error,
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
