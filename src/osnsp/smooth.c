/* smooth.c - one-step problems with smooth sources: Newton's method around the problem with given ones.
 *
 * For given values of these sources the problem is piecewise affine in them, and the slope of what they read is that of
 * the mode in which it was solved (a semismooth Newton method; Qi and Sun 1993). A refusal of such a problem says nothing
 * of the whole. */
#include "in_order.h"
#include "magnitudes.h"
#include "osnsp_internal.h"
#include "scales.h"
#include "smooth_newton.h"

#include <math.h>

/* Newton's method doubles its digits with each step once it is near, and a limited exponential takes a step for each
 * e-fold that it is off: 700 of them are all that a double has. */
enum { MOST_STEPS = 1000 };

/* Lines that are much steeper make a mode regular that holds a node by next to nothing: eight times a thousand span all
 * digits. */
enum { MOST_STEEPER = 8 };

/* Where pivoting finds no mode all are tried (enumerate.c), and iterates that go from mode to mode without an end have that
 * done in each step. Since the last answer they may try what one problem of 12 diodes and two hundred unknowns has, in modes
 * times unknowns: each takes an elimination for its null space. A problem leaves half of that to those behind it, as where
 * positions of switches or lengths of steps are tried in turn. The first of all is always tried. */
static const long most_enumerated = 200L << 12;

/* On the way to functions that count in full Newton's method begins near its answer, where it doubles digits; what has not
 * agreed after as many steps as a limited exponential takes for a change by a factor of 1e17 is too far away. */
enum { MOST_STEPS_NEAR = 40 };

enum dalcs_status dalcs_osnsp_smooth_setup(struct dalcs_osnsp *p) {
    if (p->system->n_smooth == 0) {
        return DALCS_OK;
    }
    p->smooth.newton = dalcs_arena_alloc(&p->arena, 1, sizeof(*p->smooth.newton));
    p->smooth.given = dalcs_arena_alloc(&p->arena, (size_t)(p->system->n_x + p->system->n_inputs),
                                        sizeof(*p->smooth.given));
    p->smooth.reached =
        dalcs_arena_alloc(&p->arena, (size_t)p->system->n_smooth, sizeof(*p->smooth.reached));
    p->smooth.reached_x =
        dalcs_arena_alloc(&p->arena, (size_t)p->system->n_smooth, sizeof(*p->smooth.reached_x));
    p->smooth.other = dalcs_arena_alloc(&p->arena, (size_t)(dalcs_system_n_columns(p->system)),
                                        sizeof(*p->smooth.other));
    p->smooth.mode = dalcs_arena_alloc(&p->arena, (size_t)p->n_words, sizeof(*p->smooth.mode));
    if (p->smooth.newton == NULL || p->smooth.mode == NULL || p->smooth.given == NULL ||
        p->smooth.other == NULL || p->smooth.reached == NULL || p->smooth.reached_x == NULL) {
        return DALCS_E_NOMEM;
    }
    struct dalcs_smooth_newton *n = p->smooth.newton;
    DALCS_TRY(dalcs_smooth_newton_setup(n, p->system, 1, &p->arena));
    dalcs_smooth_starting_tangents(p->system, n->x, n->phi);
    return DALCS_OK;
}

void dalcs_osnsp_smooth_finish(const struct dalcs_osnsp *p) {
    dalcs_smooth_drop_tangents(p->system);
}

/* What was factored with other lines is of no use. */
static void forget(struct dalcs_osnsp *p) {
    dalcs_modes_finish(p);
    dalcs_in_order_finish(p);
    dalcs_smooth_newton_forget(p->smooth.newton);
    p->smooth.n_tangents++;
}

/* V, A: raised to the largest of an answer, but of parts of formulas. */
static void raise_largest(const struct dalcs_system *s, const double *y, double *largest) {
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        double *of = &largest[s->column_is_current[c]];
        *of = s->is_part[c] ? *of : fmax(*of, fabs(y[c]));
    }
}

bool dalcs_osnsp_retangent(struct dalcs_osnsp *p, const double *y) {
    double largest[2] = {INFINITY, INFINITY};
    if (y != NULL) {
        largest[0] = largest[1] = 0.0;
        raise_largest(p->system, y, largest);
    }
    struct dalcs_smooth_newton *n = p->smooth.newton;
    const struct dalcs_smooth_seen seen = {
        (const double(*)[2])n->x,
        (const double(*)[2])n->terms,
        {fmax(n->volt, p->smooth.largest[0]), p->smooth.largest[1]}};
    if (!dalcs_smooth_retangent(p->system, &seen, largest, n->phi)) {
        return false;
    }
    forget(p);
    return true;
}

