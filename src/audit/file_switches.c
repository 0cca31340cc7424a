/* file_switches.c - where a switch may stand, by its control and what came before, and where the file shows it.
 *
 * Between two rows a control may have been above or below both: by a quarter of the change of its slope times
 * the time between them, which is what a kink anywhere between them makes. What it may have done there a switch
 * with hysteresis may remember. */
#include "file_internal.h"

/* The control less its threshold, at row k of the table. */
static struct file_number control_at(const struct file_audit *a, const struct file_row *row,
                                     int device, long k) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const struct dalcs_switch_model *m = &a->circuit->models.of_switch[d->model];
    struct file_number c = {0};
    if (k < 0 || k >= (long)a->table->n_rows) {
        return c;
    }
    if (d->control >= 0) {
        const long column = a->columns.current[d->control];
        c = column >= 0 ? file_cell(a, (size_t)k, (size_t)column) : c;
    } else if (k == (long)row->index) {
        c = file_add(row->v[d->node[2]], -1.0, row->v[d->node[3]]);
    } else {
        c = file_add(file_potential_at(a, (size_t)k, d->node[2]), -1.0,
                     file_potential_at(a, (size_t)k, d->node[3]));
    }
    c.value = (m->is_inverted ? -c.value : c.value) - m->vt;
    return c;
}

/* What a control is held to, besides: over its own largest value. */
static double control_tolerance(const struct file_audit *a, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const struct dalcs_switch_model *m = &a->circuit->models.of_switch[d->model];
    const double signal = d->control >= 0 ? a->scale.i[d->control]
                                          : fmax(a->scale.v[d->node[2]], a->scale.v[d->node[3]]);
    return a->promise.tolerance * fmax(signal, fabs(m->vt) + fabs(m->vh));
}

static double time_at(const struct file_audit *a, long k) {
    return a->table->value[(size_t)k * a->table->n_columns];
}

/* The change of slope at row k; 0 where there is none to be seen. */
static double bend_at(const struct file_audit *a, const struct file_row *row, int device, long k) {
    const struct file_number c[3] = {control_at(a, row, device, k - 1),
                                     control_at(a, row, device, k),
                                     control_at(a, row, device, k + 1)};
    if (!c[0].known || !c[1].known || !c[2].known) {
        return 0.0;
    }
    const double before = time_at(a, k) - time_at(a, k - 1);
    const double after = time_at(a, k + 1) - time_at(a, k);
    return before > 0.0 && after > 0.0
               ? fabs((c[2].value - c[1].value) / after - (c[1].value - c[0].value) / before)
               : 0.0;
}

/* Within its hysteresis a switch is where it began, if nothing has moved it before: what was before is known, or at an
 * operating point sources alone command it. */
static bool knows_start(const struct file_audit *a, const struct file_row *row,
                        const struct dalcs_device *d) {
    const bool is_commanded =
        d->control < 0 && a->nodes.fed_from[d->node[2]] == a->nodes.fed_from[d->node[3]];
    const bool is_start =
        a->is_at_rest ? is_commanded : a->circuit->analyses.transient.use_initial_conditions;
    return row->t == 0.0 && (is_start || row->is_left) && !a->promise.remembers;
}

