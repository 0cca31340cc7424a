/* several.c - circuits that are not passive and have several solutions.
 *
 * Where controlled sources or negative resistors give energy, answers need not hang together: each mode
 * of few diodes is tried. In a transient two small steps are, for solutions that part only later are
 * still equal at the start (x' = sign(x) from 0), and one step alone may be longer than the circuit has a
 * unique answer for. */
#include "freedom.h"
#include "smooth_newton.h"

#include <math.h>
#include <string.h>

/* Diodes up to which 2^n modes are tried; answers kept. */
enum { MOST_DIODES = 6, MOST_ANSWERS = 8 };

/* Values of a signal that differ by less than this part of the larger are the same, and so are those that differ by
 * what factors may leave of the largest voltage or current of all. */
static const double same_value = 1e-9;
static const double rounding = 1e-13;

/* The first step over the stop time, the second over the first. */
static const double first_part = 1e-6;
static const double second_part = 1e-3;

/* Answers of monotone blocks hang together, whatever else reads them. */
static bool is_candidate(const struct dalcs_component *c) {
    const struct dalcs_system *s = c->system;
    int n_diodes = 0;
    for (int d = 0; d < s->n_pairs; d++) {
        n_diodes += s->pair[d].kind == DALCS_PAIR_DIODE ? 1 : 0;
    }
    return !dalcs_osnsp_is_monotone(&c->osnsp) && n_diodes > 0 && n_diodes <= MOST_DIODES;
}

/* Modes are tried with products and smooth functions as lines, their tangents at the answer that is taken. Does an answer
 * lie on the functions, too? */
static bool lies_on_functions(const struct dalcs_component *c, const double *y) {
    const struct dalcs_system *s = c->system;
    bool lies = true;
    for (int k = 0; k < s->n_smooth && lies; k++) {
        const struct dalcs_smooth_input *of = &s->smooth[k];
        double x[2];
        for (int j = 0; j < 2; j++) {
            x[j] = j < of->n && of->column[j] >= 0 ? y[of->column[j]] : of->number[j];
        }
        const double value = dalcs_smooth_value(of->kind, x);
        const double off = dalcs_smooth_rest(of, x) - c->osnsp.smooth.newton->phi[k];
        lies = fabs(off) <= same_value * (fabs(value) + fabs(value - off));
    }
    return lies;
}

/* The first of n answers, those that lie there; how many. */
static int keep_true(const struct dalcs_component *c, double *answer, int n) {
    const size_t n_columns = (size_t)dalcs_system_n_columns(c->system);
    int kept = 0;
    for (int k = 0; k < n; k++) {
        if (lies_on_functions(c, answer + (size_t)k * n_columns)) {
            memmove(answer + (size_t)kept * n_columns, answer + (size_t)k * n_columns,
                    n_columns * sizeof(*answer));
            kept++;
        }
    }
    return kept;
}

/* All answers of a step of length h from the present values; of an operating point where h is 0. The
 * last one is that which is taken. */
static enum dalcs_status list_answers(struct dalcs_component *c, double h, double *u,
                                      double *answer, int *n) {
    const struct dalcs_system *s = c->system;
    size_t n_columns = (size_t)dalcs_system_n_columns(s);
    double sigma = h > 0.0 && s->n_x > 0 ? 1.0 / h : 0.0;
    memcpy(u, c->y, (size_t)s->n_x * sizeof(*u));
    memcpy(u + s->n_x, c->u + s->n_x, (size_t)s->n_inputs * sizeof(*u));
    if (h > 0.0) {
        dalcs_component_look_ahead(c, h, DALCS_RIGHT, u);
    }
    DALCS_TRY(dalcs_osnsp_list_answers(&c->osnsp, sigma, u, MOST_ANSWERS, answer, n));
    *n = keep_true(c, answer, *n);
    if (*n < 2) {
        return DALCS_OK;
    }
    memcpy(c->saved_mode, c->osnsp.mode, (size_t)c->osnsp.n_words * sizeof(*c->saved_mode));
    enum dalcs_status status =
        dalcs_osnsp_solve(&c->osnsp, sigma, u, answer + MOST_ANSWERS * n_columns);
    memcpy(c->osnsp.mode, c->saved_mode, (size_t)c->osnsp.n_words * sizeof(*c->saved_mode));
    *n = status > DALCS_OK ? 0 : *n;
    return status < DALCS_OK ? status : DALCS_OK;
}

static double value_of(const struct dalcs_output *out, int system, const double *y,
                       const double *inputs) {
    double value = out->plus.system == system ? dalcs_probe_value(&out->plus, y, inputs) : 0.0;
    return out->minus.system == system ? value - dalcs_probe_value(&out->minus, y, inputs) : value;
}

