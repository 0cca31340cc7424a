/* compile_call.c - calls in a formula: tables, waves, functions of one quantity. */
#include "behaviour.h"
#include "pi.h"

#include <math.h>
#include <string.h>

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
            return dalcs_compile_refuse(c, f->argument[k + 1],
                                        "those of table() may vary, up to 16 of them",
                                        "the points of this table are numbers");
        }
        const double number = argument[k + 1]->affine.constant;
        struct dalcs_knot *point = &knot[k / 2];
        if (k % 2 == 0) {
            point->at = number;
        } else {
            point->left = point->value = point->right = number;
        }
        if (k % 2 == 0 && k > 0 && !(number > knot[k / 2 - 1].at)) {
            return dalcs_compile_refuse_name(c, f,
                                             "table(x, x1, y1, x2, y2, ...) with x1 < x2 < ...",
                                             "the points of '%s' are not in order");
        }
    }
    if (f->n % 2 == 0 || n < 1) {
        return dalcs_compile_refuse_name(c, f, "table(x, x1, y1, x2, y2, ...) with x1 < x2 < ...",
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

/* Is it a piecewise function of one argument? *form: its; NULL: it could not be made. */
static bool compile_piecewise(struct dalcs_compiler *c, const struct dalcs_formula *f,
                              const struct dalcs_form *a, const struct dalcs_form **form) {
    if (is_named(f, "abs")) {
        *form = apply(c, (struct dalcs_knot[]){{0, 0, 0, 0}}, 1, -1, 1, a);
        return true;
    }
    if (is_named(f, "sgn")) {
        *form = apply(c, (struct dalcs_knot[]){{0, -1, 0, 1}}, 1, 0, 0, a);
        return true;
    }
    if (is_named(f, "u") || is_named(f, "stp") || is_named(f, "gt0") || is_named(f, "ge0")) {
        *form = dalcs_compile_compare(c, a, dalcs_form_number(c, 0), is_named(f, "ge0") ? 1 : 0);
        return true;
    }
    if (is_named(f, "lt0") || is_named(f, "le0")) {
        *form = dalcs_compile_compare(c, dalcs_form_number(c, 0), a, is_named(f, "le0") ? 1 : 0);
        return true;
    }
    if (is_named(f, "buf")) {
        *form = dalcs_compile_compare(c, a, dalcs_form_number(c, 0.5), 0);
        return true;
    }
    if (is_named(f, "inv")) {
        *form = dalcs_compile_compare(c, dalcs_form_number(c, 0.5), a, 1);
        return true;
    }
    if (is_named(f, "uramp")) {
        *form = apply(c, (struct dalcs_knot[]){{0, 0, 0, 0}}, 1, 0, 1, a);
        return true;
    }
    if (is_named(f, "u2")) {
        *form = apply(c, (struct dalcs_knot[]){{0, 0, 0, 0}, {1, 1, 1, 1}}, 2, 0, 0, a);
        return true;
    }
    return false;
}

const struct dalcs_form *dalcs_compile_call(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                            const struct dalcs_form **argument) {
    static const char *const points[] = {"eq0", "ne0"};
    const struct dalcs_form *a = argument[0];
    const struct dalcs_form *form;
    if (compile_piecewise(c, f, a, &form)) {
        return form;
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
        return dalcs_compile_refuse_name(
            c, f, "gt0, lt0, ge0 and le0 compare",
            "%s(...) of a quantity that varies differs at single points only");
    }
    enum dalcs_smooth_kind kind;
    if (dalcs_smooth_find(smooth_name(c, f), f->n, &kind)) {
        return dalcs_smooth_form(c, f, kind, f->n, argument);
    }
    return dalcs_compile_refuse_name(c, f, NULL,
                                     "%s(...) of a quantity that varies is not a smooth function");
}
