/* euler.c - the time loop of implicit Euler over all components, and the micro-steps that tell what
 * happens at a discontinuity. */
#include "euler.h"

#include <math.h>
#include <string.h>

/* Lengths of a micro-step over h, the next where one has no certified answer (a circuit that is not
 * passive may have widely different gains). Two of them, extrapolated, leave an error of the square.
 * None reaches more than half of the way to the next edge. */
static const double micro_part[] = {1e-6, 1e-3, 1.0};

/* A quantity jumps when its change survives extrapolation to a step of 0 (regular changes halve with
 * the micro-step, impulsive ones do not) and is more than rounding. */
static const double jump_part = 0.5;
static const double jump_floor = 1e-9;

/* What is left of a state that falls to 0, over the largest that it was; and of one that has always been 0, over the
 * physical scale of its unit. */
static const double micro_error = 1e-6; /* what two micro-steps tell of what is no state */
static const double jump_remainder = 1e-12, jump_rounding = 1e-15;

/* Where vanishing steps have a limit, half a micro-step moves the state as far as a whole one, or half
 * as far; with the derivative of an impulse it moves it twice as far. */
static const double runaway = 1.5;

enum dalcs_status dalcs_euler_setup(struct dalcs_euler *e, const struct dalcs_circuit *circuit,
                                    const struct dalcs_network *network,
                                    const struct dalcs_osnsp_options *options, double h,
                                    double stop) {
    *e = (struct dalcs_euler){.circuit = circuit,
                              .network = network,
                              .h = h,
                              .failed_system = -1,
                              .worst = {.where = -1}};
    size_t n = (size_t)network->n_systems;
    size_t columns = 1;
    size_t pairs = 1;
    enum dalcs_status status = DALCS_OK;
    e->component = dalcs_arena_alloc(&e->arena, n, sizeof(*e->component));
    if (e->component == NULL) {
        return DALCS_E_NOMEM;
    }
    struct dalcs_osnsp_options share = *options;
    share.cache_bytes = options->cache_bytes / (n > 0 ? n : 1);
    for (int k = 0; k < network->n_systems && status == DALCS_OK; k++) {
        const struct dalcs_system *s = &network->system[k];
        size_t n_columns = (size_t)dalcs_system_n_columns(s);
        columns = n_columns > columns ? n_columns : columns;
        pairs = (size_t)s->n_pairs > pairs ? (size_t)s->n_pairs : pairs;
        status = dalcs_component_setup(&e->component[k], circuit, s, &share);
        e->n_components = k + 1;
    }
    e->after = dalcs_arena_alloc(&e->arena, columns, sizeof(double));
    e->charge = dalcs_arena_alloc(&e->arena, pairs, sizeof(double));
    e->flux = dalcs_arena_alloc(&e->arena, pairs, sizeof(double));
    e->told = dalcs_arena_alloc(&e->arena, columns, sizeof(double));
    e->told_from = dalcs_arena_alloc(&e->arena, columns, sizeof(double));
    e->noise = dalcs_arena_alloc(&e->arena, columns, sizeof(double));
    e->jump.after = dalcs_arena_alloc(&e->arena, columns, sizeof(double));
    e->jump.charge = dalcs_arena_alloc(&e->arena, pairs, sizeof(double));
    e->jump.flux = dalcs_arena_alloc(&e->arena, pairs, sizeof(double));
    bool complete = e->after != NULL && e->charge != NULL && e->flux != NULL && e->told != NULL &&
                    e->noise != NULL && e->jump.after != NULL && e->jump.charge != NULL &&
                    e->jump.flux != NULL;
    if (status == DALCS_OK && !complete) {
        status = DALCS_E_NOMEM;
    }
    if (status != DALCS_OK) {
        dalcs_euler_finish(e);
        return status;
    }
    dalcs_grid_init(&e->grid, h, stop, circuit->n_stimuli, circuit->stimulus);
    return DALCS_OK;
}

void dalcs_euler_finish(struct dalcs_euler *e) {
    for (int k = 0; k < e->n_components; k++) {
        dalcs_component_finish(&e->component[k]);
    }
    dalcs_arena_finish(&e->arena);
    dalcs_jumps_finish(&e->jumps);
    *e = (struct dalcs_euler){0};
}

