/* file_values.c - potentials, voltages and currents at a row: from columns, and from laws where those give
 * them. */
#include "file_internal.h"

/* ---- Sources ------------------------------------------------------------------------------------ */

static void widen(double *low, double *high, double value) {
    *low = fmin(*low, value);
    *high = fmax(*high, value);
}

/* Edges that a window of time is searched for, at most: what a source is at these it may be. */
enum { MOST_EDGES = 16 };

/* Of the first row; not a number: it is in no column of its own. */
static double potential(const struct file_audit *a, int node) {
    const struct file_potential *p = a->columns.potential_of[node] >= 0
                                         ? &a->columns.potential[a->columns.potential_of[node]]
                                         : NULL;
    return node == 0                                    ? 0.0
           : p != NULL && p->base == 0 && p->column > 0 ? a->table->value[p->column]
                                                        : (double)NAN;
}

/* The simulator's own `op` takes the DC values although the netlist has a .tran: the first source that tells the two apart
 * says which it was. */
bool file_rests_before(const struct file_audit *a) {
    const struct dalcs_circuit *c = a->circuit;
    bool before = c->analyses.transient.present;
    for (int d = 0; d < c->n_devices && before; d++) {
        const struct dalcs_device *device = &c->device[d];
        if (device->kind != DALCS_VSOURCE || c->stimulus[device->stimulus].is_written) {
            continue;
        }
        const double is = potential(a, device->node[0]) - potential(a, device->node[1]);
        const double of_tran = dalcs_stimulus_operating_value(&c->stimulus[device->stimulus], true);
        const double of_op = dalcs_stimulus_operating_value(&c->stimulus[device->stimulus], false);
        if (isfinite(is) && of_tran != of_op) {
            return fabs(is - of_tran) <= fabs(is - of_op);
        }
    }
    return before;
}

struct file_number file_stimulus(const struct file_audit *a, const struct file_row *row,
                                 int stimulus) {
    const struct dalcs_stimulus *s = &a->circuit->stimulus[stimulus];
    if (s->is_written) {
        return (struct file_number){0};
    }
    if (a->is_at_rest) {
        return file_exactly(dalcs_stimulus_operating_value(s, a->is_before));
    }
    const double first = dalcs_stimulus_value(s, row->t, row->is_right ? DALCS_RIGHT : DALCS_LEFT);
    double low = first, high = first;
    if (!row->is_left && !row->is_right) {
        widen(&low, &high, dalcs_stimulus_value(s, row->t, DALCS_RIGHT));
    }
    if (row->t_error > 0.0) {
        widen(&low, &high, dalcs_stimulus_value(s, row->t + row->t_error, DALCS_LEFT));
        widen(&low, &high, dalcs_stimulus_value(s, fmax(row->t - row->t_error, 0.0), DALCS_RIGHT));
    }
    const double from = row->t - row->t_error - a->ramp;
    double edge = from > 0.0 ? dalcs_stimulus_next_edge(s, from) : 0.0;
    for (int k = 0; k < MOST_EDGES && edge <= row->t + row->t_error; k++) {
        const bool is_near = edge >= row->t - row->t_error && row->t_error > 0.0;
        if (is_near || (a->ramp > 0.0 && dalcs_stimulus_jumps_at(s, edge))) {
            widen(&low, &high, dalcs_stimulus_value(s, edge, DALCS_LEFT));
            widen(&low, &high, dalcs_stimulus_value(s, edge, DALCS_RIGHT));
        }
        edge = dalcs_stimulus_next_edge(s, edge);
    }
    return (struct file_number){0.5 * (low + high), 0.5 * (high - low), true};
}

/* ---- What a signal is held to ------------------------------------------------------------------- */

/* doc/methods.md, "What the tolerance means": signals below 1e-5 of the largest of their unit are held to that
 * one's scale, currents of diodes and switches below 1e-2. */
static const double least_signal = 1e-5, least_of_pair = 1e-2;

double file_volts(const struct file_audit *a, int device) {
    const double least = fmax(least_signal * a->scale.volts, a->scale.vouched[0]);
    return a->promise.tolerance * fmax(a->scale.u[device], least) + a->promise.vntol;
}

double file_amperes(const struct file_audit *a, int device) {
    const enum dalcs_device_kind kind = a->circuit->device[device].kind;
    const bool is_pair = kind == DALCS_DIODE || kind == DALCS_SWITCH;
    const double part = is_pair ? least_of_pair : least_signal;
    const double least = fmax(part * a->scale.amperes, a->scale.vouched[1]);
    return a->promise.tolerance * fmax(a->scale.i[device], least) + a->promise.abstol;
}

/* ---- Columns ------------------------------------------------------------------------------------ */

