/* smooth_step.c - Newton's method on the values of smooth sources at the nodes of a step. */
#include "smooth_step_internal.h"

#include "extremes.h"
#include "magnitudes.h"
#include "present.h"
#include "rounding.h"
#include "smooth_poles.h"
#include "smooth_tangents.h"

#include <math.h>

/* A step in which so many are not enough is too long: near the solution each doubles the digits. */
enum { MOST_STEPS = 12 };

enum dalcs_status dalcs_smooth_step_setup(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    if (s->n_smooth == 0 || part->kind == DALCS_PART_ALGEBRAIC) {
        return DALCS_OK;
    }
    const struct dalcs_stages *stages = &part->stages;
    struct dalcs_smooth_step *p = dalcs_arena_alloc(&part->arena, 1, sizeof(*p));
    if (p == NULL) {
        return DALCS_E_NOMEM;
    }
    part->smooth = p;
    const size_t n = (size_t)(stages->method->s + 1) * (size_t)s->n_smooth;
    p->mode = dalcs_arena_alloc(&part->arena, (size_t)stages->n_words, sizeof(*p->mode));
    p->in = dalcs_arena_alloc(&part->arena, (size_t)stages->n_in, sizeof(double));
    p->out = dalcs_arena_alloc(&part->arena, dalcs_stages_room(stages), sizeof(double));
    p->dx = dalcs_arena_alloc(&part->arena, n, sizeof(*p->dx));
    p->drift = dalcs_arena_alloc(&part->arena, n * (size_t)s->n_x + 1, sizeof(double));
    p->rounding = dalcs_arena_alloc(&part->arena, (size_t)s->n_x + 1, sizeof(double));
    p->moved = dalcs_arena_alloc(&part->arena, (size_t)s->n_pairs + 1, sizeof(*p->moved));
    p->last = dalcs_arena_alloc(&part->arena, (size_t)s->n_smooth, sizeof(*p->last));
    p->most = dalcs_arena_alloc(&part->arena, (size_t)s->n_smooth, sizeof(*p->most));
    if (p->drift == NULL || p->rounding == NULL || p->moved == NULL || p->mode == NULL ||
        p->in == NULL || p->out == NULL || p->dx == NULL || p->last == NULL || p->most == NULL) {
        return DALCS_E_NOMEM;
    }
    p->may_have_poles = dalcs_smooth_may_have_poles(s);
    DALCS_TRY(dalcs_smooth_missed_setup(part));
    return dalcs_smooth_newton_setup(&p->newton, s, stages->method->s + 1, &part->arena);
}

/* The place of value q in what goes into a step. */
static int place_of(const struct dalcs_radau_part *part, int q) {
    const int n_smooth = part->component->system->n_smooth;
    return dalcs_smooth_step_place(part, q % n_smooth, q / n_smooth);
}

/* What goes into the step, from the present values. */
static void put_values(struct dalcs_radau_part *part) {
    const struct dalcs_smooth_newton *n = &part->smooth->newton;
    const int n_smooth = n->system->n_smooth;
    for (int q = 0; q < n->n; q++) {
        *dalcs_smooth_step_value(part, q % n_smooth, q / n_smooth) = n->phi[q];
    }
    dalcs_segment_inputs(part);
}

static void read(struct dalcs_smooth_newton *n, const struct dalcs_radau_part *part,
                 const double *out) {
    for (int node = 0; node < n->n_points; node++) {
        dalcs_smooth_newton_read(n, node, out + node * part->stages.layout.stride);
    }
}

static bool has_slope(const struct dalcs_radau_part *part) {
    const struct dalcs_smooth_step *p = part->smooth;
    const struct dalcs_osnsp *osnsp = &part->component->osnsp;
    return p->slope_h == part->segment.h && dalcs_mode_is(p->mode, osnsp->mode, osnsp->n_words);
}

/* Which pairs lie beside what a change of some value makes of them. */
static void note_moved(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    const int n_equations = dalcs_system_n_equations(s);
    for (int node = 0; node < part->stages.layout.n_nodes; node++) {
        const int first = node * part->stages.layout.stride + n_equations;
        for (int d = 0; d < s->n_pairs; d++) {
            part->smooth->moved[d] |= part->smooth->out[first + d] != part->segment.out[first + d];
        }
    }
}

