/* look_after.c - micro-steps of implicit Euler that show what happens at a discontinuity. */
#include "euler_internal.h"

#include "magnitudes.h"
#include "power_of_step.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

/* Lengths of a micro-step over h, the next where one has no certified answer (a circuit that is not
 * passive may have widely different gains). Two of them, extrapolated, leave an error of the square.
 * None reaches more than half of the way to the next edge. */
static const double micro_part[] = {1e-6, 1e-3, 1.0};

static double largest_state(const struct dalcs_system *s, const double *y, bool currents) {
    double largest = 0.0;
    for (int x = 0; x < s->n_x; x++) {
        largest = s->column_is_current[x] == currents ? fmax(largest, fabs(y[x])) : largest;
    }
    return largest;
}

/* Refuses a jump that two steps from x with the answers y1 and y2, one half as long as the other, do not agree about: what
 * moves the farther the shorter the step is, the derivative of an impulse moves, which implicit Euler cannot follow. Those
 * states are to blame. */
static enum dalcs_status refuse_derivative(struct dalcs_euler *e, int k, const double *x,
                                           const double *y1, const double *y2) {
    dalcs_osnsp_blame_states(&e->component[k].osnsp, x, y1, y2);
    e->component[k].failure.sigma = 1.0 / e->h;
    e->component[k].failure.u = e->component[k].u;
    e->failure.system = k;
    e->failure.time = e->t;
    e->failure.h = e->h;
    return DALCS_INFEASIBLE;
}

/* Into e->telling.noise: the change of each state that is rounding and no jump. A certificate leaves a state as much of its own size,
 * and a sum as much of the largest of its unit so far, or of what the other unit drives through the circuit's
 * conductances. */
static void find_noise(struct dalcs_euler *e, int k, const double *before) {
    const struct dalcs_component *c = &e->component[k];
    const struct dalcs_system *s = c->system;
    const struct dalcs_step_form *f = c->osnsp.cache.form[0];
    double unit[2];
    for (int of = 0; of < 2; of++) {
        unit[of] = fmax(c->scale[of], fmax(largest_state(s, before, of == 1),
                                           largest_state(s, e->jump.after, of == 1)));
    }
    const double scale[2] = {fmax(unit[0], f->ampere_in_volts * unit[1]),
                             fmax(unit[1], f->volt_in_amperes * unit[0])};
    for (int x = 0; x < s->n_x; x++) {
        double own = fmax(c->largest[x], fmax(fabs(before[x]), fabs(e->jump.after[x])));
        e->telling.noise[x] =
            fmax(dalcs_answer_rounded * own, dalcs_sum_rounded * scale[s->column_is_current[x]]);
    }
}

/* What two micro-steps, y of length h and the component's scratch of half of it, say of a jump: a change that does not
 * halve with the micro-step and is more than rounding. */
static bool extrapolate(struct dalcs_euler *e, int k, const double *u, const double *y,
                        const double *limit) {
    const struct dalcs_component *c = &e->component[k];
    const struct dalcs_system *s = c->system;
    bool jumps = false;
    for (int x = 0; x < s->n_x; x++) {
        double whole = y[x] - u[x];
        double half = c->scratch[x] - u[x];
        jumps = jumps || (dalcs_power_of_step(whole, half) <= 0.0 &&
                          fabs(2.0 * half - whole) > limit[s->column_is_current[x]]);
    }
    for (int x = 0; x < s->n_x && jumps; x++) {
        e->after[x] = 2.0 * c->scratch[x] - y[x];
    }
    return jumps;
}

/* The impulses that the two micro-steps saw; those of y are there already. Where diodes share an impulse
 * in more than one way the two may have taken different ones: what is extrapolated from them may then be
 * negative, which no diode's is, and the shorter step's own are an answer. */
static void extrapolate_impulses(struct dalcs_euler *e, int k, double h) {
    const struct dalcs_component *c = &e->component[k];
    const double *lambda = c->scratch + dalcs_system_n_equations(c->system);
    bool differ = false;
    for (int d = 0; d < c->system->n_pairs; d++) {
        bool is_less = dalcs_power_of_step(e->charge[d], 0.5 * h * lambda[d]) > 1.0 ||
                       dalcs_power_of_step(e->flux[d], 0.5 * h * c->osnsp.w[d]) > 1.0;
        differ = differ || (c->osnsp.lists.is_diode[d] && is_less);
    }
    for (int d = 0; d < c->system->n_pairs; d++) {
        double *impulse[2] = {&e->charge[d], &e->flux[d]};
        double half[2] = {0.5 * h * lambda[d], 0.5 * h * c->osnsp.w[d]};
        for (int i = 0; i < 2; i++) {
            bool impulsive = dalcs_power_of_step(*impulse[i], half[i]) <= 0.0;
            *impulse[i] = !impulsive ? 0.0 : differ ? half[i] : 2.0 * half[i] - *impulse[i];
        }
    }
}

/* A state that moves twice as far in half the time has no limit: the derivative of an impulse moves it. */
static bool runs_away(const struct dalcs_component *c, const double *u, const double *y,
                      const double *limit) {
    bool away = false;
    for (int x = 0; x < c->system->n_x && !away; x++) {
        double whole = fabs(y[x] - u[x]);
        away = whole > limit[c->system->column_is_current[x]] &&
               dalcs_power_of_step(whole, c->scratch[x] - u[x]) < 0.0;
    }
    return away;
}

