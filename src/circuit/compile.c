/* compile.c - formulas to values, operation by operation. What is not piecewise linear is a source of its own
 * (smooth_parts.c), or refused. */
#include "behaviour.h"
#include "pi.h"

#include <math.h>
#include <string.h>

static const struct dalcs_form *refuse(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                       const char *hint, const char *what) {
    if (!c->failed && !c->is_silent) {
        dalcs_builder_error_at(c->builder, &f->where, hint, "%s", what);
    }
    c->failed = true;
    return NULL;
}

static const struct dalcs_form *refuse_name(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                            const char *hint, const char *format) {
    if (!c->failed && !c->is_silent) {
        dalcs_builder_error_at(c->builder, &f->where, hint, format, f->function);
    }
    c->failed = true;
    return NULL;
}

/* ---- Signals ------------------------------------------------------------------------------------- */

static const struct dalcs_form *voltage(struct dalcs_compiler *c, const struct dalcs_formula *f) {
    const int plus = dalcs_builder_find_node(c->builder, f->signal[0]);
    const int minus = f->signal[1] != NULL ? dalcs_builder_find_node(c->builder, f->signal[1]) : 0;
    if (plus < 0 || minus < 0) {
        c->failed = true;
        return NULL;
    }
    struct dalcs_affine sum = dalcs_affine_constant(0);
    for (int k = 0; k < 2; k++) {
        const int node = k == 0 ? plus : minus;
        const struct dalcs_affine v = dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, node);
        sum = node != 0 ? dalcs_affine_add(c, &sum, k == 0 ? 1 : -1, &v) : sum;
    }
    return dalcs_form_affine(c, &sum);
}

static const struct dalcs_form *current(struct dalcs_compiler *c, const struct dalcs_formula *f) {
    const int device = dalcs_builder_find_device(c->builder, f->signal[0]);
    if (device < 0) {
        c->failed = true;
        return NULL;
    }
    const int of = c->builder->elements.current_of[device];
    const struct dalcs_affine i = dalcs_affine_of(c, DALCS_QUANTITY_CURRENT, of);
    return dalcs_form_affine(c, &i);
}

/* ---- Operations ---------------------------------------------------------------------------------- */

static const struct dalcs_form *multiply(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                         const struct dalcs_form *a, const struct dalcs_form *b) {
    const struct dalcs_form *product;
    const enum dalcs_product kind = dalcs_form_multiply(c, a, b, &product);
    for (int k = 0; kind != DALCS_PRODUCT_IS && f->code == DALCS_MULTIPLY && k < 2; k++) {
        const struct dalcs_commutation what = {.steps = f->argument[k],
                                               .quantity = f->argument[1 - k]};
        product = dalcs_commutate(c, &what);
        if (product != NULL || c->failed) {
            return product;
        }
    }
    if (kind == DALCS_PRODUCT_IS_CURVED && f->code == DALCS_MULTIPLY) {
        return dalcs_smooth_form(c, f, DALCS_SMOOTH_PRODUCT, 2,
                                 (const struct dalcs_form *[]){a, b});
    }
    return kind == DALCS_PRODUCT_IS
               ? product
               : refuse(c, f, "an ideal switch S turns a voltage or a current on and off",
                        "the height of this jump is not constant: complementarity pairs cannot "
                        "describe it");
}

static const struct dalcs_form *divide(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                       const struct dalcs_form *a, const struct dalcs_form *b) {
    const struct dalcs_form *over = dalcs_form_is_number(b) ? NULL : dalcs_form_reciprocal(c, b);
    if (over != NULL) {
        const struct dalcs_commutation what = {
            .steps = f->argument[1], .quantity = f->argument[0], .is_over = true};
        const struct dalcs_form *product;
        const enum dalcs_product kind = dalcs_form_multiply(c, a, over, &product);
        product = kind == DALCS_PRODUCT_IS ? product : dalcs_commutate(c, &what);
        if (product != NULL || c->failed) {
            return product;
        }
    }
    if (!dalcs_form_is_number(b)) {
        return dalcs_smooth_form(c, f, DALCS_SMOOTH_QUOTIENT, 2,
                                 (const struct dalcs_form *[]){a, b});
    }
    return b->affine.constant == 0 ? refuse(c, f, NULL, "division by 0")
                                   : dalcs_form_scale(c, 1 / b->affine.constant, a);
}

