/* storage_integral.c - the integral over x of a capacitance or an inductance that is written with functions of x.
 *
 * Every rule is one of a table of integrals (Abramowitz and Stegun 1964, 4.1 to 4.5): polynomials, exp(l), sin(l),
 * cos(l), tanh(l), atan(l) and powers of a line l, sums of them, and choices between them at a number. A choice at k,
 * of a below and b above, has the integral A(min(x, k)) + B(max(x, k)): it has no jump, and neither is asked where it is
 * not chosen, so that exp(-10 x) that is chosen above 5 does not grow without end below. */
#include "formula_writer.h"
#include "storage.h"

#include <string.h>

enum { MOST_POWERS = 9 }; /* x^0 to x^8: more is written by nobody, and is refused */

struct polynomial {
    double of[MOST_POWERS];
};

/* ---- Polynomials of x -------------------------------------------------------------------------------- */

static int degree(const struct polynomial *p) {
    int n = MOST_POWERS - 1;
    while (n > 0 && p->of[n] == 0) {
        n--;
    }
    return n;
}

static bool multiply(const struct polynomial *a, const struct polynomial *b,
                     struct polynomial *product) {
    *product = (struct polynomial){{0}};
    if (degree(a) + degree(b) >= MOST_POWERS) {
        return false;
    }
    for (int i = 0; i <= degree(a); i++) {
        for (int j = 0; j <= degree(b); j++) {
            product->of[i + j] += a->of[i] * b->of[j];
        }
    }
    return true;
}

static bool raise_to(const struct polynomial *a, double power, struct polynomial *raised) {
    *raised = (struct polynomial){{1}};
    bool is = power >= 0 && power < MOST_POWERS && power == (int)power;
    for (int k = 0; is && k < (int)power; k++) {
        const struct polynomial before = *raised;
        is = multiply(&before, a, raised);
    }
    return is;
}

static bool is_power(const struct dalcs_formula *f) {
    return f->kind == DALCS_FORMULA_CALL
               ? strcmp(f->function, "pow") == 0
               : f->kind == DALCS_FORMULA_OPERATION && f->code == DALCS_POWER;
}

static bool is_square(const struct dalcs_formula *f) {
    return f->kind == DALCS_FORMULA_CALL &&
           (strcmp(f->function, "sqr") == 0 || strcmp(f->function, "square") == 0);
}

/* f as a polynomial; false: it is none. */
static bool find_polynomial(const struct dalcs_formula *f, struct polynomial *p) {
    struct polynomial a = {{0}};
    struct polynomial b = {{0}};
    *p = (struct polynomial){{0}};
    if (f->kind == DALCS_FORMULA_NUMBER || f->kind == DALCS_FORMULA_TIME) {
        const bool is_x = f->kind == DALCS_FORMULA_TIME;
        p->of[is_x] = is_x ? 1 : f->number;
        return true;
    }
    if (is_square(f)) {
        return find_polynomial(f->argument[0], &a) && multiply(&a, &a, p);
    }
    if ((f->kind != DALCS_FORMULA_OPERATION && !is_power(f)) ||
        !find_polynomial(f->argument[0], &a) ||
        (f->n > 1 && !find_polynomial(f->argument[1], &b))) {
        return false;
    }
    if (is_power(f)) {
        return degree(&b) == 0 && raise_to(&a, b.of[0], p);
    }
    const double sign = f->code == DALCS_ADD ? 1 : -1;
    switch (f->code) {
    case DALCS_NEGATE:
    case DALCS_ADD:
    case DALCS_SUBTRACT:
        for (int k = 0; k < MOST_POWERS; k++) {
            p->of[k] = f->code == DALCS_NEGATE ? -a.of[k] : a.of[k] + sign * b.of[k];
        }
        return true;
    case DALCS_MULTIPLY:
        return multiply(&a, &b, p);
    case DALCS_DIVIDE:
        for (int k = 0; k < MOST_POWERS; k++) {
            p->of[k] = a.of[k] / b.of[0];
        }
        return degree(&b) == 0 && b.of[0] != 0;
    default:
        return false;
    }
}

/* slope x and a number */
static bool find_line(const struct dalcs_formula *f, double *slope) {
    struct polynomial p;
    const bool is = find_polynomial(f, &p) && degree(&p) == 1;
    *slope = is ? p.of[1] : 0;
    return is;
}

static bool is_number(const struct dalcs_formula *f, double *number) {
    struct polynomial p;
    const bool is = find_polynomial(f, &p) && degree(&p) == 0;
    *number = is ? p.of[0] : 0;
    return is;
}

/* ---- Writing ------------------------------------------------------------------------------------------ */

static const struct dalcs_formula *operation(struct dalcs_formula_writer *w,
                                             enum dalcs_operation_code code,
                                             const struct dalcs_formula *a,
                                             const struct dalcs_formula *b) {
    return a != NULL && b != NULL ? dalcs_formula_operation(w, code, a, b) : NULL;
}

static const struct dalcs_formula *times(struct dalcs_formula_writer *w, double factor,
                                         const struct dalcs_formula *f) {
    return operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, factor), f);
}

