/* evaluate.c - runs the operations of an expression on a stack.
 *
 * A parameter that has no value yet ends the run (WAITS); the caller finds its value and starts again,
 * so that long chains of parameters need no recursion. A result that is not finite is an error at the
 * place of the operation that made it. */
#include "language.h"

#include <math.h>
#include <string.h>

/* Functions that call functions: the depth is limited, for each level takes stack. */
enum { DEEPEST_CALL = 100, MOST_OPERATIONS = 10000000 };

/* One run: of an expression, or of a function's body with its arguments at stack[base]. */
struct run {
    struct dalcs_language *language;
    struct dalcs_scope *scope;
    const struct dalcs_expression *expression;
    size_t base;
};

static void report(const struct run *r, const struct dalcs_operation *o, const char *hint,
                   const char *format, ...) __attribute__((format(printf, 4, 5)));

static void report(const struct run *r, const struct dalcs_operation *o, const char *hint,
                   const char *format, ...) {
    struct dalcs_location where = dalcs_expression_place(&r->expression->text, o->begin, o->length);
    where.instance = r->scope->origin;
    va_list arguments;
    va_start(arguments, format);
    dalcs_diag_add_list(r->language->diag, DALCS_ERROR, &where, hint, format, arguments);
    va_end(arguments);
    r->language->deck->has_errors = true;
}

static bool push(struct dalcs_language *language, double value) {
    if (dalcs_grow(&language->stack, &language->stack_capacity, language->n_stack + 1,
                   sizeof *language->stack) != DALCS_OK) {
        language->out_of_memory = true;
        return false;
    }
    language->stack[language->n_stack++] = value;
    return true;
}

static enum dalcs_outcome outcome_of(bool ok) {
    return ok ? DALCS_OUTCOME_VALUE : DALCS_OUTCOME_WRONG;
}

/* ---- Names ----------------------------------------------------------------------------------- */

/* Was an error reported that may be why a name is not known? */
static bool hides_names(const struct dalcs_language *language) {
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
        const char *nearest = dalcs_names_nearest(&s->definition->parameters, name);
        if (nearest != NULL && strcmp(nearest, name) == 0) {
            return "the branch of .if that sets it was not chosen, or not yet";
        }
        if (nearest != NULL) {
            return dalcs_language_text(language, "did you mean '%s'?", nearest);
        }
    }
    return dalcs_language_suggest(language, &scope->definition->parameters, name, "parameters");
}

/* What a call gives may be said with what it gives besides, as in LTspice: X1 a b PWM Tdead=1u step=0.1*Tdead. */
static struct dalcs_value *find_beside(const struct run *r, const char *name) {
    const struct dalcs_language *language = r->language;
    const struct dalcs_value *now =
        language->n_sought > 0 ? language->sought[language->n_sought - 1] : NULL;
    const bool is_of_call = now != NULL && now->owner != NULL && now->where == r->scope;
    struct dalcs_value *value = is_of_call ? dalcs_scope_find_given(now->owner, name) : NULL;
    return value != now ? value : NULL;
}

static enum dalcs_outcome push_name(const struct run *r, const struct dalcs_operation *o) {
    struct dalcs_language *language = r->language;
    struct dalcs_value *value = dalcs_scope_find_value(r->scope, o->u.name);
    double constant;
    if (value == NULL && !dalcs_constant_find(o->u.name, &constant)) {
        value = find_beside(r, o->u.name);
    }
    if (value != NULL) {
        value->is_used = true;
        if (value->state == DALCS_VALUE_KNOWN) {
            return outcome_of(push(language, value->value));
        }
        language->awaited = value;
        return value->state == DALCS_VALUE_WRONG ? DALCS_OUTCOME_WRONG : DALCS_OUTCOME_WAITS;
    }
    if (dalcs_constant_find(o->u.name, &constant)) {
        return outcome_of(push(language, constant));
    }
    if (hides_names(language)) {
        return DALCS_OUTCOME_WRONG;
    }
    report(r, o, suggest_name(language, r->scope, o->u.name), "there is no parameter '%s'",
           o->u.name);
    return DALCS_OUTCOME_WRONG;
}

/* ---- Calls ----------------------------------------------------------------------------------- */

static enum dalcs_outcome run(struct run *r);

static bool check_count(const struct run *r, const struct dalcs_operation *o, int least, int most) {
    if (o->count >= least && o->count <= most) {
        return true;
    }
    report(r, o, NULL, "'%s' takes %s%d argument%s, not %d", o->u.name,
           least == most      ? ""
           : o->count < least ? "at least "
                              : "at most ",
           o->count < least ? least : most,
           o->count < least && least == 1 ? ""
           : most == 1                    ? ""
                                          : "s",
           o->count);
    return false;
}

