/* audit_response.c - what .ac has found at a frequency, read as voltages and currents of the elements. */
#include "audit_response.h"

#include "audit_points.h"

#include "congruential.h"
#include "pi.h"
#include "quantity.h"
#include "rounding.h"

#include <math.h>

/* Of so many frequencies one is looked at by default, and the first and the last: a look takes about a fifth of what a
 * frequency takes to solve; around an orbit, where events and pieces of a period are looked at, four times as much as one. */
enum { FREQUENCIES_APART = 16, AROUND_ORBITS_APART = 64 };

/* ---- Columns to voltages and currents ------------------------------------------------------------ */

static double complex column(const struct dalcs_audit_response *a, int system, int k) {
    const struct dalcs_response_columns *of = &a->of[system];
    return of->part[0][k] + (of->part[1] != NULL ? of->part[1][k] : 0.0) * I;
}

static void read_current(struct dalcs_audit_response *a, int device) {
    const struct dalcs_readout *r = a->readout;
    double complex sum = 0.0;
    double size = 0.0;
    for (int k = r->start[device]; k < r->start[device + 1]; k++) {
        const double complex term =
            r->term[k].coefficient * column(a, r->device_system[device], r->term[k].column);
        sum += term;
        size += cabs(term);
    }
    a->values.i[device] = sum;
    a->values.size[device] = r->start[device + 1] > r->start[device] ? size : -1.0;
}

void dalcs_audit_response_read(struct dalcs_audit_response *a) {
    const struct dalcs_readout *r = a->readout;
    for (int n = 0; n < r->n_nodes; n++) {
        const bool is_column = a->node_system[n] >= 0 && r->node_column[n] >= 0;
        a->values.v[n] = is_column ? column(a, a->node_system[n], r->node_column[n]) : 0.0;
    }
    for (int d = 0; d < r->n_devices; d++) {
        a->values.i[d] = 0.0;
        a->values.size[d] = -1.0;
        if (a->is_there[d]) {
            read_current(a, d);
        }
    }
}

/* At rest: no current in capacitors. Those of resistors and the like play no part in lines. */
static void complete_point(struct dalcs_audit_response *a) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    for (int d = 0; d < c->n_devices; d++) {
        const struct dalcs_device *device = &c->device[d];
        double complex y = 0.0;
        if (a->values.size[d] >= 0.0 || !a->is_there[d]) {
            continue;
        }
        if (device->kind == DALCS_RESISTOR && device->value != 0.0) {
            y = (a->values.v[device->node[0]] - a->values.v[device->node[1]]) / device->value;
        }
        if (device->kind == DALCS_RESISTOR || device->kind == DALCS_CAPACITOR) {
            a->values.i[d] = y;
            a->values.size[d] = cabs(y);
        }
    }
}

/* ---- Start --------------------------------------------------------------------------------------- */

static enum dalcs_status make_room(struct dalcs_audit_response *a) {
    const size_t n_nodes = (size_t)a->readout->n_nodes, n_devices = (size_t)a->readout->n_devices;
    a->values.v = dalcs_arena_alloc(&a->arena, n_nodes, sizeof *a->values.v);
    a->values.i = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->values.i);
    a->values.size = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->values.size);
    a->is_there = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->is_there);
    a->is_restless = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->is_restless);
    a->node_system = dalcs_arena_alloc(&a->arena, n_nodes, sizeof *a->node_system);
    return a->values.v != NULL && a->values.i != NULL && a->values.size != NULL &&
                   a->is_there != NULL && a->is_restless != NULL && a->node_system != NULL
               ? DALCS_OK
               : DALCS_E_NOMEM;
}

static void find_systems(struct dalcs_audit_response *a, const struct dalcs_euler *e) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    for (int n = 0; n < c->n_nodes; n++) {
        a->node_system[n] = -1;
    }
    for (int d = 0; d < c->n_devices; d++) {
        const int system = a->readout->device_system[d];
        a->is_there[d] = system >= 0;
        a->is_restless[d] = system >= 0 && e->component[system].commands.restless != NULL;
        for (int k = 0; k < 2 && system >= 0; k++) {
            a->node_system[c->device[d].node[k]] = system;
        }
    }
}