/* a > b; at equality over a whole range it is `at_0`. */
static const struct dalcs_form *compare(struct dalcs_compiler *c, const struct dalcs_form *a,
                                        const struct dalcs_form *b, double at_0) {
    struct dalcs_knot knot = {0, 0, at_0, 1};
    const struct dalcs_piecewise step = {.n = 1, .knot = &knot};
    const struct dalcs_form *result = dalcs_form_apply(c, &step, dalcs_form_add(c, a, -1, b));
    return dalcs_form_to_logic(c, result);
}

const struct dalcs_form *dalcs_compile_truth(struct dalcs_compiler *c, const struct dalcs_form *a) {
    const bool is_above_half =
        c->builder->netlist->dialect.name == DALCS_DIALECT_LTSPICE && a != NULL && a->height != 1;
    return is_above_half ? compare(c, a, dalcs_form_number(c, 0.5), 0) : dalcs_form_to_logic(c, a);
}

static const struct dalcs_form *to_logic(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                         const struct dalcs_form *a) {
    const struct dalcs_form *logic = dalcs_compile_truth(c, a);
    if (logic == NULL) {
        return refuse(c, f, "write a comparison, such as v(a) > 0",
                      "a condition that is true unless a quantity is exactly 0");
    }
    return logic;
}

static const struct dalcs_form *logic_of(struct dalcs_compiler *c, const struct dalcs_formula *f) {
    return to_logic(c, f, dalcs_compile(c, f));
}

/* 1 where f is false. Of comparisons it is the opposite ones, by De Morgan: so its 0 is exact, whatever it multiplies. */
static const struct dalcs_form *opposite(struct dalcs_compiler *c, const struct dalcs_formula *f) {
    const enum dalcs_operation_code code = f->kind == DALCS_FORMULA_OPERATION ? f->code : DALCS_ADD;
    const struct dalcs_form *a;
    const struct dalcs_form *b;
    switch (code) {
    case DALCS_NOT:
        return logic_of(c, f->argument[0]);
    case DALCS_TO_LOGIC:
        return opposite(c, f->argument[0]);
    case DALCS_JUMP_AND:
    case DALCS_JUMP_OR:
        a = opposite(c, f->argument[0]);
        b = a != NULL ? opposite(c, f->argument[1]) : NULL;
        return b == NULL                ? NULL
               : code == DALCS_JUMP_AND ? dalcs_form_either(c, a, b)
                                        : multiply(c, f, a, b);
    default:
        a = logic_of(c, f);
        return a != NULL ? dalcs_form_negated(c, a) : NULL;
    }
}

static const struct dalcs_form *operation(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                          const struct dalcs_form *a, const struct dalcs_form *b) {
    const struct dalcs_form *x;
    const struct dalcs_form *y;
    switch (f->code) {
    case DALCS_NEGATE:
        return dalcs_form_scale(c, -1, a);
    case DALCS_ADD:
        return dalcs_form_add(c, a, 1, b);
    case DALCS_SUBTRACT:
        return dalcs_form_add(c, a, -1, b);
    case DALCS_MULTIPLY:
        return multiply(c, f, a, b);
    case DALCS_DIVIDE:
        return divide(c, f, a, b);
    case DALCS_POWER:
        return dalcs_form_is_number(b) && b->affine.constant == 1
                   ? a
                   : dalcs_smooth_form(c, f, DALCS_SMOOTH_POWER, 2,
                                       (const struct dalcs_form *[]){a, b});
    case DALCS_GREATER:
        return compare(c, a, b, 0);
    case DALCS_GREATER_EQUAL:
        return compare(c, a, b, 1);
    case DALCS_LESS:
        return compare(c, b, a, 0);
    case DALCS_LESS_EQUAL:
        return compare(c, b, a, 1);
    case DALCS_EQUAL:
    case DALCS_UNEQUAL:
        return refuse(c, f, "write a comparison with < or >",
                      "two quantities that vary are equal at single points only");
    case DALCS_NOT:
        return opposite(c, f->argument[0]);
    case DALCS_TO_LOGIC:
        return to_logic(c, f->argument[0], a);
    case DALCS_JUMP_AND:
    case DALCS_JUMP_OR:
        x = to_logic(c, f->argument[0], a);
        y = x != NULL ? to_logic(c, f->argument[1], b) : NULL;
        if (y == NULL) {
            return NULL;
        }
        return f->code == DALCS_JUMP_AND ? multiply(c, f, x, y) : dalcs_form_either(c, x, y);
    default:
        return NULL; /* a remainder is a staircase */
    }
}

