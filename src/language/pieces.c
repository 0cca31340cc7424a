/* pieces.c - a sign or a step in a formula of one quantity that has smooth sides: the formula is the sum of its sides and of
 * its jumps. sgn(x) * ln(1 + abs(x)) is ln(1 + max(x, 0)) - ln(1 - min(x, 0)).
 *
 * As written what jumps multiplies what is smooth. Each step is any value between its sides where the quantity is at the
 * kink, and a product of one with a smooth function has then a value that the formula has nowhere. A sum of smooth functions
 * of max and min has one value at each place. With kinks c1 < c2 < ... and sides F0, F1, ... it is
 *
 *     F(x) = F0(min(x, c1)) + F1(max(min(x, c2), c1)) - F1(c1) + (F1(c1) - F0(c1)) u(x - c1) + ...
 *
 * The height of each jump is a number, so that it is a jump of pairs: at the kink the circuit chooses any value between both
 * sides. As a product it would be a switch, which has no position there. What has choices alone, and sides that meet, stays
 * as it is: a choice is one switch. */
#include "sides.h"

#include <math.h>
#include <stdlib.h>

/* Of one formula; of others it stays as it is. */
enum { MOST_QUANTITIES = 16 };

/* ---- Where such sums are in a formula ------------------------------------------------------------ */

struct rewriter {
    struct dalcs_kinks kinks;
    struct dalcs_rewriting *r;
    const struct dalcs_formula **memo; /* by number_of */
};

/* The terms of a sum; false: there are too many. */
static bool read_terms(struct rewriter *w, const struct dalcs_formula *f, double factor,
                       struct dalcs_sides_terms *t) {
    const struct dalcs_formula *a = f->n > 0 ? f->argument[0] : NULL;
    const struct dalcs_formula *b = f->n > 1 ? f->argument[1] : NULL;
    const bool subtracts = dalcs_formula_is_operation(f, DALCS_SUBTRACT);
    if (subtracts || dalcs_formula_is_operation(f, DALCS_ADD)) {
        return read_terms(w, a, factor, t) && read_terms(w, b, subtracts ? -factor : factor, t);
    }
    if (dalcs_formula_is_operation(f, DALCS_NEGATE)) {
        return read_terms(w, a, -factor, t);
    }
    if (dalcs_formula_is_operation(f, DALCS_MULTIPLY) &&
        (a->kind == DALCS_FORMULA_NUMBER || b->kind == DALCS_FORMULA_NUMBER)) {
        const bool is_first = a->kind == DALCS_FORMULA_NUMBER;
        return read_terms(w, is_first ? b : a, factor * (is_first ? a : b)->number, t);
    }
    if (dalcs_formula_is_operation(f, DALCS_DIVIDE) && b->kind == DALCS_FORMULA_NUMBER &&
        b->number != 0) {
        return read_terms(w, a, factor / b->number, t);
    }
    const struct dalcs_kinks_part *part = dalcs_kinks_mark(&w->kinks, f);
    if (t->n == DALCS_SIDES_MOST_TERMS || !isfinite(factor)) {
        return false;
    }
    t->part[t->n] = f;
    t->factor[t->n] = factor;
    t->has_kink[t->n++] = part->state == DALCS_KINKS_OF_ONE && part->has_kink;
    return true;
}

static const struct dalcs_formula *rebuild(struct rewriter *w, const struct dalcs_formula *f);

/* f with the terms that have kinks as a sum of sides; f itself: they are none; NULL: out of memory. */
static const struct dalcs_formula *write_sum(struct rewriter *w, const struct dalcs_formula *f) {
    struct dalcs_sides_terms t = {0};
    const struct dalcs_formula *sum =
        read_terms(w, f, 1, &t) ? dalcs_sides_write(&w->kinks, w->r, &t, f) : f;
    for (int k = 0; k < t.n && sum != NULL && sum != f; k++) {
        sum = t.has_kink[k] ? sum
                            : dalcs_rewriting_combine(
                                  w->r, f, DALCS_ADD, sum,
                                  dalcs_rewriting_times(w->r, rebuild(w, t.part[k]), t.factor[k]));
    }
    return sum;
}

