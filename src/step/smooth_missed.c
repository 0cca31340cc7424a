/* smooth_missed.c - what the polynomials of smooth sources miss between the nodes of a step.
 *
 * Sources read what others miss. Where none reads itself by way of others, as many rounds as there are sources tell all of
 * it. In a ring each round makes of it what the tangents there, less the lines, make of the one before: that may grow
 * without bound, in a step of any length. There it is the solution of as many equations, by Newton's method. */
#include "extremes.h"
#include "magnitudes.h"
#include "present.h"
#include "rounding.h"
#include "smooth_step_internal.h"
#include "smooth_tangents.h"

#include <lapacke.h>
#include <math.h>

/* Near the solution each doubles the digits; rounding may not let them settle. */
enum { MOST_STEPS = 8 };

double *dalcs_smooth_step_value(const struct dalcs_radau_part *part, int source, int node) {
    return part->excitation.smooth + source * (part->stages.method->s + 2) + node;
}

int dalcs_smooth_step_place(const struct dalcs_radau_part *part, int source, int node) {
    const double *value = dalcs_smooth_step_value(part, source, node);
    return part->component->system->n_x + 1 + part->excitation.first_smooth +
           (int)(value - part->excitation.smooth);
}

static double *missed_of(const struct dalcs_radau_part *part, int source) {
    return dalcs_smooth_step_value(part, source, part->stages.method->s + 1);
}

enum dalcs_status dalcs_smooth_missed_setup(struct dalcs_radau_part *part) {
    struct dalcs_smooth_missed *p = &part->smooth->missed;
    const size_t n = (size_t)part->component->system->n_smooth;
    p->mode = dalcs_arena_alloc(&part->arena, (size_t)part->stages.n_words, sizeof(*p->mode));
    p->slope = dalcs_arena_alloc(&part->arena, 2 * n * n, sizeof(double));
    p->matrix = dalcs_arena_alloc(&part->arena, n * n, sizeof(double));
    p->change = dalcs_arena_alloc(&part->arena, n, sizeof(double));
    p->pivot = dalcs_arena_alloc(&part->arena, n, sizeof(int));
    return p->mode != NULL && p->slope != NULL && p->matrix != NULL && p->change != NULL &&
                   p->pivot != NULL
               ? DALCS_OK
               : DALCS_E_NOMEM;
}

void dalcs_smooth_missed_forget(struct dalcs_radau_part *part) {
    for (int k = 0; k < part->component->system->n_smooth; k++) {
        *missed_of(part, k) = 0.0;
    }
}

static enum dalcs_status apply(struct dalcs_radau_part *part, struct dalcs_stage_entry **entry) {
    dalcs_segment_inputs(part);
    return dalcs_stages_step(&part->stages, part->component->osnsp.mode, part->segment.h,
                             part->segment.in, part->segment.out, entry);
}

/* A source between two nodes: what it reads there, its polynomial, what its argument is made of, by how much it is not the
 * polynomial, and what of that may be rounding: of the function there, and of its values at the nodes by their weights. */
struct between {
    double x[2], phi, terms, off, rounding;
};

static struct between look_between(const struct dalcs_radau_part *part, int k) {
    const struct dalcs_smooth_newton *n = &part->smooth->newton;
    const struct dalcs_collocation *m = part->stages.method;
    const int n_smooth = n->system->n_smooth;
    const struct dalcs_smooth_input *of = &n->system->smooth[k];
    const double *ripple = part->segment.out + part->stages.layout.ripple;
    const bool is_root = dalcs_smooth_root_exponent(of) > 0.0;
    double weights = 1.0;
    struct between b = {.x = {of->number[0], of->number[1]}};
    for (int node = 0; node <= m->s; node++) {
        const int q = node * n_smooth + k;
        const double terms = is_root ? dalcs_smooth_newton_terms(n, q, 0) : n->terms[q][0];
        b.terms = dalcs_larger(b.terms, terms);
        for (int j = 0; j < of->n; j++) {
            b.x[j] += of->column[j] >= 0 ? m->worst.value[node] * n->x[q][j] : 0.0;
        }
        b.phi += m->worst.value[node] * n->phi[q];
        weights += fabs(m->worst.value[node]);
    }
    for (int j = 0; j < of->n; j++) {
        b.x[j] += of->column[j] >= 0 ? ripple[of->column[j]] : 0.0;
    }
    b.x[0] = dalcs_smooth_held(of->kind, b.x, dalcs_alike * b.terms);
    const double rest = dalcs_smooth_rest(of, b.x);
    const double value =
        rest + dalcs_smooth_line(of, 0) * b.x[0] + dalcs_smooth_line(of, 1) * b.x[1];
    b.off = rest - b.phi;
    b.rounding = weights * dalcs_smooth_rounding(of, value, b.x);
    return b;
}