static enum dalcs_status solve(struct dalcs_euler *e, int k, double sigma, const double *u,
                               double *y) {
    struct dalcs_component *c = &e->component[k];
    enum dalcs_status status = dalcs_component_solve(c, sigma, u, y);
    if (status != DALCS_OK) {
        c->failed_sigma = sigma;
        c->failed_u = u;
        e->failed_system = k;
        e->failed_time = e->t;
        e->failed_h = sigma > 0.0 ? 1.0 / sigma : e->h;
        return status;
    }
    if (c->osnsp.certificate.worst > e->worst.worst) {
        e->worst = c->osnsp.certificate;
        e->worst_time = e->t;
        e->worst_system = k;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_euler_tell_open(struct dalcs_euler *e, int k) {
    struct dalcs_component *c = &e->component[k];
    struct dalcs_osnsp *p = &c->osnsp;
    if (e->on_open == NULL || !dalcs_osnsp_is_open(p)) {
        return DALCS_OK;
    }
    double scale[2];
    bool vanishes;
    dalcs_osnsp_find_ties(p, c->u, c->y, scale);
    return e->on_open(e->open_user,
                      &(struct dalcs_open_instant){.time = e->t,
                                                   .engine = e,
                                                   .system = k,
                                                   .at_operating_point = e->at_operating_point,
                                                   .mode = p->mode,
                                                   .w = p->w,
                                                   .tied = p->tied,
                                                   .scale = {scale[0], scale[1]}},
                      &vanishes);
}

enum dalcs_status dalcs_euler_operating_point(struct dalcs_euler *e, bool transient_follows) {
    e->at_operating_point = true;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        dalcs_component_sample_operating(c, transient_follows, c->u);
        DALCS_TRY(solve(e, k, 0.0, c->u, c->y));
        memcpy(c->u, c->y, (size_t)c->system->n_x * sizeof(double));
    }
    if (e->on_operating_point != NULL) {
        DALCS_TRY(e->on_operating_point(e->circuit, e));
    }
    for (int k = 0; k < e->n_components; k++) {
        DALCS_TRY(dalcs_euler_tell_open(e, k));
    }
    e->at_operating_point = false;
    return DALCS_OK;
}

static double largest_state(const struct dalcs_system *s, const double *y, bool currents) {
    double largest = 0.0;
    for (int x = 0; x < s->n_x; x++) {
        largest = s->column_is_current[x] == currents ? fmax(largest, fabs(y[x])) : largest;
    }
    return largest;
}

double dalcs_euler_jump_energy(const struct dalcs_system *s, const double *before,
                               const double *after) {
    double energy = 0.0;
    for (int i = 0; i < s->n_x; i++) {
        for (int k = s->storage.p[i]; k < s->storage.p[i + 1]; k++) {
            int j = s->storage.j[k];
            energy += 0.5 * s->storage.x[k] * (after[i] - before[i]) * (after[j] - before[j]);
        }
    }
    return energy;
}

double dalcs_euler_stored_energy(const struct dalcs_system *s, const double *x) {
    double energy = 0.0;
    for (int i = 0; i < s->n_x; i++) {
        energy += 0.5 * x[i] * dalcs_csr_row_dot(&s->storage, i, x);
    }
    return energy;
}

/* What a jump cost, J: stored, lost, and in the thresholds that charge has passed. */
static double cost_of(const struct dalcs_system *s, const double *before,
                      const struct dalcs_jump_answer *jump) {
    double cost = dalcs_euler_stored_energy(s, jump->after) - dalcs_euler_stored_energy(s, before) +
                  dalcs_euler_jump_energy(s, before, jump->after);
    for (int d = 0; d < s->n_pairs; d++) {
        for (int k = s->F.p[d]; k < s->F.p[d + 1]; k++) {
            cost += s->F.j[k] == 0 ? s->F.x[k] * jump->charge[d] : 0.0;
        }
    }
    return cost;
}

enum dalcs_status dalcs_euler_find_jump(struct dalcs_euler *e, int k, const double *u) {
    const struct dalcs_osnsp *p = &e->component[k].osnsp;
    const struct dalcs_system *s = p->system;
    DALCS_TRY(dalcs_jumps_solve(&e->jumps, e->circuit, e->network, &p->options, k, p->mode, u,
                                u + s->n_x, &e->jump));
    if (!e->jump.is_known) {
        memcpy(e->jump.after, e->after, (size_t)s->n_x * sizeof(double));
        memcpy(e->jump.charge, e->charge, (size_t)s->n_pairs * sizeof(double));
        memcpy(e->jump.flux, e->flux, (size_t)s->n_pairs * sizeof(double));
        e->jump.source_work = cost_of(s, u, &e->jump);
    }
    return DALCS_OK;
}

/* The step from x is one of impulses of higher order than implicit Euler can follow: y1 and y2 are answers of steps one of
 * which is shorter. */
static enum dalcs_status refuse_derivative(struct dalcs_euler *e, int k, const double *x,
                                           const double *y1, const double *y2) {
    dalcs_osnsp_blame_states(&e->component[k].osnsp, x, y1, y2);
    e->component[k].failed_sigma = 1.0 / e->h;
    e->component[k].failed_u = e->component[k].u;
    e->failed_system = k;
    e->failed_time = e->t;
    e->failed_h = e->h;
    return DALCS_INFEASIBLE;
}

/* e->told_from and e->told: the states before and after a jump, without what is rounding. Impulses of charge come with
 * voltages that jump, those of flux with currents. */
static bool tell_states(struct dalcs_euler *e, const struct dalcs_system *s, const double *before) {
    bool jumps[2] = {false, false};
    for (int x = 0; x < s->n_x; x++) {
        bool is_told = fabs(e->jump.after[x] - before[x]) > e->noise[x];
        e->told_from[x] = before[x];
        e->told[x] = is_told ? e->jump.after[x] : before[x];
        jumps[s->column_is_current[x]] = jumps[s->column_is_current[x]] || is_told;
    }
    if (!jumps[0]) {
        memset(e->jump.charge, 0, (size_t)s->n_pairs * sizeof(double));
    }
    if (!jumps[1]) {
        memset(e->jump.flux, 0, (size_t)s->n_pairs * sizeof(double));
    }
    return jumps[0] || jumps[1];
}

/* And the other columns of the equations, as far as they are known. */
static void tell_columns(struct dalcs_euler *e, const struct dalcs_system *s, const double *from,
                         const double *to) {
    for (int c = s->n_x; c < dalcs_system_n_equations(s); c++) {
        double size = fmax(fabs(from[c]), fabs(to[c]));
        e->told_from[c] = from[c];
        e->told[c] = fabs(to[c] - from[c]) <= micro_error * size  ? from[c]
                     : fabs(to[c]) <= micro_error * fabs(from[c]) ? 0.0
                                                                  : to[c];
    }
}

enum dalcs_status dalcs_euler_report_jump(struct dalcs_euler *e, int k, double time,
                                          const double *before, const double *from,
                                          const double *to) {
    const struct dalcs_system *s = e->component[k].system;
    struct dalcs_euler_jump jump = {
        .time = time,
        .system = k,
        .mode = e->component[k].osnsp.mode,
        .before = before,
        .after = e->jump.after,
        .n_known = s->n_x,
        .charge = e->jump.charge,
        .flux = e->jump.flux,
        .energy_lost = dalcs_euler_jump_energy(s, before, e->jump.after),
        .source_work = e->jump.source_work,
    };
    if (e->observer != NULL) {
        e->observer->jump(e->observer->user, &jump);
    }
    if (e->on_jump == NULL || !tell_states(e, s, before)) {
        return DALCS_OK;
    }
    if (from != NULL && to != NULL) {
        tell_columns(e, s, from, to);
        jump.n_known = dalcs_system_n_equations(s);
    }
    jump.before = e->told_from;
    jump.after = e->told;
    jump.energy_lost = dalcs_euler_jump_energy(s, before, e->told);
    return e->on_jump(e->jump_user, &jump);
}

/* What certificates may leave of the states' own sizes, or rounding of the largest of their unit so far and of what the
 * other unit vouches for. */
static void find_noise(struct dalcs_euler *e, int k, const double *before) {
    const struct dalcs_component *c = &e->component[k];
    const struct dalcs_system *s = c->system;
    const struct dalcs_step_form *f = c->osnsp.form[0];
    double unit[2];
    for (int of = 0; of < 2; of++) {
        unit[of] = fmax(c->scale[of], fmax(largest_state(s, before, of == 1),
                                           largest_state(s, e->jump.after, of == 1)));
    }
    const double scale[2] = {fmax(unit[0], f->ampere_in_volts * unit[1]),
                             fmax(unit[1], f->volt_in_amperes * unit[0])};
    for (int x = 0; x < s->n_x; x++) {
        double own = fmax(c->largest[x], fmax(fabs(before[x]), fabs(e->jump.after[x])));
        e->noise[x] = fmax(jump_remainder * own, jump_rounding * scale[s->column_is_current[x]]);
    }
}

/* What two micro-steps, y of length h and the component's scratch of half of it, say of a jump. */
static bool extrapolate(struct dalcs_euler *e, int k, const double *u, const double *y,
                        const double *limit) {
    const struct dalcs_component *c = &e->component[k];
    const struct dalcs_system *s = c->system;
    bool jumps = false;
    for (int x = 0; x < s->n_x; x++) {
        double whole = y[x] - u[x];
        double limit_of_0 = 2.0 * (c->scratch[x] - u[x]) - whole;
        jumps = jumps || (fabs(limit_of_0) > jump_part * fabs(whole) &&
                          fabs(limit_of_0) > limit[s->column_is_current[x]]);
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
        double charge = h * lambda[d] - e->charge[d];
        double flux = h * c->osnsp.w[d] - e->flux[d];
        differ = differ || (c->osnsp.is_diode[d] && (charge < -jump_part * fabs(e->charge[d]) ||
                                                     flux < -jump_part * fabs(e->flux[d])));
    }
    for (int d = 0; d < c->system->n_pairs; d++) {
        double *impulse[2] = {&e->charge[d], &e->flux[d]};
        double half[2] = {0.5 * h * lambda[d], 0.5 * h * c->osnsp.w[d]};
        for (int i = 0; i < 2; i++) {
            double limit_of_0 = 2.0 * half[i] - *impulse[i];
            bool impulsive = fabs(limit_of_0) > jump_part * fabs(*impulse[i]);
            *impulse[i] = !impulsive ? 0.0 : differ ? half[i] : limit_of_0;
        }
    }
}

/* A state that moves twice as far in half the time has no limit. */
static bool runs_away(const struct dalcs_component *c, const double *u, const double *y,
                      const double *limit) {
    bool away = false;
    for (int x = 0; x < c->system->n_x && !away; x++) {
        double whole = fabs(y[x] - u[x]);
        away = whole > limit[c->system->column_is_current[x]] &&
               fabs(c->scratch[x] - u[x]) > runaway * whole;
    }
    return away;
}

/* Solves micro-steps from u (whose x is x-) into y, and so learns the state just after a
 * discontinuity, left in e->after: x- where it is continuous. Where it jumps, the jump is reported
 * and y holds impulsive currents. *length is that of the micro-step of y. */
static enum dalcs_status look_after(struct dalcs_euler *e, int k, const double *before,
                                    const double *u, double *y, double *length) {
    struct dalcs_component *c = &e->component[k];
    const struct dalcs_system *s = c->system;
    int n_equations = dalcs_system_n_equations(s);
    enum dalcs_status status = DALCS_NOT_CONVERGED;
    double h = 0.0;
    for (size_t i = 0; i < sizeof(micro_part) / sizeof(*micro_part) && status > DALCS_OK; i++) {
        h = fmin(micro_part[i] * e->grid.h, 0.5 * (e->grid.next_edge - e->t));
        status = solve(e, k, 1.0 / h, u, y);
    }
    DALCS_TRY(status);
    *length = h;
    memcpy(e->after, u, (size_t)s->n_x * sizeof(double));
    double limit[2];
    bool moved = false;
    for (int unit = 0; unit < 2; unit++) {
        limit[unit] = jump_floor * fmax(largest_state(s, u, unit), largest_state(s, y, unit));
    }
    for (int x = 0; x < s->n_x; x++) {
        moved = moved || fabs(y[x] - u[x]) > limit[s->column_is_current[x]];
    }
    if (!moved) {
        return DALCS_OK;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        e->charge[d] = h * y[n_equations + d];
        e->flux[d] = h * c->osnsp.w[d];
    }
    DALCS_TRY(solve(e, k, 2.0 / h, u, c->scratch));
    if (c->commanded) {
        return DALCS_OK; /* a switch moved in between: the two tell nothing together */
    }
    if (!dalcs_osnsp_is_monotone(&c->osnsp) && runs_away(c, u, y, limit)) {
        return refuse_derivative(e, k, u, y, c->scratch);
    }
    if (!extrapolate(e, k, u, y, limit)) {
        return DALCS_OK;
    }
    extrapolate_impulses(e, k, h);
    DALCS_TRY(dalcs_euler_find_jump(e, k, u));
    bool jumps = !e->jump.is_known;
    for (int x = 0; x < s->n_x && !jumps; x++) {
        jumps = fabs(e->jump.after[x] - u[x]) > limit[s->column_is_current[x]];
    }
    if (!jumps) {
        return DALCS_OK; /* a transient faster than a micro-step, which is not a jump */
    }
    memcpy(e->after, e->jump.after, (size_t)s->n_x * sizeof(double));
    find_noise(e, k, before);
    return dalcs_euler_report_jump(e, k, e->t, before, e->t > 0.0 ? before : NULL, c->scratch);
}

/* y becomes all values just after a discontinuity, with the state after it. A micro-step from that
 * state tells where the circuit goes; its mirror image, which comes from as far before, ends on that
 * state up to the square of the micro-step, with the currents that slopes of sources drive, and is
 * certified. u is left as it was. */
static enum dalcs_status settle_after(struct dalcs_euler *e, int k, const double *before,
                                      const double *u, double *y) {
    struct dalcs_component *c = &e->component[k];
    size_t n_x = (size_t)c->system->n_x;
    size_t input_bytes = (size_t)c->system->n_inputs * sizeof(double);
    if (n_x == 0) {
        return solve(e, k, 0.0, u, y);
    }
    double h;
    DALCS_TRY(look_after(e, k, before, u, y, &h));
    memcpy(c->probe_u, e->after, n_x * sizeof(double));
    memcpy(c->probe_u + n_x, u + n_x, input_bytes);
    dalcs_component_look_ahead(c, e->t + h, c->probe_u);
    enum dalcs_status status = solve(e, k, 1.0 / h, c->probe_u, c->scratch);
    if (status == DALCS_OK) {
        for (size_t x = 0; x < n_x; x++) {
            c->probe_u[x] = 2.0 * e->after[x] - c->scratch[x];
        }
        memcpy(c->probe_u + n_x, u + n_x, input_bytes);
        status = solve(e, k, 1.0 / h, c->probe_u, c->scratch);
    }
    if (status < DALCS_OK) {
        return status;
    }
    /* otherwise the first micro-step has to do, and the next step tells */
    if (status == DALCS_OK) {
        memcpy(y, c->scratch, (size_t)dalcs_system_n_columns(c->system) * sizeof(double));
    }
    memcpy(y, e->after, n_x * sizeof(double));
    return DALCS_OK;
}

enum dalcs_status dalcs_euler_start(struct dalcs_euler *e, double *const *initial) {
    e->looks_behind = true;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        size_t n_x = (size_t)c->system->n_x;
        size_t n_columns = (size_t)dalcs_system_n_columns(c->system);
        dalcs_component_sample(c, 0.0, DALCS_RIGHT, c->u);
        if (initial != NULL) {
            memcpy(c->u, initial[k], n_x * sizeof(double));
            memset(c->y_before, 0, n_columns * sizeof(double));
            memcpy(c->y_before, c->u, n_x * sizeof(double));
        } else {
            memcpy(c->y_before, c->y, n_columns * sizeof(double));
        }
        if (e->observer != NULL) {
            e->observer->start(e->observer->user, k, c->u);
        }
        if (initial != NULL || dalcs_component_jumps_at_start(c)) {
            DALCS_TRY(settle_after(e, k, c->y_before, c->u, c->y));
        }
    }
    for (int k = 0; initial != NULL && k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        c->was_open = dalcs_osnsp_is_open(&c->osnsp);
        if (c->is_static) {
            DALCS_TRY(dalcs_euler_tell_open(e, k));
        }
    }
    e->looks_behind = false;
    return DALCS_OK;
}

