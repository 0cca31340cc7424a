/* signed_powers.c - powers with the sign of what they are of: sgn(x)*sqrt(abs(x)) is pwrs(x, 0.5), and x*sqrt(abs(x))
 * is pwrs(x, 1.5).
 *
 * Flow through an orifice, drag and the square law of a fan are written with the sign, or with a choice of its sides,
 * x > 0 ? sqrt(x) : -sqrt(-x). As written the steps of a sign multiply what is steep at 0; the power itself has one slope
 * at each place, and Newton's method finds it. */
#include "rewriting.h"

#include <math.h>

/* factor * rest * sgn(sign) * |size|^exponent; NULL: there is none of these. Of a root that is written without abs(), the
 * argument is side * size. */
struct term {
    double factor;
    const struct dalcs_formula *rest, *sign, *size;
    double exponent;
    int side; /* 1 or -1, 0: written with abs() */
    bool is_one;
};

/* x as k times something that is no product with a number; a sum with one is left as it is. */
static const struct dalcs_formula *peel(const struct dalcs_formula *x, double *k) {
    const struct dalcs_formula_line line = dalcs_formula_read_line(x);
    *k = line.constant == 0.0 ? line.slope : 1.0;
    return line.constant == 0.0 ? line.of : x;
}

/* |x|^exponent, as a factor of a term. */
static bool take_power(const struct dalcs_formula *x, double exponent, struct term *t) {
    double outer;
    double inner = 1.0;
    const struct dalcs_formula *size = peel(x, &outer);
    const bool has_abs = dalcs_formula_is_call(size, "abs");
    if (has_abs) {
        size = peel(size->argument[0], &inner);
    }
    const double k = outer * fabs(inner);
    if (t->size != NULL || !(exponent > 0.0) || (has_abs && !(k > 0.0)) || k == 0.0) {
        return false;
    }
    t->size = size;
    t->exponent = exponent;
    t->side = has_abs ? 0 : k > 0.0 ? 1 : -1;
    t->factor *= pow(fabs(k), exponent);
    return true;
}

static bool take_factor(struct dalcs_rewriting *r, const struct dalcs_formula *f, struct term *t);

/* The factors of a product. */
static bool take_factors(struct dalcs_rewriting *r, const struct dalcs_formula *f, struct term *t) {
    double k;
    const struct dalcs_formula *what = peel(f, &k);
    t->factor *= k;
    if (dalcs_formula_is_operation(what, DALCS_MULTIPLY)) {
        return take_factors(r, what->argument[0], t) && take_factors(r, what->argument[1], t);
    }
    return take_factor(r, what, t);
}

static bool take_factor(struct dalcs_rewriting *r, const struct dalcs_formula *f, struct term *t) {
    const bool is_magnitude = dalcs_formula_is_call(f, "pwr");
    const bool is_power = (is_magnitude || dalcs_formula_is_operation(f, DALCS_POWER) ||
                           dalcs_formula_is_call(f, "pow")) &&
                          f->argument[1]->kind == DALCS_FORMULA_NUMBER;
    if (f->kind == DALCS_FORMULA_NUMBER) {
        t->factor *= f->number;
        return true;
    }
    if (dalcs_formula_is_call(f, "sgn")) {
        double k;
        const struct dalcs_formula *of = peel(f->argument[0], &k);
        const bool is = t->sign == NULL && k != 0.0;
        t->sign = of;
        t->factor *= copysign(1.0, k);
        return is;
    }
    if (dalcs_formula_is_call(f, "sqrt")) {
        return take_power(f->argument[0], 0.5, t);
    }
    if (is_power) {
        const bool is = take_power(f->argument[0], f->argument[1]->number, t);
        t->side = is_magnitude ? 0 : t->side;
        return is;
    }
    if (dalcs_formula_is_call(f, "abs") && t->size == NULL) {
        return take_power(f, 1.0, t);
    }
    t->rest = t->rest == NULL ? f : dalcs_rewriting_product(r, f, t->rest, f);
    return t->rest != NULL;
}

static struct term read_term(struct dalcs_rewriting *r, const struct dalcs_formula *f) {
    struct term t = {.factor = 1.0};
    t.is_one = take_factors(r, f, &t) && t.size != NULL;
    return t;
}

