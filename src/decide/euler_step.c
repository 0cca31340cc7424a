/* euler_step.c - a step of implicit Euler as a segment, where events crowd or no mode is found. */
#include "magnitudes.h"
#include "micro_steps.h"
#include "present.h"
#include "restart.h"
#include "slide.h"
#include "slide_try.h"
#include "smooth_step.h"
#include "step_length.h"

#include <math.h>
#include <string.h>

/* States go straight, and all else is what it is at the end. */
static void fill_out(struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    int n_columns = dalcs_system_n_columns(p->system);
    int n_equations = dalcs_system_n_equations(p->system);
    double *end = part->segment.out + (l->n_nodes - 1) * l->stride;
    memcpy(end, part->work.y1, (size_t)n_columns * sizeof(double));
    for (int d = 0; d < p->system->n_pairs; d++) {
        end[n_equations + d] += dalcs_osnsp_is_on(p, d) ? 0.0 : p->w[d];
    }
    for (int k = 0; k < l->n_nodes; k++) {
        double *out = part->segment.out + k * l->stride;
        double at = part->stages.method->node[k];
        for (int c = 0; c < n_columns; c++) {
            double start = c < p->system->n_x ? part->x[c] : end[c];
            out[c] = k + 1 < l->n_nodes ? start + at * (end[c] - start) : end[c];
        }
        for (int i = 0; i < part->stages.n_watched; i++) {
            out[n_columns + i] = 0.0;
        }
    }
}

void dalcs_radau_accept_euler(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                              double h) {
    double limit = dalcs_radau_limit(r, part);
    part->segment.by_euler = true;
    part->segment.is_coarse = true;
    part->segment.h = h;
    part->segment.end = 1.0;
    part->segment.t_end = fmin(part->segment.t + h, limit);
    part->segment.why = part->segment.t_end >= limit ? DALCS_END_AT_EDGE : DALCS_END_OF_STEP;
    part->guards.n_crossed = 0;
    part->guards.fresh = true;
    part->guards.undecided = false;
}

void dalcs_radau_accept_implicit(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                                 double h) {
    const struct dalcs_component *c = part->component;
    const struct dalcs_observer *observer = r->base->listener.observer;
    if (observer != NULL) {
        const struct dalcs_observed_sides whole = {
            .n = 1, .y = {part->work.y1}, .weight = {1.0}, .h = h, .times = 1.0};
        observer->scale(observer->user, part->index, &c->osnsp.certificate);
        observer->try_by_euler(observer->user, part->index);
        observer->step_by_euler(observer->user, part->index, part->x, part->work.y1, &whole,
                                part->work.u + c->system->n_x);
    }
    fill_out(part);
    if (part->smooth != NULL) {
        dalcs_smooth_euler_note(part);
    }
    dalcs_radau_accept_euler(r, part, h);
}

/* Does half of the step, part->work.y2, lead at least a quarter as far as the step itself, the same way, and no farther?
 * Else a value of a smooth function may be one that no state goes to: c v' = v^3 has v = -(c / h)^1/2 on the other side of
 * infinity. A state that sources drive as a power t^p of more than the second goes 2^-p as far in any step: *share, of the
 * least one, is what it was in a step four times as long. That of a state whose step alone is beyond infinity falls at least
 * as h^3/2, which is h from where it was and h^1/2 from the other side. */
static bool is_on_way(const struct dalcs_radau_part *part, double *share) {
    const struct dalcs_system *s = part->component->system;
    const double noticeable = dalcs_micro_noticeable(part);
    const double before = *share;
    bool is = true;
    *share = INFINITY;
    for (int x = 0; x < s->n_x && is; x++) {
        double whole = part->work.y1[x] - part->x[x];
        double half = part->work.y2[x] - part->x[x];
        double scale = fmax(part->scales.unit[s->column_is_current[x]], fabs(part->x[x]));
        double along = copysign(half, half * whole); /* below 0: the other way */
        if (fabs(whole) > noticeable * scale) {
            *share = fmin(*share, along / fabs(whole));
            is = along > 0.0 && along <= (1.0 + dalcs_slight) * fabs(whole);
        }
    }
    return is && (4.0 * *share >= 1.0 || (0.5 * before <= *share && *share <= 2.0 * before));
}

/* part->work.y1 by a step of length *h, or of a part of it: where sources are smooth functions, so long that the state is
 * on its way. */