bool dalcs_smooth_step_moves(const struct dalcs_radau_part *part, int pair) {
    return part->smooth == NULL || part->smooth->slope_h == 0.0 || part->smooth->moved[pair];
}

/* What a change of each value does to all arguments, by differences: the step is affine in them. */
static enum dalcs_status find_slope(struct dalcs_radau_part *part,
                                    struct dalcs_stage_entry *entry) {
    struct dalcs_smooth_step *p = part->smooth;
    struct dalcs_smooth_newton *n = &p->newton;
    const struct dalcs_system *s = n->system;
    const struct dalcs_osnsp *osnsp = &part->component->osnsp;
    const int stride = part->stages.layout.stride;
    memcpy(p->in, part->segment.in, (size_t)part->stages.n_in * sizeof(double));
    for (int q = 0; q < n->n; q++) {
        double *in = p->in + place_of(part, q);
        const double before = *in;
        const double change = 1.0 + fabs(before);
        *in += change;
        DALCS_TRY(dalcs_stages_apply(&part->stages, entry, p->in, p->out));
        *in = before;
        note_moved(part);
        for (int k = 0; k < 2 * n->n; k++) {
            const struct dalcs_smooth_input *of = &s->smooth[k / 2 % s->n_smooth];
            const int column = k % 2 < of->n ? of->column[k % 2] : -1;
            const int at = k / 2 / s->n_smooth * stride + column;
            n->slope[(size_t)k * (size_t)n->n + (size_t)q] =
                column >= 0 ? (p->out[at] - part->segment.out[at]) / change : 0.0;
        }
        const int drift = part->stages.layout.drift;
        for (int x = 0; x < s->n_x; x++) {
            p->drift[q * s->n_x + x] = (p->out[drift + x] - part->segment.out[drift + x]) / change;
        }
    }
    p->slope_h = part->segment.h;
    memcpy(p->mode, osnsp->mode, (size_t)osnsp->n_words * sizeof(*p->mode));
    return DALCS_OK;
}

static enum dalcs_status apply(struct dalcs_radau_part *part, struct dalcs_stage_entry **entry) {
    return dalcs_stages_step(&part->stages, part->component->osnsp.mode, part->segment.h,
                             part->segment.in, part->segment.out, entry);
}

/* Until the values are the functions to so much of themselves, or to rounding. */
static enum dalcs_status iterate(struct dalcs_radau_part *part, double tolerance,
                                 struct dalcs_stage_entry **entry) {
    struct dalcs_smooth_newton *n = &part->smooth->newton;
    for (int step = 0; step < MOST_STEPS; step++) {
        bool repeats;
        bool is_done;
        if (dalcs_osnsp_is_cancelled(&part->component->osnsp)) {
            return DALCS_E_CANCELLED;
        }
        put_values(part);
        enum dalcs_status status = apply(part, entry);
        if (status != DALCS_OK) {
            return status;
        }
        read(n, part, part->segment.out);
        if (!dalcs_smooth_newton_is_finite(n, &repeats)) {
            return DALCS_NOT_CONVERGED;
        }
        if (!repeats && dalcs_smooth_newton_agrees(n, tolerance, &is_done) && is_done) {
            return DALCS_OK;
        }
        if (!repeats && !has_slope(part)) {
            DALCS_TRY(find_slope(part, *entry));
        }
        if (!repeats && !dalcs_smooth_newton_step(n)) {
            return DALCS_NOT_CONVERGED;
        }
    }
    return DALCS_NOT_CONVERGED;
}

/* Steps that were factored with other lines are forgotten. */
static void take_tangents(struct dalcs_radau_part *part) {
    struct dalcs_smooth_step *p = part->smooth;
    if (p->n_tangents != part->component->osnsp.smooth.n_tangents) {
        p->n_tangents = part->component->osnsp.smooth.n_tangents;
        dalcs_stages_forget(&part->stages);
        part->segment.entry = NULL;
        dalcs_smooth_newton_forget(&p->newton);
        p->slope_h = p->missed.h = 0.0;
    }
}

