/* rational.c - sums, products, quotients and whole powers of s, multiplied out; exp(-s T) as a factor of all. */
#include "rational.h"

#include <math.h>
#include <string.h>

enum { DEEPEST = 200 };

struct work {
    struct dalcs_builder *builder;
    int depth;
};

static void trim(struct dalcs_polynomial *p) {
    while (p->degree > 0 && p->c[p->degree] == 0) {
        p->degree--;
    }
}

static bool multiply(const struct dalcs_polynomial *a, const struct dalcs_polynomial *b,
                     struct dalcs_polynomial *product) {
    struct dalcs_polynomial p = {.degree = a->degree + b->degree};
    if (p.degree > DALCS_RATIONAL_DEGREE) {
        return false;
    }
    for (int i = 0; i <= a->degree; i++) {
        for (int k = 0; k <= b->degree; k++) {
            p.c[i + k] += a->c[i] * b->c[k];
        }
    }
    trim(&p);
    *product = p;
    return true;
}

static bool is_same(const struct dalcs_polynomial *a, const struct dalcs_polynomial *b) {
    return a->degree == b->degree &&
           memcmp(a->c, b->c, (size_t)(a->degree + 1) * sizeof a->c[0]) == 0;
}

static bool is_zero(const struct dalcs_polynomial *p) {
    return p->degree == 0 && p->c[0] == 0;
}

/* a + sign b */
static bool add(const struct dalcs_rational *a, double sign, const struct dalcs_rational *b,
                struct dalcs_rational *sum) {
    struct dalcs_polynomial x = a->above;
    struct dalcs_polynomial y = b->above;
    struct dalcs_polynomial below = a->below;
    if (!is_same(&a->below, &b->below) &&
        (!multiply(&a->above, &b->below, &x) || !multiply(&b->above, &a->below, &y) ||
         !multiply(&a->below, &b->below, &below))) {
        return false;
    }
    for (int k = x.degree + 1; k <= y.degree; k++) {
        x.c[k] = 0;
    }
    for (int k = 0; k <= y.degree; k++) {
        x.c[k] += sign * y.c[k];
    }
    x.degree = x.degree > y.degree ? x.degree : y.degree;
    trim(&x);
    *sum = (struct dalcs_rational){x, below, is_zero(&a->above) ? b->delay : a->delay};
    return true;
}

static bool fail(struct work *w, const struct dalcs_formula *f, const char *what) {
    dalcs_builder_error_at(
        w->builder, &f->where,
        "a transfer function is a ratio of polynomials in s, or exp(-s*T) times one",
        "%s is not supported in a transfer function", what);
    return false;
}

static struct dalcs_rational number(double value) {
    return (struct dalcs_rational){.above = {.c = {value}}, .below = {.c = {1}}};
}

static bool make(struct work *w, const struct dalcs_formula *f, struct dalcs_rational *r);

static bool power(struct work *w, const struct dalcs_formula *f, struct dalcs_rational *r) {
    struct dalcs_rational base;
    const struct dalcs_formula *exponent = f->argument[1];
    if (!make(w, f->argument[0], &base)) {
        return false;
    }
    if (exponent->kind != DALCS_FORMULA_NUMBER || floor(exponent->number) != exponent->number ||
        fabs(exponent->number) > DALCS_RATIONAL_DEGREE) {
        return fail(w, f, "a power that is no small whole number");
    }
    *r = number(1);
    for (int k = 0; k < (int)fabs(exponent->number); k++) {
        if (!multiply(&r->above, &base.above, &r->above) ||
            !multiply(&r->below, &base.below, &r->below)) {
            return fail(w, f, "a degree above 20");
        }
    }
    if (exponent->number < 0) {
        *r = (struct dalcs_rational){r->below, r->above, 0};
    }
    r->delay = exponent->number * base.delay;
    return !is_zero(&r->below) || fail(w, f, "a division by 0");
}

