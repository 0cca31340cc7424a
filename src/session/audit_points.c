/* audit_points.c - an operating point as a table of one row, and what the audit says of it.
 *
 * The table has the voltages of the row that is written, and beside them every voltage and every current that the engine
 * knows, so that no law has to be left out. A certified answer may be off by the rounding that the certificate allows. */
#include "audit_points.h"

#include "file_audit.h"
#include "names.h"
#include "quantity.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

/* Columns of one row, and the arena that all of it is in. */
struct point {
    const struct dalcs_circuit *circuit;
    const struct dalcs_readout *readout;
    const struct dalcs_euler *euler;
    struct dalcs_wave_table table;
    struct dalcs_names there; /* of its columns */
    const char **name;
    double *value, *relative, *absolute;
    double *largest[2]; /* [n_systems] V, A */
    struct dalcs_arena arena;
};

static enum dalcs_status make_room(struct point *p, size_t n_outputs) {
    const size_t most = 1 + n_outputs + (size_t)p->circuit->n_nodes + (size_t)p->circuit->n_devices;
    p->name = dalcs_arena_alloc(&p->arena, most, sizeof *p->name);
    p->value = dalcs_arena_alloc(&p->arena, most, sizeof(double));
    p->relative = dalcs_arena_alloc(&p->arena, most, sizeof(double));
    p->absolute = dalcs_arena_alloc(&p->arena, most, sizeof(double));
    for (int k = 0; k < 2; k++) {
        p->largest[k] =
            dalcs_arena_alloc(&p->arena, (size_t)p->euler->n_components, sizeof(double));
    }
    if (p->largest[0] == NULL || p->largest[1] == NULL || p->name == NULL || p->value == NULL ||
        p->relative == NULL || p->absolute == NULL) {
        return DALCS_E_NOMEM;
    }
    p->name[0] = "time";
    p->table = (struct dalcs_wave_table){.n_columns = 1,
                                         .n_rows = 1,
                                         .name = p->name,
                                         .value = p->value,
                                         .relative = p->relative,
                                         .absolute = p->absolute};
    return DALCS_OK;
}

static double largest_of(const struct point *p, int unit, int system) {
    return system >= 0 ? p->largest[unit][system] : 0.0;
}

/* The largest voltage of a node and current of each system. Where nothing flows, currents are what resistors make of the
 * rounding of voltages. */
static void find_largest(struct point *p) {
    const struct dalcs_readout *r = p->readout;
    for (int d = 0; d < p->circuit->n_devices; d++) {
        const int system = r->device_system[d];
        if (system < 0) {
            continue;
        }
        const double *y = p->euler->component[system].y;
        double *largest[2] = {&p->largest[0][system], &p->largest[1][system]};
        for (int k = 0; k < 2; k++) {
            const int column = r->node_column[p->circuit->device[d].node[k]];
            *largest[0] = fmax(*largest[0], column >= 0 ? fabs(y[column]) : 0.0);
        }
        *largest[1] = fmax(*largest[1], fabs(dalcs_readout_current(r, d, y)));
    }
    for (int d = 0; d < p->circuit->n_devices; d++) {
        const struct dalcs_device *device = &p->circuit->device[d];
        const int system = r->device_system[d];
        if (system >= 0 && device->kind == DALCS_RESISTOR && device->value != 0.0) {
            const double of_rounding = dalcs_rounded * p->largest[0][system] / fabs(device->value);
            p->largest[1][system] = fmax(p->largest[1][system], of_rounding / dalcs_answer_rounded);
        }
    }
}

/* One more column, unless one of that name is there; `size` is what its value is a sum of, `largest` the largest value of
 * its unit in its system. What elimination makes of a 0 is within the rounding of that: such a value is known to its own
 * size. */
static enum dalcs_status add(struct point *p, const char *name, double value, double size,
                             double largest) {
    const size_t c = p->table.n_columns;
    int found;
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_names_find_or_add(&p->there, name, (int)c, &found));
    if (found == (int)c) {
        p->name[c] = name;
        p->value[c] = value;
        const bool is_rounding = fabs(value) <= dalcs_answer_rounded * largest;
        p->absolute[c] = fmax(dalcs_answer_rounded * size, is_rounding ? fabs(value) : 0.0);
        p->table.n_columns++;
    }
    return DALCS_OK;
}