static const struct dalcs_formula *call(struct dalcs_formula_writer *w, const char *function,
                                        const struct dalcs_formula *argument) {
    return argument != NULL ? dalcs_formula_call(w, function, 1, &argument) : NULL;
}

/* As Horner's rule has it. */
static const struct dalcs_formula *integrate_polynomial(struct dalcs_formula_writer *w,
                                                        const struct polynomial *p) {
    const struct dalcs_formula *x = dalcs_formula_signal(w, DALCS_FORMULA_TIME, NULL, NULL);
    const int n = degree(p);
    const struct dalcs_formula *sum = dalcs_formula_number(w, p->of[n] / (n + 1));
    for (int k = n - 1; k >= 0; k--) {
        sum = operation(w, DALCS_ADD, operation(w, DALCS_MULTIPLY, sum, x),
                        dalcs_formula_number(w, p->of[k] / (k + 1)));
    }
    return operation(w, DALCS_MULTIPLY, sum, x);
}

/* ---- Functions of a line -------------------------------------------------------------------------------- */

/* base^power, with base a line: the logarithm at -1. Neither that nor a broken power has a value where the base is
 * negative. A power below -1 has a pole, or another charge beyond it that equations alone do not tell from the right one:
 * it is refused. */
static const struct dalcs_formula *integrate_power(struct dalcs_formula_writer *w,
                                                   const struct dalcs_formula *base, double power) {
    double slope;
    if (!find_line(base, &slope) || power < -1) {
        return NULL;
    }
    if (power == -1) {
        return times(w, 1 / slope, call(w, "ln", base));
    }
    const struct dalcs_formula *raised =
        operation(w, DALCS_POWER, base, dalcs_formula_number(w, power + 1));
    return times(w, 1 / (slope * (power + 1)), raised);
}

/* u atan(u) - ln(1 + u^2) / 2 */
static const struct dalcs_formula *integrate_atan(struct dalcs_formula_writer *w,
                                                  const struct dalcs_formula *u) {
    const struct dalcs_formula *product = operation(w, DALCS_MULTIPLY, u, call(w, "atan", u));
    const struct dalcs_formula *square =
        operation(w, DALCS_ADD, dalcs_formula_number(w, 1), call(w, "sqr", u));
    return operation(w, DALCS_SUBTRACT, product, times(w, 0.5, call(w, "ln", square)));
}

/* ln(cosh u) = u + ln(1 + exp(-2 u)) - ln 2 */
static const struct dalcs_formula *integrate_tanh(struct dalcs_formula_writer *w,
                                                  const struct dalcs_formula *u) {
    const struct dalcs_formula *rest =
        operation(w, DALCS_ADD, dalcs_formula_number(w, 1), call(w, "exp", times(w, -2, u)));
    return operation(w, DALCS_ADD, u, call(w, "ln", rest));
}

static const struct dalcs_formula *integrate_call(struct dalcs_formula_writer *w,
                                                  const struct dalcs_formula *f) {
    const struct dalcs_formula *u = f->argument[0];
    double slope;
    double power;
    if (strcmp(f->function, "pow") == 0) {
        return is_number(f->argument[1], &power) ? integrate_power(w, u, power) : NULL;
    }
    if (strcmp(f->function, "sqrt") == 0) {
        return integrate_power(w, u, 0.5);
    }
    if (f->n != 1 || !find_line(u, &slope)) {
        return NULL;
    }
    const struct dalcs_formula *whole = strcmp(f->function, "exp") == 0 ? call(w, "exp", u)
                                        : strcmp(f->function, "sin") == 0
                                            ? times(w, -1, call(w, "cos", u))
                                        : strcmp(f->function, "cos") == 0  ? call(w, "sin", u)
                                        : strcmp(f->function, "tanh") == 0 ? integrate_tanh(w, u)
                                        : strcmp(f->function, "atan") == 0 ? integrate_atan(w, u)
                                                                           : NULL;
    return whole != NULL ? times(w, 1 / slope, whole) : NULL;
}

/* ---- Choices ------------------------------------------------------------------------------------------ */

static bool is_comparison(const struct dalcs_formula *f) {
    return f->kind == DALCS_FORMULA_OPERATION &&
           (f->code == DALCS_LESS || f->code == DALCS_LESS_EQUAL || f->code == DALCS_GREATER ||
            f->code == DALCS_GREATER_EQUAL);
}

/* The integral with x kept on one side of k. */
static const struct dalcs_formula *one_side(struct dalcs_formula_writer *w, const char *side,
                                            double k, const struct dalcs_formula *f) {
    const struct dalcs_formula *x = dalcs_formula_signal(w, DALCS_FORMULA_TIME, NULL, NULL);
    const struct dalcs_formula *both[2] = {x, dalcs_formula_number(w, k)};
    const struct dalcs_formula *whole = dalcs_storage_integral(w, f);
    return whole != NULL ? dalcs_storage_formula_copy(w, NULL, whole,
                                                      dalcs_formula_call(w, side, 2, both), false)
                         : NULL;
}

