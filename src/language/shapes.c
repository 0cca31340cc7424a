/* shapes.c - which smooth formulas of one quantity rise everywhere, or on one side of a centre alone.
 *
 * A sum of what rises rises; exp, sinh, tanh and a cube of what rises do; a square has a centre where its argument is 0; what
 * is 1 over something of one sign rises where that falls. What is known in no such way is another shape. */
#include "shapes.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Parts of one formula, those that are shared as often as they are read: a longer one is of another shape. */
enum { MOST_PARTS = 200 };

static struct dalcs_shape read_shape(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                                     int *n);

double dalcs_shape_value(const struct dalcs_kinks *kinks, const struct dalcs_formula *f, double x) {
    return dalcs_kinks_evaluate(kinks, f, x, x).value;
}

/* ---- Where a value is ---------------------------------------------------------------------------- */

/* Numbers in the order of doubles: halving between two of them ends at two neighbours after 64 steps. */
static int64_t rank_of(double x) {
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits < 0 ? INT64_MIN - bits : bits;
}

static double of_rank(int64_t rank) {
    const int64_t bits = rank < 0 ? INT64_MIN - rank : rank;
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* The end of where sign * f is below the value, or at most there (is_within). */
static double find_end(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                       const double *range, double sign, double value, bool is_within) {
    int64_t low = rank_of(range[0]);
    int64_t high = rank_of(range[1]);
    while (low < high - 1) {
        const int64_t middle = low / 2 + high / 2 + (low % 2 + high % 2) / 2;
        const double above = sign * (dalcs_shape_value(kinks, f, of_rank(middle)) - value);
        if (above < 0 || (is_within && above == 0)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return of_rank(is_within ? low : high);
}

double dalcs_shape_reach(const struct dalcs_kinks *kinks, const struct dalcs_formula *f, double low,
                         double high, double value) {
    const double first = dalcs_shape_value(kinks, f, low);
    const double last = dalcs_shape_value(kinks, f, high);
    const double sign = last > first ? 1 : -1;
    if (!(sign * first < sign * value && sign * value < sign * last)) {
        return NAN;
    }
    /* Rounding may give one value to many numbers: the one in the middle. */
    const double range[2] = {low, high};
    return 0.5 * find_end(kinks, f, range, sign, value, false) +
           0.5 * find_end(kinks, f, range, sign, value, true);
}

/* ---- Shapes -------------------------------------------------------------------------------------- */

static const struct dalcs_shape other = {.kind = DALCS_SHAPE_OTHER};

static struct dalcs_shape turn_over(struct dalcs_shape s) {
    static const enum dalcs_shape_kind turned[] = {
        [DALCS_SHAPE_OTHER] = DALCS_SHAPE_OTHER,    [DALCS_SHAPE_NUMBER] = DALCS_SHAPE_NUMBER,
        [DALCS_SHAPE_RISING] = DALCS_SHAPE_FALLING, [DALCS_SHAPE_FALLING] = DALCS_SHAPE_RISING,
        [DALCS_SHAPE_VALLEY] = DALCS_SHAPE_PEAK,    [DALCS_SHAPE_PEAK] = DALCS_SHAPE_VALLEY};

    s.kind = turned[s.kind];
    return s;
}

static bool has_centre(const struct dalcs_shape *s) {
    return s->kind == DALCS_SHAPE_VALLEY || s->kind == DALCS_SHAPE_PEAK;
}

static bool has_slope(const struct dalcs_shape *s) {
    return s->kind == DALCS_SHAPE_RISING || s->kind == DALCS_SHAPE_FALLING;
}

/* Of two that rise or fall. Where one ends before the other begins, there is the centre of the sum. */
static struct dalcs_shape add_slopes(struct dalcs_shape a, struct dalcs_shape b) {
    struct dalcs_shape sum = a;
    sum.is_curved = a.is_curved || b.is_curved;
    sum.from = fmin(a.from, b.from);
    sum.to = fmax(a.to, b.to);
    if (a.kind == b.kind) {
        return sum;
    }
    const struct dalcs_shape *first = a.to <= b.from ? &a : &b;
    const struct dalcs_shape *second = a.to <= b.from ? &b : &a;
    sum.kind = first->kind == DALCS_SHAPE_FALLING ? DALCS_SHAPE_VALLEY : DALCS_SHAPE_PEAK;
    sum.centre = second->from;
    return first->to <= second->from ? sum : other;
}

static struct dalcs_shape add(struct dalcs_shape a, struct dalcs_shape b) {
    if (a.kind == DALCS_SHAPE_NUMBER || b.kind == DALCS_SHAPE_NUMBER) {
        return a.kind == DALCS_SHAPE_NUMBER ? b : a;
    }
    if (has_slope(&a) && has_slope(&b)) {
        return add_slopes(a, b);
    }
    return has_centre(&a) && a.kind == b.kind && a.centre == b.centre ? a : other;
}

/* Of a function that rises (1) or falls (-1) where its argument is above 0, and below; 0: it has no value there. */
struct sides_of_zero {
    int above, below;
    bool has_pole; /* at 0 */
};

static struct dalcs_shape apply(const struct dalcs_kinks *kinks, const struct dalcs_formula *of,
                                struct dalcs_shape s, struct sides_of_zero by) {
    const bool is_above = by.has_pole ? s.low > 0 : s.low >= 0;
    const bool is_below = by.has_pole ? s.high < 0 : s.high <= 0;
    int sign = is_above ? by.above : is_below ? by.below : 0;
    sign = !by.has_pole && by.above == by.below ? by.above : sign;
    s.is_curved = true;
    if (s.kind == DALCS_SHAPE_NUMBER) {
        return s;
    }
    if (sign == 0 && has_slope(&s) && !by.has_pole && by.above * by.below < 0) {
        s.kind = DALCS_SHAPE_VALLEY;
        s.centre = dalcs_shape_reach(kinks, of, -DBL_MAX, DBL_MAX, 0);
        return by.above > 0 ? s : turn_over(s);
    }
    return sign == 0 ? other : sign > 0 ? s : turn_over(s);
}

/* Of a power: what it is of negative numbers differs from function to function, and between dialects. */
static struct sides_of_zero of_power(const struct dalcs_kinks *kinks, const char *name, double y) {
    const struct dalcs_function *function = dalcs_function_find(name, kinks->dialect);
    const double below = function != NULL && function->two != NULL ? function->two(-2, y) : NAN;
    const int above = y > 0 ? 1 : -1;
    return (struct sides_of_zero){.above = y == 0 ? 0 : above,
                                  .below = isnan(below) || y == 0 ? 0
                                           : below < 0            ? above
                                                                  : -above,
                                  .has_pole = y < 0};
}

/* Factors that are all alike: how many; 0: they are not. */
static int count_factors(const struct dalcs_formula *f, const struct dalcs_formula **base) {
    if (dalcs_formula_is_operation(f, DALCS_MULTIPLY)) {
        const int a = count_factors(f->argument[0], base);
        const int b = a > 0 ? count_factors(f->argument[1], base) : 0;
        return b > 0 ? a + b : 0;
    }
    const bool is = *base == NULL || dalcs_formula_is_same(*base, f);
    *base = f;
    return is ? 1 : 0;
}

static struct dalcs_shape of_product(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                                     int *n) {
    const struct dalcs_formula *base = NULL;
    const int count = count_factors(f, &base);
    *n -= count;
    return count == 0 ? other
                      : apply(kinks, base, read_shape(kinks, base, n),
                              (struct sides_of_zero){1, count % 2 == 1 ? 1 : -1, false});
}

static struct dalcs_shape of_call(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                                  int *n) {
    static const char *const rising[] = {"exp",      "sinh",   "asinh", "arcsinh",
                                         "atan",     "arctan", "tanh",  "logistic",
                                         "softplus", "cbrt",   NULL};
    static const char *const even[] = {"sqr", "square", "cosh", NULL};
    static const char *const powers[] = {"pow", "pwr", "pwrs", NULL};
    const bool is_power =
        dalcs_formula_is_operation(f, DALCS_POWER) || dalcs_formula_is_call_of(f, powers);
    const char *name = f->kind == DALCS_FORMULA_CALL ? f->function : "pow";
    struct sides_of_zero by = {0, 0, false};
    if (is_power && f->argument[1]->kind == DALCS_FORMULA_NUMBER) {
        by = of_power(kinks, name, f->argument[1]->number);
    } else if (dalcs_formula_is_call_of(f, rising)) {
        by = (struct sides_of_zero){1, 1, false};
    } else if (dalcs_formula_is_call_of(f, even)) {
        by = (struct sides_of_zero){1, -1, false};
    } else if (dalcs_formula_is_call(f, "sqrt")) {
        by = (struct sides_of_zero){1, 0, false};
    }
    return by.above == 0 ? other
                         : apply(kinks, f->argument[0], read_shape(kinks, f->argument[0], n), by);
}

static struct dalcs_shape of_operation(const struct dalcs_kinks *kinks,
                                       const struct dalcs_formula *f, int *n) {
    if (f->code == DALCS_ADD || f->code == DALCS_SUBTRACT) {
        const struct dalcs_shape a = read_shape(kinks, f->argument[0], n);
        const struct dalcs_shape b = read_shape(kinks, f->argument[1], n);
        return add(a, f->code == DALCS_ADD ? b : turn_over(b));
    }
    if (f->code == DALCS_MULTIPLY) {
        return of_product(kinks, f, n);
    }
    if (f->code == DALCS_DIVIDE && f->argument[0]->kind == DALCS_FORMULA_NUMBER) {
        const int sign = f->argument[0]->number > 0 ? -1 : 1;
        return apply(kinks, f->argument[1], read_shape(kinks, f->argument[1], n),
                     (struct sides_of_zero){sign, sign, true});
    }
    return f->code == DALCS_POWER ? of_call(kinks, f, n) : other;
}

/* max or min of the quantity and a number: it rises from there, or up to there. */
static struct dalcs_shape of_bound(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                                   int *n) {
    const int number = f->argument[0]->kind == DALCS_FORMULA_NUMBER ? 0 : 1;
    const bool is_max = dalcs_formula_is_call(f, "max");
    if (!(is_max || dalcs_formula_is_call(f, "min")) || f->n != 2 ||
        f->argument[number]->kind != DALCS_FORMULA_NUMBER) {
        return other;
    }
    const struct dalcs_formula *of = f->argument[1 - number];
    struct dalcs_shape s = read_shape(kinks, of, n);
    const double at =
        has_slope(&s) ? dalcs_shape_reach(kinks, of, -DBL_MAX, DBL_MAX, f->argument[number]->number)
                      : NAN;
    if (isnan(at)) {
        return other;
    }
    *(is_max == (s.kind == DALCS_SHAPE_RISING) ? &s.from : &s.to) = at;
    return s;
}

/* Between which numbers it is; another shape where they have no value. */
static void find_range(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                       struct dalcs_shape *s) {
    const double first = dalcs_shape_value(kinks, f, -DBL_MAX);
    const double last = dalcs_shape_value(kinks, f, DBL_MAX);
    const double centre = has_centre(s) ? dalcs_shape_value(kinks, f, s->centre) : first;
    s->low = fmin(fmin(first, last), centre);
    s->high = fmax(fmax(first, last), centre);
    s->kind = isnan(first) || isnan(last) || isnan(centre) ? DALCS_SHAPE_OTHER : s->kind;
}

static struct dalcs_shape read_shape(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                                     int *n) {
    const struct dalcs_formula_line line = dalcs_formula_read_line(f);
    struct dalcs_shape s = {.kind = DALCS_SHAPE_RISING, .from = -INFINITY, .to = INFINITY};
    *n -= 1;
    if (*n < 0) {
        return other;
    }
    if (line.of->kind == DALCS_FORMULA_NUMBER) {
        s.kind = DALCS_SHAPE_NUMBER;
    } else if (!dalcs_formula_is_same(line.of, kinks->quantity)) {
        s = line.of->kind == DALCS_FORMULA_OPERATION ? of_operation(kinks, line.of, n)
            : dalcs_kinks_is_call(line.of)           ? of_bound(kinks, line.of, n)
            : line.of->kind == DALCS_FORMULA_CALL    ? of_call(kinks, line.of, n)
                                                     : other;
    }
    s = line.slope > 0 ? s : turn_over(s);
    if (s.kind != DALCS_SHAPE_OTHER) {
        find_range(kinks, f, &s);
    }
    return s;
}

struct dalcs_shape dalcs_shape_read(const struct dalcs_kinks *kinks,
                                    const struct dalcs_formula *f) {
    int n = MOST_PARTS;
    return read_shape(kinks, f, &n);
}
