/* file_branches.c - the law of each element at a row, as far as its voltage and current are known. */
#include "file_internal.h"

/* What is wanted may be a range: the law is broken by as much as a value is outside of it. */
static void compare(struct file_audit *a, const struct file_row *row, enum dalcs_audit_law law,
                    int device, struct file_number is, struct file_number wanted, double allowed) {
    if (is.known && wanted.known) {
        const double off = fmax(fabs(is.value - wanted.value) - wanted.error, 0.0);
        file_find(a, law, device, law == DALCS_AUDIT_BRANCH ? "V" : "A", off, is.error + allowed,
                  row->t, row->t);
    }
}

static void check_voltage(struct file_audit *a, const struct file_row *row, int device,
                          struct file_number wanted) {
    compare(a, row, DALCS_AUDIT_BRANCH, device, row->u[device], wanted, file_volts(a, device));
}

/* A current that is the law's own, or in no file, is Kirchhoff's matter. */
static void check_current(struct file_audit *a, const struct file_row *row, int device,
                          struct file_number wanted) {
    if (!row->is_assumed[device]) {
        compare(a, row, DALCS_AUDIT_CURRENT, device, row->i[device], wanted,
                file_amperes(a, device));
    }
}

/* One branch of a diode, 0 <= current _|_ beyond = v + r current - v_at >= 0: which of the two is not, V or A. */
static void check_pair(struct file_audit *a, const struct file_row *row, int device, double current,
                       double beyond, const double allowed[2]) {
    const double over[2] = {beyond / allowed[0], current / allowed[1]};
    const double volts = fmax(-beyond, over[0] <= over[1] ? beyond : 0.0);
    const double amperes = over[1] < over[0] ? current : 0.0;
    file_find(a, DALCS_AUDIT_BRANCH, device, "V", volts, allowed[0], row->t, row->t);
    file_find(a, DALCS_AUDIT_CURRENT, device, "A", amperes, allowed[1], row->t, row->t);
}

void file_check_diode(struct file_audit *a, const struct file_row *row, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const struct dalcs_diode_model *m = &a->circuit->models.of_diode[d->model];
    const struct file_number u = row->u[device], i = row->i[device];
    const double volts = file_volts(a, device) + u.error;
    if (!u.known) {
        return;
    }
    if (!i.known || row->is_assumed[device]) { /* then only what no current could explain */
        const double forward = m->ron == 0.0 ? u.value - m->vfwd : 0.0;
        const double reverse = m->rrev == 0.0 ? -u.value - m->vrev : 0.0;
        file_find(a, DALCS_AUDIT_BRANCH, device, "V", fmax(fmax(forward, reverse), 0.0), volts,
                  row->t, row->t);
        return;
    }
    const double g = isfinite(m->roff) ? 1.0 / m->roff : 0.0;
    const double own = i.value - g * u.value;
    const double amperes = file_amperes(a, device) + i.error + g * u.error;
    const double forward = fmax(own, 0.0), reverse = fmax(-own, 0.0);
    const double on[2] = {volts + m->ron * (amperes), amperes};
    check_pair(a, row, device, forward, m->vfwd + m->ron * forward - u.value, on);
    if (isfinite(m->vrev)) {
        const double back[2] = {volts + m->rrev * amperes, amperes};
        check_pair(a, row, device, reverse, m->vrev + m->rrev * reverse + u.value, back);
    } else {
        file_find(a, DALCS_AUDIT_CURRENT, device, "A", reverse, amperes, row->t, row->t);
    }
}

/* What an E or G makes of its formula, or of the voltage that it reads. */
static struct file_number output_of(struct file_audit *a, const struct file_row *row, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    if (d->behaviour != NULL) {
        return file_formula(a, row, device);
    }
    const double gain = d->is_delay && a->is_at_rest ? 1.0 : d->value;
    return file_add(file_exactly(0.0), gain,
                    file_add(row->v[d->node[2]], -1.0, row->v[d->node[3]]));
}

static void check_resistor(struct file_audit *a, const struct file_row *row, int device) {
    const double r = a->circuit->device[device].value;
    if (r == 0.0) {
        check_voltage(a, row, device, file_exactly(0.0));
    } else {
        check_current(a, row, device, file_add(file_exactly(0.0), 1.0 / r, row->u[device]));
    }
}

static void check_branch(struct file_audit *a, const struct file_row *row, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const struct file_number zero = file_exactly(0.0);
    switch (d->kind) {
    case DALCS_VSOURCE:
        check_voltage(a, row, device, file_stimulus(a, row, d->stimulus));
        break;
    case DALCS_ISOURCE:
        check_current(a, row, device, file_stimulus(a, row, d->stimulus));
        break;
    case DALCS_RESISTOR:
        check_resistor(a, row, device);
        break;
    case DALCS_VCVS:
        if (!file_is_given(a, device)) {
            check_voltage(a, row, device, output_of(a, row, device));
        }
        break;
    case DALCS_VCCS:
        check_current(a, row, device, output_of(a, row, device));
        break;
    case DALCS_CCVS:
        check_voltage(a, row, device, file_add(zero, d->value, row->i[d->control]));
        break;
    case DALCS_CCCS:
        check_current(a, row, device, file_add(zero, d->value, row->i[d->control]));
        break;
    case DALCS_DIODE:
        file_check_diode(a, row, device);
        break;
    case DALCS_SWITCH:
        file_check_switch(a, row, device);
        break;
    default: /* coils and capacitors: file_storage.c */
        if (d->kind == DALCS_INDUCTOR && a->is_at_rest) {
            check_voltage(a, row, device, zero);
        }
        break;
    }
}

void file_check_branches(struct file_audit *a, const struct file_row *row) {
    for (int d = 0; d < a->circuit->n_devices; d++) {
        check_branch(a, row, d);
    }
}
