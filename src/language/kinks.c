/* kinks.c - which parts of a formula are of one quantity, and have kinks. */
#include "kinks.h"

/* Written out, with shared parts as often as they are read: no person wrote a longer formula of one quantity. */
enum { MOST_PARTS = 1000 };

bool dalcs_kinks_is_step_call(const struct dalcs_formula *f) {
    static const char *const names[] = {"sgn", "u", "stp", "gt0", "lt0", "ge0", "le0", NULL};
    return dalcs_formula_is_call_of(f, names);
}

bool dalcs_kinks_is_call(const struct dalcs_formula *f) {
    static const char *const names[] = {"abs", "uramp", "max", "min", "limit", NULL};
    return dalcs_formula_is_call_of(f, names) || dalcs_kinks_is_step_call(f);
}

static bool is_smooth_call(const struct dalcs_formula *f) {
    static const char *const names[] = {
        "sin",    "cos",   "tan",    "asin",  "acos",     "atan",     "arcsin",    "arccos",
        "arctan", "atan2", "sinh",   "cosh",  "tanh",     "asinh",    "acosh",     "atanh",
        "sqrt",   "sqr",   "square", "cbrt",  "logistic", "softplus", "bernoulli", "exp",
        "ln",     "log",   "log10",  "hypot", "pow",      "pwr",      "pwrs",      NULL};
    return dalcs_formula_is_call_of(f, names);
}

static bool is_between(enum dalcs_operation_code code, enum dalcs_operation_code first,
                       enum dalcs_operation_code last) {
    return code >= first && code <= last;
}

bool dalcs_kinks_is_condition(const struct dalcs_formula *f) {
    return f->kind == DALCS_FORMULA_OPERATION &&
           (is_between(f->code, DALCS_LESS, DALCS_GREATER_EQUAL) || f->code == DALCS_NOT ||
            f->code == DALCS_TO_LOGIC || f->code == DALCS_JUMP_AND || f->code == DALCS_JUMP_OR);
}

/* ---- What parts are ------------------------------------------------------------------------------ */

/* Sums over the arguments of a part. */
struct arguments {
    bool is_other, has_kink, is_curved, are_stepped, has_step;
    int n_of_one; /* that are of the quantity, and no steps */
    double size;
};

static struct arguments read_arguments(struct dalcs_kinks *kinks, const struct dalcs_formula *f) {
    struct arguments all = {.is_other = f->n == 0, .are_stepped = true, .size = 1};
    for (int k = 0; k < f->n; k++) {
        const struct dalcs_kinks_part *of = dalcs_kinks_mark(kinks, f->argument[k]);
        const bool is_condition = f->kind == DALCS_FORMULA_CHOICE && k == 0;
        const bool counts = !is_condition && of->state == DALCS_KINKS_OF_ONE;
        all.is_other = all.is_other || of->state == DALCS_KINKS_OTHER;
        all.has_kink = all.has_kink || of->has_kink;
        all.has_step = all.has_step || of->has_step;
        all.is_curved = all.is_curved || of->is_curved;
        all.are_stepped = all.are_stepped && (of->is_stepped || !counts);
        all.n_of_one += counts && !of->is_stepped ? 1 : 0;
        all.size += of->size;
    }
    return all;
}

static struct dalcs_kinks_part read_operation(const struct dalcs_kinks *kinks,
                                              const struct dalcs_formula *f,
                                              const struct arguments *all) {
    struct dalcs_kinks_part part = {DALCS_KINKS_OF_ONE, all->has_kink, all->is_curved,
                                    all->are_stepped,   false,         0};
    const bool divides = f->code == DALCS_DIVIDE &&
                         kinks->part[f->argument[1]->number_of].state == DALCS_KINKS_OF_ONE &&
                         !kinks->part[f->argument[1]->number_of].is_stepped;
    if (dalcs_kinks_is_condition(f)) {
        part.state = all->is_curved ? DALCS_KINKS_OTHER : DALCS_KINKS_OF_ONE;
        part.has_kink = part.is_stepped = true;
    } else if (f->code == DALCS_MULTIPLY || f->code == DALCS_DIVIDE || f->code == DALCS_POWER) {
        part.is_curved = all->is_curved || all->n_of_one > 1 || divides ||
                         (f->code == DALCS_POWER && all->n_of_one > 0);
    } else if (f->code != DALCS_NEGATE && f->code != DALCS_ADD && f->code != DALCS_SUBTRACT) {
        part.state = DALCS_KINKS_OTHER;
    }
    return part;
}

static struct dalcs_kinks_part read_part(struct dalcs_kinks *kinks, const struct dalcs_formula *f) {
    const struct dalcs_formula *of = dalcs_formula_read_line(f).of;
    struct dalcs_kinks_part part = {.state = DALCS_KINKS_OF_ONE, .size = 1};
    if (f->kind == DALCS_FORMULA_NUMBER) {
        part.state = DALCS_KINKS_NUMBER;
        return part;
    }
    if (dalcs_formula_is_same(of, kinks->quantity)) {
        return part;
    }
    const struct arguments all = read_arguments(kinks, f);
    part = (struct dalcs_kinks_part){DALCS_KINKS_OF_ONE, all.has_kink, all.is_curved,
                                     all.are_stepped,    false,        0};
    if (f->kind == DALCS_FORMULA_OPERATION && !all.is_other) {
        part = read_operation(kinks, f, &all);
    } else if (f->kind == DALCS_FORMULA_CHOICE) {
        const struct dalcs_kinks_part *condition = &kinks->part[f->argument[0]->number_of];
        part.has_kink = true;
        part.state = condition->is_stepped ? DALCS_KINKS_OF_ONE : DALCS_KINKS_OTHER;
    } else if (dalcs_kinks_is_call(f)) {
        part.has_kink = true;
        part.is_stepped = part.is_stepped || dalcs_kinks_is_step_call(f);
        part.state = all.is_curved ? DALCS_KINKS_OTHER : DALCS_KINKS_OF_ONE;
    } else if (is_smooth_call(f)) {
        part.is_curved = !all.are_stepped;
    } else {
        part.state = DALCS_KINKS_OTHER;
    }
    part.has_step = all.has_step || dalcs_kinks_is_step_call(f);
    part.size = all.size;
    part.state = all.is_other || all.size > MOST_PARTS ? DALCS_KINKS_OTHER : part.state;
    return part;
}

const struct dalcs_kinks_part *dalcs_kinks_mark(struct dalcs_kinks *kinks,
                                                const struct dalcs_formula *f) {
    struct dalcs_kinks_part *part = &kinks->part[f->number_of];
    if (part->state == DALCS_KINKS_UNKNOWN) {
        *part = read_part(kinks, f);
    }
    return part;
}
