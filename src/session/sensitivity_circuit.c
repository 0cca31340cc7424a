/* sensitivity_circuit.c - a circuit with another value beside the one whose orbit is known. */
#include "sensitivity_internal.h"

#include <math.h>

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    (void)user;
    (void)plot;
    return DALCS_OK;
}

static enum dalcs_status row(void *user, double time, const double *value) {
    (void)user;
    (void)time;
    (void)value;
    return DALCS_OK;
}

static enum dalcs_status progress(void *user, double time, double stop) {
    return dalcs_run_progress(user, time, stop);
}

double dalcs_sensitivity_place(int which) {
    static const double place[N_ORBITS] = {0.0, 1.0, -1.0, 2.0, -2.0};
    return place[which];
}

enum dalcs_status dalcs_sensitivity_build(struct dalcs_sensitivities *s,
                                          const struct dalcs_override *override, size_t n,
                                          struct dalcs_session *other) {
    struct dalcs_session *of = s->run->s;
    other->name = of->name;
    other->asks.steady = of->asks.steady;
    DALCS_TRY(dalcs_session_build(of, override, n, &other->circuit, &other->network));
    other->has_circuit = other->has_network = true;
    other->circuit.analyses.sensitivity.present = false;
    other->circuit.analyses.periodic.present = true;
    const enum dalcs_status status =
        dalcs_operating_currents_keep(&other->circuit, &other->network, &of->circuit, &other->diag);
    other->has_network = status == DALCS_OK;
    return status;
}

enum dalcs_status dalcs_sensitivity_run(struct dalcs_sensitivities *s, struct dalcs_session *other,
                                        struct dalcs_steady_near *near, bool *same) {
    const struct dalcs_sink sink = {
        .user = s->run, .begin = begin, .row = row, .progress = progress};
    const bool is_first = near->orbit != NULL;
    near->n_x = s->st->layout.n_x;
    near->n_pairs = s->st->layout.n_pairs;
    other->steady.near = near;
    const enum dalcs_status status =
        dalcs_session_run_analysis(other, &s->options, &sink, DALCS_PERIODIC);
    other->steady.near = NULL;
    s->signature = is_first ? near->signature : s->signature;
    *same = status == DALCS_OK && (s->may_differ || near->signature == s->signature);
    return status > DALCS_OK && !is_first ? DALCS_OK : status;
}

void dalcs_sensitivity_take(struct dalcs_sensitivities *s, const struct dalcs_session *other,
                            int which, bool *same) {
    *same = *same && dalcs_sensitivity_count(&other->results.report) == s->n_results;
    for (size_t k = 0; *same && k < s->n_results; k++) {
        s->value[which][k] = dalcs_sensitivity_get(&other->results.report, k).value;
    }
}
