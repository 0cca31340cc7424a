/* sides.c - a sum of parts of one quantity, as the sum of its sides. */
#include "sides.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Of one sum; another one stays as it is. */
enum { MOST_KINKS = 16 };

/* One side, of what is written for the quantity there. */
struct side {
    const struct dalcs_kinks *kinks;
    struct dalcs_rewriting *r;
    double at;
    const struct dalcs_formula *clipped;
};

static const struct dalcs_formula *write_side(const struct side *side,
                                              const struct dalcs_formula *f);

static const struct dalcs_formula *write_arguments(const struct side *side,
                                                   const struct dalcs_formula *f) {
    const struct dalcs_formula **argument =
        dalcs_alloc((size_t)f->n + 1, sizeof(const struct dalcs_formula *));
    side->r->failed = side->r->failed || argument == NULL;
    for (int k = 0; k < f->n && !side->r->failed; k++) {
        argument[k] = write_side(side, f->argument[k]);
        side->r->failed = side->r->failed || argument[k] == NULL;
    }
    const struct dalcs_formula *made = NULL;
    if (!side->r->failed) {
        const bool combines = dalcs_formula_is_operation(f, DALCS_ADD) ||
                              dalcs_formula_is_operation(f, DALCS_MULTIPLY);
        made = combines ? dalcs_rewriting_combine(side->r, f, f->code, argument[0], argument[1])
                        : dalcs_rewriting_like(side->r, f, f->n, argument);
    }
    free(argument);
    return made;
}

/* A part as it is on one side; what is a number there is one. */
static const struct dalcs_formula *write_side(const struct side *side,
                                              const struct dalcs_formula *f) {
    const struct dalcs_kinks *kinks = side->kinks;
    const struct dalcs_kinks_part *part = &kinks->part[f->number_of];
    if (part->state == DALCS_KINKS_NUMBER || dalcs_formula_is_same(f, kinks->quantity)) {
        return part->state == DALCS_KINKS_NUMBER ? f : side->clipped;
    }
    const double here = dalcs_kinks_evaluate(kinks, f, side->at, side->at).value;
    if (part->is_stepped) {
        return dalcs_rewriting_number(side->r, f, here);
    }
    if (f->kind == DALCS_FORMULA_CHOICE) {
        const struct dalcs_formula *condition = f->argument[0];
        const bool is = dalcs_kinks_evaluate(kinks, condition, side->at, side->at).value != 0;
        return write_side(side, f->argument[is ? 1 : 2]);
    }
    if (!dalcs_kinks_is_call(f)) {
        return write_arguments(side, f);
    }
    if (dalcs_formula_is_call(f, "abs") || dalcs_formula_is_call(f, "uramp")) {
        const struct dalcs_formula *a = f->argument[0];
        const double sign = dalcs_kinks_evaluate(kinks, a, side->at, side->at).value;
        const double below = dalcs_formula_is_call(f, "abs") ? -1 : 0;
        return dalcs_rewriting_times(side->r, write_side(side, a), sign > 0 ? 1 : below);
    }
    return write_side(side, f->argument[dalcs_kinks_chosen(kinks, f, side->at)]);
}

/* ---- A sum of sides ------------------------------------------------------------------------------ */

struct sides {
    int n_kinks;
    double kink[MOST_KINKS + 2];     /* from -infinity to infinity */
    double jump[MOST_KINKS + 2];     /* there, from the side below to the side above */
    bool is_above[MOST_KINKS + 2];   /* the value at the kink itself is that of the side above */
    bool is_between[MOST_KINKS + 2]; /* it is neither that nor that of the side below */
    bool has_jump;
};

static bool find_kink(const struct dalcs_kinks *kinks, const struct dalcs_sides_terms *t,
                      double low, double high, double *at) {
    bool has = false;
    for (int k = 0; k < t->n && !has; k++) {
        has = t->has_kink[k] && dalcs_kinks_find(kinks, t->part[k], low, high, at);
    }
    return has;
}

