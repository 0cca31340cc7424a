/* kinks_values.c - values of a formula of one quantity on a side of its kinks, and where these are. */
#include "kinks.h"

#include <float.h>
#include <math.h>

typedef struct dalcs_kinks_value value;

int dalcs_kinks_chosen(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                       double side) {
    const bool is_limit = dalcs_formula_is_call(f, "limit");
    int chosen = 0;
    double found = dalcs_kinks_evaluate(kinks, f->argument[0], side, side).value;
    const double inner = found;
    for (int k = 1; k < f->n; k++) {
        const double other = dalcs_kinks_evaluate(kinks, f->argument[k], side, side).value;
        const bool is_above = is_limit ? k == 1 : dalcs_formula_is_call(f, "max");
        if (is_above ? other > found : other < found) {
            chosen = k;
            found = other;
        }
    }
    return is_limit && inner == found ? 0 : chosen;
}

static value of_line(const struct dalcs_formula *f, double x) {
    const struct dalcs_formula_line line = dalcs_formula_read_line(f);
    const bool is_number = line.of->kind == DALCS_FORMULA_NUMBER;
    const double of = is_number ? line.of->number : x;
    const double term = line.slope * of;
    return (value){term + line.constant, 2 * DBL_EPSILON * (fabs(term) + fabs(line.constant))};
}

static double of_one_or_two(const struct dalcs_function *f, const double *x) {
    return f->one != NULL ? f->one(x[0]) : f->two != NULL ? f->two(x[0], x[1]) : NAN;
}

/* By as much as the value varies where its arguments vary by their rounding. */
static value of_call(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                     const value *argument) {
    const char *name = f->kind == DALCS_FORMULA_CALL ? f->function : "pow";
    const struct dalcs_function *function = dalcs_function_find(name, kinks->dialect);
    if (function == NULL || f->n > 2) {
        return (value){NAN, NAN};
    }
    double x[2] = {argument[0].value, f->n > 1 ? argument[1].value : 0};
    value made = {of_one_or_two(function, x), 0};
    made.rounding = 2 * DBL_EPSILON * fabs(made.value);
    for (int k = 0; k < f->n; k++) {
        double most = 0;
        for (int sign = -1; sign <= 1; sign += 2) {
            x[k] = argument[k].value + sign * argument[k].rounding;
            most = fmax(most, fabs(of_one_or_two(function, x) - made.value));
        }
        x[k] = argument[k].value;
        made.rounding += most;
    }
    return made;
}

static value of_operation(enum dalcs_operation_code code, value a, value b) {
    value made = {NAN, 0};
    switch (code) {
    case DALCS_NEGATE:
        return (value){-a.value, a.rounding};
    case DALCS_ADD:
        made = (value){a.value + b.value, a.rounding + b.rounding};
        break;
    case DALCS_SUBTRACT:
        made = (value){a.value - b.value, a.rounding + b.rounding};
        break;
    case DALCS_MULTIPLY:
        made = (value){a.value * b.value, fabs(a.value) * b.rounding + fabs(b.value) * a.rounding};
        break;
    case DALCS_DIVIDE:
        made.value = a.value / b.value;
        made.rounding = (a.rounding + fabs(made.value) * b.rounding) / fabs(b.value);
        break;
    default:
        break;
    }
    made.rounding += DBL_EPSILON * fabs(made.value);
    return made;
}

static bool is_true(const struct dalcs_kinks *kinks, const struct dalcs_formula *f, double side) {
    const struct dalcs_formula *a = f->argument[0];
    const struct dalcs_formula *b = f->n > 1 ? f->argument[1] : NULL;
    const double left = dalcs_kinks_evaluate(kinks, a, side, side).value;
    const double right = b != NULL ? dalcs_kinks_evaluate(kinks, b, side, side).value : 0;
    switch (f->code) {
    case DALCS_LESS:
    case DALCS_LESS_EQUAL:
        return left < right;
    case DALCS_GREATER:
    case DALCS_GREATER_EQUAL:
        return left > right;
    case DALCS_JUMP_AND:
        return left != 0 && right != 0;
    case DALCS_JUMP_OR:
        return left != 0 || right != 0;
    default:
        return (left != 0) == (f->code == DALCS_TO_LOGIC);
    }
}

