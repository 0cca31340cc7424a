/* compile.c - formulas to values, operation by operation. What is not piecewise linear is a source of its own
 * (smooth_parts.c), or refused. */
#include "behaviour.h"

#include <math.h>

const struct dalcs_form *dalcs_compile_refuse(struct dalcs_compiler *c,
                                              const struct dalcs_formula *f, const char *hint,
                                              const char *what) {
    if (!c->failed && !c->is_silent) {
        dalcs_builder_error_at(c->builder, &f->where, hint, "%s", what);
    }
    c->failed = true;
    return NULL;
}

const struct dalcs_form *dalcs_compile_refuse_name(struct dalcs_compiler *c,
                                                   const struct dalcs_formula *f, const char *hint,
                                                   const char *format) {
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
               : dalcs_compile_refuse(
                     c, f, "an ideal switch S turns a voltage or a current on and off",
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
    return b->affine.constant == 0 ? dalcs_compile_refuse(c, f, NULL, "division by 0")
                                   : dalcs_form_scale(c, 1 / b->affine.constant, a);
}

const struct dalcs_form *dalcs_compile_compare(struct dalcs_compiler *c, const struct dalcs_form *a,
                                               const struct dalcs_form *b, double at_0) {
    struct dalcs_knot knot = {0, 0, at_0, 1};
    const struct dalcs_piecewise step = {.n = 1, .knot = &knot};
    const struct dalcs_form *result = dalcs_form_apply(c, &step, dalcs_form_add(c, a, -1, b));
    return dalcs_form_to_logic(c, result);
}

const struct dalcs_form *dalcs_compile_truth(struct dalcs_compiler *c, const struct dalcs_form *a) {
    const bool is_above_half =
        c->builder->netlist->dialect.name == DALCS_DIALECT_LTSPICE && a != NULL && a->height != 1;
    return is_above_half ? dalcs_compile_compare(c, a, dalcs_form_number(c, 0.5), 0)
                         : dalcs_form_to_logic(c, a);
}

static const struct dalcs_form *to_logic(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                         const struct dalcs_form *a) {
    const struct dalcs_form *logic = dalcs_compile_truth(c, a);
    if (logic == NULL) {
        return dalcs_compile_refuse(c, f, "write a comparison, such as v(a) > 0",
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
        return dalcs_compile_compare(c, a, b, 0);
    case DALCS_GREATER_EQUAL:
        return dalcs_compile_compare(c, a, b, 1);
    case DALCS_LESS:
        return dalcs_compile_compare(c, b, a, 0);
    case DALCS_LESS_EQUAL:
        return dalcs_compile_compare(c, b, a, 1);
    case DALCS_EQUAL:
    case DALCS_UNEQUAL:
        return dalcs_compile_refuse(c, f, "write a comparison with < or >",
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
        return dalcs_compile_refuse(
            c, f, "an ideal switch S chooses between two voltages",
            "the two values differ by what is not constant where the condition changes: "
            "no complementarity pairs make such a jump");
    }
    return dalcs_form_add(c, base, 1, product);
}

/* ---- Formulas -------------------------------------------------------------------------------------- */

/* The forms of all arguments; of a choice without its condition: that, or the opposite one, comes later. */
static const struct dalcs_form **compile_arguments(struct dalcs_compiler *c,
                                                   const struct dalcs_formula *f) {
    const struct dalcs_form **argument =
        dalcs_arena_alloc(c->arena, (size_t)f->n + 1, sizeof(const struct dalcs_form *));
    if (argument == NULL) {
        c->builder->out_of_memory = true;
        c->failed = true;
    }
    const int first = f->kind == DALCS_FORMULA_CHOICE ? 1 : 0;
    for (int k = first; k < f->n && !c->failed; k++) {
        argument[k] = dalcs_compile(c, f->argument[k]);
    }
    return argument;
}

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
    const struct dalcs_form **argument = compile_arguments(c, f);
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
        return dalcs_compile_call(c, f, argument);
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
