/* exponentials.c - quotients and logarithms of sums of exponentials: 1/(1+exp(-x)) is logistic(x), ln(1+exp(x)) is
 * softplus(x), x/(exp(x)-1) is bernoulli(x).
 *
 * These functions are bounded, or grow as a line does. As written they pass exponentials that overflow where |x| is some
 * hundreds, and beside which 1 is rounding from 37 on: Newton's method has no digits there. With two terms below,
 *
 *     (a1 e^p + a2 e^q)/(d1 e^p + d2 e^q) = a1/d1 + (a2/d2 - a1/d1)/(1 + e^-z),     z = q - p + ln(d2/d1),
 *
 * where d1 and d2 have one sign. The logarithm of such a sum is p + ln(d1) + ln(1 + e^z). Where the signs differ a line
 * above that is 0 where the sum is has no pole there: it is a factor times z/(e^z - 1). */
#include "rewriting.h"

#include <float.h>
#include <math.h>

enum { MOST_TERMS = 4 };

/* sign * exp(slope * of + constant); slope 0: a number */
struct term {
    double sign, slope, constant;
};

/* A sum of them, all of one quantity. */
struct sum {
    const struct dalcs_formula *of; /* NULL: none yet */
    int n;
    struct term term[MOST_TERMS];
};

static bool is_alike(double a, double b) {
    return fabs(a - b) <= 8 * DBL_EPSILON * fmax(fabs(a), fabs(b));
}

/* Terms of one slope are one. What is left of two that cancel is 0. */
static bool add_term(struct sum *sum, struct term t) {
    for (int k = 0; k < sum->n; k++) {
        struct term *known = &sum->term[k];
        if (is_alike(known->slope, t.slope)) {
            const double top = fmax(known->constant, t.constant);
            const double value =
                known->sign * exp(known->constant - top) + t.sign * exp(t.constant - top);
            known->sign = value > 0 ? 1 : -1;
            known->constant = top + log(fabs(value));
            if (fabs(value) <= 4 * DBL_EPSILON) {
                *known = sum->term[--sum->n];
            }
            return true;
        }
    }
    const bool has_room = sum->n < MOST_TERMS && isfinite(t.constant) && isfinite(t.slope);
    if (has_room) {
        sum->term[sum->n++] = t;
    }
    return has_room;
}

static bool add_number(struct sum *sum, double value) {
    return value == 0 || add_term(sum, (struct term){value > 0 ? 1 : -1, 0, log(fabs(value))});
}

static bool add_exponential(struct sum *sum, const struct dalcs_formula *argument, double factor) {
    const struct dalcs_formula_line line = dalcs_formula_read_line(argument);
    if (line.of->kind == DALCS_FORMULA_NUMBER ||
        (sum->of != NULL && !dalcs_formula_is_same(sum->of, line.of))) {
        return false;
    }
    sum->of = line.of;
    return add_term(
        sum, (struct term){factor > 0 ? 1 : -1, line.slope, line.constant + log(fabs(factor))});
}

/* factor * f as terms of a sum; false: it is something else. */
static bool read_sum(struct sum *sum, const struct dalcs_formula *f, double factor) {
    const struct dalcs_formula_line line = dalcs_formula_read_line(f);
    if (factor == 0 || !isfinite(factor)) {
        return false;
    }
    if (line.of->kind == DALCS_FORMULA_NUMBER) {
        return add_number(sum, factor * (line.slope * line.of->number + line.constant));
    }
    if (line.of != f) {
        return read_sum(sum, line.of, factor * line.slope) &&
               add_number(sum, factor * line.constant);
    }
    if (dalcs_formula_is_operation(f, DALCS_ADD) || dalcs_formula_is_operation(f, DALCS_SUBTRACT)) {
        const double second = f->code == DALCS_ADD ? factor : -factor;
        return read_sum(sum, f->argument[0], factor) && read_sum(sum, f->argument[1], second);
    }
    return dalcs_formula_is_call(f, "exp") && add_exponential(sum, f->argument[0], factor);
}

