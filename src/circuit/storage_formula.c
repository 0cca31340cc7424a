/* storage_formula.c - the formula of a flux or a charge: its values, and what it is with another argument. */
#include "formula_writer.h"
#include "storage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Values ---------------------------------------------------------------------------------------- */

static double operate(enum dalcs_operation_code code, double a, double b) {
    switch (code) {
    case DALCS_NEGATE:
        return -a;
    case DALCS_NOT:
        return a == 0 ? 1 : 0;
    case DALCS_ADD:
        return a + b;
    case DALCS_SUBTRACT:
        return a - b;
    case DALCS_MULTIPLY:
        return a * b;
    case DALCS_DIVIDE:
        return a / b;
    case DALCS_POWER:
        return pow(a, b);
    case DALCS_LESS:
        return a < b ? 1 : 0;
    case DALCS_LESS_EQUAL:
        return a <= b ? 1 : 0;
    case DALCS_GREATER:
        return a > b ? 1 : 0;
    case DALCS_GREATER_EQUAL:
        return a >= b ? 1 : 0;
    case DALCS_TO_LOGIC:
        return a != 0 ? 1 : 0;
    case DALCS_JUMP_AND:
        return a != 0 && b != 0 ? 1 : 0;
    case DALCS_JUMP_OR:
        return a != 0 || b != 0 ? 1 : 0;
    default:
        return (double)NAN; /* the compiler of formulas refuses it */
    }
}

static double call_at(const struct dalcs_builder *builder, const struct dalcs_formula *f,
                      double x) {
    const struct dalcs_function *function =
        dalcs_function_find(f->function, builder->netlist->dialect.name);
    double few[8];
    double *argument = f->n <= 8 ? few : dalcs_alloc((size_t)f->n, sizeof *argument);
    double value = (double)NAN;
    if (function != NULL && argument != NULL) {
        for (int k = 0; k < f->n; k++) {
            argument[k] = dalcs_storage_formula_at(builder, f->argument[k], x);
        }
        value = function->one != NULL    ? function->one(argument[0])
                : function->two != NULL  ? function->two(argument[0], argument[1])
                : function->many != NULL ? function->many(argument, f->n)
                                         : value;
    }
    if (argument != few) {
        free(argument);
    }
    return value;
}

double dalcs_storage_formula_at(const struct dalcs_builder *builder, const struct dalcs_formula *f,
                                double x) {
    double a;
    switch (f->kind) {
    case DALCS_FORMULA_NUMBER:
        return f->number;
    case DALCS_FORMULA_TIME:
    case DALCS_FORMULA_VOLTAGE:
        return x;
    case DALCS_FORMULA_OPERATION:
        a = dalcs_storage_formula_at(builder, f->argument[0], x);
        return operate(f->code, a,
                       f->n > 1 ? dalcs_storage_formula_at(builder, f->argument[1], x) : 0);
    case DALCS_FORMULA_CHOICE:
        a = dalcs_storage_formula_at(builder, f->argument[0], x);
        return dalcs_storage_formula_at(builder, f->argument[a != 0 ? 1 : 2], x);
    case DALCS_FORMULA_CALL:
        return call_at(builder, f, x);
    default:
        return (double)NAN;
    }
}

/* ---- A formula with another argument ----------------------------------------------------------------- */

struct copying {
    struct dalcs_formula_writer *w;
    const struct dalcs_formula **copy; /* by number_of, NULL before */
    const struct dalcs_formula *argument;

    /* What stands for the argument besides x; card NULL: nothing */
    const struct dalcs_card *card;
    bool keeps_others; /* other signals, and the time, stay what they are */
    bool failed;
};

static bool is_name(const struct dalcs_token *token, const struct dalcs_token *other) {
    const char *text = token != NULL ? token->text : "0";
    return strcmp(text, other->text) == 0 ||
           (strcmp(text, "gnd") == 0 && strcmp(other->text, "0") == 0);
}

/* NULL: ground. */
static bool is_same_node(const struct dalcs_token *a, const struct dalcs_token *b) {
    return (a == NULL || b == NULL) ? a == b : strcmp(a->text, b->text) == 0;
}

/* The argument as a signal names it: 1, or -1 where it is turned around; 0: it is another. */
static int direction_of(const struct copying *c, const struct dalcs_formula *f) {
    const struct dalcs_token *token = c->card->token;
    if (f->kind == DALCS_FORMULA_CURRENT) {
        return c->card->letter == 'l' && is_name(f->signal[0], token) ? 1 : 0;
    }
    if (c->card->letter != 'c') {
        return 0;
    }
    return is_name(f->signal[0], &token[1]) && is_name(f->signal[1], &token[2])   ? 1
           : is_name(f->signal[0], &token[2]) && is_name(f->signal[1], &token[1]) ? -1
                                                                                  : 0;
}

