/* evaluate.c - runs the operations of an expression on a stack.
 *
 * A parameter that has no value yet ends the run (WAITS); the caller finds its value and starts again,
 * so that long chains of parameters need no recursion. A result that is not finite is an error at the
 * place of the operation that made it. */
#include "evaluation.h"
#include "foreign.h"

#include <math.h>
#include <string.h>

/* An expression that takes more goes round in circles. */
enum { MOST_OPERATIONS = 10000000 };

void dalcs_evaluation_report(const struct dalcs_evaluation *r, const struct dalcs_operation *o,
                             const char *hint, const char *format, ...) {
    struct dalcs_location where = dalcs_expression_place(&r->expression->text, o->begin, o->length);
    where.instance = r->scope->origin;
    va_list arguments;
    va_start(arguments, format);
    dalcs_diag_add_list(r->language->diag, DALCS_ERROR, &where, hint, format, arguments);
    va_end(arguments);
    r->language->deck->has_errors = true;
}

enum dalcs_outcome dalcs_evaluation_push(struct dalcs_language *language, double value) {
    if (dalcs_grow(&language->evaluation.stack, &language->evaluation.stack_capacity,
                   language->evaluation.n_stack + 1,
                   sizeof *language->evaluation.stack) != DALCS_OK) {
        language->out_of_memory = true;
        return DALCS_OUTCOME_WRONG;
    }
    language->evaluation.stack[language->evaluation.n_stack++] = value;
    return DALCS_OUTCOME_VALUE;
}

/* ---- Names ----------------------------------------------------------------------------------- */

bool dalcs_language_hides_names(const struct dalcs_language *language) {
    return language->netlist->misses_file || language->misses_assignment;
}

static const char *suggest_name(struct dalcs_language *language, struct dalcs_scope *scope,
                                const char *name) {
    if (dalcs_function_find(name, language->netlist->dialect.name) != NULL) {
        return dalcs_language_text(language, "'%s' is a function: write %s(...)", name, name);
    }
    if (strcmp(name, "time") == 0) {
        return "an expression here is a number that is known before the run";
    }
    for (const struct dalcs_scope *s = scope; s != NULL; s = s->caller) {
        const char *nearest = dalcs_names_nearest(&s->definition->parameters.names, name);
        if (nearest != NULL && strcmp(nearest, name) == 0) {
            return "the branch of .if that sets it was not chosen, or not yet";
        }
        if (nearest != NULL) {
            return dalcs_language_text(language, "did you mean '%s'?", nearest);
        }
    }
    return dalcs_language_suggest(language, &scope->definition->parameters.names, name,
                                  "parameters");
}

/* What a call gives may be said with what it gives besides, as in LTspice: X1 a b PWM Tdead=1u step=0.1*Tdead. */
static struct dalcs_value *find_beside(const struct dalcs_evaluation *r, const char *name) {
    const struct dalcs_language *language = r->language;
    const struct dalcs_value *now =
        language->sought.n > 0 ? language->sought.value[language->sought.n - 1] : NULL;
    const bool is_of_call = now != NULL && now->owner != NULL && now->where == r->scope;
    struct dalcs_value *value = is_of_call ? dalcs_scope_find_given(now->owner, name) : NULL;
    return value != now ? value : NULL;
}

static enum dalcs_outcome push_name(const struct dalcs_evaluation *r,
                                    const struct dalcs_operation *o) {
    struct dalcs_language *language = r->language;
    struct dalcs_value *value = dalcs_scope_find_value(r->scope, o->u.name);
    double constant;
    if (value == NULL && !dalcs_constant_find(o->u.name, &constant)) {
        value = find_beside(r, o->u.name);
    }
    if (value != NULL) {
        value->is_used = true;
        if (value->state == DALCS_VALUE_KNOWN) {
            return dalcs_evaluation_push(language, value->value);
        }
        language->sought.awaited = value;
        return value->state == DALCS_VALUE_WRONG ? DALCS_OUTCOME_WRONG : DALCS_OUTCOME_WAITS;
    }
    if (dalcs_constant_find(o->u.name, &constant)) {
        return dalcs_evaluation_push(language, constant);
    }
    if (dalcs_language_hides_names(language)) {
        return DALCS_OUTCOME_WRONG;
    }
    const struct dalcs_expression_text *text = &r->expression->text;
    const char *sign = dalcs_foreign_sign(text->text, (size_t)text->length);
    dalcs_evaluation_report(r, o, sign != NULL ? sign : suggest_name(language, r->scope, o->u.name),
                            "there is no parameter '%s'", o->u.name);
    return DALCS_OUTCOME_WRONG;
}

/* ---- Operators ------------------------------------------------------------------------------- */

static bool power(const struct dalcs_evaluation *r, const struct dalcs_operation *o, double x,
                  double y, double *value) {
    const bool is_even = floor(y / 2) == y / 2;
    if (x < 0 && !is_even) {
        dalcs_evaluation_report(r, o, "pow(x, y) is the power, pwr(x, y) that of the magnitude",
                                "a power of %.9g: ngspice takes the magnitude, others do not", x);
        return false;
    }
    *value = pow(fabs(x), y);
    return true;
}

/* x / y, x % y and x \ y. */
static bool divide(const struct dalcs_evaluation *r, const struct dalcs_operation *o, double x,
                   double y, double *value) {
    if (y == 0) {
        dalcs_evaluation_report(r, o, NULL, "division by 0");
        return false;
    }
    if (o->code == DALCS_QUOTIENT && x / y < 0) {
        dalcs_evaluation_report(r, o, "write int(x / y)", "a\\b of %.9g: ngspice drops its sign",
                                x / y);
        return false;
    }
    *value = o->code == DALCS_REMAINDER ? fmod(x, y) : x / y;
    *value = o->code == DALCS_QUOTIENT ? trunc(*value) : *value;
    return true;
}