/* The two terms of a sum, and z of which they are: it is first * (1 + e^z), or first * (1 - e^z). */
struct pair {
    const struct dalcs_formula *of;
    struct term first, second;
    double slope, constant; /* of z */
};

static bool read_pair(const struct dalcs_formula *f, struct pair *pair) {
    struct sum sum = {0};
    if (!read_sum(&sum, f, 1) || sum.n != 2 || sum.of == NULL) {
        return false;
    }
    const int number = sum.term[1].slope == 0 ? 1 : 0; /* first, if there is one */
    const struct term a = sum.term[number];
    const struct term b = sum.term[1 - number];
    *pair = (struct pair){sum.of, a, b, b.slope - a.slope, b.constant - a.constant};
    return true;
}

/* ---- What is written ----------------------------------------------------------------------------- */

static const struct dalcs_formula *line_of(struct dalcs_rewriting *r,
                                           const struct dalcs_formula *at,
                                           const struct dalcs_formula *of, double slope,
                                           double constant) {
    return dalcs_rewriting_combine(r, at, DALCS_ADD, dalcs_rewriting_times(r, of, slope),
                                   dalcs_rewriting_number(r, at, constant));
}

/* name(factor * z) */
static const struct dalcs_formula *call_of_z(struct dalcs_rewriting *r,
                                             const struct dalcs_formula *at, const char *name,
                                             const struct pair *pair, double factor) {
    const struct dalcs_formula *z =
        line_of(r, at, pair->of, factor * pair->slope, factor * pair->constant);
    struct dalcs_formula *call = z != NULL ? dalcs_rewriting_like(r, at, 1, &z) : NULL;
    if (call != NULL) {
        call->kind = DALCS_FORMULA_CALL;
        call->function = name;
    }
    return call;
}

/* first/pair.first and second/pair.second, of what stands above. */
static bool find_shares(const struct sum *above, const struct pair *pair, double *first,
                        double *second) {
    bool is = true;
    *first = *second = 0;
    for (int k = 0; k < above->n && is; k++) {
        const struct term *t = &above->term[k];
        const bool is_first = is_alike(t->slope, pair->first.slope);
        const struct term *below = is_first ? &pair->first : &pair->second;
        const double share = t->sign * below->sign * exp(t->constant - below->constant);
        is = is_alike(t->slope, below->slope) && isfinite(share);
        *(is_first ? first : second) = share;
    }
    return is;
}

/* A sum over a pair of one sign; NULL: it is none. */
static const struct dalcs_formula *divide_sum(struct dalcs_rewriting *r,
                                              const struct dalcs_formula *at,
                                              const struct dalcs_formula *above,
                                              const struct pair *pair) {
    struct sum sum = {.of = pair->of};
    double first;
    double second;
    if (!read_sum(&sum, above, 1) || !find_shares(&sum, pair, &first, &second)) {
        return NULL;
    }
    if (is_alike(first, -second)) {
        return dalcs_rewriting_times(r, call_of_z(r, at, "tanh", pair, 0.5), second);
    }
    if (second == 0) {
        return dalcs_rewriting_times(r, call_of_z(r, at, "logistic", pair, -1), first);
    }
    return dalcs_rewriting_combine(
        r, at, DALCS_ADD, dalcs_rewriting_number(r, at, first),
        dalcs_rewriting_times(r, call_of_z(r, at, "logistic", pair, 1), second - first));
}

/* A line over a number and an exponential of the other sign that are 0 together; NULL: it is none. */
static const struct dalcs_formula *divide_line(struct dalcs_rewriting *r,
                                               const struct dalcs_formula *at,
                                               const struct dalcs_formula *above,
                                               const struct pair *pair) {
    const struct dalcs_formula_line line = dalcs_formula_read_line(above);
    const double factor = line.slope / pair->slope;
    const double value = pair->first.sign * exp(pair->first.constant);
    const bool is = pair->first.slope == 0 && dalcs_formula_is_same(line.of, pair->of) &&
                    is_alike(line.constant, factor * pair->constant) && isfinite(value);
    return is ? dalcs_rewriting_times(r, call_of_z(r, at, "bernoulli", pair, 1), -factor / value)
              : NULL;
}