static void put_sources(const struct dalcs_osnsp *p, double *u) {
    const struct dalcs_system *s = p->system;
    for (int k = 0; k < s->n_smooth; k++) {
        u[s->n_x + s->smooth[k].input] = p->smooth.newton->phi[k];
    }
}

/* What a change of each source does to the arguments in the present mode: a difference, exact as all is affine there. */
static enum dalcs_status find_slope(struct dalcs_osnsp *p, double *u, const double *y) {
    const struct dalcs_system *s = p->system;
    double *other = p->smooth.other;
    struct dalcs_smooth_newton *n = p->smooth.newton;
    memcpy(p->smooth.mode, p->mode, (size_t)p->n_words * sizeof(*p->mode));
    for (int k = 0; k < s->n_smooth; k++) {
        const double change = 1.0 + fabs(n->phi[k]);
        bool clash;
        u[s->n_x + s->smooth[k].input] += change;
        const enum dalcs_status status = dalcs_osnsp_try_mode(p, u, other, &clash);
        const bool is_known =
            status == DALCS_OK; /* else as if it changed nothing: a step of less use */
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        for (int q = 0; q < s->n_smooth; q++) {
            for (int j = 0; j < 2; j++) {
                const int column = j < s->smooth[q].n ? s->smooth[q].column[j] : -1;
                n->slope[(2 * q + j) * n->n + k] =
                    column >= 0 && is_known ? (other[column] - y[column]) / change : 0.0;
            }
        }
        u[s->n_x + s->smooth[k].input] = n->phi[k];
    }
    return DALCS_OK;
}

/* Can be seen that voltages and currents of the answer y move by so much at most? A circuit at rest is measured by what it was
 * before. Where all of a unit that has been, in y too, is less than it moves by, that is rounding, or 0 of which everything
 * would be seen: what drives the circuit could raise is the measure then. */
static bool are_seen(const struct dalcs_osnsp *p, const double *y, const double *moved) {
    const double *largest = p->smooth.largest;
    const struct dalcs_scales scale =
        dalcs_scales_physical(p, dalcs_scales_driving(p, p->smooth.given), y);
    const double raised[2] = {scale.volt, scale.ampere};
    bool seen = false;
    for (int k = 0; k < 2; k++) {
        const double measure = largest[k] > moved[k] ? largest[k] : raised[k];
        seen = seen || moved[k] > dalcs_nothing * measure;
    }
    return seen;
}

/* Is the answer y the same to what can be seen, where source k is off by so much? */
static enum dalcs_status find_shift(struct dalcs_osnsp *p, int k, double off, const double *y,
                                    bool *is_seen) {
    const struct dalcs_system *s = p->system;
    double moved[2] = {0.0, 0.0};
    bool clash;
    double *u = p->smooth.given;
    put_sources(p, u);
    u[s->n_x + s->smooth[k].input] += off;
    const enum dalcs_status status = dalcs_osnsp_try_mode(p, u, p->smooth.other, &clash);
    for (int c = 0; c < dalcs_system_n_columns(s) && status == DALCS_OK; c++) {
        double *of = &moved[s->column_is_current[c]];
        *of = s->is_part[c] ? *of : fmax(*of, fabs(p->smooth.other[c] - y[c]));
    }
    *is_seen = *is_seen || are_seen(p, y, moved);
    return status < DALCS_OK ? status : DALCS_OK;
}

/* Does an answer hold where functions themselves drive the circuit? What was solved has their lines and what these leave of
 * them: where a line is far steeper than the function, both are large, and neither rounding of their difference nor a
 * diode's sign is to be measured on them. */