/* false: there are too many. */
static bool find_kinks(const struct dalcs_kinks *kinks, const struct dalcs_sides_terms *t,
                       struct sides *sides) {
    *sides = (struct sides){.kink = {-(double)INFINITY, (double)INFINITY}};
    for (int k = 0; k <= sides->n_kinks;) {
        double at;
        if (!find_kink(kinks, t, sides->kink[k], sides->kink[k + 1], &at)) {
            k++;
        } else if (sides->n_kinks == MOST_KINKS) {
            return false;
        } else {
            for (int j = ++sides->n_kinks + 1; j > k + 1; j--) {
                sides->kink[j] = sides->kink[j - 1];
            }
            sides->kink[k + 1] = at;
        }
    }
    return true;
}

static double side_of(const struct sides *sides, int k) {
    return dalcs_kinks_between(sides->kink[k], sides->kink[k + 1]);
}

static struct dalcs_kinks_value evaluate(const struct dalcs_kinks *kinks,
                                         const struct dalcs_sides_terms *t, double side,
                                         double at) {
    struct dalcs_kinks_value sum = {0, 0};
    for (int k = 0; k < t->n; k++) {
        if (t->has_kink[k]) {
            const struct dalcs_kinks_value of = dalcs_kinks_evaluate(kinks, t->part[k], side, at);
            sum.value += t->factor[k] * of.value;
            sum.rounding += fabs(t->factor[k]) * (of.rounding + DBL_EPSILON * fabs(of.value));
        }
    }
    return sum;
}

/* How far each side begins above the end of the one before it: 0 where that is rounding. false: a side has no value there. */
static bool find_jumps(const struct dalcs_kinks *kinks, const struct dalcs_sides_terms *t,
                       struct sides *sides) {
    bool are_finite = sides->n_kinks > 0;
    for (int k = 1; k <= sides->n_kinks && are_finite; k++) {
        const double at = sides->kink[k];
        const struct dalcs_kinks_value a = evaluate(kinks, t, side_of(sides, k - 1), at);
        const struct dalcs_kinks_value b = evaluate(kinks, t, side_of(sides, k), at);
        const double here = evaluate(kinks, t, at, at).value;
        const double jump = b.value - a.value;
        sides->jump[k] = fabs(jump) <= a.rounding + b.rounding ? 0 : jump;
        sides->is_above[k] = fabs(here - b.value) <= b.rounding;
        sides->is_between[k] = !sides->is_above[k] && !(fabs(here - a.value) <= a.rounding);
        sides->has_jump = sides->has_jump || sides->jump[k] != 0;
        are_finite = isfinite(jump);
    }
    return are_finite;
}

/* max(min(x, high), low), without what is not finite. */
static const struct dalcs_formula *clip(struct dalcs_rewriting *r, const struct dalcs_formula *x,
                                        double low, double high) {
    const struct dalcs_formula *made = x;
    if (isfinite(high)) {
        made = dalcs_rewriting_call(r, x, "min", made, dalcs_rewriting_number(r, x, high));
    }
    if (isfinite(low) && made != NULL) {
        made = dalcs_rewriting_call(r, x, "max", made, dalcs_rewriting_number(r, x, low));
    }
    return made;
}

/* The sum where the quantity is on one side; NULL: out of memory. */
static const struct dalcs_formula *write_terms(const struct side *side,
                                               const struct dalcs_sides_terms *t,
                                               const struct dalcs_formula *at) {
    const struct dalcs_formula *sum = dalcs_rewriting_number(side->r, at, 0);
    for (int k = 0; k < t->n && sum != NULL; k++) {
        if (t->has_kink[k]) {
            sum = dalcs_rewriting_combine(
                side->r, at, DALCS_ADD, sum,
                dalcs_rewriting_times(side->r, write_side(side, t->part[k]), t->factor[k]));
        }
    }
    return sum;
}

