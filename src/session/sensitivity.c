/* sensitivity.c - .sens: orbits of the circuit with other values, and differences of what they measure. */
#include "sensitivity.h"

#include <math.h>
#include <string.h>

/* h: the error of the fourth order is below 1e-10 of what depends on a value as a power of it does, and rounding, 1e-13
 * of a measurement, leaves as much. Near a value where modes change it is taken smaller, as far as rounding allows. */
static const double first_step = 0x1p-10, less = 0x1p-3, last_step = 0x1p-19;

/* Orbits are found to so much, whatever the run's tolerance: differences show their errors. */
static const double tolerance_of_orbits = 1e-11;

/* A measurement with a corner at the value has a second difference that grows with h, else with its square. One below
 * this part of the measurement is rounding of it, extremes have 1e-10, and turns a derivative by 1e-5 at most. */
static const double corner = 3.0, rounding = 1e-8;

enum { AT_VALUE, PLUS, MINUS, PLUS_TWO, MINUS_TWO, N_ORBITS };

static const double place[N_ORBITS] = {0.0, 1.0, -1.0, 2.0, -2.0};

struct sensitivities {
    struct dalcs_steady *st;
    struct dalcs_run *run;
    struct dalcs_run_options options;
    uint64_t signature; /* of the orbit at the netlist's values */
    size_t n_results;
    struct dalcs_sensitivity_result *result; /* [n_results] the session's */
    double *value[N_ORBITS];                 /* [n_results] */
    struct dalcs_arena arena;
};

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

static const char *keep_text(struct dalcs_arena *arena, const char *text) {
    return dalcs_arena_copy(arena, text, strlen(text));
}

/* ---- One orbit ----------------------------------------------------------------------------------- */

/* A session of the circuit with the override. */
static enum dalcs_status build(struct sensitivities *s, const struct dalcs_override *override,
                               size_t n, struct dalcs_session *other) {
    struct dalcs_session *of = s->run->s;
    bool any;
    other->name = of->name;
    other->asks_steady = of->asks_steady;
    DALCS_TRY(dalcs_session_build(of, override, n, &other->circuit, &other->network));
    other->has_circuit = other->has_network = true;
    other->circuit.sensitivity.present = false;
    other->circuit.periodic.present = true;
    DALCS_TRY(dalcs_operating_currents_keep(&other->circuit, &of->circuit, &any));
    if (any) {
        const struct dalcs_network_options again = {.silent = true, .with_readout = true};
        dalcs_network_finish(&other->network);
        const enum dalcs_status status =
            dalcs_network_build(&other->network, &other->circuit, &again, &other->diag);
        other->has_network = status == DALCS_OK;
        return status;
    }
    return DALCS_OK;
}

static void finish(struct dalcs_session *other) {
    dalcs_session_forget_run(other);
    if (other->has_network) {
        dalcs_network_finish(&other->network);
    }
    if (other->has_circuit) {
        dalcs_circuit_finish(&other->circuit);
    }
    dalcs_diag_finish(&other->diag);
    dalcs_arena_finish(&other->arena);
}