/* Of a part with kinks of its own. */
static value of_side(const struct dalcs_kinks *kinks, const struct dalcs_formula *f, double side,
                     double x) {
    const struct dalcs_formula *a = f->argument[0];
    const double sign = dalcs_kinks_evaluate(kinks, a, side, side).value;
    const bool is_below = dalcs_formula_is_call(f, "lt0") || dalcs_formula_is_call(f, "le0");
    const bool holds_at =
        sign == 0 && (dalcs_formula_is_call(f, "ge0") || dalcs_formula_is_call(f, "le0"));
    value made = {sign > 0 || holds_at ? 1 : 0, 0};
    if (dalcs_formula_is_call(f, "abs") || dalcs_formula_is_call(f, "uramp")) {
        const double below = dalcs_formula_is_call(f, "abs") ? -1 : 0;
        const value of = dalcs_kinks_evaluate(kinks, a, side, x);
        made = (value){(sign > 0 ? 1 : below) * of.value, of.rounding};
    } else if (dalcs_formula_is_call(f, "sgn")) {
        made.value = sign > 0 ? 1 : sign < 0 ? -1 : 0;
    } else if (is_below) {
        made.value = sign < 0 || holds_at ? 1 : 0;
    } else if (!dalcs_kinks_is_step_call(f)) {
        made =
            dalcs_kinks_evaluate(kinks, f->argument[dalcs_kinks_chosen(kinks, f, side)], side, x);
    }
    return made;
}

value dalcs_kinks_evaluate(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                           double side, double x) {
    const struct dalcs_formula *of = dalcs_formula_read_line(f).of;
    if (of->kind == DALCS_FORMULA_NUMBER || dalcs_formula_is_same(of, kinks->quantity)) {
        return of_line(f, x);
    }
    if (dalcs_kinks_is_condition(f)) {
        return (value){is_true(kinks, f, side) ? 1 : 0, 0};
    }
    if (f->kind == DALCS_FORMULA_CHOICE) {
        const bool is = dalcs_kinks_evaluate(kinks, f->argument[0], side, side).value != 0;
        return dalcs_kinks_evaluate(kinks, f->argument[is ? 1 : 2], side, x);
    }
    if (dalcs_kinks_is_call(f)) {
        return of_side(kinks, f, side, x);
    }
    value argument[2] = {{0, 0}, {0, 0}};
    for (int k = 0; k < f->n && k < 2; k++) {
        argument[k] = dalcs_kinks_evaluate(kinks, f->argument[k], side, x);
    }
    return f->kind == DALCS_FORMULA_CALL || f->code == DALCS_POWER
               ? of_call(kinks, f, argument)
               : of_operation(f->code, argument[0], argument[1]);
}

/* ---- Kinks --------------------------------------------------------------------------------------- */

double dalcs_kinks_between(double low, double high) {
    const bool has_low = isfinite(low);
    const bool has_high = isfinite(high);
    const double size = fmax(has_low ? fabs(low) : 0, has_high ? fabs(high) : 0);
    const double away = size > 0 ? size : 1;
    return has_low && has_high ? low + 0.5 * (high - low)
           : has_low           ? low + away
           : has_high          ? high - away
                               : 0;
}

/* slope * quantity + constant, of a part that is a line at `side`. */
struct line {
    double slope, constant;
};

static struct line line_at(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                           double side);

static struct line line_of_operation(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                                     double side) {
    const struct line a = line_at(kinks, f->argument[0], side);
    const struct line b = f->n > 1 ? line_at(kinks, f->argument[1], side) : (struct line){0, 0};
    switch (f->code) {
    case DALCS_NEGATE:
        return (struct line){-a.slope, -a.constant};
    case DALCS_ADD:
        return (struct line){a.slope + b.slope, a.constant + b.constant};
    case DALCS_SUBTRACT:
        return (struct line){a.slope - b.slope, a.constant - b.constant};
    case DALCS_MULTIPLY:
        return (struct line){a.slope * b.constant + b.slope * a.constant, a.constant * b.constant};
    case DALCS_DIVIDE:
        return (struct line){a.slope / b.constant, a.constant / b.constant};
    default:
        return (struct line){NAN, NAN};
    }
}