static enum dalcs_status certify(struct dalcs_osnsp *p, const double *y) {
    const struct dalcs_system *s = p->system;
    struct dalcs_smooth_newton *n = p->smooth.newton;
    double *u = p->smooth.given;
    const bool is_least_norm = p->least_norm;
    bool is_steep = false;
    bool is_seen = false;
    for (int k = 0; k < n->n && !is_seen; k++) {
        const double off = dalcs_smooth_newton_excused(n, k);
        is_steep = is_steep || off > 0.0;
        DALCS_TRY(off > 0.0 ? find_shift(p, k, off, y, &is_seen) : DALCS_OK);
    }
    if (!is_steep) {
        return DALCS_OK;
    }
    for (int k = 0; k < n->n; k++) {
        u[s->n_x + s->smooth[k].input] = dalcs_smooth_value(s->smooth[k].kind, n->x[k]);
    }
    const bool holds = !is_seen && dalcs_certificate_pairs_hold(p, u, y);
    bool clash;
    put_sources(p, u);
    memcpy(p->smooth.other, y, (size_t)dalcs_system_n_columns(s) * sizeof(*y));
    dalcs_certificate_evaluate_either(p, u, p->smooth.other, &clash); /* as it was */
    p->least_norm = is_least_norm;
    n->outcome.is_refused = !holds;
    return holds ? DALCS_OK : DALCS_NOT_CONVERGED;
}

/* Of the next problem of this step of Newton's method. */
static void limit_modes(struct dalcs_osnsp *p) {
    const bool has_tried = p->counters.enumerated > p->smooth.answered_at;
    const long left = p->smooth.may_enumerate - p->counters.enumerated;
    p->asks.most_enumerated = !has_tried ? 0 : left > 0 ? left : 1;
}

/* Is what was tried of the mode that the last step had its slopes from? In another one functions may agree less for a step,
 * and the next one begins with the slopes there. */
static bool stays(const struct dalcs_osnsp *p) {
    return dalcs_mode_is(p->smooth.mode, p->mode, p->n_words);
}

/* Is what was tried to be tried again before the next step? The last one led away, and was halved; or it did not, and there are
 * lines with which the digits suffice. */
static bool tries_again(struct dalcs_osnsp *p, const double *y, int step, bool stalls) {
    struct dalcs_smooth_newton *n = p->smooth.newton;
    n->is_damped = n->is_damped || stalls || step >= MOST_STEPS_NEAR;
    if (dalcs_smooth_newton_overshoots(n, p->options.certificate_tolerance)) {
        return true;
    }
    const bool has_lines = stalls && n->share == 1.0 && dalcs_osnsp_retangent(p, y);
    n->is_damped = n->is_damped && !has_lines;
    return has_lines;
}

/* From the present values and lines. */
static enum dalcs_status iterate(struct dalcs_osnsp *p, double sigma, double *y, given_solve *solve,
                                 int most_steps) {
    const struct dalcs_system *s = p->system;
    struct dalcs_smooth_newton *n = p->smooth.newton;
    int n_steeper = 0;
    bool is_last =
        false; /* what holds no flux but its current is rounded like a flux: one step more */
    dalcs_smooth_newton_begin(n, n->x);
    for (int step = 0; step < most_steps; step++) {
        limit_modes(p);
        put_sources(p, p->smooth.given);
        enum dalcs_status status = solve(p, sigma, p->smooth.given, y);
        if (status > DALCS_OK && n->share == 1.0 && p->smooth.n_tangents > 0 &&
            n_steeper++ < MOST_STEEPER) {
            dalcs_smooth_scale_tangents(s, 1.0 / dalcs_small, n->x, n->phi);
            forget(p);
            dalcs_smooth_newton_begin(n, n->x);
            continue;
        }
        n->outcome.is_refused = status == DALCS_INFEASIBLE;
        if (status != DALCS_OK) {
            return status == DALCS_INFEASIBLE ? DALCS_NOT_CONVERGED : status;
        }
        dalcs_smooth_newton_read(n, 0, y);
        bool repeats;
        bool is_done;
        if (!dalcs_smooth_newton_is_finite(n, &repeats)) {
            return DALCS_NOT_CONVERGED;
        }
        if (repeats) {
            continue;
        }
        bool agrees = dalcs_smooth_newton_agrees(n, p->options.certificate_tolerance, &is_done);
        if (agrees && is_done && (is_last || !dalcs_smooth_starts_on_lines(s))) {
            return DALCS_OK;
        }
        is_last = agrees && is_done;
        if (!is_last && tries_again(p, y, step, step > 0 && is_done && stays(p) && !n->limits)) {
            continue;
        }
        DALCS_TRY(find_slope(p, p->smooth.given, y));
        if (!dalcs_smooth_newton_step(n)) {
            return DALCS_NOT_CONVERGED;
        }
    }
    return DALCS_NOT_CONVERGED;
}