/* condition ? a : b = b + condition (a - b) = a + not condition (b - a). What the difference is added to is exact where the
 * other is not chosen: it is the smaller, since next to a large one it would be rounding. */
static const struct dalcs_form *choice(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                       const struct dalcs_form *a, const struct dalcs_form *b) {
    const bool is_opposite = dalcs_form_largest(a) < dalcs_form_largest(b);
    const struct dalcs_form *base = is_opposite ? a : b;
    const struct dalcs_form *logic =
        is_opposite ? opposite(c, f->argument[0]) : logic_of(c, f->argument[0]);
    const struct dalcs_form *difference =
        logic != NULL ? dalcs_form_add(c, is_opposite ? b : a, -1, base) : NULL;
    const struct dalcs_form *product;
    if (difference == NULL) {
        return NULL;
    }
    if (dalcs_form_multiply(c, logic, difference, &product) != DALCS_PRODUCT_IS) {
        const struct dalcs_commutation what = {.of = f,
                                               .steps = f->argument[0],
                                               .quantity = f->argument[is_opposite ? 2 : 1],
                                               .less = f->argument[is_opposite ? 1 : 2],
                                               .is_condition = true,
                                               .is_opposite = is_opposite};
        product = dalcs_commutate(c, &what);
        if (product != NULL || c->failed) {
            return product != NULL ? dalcs_form_add(c, base, 1, product) : NULL;
        }
        return refuse(c, f, "an ideal switch S chooses between two voltages",
                      "the two values differ by what is not constant where the condition changes: "
                      "no complementarity pairs make such a jump");
    }
    return dalcs_form_add(c, base, 1, product);
}

/* ---- Functions ------------------------------------------------------------------------------------- */

static const struct dalcs_form *apply(struct dalcs_compiler *c, struct dalcs_knot *knot, int n,
                                      double before, double after, const struct dalcs_form *a) {
    const struct dalcs_piecewise outer = {.n = n, .knot = knot, .before = before, .after = after};
    return dalcs_form_apply(c, &outer, a);
}

/* table(x, x1, y1, ...), constant outside; pwl the same with lines that go on. */
static const struct dalcs_form *table(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                      const struct dalcs_form **argument, bool goes_on) {
    const int n = (f->n - 1) / 2;
    struct dalcs_knot *knot = dalcs_arena_alloc(c->arena, (size_t)n, sizeof *knot);
    if (knot == NULL) {
        c->builder->out_of_memory = true;
        c->failed = true;
        return NULL;
    }
    for (int k = 0; k < 2 * n; k++) {
        if (!dalcs_form_is_number(argument[k + 1])) {
            return refuse(c, f->argument[k + 1], NULL, "the points of a table are numbers");
        }
        const double number = argument[k + 1]->affine.constant;
        struct dalcs_knot *point = &knot[k / 2];
        if (k % 2 == 0) {
            point->at = number;
        } else {
            point->left = point->value = point->right = number;
        }
        if (k % 2 == 0 && k > 0 && !(number > knot[k / 2 - 1].at)) {
            return refuse_name(c, f, "table(x, x1, y1, x2, y2, ...) with x1 < x2 < ...",
                               "the points of '%s' are not in order");
        }
    }
    if (f->n % 2 == 0 || n < 1) {
        return refuse_name(c, f, "table(x, x1, y1, x2, y2, ...) with x1 < x2 < ...",
                           "the points of '%s' are not in order");
    }
    const struct dalcs_piecewise inside = {.n = n, .knot = knot};
    const bool has_slopes = goes_on && n > 1;
    return apply(c, knot, n, has_slopes ? dalcs_piecewise_slope(&inside, 1) : 0,
                 has_slopes ? dalcs_piecewise_slope(&inside, n - 1) : 0, argument[0]);
}

