/* evaluate_call.c - calls in expressions that are numbers: functions of the netlist, built-in ones, random values. */
#include "evaluation.h"

#include <math.h>
#include <string.h>

/* Functions that call functions: the depth is limited, for each level takes stack. */
enum { DEEPEST_CALL = 100 };

static bool check_count(const struct dalcs_evaluation *r, const struct dalcs_operation *o,
                        int least, int most) {
    if (o->count >= least && o->count <= most) {
        return true;
    }
    dalcs_evaluation_report(r, o, NULL, "'%s' takes %s%d argument%s, not %d", o->u.name,
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

static enum dalcs_outcome call_user(const struct dalcs_evaluation *r,
                                    const struct dalcs_operation *o,
                                    struct dalcs_user_function *function) {
    struct dalcs_language *language = r->language;
    if (!check_count(r, o, function->n_arguments, function->n_arguments)) {
        return DALCS_OUTCOME_WRONG;
    }
    if (function->is_active || language->evaluation.call_depth >= DEEPEST_CALL) {
        dalcs_evaluation_report(r, o, NULL,
                                function->is_active
                                    ? "function '%s' calls itself"
                                    : "functions call each other too deep, here '%s'",
                                o->u.name);
        return DALCS_OUTCOME_WRONG;
    }
    if (!dalcs_scope_compile(language, NULL, function->body, function->n_tokens,
                             &function->arguments, &function->expression)) {
        return DALCS_OUTCOME_WRONG;
    }
    struct dalcs_evaluation inner = {language, r->scope, function->expression,
                                     language->evaluation.n_stack - (size_t)o->count};
    function->is_active = true;
    language->evaluation.call_depth++;
    const enum dalcs_outcome outcome = dalcs_evaluation_run(&inner);
    language->evaluation.call_depth--;
    function->is_active = false;
    if (outcome == DALCS_OUTCOME_VALUE) {
        /* The result takes the place of the arguments. */
        const double value = language->evaluation.stack[language->evaluation.n_stack - 1];
        language->evaluation.n_stack = inner.base;
        return dalcs_evaluation_push(language, value);
    }
    return outcome;
}

static const char *suggest_function(const struct dalcs_evaluation *r, const char *name) {
    if (strncmp(name, "spice_", strlen("spice_")) == 0) {
        return "write it as a source, Vname n 0 PULSE(...), and v(n) in the formula";
    }
    for (const struct dalcs_scope *s = r->scope; s != NULL; s = s->caller) {
        const char *nearest = dalcs_names_nearest(&s->definition->functions.names, name);
        if (nearest != NULL) {
            return dalcs_language_text(r->language, "did you mean '%s'?", nearest);
        }
    }
    const char *nearest = dalcs_function_nearest(name);
    return nearest != NULL ? dalcs_language_text(r->language, "did you mean '%s'?", nearest)
                           : dalcs_function_refusal(name);
}

/* A random value. */
static enum dalcs_outcome draw(const struct dalcs_evaluation *r, const struct dalcs_operation *o,
                               dalcs_draw *function) {
    struct dalcs_language *language = r->language;
    const double *x = /* without arguments there may be no stack */
        o->count > 0
            ? language->evaluation.stack + (language->evaluation.n_stack - (size_t)o->count)
            : NULL;
    const double value = dalcs_drawn_next(language, function, x, o->count);
    if (!isfinite(value)) {
        dalcs_evaluation_report(r, o, dalcs_draw_usage(o->u.name), "a value of %s is not finite",
                                o->u.name);
        return DALCS_OUTCOME_WRONG;
    }
    language->evaluation.n_stack -= (size_t)o->count;
    return dalcs_evaluation_push(language, value);
}

/* LTspice's rand(x): the value at the whole number before x. */
static enum dalcs_outcome hold(struct dalcs_language *language) {
    double *x = &language->evaluation.stack[language->evaluation.n_stack - 1];
    *x = dalcs_draw_at(floor(*x));
    return DALCS_OUTCOME_VALUE;
}

static void report_not_finite(const struct dalcs_evaluation *r, const struct dalcs_operation *o,
                              const double *x, double value) {
    if (o->count == 1) {
        dalcs_evaluation_report(r, o, NULL, "%s(%.9g) is not %s", o->u.name, x[0],
                                isnan(value) ? "a number" : "finite");
    } else if (o->count == 2) {
        dalcs_evaluation_report(r, o, NULL, "%s(%.9g, %.9g) is not %s", o->u.name, x[0], x[1],
                                isnan(value) ? "a number" : "finite");
    } else {
        dalcs_evaluation_report(r, o, "table(x, x1, y1, x2, y2, ...) with x1 < x2 < ...",
                                "the points of '%s' are not in order", o->u.name);
    }
}

enum dalcs_outcome dalcs_evaluation_call(const struct dalcs_evaluation *r,
                                         const struct dalcs_operation *o) {
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
    if (function == NULL && dalcs_language_hides_names(language)) {
        return DALCS_OUTCOME_WRONG;
    }
    if (function == NULL && is_random) {
        dalcs_evaluation_report(r, o, dalcs_draw_usage(o->u.name),
                                "'%s' does not take %d argument%s", o->u.name, o->count,
                                o->count == 1 ? "" : "s");
        return DALCS_OUTCOME_WRONG;
    }
    if (function == NULL) {
        dalcs_evaluation_report(r, o, suggest_function(r, o->u.name), "there is no function '%s'",
                                o->u.name);
        return DALCS_OUTCOME_WRONG;
    }
    if (!check_count(r, o, function->least, function->most)) {
        return DALCS_OUTCOME_WRONG;
    }
    const double *x = language->evaluation.stack + language->evaluation.n_stack - (size_t)o->count;
    const double value = function->one != NULL   ? function->one(x[0])
                         : function->two != NULL ? function->two(x[0], x[1])
                                                 : function->many(x, o->count);
    if (!isfinite(value)) {
        report_not_finite(r, o, x, value);
        return DALCS_OUTCOME_WRONG;
    }
    language->evaluation.n_stack -= (size_t)o->count;
    return dalcs_evaluation_push(language, value);
}

enum dalcs_outcome dalcs_evaluation_check_call(const struct dalcs_evaluation *r,
                                               const struct dalcs_operation *o) {
    if (dalcs_scope_find_function(r->scope, o->u.name) != NULL) {
        return DALCS_OUTCOME_VALUE;
    }
    dalcs_evaluation_report(r, o, dalcs_function_refusal(o->u.name), "'%s(...)' is not a number",
                            o->u.name);
    return DALCS_OUTCOME_WRONG;
}
