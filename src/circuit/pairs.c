/* pairs.c - piecewise-linear functions to complementarity pairs.
 *
 *   kink          lambda = max(g a, 0)         0 <= lambda _|_ lambda / g - a >= 0
 *   saturation    lambda between 0 and H, g a between them, nu = max(a - H / g, 0)
 *                                              0 <= lambda _|_ nu + lambda / g - a >= 0
 *                                              0 <= nu     _|_ H - lambda >= 0
 *   jump          the same with 1 / g = 0: lambda is H where a > 0, 0 where a < 0 and anything
 *                 between them where a = 0; nu = max(a, 0)
 *
 * Lambda is in the units of what it adds to: so its rounding is that of the output, however steep the
 * slope, and on a rail it is exact. */
#include "behaviour.h"

#include <math.h>

/* The cell of these numbers, one that is there already if possible: its first pair. */
static int add_cell(struct dalcs_compiler *c, const struct dalcs_affine *argument,
                    double resistance, double height, double rest) {
    for (size_t k = 0; k < c->n_cells; k++) {
        const struct dalcs_cell *known = &c->cell[k];
        double factor;
        if (known->resistance == resistance && known->height == height && known->rest == rest &&
            known->argument.constant == argument->constant &&
            dalcs_affine_is_along(argument, &known->argument, &factor) && factor != 0 &&
            argument->term[0].coefficient == known->argument.term[0].coefficient) {
            return known->pair;
        }
    }
    if (c->failed ||
        dalcs_grow(&c->cell, &c->cell_capacity, c->n_cells + 1, sizeof *c->cell) != DALCS_OK) {
        c->builder->out_of_memory = c->builder->out_of_memory || !c->failed;
        c->failed = true;
        return 0;
    }
    const int pair = c->n_pairs;
    c->cell[c->n_cells++] = (struct dalcs_cell){*argument, resistance, height, rest, pair};
    c->n_pairs += isinf(height) ? 1 : 2;
    return pair;
}

static void add_pair(struct dalcs_compiler *c, struct dalcs_affine *sum, double factor, int pair) {
    const struct dalcs_affine lambda = dalcs_affine_of(c, DALCS_QUANTITY_PAIR, pair);
    *sum = dalcs_affine_add(c, sum, factor, &lambda);
}

/* One half of a function: what it adds to the line of its base piece, from there outwards. */
struct half {
    const struct dalcs_piecewise *f;
    const struct dalcs_affine *direction;
    int base; /* piece: before knot `base` */
    int sign; /* 1: to the right, -1: to the left */
};

/* The piece beyond the kth knot outwards, and what it is called in f. */
static const struct dalcs_knot *knot_of(const struct half *h, int k) {
    const int i = h->sign > 0 ? h->base + k : h->base - 1 - k;
    return i >= 0 && i < h->f->n ? &h->f->knot[i] : NULL;
}

/* The slope outwards of the kth piece, 0 the base. */
static double slope_of(const struct half *h, int k) {
    return h->sign * dalcs_piecewise_slope(h->f, h->base + h->sign * k);
}

static double near_value(const struct half *h, const struct dalcs_knot *knot) {
    return h->sign > 0 ? knot->left : knot->right;
}

static double far_value(const struct half *h, const struct dalcs_knot *knot) {
    return h->sign > 0 ? knot->right : knot->left;
}

/* Arguments are up to this part of a piece's width: a kink goes on beyond it, and what ends it must cancel that: at most
 * eps / narrow * 1 kV = 2e-10 of what the piece is high is rounding. Narrower pieces saturate, which is exact and takes
 * one pair more. */
static const double narrow = 1e-3;

/* What a piece adds to the line of slope `before`, from its first knot to the next one, where it ends. */
static void add_saturation(struct dalcs_compiler *c, const struct half *h, int k, double before,
                           const struct dalcs_affine *beyond, struct dalcs_affine *sum) {
    const double width = fabs(knot_of(h, k + 1)->at - knot_of(h, k)->at);
    const double slope = fabs(slope_of(h, k + 1) - before);
    const double height =
        near_value(h, knot_of(h, k + 1)) - far_value(h, knot_of(h, k)) - before * width;
    if (slope != 0 && height != 0) {
        add_pair(c, sum, height > 0 ? 1 : -1, add_cell(c, beyond, 1 / slope, fabs(height), 0));
    }
}