/* From what was there at the end of the segment before, or of a micro-step. */
static enum dalcs_status solve(struct dalcs_radau_part *part, struct dalcs_stage_entry **entry) {
    struct dalcs_smooth_newton *n = &part->smooth->newton;
    const struct dalcs_smooth_newton *now = part->component->osnsp.smooth.newton;
    const int n_smooth = n->system->n_smooth;
    take_tangents(part);
    for (int q = 0; q < n->n; q++) {
        n->phi[q] = now->phi[q % n_smooth];
    }
    dalcs_smooth_newton_begin(n, now->x);
    dalcs_smooth_missed_forget(part);
    const double tolerance = dalcs_larger(part->component->osnsp.options.certificate_tolerance,
                                          dalcs_slight * part->inner_tolerance);
    enum dalcs_status status = iterate(part, tolerance, entry);
    return status == DALCS_OK ? dalcs_smooth_missed_add(part, entry) : status;
}

enum dalcs_status dalcs_smooth_step_solve(struct dalcs_radau_part *part,
                                          struct dalcs_stage_entry **entry) {
    (void)dalcs_osnsp_retangent(&part->component->osnsp, NULL);
    enum dalcs_status status = solve(part, entry);
    if (status > DALCS_OK && dalcs_osnsp_retangent(&part->component->osnsp, NULL)) {
        status = solve(part, entry);
    }
    if (status == DALCS_OK) {
        part->segment.rounding = dalcs_stage_rounding(*entry);
    }
    return status;
}

enum dalcs_status dalcs_smooth_step_refine(struct dalcs_radau_part *part,
                                           struct dalcs_stage_entry **entry) {
    part->smooth->newton.outcome.defect = INFINITY;
    dalcs_smooth_missed_forget(part);
    const enum dalcs_status status = iterate(part, 0.0, entry);
    return status == DALCS_OK ? dalcs_smooth_missed_add(part, entry) : status;
}

void dalcs_smooth_step_note(struct dalcs_radau_part *part, double theta) {
    const struct dalcs_smooth_newton *n = &part->smooth->newton;
    const int n_smooth = n->system->n_smooth;
    struct dalcs_smooth_newton *now = part->component->osnsp.smooth.newton;
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(part->stages.method, theta, weight);
    for (int k = 0; k < n_smooth; k++) {
        now->phi[k] = 0.0;
        for (int node = 0; node < n->n_points; node++) {
            now->phi[k] += weight[node] * n->phi[node * n_smooth + k];
        }
    }
    dalcs_smooth_step_arguments(part, theta, now->x);
    dalcs_smooth_euler_note(part);
}

const double *dalcs_smooth_step_rounding(struct dalcs_radau_part *part,
                                         struct dalcs_stage_entry *entry) {
    const struct dalcs_smooth_step *p = part->smooth;
    const int n_x = part->component->system->n_x;
    if (p == NULL || (!has_slope(part) && find_slope(part, entry) != DALCS_OK)) {
        return NULL;
    }
    memset(p->rounding, 0, (size_t)n_x * sizeof(double));
    for (int q = 0; q < p->newton.n; q++) {
        const double rounding = dalcs_smooth_function_rounding(
            dalcs_smooth_newton_input(&p->newton, q), p->newton.x[q]);
        for (int x = 0; x < n_x && isfinite(rounding); x++) {
            p->rounding[x] += fabs(p->drift[q * n_x + x]) * rounding;
        }
    }
    return p->rounding;
}

enum dalcs_status dalcs_smooth_step_vary_begin(struct dalcs_radau_part *part,
                                               struct dalcs_stage_entry *entry) {
    if (!has_slope(part)) {
        DALCS_TRY(find_slope(part, entry));
    }
    return dalcs_smooth_newton_factor(&part->smooth->newton) ? DALCS_OK : DALCS_SINGULAR;
}

void dalcs_smooth_step_vary(const struct dalcs_radau_part *part, const double *out, double *in) {
    const struct dalcs_smooth_step *p = part->smooth;
    const struct dalcs_system *s = p->newton.system;
    double *change = p->newton.work.step;
    for (int q = 0; q < p->newton.n; q++) {
        const struct dalcs_smooth_input *of = &s->smooth[q % s->n_smooth];
        const double *y = out + q / s->n_smooth * part->stages.layout.stride;
        for (int j = 0; j < 2; j++) {
            p->dx[q][j] = j < of->n && of->column[j] >= 0 ? y[of->column[j]] : 0.0;
        }
    }
    dalcs_smooth_newton_vary(&p->newton, p->dx, change);
    for (int q = 0; q < p->newton.n; q++) {
        in[place_of(part, q)] = change[q];
    }
}