static enum dalcs_status solve_on_way(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      double *h) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    const size_t bytes = (size_t)p->n_words * sizeof(*p->mode);
    bool is_shortest = false;
    double share = 0.0;
    memcpy(part->work.mode_before, p->mode, bytes);
    while (!is_shortest) {
        DALCS_TRY(dalcs_radau_implicit_step(r, part, *h, *h, part->x, part->work.y1));
        if (part->smooth == NULL || dalcs_smooth_euler_meets_pole(part)) {
            return DALCS_OK;
        }
        memcpy(p->mode, part->work.mode_before, bytes);
        const double half = 0.5 * *h;
        enum dalcs_status status =
            dalcs_radau_implicit_step(r, part, half, half, part->x, part->work.y2);
        memcpy(p->mode, part->work.mode_before, bytes);
        if (status < DALCS_OK) {
            return status;
        }
        if (status == DALCS_OK && is_on_way(part, &share)) {
            return dalcs_radau_implicit_step(r, part, *h, *h, part->x, part->work.y1);
        }
        is_shortest = 0.25 * *h < dalcs_length_shortest(r);
        *h *= is_shortest ? 1.0 : 0.25;
    }
    return dalcs_micro_fail(r, part, 1.0 / *h, part->work.u, DALCS_NOT_CONVERGED);
}

static void put_inputs(struct dalcs_radau_part *part, double h) {
    const size_t n_x = (size_t)part->component->system->n_x;
    memcpy(part->work.u, part->x, n_x * sizeof(double));
    dalcs_excitation_inputs(&part->excitation, part->segment.t, h, part->work.u + n_x);
}

/* The switches do not agree with part->work.y1, the answer of a step of length h. If they would not in vanishing ones
 * either, a step in one of their positions is none of the circuit. Those without hysteresis may have a mean of both: where
 * vanishing steps have none either, the step is *undecided, and the audit ends the run if the next one is, too. */
static enum dalcs_status check_limit(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                     bool *undecided) {
    struct dalcs_component *c = part->component;
    const bool has_states = c->system->n_x > 0;
    const size_t bytes = (size_t)c->osnsp.n_words * sizeof(uint64_t);
    const double micro = dalcs_radau_micro_length(r, part, 0);
    const double sigma = has_states ? 1.0 / micro : 0.0;
    struct dalcs_restless found;
    const struct dalcs_restless_step vanishing = {
        .sigma = sigma, .u = part->work.u, .moving = c->probe_u};
    memcpy(part->work.mode_before, c->osnsp.mode, bytes);
    DALCS_TRY(dalcs_slide_find_leading(r, part, micro));
    put_inputs(part, micro);
    DALCS_TRY(dalcs_restless_find(&c->positions, !c->positions.sides.remember, &vanishing,
                                  part->work.y2, &found));
    memcpy(c->osnsp.mode, part->work.mode_before, bytes);
    if (found.pair >= 0) {
        enum dalcs_status status = dalcs_micro_fail(r, part, sigma, part->work.u, DALCS_INFEASIBLE);
        c->failure.restless = found;
        return status;
    }
    DALCS_TRY(dalcs_restless_find(&c->positions, false, &vanishing, part->work.y2, &found));
    memcpy(c->osnsp.mode, part->work.mode_before, bytes);
    if (found.pair >= 0) {
        bool slides;
        DALCS_TRY(dalcs_slide_micro_steps(r, part, micro, &slides));
        memcpy(c->osnsp.mode, part->work.mode_before, bytes);
        *undecided = !slides;
    }
    put_inputs(part, h);
    return dalcs_osnsp_solve(&c->osnsp, has_states ? 1.0 / h : 0.0, part->work.u, part->work.y1);
}

enum dalcs_status dalcs_radau_euler_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                         double h) {
    struct dalcs_component *c = part->component;
    bool slides = part->guards.slides;
    part->guards.slides = false;
    if (!slides) {
        dalcs_micro_positions(part, true);
        DALCS_TRY(solve_on_way(r, part, &h));
        slides = c->positions.alternates;
    }
    if (slides) {
        DALCS_TRY(dalcs_slide_step(r, part, dalcs_radau_limit(r, part), true, &slides));
        if (slides) {
            return DALCS_OK;
        }
        dalcs_micro_positions(part, true);
        DALCS_TRY(dalcs_radau_implicit_step(r, part, h, h, part->x, part->work.y1));
    }
    if (dalcs_smooth_euler_meets_pole(part)) {
        return dalcs_micro_fail(r, part, 1.0 / h, part->work.u, DALCS_NOT_CONVERGED);
    }
    bool undecided = false;
    if (!c->positions.settled) { /* the present command stands */
        DALCS_TRY(check_limit(r, part, h, &undecided));
        c->commands.n_delayed++;
    }
    dalcs_radau_accept_implicit(r, part, h);
    part->guards.undecided = undecided;
    r->euler_steps++;
    return DALCS_OK;
}
