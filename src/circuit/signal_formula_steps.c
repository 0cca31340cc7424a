/* signal_formula_steps.c - formulas of signals: from operations to steps on a stack.
 *
 * Functions of the netlist are written out where they are called: their arguments are on the stack
 * then, and how high it is there is known. */
#include "pi.h"
#include "result_cards.h"
#include "signal_formula_card.h"

#include <stdlib.h>
#include <string.h>

/* Functions that write themselves out again and again: no person wrote such a formula. */
enum { DEEPEST_CALL = 100, MOST_STEPS = 100000 };

static void report(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                   const struct dalcs_operation *o, const char *hint, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

static void report(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                   const struct dalcs_operation *o, const char *hint, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    dalcs_signal_compilation_report(c, &e->text, o->begin, o->length, hint, format, arguments);
    va_end(arguments);
}

/* Adds a step after which the stack is `higher` than before. */
static void add(struct dalcs_signal_compilation *c, struct dalcs_signal_formula_step step,
                int higher) {
    if (dalcs_grow(&c->step, &c->step_capacity, c->n_steps + 1, sizeof *c->step) != DALCS_OK) {
        c->builder->out_of_memory = true;
        c->failed = true;
        return;
    }
    c->step[c->n_steps++] = step;
    c->height += higher;
    c->deepest = c->height > c->deepest ? c->height : c->deepest;
}

/* ---- Names and signals ----------------------------------------------------------------------- */

static const char *hint_for_name(const struct dalcs_signal_compilation *c, const char *name) {
    struct dalcs_builder *builder = c->builder;
    const struct dalcs_names *results = c->rules->results;
    const char *nearest = results != NULL ? dalcs_names_nearest(results, name) : NULL;
    if (nearest != NULL) {
        return dalcs_builder_hint(builder, "did you mean '%s'?", nearest);
    }
    if (dalcs_names_find(&builder->elements.nodes, name) >= 0) {
        return dalcs_builder_hint(builder, "write v(%s)", name);
    }
    if (dalcs_names_find(&builder->elements.devices, name) >= 0) {
        return dalcs_builder_hint(builder, "write i(%s)", name);
    }
    return results != NULL
               ? dalcs_builder_hint(builder, "measure it before this line: .meas tran %s AVG ...",
                                    name)
               : NULL;
}

static void add_name(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                     const struct dalcs_operation *o) {
    const struct dalcs_signal_formula_rules *rules = c->rules;
    const int signal = dalcs_signal_compilation_unmask(o->u.name);
    const int result = rules->results != NULL ? dalcs_names_find(rules->results, o->u.name) : -1;
    struct dalcs_signal_formula_step step = {.push = DALCS_PUT_VALUE};
    if (signal >= 0) {
        step.push = DALCS_PUT_SIGNAL;
        step.index = c->signal[signal];
        step.part = c->part[signal];
    } else if (result >= 0) {
        step.push = DALCS_PUT_RESULT;
        step.index = result;
    } else if (strcmp(o->u.name, rules->variable) == 0 && rules->no_signals == NULL) {
        step.push = DALCS_PUT_TIME;
    } else if (dalcs_deck_parameter(c->builder->deck, o->u.name, &step.number) ||
               dalcs_constant_find(o->u.name, &step.number)) {
        step.push = DALCS_PUT_VALUE;
    } else if (strcmp(o->u.name, "freq") == 0 && strcmp(rules->variable, "frequency") == 0 &&
               rules->no_signals == NULL) { /* LTspice's name for it, where no parameter has it */
        step.push = DALCS_PUT_TIME;
    } else {
        report(c, e, o, hint_for_name(c, o->u.name),
               rules->results != NULL ? "there is no parameter and no earlier measurement '%s'"
                                      : "there is no parameter '%s'",
               o->u.name);
        return;
    }
    add(c, step, 1);
    if (signal >= 0 && c->factor[signal] >= 0) {
        step.index = c->factor[signal];
        add(c, step, 1);
        add(c, (struct dalcs_signal_formula_step){.code = DALCS_MULTIPLY}, -1);
    }
}

/* v(...) or i(...) in a function of the netlist; its names follow. */
static void add_signal(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                       const struct dalcs_operation *o) {
    struct dalcs_token name[2];
    if (c->rules->no_signals != NULL) {
        report(c, e, o, NULL, "%s", c->rules->no_signals);
        return;
    }
    for (int k = 0; k < o->count; k++) {
        const struct dalcs_piece *piece = dalcs_expression_piece(&e->text, o[1 + k].begin);
        name[k] = (struct dalcs_token){.line = piece->line,
                                       .text = o[1 + k].u.name,
                                       .offset = piece->offset + o[1 + k].begin - piece->begin,
                                       .length = o[1 + k].length,
                                       .kind = DALCS_TOKEN_WORD};
    }
    const int index = dalcs_signal_compilation_find(c, *o->u.name == 'i', &name[0],
                                                    o->count > 1 ? &name[1] : NULL);
    if (index >= 0) {
        add(c, (struct dalcs_signal_formula_step){.push = DALCS_PUT_SIGNAL, .index = index}, 1);
    }
}

/* ---- Calls ----------------------------------------------------------------------------------- */

static void add_expression(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                           int arguments);

static void check_count(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                        const struct dalcs_operation *o, int least, int most) {
    if (o->count < least || o->count > most) {
        const int limit = o->count < least ? least : most;
        report(c, e, o, NULL, "'%s' takes %s%d argument%s, not %d", o->u.name,
               least == most      ? ""
               : o->count < least ? "at least "
                                  : "at most ",
               limit, limit == 1 ? "" : "s", o->count);
    }
}

/* A function of the netlist; false when there is none of this name. */
static bool write_out(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                      const struct dalcs_operation *o) {
    const struct dalcs_expression *body;
    int n_arguments;
    if (!dalcs_deck_function(c->builder->deck, o->u.name, &n_arguments, &body,
                             &c->builder->out_of_memory)) {
        return false;
    }
    if (body == NULL) {
        c->builder->failed = c->builder->failed || !c->builder->out_of_memory;
        c->failed = true;
        return true;
    }
    check_count(c, e, o, n_arguments, n_arguments);
    if (c->depth >= DEEPEST_CALL) {
        report(c, e, o, NULL, "functions call each other too deep, here '%s'", o->u.name);
    }
    if (!c->failed) {
        const int arguments = c->height - n_arguments;
        c->depth++;
        add_expression(c, body, arguments);
        c->depth--;
        add(c, (struct dalcs_signal_formula_step){.push = DALCS_PUT_DOWN, .index = arguments},
            -n_arguments);
    }
    return true;
}

/* LTspice's measurements have angles in degrees, unless a setting outside of the netlist says radians;
 * the formulas of its elements have radians. */
static bool has_degrees(const struct dalcs_signal_compilation *c, const char *name,
                        bool *is_inverse) {
    static const char *const of_angles[] = {"sin", "cos", "tan"};
    static const char *const to_angles[] = {"asin",   "acos",   "atan",  "atan2",
                                            "arcsin", "arccos", "arctan"};
    *is_inverse = dalcs_builder_is_one_of(name, to_angles, sizeof to_angles / sizeof to_angles[0]);
    return c->builder->netlist->dialect.name == DALCS_DIALECT_LTSPICE &&
           (*is_inverse ||
            dalcs_builder_is_one_of(name, of_angles, sizeof of_angles / sizeof of_angles[0]));
}

static void add_factor(struct dalcs_signal_compilation *c, double factor) {
    add(c, (struct dalcs_signal_formula_step){.push = DALCS_PUT_VALUE, .number = factor}, 1);
    add(c, (struct dalcs_signal_formula_step){.code = DALCS_MULTIPLY}, -1);
}

static void note_degrees(const struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                         const struct dalcs_operation *o) {
    const struct dalcs_location where = dalcs_expression_place(&e->text, o->begin, o->length);
    dalcs_diag_add(c->builder->diag, DALCS_NOTE, &where,
                   "for radians: sin(x*180/pi), atan(x)*pi/180",
                   "angles of measurements are in degrees, as LTspice has them");
}

static void add_call(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                     const struct dalcs_operation *o) {
    if (write_out(c, e, o)) {
        return;
    }
    const struct dalcs_function *function =
        dalcs_function_find(o->u.name, c->builder->netlist->dialect.name);
    if (function == NULL) {
        const char *nearest = dalcs_function_nearest(o->u.name);
        report(c, e, o,
               nearest != NULL ? dalcs_builder_hint(c->builder, "did you mean '%s'?", nearest)
                               : NULL,
               "there is no function '%s' for measurements", o->u.name);
        return;
    }
    check_count(c, e, o, function->least, function->most);
    bool is_inverse;
    const bool in_degrees = has_degrees(c, o->u.name, &is_inverse);
    if (in_degrees && !is_inverse) {
        add_factor(c, dalcs_pi / 180);
    }
    add(c,
        (struct dalcs_signal_formula_step){
            .code = o->code, .count = o->count, .function = function},
        1 - o->count);
    if (in_degrees && is_inverse) {
        add_factor(c, 180 / dalcs_pi);
    }
    if (in_degrees) {
        note_degrees(c, e, o);
    }
}

/* Of a function that other simulators have: is it the netlist's own? */
static void check_call(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                       const struct dalcs_operation *o) {
    const struct dalcs_expression *body;
    int n_arguments;
    if (!dalcs_deck_function(c->builder->deck, o->u.name, &n_arguments, &body,
                             &c->builder->out_of_memory)) {
        report(c, e, o, NULL, "there is no function '%s' for measurements", o->u.name);
    }
}

/* ---- Operations ------------------------------------------------------------------------------ */

static bool is_jump(const struct dalcs_operation *o) {
    return o->code >= DALCS_JUMP && o->code <= DALCS_JUMP_OR;
}

static void add_operation(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                          const struct dalcs_operation *o, int arguments) {
    switch (o->code) {
    case DALCS_PUSH_NUMBER:
        add(c, (struct dalcs_signal_formula_step){.push = DALCS_PUT_VALUE, .number = o->u.number},
            1);
        break;
    case DALCS_PUSH_NAME:
        add_name(c, e, o);
        break;
    case DALCS_PUSH_ARGUMENT:
        add(c,
            (struct dalcs_signal_formula_step){.push = DALCS_PUT_ARGUMENT,
                                               .index = arguments + o->count},
            1);
        break;
    case DALCS_PUSH_SIGNAL:
        add_signal(c, e, o);
        break;
    case DALCS_SIGNAL_NAME:
        break; /* add_signal has taken it */
    case DALCS_CHECK_CALL:
        check_call(c, e, o);
        break;
    case DALCS_CALL:
        add_call(c, e, o);
        break;
    case DALCS_NEGATE:
    case DALCS_NOT:
    case DALCS_TO_LOGIC:
        add(c, (struct dalcs_signal_formula_step){.code = o->code}, 0);
        break;
    default: /* takes a value off the stack, and so does a jump, or what it jumps over puts one on */
        add(c, (struct dalcs_signal_formula_step){.code = o->code, .count = o->count}, -1);
        break;
    }
}

/* Adds all of an expression; arguments: where those of its function begin on the stack. */
static void add_expression(struct dalcs_signal_compilation *c, const struct dalcs_expression *e,
                           int arguments) {
    size_t *start = dalcs_arena_alloc(&c->builder->scratch, (size_t)e->n + 1, sizeof *start);
    if (start == NULL) {
        c->builder->out_of_memory = true;
        c->failed = true;
        return;
    }
    for (int k = 0; k < e->n && !c->failed; k++) {
        start[k] = c->n_steps;
        add_operation(c, e, &e->operation[k], arguments);
        if (!c->failed && c->n_steps > MOST_STEPS) {
            report(c, e, &e->operation[k], NULL, "the formula is too long");
        }
    }
    start[e->n] = c->n_steps;
    for (int k = 0; k < e->n && !c->failed; k++) {
        const struct dalcs_operation *o = &e->operation[k];
        if (is_jump(o)) {
            c->step[start[k]].count = (int)(start[k + o->count] - start[k]);
        }
    }
}

/* ---- The whole ------------------------------------------------------------------------------- */

bool dalcs_signal_compilation_steps(struct dalcs_signal_compilation *c,
                                    const struct dalcs_expression *expression,
                                    struct dalcs_signal_formula *formula) {
    add_expression(c, expression, 0);
    if (!c->failed && c->deepest > DALCS_SIGNAL_FORMULA_DEEPEST) {
        report(c, expression, &expression->operation[expression->n - 1], NULL,
               "the formula is too long");
    }
    if (!c->failed) {
        dalcs_signal_compilation_finish(c, formula);
    }
    free(c->step);
    return !c->failed;
}