/* All that is missed, by more than rounding. What sources read has ripples, too, from others. *changes: it is not what it
 * was the last time, *by: by how much of a value. */
static bool find_missed(struct dalcs_radau_part *part, bool *changes, double *by) {
    const struct dalcs_system *s = part->component->system;
    bool is_finite = true;
    *changes = false;
    *by = 0.0;
    for (int k = 0; k < s->n_smooth; k++) {
        const struct dalcs_smooth_input *of = &s->smooth[k];
        const struct between b = look_between(part, k);
        double rest = fabs(b.off) - b.rounding;
        if (rest > 0.0 && dalcs_smooth_root_exponent(of) > 0.0) {
            const double by_terms =
                dalcs_smooth_variation(of->kind, b.x, 0, dalcs_rounded * b.terms);
            rest = dalcs_smaller(rest, fabs(b.off) - by_terms);
        }
        const double missed = isfinite(b.off) ? copysign(dalcs_larger(rest, 0.0), b.off) : b.off;
        double *known = missed_of(part, k);
        is_finite = is_finite && isfinite(missed);
        *changes = *changes || fabs(missed - *known) > dalcs_rounded * fabs(b.phi);
        *by = dalcs_larger(*by, b.phi != 0.0 ? fabs((missed - *known) / b.phi) : 0.0);
        *known = missed;
    }
    return is_finite;
}

/* Once for each source that may stand between the first and the last. *settles: the last round changed no value by more of
 * it than the first did. */
static enum dalcs_status pass_on(struct dalcs_radau_part *part, int most_rounds,
                                 struct dalcs_stage_entry **entry, bool *settles) {
    bool changes = true;
    double first = 0.0;
    double by = 0.0;
    for (int round = 0; round < most_rounds && changes; round++) {
        if (!find_missed(part, &changes, &by)) {
            return DALCS_NOT_CONVERGED;
        }
        first = round == 0 ? by : first;
        const enum dalcs_status status = changes ? apply(part, entry) : DALCS_OK;
        if (status != DALCS_OK) {
            return status;
        }
    }
    *settles = !changes || by <= first;
    return DALCS_OK;
}

/* What a change of each makes of the arguments there, by differences: the step is affine in them. */
static enum dalcs_status find_slope(struct dalcs_radau_part *part,
                                    struct dalcs_stage_entry *entry) {
    struct dalcs_smooth_step *p = part->smooth;
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_osnsp *osnsp = &part->component->osnsp;
    const int ripple = part->stages.layout.ripple;
    if (p->missed.h == part->segment.h &&
        dalcs_mode_is(p->missed.mode, osnsp->mode, osnsp->n_words)) {
        return DALCS_OK;
    }
    memcpy(p->in, part->segment.in, (size_t)part->stages.n_in * sizeof(double));
    for (int k = 0; k < s->n_smooth; k++) {
        double *in = p->in + dalcs_smooth_step_place(part, k, part->stages.method->s + 1);
        const double before = *in;
        const double change = 1.0 + fabs(before);
        *in += change;
        DALCS_TRY(dalcs_stages_apply(&part->stages, entry, p->in, p->out));
        *in = before;
        for (int q = 0; q < 2 * s->n_smooth; q++) {
            const struct dalcs_smooth_input *of = &s->smooth[q / 2];
            const int column = q % 2 < of->n ? of->column[q % 2] : -1;
            p->missed.slope[q * s->n_smooth + k] =
                column >= 0
                    ? (p->out[ripple + column] - part->segment.out[ripple + column]) / change
                    : 0.0;
        }
    }
    p->missed.h = part->segment.h;
    memcpy(p->missed.mode, osnsp->mode, (size_t)osnsp->n_words * sizeof(*p->missed.mode));
    return DALCS_OK;
}