static bool quotient(struct work *w, const struct dalcs_formula *f, struct dalcs_rational *r) {
    struct dalcs_rational a;
    struct dalcs_rational b;
    const bool divides = f->code == DALCS_DIVIDE;
    if (!make(w, f->argument[0], &a) || !make(w, f->argument[1], &b)) {
        return false;
    }
    r->delay = a.delay + (divides ? -b.delay : b.delay);
    if (divides && is_zero(&b.above)) {
        return fail(w, f, "a division by 0");
    }
    if (divides && is_same(&a.below, &b.below)) { /* of one denominator nothing is left */
        *r = (struct dalcs_rational){a.above, b.above, r->delay};
        return true;
    }
    return (multiply(&a.above, divides ? &b.below : &b.above, &r->above) &&
            multiply(&a.below, divides ? &b.above : &b.below, &r->below)) ||
           fail(w, f, "a degree above 20");
}

/* Terms of one delay, or one of them 0. */
static bool sum(struct work *w, const struct dalcs_formula *f, const struct dalcs_rational *a,
                const struct dalcs_rational *b, struct dalcs_rational *r) {
    if (a->delay != b->delay && !is_zero(&a->above) && !is_zero(&b->above)) {
        return fail(w, f, "a sum of terms that are delayed by different times");
    }
    return add(a, f->code == DALCS_ADD ? 1 : -1, b, r) || fail(w, f, "a degree above 20");
}

/* exp(c - s T) */
static bool exponential(struct work *w, const struct dalcs_formula *f, struct dalcs_rational *r) {
    struct dalcs_rational a;
    if (!make(w, f->argument[0], &a)) {
        return false;
    }
    if (a.below.degree > 0 || a.above.degree > 1 || a.delay != 0) {
        return fail(w, f, "exp() of anything but a number times s, which is a delay,");
    }
    *r = number(exp(a.above.c[0] / a.below.c[0]));
    r->delay = a.above.degree > 0 ? -a.above.c[1] / a.below.c[0] : 0;
    return true;
}

static bool operation(struct work *w, const struct dalcs_formula *f, struct dalcs_rational *r) {
    struct dalcs_rational a;
    struct dalcs_rational b;
    switch (f->code) {
    case DALCS_NEGATE:
        a = number(0);
        return make(w, f->argument[0], &b) && add(&a, -1, &b, r);
    case DALCS_ADD:
    case DALCS_SUBTRACT:
        return make(w, f->argument[0], &a) && make(w, f->argument[1], &b) && sum(w, f, &a, &b, r);
    case DALCS_MULTIPLY:
    case DALCS_DIVIDE:
        return quotient(w, f, r);
    case DALCS_POWER:
        return power(w, f, r);
    default:
        return fail(w, f, "a comparison");
    }
}

static bool make(struct work *w, const struct dalcs_formula *f, struct dalcs_rational *r) {
    if (w->depth > DEEPEST) {
        return fail(w, f, "so deep an expression");
    }
    bool ok = false;
    w->depth++;
    switch (f->kind) {
    case DALCS_FORMULA_NUMBER:
        *r = number(f->number);
        ok = true;
        break;
    case DALCS_FORMULA_TIME:
        *r = (struct dalcs_rational){.above = {1, {0, 1}}, .below = {.c = {1}}};
        ok = true;
        break;
    case DALCS_FORMULA_OPERATION:
        ok = operation(w, f, r);
        break;
    case DALCS_FORMULA_CALL:
        ok = (strcmp(f->function, "pow") == 0 || strcmp(f->function, "pwr") == 0) && f->n == 2
                 ? power(w, f, r)
             : strcmp(f->function, "exp") == 0 ? exponential(w, f, r)
                                               : fail(w, f, "a function of s");
        break;
    default:
        ok = fail(w, f, "a voltage or a current");
        break;
    }
    w->depth--;
    return ok;
}

bool dalcs_rational_make(struct dalcs_builder *builder, const struct dalcs_formula *formula,
                         struct dalcs_rational *r) {
    struct work w = {.builder = builder};
    if (!make(&w, formula, r)) {
        return false;
    }
    r->delay = is_zero(&r->above) ? 0 : r->delay;
    return r->delay >= 0 || fail(&w, formula, "exp(s T) with T > 0, which comes before its cause,");
}