/* sin, cos and falling exp of a straight line in time. */
static const struct dalcs_form *wave(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                     const struct dalcs_form *a) {
    const double rate = a->affine.term[0].coefficient;
    const double offset = a->affine.constant;
    if (*f->function != 'e') {
        const struct dalcs_wave w = {.frequency = rate / (2 * dalcs_pi),
                                     .phase = offset / (2 * dalcs_pi) +
                                              (*f->function == 'c' ? 0.25 : 0)};
        return dalcs_wave_value(c, &w);
    }
    const struct dalcs_wave w = {.decay = -rate, .phase = 0.25};
    return dalcs_form_scale(c, exp(offset), dalcs_wave_value(c, &w));
}

static const struct dalcs_form *
fold(struct dalcs_compiler *c, const struct dalcs_formula *f, const struct dalcs_form **argument,
     const struct dalcs_form *(*two)(struct dalcs_compiler *c, const struct dalcs_form *a,
                                     const struct dalcs_form *b)) {
    const struct dalcs_form *result = argument[0];
    for (int k = 1; k < f->n && result != NULL; k++) {
        result = two(c, result, argument[k]);
    }
    return result;
}

static bool is_named(const struct dalcs_formula *f, const char *name) {
    return strcmp(f->function, name) == 0;
}

/* As the table of functions has it, where dialects differ. */
static const char *smooth_name(const struct dalcs_compiler *c, const struct dalcs_formula *f) {
    const struct dalcs_function *function =
        dalcs_function_find(f->function, c->builder->netlist->dialect.name);
    return function != NULL ? function->name : f->function;
}

static const struct dalcs_form *call(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                     const struct dalcs_form **argument) {
    static const char *const points[] = {"eq0", "ne0"};
    const struct dalcs_form *a = argument[0];
    if (is_named(f, "abs")) {
        return apply(c, (struct dalcs_knot[]){{0, 0, 0, 0}}, 1, -1, 1, a);
    }
    if (is_named(f, "sgn")) {
        return apply(c, (struct dalcs_knot[]){{0, -1, 0, 1}}, 1, 0, 0, a);
    }
    if (is_named(f, "u") || is_named(f, "stp") || is_named(f, "gt0") || is_named(f, "ge0")) {
        return compare(c, a, dalcs_form_number(c, 0), is_named(f, "ge0") ? 1 : 0);
    }
    if (is_named(f, "lt0") || is_named(f, "le0")) {
        return compare(c, dalcs_form_number(c, 0), a, is_named(f, "le0") ? 1 : 0);
    }
    if (is_named(f, "buf")) {
        return compare(c, a, dalcs_form_number(c, 0.5), 0);
    }
    if (is_named(f, "inv")) {
        return compare(c, dalcs_form_number(c, 0.5), a, 1);
    }
    if (is_named(f, "uramp")) {
        return apply(c, (struct dalcs_knot[]){{0, 0, 0, 0}}, 1, 0, 1, a);
    }
    if (is_named(f, "u2")) {
        return apply(c, (struct dalcs_knot[]){{0, 0, 0, 0}, {1, 1, 1, 1}}, 2, 0, 0, a);
    }
    if (is_named(f, "max")) {
        return fold(c, f, argument, dalcs_form_max);
    }
    if (is_named(f, "min")) {
        return fold(c, f, argument, dalcs_form_min);
    }
    if (is_named(f, "limit")) {
        const struct dalcs_form *low = dalcs_form_min(c, argument[1], argument[2]);
        const struct dalcs_form *high = dalcs_form_max(c, argument[1], argument[2]);
        return dalcs_form_min(c, dalcs_form_max(c, a, low), high);
    }
    if (is_named(f, "table") || is_named(f, "tbl") || is_named(f, "pwl")) {
        return table(c, f, argument, is_named(f, "pwl"));
    }
    const bool is_of_time = a->n == 0 && dalcs_affine_is_time(&a->affine);
    const bool is_exponential =
        is_named(f, "exp") && is_of_time && a->affine.term[0].coefficient <= 0;
    if (is_exponential || (is_of_time && (is_named(f, "sin") || is_named(f, "cos")))) {
        return wave(c, f, a);
    }
    if ((is_named(f, "pow") || is_named(f, "pwrs")) && dalcs_form_is_number(argument[1]) &&
        argument[1]->affine.constant == 1) {
        return a;
    }
    if (dalcs_builder_is_one_of(f->function, points, sizeof points / sizeof points[0])) {
        return refuse_name(c, f, "gt0, lt0, ge0 and le0 compare",
                           "%s(...) of a quantity that varies differs at single points only");
    }
    enum dalcs_smooth_kind kind;
    if (dalcs_smooth_find(smooth_name(c, f), f->n, &kind)) {
        return dalcs_smooth_form(c, f, kind, f->n, argument);
    }
    return refuse_name(c, f, NULL, "%s(...) of a quantity that varies is not a smooth function");
}