/* Answers that differ in their states, if any do: the others share currents in different ways. */
static int count(struct dalcs_view *view, const struct dalcs_system *s, const double *answer,
                 int n) {
    size_t n_columns = (size_t)dalcs_system_n_columns(s);
    int n_different = 0;
    for (int k = 0; k < n; k++) {
        bool is_new = true;
        for (int j = 0; j < k && is_new; j++) {
            is_new = false;
            for (int x = 0; x < s->n_x && !is_new; x++) {
                double a = answer[(size_t)k * n_columns + (size_t)x];
                double b = answer[(size_t)j * n_columns + (size_t)x];
                is_new = dalcs_view_is_open(view, s->column_is_current[x], fmin(a, b), fmax(a, b));
            }
        }
        n_different += is_new ? 1 : 0;
    }
    return n_different > 1 ? n_different : n;
}

/* Beside an integrator of 1e7 V a latch of 1 V has two states all the same. */
static bool is_open(const struct dalcs_view *view, bool is_current,
                    const struct dalcs_open_signal *signal) {
    double apart = signal->upper - signal->lower;
    return apart > same_value * fmax(fabs(signal->lower), fabs(signal->upper)) &&
           apart > rounding * view->largest[is_current ? 1 : 0];
}

static enum dalcs_status tell(struct dalcs_undetermined *u, const struct dalcs_euler *e, int system,
                              double h, const double *inputs, const double *answer, int n) {
    const struct dalcs_system *s = &e->network->system[system];
    size_t n_columns = (size_t)dalcs_system_n_columns(s);
    struct dalcs_arena work = {0};
    struct dalcs_view view = {.u = u};
    struct dalcs_finding finding = {.time = h,
                                    .at_operating_point = e->failure.at_operating_point,
                                    .device = -1,
                                    .n_answers = n,
                                    .has_intervals = true};
    for (size_t k = 0; k < (size_t)n * n_columns; k++) {
        double *largest = &view.largest[s->column_is_current[k % n_columns] ? 1 : 0];
        *largest = fmax(*largest, fabs(answer[k]));
    }
    finding.because = dalcs_arena_printf(&work, "%d solutions of a circuit that is not passive",
                                         count(&view, s, answer, n));
    finding.signal =
        dalcs_arena_alloc(&work, (size_t)e->network->n_outputs, sizeof(*finding.signal));
    if (finding.because == NULL || finding.signal == NULL) {
        dalcs_arena_finish(&work);
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < e->network->n_outputs; i++) {
        const struct dalcs_output *out = &e->network->output[i];
        if (u->told[i].is_told || (out->plus.system != system && out->minus.system != system)) {
            continue;
        }
        struct dalcs_open_signal *signal = &finding.signal[finding.n_signals];
        *signal = (struct dalcs_open_signal){.output = i, .lower = INFINITY, .upper = -INFINITY};
        signal->value = value_of(out, system, answer + MOST_ANSWERS * n_columns, inputs);
        for (int k = 0; k < n; k++) {
            double value = value_of(out, system, answer + (size_t)k * n_columns, inputs);
            signal->lower = fmin(signal->lower, value);
            signal->upper = fmax(signal->upper, value);
        }
        bool open = is_open(&view, out->is_current, signal);
        u->told[i] = (struct dalcs_told){.is_told = open, .system = system, .time = -1.0};
        finding.n_signals += open ? 1 : 0;
    }
    enum dalcs_status status = finding.n_signals > 0 ? u->on_finding(u->user, &finding) : DALCS_OK;
    dalcs_arena_finish(&work);
    return status;
}

static enum dalcs_status look(struct dalcs_undetermined *u, struct dalcs_euler *e, int system,
                              double h, double *inputs, double *answer) {
    struct dalcs_component *c = &e->component[system];
    int n = 2;
    if (h > 0.0 && c->system->n_x > 0) {
        DALCS_TRY(list_answers(c, second_part * h, inputs, answer, &n));
    }
    if (n > 1) {
        DALCS_TRY(list_answers(c, h, inputs, answer, &n));
    }
    return n > 1 ? tell(u, e, system, h, inputs + c->system->n_x, answer, n) : DALCS_OK;
}

enum dalcs_status dalcs_undetermined_several(struct dalcs_undetermined *u, struct dalcs_euler *e,
                                             double stop) {
    for (int k = 0; k < e->n_components; k++) {
        const struct dalcs_system *s = e->component[k].system;
        if (!is_candidate(&e->component[k])) {
            continue;
        }
        DALCS_TRY(dalcs_undetermined_prepare(u));
        struct dalcs_arena work = {0};
        size_t n_columns = (size_t)dalcs_system_n_columns(s);
        double *inputs = dalcs_arena_alloc(&work, (size_t)(s->n_x + s->n_inputs), sizeof(*inputs));
        double *answer = dalcs_arena_alloc(&work, (MOST_ANSWERS + 1) * n_columns, sizeof(*answer));
        enum dalcs_status status = DALCS_E_NOMEM;
        if (inputs != NULL && answer != NULL) {
            status = look(u, e, k, first_part * stop, inputs, answer);
        }
        dalcs_arena_finish(&work);
        DALCS_TRY(status);
    }
    return DALCS_OK;
}