unsigned char file_position(const struct file_audit *a, const struct file_row *row,
                            const struct file_row *before, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const double half_width = fabs(a->circuit->models.of_switch[d->model].vh);
    const long k = (long)row->index;
    const struct file_number now = control_at(a, row, device, k);
    const bool is_between = row->is_behind && !row->is_right; /* others are on both sides of it */
    if (!now.known || is_between) {
        return FILE_OPEN | FILE_CLOSED;
    }
    const double margin = now.error + control_tolerance(a, device);
    unsigned char position = d->initially_on ? FILE_CLOSED : FILE_OPEN;
    if (before == NULL && !knows_start(a, row, d)) {
        position = FILE_OPEN | FILE_CLOSED;
    }
    double low = now.value;
    double high = low;
    const struct file_number then = control_at(a, row, device, k - 1);
    if (before != NULL) {
        position = before->position[device];
        const double h = time_at(a, k) - time_at(a, k - 1);
        const double beyond =
            h > 0.0 ? 0.25 * h * (bend_at(a, row, device, k - 1) + bend_at(a, row, device, k))
                    : 0.0;
        low = fmin(low, then.known ? then.value : -INFINITY) - beyond;
        high = fmax(high, then.known ? then.value : INFINITY) + beyond;
    }
    if (now.value > half_width + margin) {
        return FILE_CLOSED;
    }
    if (now.value < -half_width - margin) {
        return FILE_OPEN;
    }
    position |= high >= half_width - margin ? FILE_CLOSED : 0;
    position |= low <= -half_width + margin || d->valve >= 0 ? FILE_OPEN : 0;
    return position;
}

/* By how much the law of a position is missed, over what is allowed. */
struct miss {
    double defect, allowed;
    bool known;
};

static struct miss miss_of(const struct file_audit *a, const struct file_row *row, int device,
                           unsigned char position) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const struct dalcs_switch_model *m = &a->circuit->models.of_switch[d->model];
    const struct file_number u = row->u[device], i = row->i[device];
    struct file_number off = u;
    double allowed = file_volts(a, device);
    if (position == FILE_CLOSED && m->ron > 0.0) {
        off = file_add(u, -m->ron, i);
    } else if (position == FILE_OPEN) {
        off = isfinite(m->roff) ? file_add(i, -1.0 / m->roff, u) : i;
        allowed = file_amperes(a, device);
        off.known = off.known && !row->is_assumed[device];
    }
    return (struct miss){fabs(off.value), off.error + allowed, off.known};
}

static bool fits(struct miss m) {
    return m.known && m.defect <= m.allowed;
}

/* How far the control is from the threshold that it would have had to reach to be where the file shows it. */
static double short_of(const struct file_audit *a, const struct file_row *row, int device,
                       unsigned char shown) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const double half_width = fabs(a->circuit->models.of_switch[d->model].vh);
    const double c = control_at(a, row, device, (long)row->index).value;
    return shown == FILE_OPEN ? c + half_width : half_width - c;
}

void file_check_switch(struct file_audit *a, const struct file_row *row, int device) {
    const unsigned char wanted = row->position[device];
    const struct miss closed = miss_of(a, row, device, FILE_CLOSED);
    const struct miss open = miss_of(a, row, device, FILE_OPEN);
    if (wanted == (FILE_OPEN | FILE_CLOSED)) {
        if (closed.known && open.known && !fits(open)) {
            file_find(a, DALCS_AUDIT_BRANCH, device, "V", closed.defect, closed.allowed, row->t,
                      row->t);
        }
        return;
    }
    const struct miss *of_wanted = wanted == FILE_CLOSED ? &closed : &open;
    const struct miss *of_other = wanted == FILE_CLOSED ? &open : &closed;
    if (!of_wanted->known) {
        return;
    }
    const double margin =
        control_tolerance(a, device) + control_at(a, row, device, (long)row->index).error;
    const char *unit = a->circuit->device[device].control >= 0 ? "A" : "V";
    const bool is_other = !fits(*of_wanted) && fits(*of_other);
    file_find(a, DALCS_AUDIT_POSITION, device, unit,
              is_other
                  ? short_of(a, row, device, (unsigned char)(wanted ^ (FILE_OPEN | FILE_CLOSED)))
                  : 0.0,
              margin, row->t, row->t);
    if (!is_other) {
        file_find(a, wanted == FILE_CLOSED ? DALCS_AUDIT_BRANCH : DALCS_AUDIT_CURRENT, device,
                  wanted == FILE_CLOSED ? "V" : "A", of_wanted->defect, of_wanted->allowed, row->t,
                  row->t);
    }
}