struct file_number file_cell(const struct file_audit *a, size_t row, size_t column) {
    const double x = a->table->value[row * a->table->n_columns + column];
    return (struct file_number){
        x, a->table->relative[column] * fabs(x) + a->table->absolute[column], isfinite(x)};
}

struct file_number file_potential_at(const struct file_audit *a, size_t row, int node) {
    struct file_number sum = file_exactly(0.0);
    while (node > 0) {
        if (a->columns.potential_of[node] < 0) {
            return (struct file_number){0};
        }
        const struct file_potential *p = &a->columns.potential[a->columns.potential_of[node]];
        if (p->sign != 0.0) {
            sum = file_add(sum, p->sign, file_cell(a, row, p->column));
        }
        node = p->base;
    }
    return sum;
}

static void read_potentials(const struct file_audit *a, struct file_row *row) {
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        row->v[n] = file_potential_at(a, row->index, n);
    }
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const int *node = a->circuit->device[d].node;
        row->u[d] = file_add(row->v[node[0]], -1.0, row->v[node[1]]);
    }
}

/* ---- Laws that give a current ------------------------------------------------------------------- */

static struct file_number of_law(struct file_audit *a, const struct file_row *row, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const struct file_number none = {0}, zero = file_exactly(0.0);
    switch (d->kind) {
    case DALCS_RESISTOR:
        return d->value != 0.0 ? file_add(zero, 1.0 / d->value, row->u[device]) : none;
    case DALCS_ISOURCE:
        return file_stimulus(a, row, d->stimulus);
    case DALCS_VCCS:
        return d->behaviour != NULL
                   ? file_formula(a, row, device)
                   : file_add(zero, d->value,
                              file_add(row->v[d->node[2]], -1.0, row->v[d->node[3]]));
    case DALCS_CCCS:
        return file_add(zero, d->value, row->i[d->control]);
    case DALCS_CAPACITOR:
        return a->is_at_rest ? zero : none;
    default:
        return none;
    }
}

/* A diode that blocks and a switch whose position is known have the current that their line gives. One that
 * conducts may have any: a steep line would make much of what its voltage is off by. */
struct file_number file_blocked(const struct file_audit *a, const struct file_row *row,
                                int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const struct file_number none = {0}, zero = file_exactly(0.0), u = row->u[device];
    if (d->kind == DALCS_SWITCH && row->position[device] == FILE_OPEN) {
        const double roff = a->circuit->models.of_switch[d->model].roff;
        return isfinite(roff) ? file_add(zero, 1.0 / roff, u) : zero;
    }
    if (d->kind == DALCS_DIODE && u.known) {
        const struct dalcs_diode_model *m = &a->circuit->models.of_diode[d->model];
        const double margin = file_volts(a, device) + u.error;
        const bool blocks = u.value < m->vfwd - margin && u.value > -m->vrev + margin;
        return !blocks ? none : isfinite(m->roff) ? file_add(zero, 1.0 / m->roff, u) : zero;
    }
    return none;
}

static void take_laws(struct file_audit *a, struct file_row *row, bool assume) {
    for (int d = 0; d < a->circuit->n_devices; d++) {
        if (!row->i[d].known) {
            row->i[d] = assume ? file_blocked(a, row, d) : of_law(a, row, d);
            row->is_assumed[d] = row->i[d].known;
        }
    }
}

/* Sources that read currents come behind those: this often, at most, one behind the other. */
enum { MOST_ROUNDS = 3 };

void file_evaluate(struct file_audit *a, size_t k, struct file_row *row,
                   const struct file_row *before) {
    const struct dalcs_wave_table *table = a->table;
    const double *time = table->value + k * table->n_columns;
    row->index = k;
    row->t = *time;
    row->t_error = table->relative[0] * fabs(row->t) + table->absolute[0];
    row->is_behind = file_is_behind(table, k);
    row->is_right = row->is_behind && !file_is_behind(table, k + 1);
    row->is_left = !row->is_behind && file_is_behind(table, k + 1);
    read_potentials(a, row);
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const long column = a->columns.current[d];
        row->i[d] = column >= 0 ? file_cell(a, k, (size_t)column) : (struct file_number){0};
        row->is_assumed[d] = false;
        if (a->circuit->device[d].kind == DALCS_SWITCH) {
            row->position[d] = file_position(a, row, before, d);
        }
    }
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        row->is_spent[n] = false;
    }
    for (int round = 0; round < MOST_ROUNDS; round++) {
        file_take_given(a, row);
        take_laws(a, row, false);
        file_peel(a, row);
        if (round == 0) {
            take_laws(a, row, true);
            file_peel(a, row);
        }
    }
    file_take_given(a, row);
}
