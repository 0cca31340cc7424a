/* operating_point.c - .op: one one-step problem, one row. */
#include "pipeline.h"

#include "audit_points.h"
#include "delayed.h"
#include "gates.h"
#include "measures.h"

#include <stdlib.h>

static enum dalcs_status measure_operating_point(struct dalcs_run *r, const double *row) {
    struct dalcs_measures measures = {0};
    enum dalcs_status status = dalcs_measures_start_rows(&measures, r, DALCS_MEASURED_OP, 0.0, 0.0);
    if (status == DALCS_OK) {
        dalcs_measures_row(&measures, 0.0, row);
        status = dalcs_measures_report(&measures, r, DALCS_OK);
    }
    dalcs_measures_finish(&measures);
    return status;
}

static enum dalcs_status solve(struct dalcs_run *r, const struct dalcs_network *network) {
    struct dalcs_session *s = r->s;
    struct dalcs_euler e;
    DALCS_TRY(dalcs_euler_setup(&e, &s->circuit, network, &r->osnsp, 1.0, 1.0));
    e.listener.open_user = &r->nonunique.undetermined;
    e.listener.on_open = dalcs_undetermined_at;
    struct dalcs_logic_run logic;
    enum dalcs_status status = dalcs_logic_run_setup(&logic, &s->circuit, &e, NULL);
    if (status == DALCS_OK) {
        status = dalcs_gates_operating_point(&e, &logic, s->circuit.analyses.transient.present);
        dalcs_warn_of_restless_gates(r, &logic);
    }
    if (status == DALCS_OK) {
        status = dalcs_run_begin_plot(r, DALCS_OPERATING_POINT);
    }
    if (status == DALCS_OK) {
        e.failure.at_operating_point = true;
        status = dalcs_undetermined_several(&r->nonunique.undetermined, &e, 0.0);
        e.failure.at_operating_point = false;
    }
    double *row = dalcs_alloc((size_t)network->n_outputs, sizeof(*row));
    if (status == DALCS_OK && row == NULL) {
        status = DALCS_E_NOMEM;
    }
    if (status == DALCS_OK) {
        dalcs_recorder_evaluate(network, &e, row);
        status = r->sink->row(r->sink->user, 0.0, row);
    }
    if (status == DALCS_OK) {
        const struct dalcs_solved_point point = {
            .circuit = &s->circuit, .network = network, .euler = &e, .logic = &logic, .row = row};
        status = dalcs_audit_point(r, &point);
    }
    if (status == DALCS_OK) {
        status = measure_operating_point(r, row);
    }
    if (status == DALCS_OK) {
        status = r->sink->end(r->sink->user);
    }
    if (status == DALCS_OK && !s->circuit.analyses.transient.present) {
        dalcs_recorder_states(network, &e, s->results.start);
        dalcs_recorder_states(network, &e, s->results.final);
    }
    free(row);
    status = dalcs_explain_failure(r, &e, status);
    dalcs_run_add_work(r, &e);
    dalcs_logic_run_finish(&logic);
    dalcs_euler_finish(&e);
    return status;
}

enum dalcs_status dalcs_operating_point_run(struct dalcs_run *r) {
    struct dalcs_session *s = r->s;
    if (s->circuit.control.n_delayed == 0) {
        return solve(r, &s->network);
    }
    struct dalcs_network at_rest;
    dalcs_delayed_rest(&s->circuit);
    DALCS_TRY(dalcs_network_build(
        &at_rest, &s->circuit,
        &(struct dalcs_network_options){.at_rest = true, .silent = true, .with_readout = true},
        &s->diag));
    const enum dalcs_status status = solve(r, &at_rest);
    dalcs_network_finish(&at_rest);
    return status;
}