/* Without its sign x is |x|: x * |x|^p is a power of 1 + p. x * |x| stays, for its pieces are smooth. */
static void take_sign(struct term *t) {
    const bool is_factor = t->is_one && t->sign == NULL && t->exponent != 1.0 && t->rest != NULL &&
                           dalcs_formula_is_same(t->rest, t->size);
    if (is_factor) {
        t->sign = t->rest;
        t->rest = NULL;
        t->exponent += 1.0;
    }
}

/* factor * rest * pwrs(size, exponent) */
static const struct dalcs_formula *write(struct dalcs_rewriting *r, const struct dalcs_formula *at,
                                         const struct term *t) {
    const struct dalcs_formula *power =
        t->exponent == 1.0 ? t->size
                           : dalcs_rewriting_call(r, at, "pwrs", t->size,
                                                  dalcs_rewriting_number(r, at, t->exponent));
    const struct dalcs_formula *product =
        t->factor == 1.0
            ? power
            : dalcs_rewriting_product(r, at, dalcs_rewriting_number(r, at, t->factor), power);
    return t->rest == NULL || product == NULL ? product
                                              : dalcs_rewriting_product(r, at, t->rest, product);
}

static const struct dalcs_formula *change_product(struct dalcs_rewriting *r,
                                                  const struct dalcs_formula *f) {
    struct term t = read_term(r, f);
    take_sign(&t);
    const bool is_signed =
        t.is_one && t.sign != NULL && t.side == 0 && dalcs_formula_is_same(t.sign, t.size);
    return is_signed ? write(r, f, &t) : f;
}

/* Is the first value of a choice that above 0 of a quantity (1), or that below (-1)? 0: it is another choice. */
static int side_of(const struct dalcs_formula *condition, const struct dalcs_formula *quantity) {
    const struct dalcs_formula *f = condition;
    if (dalcs_formula_is_operation(f, DALCS_TO_LOGIC)) {
        f = f->argument[0];
    }
    const bool is_above = dalcs_formula_is_operation(f, DALCS_GREATER) ||
                          dalcs_formula_is_operation(f, DALCS_GREATER_EQUAL);
    const bool is_below = dalcs_formula_is_operation(f, DALCS_LESS) ||
                          dalcs_formula_is_operation(f, DALCS_LESS_EQUAL);
    if (!is_above && !is_below) {
        return 0;
    }
    const int turned = f->argument[0]->kind == DALCS_FORMULA_NUMBER ? 1 : 0;
    const struct dalcs_formula *limit = f->argument[1 - turned];
    double k;
    const struct dalcs_formula *of = peel(f->argument[turned], &k);
    if (limit->kind != DALCS_FORMULA_NUMBER || limit->number != 0.0 || k == 0.0 ||
        !dalcs_formula_is_same(of, quantity)) {
        return 0;
    }
    return (is_above == (k > 0.0)) == (turned == 0) ? 1 : -1;
}

static const struct dalcs_formula *change_choice(struct dalcs_rewriting *r,
                                                 const struct dalcs_formula *f) {
    struct term a = read_term(r, f->argument[1]);
    const struct term b = read_term(r, f->argument[2]);
    const bool are_powers = a.is_one && b.is_one && a.sign == NULL && b.sign == NULL &&
                            a.rest == NULL && b.rest == NULL && a.exponent == b.exponent &&
                            dalcs_formula_is_same(a.size, b.size);
    const int side = are_powers ? side_of(f->argument[0], a.size) : 0;
    const bool have_values = (a.side == 0 || a.side == side) && (b.side == 0 || b.side == -side);
    if (side == 0 || !have_values || a.factor != -b.factor) {
        return f;
    }
    a.factor *= side;
    return write(r, f, &a);
}

static const struct dalcs_formula *change(struct dalcs_rewriting *r,
                                          const struct dalcs_formula *f) {
    return dalcs_formula_is_operation(f, DALCS_MULTIPLY) ? change_product(r, f)
           : f->kind == DALCS_FORMULA_CHOICE             ? change_choice(r, f)
                                                         : f;
}

const struct dalcs_formula *dalcs_formula_signed_powers(struct dalcs_arena *arena,
                                                        const struct dalcs_formula *formula) {
    return dalcs_formula_rewrite(arena, formula, change);
}