static void add_half(struct dalcs_compiler *c, const struct half *h, struct dalcs_affine *sum) {
    const struct dalcs_affine zero = dalcs_affine_constant(0);
    double before = slope_of(h, 0); /* of the line that the pieces are added to */
    for (int k = 0; knot_of(h, k) != NULL && !c->failed; k++) {
        const struct dalcs_knot *knot = knot_of(h, k);
        const struct dalcs_knot *next = knot_of(h, k + 1);
        struct dalcs_affine beyond = dalcs_affine_add(c, &zero, h->sign, h->direction);
        beyond.constant = -h->sign * knot->at;
        const bool returns = next != NULL && slope_of(h, k + 2) == before;
        const bool saturates = returns || (next != NULL && fabs(next->at - knot->at) < narrow);
        const double bend = saturates ? 0 : slope_of(h, k + 1) - before;
        const double jump = far_value(h, knot) - near_value(h, knot);
        if (jump != 0) {
            const double rest = (knot->value - near_value(h, knot)) / jump;
            const int pair = add_cell(c, &beyond, 0, fabs(jump), rest);
            add_pair(c, sum, jump > 0 ? 1 : -1, pair);
            if (bend != 0) {
                add_pair(c, sum, bend, pair + 1);
            }
        } else if (bend != 0) {
            add_pair(c, sum, bend > 0 ? 1 : -1, add_cell(c, &beyond, 1 / fabs(bend), INFINITY, 0));
        }
        if (saturates) {
            add_saturation(c, h, k, before, &beyond, sum);
        }
        before += bend;
    }
}

/* Arguments are between a millionth of this and a million times it, in volts or amperes. The base leaves the rounding of its
 * value to the other pieces. A flat one that begins nearer than this gives them at most 1e6 eps = 2e-10 of what they are
 * worth. Without one, the piece around 0 reaches at least as far, and slope times argument is rounded to at most 1e6 eps
 * of what the flat pieces are worth. */
static const double near_zero = 1.0;

static double value_of(const struct dalcs_piecewise *f, int piece) {
    const struct dalcs_knot *knot = &f->knot[piece < f->n ? piece : f->n - 1];
    return piece < f->n ? knot->left : knot->right;
}

static double distance_of(const struct dalcs_piecewise *f, int piece) {
    const double below = piece < f->n ? -f->knot[piece].at : -INFINITY;
    const double above = piece > 0 ? f->knot[piece - 1].at : -INFINITY;
    return fmax(fmax(below, above), 0);
}

/* The piece that the others are added to: a flat one near 0, on which the value is then exact, and of these the one
 * of the least value; or else the one around 0. */
static int base_of(const struct dalcs_piecewise *f) {
    int base = -1;
    for (int k = 0; k <= f->n; k++) {
        const bool may_be = dalcs_piecewise_slope(f, k) == 0 && distance_of(f, k) < near_zero;
        if (may_be && (base < 0 || fabs(value_of(f, k)) < fabs(value_of(f, base)))) {
            base = k;
        }
    }
    if (base >= 0) {
        return base;
    }
    for (base = 0; base < f->n && f->knot[base].at <= 0;) {
        base++;
    }
    if (isinf(dalcs_piecewise_slope(f, base))) { /* a vertical end */
        base = base == 0 ? 1 : base - 1;
    }
    return base;
}

static void freeze_part(struct dalcs_compiler *c, const struct dalcs_form_part *part,
                        struct dalcs_affine *sum) {
    const struct dalcs_piecewise *f = &part->f;
    if (dalcs_affine_is_time(&part->direction)) {
        const struct dalcs_affine s =
            dalcs_affine_of(c, DALCS_QUANTITY_STIMULUS, dalcs_time_stimulus(c, f));
        *sum = dalcs_affine_add(c, sum, 1, &s);
        return;
    }
    struct dalcs_affine decided;
    if (c->potentials != NULL && dalcs_decided(c, &part->direction, f, &decided)) {
        *sum = dalcs_affine_add(c, sum, 1, &decided);
        return;
    }
    const int base = base_of(f);
    sum->constant += dalcs_piecewise_on_line(f, base, 0);
    *sum = dalcs_affine_add(c, sum, dalcs_piecewise_slope(f, base), &part->direction);
    const struct half right = {f, &part->direction, base, 1};
    const struct half left = {f, &part->direction, base, -1};
    add_half(c, &right, sum);
    add_half(c, &left, sum);
}