/* What the first orbit has measured, for the report. */
static enum dalcs_status list_results(struct sensitivities *s, const struct dalcs_report *report) {
    struct dalcs_arena *arena = &s->run->s->arena;
    s->n_results = dalcs_sensitivity_count(report);
    s->result = dalcs_arena_alloc(arena, s->n_results + 1, sizeof *s->result);
    bool complete = s->result != NULL;
    for (int k = 0; k < N_ORBITS && complete; k++) {
        s->value[k] = dalcs_arena_alloc(&s->arena, s->n_results + 1, sizeof(double));
        complete = s->value[k] != NULL;
    }
    for (size_t k = 0; k < s->n_results && complete; k++) {
        s->result[k] = dalcs_sensitivity_get(report, k);
        s->result[k].name = keep_text(arena, s->result[k].name);
        complete = s->result[k].name != NULL;
    }
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

/* *same: its modes follow each other as on the first one, and it has measured as much. */
static enum dalcs_status run_orbit(struct sensitivities *s, const struct dalcs_override *override,
                                   size_t n, int which, bool *same) {
    struct dalcs_session other = {0};
    struct dalcs_steady_near near = {.point = s->st->at,
                                     .n_x = s->st->layout.n_x,
                                     .n_pairs = s->st->layout.n_pairs,
                                     .period = s->st->period};
    const struct dalcs_sink sink = {
        .user = s->run, .begin = begin, .row = row, .progress = progress};
    other.near = &near;
    *same = false;
    enum dalcs_status status = build(s, override, n, &other);
    if (status == DALCS_OK) {
        status = dalcs_session_run_analysis(&other, &s->options, &sink, DALCS_PERIODIC);
    }
    if (status == DALCS_OK && which == AT_VALUE) {
        s->signature = near.signature;
        status = list_results(s, &other.report);
    }
    if (status == DALCS_OK) {
        *same = near.signature == s->signature &&
                dalcs_sensitivity_count(&other.report) == s->n_results;
    }
    for (size_t k = 0; *same && k < s->n_results; k++) {
        s->value[which][k] = dalcs_sensitivity_get(&other.report, k).value;
    }
    finish(&other);
    return status <= DALCS_OK ? status : which == AT_VALUE ? status : DALCS_OK;
}

/* ---- Differences --------------------------------------------------------------------------------- */

/* Phases differ by less than half a turn. */
static double difference(const struct sensitivities *s, size_t k, int which) {
    const double d = s->value[which][k] - s->value[AT_VALUE][k];
    return strcmp(s->result[k].kind, "phase") == 0 ? remainder(d, 360.0) : d;
}

static double differentiate(const struct sensitivities *s, size_t k, double by) {
    const double near[2] = {difference(s, k, PLUS), difference(s, k, MINUS)};
    const double far_[2] = {difference(s, k, PLUS_TWO), difference(s, k, MINUS_TWO)};
    const double bend = fabs(near[0] + near[1]);
    const double noise = rounding * dalcs_sensitivity_scale(s->result, s->n_results, k);
    const bool has_corner = bend > noise && fabs(far_[0] + far_[1]) < corner * bend;
    return has_corner ? (double)NAN
                      : (8.0 * (near[0] - near[1]) - (far_[0] - far_[1])) / (12.0 * by);
}

/* A source of 0 V is varied by as much of 1 V. */
static enum dalcs_status vary(struct sensitivities *s, const struct dalcs_sweep *item, double *by) {
    const double size = item->start != 0.0 ? fabs(item->start) : 1.0;
    bool same = false;
    for (double h = first_step; h >= last_step && !same; h *= less) {
        *by = h * size;
        same = true;
        for (int k = PLUS; k < N_ORBITS && same; k++) {
            struct dalcs_override override;
            (void)dalcs_override_of(item, item->start + place[k] * *by, &override);
            DALCS_TRY(run_orbit(s, &override, 1, k, &same));
        }
    }
    *by = same ? *by : 0.0;
    return DALCS_OK;
}

static enum dalcs_status differentiate_all(struct sensitivities *s, const struct dalcs_sweep *item,
                                           double **derivative, size_t p) {
    double by;
    bool any = false;
    DALCS_TRY(vary(s, item, &by));
    for (size_t k = 0; k < s->n_results; k++) {
        derivative[k][p] = by > 0.0 ? differentiate(s, k, by) : (double)NAN;
        any = any || isfinite(derivative[k][p]);
    }
    if (!any && s->n_results > 0) {
        dalcs_diag_add(&s->run->s->diag, DALCS_WARNING, &item->where,
                       "there the orbit's modes change, as at the border of discontinuous "
                       "conduction; take a value beside it",
                       ".sens: there is no derivative by '%s' at %.9g", item->label, item->start);
    }
    return DALCS_OK;
}

/* ---- All of it ----------------------------------------------------------------------------------- */

static enum dalcs_status fill_report(struct sensitivities *s) {
    struct dalcs_session *session = s->run->s;
    const struct dalcs_sensitivity_card *card = &session->circuit.sensitivity;
    const size_t n = (size_t)card->n;
    struct dalcs_sensitivity_parameter *parameter =
        dalcs_arena_alloc(&session->arena, n + 1, sizeof *parameter);
    double **derivative = dalcs_arena_alloc(&s->arena, s->n_results + 1, sizeof *derivative);
    bool complete = parameter != NULL && derivative != NULL;
    for (size_t k = 0; k < s->n_results && complete; k++) {
        derivative[k] = dalcs_arena_alloc(&session->arena, n + 1, sizeof(double));
        s->result[k].derivative = derivative[k];
        complete = derivative[k] != NULL;
    }
    for (size_t p = 0; p < n && complete; p++) {
        parameter[p] = (struct dalcs_sensitivity_parameter){
            keep_text(&session->arena, card->item[p].label), card->item[p].start};
        complete = parameter[p].name != NULL;
    }
    if (!complete) {
        return DALCS_E_NOMEM;
    }
    for (size_t p = 0; p < n; p++) {
        DALCS_TRY(differentiate_all(s, &card->item[p], derivative, p));
    }
    session->report.sensitivity.present = true;
    session->report.sensitivity.n_parameters = n;
    session->report.sensitivity.n_results = s->n_results;
    session->report.sensitivity.parameter = parameter;
    session->report.sensitivity.result = s->result;
    return DALCS_OK;
}

enum dalcs_status dalcs_sensitivities_run(struct dalcs_steady *st) {
    struct dalcs_run *r = st->run;
    struct sensitivities s = {.st = st, .run = r, .options = *r->options};
    s.options.tolerance = fmin(r->tolerance, tolerance_of_orbits);
    s.options.audit = DALCS_AUDIT_OFF;
    s.options.record = s.options.energy = false;
    s.options.dump_path = NULL;
    s.options.steady = true;
    dalcs_run_options_set_times(&s.options, NULL, 0);
    bool same;
    enum dalcs_status status = run_orbit(&s, NULL, 0, AT_VALUE, &same);
    if (status > DALCS_OK) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, NULL, NULL,
                       ".sens: the orbit could not be found once more: there are no sensitivities");
        status = DALCS_OK;
    } else if (status == DALCS_OK) {
        status = fill_report(&s);
    }
    dalcs_arena_finish(&s.arena);
    return status;
}