/* above/pair; NULL: it stays as it is. A factor of a product may be what is divided, or all of it. */
static const struct dalcs_formula *divide(struct dalcs_rewriting *r, const struct dalcs_formula *at,
                                          const struct dalcs_formula *above,
                                          const struct pair *pair) {
    const bool have_one_sign = pair->first.sign == pair->second.sign;
    const struct dalcs_formula *made =
        have_one_sign ? divide_sum(r, at, above, pair) : divide_line(r, at, above, pair);
    for (int k = 0; k < 2 && made == NULL && dalcs_formula_is_operation(above, DALCS_MULTIPLY);
         k++) {
        const bool is_number = above->argument[k]->kind == DALCS_FORMULA_NUMBER;
        made = is_number ? NULL : divide(r, at, above->argument[k], pair);
        made = made != NULL
                   ? dalcs_rewriting_combine(r, at, DALCS_MULTIPLY, above->argument[1 - k], made)
                   : NULL;
    }
    return made;
}

static const struct dalcs_formula *change_quotient(struct dalcs_rewriting *r,
                                                   const struct dalcs_formula *f) {
    struct pair pair;
    if (!read_pair(f->argument[1], &pair)) {
        return f;
    }
    const struct dalcs_formula *made = divide(r, f, f->argument[0], &pair);
    if (made == NULL && pair.first.sign == pair.second.sign && pair.first.slope == 0) {
        const struct dalcs_formula *one = dalcs_rewriting_number(r, f, 1);
        made = one != NULL ? divide_sum(r, f, one, &pair) : NULL;
        made = made != NULL ? dalcs_rewriting_combine(r, f, DALCS_MULTIPLY, f->argument[0], made)
                            : NULL;
    }
    return made != NULL ? made : f;
}

/* factor * ln(f->argument[0]) */
static const struct dalcs_formula *change_logarithm(struct dalcs_rewriting *r,
                                                    const struct dalcs_formula *f, double factor) {
    struct pair pair;
    if (!read_pair(f->argument[0], &pair) || pair.first.sign < 0 || pair.second.sign < 0) {
        return f;
    }
    const struct dalcs_formula *rest =
        pair.first.slope == 0
            ? dalcs_rewriting_number(r, f, factor * pair.first.constant)
            : line_of(r, f, pair.of, factor * pair.first.slope, factor * pair.first.constant);
    const struct dalcs_formula *made = dalcs_rewriting_combine(
        r, f, DALCS_ADD, rest,
        dalcs_rewriting_times(r, call_of_z(r, f, "softplus", &pair, 1), factor));
    return made != NULL ? made : f;
}

static const struct dalcs_formula *
change_either(struct dalcs_rewriting *r, const struct dalcs_formula *f, bool log_is_natural) {
    const bool is_log = dalcs_formula_is_call(f, "log");
    if (dalcs_formula_is_operation(f, DALCS_DIVIDE)) {
        return change_quotient(r, f);
    }
    if (dalcs_formula_is_call(f, "ln") || (is_log && log_is_natural)) {
        return change_logarithm(r, f, 1);
    }
    return is_log || dalcs_formula_is_call(f, "log10") ? change_logarithm(r, f, 1 / log(10)) : f;
}

static const struct dalcs_formula *change(struct dalcs_rewriting *r,
                                          const struct dalcs_formula *f) {
    return change_either(r, f, true);
}

static const struct dalcs_formula *change_in_xyce(struct dalcs_rewriting *r,
                                                  const struct dalcs_formula *f) {
    return change_either(r, f, false);
}

const struct dalcs_formula *dalcs_formula_exponentials(struct dalcs_arena *arena,
                                                       const struct dalcs_formula *formula,
                                                       enum dalcs_dialect_name dialect) {
    return dalcs_formula_rewrite(arena, formula,
                                 dialect == DALCS_DIALECT_XYCE ? change_in_xyce : change);
}
