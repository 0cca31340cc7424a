/* sensitivity.c - .sens: circuits with other values, and differences of what they measure. */
#include "sensitivity_internal.h"

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

static const char *keep_text(struct dalcs_arena *arena, const char *text) {
    return dalcs_arena_copy(arena, text, strlen(text));
}

/* ---- One orbit ----------------------------------------------------------------------------------- */

/* What the first orbit has measured, for the report. */
static enum dalcs_status list_results(struct dalcs_sensitivities *s,
                                      const struct dalcs_report *report) {
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

/* Newton's method from the orbit of the netlist's values, of a circuit with the override. */
static enum dalcs_status run_orbit(struct dalcs_sensitivities *s,
                                   const struct dalcs_override *override, size_t n, int which,
                                   bool *same) {
    struct dalcs_session other = {0};
    const bool is_first = which == AT_VALUE;
    struct dalcs_steady_near near = {
        .point = s->st->at, .period = s->st->period, .orbit = is_first ? s->st : NULL};
    *same = false;
    enum dalcs_status status = dalcs_sensitivity_build(s, override, n, &other);
    if (status == DALCS_OK) {
        status = dalcs_sensitivity_run(s, &other, &near, same);
    }
    if (status == DALCS_OK && is_first) {
        status = list_results(s, &other.report);
    }
    if (status == DALCS_OK) {
        dalcs_sensitivity_take(s, &other, which, same);
    }
    dalcs_session_finish_other(&other);
    return status <= DALCS_OK || is_first ? status : DALCS_OK;
}

/* ---- Differences --------------------------------------------------------------------------------- */

/* Phases differ by less than half a turn. */
static double difference(const struct dalcs_sensitivities *s, size_t k, int which) {
    const double d = s->value[which][k] - s->value[AT_VALUE][k];
    return strcmp(s->result[k].kind, "phase") == 0 ? remainder(d, 360.0) : d;
}

static double differentiate(const struct dalcs_sensitivities *s, size_t k, double by) {
    const double near[2] = {difference(s, k, PLUS), difference(s, k, MINUS)};
    const double far_[2] = {difference(s, k, PLUS_TWO), difference(s, k, MINUS_TWO)};
    const double bend = fabs(near[0] + near[1]);
    const double noise = rounding * dalcs_sensitivity_scale(s->result, s->n_results, k);
    const bool has_corner = bend > noise && fabs(far_[0] + far_[1]) < corner * bend;
    return has_corner ? (double)NAN
                      : (8.0 * (near[0] - near[1]) - (far_[0] - far_[1])) / (12.0 * by);
}

/* The four orbits themselves. */
static enum dalcs_status find_orbits(struct dalcs_sensitivities *s, const struct dalcs_sweep *item,
                                     double by, bool *same) {
    *same = true;
    for (int k = PLUS; k < N_ORBITS && *same; k++) {
        struct dalcs_override override;
        (void)dalcs_override_of(item, item->start + dalcs_sensitivity_place(k) * by, &override);
        DALCS_TRY(run_orbit(s, &override, 1, k, same));
    }
    return DALCS_OK;
}

/* A source of 0 V is varied by as much of 1 V. Where the states of the orbit, with another value, lead to other modes,
 * its tangent cannot be found from there: then the orbits are looked for. */
static enum dalcs_status vary(struct dalcs_sensitivities *s, const struct dalcs_sweep *item,
                              double *by) {
    const double size = item->start != 0.0 ? fabs(item->start) : 1.0;
    bool same = false;
    for (double h = first_step; h >= last_step && !same; h *= less) {
        *by = h * size;
        DALCS_TRY(s->st->is_exact ? dalcs_sensitivity_along_tangent(s, item, *by, &same)
                                  : DALCS_OK);
        DALCS_TRY(same ? DALCS_OK : find_orbits(s, item, *by, &same));
    }
    *by = same ? *by : 0.0;
    return DALCS_OK;
}

static enum dalcs_status differentiate_all(struct dalcs_sensitivities *s,
                                           const struct dalcs_sweep *item, double **derivative,
                                           size_t p) {
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

static enum dalcs_status fill_report(struct dalcs_sensitivities *s) {
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

static bool make_room(struct dalcs_sensitivities *s) {
    const size_t n = (size_t)s->st->layout.n_x + 1;
    bool complete = dalcs_steady_make_point(s->st, &s->beside);
    for (int k = PLUS; k < N_ORBITS; k++) {
        s->image[k] = dalcs_arena_alloc(&s->arena, n, sizeof(double));
        complete = complete && s->image[k] != NULL;
    }
    s->step = dalcs_arena_alloc(&s->arena, n, sizeof(double));
    return complete && s->step != NULL;
}

enum dalcs_status dalcs_sensitivities_run(struct dalcs_steady *st) {
    struct dalcs_run *r = st->run;
    struct dalcs_sensitivities s = {.st = st, .run = r, .options = *r->options};
    if (!make_room(&s)) {
        dalcs_arena_finish(&s.arena);
        return DALCS_E_NOMEM;
    }
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
