/* evaluate.c - the solution of all parts at one time. */
#include "algebraic_poles.h"
#include "present.h"
#include "radau.h"
#include "recurrence.h"
#include "step_error.h"

#include <math.h>
#include <string.h>

double dalcs_radau_bystander(const struct dalcs_radau_part *part, int bystander, double t,
                             enum dalcs_side side) {
    const struct dalcs_component *c = part->component;
    const struct dalcs_system *s = c->system;
    const double *gain = part->excitation.bystanders.gain + bystander * s->n_inputs;
    double sum = 0.0;
    for (int k = 0; k < s->n_inputs; k++) {
        if (gain[k] != 0.0) {
            const struct dalcs_stimulus *stimulus =
                k > 0 ? &c->circuit->stimulus[s->stimulus[k]] : NULL;
            sum += gain[k] * (k > 0 ? dalcs_stimulus_value(stimulus, t, side) : 1.0);
        }
    }
    return sum;
}

/* The last time that a source had an edge: a part without memory that has no solution at t has had none, but for single
 * times, since then, for in between sources are analytic. */
static double last_edge(const struct dalcs_component *c, double t, enum dalcs_side side) {
    double since = 0.0;
    for (double next = 0.0; next < t || (next == t && side == DALCS_RIGHT);) {
        since = next;
        next = dalcs_component_next_edge(c, since);
    }
    return since;
}

/* Where smooth functions end, no source need have an edge: between a time that has a solution, or an edge, and t. */
static double first_without(struct dalcs_radau_part *part, double since, double t, double near) {
    struct dalcs_component *c = part->component;
    double last = fmax(since, part->answered_at);
    while (t - last > near) {
        const double middle = last + 0.5 * (t - last);
        dalcs_component_look_ahead(c, middle, DALCS_LEFT, c->u);
        if (middle <= last || middle >= t) {
            break;
        }
        if (dalcs_component_solve(c, 0.0, c->u, c->y) > DALCS_OK) {
            t = middle;
        } else {
            last = middle;
        }
    }
    dalcs_component_look_ahead(c, t, DALCS_LEFT, c->u);
    const bool has_none = dalcs_component_solve(c, 0.0, c->u, c->y) > DALCS_OK;
    return has_none ? t : last; /* and what is told is of this time */
}

static void blame(const struct dalcs_radau *r, struct dalcs_radau_part *part, double t) {
    r->base->failure.time = t;
    r->base->failure.system = part->index;
    part->component->failure.sigma = 0.0;
    part->component->failure.u = part->component->u;
}

static void note_failure(const struct dalcs_radau *r, struct dalcs_radau_part *part, double t,
                         enum dalcs_side side) {
    const struct dalcs_component *c = part->component;
    const double since = last_edge(c, t, side);
    blame(r, part, c->system->n_smooth > 0 ? first_without(part, since, t, r->resolution) : since);
}

static void evaluate_stepped(struct dalcs_radau_part *part, double t, enum dalcs_side side) {
    struct dalcs_component *c = part->component;
    const struct dalcs_system *s = c->system;
    const struct dalcs_bystanders *b = &part->excitation.bystanders;
    int n_equations = dalcs_system_n_equations(s);
    dalcs_recurrence_complete(part);
    dalcs_step_values(part, dalcs_radau_theta(part, t), part->work.y1);
    memcpy(c->y, part->work.y1, (size_t)dalcs_system_n_columns(s) * sizeof(double));
    for (int d = 0; d < s->n_pairs; d++) {
        c->y[n_equations + d] *= dalcs_osnsp_is_on(&c->osnsp, d) ? 1.0 : 0.0;
    }
    for (int i = 0; i < b->n; i++) {
        c->y[b->column[i]] = dalcs_radau_bystander(part, i, t, side);
    }
    for (int i = 0; i < part->used.n; i++) {
        int k = part->used.input[i];
        c->u[s->n_x + k] = dalcs_stimulus_value(&c->circuit->stimulus[s->stimulus[k]], t, side);
    }
}

void dalcs_radau_read(struct dalcs_radau *r, int part, double t, enum dalcs_side side) {
    evaluate_stepped(&r->part[part], t, side);
}

static void evaluate_all_stepped(struct dalcs_radau *r, double t, enum dalcs_side side) {
    for (int k = 0; k < r->n_parts; k++) {
        if (r->part[k].kind == DALCS_PART_STEPPED) {
            evaluate_stepped(&r->part[k], t, side);
        }
    }
}

enum dalcs_status dalcs_radau_solve(struct dalcs_radau *r, struct dalcs_radau_part *part, double t,
                                    enum dalcs_side side) {
    struct dalcs_component *c = part->component;
    const struct dalcs_system *s = c->system;
    if (c->varying.n == 0 && t > 0.0) {
        return DALCS_OK;
    }
    bool is_new = !part->is_answered;
    for (int i = 0; i < c->varying.n; i++) {
        int k = c->varying.input[i];
        const double u = dalcs_stimulus_value(&c->circuit->stimulus[s->stimulus[k]], t, side);
        is_new = is_new || u != c->u[k];
        c->u[k] = u;
    }
    r->base->t = t;
    if (!is_new) {
        part->answered_at = t;
        return DALCS_OK;
    }
    const bool looks_between = dalcs_algebraic_poles_expect(part, t);
    const double before = part->answered_at;
    part->is_answered = false;
    enum dalcs_status status = dalcs_component_solve(c, 0.0, c->u, c->y);
    if (status > DALCS_OK) {
        note_failure(r, part, t, side);
    }
    DALCS_TRY(status);
    if (looks_between) {
        double at = t;
        status = dalcs_algebraic_poles_check(r, part, before, &at, side);
        if (status > DALCS_OK) {
            blame(r, part, at);
        }
        DALCS_TRY(status);
    }
    if (!dalcs_osnsp_is_open(&c->osnsp)) {
        part->is_answered = true;
        part->answered_at = t;
        return DALCS_OK;
    }
    evaluate_all_stepped(r, t, side); /* voltages between parts are told, too */
    return dalcs_euler_tell_open(r->base, part->index);
}

enum dalcs_status dalcs_radau_evaluate(struct dalcs_radau *r, double t, enum dalcs_side side) {
    evaluate_all_stepped(r, t, side);
    for (int k = 0; k < r->n_parts; k++) {
        if (r->part[k].kind == DALCS_PART_ALGEBRAIC) {
            DALCS_TRY(dalcs_radau_solve(r, &r->part[k], t, side));
        }
    }
    return DALCS_OK;
}

static void evaluate_end_of_last(struct dalcs_radau_part *part) {
    struct dalcs_component *c = part->component;
    dalcs_recurrence_complete_before(part);
    dalcs_radau_swap_out(part, &part->segment.out_before);
    dalcs_step_values(part, part->segment.end_before, part->work.y1);
    memcpy(c->y, part->work.y1, (size_t)dalcs_system_n_columns(c->system) * sizeof(double));
}

/* A component that found no next segment is where its last one ended. */
void dalcs_radau_break_off(struct dalcs_radau *r, double t) {
    for (int k = 0; k < r->n_parts; k++) {
        struct dalcs_radau_part *part = &r->part[k];
        if (part->kind != DALCS_PART_STEPPED) {
            continue;
        }
        if (part->segment.t_end > part->segment.t) {
            evaluate_stepped(part, t, DALCS_LEFT);
        } else if (part->segment.t > 0.0) {
            evaluate_end_of_last(part);
        }
    }
}