static enum dalcs_outcome call_user(const struct run *r, const struct dalcs_operation *o,
                                    struct dalcs_user_function *function) {
    struct dalcs_language *language = r->language;
    if (!check_count(r, o, function->n_arguments, function->n_arguments)) {
        return DALCS_OUTCOME_WRONG;
    }
    if (function->is_active || language->call_depth >= DEEPEST_CALL) {
        report(r, o, NULL,
               function->is_active ? "function '%s' calls itself"
                                   : "functions call each other too deep, here '%s'",
               o->u.name);
        return DALCS_OUTCOME_WRONG;
    }
    if (!dalcs_scope_compile(language, NULL, function->body, function->n_tokens,
                             &function->arguments, &function->expression)) {
        return DALCS_OUTCOME_WRONG;
    }
    struct run inner = {language, r->scope, function->expression,
                        language->n_stack - (size_t)o->count};
    function->is_active = true;
    language->call_depth++;
    const enum dalcs_outcome outcome = run(&inner);
    language->call_depth--;
    function->is_active = false;
    if (outcome == DALCS_OUTCOME_VALUE) {
        /* The result takes the place of the arguments. */
        const double value = language->stack[language->n_stack - 1];
        language->n_stack = inner.base;
        return outcome_of(push(language, value));
    }
    return outcome;
}

static const char *suggest_function(const struct run *r, const char *name) {
    for (const struct dalcs_scope *s = r->scope; s != NULL; s = s->caller) {
        const char *nearest = dalcs_names_nearest(&s->definition->functions, name);
        if (nearest != NULL) {
            return dalcs_language_text(r->language, "did you mean '%s'?", nearest);
        }
    }
    const char *nearest = dalcs_function_nearest(name);
    return nearest != NULL ? dalcs_language_text(r->language, "did you mean '%s'?", nearest)
                           : dalcs_function_refusal(name);
}

/* A random value. */
static enum dalcs_outcome draw(const struct run *r, const struct dalcs_operation *o,
                               dalcs_draw *function) {
    struct dalcs_language *language = r->language;
    const double *x = /* without arguments there may be no stack */
        o->count > 0 ? &language->stack[language->n_stack - (size_t)o->count] : NULL;
    const double value = dalcs_drawn_next(language, function, x, o->count);
    if (!isfinite(value)) {
        report(r, o, dalcs_draw_usage(o->u.name), "a value of %s is not finite", o->u.name);
        return DALCS_OUTCOME_WRONG;
    }
    language->n_stack -= (size_t)o->count;
    return outcome_of(push(language, value));
}

/* LTspice's rand(x): the value at the whole number before x. */
static enum dalcs_outcome hold(struct dalcs_language *language) {
    double *x = &language->stack[language->n_stack - 1];
    *x = dalcs_draw_at(floor(*x));
    return DALCS_OUTCOME_VALUE;
}

static enum dalcs_outcome call(const struct run *r, const struct dalcs_operation *o) {
    struct dalcs_language *language = r->language;
    struct dalcs_user_function *user = dalcs_language_function(language, r->scope, o->u.name);
    bool is_random;
    dalcs_draw *drawn = dalcs_draw_find(o->u.name, o->count, &is_random);
    if (user != NULL) {
        return call_user(r, o, user);
    }
    if (drawn != NULL) {
        return draw(r, o, drawn);
    }
    if (is_random && o->count == 1 && strcmp(o->u.name, "rand") == 0) {
        return hold(language);
    }
    const struct dalcs_function *function =
        dalcs_function_find(o->u.name, language->netlist->dialect.name);
    if (function == NULL && hides_names(language)) {
        return DALCS_OUTCOME_WRONG;
    }
    if (function == NULL && is_random) {
        report(r, o, dalcs_draw_usage(o->u.name), "'%s' does not take %d argument%s", o->u.name,
               o->count, o->count == 1 ? "" : "s");
        return DALCS_OUTCOME_WRONG;
    }
    if (function == NULL) {
        report(r, o, suggest_function(r, o->u.name), "there is no function '%s'", o->u.name);
        return DALCS_OUTCOME_WRONG;
    }
    if (!check_count(r, o, function->least, function->most)) {
        return DALCS_OUTCOME_WRONG;
    }
    const double *x = &language->stack[language->n_stack - (size_t)o->count];
    const double value = function->one != NULL   ? function->one(x[0])
                         : function->two != NULL ? function->two(x[0], x[1])
                                                 : function->many(x, o->count);
    if (!isfinite(value)) {
        if (o->count == 1) {
            report(r, o, NULL, "%s(%.9g) is not %s", o->u.name, x[0],
                   isnan(value) ? "a number" : "finite");
        } else if (o->count == 2) {
            report(r, o, NULL, "%s(%.9g, %.9g) is not %s", o->u.name, x[0], x[1],
                   isnan(value) ? "a number" : "finite");
        } else {
            report(r, o, "table(x, x1, y1, x2, y2, ...) with x1 < x2 < ...",
                   "the points of '%s' are not in order", o->u.name);
        }
        return DALCS_OUTCOME_WRONG;
    }
    language->n_stack -= (size_t)o->count;
    return outcome_of(push(language, value));
}