static const struct dalcs_formula *write_step(struct dalcs_rewriting *r, const char *function,
                                              const struct dalcs_formula *beyond) {
    struct dalcs_formula *step =
        beyond != NULL ? dalcs_rewriting_like(r, beyond, 1, &beyond) : NULL;
    if (step != NULL) {
        step->kind = DALCS_FORMULA_CALL;
        step->function = function;
    }
    return step;
}

/* The jump at a kink, on its lower side before, on its upper side behind; at the kink where the formula says. */
static const struct dalcs_formula *write_jump(const struct dalcs_kinks *kinks,
                                              struct dalcs_rewriting *r, const struct sides *sides,
                                              int k, const struct dalcs_formula *where) {
    const double jump = sides->jump[k];
    if (jump == 0) {
        return dalcs_rewriting_number(r, where, 0);
    }
    const struct dalcs_formula *beyond = dalcs_rewriting_combine(
        r, where, DALCS_ADD, kinks->quantity, dalcs_rewriting_number(r, where, -sides->kink[k]));
    if (sides->is_between[k]) {
        return dalcs_rewriting_combine(
            r, where, DALCS_ADD, dalcs_rewriting_number(r, where, 0.5 * jump),
            dalcs_rewriting_times(r, write_step(r, "sgn", beyond), 0.5 * jump));
    }
    const char *step = sides->is_above[k] ? "ge0" : "u";
    return dalcs_rewriting_times(r, write_step(r, step, beyond), jump);
}

static const struct dalcs_formula *write_sides(const struct dalcs_kinks *kinks,
                                               struct dalcs_rewriting *r,
                                               const struct dalcs_sides_terms *t,
                                               const struct sides *sides,
                                               const struct dalcs_formula *where) {
    const struct dalcs_formula *sum = dalcs_rewriting_number(r, where, 0);
    struct dalcs_kinks_value constant = {0, 0};
    for (int k = 0; k <= sides->n_kinks && sum != NULL; k++) {
        const double low = sides->kink[k];
        struct side side = {kinks, r, side_of(sides, k), NULL};
        side.clipped = clip(r, kinks->quantity, low, sides->kink[k + 1]);
        const struct dalcs_formula *made =
            side.clipped != NULL ? write_terms(&side, t, where) : NULL;
        const bool has_begun = k > 0 && made != NULL && made->kind != DALCS_FORMULA_NUMBER;
        if (has_begun) {
            const struct dalcs_kinks_value begins = evaluate(kinks, t, side.at, low);
            constant.value -= begins.value;
            constant.rounding += begins.rounding;
        }
        sum = k > 0 && !has_begun && made != NULL
                  ? sum
                  : dalcs_rewriting_combine(r, where, DALCS_ADD, sum, made);
        sum = dalcs_rewriting_combine(r, where, DALCS_ADD, sum,
                                      write_jump(kinks, r, sides, k, where));
    }
    const bool is_rounding = fabs(constant.value) <= constant.rounding;
    return is_rounding ? sum
                       : dalcs_rewriting_combine(r, where, DALCS_ADD, sum,
                                                 dalcs_rewriting_number(r, where, constant.value));
}

const struct dalcs_formula *dalcs_sides_write(const struct dalcs_kinks *kinks,
                                              struct dalcs_rewriting *r,
                                              const struct dalcs_sides_terms *t,
                                              const struct dalcs_formula *where) {
    struct sides sides;
    bool is_curved = false;
    bool has_step = false;
    for (int k = 0; k < t->n; k++) {
        const struct dalcs_kinks_part *part = &kinks->part[t->part[k]->number_of];
        is_curved = is_curved || (t->has_kink[k] && part->is_curved);
        has_step = has_step || (t->has_kink[k] && part->has_step);
    }
    return is_curved && find_kinks(kinks, t, &sides) && find_jumps(kinks, t, &sides) &&
                   (has_step || sides.has_jump)
               ? write_sides(kinks, r, t, &sides, where)
               : where;
}
