/* file_audit.c - the passes over the rows of a table, and the worst that was found. */
#include "audit_internal.h"
#include "file_internal.h"
#include "union_find.h"

#include <stdlib.h>

/* ---- Room --------------------------------------------------------------------------------------- */

static bool make(struct file_audit *a, void *array, size_t n, size_t size) {
    void *made = dalcs_arena_alloc(&a->arena, n, size);
    *(void **)array = made;
    return made != NULL;
}

static bool make_row(struct file_audit *a, struct file_row *row) {
    const size_t n_nodes = (size_t)a->circuit->n_nodes, n_devices = (size_t)a->circuit->n_devices;
    return make(a, &row->v, n_nodes, sizeof *row->v) &&
           make(a, &row->u, n_devices, sizeof *row->u) &&
           make(a, &row->i, n_devices, sizeof *row->i) &&
           make(a, &row->is_assumed, n_devices, sizeof *row->is_assumed) &&
           make(a, &row->position, n_devices, sizeof *row->position) &&
           make(a, &row->is_spent, n_nodes, sizeof *row->is_spent);
}

static bool make_for_nodes(struct file_audit *a) {
    const size_t n = (size_t)a->circuit->n_nodes;
    return make(a, &a->nodes.of, n, sizeof *a->nodes.of) &&
           make(a, &a->nodes.fed_from, n, sizeof *a->nodes.fed_from) &&
           make(a, &a->nodes.first_branch, n + 1, sizeof *a->nodes.first_branch) &&
           make(a, &a->columns.potential, n, sizeof *a->columns.potential) &&
           make(a, &a->columns.potential_of, n, sizeof *a->columns.potential_of) &&
           make(a, &a->columns.given_by, n, sizeof *a->columns.given_by) &&
           make(a, &a->columns.given, n, sizeof *a->columns.given) &&
           make(a, &a->coverage.ever_given, n, sizeof *a->coverage.ever_given) &&
           make(a, &a->scale.v, n, sizeof *a->scale.v) &&
           make(a, &a->coverage.is_covered, n, sizeof *a->coverage.is_covered) &&
           make(a, &a->coverage.is_checked, n, sizeof *a->coverage.is_checked) &&
           make(a, &a->sets.count, n, sizeof *a->sets.count) &&
           make(a, &a->sets.stack, n, sizeof *a->sets.stack) &&
           make(a, &a->sets.cluster, n, sizeof *a->sets.cluster) &&
           make(a, &a->sets.has_unspent, n, sizeof *a->sets.has_unspent) &&
           make(a, &a->sets.sum, n, sizeof *a->sets.sum) &&
           make(a, &a->sets.largest, n, sizeof *a->sets.largest) &&
           make(a, &a->sets.law, n, sizeof *a->sets.law) &&
           make(a, &a->window.of_node, n, sizeof *a->window.of_node);
}

static bool make_for_devices(struct file_audit *a) {
    const size_t n = (size_t)a->circuit->n_devices;
    return make(a, &a->nodes.branch, 2 * n, sizeof *a->nodes.branch) &&
           make(a, &a->columns.current, n, sizeof *a->columns.current) &&
           make(a, &a->scale.u, n, sizeof *a->scale.u) &&
           make(a, &a->scale.i, n, sizeof *a->scale.i) &&
           make(a, &a->coverage.ever_known, n, sizeof *a->coverage.ever_known) &&
           make(a, &a->coverage.ever_seen, n, sizeof *a->coverage.ever_seen) &&
           make(a, &a->charges.charge, n, sizeof *a->charges.charge) &&
           make(a, &a->charges.is_taken, n, sizeof *a->charges.is_taken) &&
           make(a, &a->window.of_device, n, sizeof *a->window.of_device) &&
           make(a, &a->columns.is_used, a->table->n_columns, sizeof *a->columns.is_used);
}

static enum dalcs_status make_room(struct file_audit *a) {
    int most = 0;
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const struct dalcs_behaviour *b = a->circuit->device[d].behaviour;
        most = b != NULL && b->n_pairs > most ? b->n_pairs : most;
    }
    bool complete =
        make_for_nodes(a) && make_for_devices(a) &&
        make(a, &a->gates.bit, (size_t)a->circuit->control.n_gates, sizeof *a->gates.bit) &&
        make(a, &a->gates.source, (size_t)a->circuit->n_stimuli, sizeof(int)) &&
        make(a, &a->formulas.value, (size_t)most, sizeof *a->formulas.value) &&
        make(a, &a->formulas.error, (size_t)most, sizeof *a->formulas.error);
    for (int k = 0; k < 4; k++) {
        complete = complete && make_row(a, &a->row[k]);
    }
    for (int law = 0; law < FILE_LAWS; law++) {
        const int n = law == DALCS_AUDIT_KCL ? a->circuit->n_nodes : a->circuit->n_devices;
        complete = complete && make(a, &a->worst[law], (size_t)n, sizeof **a->worst);
    }
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