static enum dalcs_status audit_point(struct dalcs_run *r, struct dalcs_solved_point point) {
    const struct dalcs_network *network = point.network;
    double *row = dalcs_alloc((size_t)network->n_outputs, sizeof *row);
    if (row == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_recorder_evaluate(network, point.euler, row);
    point.row = row;
    const enum dalcs_status status = dalcs_audit_point(r, &point);
    free(row);
    return status;
}

enum dalcs_status dalcs_audit_response_rows(struct dalcs_audit_response *a, struct dalcs_run *r,
                                            const struct dalcs_euler *euler,
                                            struct dalcs_response_columns *of, int n) {
    *a =
        (struct dalcs_audit_response){.run = r, .of = of, .n = n, .readout = r->s->network.readout};
    a->laws.tolerance = r->tolerance;
    DALCS_TRY(make_room(a));
    find_systems(a, euler);
    return DALCS_OK;
}

enum dalcs_status dalcs_audit_response_start(struct dalcs_audit_response *a, struct dalcs_run *r,
                                             const struct dalcs_solved_point *point,
                                             struct dalcs_response_columns *of, int n) {
    const struct dalcs_network *network = point->network;
    *a = (struct dalcs_audit_response){.run = r, .of = of, .n = n};
    if (r->options->audit == DALCS_AUDIT_OFF || network->readout == NULL) {
        return DALCS_OK;
    }
    DALCS_TRY(audit_point(r, *point));
    a->readout = network->readout;
    DALCS_TRY(make_room(a));
    find_systems(a, point->euler);
    struct dalcs_response_columns *at =
        dalcs_arena_alloc(&a->arena, (size_t)network->n_systems, sizeof *at);
    if (at == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < network->n_systems; k++) {
        at[k].part[0] = point->euler->component[k].y;
    }
    a->of = at;
    dalcs_audit_response_read(a);
    complete_point(a);
    a->of = of;
    const struct dalcs_response_devices devices = {a->is_there, a->is_restless};
    return dalcs_response_audit_start(&a->laws, &r->s->circuit, &devices, &a->values, r->tolerance);
}

void dalcs_audit_response_finish(struct dalcs_audit_response *a) {
    dalcs_response_audit_finish(&a->laws);
    dalcs_arena_finish(&a->arena);
    *a = (struct dalcs_audit_response){0};
}

/* ---- One frequency ------------------------------------------------------------------------------- */

/* The first and the last, and others that are drawn. */
bool dalcs_audit_response_draws(struct dalcs_audit_response *a, int k) {
    const bool is_next = k == a->next;
    if (is_next) {
        const double chance = dalcs_congruential_chance(&a->seed);
        const int apart = a->laws.circuit != NULL ? FREQUENCIES_APART : AROUND_ORBITS_APART;
        a->next = k + 1 + (int)(chance * (2 * apart - 1));
    }
    return is_next || k + 1 == a->n || a->run->options->audit == DALCS_AUDIT_FULL;
}

/* What is written of a signal is what its nodes or its device have. */
static bool is_row_right(const struct dalcs_audit_response *a, const double *row, int *wrong,
                         double *off) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    const struct dalcs_network *network = &a->run->s->network;
    for (int k = 0; k < network->n_outputs; k++) {
        const struct dalcs_signal *s = &c->results.signal[k];
        const double complex is = row[2 * k] + row[2 * k + 1] * I;
        const bool is_current = s->kind == DALCS_SIGNAL_CURRENT;
        if (is_current && a->values.size[s->device] < 0.0) {
            continue;
        }
        const double complex wanted =
            is_current ? a->values.i[s->device] : a->values.v[s->node[0]] - a->values.v[s->node[1]];
        const double size = is_current
                                ? fmax(a->values.size[s->device], cabs(wanted))
                                : cabs(a->values.v[s->node[0]]) + cabs(a->values.v[s->node[1]]);
        *off = cabs(is - wanted);
        if (*off >
            a->laws.tolerance * cabs(wanted) +
                dalcs_answer_rounded * (size + (is_current ? a->laws.amperes : a->laws.volts))) {
            *wrong = k;
            return false;
        }
    }
    return true;
}