static bool apply(const struct dalcs_evaluation *r, const struct dalcs_operation *o, double x,
                  double y, double *value) {
    switch (o->code) {
    case DALCS_ADD:
        *value = x + y;
        break;
    case DALCS_SUBTRACT:
        *value = x - y;
        break;
    case DALCS_MULTIPLY:
        *value = x * y;
        break;
    case DALCS_DIVIDE:
    case DALCS_REMAINDER:
    case DALCS_QUOTIENT:
        if (!divide(r, o, x, y, value)) {
            return false;
        }
        break;
    case DALCS_POWER:
        if (!power(r, o, x, y, value)) {
            return false;
        }
        break;
    case DALCS_EQUAL:
        *value = x == y;
        break;
    case DALCS_UNEQUAL:
        *value = x != y;
        break;
    case DALCS_LESS:
        *value = x < y;
        break;
    case DALCS_LESS_EQUAL:
        *value = x <= y;
        break;
    case DALCS_GREATER:
        *value = x > y;
        break;
    default:
        *value = x >= y;
        break;
    }
    if (!isfinite(*value)) {
        dalcs_evaluation_report(r, o, NULL, "the result is larger than any number here");
        return false;
    }
    return true;
}

static void unary(struct dalcs_language *language, enum dalcs_operation_code code) {
    double *top = language->evaluation.stack + (language->evaluation.n_stack - 1);
    *top = code == DALCS_NEGATE ? *top * -1 : code == DALCS_NOT ? *top == 0 : *top != 0;
}

static enum dalcs_outcome binary(const struct dalcs_evaluation *r,
                                 const struct dalcs_operation *o) {
    struct dalcs_language *language = r->language;
    double *top = language->evaluation.stack + (language->evaluation.n_stack - 2);
    double value;
    if (!apply(r, o, top[0], top[1], &value)) {
        return DALCS_OUTCOME_WRONG;
    }
    top[0] = value;
    language->evaluation.n_stack--;
    return DALCS_OUTCOME_VALUE;
}

/* A jump by what is on the stack: is it taken? */
static bool jumps(struct dalcs_language *language, enum dalcs_operation_code code) {
    double *top = language->evaluation.stack + (language->evaluation.n_stack - 1);
    const bool is_zero = *top == 0;
    const bool taken = code == DALCS_JUMP_OR ? !is_zero : is_zero;
    if (taken && code == DALCS_JUMP_OR) {
        *top = 1;
    }
    language->evaluation.n_stack -= code == DALCS_JUMP_IF_ZERO || !taken;
    return taken;
}

enum dalcs_outcome dalcs_evaluation_run(struct dalcs_evaluation *r) {
    struct dalcs_language *language = r->language;
    for (int k = 0; k < r->expression->n; k++) {
        const struct dalcs_operation *o = &r->expression->operation[k];
        enum dalcs_outcome outcome = DALCS_OUTCOME_VALUE;
        if (++language->evaluation.operations > MOST_OPERATIONS) {
            dalcs_evaluation_report(r, o, NULL, "this takes more than %d operations",
                                    MOST_OPERATIONS);
            return DALCS_OUTCOME_WRONG;
        }
        switch (o->code) {
        case DALCS_PUSH_NUMBER:
            outcome = dalcs_evaluation_push(language, o->u.number);
            break;
        case DALCS_PUSH_NAME:
            outcome = push_name(r, o);
            break;
        case DALCS_PUSH_ARGUMENT:
            outcome = dalcs_evaluation_push(language,
                                            language->evaluation.stack[r->base + (size_t)o->count]);
            break;
        case DALCS_NEGATE:
        case DALCS_NOT:
        case DALCS_TO_LOGIC:
            unary(language, o->code);
            break;
        case DALCS_JUMP:
            k += o->count - 1;
            break;
        case DALCS_JUMP_IF_ZERO:
        case DALCS_JUMP_AND:
        case DALCS_JUMP_OR:
            k += jumps(language, o->code) ? o->count - 1 : 0;
            break;
        case DALCS_PUSH_SIGNAL:
        case DALCS_SIGNAL_NAME:
        case DALCS_CHECK_CALL:
            outcome = dalcs_evaluation_check_call(r, o);
            break;
        case DALCS_CALL:
            outcome = dalcs_evaluation_call(r, o);
            break;
        default:
            outcome = binary(r, o);
            break;
        }
        if (outcome != DALCS_OUTCOME_VALUE) {
            return outcome;
        }
    }
    return DALCS_OUTCOME_VALUE;
}

enum dalcs_outcome dalcs_evaluate(struct dalcs_language *language, struct dalcs_scope *scope,
                                  const struct dalcs_expression *expression, double *value) {
    const size_t base = language->evaluation.n_stack;
    const uint32_t n_drawn = language->drawing.place.n;
    struct dalcs_evaluation r = {language, scope, expression, base};
    language->evaluation.operations = 0;
    const enum dalcs_outcome outcome = dalcs_evaluation_run(&r);
    if (outcome == DALCS_OUTCOME_VALUE) {
        *value = language->evaluation.stack[base];
    } else {
        language->drawing.place.n = n_drawn; /* it is evaluated again, or for nothing */
    }
    language->evaluation.n_stack = base;
    return outcome;
}
