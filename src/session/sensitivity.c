/* sensitivity.c - .sens: circuits with other values, and differences of what they measure. */
#include "sensitivity_internal.h"

#include <math.h>
#include <string.h>

/* h: the error of the fourth order is below 1e-10 of what depends on a value as a power of it does, and rounding, 1e-13
 * of a measurement, leaves as much. Near a value where modes change it is taken smaller, as far as rounding allows. */
static const double first_step = 0x1p-10, less = 0x1p-3, last_step = 0x1p-19;

/* Orbits are found to so much, whatever the run's tolerance: differences show their errors. */
static const double tolerance_of_orbits = 1e-11;

/* What is below this part of a measurement is rounding of it, extremes have 1e-10; it turns a derivative by 1e-5 at most. */
static const double rounding = 1e-8, turned = 1e-5;

/* A second difference grows with h at a corner, elsewhere with its square: by 2 or 4 from h to 2h. */
static const double corner = 3.0;

/* How far the derivatives of one value are. */
struct looked {
    double derivative; /* by a relative change; NAN: none */
    double bend;       /* the second difference with the last h; 0: no corner is seen */
    double slope;      /* the derivative by that h; NAN: not smooth */
    bool is_open;
};

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
    s->looked = dalcs_arena_alloc(&s->arena, s->n_results + 1, sizeof *s->looked);
    bool complete = s->result != NULL && s->looked != NULL;
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
        status = list_results(s, &other.results.report);
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

static double noise_of(const struct dalcs_sensitivities *s, size_t k) {
    return rounding * dalcs_sensitivity_scale(s->result, s->n_results, k);
}

/* Are two slopes the same function's, which is smooth? Slopes over h and 2h differ by the square of h, and what the fourth
 * order leaves is the square of that: what differs by more than its root has a kink or another extremum between. */
static bool are_slopes_near(const struct dalcs_sensitivities *s, size_t k, double a, double b,
                            double h) {
    const double scale = dalcs_sensitivity_scale(s->result, s->n_results, k);
    return fabs(a - b) <= noise_of(s, k) / h + sqrt(turned) * fmax(scale, fmax(fabs(a), fabs(b)));
}

/* The derivative by a relative change, from the differences with h; NAN: they are not those of a smooth function. *bend: the
 * second difference of a corner, else 0. */
static double differentiate(const struct dalcs_sensitivities *s, size_t k, double h, double *bend) {
    const double near[2] = {difference(s, k, PLUS), difference(s, k, MINUS)};
    const double far_[2] = {difference(s, k, PLUS_TWO), difference(s, k, MINUS_TWO)};
    const double slope[2] = {0.5 * (near[0] - near[1]) / h, 0.25 * (far_[0] - far_[1]) / h};
    const double second = fabs(near[0] + near[1]);
    const bool has_corner = second > noise_of(s, k) && fabs(far_[0] + far_[1]) < corner * second;
    const bool is_smooth = !has_corner && are_slopes_near(s, k, slope[0], slope[1], h);
    *bend = has_corner ? second : 0.0;
    return is_smooth ? (4.0 * slope[0] - slope[1]) / 3.0 : (double)NAN;
}

/* One more h. A corner at the value itself is as sharp with every h, one beside it is outside sooner or later: it is that
 * where a sharp one would still be seen. Orbits with other modes than at the value have to say the same with two h. */
static void look(const struct dalcs_sensitivities *s, size_t k, double h, bool has_same_modes,
                 struct looked *l) {
    double bend;
    const double slope = differentiate(s, k, h, &bend);
    const bool has_value = isfinite(difference(s, k, PLUS));
    const bool is_hidden = l->bend > 0.0 && l->bend * less <= 2.0 * noise_of(s, k);
    const bool is_told = has_same_modes || are_slopes_near(s, k, slope, l->slope, h);
    if (!has_value || is_hidden || (isfinite(slope) && is_told)) {
        l->derivative = has_value && !is_hidden ? slope : (double)NAN;
        l->is_open = false;
    }
    l->bend = bend;
    l->slope = slope;
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

/* Where the states of the orbit, with another value, lead to other modes, its tangent cannot be found from there: then
 * the orbits are looked for. */
static enum dalcs_status vary(struct dalcs_sensitivities *s, const struct dalcs_sweep *item,
                              double by, bool *found) {
    *found = false;
    if (s->st->pass.is_exact && !s->may_differ) {
        DALCS_TRY(dalcs_sensitivity_along_tangent(s, item, by, found));
    }
    return *found ? DALCS_OK : find_orbits(s, item, by, found);
}

/* A source of 0 V is varied by as much of 1 V. */
static double size_of(const struct dalcs_sweep *item) {
    return item->start != 0.0 ? fabs(item->start) : 1.0;
}

/* With smaller and smaller h, until all is known; *any: there were differences. */
static enum dalcs_status look_closer(struct dalcs_sensitivities *s, const struct dalcs_sweep *item,
                                     struct looked *looked, bool *any) {
    size_t n_open = s->n_results;
    for (double h = first_step; h >= last_step && n_open > 0; h *= less) {
        bool found;
        DALCS_TRY(vary(s, item, h * size_of(item), &found));
        *any = *any || found;
        n_open = 0;
        for (size_t k = 0; k < s->n_results; k++) {
            if (found && looked[k].is_open) {
                look(s, k, h, !s->may_differ, &looked[k]);
            }
            n_open += looked[k].is_open ? 1 : 0;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status differentiate_all(struct dalcs_sensitivities *s,
                                           const struct dalcs_sweep *item, double **derivative,
                                           size_t p) {
    bool found = false, all = true, any = false;
    for (size_t k = 0; k < s->n_results; k++) {
        s->looked[k] = (struct looked){.derivative = NAN, .slope = NAN, .is_open = true};
    }
    DALCS_TRY(look_closer(s, item, s->looked, &found));
    const bool has_same_modes = found;
    if (!found) { /* modes change at the value: what is measured need not have a corner there */
        s->may_differ = true;
        const enum dalcs_status status = look_closer(s, item, s->looked, &found);
        s->may_differ = false;
        DALCS_TRY(status);
    }
    for (size_t k = 0; k < s->n_results; k++) {
        derivative[k][p] = s->looked[k].derivative / size_of(item);
        any = any || isfinite(derivative[k][p]);
        all = all && (isfinite(derivative[k][p]) || !isfinite(s->result[k].value));
    }
    if (has_same_modes ? !any && s->n_results > 0 : !all) {
        dalcs_diag_add(&s->run->s->diag, DALCS_WARNING, &item->where,
                       "there the orbit's modes change, as at the border of discontinuous "
                       "conduction; take a value beside it",
                       ".sens: %s no derivative by '%s' at %.9g",
                       any ? "of some measurements there is" : "there is", item->label,
                       item->start);
    }
    return DALCS_OK;
}

/* ---- All of it ----------------------------------------------------------------------------------- */

static enum dalcs_status fill_report(struct dalcs_sensitivities *s) {
    struct dalcs_session *session = s->run->s;
    const struct dalcs_sensitivity_card *card = &session->circuit.analyses.sensitivity;
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
    session->results.report.sensitivity.present = true;
    session->results.report.sensitivity.n_parameters = n;
    session->results.report.sensitivity.n_results = s->n_results;
    session->results.report.sensitivity.parameter = parameter;
    session->results.report.sensitivity.result = s->result;
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