/* What is open at one instant only, as where diodes commutate, is left out. */
static enum dalcs_status tell_what_stays_open(struct dalcs_euler *e) {
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        bool open = !c->is_static && dalcs_osnsp_is_open(&c->osnsp);
        if (open && c->was_open) {
            DALCS_TRY(dalcs_euler_tell_open(e, k));
        }
        c->was_open = open;
    }
    return DALCS_OK;
}

/* After a step: how large states and answers have been. */
static void note_scale(struct dalcs_component *c) {
    for (int x = 0; x < c->system->n_x; x++) {
        double size = fabs(c->y[x]);
        c->largest[x] = size > c->largest[x] ? size : c->largest[x];
    }
    c->scale[0] = fmax(c->scale[0], c->osnsp.certificate.volt);
    c->scale[1] = fmax(c->scale[1], c->osnsp.certificate.ampere);
}

enum dalcs_status dalcs_euler_step(struct dalcs_euler *e) {
    e->t_before = e->t;
    double h = dalcs_grid_advance(&e->grid, &e->at_jump);
    e->t = e->grid.t;
    e->h = h;
    double sigma = 1.0 / h;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        if (c->is_static) {
            continue;
        }
        double *swap = c->y_before;
        c->y_before = c->y;
        c->y = swap;
        size_t n_x = (size_t)c->system->n_x;
        dalcs_component_sample(c, e->t, DALCS_LEFT, c->u);
        DALCS_TRY(solve(e, k, n_x > 0 ? sigma : 0.0, c->u, c->y));
        note_scale(c);
        if (dalcs_component_overgrows(c, c->y)) {
            e->failed_system = k;
            e->failed_time = e->t;
            return DALCS_NOT_CONVERGED;
        }
        if (e->observer != NULL) {
            e->observer->scale(e->observer->user, k, &c->osnsp.certificate);
        }
        if (e->detect_jumps && c->commanded && n_x > 0) {
            size_t mode_bytes = (size_t)c->osnsp.n_words * sizeof(uint64_t);
            memcpy(c->saved_mode, c->osnsp.mode, mode_bytes);
            double length;
            enum dalcs_status status = look_after(e, k, c->y_before, c->u, c->probe_y, &length);
            if (status < DALCS_OK) {
                return status; /* without a micro-step there is no jump to report, no more */
            }
            memcpy(c->osnsp.mode, c->saved_mode, mode_bytes);
        }
        if (e->observer != NULL) {
            e->observer->step(e->observer->user, k, c->u, c->y, c->u + n_x, h);
        }
        memcpy(c->u, c->y, n_x * sizeof(double));
    }
    e->steps++;
    return e->on_open != NULL ? tell_what_stays_open(e) : DALCS_OK;
}

enum dalcs_status dalcs_euler_cross(struct dalcs_euler *e) {
    e->looks_behind = true;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        dalcs_component_sample(c, e->t, DALCS_RIGHT, c->probe_u);
        bool changes = false;
        for (int i = 0; i < c->n_varying; i++) {
            int input = c->system->n_x + c->varying[i];
            changes = changes || c->probe_u[input] != c->u[input];
        }
        if (changes) {
            dalcs_component_sample(c, e->t, DALCS_RIGHT, c->u);
            memcpy(c->probe_y, c->y, (size_t)dalcs_system_n_columns(c->system) * sizeof(double));
            DALCS_TRY(settle_after(e, k, c->probe_y, c->u, c->y));
        }
    }
    e->looks_behind = false;
    return DALCS_OK;
}