/* ---- Formulas -------------------------------------------------------------------------------------- */

static const struct dalcs_form *compile_new(struct dalcs_compiler *c,
                                            const struct dalcs_formula *f) {
    if (f->kind == DALCS_FORMULA_CALL && f->n == 1 && dalcs_function_is_noise(f->function)) {
        return dalcs_noise_form(c, f);
    }
    if (dalcs_delay_is(f) && f->n >= 2) {
        return dalcs_delay_form(c, f);
    }
    const struct dalcs_form *carrier = dalcs_carrier(c, f);
    if (carrier != NULL) {
        return carrier;
    }
    if (dalcs_memory_is(f)) {
        return dalcs_memory_form(c, f);
    }
    const struct dalcs_form **argument =
        dalcs_arena_alloc(c->arena, (size_t)f->n + 1, sizeof(const struct dalcs_form *));
    if (argument == NULL) {
        c->builder->out_of_memory = true;
        c->failed = true;
    }
    const int first = f->kind == DALCS_FORMULA_CHOICE
                          ? 1
                          : 0; /* its condition, or the opposite one, comes later */
    for (int k = first; k < f->n && !c->failed; k++) {
        argument[k] = dalcs_compile(c, f->argument[k]);
    }
    if (c->failed) {
        return NULL;
    }
    if (dalcs_staircase_is(f)) {
        return dalcs_staircase_form(c, f, argument);
    }
    struct dalcs_affine time;
    switch (f->kind) {
    case DALCS_FORMULA_NUMBER:
        return dalcs_form_number(c, f->number);
    case DALCS_FORMULA_VOLTAGE:
        return voltage(c, f);
    case DALCS_FORMULA_CURRENT:
        return current(c, f);
    case DALCS_FORMULA_TIME:
        time = dalcs_affine_of(c, DALCS_QUANTITY_TIME, 0);
        return dalcs_form_affine(c, &time);
    case DALCS_FORMULA_OPERATION:
        return operation(c, f, argument[0], argument[1]);
    case DALCS_FORMULA_CHOICE:
        return choice(c, f, argument[1], argument[2]);
    case DALCS_FORMULA_CALL:
        return call(c, f, argument);
    }
    return NULL;
}

const struct dalcs_form *dalcs_compile(struct dalcs_compiler *c,
                                       const struct dalcs_formula *formula) {
    const struct dalcs_form **known = &c->form_of[formula->number_of];
    if (*known == NULL && !c->failed) {
        *known = compile_new(c, formula);
    }
    return *known;
}