/* ---- The circuit -------------------------------------------------------------------------------- */

/* Nodes that shorts join have one potential. KCL holds at both ends of one whose current the file has. */
static void merge_shorts(struct file_audit *a, bool with_measured) {
    const struct dalcs_circuit *c = a->circuit;
    dalcs_union_reset(a->nodes.of, c->n_nodes);
    dalcs_union_reset(a->nodes.fed_from, c->n_nodes);
    for (int d = 0; d < c->n_devices; d++) {
        const struct dalcs_device *device = &c->device[d];
        const bool is_short = dalcs_device_is_short(device);
        if (is_short && (with_measured || a->columns.current[d] < 0)) {
            dalcs_union_join(a->nodes.of, device->node[0], device->node[1]);
        }
        if (is_short || device->kind == DALCS_VSOURCE) {
            dalcs_union_join(a->nodes.fed_from, device->node[0], device->node[1]);
        }
    }
    for (int n = 0; n < c->n_nodes; n++) {
        a->nodes.of[n] = dalcs_union_find(a->nodes.of, n);
        a->nodes.fed_from[n] = dalcs_union_find(a->nodes.fed_from, n);
    }
}

/* Branches by the nodes that they hang on; those with both ends on one carry nothing to it. */
static void list_branches(struct file_audit *a) {
    const struct dalcs_circuit *c = a->circuit;
    for (int fill = 0; fill < 2; fill++) {
        for (int d = 0; d < c->n_devices; d++) {
            const int end[2] = {a->nodes.of[c->device[d].node[0]],
                                a->nodes.of[c->device[d].node[1]]};
            for (int e = 0; e < 2 && end[0] != end[1]; e++) {
                if (fill) {
                    a->nodes.branch[a->nodes.first_branch[end[e]] + a->sets.count[end[e]]++] = d;
                } else {
                    a->nodes.first_branch[end[e] + 1]++;
                }
            }
        }
        for (int n = 0; n < c->n_nodes && !fill; n++) {
            a->nodes.first_branch[n + 1] += a->nodes.first_branch[n];
        }
    }
}

/* ---- What is found ------------------------------------------------------------------------------ */

bool file_find(struct file_audit *a, enum dalcs_audit_law law, int index, const char *unit,
               double defect, double allowed, double from, double to) {
    struct file_worst *w = &a->worst[law][index];
    const double ratio = defect == 0.0 ? 0.0 : defect / fmax(allowed, 0x1p-1022);
    const bool is_worst = w->n_checked == 0 || ratio > w->ratio;
    w->n_checked++;
    w->since = ratio > 1.0 && w->n_broken == 0 ? to : w->since;
    w->n_broken += ratio > 1.0 ? 1 : 0;
    if (is_worst) {
        w->ratio = ratio;
        w->defect = defect;
        w->allowed = allowed;
        w->from = from;
        w->to = to;
        w->unit = unit;
    }
    return is_worst;
}

/* ---- Passes ------------------------------------------------------------------------------------- */

static void raise(double *scale, double *most, struct file_number x) {
    if (x.known) {
        *scale = fmax(*scale, fabs(x.value));
        *most = fmax(*most, *scale);
    }
}

static bool is_part(const struct file_audit *a, int device) {
    return device >= 0 && a->circuit->device[device].behaviour != NULL &&
           a->circuit->device[device].behaviour->is_part;
}

/* Other voltages are not measured by what parts of formulas are. */
static void note_scales(struct file_audit *a, const struct file_row *row) {
    double of_parts = 0.0;
    for (int d = 0; d < a->circuit->n_devices; d++) {
        raise(&a->scale.u[d], is_part(a, d) ? &of_parts : &a->scale.volts, row->u[d]);
        raise(&a->scale.i[d], &a->scale.amperes, row->i[d]);
        a->coverage.ever_known[d] = a->coverage.ever_known[d] || row->i[d].known;
        a->coverage.ever_seen[d] =
            a->coverage.ever_seen[d] || (row->i[d].known && !row->is_assumed[d]);
    }
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        raise(&a->scale.v[n], is_part(a, a->columns.given_by[n]) ? &of_parts : &a->scale.volts,
              row->v[n]);
    }
}