/* The same of a difference of two voltages, v(a) - v(b) or -v(b) + v(a), of one node each or beside one other. */
static int direction_of_difference(const struct copying *c, const struct dalcs_formula *f) {
    if (f->kind != DALCS_FORMULA_OPERATION || f->n != 2 || c->card == NULL ||
        c->card->letter != 'c') {
        return 0;
    }
    const struct dalcs_formula *a = f->argument[0];
    const struct dalcs_formula *b = f->argument[1];
    int sign = 1;
    if (f->code == DALCS_ADD) {
        sign = a->kind == DALCS_FORMULA_OPERATION && a->code == DALCS_NEGATE ? -1 : 1;
        const struct dalcs_formula **turned = sign < 0 ? &a : &b;
        if ((*turned)->kind != DALCS_FORMULA_OPERATION || (*turned)->code != DALCS_NEGATE) {
            return 0;
        }
        *turned = (*turned)->argument[0];
    } else if (f->code != DALCS_SUBTRACT) {
        return 0;
    }
    if (a->kind != DALCS_FORMULA_VOLTAGE || b->kind != DALCS_FORMULA_VOLTAGE ||
        !is_same_node(a->signal[1], b->signal[1])) {
        return 0;
    }
    const struct dalcs_formula difference = {.kind = DALCS_FORMULA_VOLTAGE,
                                             .signal = {a->signal[0], b->signal[0]}};
    return sign * direction_of(c, &difference);
}

static bool is_time(const struct dalcs_formula *f) {
    return f->kind == DALCS_FORMULA_CALL && strcmp(f->function, dalcs_formula_time_beside) == 0;
}

/* Of a slope alone: a flux or a charge may follow anything (dalcs_storage_follow). */
static void refuse_signal(struct copying *c, const struct dalcs_formula *f) {
    const bool is_coil = c->card->letter == 'l';
    const char *name = c->card->token->text;
    const char *hint =
        is_coil ? dalcs_builder_hint(c->w->builder,
                                     "write its flux, which may: Flux=x*...; x and i(%s) are its "
                                     "current",
                                     name)
                : dalcs_builder_hint(c->w->builder,
                                     "write its charge, which may: Q=x*...; x and v(%s,%s) are its "
                                     "voltage",
                                     c->card->token[1].text, c->card->token[2].text);
    dalcs_builder_error_at(c->w->builder, &f->where, hint,
                           is_coil ? "an inductance may depend on its own current only"
                                   : "a capacitance may depend on its own voltage only");
    c->failed = true;
}

static const struct dalcs_formula *copy(struct copying *c, const struct dalcs_formula *f) {
    if (c->failed || c->copy[f->number_of] != NULL) {
        return c->failed ? NULL : c->copy[f->number_of];
    }
    const struct dalcs_formula *made = NULL;
    const bool is_signal = f->kind == DALCS_FORMULA_VOLTAGE || f->kind == DALCS_FORMULA_CURRENT;
    const int direction = c->card == NULL ? 0
                          : is_signal     ? direction_of(c, f)
                                          : direction_of_difference(c, f);
    if (f->kind == DALCS_FORMULA_TIME) {
        made = c->argument;
    } else if (is_time(f) && c->keeps_others) {
        made = dalcs_formula_signal(c->w, DALCS_FORMULA_TIME, NULL, NULL);
    } else if (is_time(f) || (is_signal && direction == 0 && !c->keeps_others)) {
        refuse_signal(c, f);
        return NULL;
    } else if (direction != 0) {
        made = direction > 0 ? c->argument
                             : dalcs_formula_operation(c->w, DALCS_SUBTRACT,
                                                       dalcs_formula_number(c->w, 0), c->argument);
    } else {
        const struct dalcs_formula **argument = dalcs_arena_alloc(
            &c->w->builder->scratch, (size_t)f->n + 1, sizeof(const struct dalcs_formula *));
        for (int k = 0; argument != NULL && k < f->n; k++) {
            argument[k] = copy(c, f->argument[k]);
        }
        made = argument != NULL && !c->failed ? dalcs_formula_like(c->w, f, argument) : NULL;
    }
    if (made == NULL && !c->failed) {
        c->w->builder->out_of_memory = c->failed = true;
    }
    c->copy[f->number_of] = made;
    return made;
}

/* Does a part read another signal than the argument, or the time? seen: by number_of. */
static bool reads_others(const struct copying *c, const struct dalcs_formula *f, bool *seen) {
    if (seen[f->number_of]) {
        return false;
    }
    seen[f->number_of] = true;
    if (direction_of_difference(c, f) != 0) {
        return false;
    }
    const bool is_signal = f->kind == DALCS_FORMULA_VOLTAGE || f->kind == DALCS_FORMULA_CURRENT;
    bool reads = is_time(f) || (is_signal && direction_of(c, f) == 0);
    for (int k = 0; k < f->n && !reads; k++) {
        reads = reads_others(c, f->argument[k], seen);
    }
    return reads;
}

bool dalcs_storage_formula_follows(struct dalcs_builder *builder, const struct dalcs_card *card,
                                   const struct dalcs_formula *f) {
    const struct copying c = {.card = card};
    bool *seen = dalcs_arena_alloc(&builder->scratch, (size_t)f->number_of + 1, sizeof *seen);
    builder->out_of_memory = builder->out_of_memory || seen == NULL;
    return seen != NULL && reads_others(&c, f, seen);
}

const struct dalcs_formula *dalcs_storage_formula_copy(struct dalcs_formula_writer *w,
                                                       const struct dalcs_card *card,
                                                       const struct dalcs_formula *f,
                                                       const struct dalcs_formula *argument,
                                                       bool keeps_others) {
    struct copying c = {.w = w, .argument = argument, .card = card, .keeps_others = keeps_others};
    c.copy = dalcs_arena_alloc(&w->builder->scratch, (size_t)f->number_of + 1,
                               sizeof(const struct dalcs_formula *));
    if (c.copy == NULL || argument == NULL) {
        w->builder->out_of_memory = true;
        return NULL;
    }
    return copy(&c, f);
}