static double size_of(const struct point *p, const struct dalcs_probe *probe) {
    double size = 0.0;
    for (int k = 0; probe->system >= 0 && k < probe->n_terms + probe->n_inputs; k++) {
        const struct dalcs_component *c = &p->euler->component[probe->system];
        const double *from = k < probe->n_terms ? c->y : c->u + c->system->n_x;
        size += fabs(probe->term[k].coefficient * from[probe->term[k].index]);
    }
    return size;
}

/* The voltages that are written. A current may be that of several elements, of a coil and its Rpar. */
static enum dalcs_status add_row(struct point *p, const struct dalcs_network *network,
                                 const double *row) {
    for (int k = 0; k < network->n_outputs; k++) {
        const struct dalcs_output *output = &network->output[k];
        const double size = size_of(p, &output->plus) + size_of(p, &output->minus);
        if (!output->is_current) {
            DALCS_TRY(add(p, output->name, row[k], size,
                          fmax(largest_of(p, 0, output->plus.system),
                               largest_of(p, 0, output->minus.system))));
        }
    }
    return DALCS_OK;
}

/* The nodes that a device hangs on have columns in its system. */
static enum dalcs_status add_nodes(struct point *p, int device, bool *is_there) {
    const struct dalcs_device *d = &p->circuit->device[device];
    for (int k = 0; k < 4; k++) {
        const int node = d->node[k];
        const int column = node > 0 ? p->readout->node_column[node] : -1;
        if (column >= 0 && !is_there[node]) {
            is_there[node] = true;
            const char *name = dalcs_arena_printf(&p->arena, "v(%s)", p->circuit->node_name[node]);
            const int system = p->readout->device_system[device];
            const double v = p->euler->component[system].y[column];
            DALCS_TRY(add(p, name, v, fabs(v), largest_of(p, 0, system)));
        }
    }
    return DALCS_OK;
}

/* The current of a device. One whose element has a terminal (file_names.c) follows by Kirchhoff's law. */
static enum dalcs_status add_current(struct point *p, int device) {
    const struct dalcs_readout *r = p->readout;
    const char *of = p->circuit->device[device].name;
    const char *name = dalcs_arena_printf(&p->arena, "i(%s)", of);
    const char *terminal = dalcs_arena_printf(&p->arena, "i(terminal(%s))", of);
    const double *y = p->euler->component[r->device_system[device]].y;
    double size = 0.0;
    if (terminal == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = r->start[device]; k < r->start[device + 1]; k++) {
        size += fabs(r->term[k].coefficient * y[r->term[k].column]);
    }
    return r->start[device + 1] > r->start[device] && dalcs_names_find(&p->there, terminal) < 0
               ? add(p, name, dalcs_readout_current(r, device, y), size,
                     largest_of(p, 1, r->device_system[device]))
               : DALCS_OK;
}

/* Terminals and other inner devices first. */
static enum dalcs_status fill(struct point *p) {
    const struct dalcs_circuit *c = p->circuit;
    bool *is_there = dalcs_arena_alloc(&p->arena, (size_t)c->n_nodes, sizeof(bool));
    if (is_there == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < 2 * c->n_devices; d++) {
        const int device = d % c->n_devices;
        const bool is_now = dalcs_names_is_inner(c->device[device].name) == (d < c->n_devices);
        if (p->readout->device_system[device] >= 0 && is_now) {
            DALCS_TRY(add_nodes(p, device, is_there));
            DALCS_TRY(add_current(p, device));
        }
    }
    return DALCS_OK;
}

/* Of a part without an operating point a warning has told already: a switch in it is left as it stood. */
static bool is_excused(const struct point *p, const struct dalcs_table_law *law) {
    bool is = false;
    for (int d = 0; d < p->circuit->n_devices && strcmp(law->law, "POSITION") == 0; d++) {
        const int of = p->readout->device_system[d];
        is = is || (of >= 0 && p->euler->component[of].commands.restless != NULL &&
                    strcmp(p->circuit->device[d].name, law->where) == 0);
    }
    return is;
}

/* The worst law that counts; NULL: there is none. */
static const struct dalcs_table_law *worst_of(const struct point *p,
                                              const struct dalcs_table_audit *found) {
    const struct dalcs_table_law *worst = NULL;
    for (size_t k = 0; k < found->n_laws && worst == NULL; k++) {
        worst = is_excused(p, &found->law[k]) ? NULL : &found->law[k];
    }
    return worst;
}