/* Each unit vouches a millionth for the other through the conductances, as in a run (kirchhoff.c): a voltage of 0 is what
 * rounding of currents makes of it. */
static void vouch(struct file_audit *a) {
    struct audit_floor floor = {0};
    for (int d = 0; d < a->circuit->n_devices; d++) {
        audit_see_conductances(&floor, a->circuit, &a->circuit->device[d]);
    }
    a->scale.vouched[0] = floor.most > 0.0 ? 1e-6 / floor.most * a->scale.amperes : 0.0;
    a->scale.vouched[1] = 1e-6 * floor.least * a->scale.volts;
}

static void check_row(struct file_audit *a, size_t k) {
    const size_t n = a->table->n_rows;
    struct file_row *now = &a->row[k % 4];
    file_check_branches(a, now);
    file_check_nodes(a, now);
    file_check_gates(a, now);
    if (k == 0 && !a->is_at_rest) {
        file_check_start(a, now, &a->row[3]);
    }
    struct file_row *const around[4] = {k >= 3 ? &a->row[(k - 3) % 4] : NULL,
                                        k >= 2 ? &a->row[(k - 2) % 4] : NULL,
                                        k >= 1 ? &a->row[(k - 1) % 4] : NULL, now};
    if (k >= 2 && !around[2]->is_behind) {
        file_check_interval(a, around);
    }
    if (k >= 1 && now->is_behind) {
        file_check_jump(a, around[2], now);
    }
    struct file_row *const last[4] = {around[1], around[2], now, NULL};
    if (k + 1 == n && k >= 1 && !now->is_behind) {
        file_check_interval(a, last);
    }
}

static void pass(struct file_audit *a, bool checks) {
    for (size_t k = 0; k < a->table->n_rows; k++) {
        file_evaluate(a, k, &a->row[k % 4], k > 0 ? &a->row[(k - 1) % 4] : NULL);
        if (checks) {
            check_row(a, k);
        } else {
            note_scales(a, &a->row[k % 4]);
        }
    }
}

/* ngspice gives an edge of no width the rise time tstep, and lets what follows the rise come as much later; a file
 * with two rows at one time knows jumps as they are. */
static double ramp_of(const struct file_audit *a) {
    const struct dalcs_wave_table *t = a->table;
    for (size_t k = 1; k < t->n_rows; k++) {
        if (file_is_behind(t, k)) {
            return 0.0;
        }
    }
    return 2.0 * a->circuit->analyses.transient.step;
}

static enum dalcs_status check_times(const struct file_audit *a, struct dalcs_diag *diag) {
    const struct dalcs_wave_table *t = a->table;
    for (size_t k = 0; k < t->n_rows; k++) {
        const double now = t->value[k * t->n_columns];
        if (!isfinite(now) || now < 0.0 || (k > 0 && now < t->value[(k - 1) * t->n_columns])) {
            dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL,
                           "the times of row %zu and the one above do not ascend from 0 on", k + 1);
            return DALCS_E_OPTION;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status audit(struct file_audit *a, struct dalcs_diag *diag) {
    DALCS_TRY(check_times(a, diag));
    DALCS_TRY(make_room(a));
    merge_shorts(a, true);
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        a->columns.potential_of[n] = a->columns.given_by[n] = -1;
    }
    for (int d = 0; d < a->circuit->n_devices; d++) {
        a->columns.current[d] = -1;
    }
    DALCS_TRY(file_find_columns(a, diag));
    file_find_given(a);
    merge_shorts(a, !a->promise.are_shorts_measured);
    list_branches(a);
    DALCS_TRY(file_take_tangents(a));
    a->is_before = file_rests_before(a);
    a->is_at_rest = a->table->n_rows == 1 && a->table->value[0] == 0.0;
    a->ramp = ramp_of(a);
    pass(a, false);
    vouch(a);
    pass(a, true);
    return DALCS_OK;
}

enum dalcs_status dalcs_file_audit(const struct dalcs_circuit *circuit,
                                   const struct dalcs_wave_table *table,
                                   const struct dalcs_file_promise *promise,
                                   struct dalcs_arena *arena, struct dalcs_diag *diag,
                                   struct dalcs_table_audit *result) {
    struct file_audit *a = dalcs_alloc(1, sizeof *a);
    if (a == NULL) {
        return DALCS_E_NOMEM;
    }
    *a = (struct file_audit){.circuit = circuit, .table = table, .promise = *promise};
    enum dalcs_status status = audit(a, diag);
    if (status == DALCS_OK) {
        status = file_report(a, arena, result);
    }
    dalcs_arena_finish(&a->arena);
    free(a);
    return status;
}