enum dalcs_status dalcs_audit_response_refute(struct dalcs_run *r, double frequency,
                                              const char *what, double off, const char *unit) {
    dalcs_diag_add(&r->s->diag, DALCS_ERROR,
                   r->response_at != NULL ? r->response_at : &r->s->circuit.analyses.ac.where,
                   "please report this netlist",
                   "the response at %.9g Hz seems wrong: the audit finds %s off by %.3g %s",
                   frequency, what != NULL ? what : "a law", off, unit);
    return DALCS_REFUTED;
}

/* Is a defect of a device one of its voltage or its current? */
static const char *unit_of(const struct dalcs_circuit *c, const struct dalcs_response_finding *f) {
    const struct dalcs_device *d = f->law != DALCS_RESPONSE_NODE ? &c->device[f->index] : NULL;
    bool is_current = d == NULL;
    if (f->law == DALCS_RESPONSE_BRANCH) {
        is_current = d->kind == DALCS_ISOURCE || d->kind == DALCS_VCCS || d->kind == DALCS_CCCS ||
                     d->kind == DALCS_CAPACITOR;
    } else if (f->law == DALCS_RESPONSE_STATE) {
        is_current = d->kind == DALCS_INDUCTOR;
    } else if (f->law == DALCS_RESPONSE_TIME) {
        return "of what it follows";
    }
    return is_current ? "A" : "V";
}

enum dalcs_status dalcs_audit_response_tell(struct dalcs_run *r, struct dalcs_response_audit *laws,
                                            double frequency) {
    static const char *const before[] = {"", "KCL at ", "", "the time of an event of "};
    static const char *const behind[] = {"", "", " across an event", ""};
    const struct dalcs_circuit *c = &r->s->circuit;
    const struct dalcs_response_finding *f = &laws->worst;
    const double defect = f->defect > 0.0 ? laws->tolerance * f->defect / f->allowed : 0.0;
    const char *where = f->defect == 0.0                ? ""
                        : f->law == DALCS_RESPONSE_NODE ? c->node_name[f->index]
                                                        : c->device[f->index].name;
    const char *what =
        dalcs_arena_printf(&laws->arena, "%s%s%s", before[f->law], where, behind[f->law]);
    DALCS_TRY(dalcs_audit_add_frequency(r, defect, what, frequency));
    return f->defect > f->allowed
               ? dalcs_audit_response_refute(r, frequency, what, f->defect, unit_of(c, f))
               : DALCS_OK;
}

enum dalcs_status dalcs_audit_response_row(struct dalcs_audit_response *a, double frequency,
                                           const double *row) {
    int wrong;
    double off;
    if (is_row_right(a, row, &wrong, &off)) {
        return DALCS_OK;
    }
    const enum dalcs_signal_kind kind = a->run->s->circuit.results.signal[wrong].kind;
    return dalcs_audit_response_refute(a->run, frequency, a->run->signals.name[wrong], off,
                                       kind == DALCS_SIGNAL_CURRENT ? "A" : "V");
}

enum dalcs_status dalcs_audit_response_look(struct dalcs_audit_response *a, int k, double frequency,
                                            const double *row) {
    if (a->readout == NULL || !dalcs_audit_response_draws(a, k)) {
        return DALCS_OK;
    }
    dalcs_audit_response_read(a);
    a->laws.worst = (struct dalcs_response_finding){0};
    dalcs_response_audit_look(&a->laws, dalcs_two_pi * frequency, &a->values);
    DALCS_TRY(dalcs_audit_response_tell(a->run, &a->laws, frequency));
    return dalcs_audit_response_row(a, frequency, row);
}