void dalcs_audit_add_points(struct dalcs_run *r) {
    struct dalcs_report *report = &r->s->results.report;
    const struct dalcs_audited_points *points = &r->points;
    if (points->where == NULL) {
        return;
    }
    const bool is_worse = report->audit.mode == NULL || points->worst > report->audit.worst;
    report->audit.mode = r->options->audit == DALCS_AUDIT_FULL ? "full" : "sample";
    report->audit.instants += points->n;
    report->frequencies += points->frequencies;
    report->audit.positions += points->positions;
    if (is_worse) {
        report->audit.worst = points->worst;
        report->audit.allowed = points->allowed;
        report->audit.where = points->where;
        report->audit.time = 0.0;
    }
    r->points = (struct dalcs_audited_points){0};
}

/* The worst law over its scale, and how many positions there were. */
static enum dalcs_status fold(struct dalcs_run *r, const struct dalcs_table_audit *found,
                              const struct dalcs_table_law *worst) {
    struct dalcs_audited_points *points = &r->points;
    const double defect = worst == NULL || worst->defect == 0.0
                              ? 0.0
                              : found->tolerance * worst->defect / worst->allowed;
    points->n++;
    points->allowed = found->tolerance;
    for (size_t k = 0; k < found->n_laws; k++) {
        points->positions += strcmp(found->law[k].law, "POSITION") == 0 ? 1 : 0;
    }
    if (points->where == NULL || defect > points->worst) {
        const bool is_node = worst != NULL && strcmp(worst->law, "KCL") == 0;
        points->worst = defect;
        points->where = dalcs_arena_printf(&r->s->arena, "%s%s", is_node ? "KCL at " : "",
                                           worst == NULL ? "" : worst->where);
    }
    return points->where != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_audit_add_frequency(struct dalcs_run *r, double defect, const char *what,
                                            double frequency) {
    struct dalcs_audited_points *points = &r->points;
    char text[DALCS_QUANTITY_SIZE];
    points->frequencies++;
    points->allowed = r->tolerance;
    if (points->where == NULL || defect > points->worst) {
        points->worst = defect;
        points->where = dalcs_arena_printf(&r->s->arena, "%s at %s", what == NULL ? "" : what,
                                           dalcs_quantity_write(text, frequency, "Hz", 6));
    }
    return points->where != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

static enum dalcs_status judge(struct dalcs_run *r, struct point *p,
                               const struct dalcs_solved_point *point) {
    const struct dalcs_file_promise promise = {.tolerance = r->tolerance,
                                               .vntol = r->radau.vntol,
                                               .abstol = r->radau.abstol,
                                               .are_gates_restless =
                                                   !dalcs_logic_run_is_at_rest(point->logic),
                                               .remembers = point->remembers,
                                               .has_own_lines = true};
    struct dalcs_table_audit found;
    DALCS_TRY(dalcs_file_audit(p->circuit, &p->table, &promise, &p->arena, &r->s->diag, &found));
    const struct dalcs_table_law *law = worst_of(p, &found);
    DALCS_TRY(fold(r, &found, law));
    if (law == NULL || !(law->defect > law->allowed)) {
        return DALCS_OK;
    }
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL, "please report this netlist",
                   "the operating point seems wrong: the audit finds %s of %s off by %.3g %s, and "
                   "%.2g %s is allowed",
                   law->law, law->where, law->defect, law->unit, law->allowed, law->unit);
    return DALCS_REFUTED;
}

enum dalcs_status dalcs_audit_point(struct dalcs_run *r, const struct dalcs_solved_point *point) {
    const struct dalcs_network *network = point->network;
    if (r->options->audit == DALCS_AUDIT_OFF || network->readout == NULL) {
        return DALCS_OK;
    }
    struct point p = {
        .circuit = point->circuit, .readout = network->readout, .euler = point->euler};
    enum dalcs_status status = make_room(&p, (size_t)network->n_outputs);
    if (status == DALCS_OK) {
        find_largest(&p);
        status = add_row(&p, network, point->row);
    }
    if (status == DALCS_OK) {
        status = fill(&p);
    }
    if (status == DALCS_OK && p.table.n_columns > 1) {
        status = judge(r, &p, point);
    }
    dalcs_names_finish(&p.there);
    dalcs_arena_finish(&p.arena);
    return status;
}