/* Before the arguments of v(...), white(...) and the like, unless the netlist has such a function. */
static enum dalcs_outcome check_call(const struct run *r, const struct dalcs_operation *o) {
    if (dalcs_scope_find_function(r->scope, o->u.name) != NULL) {
        return DALCS_OUTCOME_VALUE;
    }
    report(r, o, dalcs_function_refusal(o->u.name), "'%s(...)' is not a number", o->u.name);
    return DALCS_OUTCOME_WRONG;
}

/* ---- Operators ------------------------------------------------------------------------------- */

static bool power(const struct run *r, const struct dalcs_operation *o, double x, double y,
                  double *value) {
    const bool is_even = floor(y / 2) == y / 2;
    if (x < 0 && !is_even) {
        report(r, o, "pow(x, y) is the power, pwr(x, y) that of the magnitude",
               "a power of %.9g: ngspice takes the magnitude, others do not", x);
        return false;
    }
    *value = pow(fabs(x), y);
    return true;
}

static bool apply(const struct run *r, const struct dalcs_operation *o, double x, double y,
                  double *value) {
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
        if (y == 0) {
            report(r, o, NULL, "division by 0");
            return false;
        }
        if (o->code == DALCS_QUOTIENT && x / y < 0) {
            report(r, o, "write int(x / y)", "a\\b of %.9g: ngspice drops its sign", x / y);
            return false;
        }
        *value = o->code == DALCS_REMAINDER ? fmod(x, y) : x / y;
        *value = o->code == DALCS_QUOTIENT ? trunc(*value) : *value;
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
        report(r, o, NULL, "the result is larger than any number here");
        return false;
    }
    return true;
}

static enum dalcs_outcome binary(const struct run *r, const struct dalcs_operation *o) {
    struct dalcs_language *language = r->language;
    double *top = &language->stack[language->n_stack - 2];
    double value;
    if (!apply(r, o, top[0], top[1], &value)) {
        return DALCS_OUTCOME_WRONG;
    }
    top[0] = value;
    language->n_stack--;
    return DALCS_OUTCOME_VALUE;
}

/* A jump by what is on the stack: is it taken? */
static bool jumps(struct dalcs_language *language, enum dalcs_operation_code code) {
    double *top = &language->stack[language->n_stack - 1];
    const bool is_zero = *top == 0;
    const bool taken = code == DALCS_JUMP_OR ? !is_zero : is_zero;
    if (taken && code == DALCS_JUMP_OR) {
        *top = 1;
    }
    language->n_stack -= code == DALCS_JUMP_IF_ZERO || !taken;
    return taken;
}

static enum dalcs_outcome run(struct run *r) {
    struct dalcs_language *language = r->language;
    for (int k = 0; k < r->expression->n; k++) {
        const struct dalcs_operation *o = &r->expression->operation[k];
        enum dalcs_outcome outcome = DALCS_OUTCOME_VALUE;
        if (++language->operations > MOST_OPERATIONS) {
            report(r, o, NULL, "this takes more than %d operations", MOST_OPERATIONS);
            return DALCS_OUTCOME_WRONG;
        }
        switch (o->code) {
        case DALCS_PUSH_NUMBER:
            outcome = outcome_of(push(language, o->u.number));
            break;
        case DALCS_PUSH_NAME:
            outcome = push_name(r, o);
            break;
        case DALCS_PUSH_ARGUMENT:
            outcome = outcome_of(push(language, language->stack[r->base + (size_t)o->count]));
            break;
        case DALCS_NEGATE:
            language->stack[language->n_stack - 1] *= -1;
            break;
        case DALCS_NOT:
            language->stack[language->n_stack - 1] = language->stack[language->n_stack - 1] == 0;
            break;
        case DALCS_TO_LOGIC:
            language->stack[language->n_stack - 1] = language->stack[language->n_stack - 1] != 0;
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
            outcome = check_call(r, o);
            break;
        case DALCS_CALL:
            outcome = call(r, o);
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
    const size_t base = language->n_stack;
    const uint32_t n_drawn = language->place.n;
    struct run r = {language, scope, expression, base};
    language->operations = 0;
    const enum dalcs_outcome outcome = run(&r);
    if (outcome == DALCS_OUTCOME_VALUE) {
        *value = language->stack[base];
    } else {
        language->place.n = n_drawn; /* it is evaluated again, or for nothing */
    }
    language->n_stack = base;
    return outcome;
}
