/* steady_near.c - a steady state from that of a circuit that differs by little. */
#include "sensitivity.h"
#include "steady_step.h"

#include <string.h>

/* What a residual of 1e-11 leaves is 1e-11 / (1 - the largest multiplier): one more step squares that. */
static enum dalcs_status polish(struct dalcs_steady *st) {
    const enum dalcs_status status = dalcs_steady_next_step(st);
    for (int x = 0; x < st->layout.n_x && status == DALCS_OK; x++) {
        st->at.x[x] += st->step[x];
    }
    st->period += status == DALCS_OK ? st->own.longer : 0.0;
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    return dalcs_steady_pass(st, 1, DALCS_STEADY_M);
}

static enum dalcs_status take_point(struct dalcs_steady *st, bool is_free,
                                    const struct dalcs_steady_near *near) {
    if (st->layout.n_x != near->n_x || st->layout.n_pairs != near->n_pairs) {
        return DALCS_NOT_CONVERGED;
    }
    memcpy(st->at.x, near->point.x, (size_t)near->n_x * sizeof(double));
    memcpy(st->at.closed, near->point.closed, (size_t)near->n_pairs * sizeof(bool));
    st->has_point = true;
    st->own.is_free = is_free;
    st->period = is_free ? near->period : st->period;
    return DALCS_OK;
}

/* What the last pass, with M, is like: to the steady state of the circuit with the netlist's values. */
static void hand_on(const struct dalcs_steady *st, struct dalcs_steady *to) {
    const struct dalcs_steady_layout *l = &st->layout;
    const size_t n = (size_t)l->n_x;
    dalcs_steady_copy_point(st, &to->at, &st->at);
    memcpy(to->pass.M, st->pass.M, l->first_of_M[l->n_systems] * sizeof(double));
    memcpy(to->scale, st->scale, n * sizeof(double));
    memcpy(to->pass.first, st->pass.first, n * sizeof(double));
    memcpy(to->pass.last, st->pass.last, n * sizeof(double));
    memcpy(to->pass.phase, st->pass.phase, n * sizeof(double));
    to->period = st->period;
    to->pass.is_exact = st->pass.is_exact;
}

enum dalcs_status dalcs_steady_from_near(struct dalcs_steady *st, bool is_free,
                                         struct dalcs_steady_near *near) {
    struct dalcs_orbit_point best;
    bool found = false;
    DALCS_TRY(take_point(st, is_free, near));
    if (!dalcs_steady_make_point(st, &best)) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_steady_burst(st, &found));
    if (!found) {
        return DALCS_NOT_CONVERGED;
    }
    DALCS_TRY(dalcs_steady_refine(st, &best));
    near->signature = st->pass.signature;
    DALCS_TRY(polish(st));
    if (near->orbit != NULL) {
        hand_on(st, near->orbit);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_at_near(struct dalcs_steady *st, bool is_free,
                                       struct dalcs_steady_near *near) {
    const bool measures = near->asked == DALCS_NEAR_MEASURE;
    DALCS_TRY(take_point(st, is_free, near));
    DALCS_TRY(dalcs_steady_pass(st, 1, measures ? DALCS_STEADY_MEANS : DALCS_STEADY_PLAIN));
    near->signature = st->pass.signature;
    if (!measures) {
        memcpy(near->image, st->then.x, (size_t)near->n_x * sizeof(double));
        return DALCS_OK;
    }
    st->run->s->results.report.steady.self_oscillating = is_free;
    st->run->s->results.report.steady.period = st->period;
    return dalcs_steady_report_signals(st);
}

bool dalcs_steady_near_measures(const struct dalcs_circuit *circuit) {
    bool does = circuit->results.n_fouriers > 0;
    for (int k = 0; k < circuit->results.n_measures; k++) {
        does = does || circuit->results.measure[k].analysis == DALCS_MEASURED_PSS;
    }
    return does;
}