struct dalcs_affine dalcs_behaviour_freeze(struct dalcs_compiler *c, const struct dalcs_form *v) {
    struct dalcs_affine sum = v->affine;
    for (int k = 0; k < v->n && !c->failed; k++) {
        freeze_part(c, &v->part[k], &sum);
    }
    return sum;
}

/* ---- What the circuit keeps -------------------------------------------------------------------- */

/* Time and waves become stimuli; the terms move into the circuit's arena. */
static struct dalcs_affine keep(struct dalcs_compiler *c, const struct dalcs_affine *a) {
    struct dalcs_affine kept = dalcs_affine_constant(a->constant);
    for (int k = 0; k < a->n && !c->failed; k++) {
        struct dalcs_affine_term term = a->term[k];
        if (term.kind == DALCS_QUANTITY_TIME) {
            struct dalcs_piecewise line;
            if (!dalcs_piecewise_line(c->arena, 0, 1, &line)) {
                c->builder->out_of_memory = true;
                c->failed = true;
                break;
            }
            term.index = dalcs_time_stimulus(c, &line);
        } else if (term.kind == DALCS_QUANTITY_WAVE) {
            term.index = dalcs_wave_stimulus(c, term.index);
        }
        if (term.kind == DALCS_QUANTITY_TIME || term.kind == DALCS_QUANTITY_WAVE) {
            term.kind = DALCS_QUANTITY_STIMULUS;
        }
        const struct dalcs_affine one = {.n = 1, .term = &term};
        kept = dalcs_affine_add(c, &kept, 1, &one);
    }
    struct dalcs_affine_term *term =
        dalcs_arena_alloc(&c->builder->circuit->arena, (size_t)kept.n, sizeof *term);
    if (term == NULL) {
        c->builder->out_of_memory = true;
        c->failed = true;
        return dalcs_affine_constant(0);
    }
    for (int k = 0; k < kept.n; k++) {
        term[k] = kept.term[k];
    }
    kept.term = term;
    return kept;
}

static void keep_cell(struct dalcs_compiler *c, const struct dalcs_cell *cell,
                      struct dalcs_affine *w, double *rest) {
    const bool is_jump = cell->resistance == 0 && !isinf(cell->height); /* else one pair alone */
    rest[cell->pair] = is_jump ? cell->rest : NAN;
    const struct dalcs_affine zero = dalcs_affine_constant(0);
    struct dalcs_affine excess = dalcs_affine_add(c, &zero, -1, &cell->argument);
    add_pair(c, &excess, cell->resistance, cell->pair);
    if (!isinf(cell->height)) {
        struct dalcs_affine room = dalcs_affine_constant(cell->height);
        add_pair(c, &room, -1, cell->pair);
        add_pair(c, &excess, 1, cell->pair + 1);
        w[cell->pair + 1] = keep(c, &room);
        rest[cell->pair + 1] = NAN;
    }
    w[cell->pair] = keep(c, &excess);
}

struct dalcs_behaviour *dalcs_behaviour_make(struct dalcs_compiler *c,
                                             const struct dalcs_form *output) {
    struct dalcs_arena *arena = &c->builder->circuit->arena;
    struct dalcs_affine frozen = dalcs_behaviour_freeze(c, output);
    struct dalcs_affine decided;
    if (c->potentials != NULL && dalcs_decided(c, &frozen, NULL, &decided)) {
        frozen = decided;
    }
    struct dalcs_behaviour *behaviour = dalcs_arena_alloc(arena, 1, sizeof *behaviour);
    struct dalcs_affine *w = dalcs_arena_alloc(arena, (size_t)c->n_pairs, sizeof *w);
    double *rest = dalcs_arena_alloc(arena, (size_t)c->n_pairs, sizeof *rest);
    if (behaviour == NULL || w == NULL || rest == NULL) {
        c->builder->out_of_memory = true;
        return NULL;
    }
    *behaviour = (struct dalcs_behaviour){
        .output = keep(c, &frozen), .n_pairs = c->n_pairs, .w = w, .rest = rest};
    for (size_t k = 0; k < c->n_cells && !c->failed; k++) {
        keep_cell(c, &c->cell[k], w, rest);
    }
    return c->failed ? NULL : behaviour;
}