/* is_true where the condition, a comparison of lines, holds, and is_false where it does not. */
static const struct dalcs_formula *choose(struct dalcs_formula_writer *w,
                                          const struct dalcs_formula *condition,
                                          const struct dalcs_formula *is_true,
                                          const struct dalcs_formula *is_false) {
    struct polynomial a;
    struct polynomial b;
    if (condition->kind == DALCS_FORMULA_OPERATION &&
        (condition->code == DALCS_TO_LOGIC || condition->code == DALCS_NOT)) {
        const bool turns = condition->code == DALCS_NOT;
        return choose(w, condition->argument[0], turns ? is_false : is_true,
                      turns ? is_true : is_false);
    }
    if (!is_comparison(condition) || !find_polynomial(condition->argument[0], &a) ||
        !find_polynomial(condition->argument[1], &b) || degree(&a) > 1 || degree(&b) > 1 ||
        a.of[1] == b.of[1]) {
        return NULL;
    }
    const double slope = a.of[1] - b.of[1];
    const bool is_less = condition->code == DALCS_LESS || condition->code == DALCS_LESS_EQUAL;
    const bool is_below = is_less == (slope > 0);
    const double k = (b.of[0] - a.of[0]) / slope;
    return operation(w, DALCS_ADD, one_side(w, "min", k, is_below ? is_true : is_false),
                     one_side(w, "max", k, is_below ? is_false : is_true));
}

/* ---- All of it ------------------------------------------------------------------------------------------ */

/* number / base, or number / base^power */
static const struct dalcs_formula *integrate_quotient(struct dalcs_formula_writer *w, double number,
                                                      const struct dalcs_formula *below) {
    double power = 1;
    if (is_power(below) ||
        (below->kind == DALCS_FORMULA_CALL && strcmp(below->function, "sqrt") == 0)) {
        power = 0.5;
        if (is_power(below) && !is_number(below->argument[1], &power)) {
            return NULL;
        }
        below = below->argument[0];
    }
    return times(w, number, integrate_power(w, below, -power));
}

static bool is_product(const struct dalcs_formula *f) {
    return f->kind == DALCS_FORMULA_OPERATION && f->code == DALCS_MULTIPLY;
}

/* A number, or a comparison, among the factors comes out of the integral. */
static const struct dalcs_formula *integrate_product(struct dalcs_formula_writer *w,
                                                     const struct dalcs_formula *a,
                                                     const struct dalcs_formula *b) {
    const struct dalcs_formula *const factor[2][2] = {{a, b}, {b, a}};
    double number;
    for (int k = 0; k < 2; k++) {
        if (is_number(factor[k][0], &number)) {
            return times(w, number, dalcs_storage_integral(w, factor[k][1]));
        }
        if (is_comparison(factor[k][0])) {
            return choose(w, factor[k][0], factor[k][1], dalcs_formula_number(w, 0));
        }
    }
    for (int k = 0; k < 4; k++) {
        const struct dalcs_formula *inner = factor[k / 2][0];
        if (is_product(inner) &&
            (is_number(inner->argument[k % 2], &number) || is_comparison(inner->argument[k % 2]))) {
            const struct dalcs_formula *rest =
                operation(w, DALCS_MULTIPLY, inner->argument[1 - k % 2], factor[k / 2][1]);
            return rest != NULL ? integrate_product(w, inner->argument[k % 2], rest) : NULL;
        }
    }
    return NULL;
}

static const struct dalcs_formula *integrate_operation(struct dalcs_formula_writer *w,
                                                       const struct dalcs_formula *f) {
    const struct dalcs_formula *a = f->argument[0];
    const struct dalcs_formula *b = f->n > 1 ? f->argument[1] : NULL;
    double number;
    switch (f->code) {
    case DALCS_NEGATE:
        return times(w, -1, dalcs_storage_integral(w, a));
    case DALCS_ADD:
    case DALCS_SUBTRACT:
        return operation(w, f->code, dalcs_storage_integral(w, a), dalcs_storage_integral(w, b));
    case DALCS_MULTIPLY:
        return integrate_product(w, a, b);
    case DALCS_DIVIDE:
        return is_number(b, &number)   ? times(w, 1 / number, dalcs_storage_integral(w, a))
               : is_number(a, &number) ? integrate_quotient(w, number, b)
                                       : NULL;
    case DALCS_POWER:
        return is_number(b, &number) ? integrate_power(w, a, number) : NULL;
    default:
        return is_comparison(f)
                   ? choose(w, f, dalcs_formula_number(w, 1), dalcs_formula_number(w, 0))
                   : NULL;
    }
}

const struct dalcs_formula *dalcs_storage_integral(struct dalcs_formula_writer *w,
                                                   const struct dalcs_formula *f) {
    struct polynomial p;
    if (find_polynomial(f, &p)) {
        return integrate_polynomial(w, &p);
    }
    switch (f->kind) {
    case DALCS_FORMULA_OPERATION:
        return integrate_operation(w, f);
    case DALCS_FORMULA_CHOICE:
        return choose(w, f->argument[0], f->argument[1], f->argument[2]);
    case DALCS_FORMULA_CALL:
        return integrate_call(w, f);
    default:
        return NULL;
    }
}