static const struct dalcs_formula *rebuild_arguments(struct rewriter *w,
                                                     const struct dalcs_formula *f) {
    const struct dalcs_formula **argument =
        dalcs_alloc((size_t)f->n, sizeof(const struct dalcs_formula *));
    bool is_new = false;
    w->r->failed = w->r->failed || argument == NULL;
    for (int k = 0; k < f->n && !w->r->failed; k++) {
        argument[k] = rebuild(w, f->argument[k]);
        w->r->failed = w->r->failed || argument[k] == NULL;
        is_new = is_new || argument[k] != f->argument[k];
    }
    const struct dalcs_formula *made =
        is_new && !w->r->failed ? dalcs_rewriting_like(w->r, f, f->n, argument) : f;
    free(argument);
    return w->r->failed ? NULL : made;
}

static const struct dalcs_formula *rebuild(struct rewriter *w, const struct dalcs_formula *f) {
    if (f->n == 0 || w->r->failed) {
        return w->r->failed ? NULL : f;
    }
    const struct dalcs_formula **known = &w->memo[f->number_of];
    if (*known == NULL) {
        const struct dalcs_formula *made = write_sum(w, f);
        *known = made == f ? rebuild_arguments(w, f) : made;
        w->r->failed = w->r->failed || *known == NULL;
    }
    return *known;
}

/* ---- Of which quantities ------------------------------------------------------------------------- */

struct quantities {
    int n;
    const struct dalcs_formula *quantity[MOST_QUANTITIES];
};

/* What a part has kinks of, where it is compared with 0 or a number: a line of what is listed, which reads no time. */
static void add_quantity(struct quantities *q, const struct dalcs_formula *f) {
    const struct dalcs_formula *of = dalcs_formula_read_line(f).of;
    bool is_new = of->kind != DALCS_FORMULA_NUMBER && of->kind != DALCS_FORMULA_TIME &&
                  q->n < MOST_QUANTITIES;
    for (int k = 0; k < q->n && is_new; k++) {
        is_new = !dalcs_formula_is_same(q->quantity[k], of);
    }
    if (is_new) {
        q->quantity[q->n++] = of;
    }
}

static void list_quantities(struct quantities *q, const struct dalcs_formula *f, bool *seen) {
    if (seen[f->number_of]) {
        return;
    }
    seen[f->number_of] = true;
    for (int k = 0; k < f->n; k++) {
        list_quantities(q, f->argument[k], seen);
    }
    for (int k = 0; k < f->n && (dalcs_kinks_is_call(f) || dalcs_kinks_is_condition(f)); k++) {
        add_quantity(q, f->argument[k]);
    }
}

/* The formula with sums of sides of one quantity; NULL: out of memory. */
static const struct dalcs_formula *rewrite_of(struct dalcs_rewriting *r,
                                              const struct dalcs_formula *formula,
                                              const struct dalcs_formula *quantity,
                                              enum dalcs_dialect_name dialect) {
    const size_t n = (size_t)r->n_parts;
    struct rewriter w = {.kinks = {.dialect = dialect, .quantity = quantity}, .r = r};
    w.kinks.part = dalcs_alloc(n, sizeof *w.kinks.part);
    w.memo = dalcs_alloc(n, sizeof(const struct dalcs_formula *));
    r->failed = r->failed || w.kinks.part == NULL || w.memo == NULL;
    const struct dalcs_formula *made = rebuild(&w, formula);
    free(w.kinks.part);
    free(w.memo);
    return made;
}

const struct dalcs_formula *dalcs_formula_pieces(struct dalcs_arena *arena,
                                                 const struct dalcs_formula *formula,
                                                 enum dalcs_dialect_name dialect) {
    struct dalcs_rewriting r = {.arena = arena, .n_parts = formula->number_of + 1};
    struct quantities q = {0};
    bool *seen = dalcs_alloc((size_t)r.n_parts, sizeof *seen);
    if (seen == NULL) {
        return NULL;
    }
    list_quantities(&q, formula, seen);
    free(seen);
    for (int k = 0; k < q.n && formula != NULL; k++) {
        formula = rewrite_of(&r, formula, q.quantity[k], dialect);
    }
    return formula;
}