/* The first that has an answer. */
static enum dalcs_status solve_micro_step(struct dalcs_euler *e, int k, const double *u, double *y,
                                          double *length) {
    enum dalcs_status status = DALCS_NOT_CONVERGED;
    *length = 0.0;
    for (size_t i = 0; i < sizeof(micro_part) / sizeof(*micro_part) && status > DALCS_OK; i++) {
        *length = fmin(micro_part[i] * e->grid.h, 0.5 * (e->grid.next_edge - e->t));
        status = dalcs_euler_solve(e, k, 1.0 / *length, u, y);
    }
    return status;
}

/* By more than these V and A. */
static bool has_moved(const struct dalcs_system *s, const double *from, const double *to,
                      const double *limit) {
    bool moved = false;
    for (int x = 0; x < s->n_x && !moved; x++) {
        moved = fabs(to[x] - from[x]) > limit[s->column_is_current[x]];
    }
    return moved;
}

/* Solves micro-steps from u (whose x is x-) into y, and so learns the state just after a
 * discontinuity, left in e->after: x- where it is continuous. Where it jumps, the jump is reported
 * and y holds impulsive currents. *length is that of the micro-step of y. */
enum dalcs_status dalcs_euler_look_after(struct dalcs_euler *e, int k, const double *before,
                                         const double *u, double *y, double *length) {
    struct dalcs_component *c = &e->component[k];
    const struct dalcs_system *s = c->system;
    int n_equations = dalcs_system_n_equations(s);
    DALCS_TRY(solve_micro_step(e, k, u, y, length));
    const double h = *length;
    memcpy(e->after, u, (size_t)s->n_x * sizeof(double));
    double limit[2];
    for (int unit = 0; unit < 2; unit++) {
        double here = fmax(largest_state(s, u, unit), largest_state(s, y, unit));
        limit[unit] = fmax(dalcs_alike * here, dalcs_sum_rounded * c->scale[unit]);
    }
    if (!has_moved(s, u, y, limit)) {
        return DALCS_OK;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        e->charge[d] = h * y[n_equations + d];
        e->flux[d] = h * c->osnsp.w[d];
    }
    DALCS_TRY(dalcs_euler_solve(e, k, 2.0 / h, u, c->scratch));
    if (c->commands.moved) {
        return DALCS_OK; /* a switch moved in between: the two steps cannot be combined */
    }
    if (!dalcs_osnsp_is_monotone(&c->osnsp) && runs_away(c, u, y, limit)) {
        return refuse_derivative(e, k, u, y, c->scratch);
    }
    if (!extrapolate(e, k, u, y, limit)) {
        return DALCS_OK;
    }
    extrapolate_impulses(e, k, h);
    DALCS_TRY(dalcs_euler_find_jump(e, k, u));
    if (e->jump.is_known && !has_moved(s, u, e->jump.after, limit)) {
        return DALCS_OK; /* a transient faster than a micro-step, which is not a jump */
    }
    memcpy(e->after, e->jump.after, (size_t)s->n_x * sizeof(double));
    find_noise(e, k, before);
    for (int i = s->n_x; i < n_equations;
         i++) { /* without impulses, which are over h and over h / 2 */
        c->scratch[i] = 2.0 * y[i] - c->scratch[i];
    }
    return dalcs_euler_report_jump(e, k, e->t, before, e->t > 0.0 ? before : NULL, c->scratch);
}

/* y becomes all values just after a discontinuity, with the state after it. A micro-step from that
 * state tells where the circuit goes; its mirror image, which comes from as far before, ends on that
 * state up to the square of the micro-step, with the currents that slopes of sources drive, and is
 * certified. u is left as it was. */
enum dalcs_status dalcs_euler_settle_after(struct dalcs_euler *e, int k, const double *before,
                                           const double *u, double *y) {
    struct dalcs_component *c = &e->component[k];
    size_t n_x = (size_t)c->system->n_x;
    size_t input_bytes = (size_t)c->system->n_inputs * sizeof(double);
    if (n_x == 0) {
        return dalcs_euler_solve(e, k, 0.0, u, y);
    }
    double h;
    DALCS_TRY(dalcs_euler_look_after(e, k, before, u, y, &h));
    memcpy(c->probe_u, e->after, n_x * sizeof(double));
    memcpy(c->probe_u + n_x, u + n_x, input_bytes);
    dalcs_component_look_ahead(c, e->t + h, DALCS_RIGHT, c->probe_u);
    enum dalcs_status status = dalcs_euler_solve(e, k, 1.0 / h, c->probe_u, c->scratch);
    if (status == DALCS_OK) {
        for (size_t x = 0; x < n_x; x++) {
            c->probe_u[x] = 2.0 * e->after[x] - c->scratch[x];
        }
        memcpy(c->probe_u + n_x, u + n_x, input_bytes);
        status = dalcs_euler_solve(e, k, 1.0 / h, c->probe_u, c->scratch);
    }
    if (status < DALCS_OK) {
        return status;
    }
    /* otherwise the first micro-step is taken, and the next step decides */
    if (status == DALCS_OK) {
        memcpy(y, c->scratch, (size_t)dalcs_system_n_columns(c->system) * sizeof(double));
    }
    memcpy(y, e->after, n_x * sizeof(double));
    return DALCS_OK;
}