static struct line line_at(const struct dalcs_kinks *kinks, const struct dalcs_formula *f,
                           double side) {
    const struct dalcs_formula_line line = dalcs_formula_read_line(f);
    const bool is_number = line.of->kind == DALCS_FORMULA_NUMBER;
    if (is_number || dalcs_formula_is_same(line.of, kinks->quantity)) {
        return is_number ? (struct line){0, line.slope * line.of->number + line.constant}
                         : (struct line){line.slope, line.constant};
    }
    if (kinks->part[f->number_of].is_stepped) {
        return (struct line){0, dalcs_kinks_evaluate(kinks, f, side, side).value};
    }
    if (f->kind == DALCS_FORMULA_CHOICE) {
        const bool is = dalcs_kinks_evaluate(kinks, f->argument[0], side, side).value != 0;
        return line_at(kinks, f->argument[is ? 1 : 2], side);
    }
    if (dalcs_formula_is_call(f, "abs") || dalcs_formula_is_call(f, "uramp")) {
        const struct line of = line_at(kinks, f->argument[0], side);
        const double below = dalcs_formula_is_call(f, "abs") ? -1 : 0;
        const double factor = of.slope * side + of.constant > 0 ? 1 : below;
        return (struct line){factor * of.slope, factor * of.constant};
    }
    return f->kind == DALCS_FORMULA_CALL
               ? line_at(kinks, f->argument[dalcs_kinks_chosen(kinks, f, side)], side)
               : line_of_operation(kinks, f, side);
}

/* Where a is b, between two numbers and not at one of them but for rounding. */
static bool meet(struct line a, struct line b, double low, double high, double *at) {
    const double x = -(a.constant - b.constant) / (a.slope - b.slope);
    const double rounding = 16 * DBL_EPSILON * fabs(x);
    const bool is = x - rounding > low && x + rounding < high;
    *at = is ? x + 0.0 : *at;
    return is;
}

/* Of the part itself, whose arguments have none there. */
static bool find_own(const struct dalcs_kinks *kinks, const struct dalcs_formula *f, double low,
                     double high, double *at) {
    const double side = dalcs_kinks_between(low, high);
    const bool compares = dalcs_kinks_is_condition(f) && f->n > 1 && f->code >= DALCS_LESS &&
                          f->code <= DALCS_GREATER_EQUAL;
    bool has = false;
    if (f->kind == DALCS_FORMULA_CALL && dalcs_kinks_is_call(f) && f->n == 1) {
        return meet(line_at(kinks, f->argument[0], side), (struct line){0, 0}, low, high, at);
    }
    for (int k = 1; k < f->n && !has && (compares || dalcs_kinks_is_call(f)); k++) {
        for (int j = 0; j < k && !has; j++) {
            has = meet(line_at(kinks, f->argument[j], side), line_at(kinks, f->argument[k], side),
                       low, high, at);
        }
    }
    return has;
}

bool dalcs_kinks_find(const struct dalcs_kinks *kinks, const struct dalcs_formula *f, double low,
                      double high, double *at) {
    const double side = dalcs_kinks_between(low, high);
    if (!kinks->part[f->number_of].has_kink) {
        return false;
    }
    if (f->kind == DALCS_FORMULA_CHOICE) {
        if (dalcs_kinks_find(kinks, f->argument[0], low, high, at)) {
            return true;
        }
        const bool is = dalcs_kinks_evaluate(kinks, f->argument[0], side, side).value != 0;
        return dalcs_kinks_find(kinks, f->argument[is ? 1 : 2], low, high, at);
    }
    for (int k = 0; k < f->n; k++) {
        if (dalcs_kinks_find(kinks, f->argument[k], low, high, at)) {
            return true;
        }
    }
    return find_own(kinks, f, low, high, at);
}