static void keep_reached(struct dalcs_osnsp *p) {
    const struct dalcs_smooth_newton *n = p->smooth.newton;
    memcpy(p->smooth.reached, n->phi, (size_t)n->n * sizeof(*n->phi));
    memcpy(p->smooth.reached_x, n->x, (size_t)n->n * sizeof(*n->x));
}

static void go_back(const struct dalcs_osnsp *p) {
    const struct dalcs_smooth_newton *n = p->smooth.newton;
    memcpy(n->phi, p->smooth.reached, (size_t)n->n * sizeof(*n->phi));
    memcpy(n->x, p->smooth.reached_x, (size_t)n->n * sizeof(*n->x));
}

/* By a path of answers from functions that count nothing to those that count in full: a homotopy in an artificial
 * parameter (R. Melville et al., Artificial parameter homotopy methods for the DC operating point problem, 1993). */
static enum dalcs_status follow(struct dalcs_osnsp *p, double *y, given_solve *solve) {
    /* Of the first step; the others follow from what is found, so that it decides no answer. */
    static const double first = 0.125;
    struct dalcs_smooth_newton *n = p->smooth.newton;
    memset(n->phi, 0, (size_t)n->n * sizeof(*n->phi));
    memset(n->x, 0, (size_t)n->n * sizeof(*n->x));
    n->share = 0.0;
    enum dalcs_status status = iterate(p, 0.0, y, solve, MOST_STEPS_NEAR);
    double reached = 0.0;
    for (double step = first; status == DALCS_OK && reached < 1.0;) {
        keep_reached(p);
        n->share = fmin(1.0, reached + step);
        status = iterate(p, 0.0, y, solve, MOST_STEPS_NEAR);
        reached = status == DALCS_OK ? n->share : reached;
        step *= status == DALCS_OK ? 2.0 : 0.25;
        if (status > DALCS_OK && reached + step > reached + dalcs_nothing * first) {
            go_back(p);
            status = DALCS_OK;
        }
    }
    n->share = 1.0;
    return status;
}

static enum dalcs_status solve_by_newton(struct dalcs_osnsp *p, double sigma, const double *u,
                                         double *y, given_solve *solve) {
    const struct dalcs_system *s = p->system;
    memcpy(p->smooth.given, u, (size_t)(s->n_x + s->n_inputs) * sizeof(*p->smooth.given));
    enum dalcs_status status = iterate(p, sigma, y, solve, MOST_STEPS);
    if (status > DALCS_OK && p->smooth.n_tangents == 0) {
        /* without lines, as where nothing else holds a node: with some, from nothing */
        dalcs_smooth_nominal_tangents(s);
        forget(p);
        memset(p->smooth.newton->phi, 0, (size_t)p->smooth.newton->n * sizeof(double));
        memset(p->smooth.newton->x, 0, (size_t)p->smooth.newton->n * sizeof(*p->smooth.newton->x));
        dalcs_smooth_starting_tangents(s, p->smooth.newton->x, p->smooth.newton->phi);
        status = iterate(p, sigma, y, solve, MOST_STEPS);
    }
    if (status > DALCS_OK && sigma == 0.0) {
        status = follow(p, y, solve);
    }
    /* beside a line that is far steeper what is rounding would be any answer */
    for (int k = 0; status == DALCS_OK && dalcs_osnsp_retangent(p, y); k++) {
        status = k < MOST_STEEPER ? iterate(p, sigma, y, solve, MOST_STEPS) : DALCS_NOT_CONVERGED;
    }
    if (status == DALCS_OK) {
        raise_largest(s, y, p->smooth.largest);
    }
    return status == DALCS_OK && p->smooth.n_tangents > 0 ? certify(p, y) : status;
}

enum dalcs_status dalcs_osnsp_solve_smooth(struct dalcs_osnsp *p, double sigma, const double *u,
                                           double *y, given_solve *solve) {
    const long most = p->asks.most_enumerated;
    const long left = most_enumerated - (p->counters.enumerated - p->smooth.answered_at);
    p->smooth.may_enumerate = p->counters.enumerated + left / 2;
    const enum dalcs_status status = solve_by_newton(p, sigma, u, y, solve);
    p->smooth.answered_at = status == DALCS_OK ? p->counters.enumerated : p->smooth.answered_at;
    p->asks.most_enumerated = most;
    return status;
}
