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
    bool failed;
};

static bool is_name(const struct dalcs_token *token, const struct dalcs_token *other) {
    const char *text = token != NULL ? token->text : "0";
    return strcmp(text, other->text) == 0 ||
           (strcmp(text, "gnd") == 0 && strcmp(other->text, "0") == 0);
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

static void refuse_signal(struct copying *c, const struct dalcs_formula *f) {
    const bool is_coil = c->card->letter == 'l';
    const char *name = c->card->token->text;
    const char *hint =
        is_coil
            ? dalcs_builder_hint(c->w->builder, "x and i(%s) are the current of the coil", name)
            : dalcs_builder_hint(c->w->builder, "x and v(%s,%s) are the voltage of the capacitor",
                                 c->card->token[1].text, c->card->token[2].text);
    dalcs_builder_error_at(c->w->builder, &f->where, hint,
                           is_coil ? "the flux of a coil depends on its own current alone"
                                   : "the charge of a capacitor depends on its own voltage alone");
    c->failed = true;
}

static const struct dalcs_formula *copy(struct copying *c, const struct dalcs_formula *f) {
    if (c->failed || c->copy[f->number_of] != NULL) {
        return c->failed ? NULL : c->copy[f->number_of];
    }
    const struct dalcs_formula *made = NULL;
    if (f->kind == DALCS_FORMULA_TIME) {
        made = c->argument;
    } else if (f->kind == DALCS_FORMULA_VOLTAGE || f->kind == DALCS_FORMULA_CURRENT) {
        const int direction = c->card != NULL ? direction_of(c, f) : 0;
        if (direction == 0) {
            refuse_signal(c, f);
            return NULL;
        }
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

const struct dalcs_formula *dalcs_storage_formula_copy(struct dalcs_formula_writer *w,
                                                       const struct dalcs_card *card,
                                                       const struct dalcs_formula *f,
                                                       const struct dalcs_formula *argument) {
    struct copying c = {.w = w, .argument = argument, .card = card};
    c.copy = dalcs_arena_alloc(&w->builder->scratch, (size_t)f->number_of + 1,
                               sizeof(const struct dalcs_formula *));
    if (c.copy == NULL || argument == NULL) {
        w->builder->out_of_memory = true;
        return NULL;
    }
    return copy(&c, f);
}
