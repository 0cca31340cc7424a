/* formula_scale.c - kinks of formulas, and the equations that their outputs go to. */
#include "formula_scale.h"

#include "doubt.h"
#include "extremes.h"
#include "guard_scale.h"
#include "smooth_step.h"
#include "step_error.h"

#include <math.h>

/* Formulas inside formulas; what is deeper has its unit's scale. */
enum { DEEPEST = 6 };

/* Is it a comparison, or the second pair of one? Its argument is not its output. */
static bool compares(const struct dalcs_system *s, int pair) {
    return s->pair[pair].is_jump || (pair > 0 && s->pair[pair - 1].is_jump);
}

/* Adds the places in one matrix to places->p[d + 1], or puts them where places->p[d] says. */
static void note_places(const struct dalcs_system *s, const struct dalcs_csr *m, int first,
                        struct dalcs_formula_places *places) {
    const int n_equations = dalcs_system_n_equations(s);
    for (int r = 0; r < m->n_rows; r++) {
        for (int k = m->p[r]; k < m->p[r + 1]; k++) {
            const int d = m->j[k] - n_equations;
            if (d < 0 || !s->pair[d].is_formula || first + r == n_equations + d) {
                continue;
            }
            if (places->place == NULL) {
                places->p[d + 1]++;
            } else {
                places->place[places->p[d]++] =
                    (struct dalcs_formula_place){first + r, fabs(m->x[k])};
            }
        }
    }
}

enum dalcs_status dalcs_formula_scale_setup(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    const int n_equations = dalcs_system_n_equations(s);
    bool any = false;
    for (int d = 0; d < s->n_pairs; d++) {
        any = any || s->pair[d].is_formula;
    }
    if (!any) {
        return DALCS_OK;
    }
    struct dalcs_formula_places *places = dalcs_arena_alloc(&part->arena, 1, sizeof(*places));
    int *p = dalcs_arena_alloc(&part->arena, (size_t)s->n_pairs + 1, sizeof(int));
    if (places == NULL || p == NULL) {
        return DALCS_E_NOMEM;
    }
    *places = (struct dalcs_formula_places){.p = p};
    note_places(s, &s->A, 0, places);
    note_places(s, &s->C, n_equations, places);
    for (int d = 0; d < s->n_pairs; d++) {
        p[d + 1] += p[d];
    }
    places->place =
        dalcs_arena_alloc(&part->arena, (size_t)p[s->n_pairs] + 1, sizeof(*places->place));
    if (places->place == NULL) {
        return DALCS_E_NOMEM;
    }
    note_places(s, &s->A, 0, places);
    note_places(s, &s->C, n_equations, places);
    for (int d = s->n_pairs; d > 0; d--) {
        p[d] = p[d - 1];
    }
    p[0] = 0;
    part->laws.places = places;
    return DALCS_OK;
}

/* What the columns of an equation have been, without pairs; INFINITY where a function reads one: it may be steep. */
static double scale_of_equation(const struct dalcs_radau_part *part, int row) {
    const struct dalcs_system *s = part->component->system;
    double size = 0.0;
    for (int k = s->A.p[row]; k < s->A.p[row + 1]; k++) {
        const int c = s->A.j[k];
        if (c >= dalcs_system_n_equations(s)) {
            continue;
        }
        if (s->is_part != NULL && s->is_part[c]) {
            return INFINITY;
        }
        size += fabs(s->A.x[k]) * dalcs_larger(part->scales.column[c], part->scales.magnitude[c]);
    }
    return size;
}

static double scale_of_argument(const struct dalcs_radau_part *part, int pair, int depth);

/* Of a lambda: by all that it goes to; INFINITY: nothing tells. */
static double scale_of_output(const struct dalcs_radau_part *part, int pair, int depth) {
    const struct dalcs_formula_places *places = part->laws.places;
    const int n_equations = dalcs_system_n_equations(part->component->system);
    double least = INFINITY;
    for (int k = places->p[pair]; k < places->p[pair + 1] && depth < DEEPEST; k++) {
        const struct dalcs_formula_place *place = &places->place[k];
        const double scale = place->row < n_equations
                                 ? scale_of_equation(part, place->row)
                                 : scale_of_argument(part, place->row - n_equations, depth + 1);
        least = dalcs_smaller(least, scale / place->factor);
    }
    return least;
}

/* Of a w: what it is off by is an error of its lambda, over the slope, or, of a bound, of the lambda that it bounds. */
static double scale_of_argument(const struct dalcs_radau_part *part, int pair, int depth) {
    const struct dalcs_system *s = part->component->system;
    const double slope = dalcs_pair_slope(s, pair);
    if (slope > 0.0) {
        return slope * scale_of_output(part, pair, depth + 1);
    }
    double least = INFINITY;
    for (int k = s->C.p[pair]; k < s->C.p[pair + 1] && depth < DEEPEST; k++) {
        const int e = s->C.j[k] - dalcs_system_n_equations(s);
        if (e >= 0 && s->pair[e].is_formula) {
            least = dalcs_smaller(least, fabs(s->C.x[k]) * scale_of_output(part, e, depth + 1));
        }
    }
    return least;
}