/* One step of Newton's method. *changes: by more than rounding. false: there is none. */
static bool step(struct dalcs_radau_part *part, bool *changes) {
    struct dalcs_smooth_missed *p = &part->smooth->missed;
    const struct dalcs_system *s = part->component->system;
    const int n = s->n_smooth;
    for (int k = 0; k < n; k++) {
        const struct dalcs_smooth_input *of = &s->smooth[k];
        const struct between b = look_between(part, k);
        double gradient[2];
        dalcs_smooth_gradient_of_rest(of, 1.0, b.x, gradient);
        for (int i = 0; i < n; i++) {
            p->matrix[k * n + i] = i == k ? 1.0 : 0.0;
            for (int j = 0; j < of->n; j++) { /* by a number there may be no slope */
                p->matrix[k * n + i] -=
                    of->column[j] >= 0 ? gradient[j] * p->slope[(2 * k + j) * n + i] : 0.0;
            }
        }
        p->change[k] = b.off - *missed_of(part, k);
    }
    bool is_solved =
        LAPACKE_dgetrf(LAPACK_COL_MAJOR, n, n, p->matrix, n, p->pivot) == 0 &&
        LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'T', n, 1, p->matrix, n, p->pivot, p->change, n) == 0;
    *changes = false;
    for (int k = 0; k < n && is_solved; k++) {
        double *known = missed_of(part, k);
        *changes =
            *changes || fabs(p->change[k]) > dalcs_rounded * fabs(part->smooth->newton.phi[k]);
        *known += p->change[k];
        is_solved = isfinite(*known);
    }
    return is_solved;
}

static enum dalcs_status solve_ring(struct dalcs_radau_part *part,
                                    struct dalcs_stage_entry **entry) {
    bool changes = true;
    dalcs_smooth_missed_forget(part);
    enum dalcs_status status = apply(part, entry);
    if (status == DALCS_OK) {
        status = find_slope(part, *entry);
    }
    for (int k = 0; k < MOST_STEPS && status == DALCS_OK && changes; k++) {
        status = step(part, &changes) ? apply(part, entry) : DALCS_NOT_CONVERGED;
    }
    return status;
}

/* Does rounding of a line far steeper than its function leave digits of all values that are seen? Where it does not, no length
 * of a step is right, and what has grown says so. */
static bool has_digits(const struct dalcs_radau_part *part) {
    const struct dalcs_smooth_newton *n = &part->smooth->newton;
    const struct dalcs_osnsp *osnsp = &part->component->osnsp;
    bool has = true;
    for (int q = 0; q < n->n && has; q++) {
        const int unit = n->system->row_is_current[dalcs_smooth_newton_input(n, q)->row];
        const double largest = osnsp->smooth.largest[unit];
        has = !(dalcs_smooth_newton_excused(n, q) > dalcs_nothing * largest);
    }
    return has;
}

enum dalcs_status dalcs_smooth_missed_add(struct dalcs_radau_part *part,
                                          struct dalcs_stage_entry **entry) {
    bool settles = true;
    enum dalcs_status status = pass_on(part, part->component->system->n_smooth, entry, &settles);
    if (settles || !has_digits(part)) {
        return status;
    }
    status = solve_ring(part, entry);
    return status == DALCS_OK ? pass_on(part, 1, entry, &settles) : status;
}