double dalcs_formula_argument_noise(const struct dalcs_radau_part *part, int pair,
                                    const double *unit) {
    const struct dalcs_system *s = part->component->system;
    double size = 0.0;
    for (int k = s->C.p[pair]; k < s->C.p[pair + 1]; k++) {
        const int c = s->C.j[k];
        if (c < dalcs_system_n_equations(s)) {
            size += fabs(s->C.x[k]) * dalcs_step_scale(part, c, unit);
        }
    }
    return dalcs_larger(dalcs_doubt_noise(part), dalcs_beyond * dalcs_sum_rounded) * size;
}

/* What lambda or w of a pair is known to: by its argument, and by those of the kinks that it reads or bounds. */
static double noise_of(const struct dalcs_radau_part *part, int pair, bool is_on,
                       const double *unit) {
    const struct dalcs_system *s = part->component->system;
    const double slope = dalcs_pair_slope(s, pair);
    double noise = dalcs_formula_argument_noise(part, pair, unit);
    for (int k = s->C.p[pair]; k < s->C.p[pair + 1]; k++) {
        const int e = s->C.j[k] - dalcs_system_n_equations(s);
        if (e < 0 || e == pair || !s->pair[e].is_formula) {
            continue;
        }
        const double of_argument = dalcs_formula_argument_noise(part, e, unit);
        const double of_slope = dalcs_pair_slope(s, e);
        const bool is_argument = is_on && slope == 0.0;
        if (is_argument) {
            noise += of_argument / fabs(s->C.x[k]);
        } else if (of_slope > 0.0) {
            noise += fabs(s->C.x[k]) * of_argument / of_slope;
        }
    }
    return is_on && slope > 0.0 ? noise / slope : noise;
}

/* Of w of a pair, by what its argument is made of: numbers, columns, and lambdas that are bounded. INFINITY: other kinks.
 * Of a comparison it is w of the first pair or lambda of the second, and of no unit of theirs. */
static double scale_of_terms(const struct dalcs_radau_part *part, int pair, int depth,
                             const double *unit) {
    const struct dalcs_system *s = part->component->system;
    const int own = s->pair[pair].is_jump ? pair + 1 : pair;
    double size = 0.0;
    for (int k = s->F.p[pair]; k < s->F.p[pair + 1]; k++) {
        size += fabs(s->F.x[k] * part->excitation.constant[s->F.j[k]]);
    }
    for (int k = s->C.p[pair]; k < s->C.p[pair + 1]; k++) {
        const int c = s->C.j[k];
        const int e = c - dalcs_system_n_equations(s);
        if (e < 0) {
            size += fabs(s->C.x[k]) * dalcs_step_scale(part, c, unit);
        } else if (e != pair && e != own) {
            const bool is_kink = s->pair[e].is_formula && !compares(s, e) && depth < DEEPEST;
            const double slope = dalcs_pair_slope(s, e);
            size += is_kink && slope > 0.0 && !compares(s, pair)
                        ? fabs(s->C.x[k]) / slope * scale_of_terms(part, e, depth + 1, unit)
                        : INFINITY;
        }
    }
    return size > 0.0 ? size : INFINITY;
}

/* Of a kink whose output a function reads, which may be steep: where no function moves the argument, what it is made of is known
 * by itself. Elsewhere the rounding of functions is in it, too, and the unit's scale holds. */
static double scale_of_own(const struct dalcs_radau_part *part, int pair, bool is_on,
                           const double *unit) {
    const double own = is_on ? scale_of_output(part, pair, 0) : scale_of_argument(part, pair, 0);
    if (isfinite(own) || dalcs_smooth_step_moves(part, pair)) {
        return own;
    }
    const double slope = dalcs_pair_slope(part->component->system, pair);
    const double terms = scale_of_terms(part, pair, 0, unit);
    return is_on && slope > 0.0 ? terms / slope : terms;
}

double dalcs_formula_scale(const struct dalcs_radau_part *part, int pair, double scale,
                           const double *unit) {
    const struct dalcs_system *s = part->component->system;
    if (part->laws.places == NULL || !s->pair[pair].is_formula) {
        return scale;
    }
    if (compares(s, pair)) {
        const int first = s->pair[pair].is_jump ? pair : pair - 1;
        const double known =
            dalcs_formula_argument_noise(part, first, unit) / part->inner_tolerance;
        return dalcs_smaller(scale, dalcs_larger(scale_of_terms(part, first, 0, unit), known));
    }
    const bool is_on = dalcs_osnsp_is_on(&part->component->osnsp, pair);
    const double own = scale_of_own(part, pair, is_on, unit);
    const double known = noise_of(part, pair, is_on, unit) / part->inner_tolerance;
    const double most = dalcs_guard_nothing_flows(part, unit) ? dalcs_larger(scale, known) : scale;
    return dalcs_smaller(most, dalcs_larger(own, known));
}
