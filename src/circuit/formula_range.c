/* formula_range.c - bounds of the values that a formula can have, by interval arithmetic.
 *
 * Known are numbers, V sources to ground, what functions such as limit(), table() and sin() make of anything, and the
 * voltages of sources with such formulas. Currents and other nodes may have any value. */
#include "behaviour.h"

#include <math.h>
#include <string.h>

/* Of sources through sources, and parts that are looked at: more than any formula that a person wrote. */
enum { DEEPEST = 16, MOST_PARTS = 100000 };

struct search {
    const struct dalcs_compiler *compiler;
    bool may_change; /* may another value be put in the place of a source's stimulus? */
    int depth, n_parts;
};

static const struct dalcs_range anything = {-(double)INFINITY, (double)INFINITY};

static struct dalcs_range between(double a, double b) {
    return a <= b   ? (struct dalcs_range){a, b}
           : b <= a ? (struct dalcs_range){b, a}
                    : anything; /* not numbers */
}

static struct dalcs_range hull(struct dalcs_range a, struct dalcs_range b) {
    return between(fmin(a.low, b.low), fmax(a.high, b.high));
}

static struct dalcs_range sum(struct dalcs_range a, double sign, struct dalcs_range b) {
    const struct dalcs_range other = sign > 0 ? b : (struct dalcs_range){-b.high, -b.low};
    return between(a.low + other.low, a.high + other.high);
}

static struct dalcs_range product(struct dalcs_range a, struct dalcs_range b) {
    const double corner[] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    struct dalcs_range r = between(corner[0], corner[0]);
    for (int k = 1; k < 4; k++) {
        r = isnan(corner[k]) ? anything : hull(r, between(corner[k], corner[k]));
    }
    return r;
}

/* ---- Sources --------------------------------------------------------------------------------------- */

static struct dalcs_range range_of(struct search *search, const struct dalcs_formula *f);

/* A V source, and what .dc makes of it. */
static struct dalcs_range source_range(const struct search *search, int device) {
    const struct dalcs_circuit *c = search->compiler->builder->circuit;
    const struct dalcs_stimulus *s = &c->stimulus[c->device[device].stimulus];
    struct dalcs_range r;
    if (search->may_change || !dalcs_stimulus_bounds(s, &r.low, &r.high)) {
        return anything;
    }
    for (int k = 0; k < c->analyses.n_dc; k++) {
        const struct dalcs_sweep *sweep = &c->analyses.dc[k];
        for (int i = 0; sweep->device == device && i < 2 && sweep->spacing != DALCS_LISTED; i++) {
            const double end = i == 0 ? sweep->start : sweep->stop;
            r = hull(r, between(end, end));
        }
        for (int i = 0; sweep->device == device && i < sweep->n && sweep->spacing == DALCS_LISTED;
             i++) {
            r = hull(r, between(sweep->list[i], sweep->list[i]));
        }
    }
    return r;
}

static bool is_source(const struct dalcs_builder *builder, int device) {
    const struct dalcs_device *d = &builder->circuit->device[device];
    return (d->kind == DALCS_VSOURCE && d->stimulus >= 0) ||
           (d->kind == DALCS_VCVS && dalcs_behavioural_formula_of(builder, device) != NULL);
}

/* The source that decides the voltage of a node, against ground or else another node; -1: there is none. */
static int source_of(const struct search *search, int node) {
    struct dalcs_builder *builder = search->compiler->builder;
    const struct dalcs_circuit *c = builder->circuit;
    int k = dalcs_drivers_first(builder, node);
    while (k >= 0 && !is_source(builder, k)) {
        k = dalcs_drivers_next(builder, k);
    }
    for (int i = 0; i < c->n_devices && k < 0; i++) {
        const bool is_plus = c->device[i].node[0] == node && c->device[i].node[1] != node;
        k = is_plus && is_source(builder, i) ? i : -1;
    }
    return k;
}

static struct dalcs_range node_range(struct search *search, int node) {
    const int k = node > 0 ? source_of(search, node) : -1;
    if (node == 0 || k < 0 || search->depth >= DEEPEST) {
        return node == 0 ? between(0, 0) : anything;
    }
    const struct dalcs_builder *builder = search->compiler->builder;
    const struct dalcs_device *d = &builder->circuit->device[k];
    const struct dalcs_formula *formula =
        d->kind == DALCS_VCVS ? dalcs_behavioural_formula_of(builder, k) : NULL;
    const struct dalcs_range across = formula != NULL            ? range_of(search, formula)
                                      : d->kind == DALCS_VSOURCE ? source_range(search, k)
                                                                 : anything;
    search->depth++;
    const struct dalcs_range other = node_range(search, d->node[1]);
    search->depth--;
    return sum(other, 1, across);
}

static struct dalcs_range voltage_range(struct search *search, const struct dalcs_token *name) {
    const struct dalcs_names *nodes = &search->compiler->builder->elements.nodes;
    return name != NULL ? node_range(search, dalcs_names_find(nodes, name->text)) : between(0, 0);
}

/* ---- Parts of a formula ------------------------------------------------------------------------------ */

static struct dalcs_range operation_range(enum dalcs_operation_code code, struct dalcs_range a,
                                          struct dalcs_range b) {
    switch (code) {
    case DALCS_NEGATE:
        return between(-a.high, -a.low);
    case DALCS_ADD:
        return sum(a, 1, b);
    case DALCS_SUBTRACT:
        return sum(a, -1, b);
    case DALCS_MULTIPLY:
        return product(a, b);
    case DALCS_DIVIDE:
        return b.low > 0 || b.high < 0 ? product(a, between(1 / b.high, 1 / b.low)) : anything;
    case DALCS_REMAINDER:
    case DALCS_POWER:
        return anything;
    default:
        return between(0, 1); /* comparisons and logic */
    }
}

static bool is_of(const struct dalcs_formula *f, const char *const *names) {
    bool is = false;
    for (int k = 0; names[k] != NULL; k++) {
        is = is || strcmp(f->function, names[k]) == 0;
    }
    return is;
}

/* The least and the largest of several. */
static struct dalcs_range fold(struct search *search, const struct dalcs_formula *f,
                               double (*two)(double a, double b)) {
    struct dalcs_range r = range_of(search, f->argument[0]);
    for (int k = 1; k < f->n; k++) {
        const struct dalcs_range next = range_of(search, f->argument[k]);
        r = between(two(r.low, next.low), two(r.high, next.high));
    }
    return r;
}

static struct dalcs_range limit_range(struct search *search, const struct dalcs_formula *f) {
    const struct dalcs_range x = range_of(search, f->argument[0]);
    const struct dalcs_range ends =
        hull(range_of(search, f->argument[1]), range_of(search, f->argument[2]));
    return between(fmin(fmax(x.low, ends.low), ends.high), fmax(fmin(x.high, ends.high), ends.low));
}

static struct dalcs_range call_range(struct search *search, const struct dalcs_formula *f) {
    static const char *const logic[] = {"u",   "stp", "gt0", "ge0", "lt0",  "le0",    "eq0",
                                        "ne0", "buf", "inv", "u2",  "rand", "random", NULL};
    static const char *const within_one[] = {"sin", "cos", "tanh", "sgn", "white", NULL};
    static const char *const steps[] = {"int", "floor", "ceil", "nint", "round", NULL};
    const struct dalcs_range x = f->n > 0 ? range_of(search, f->argument[0]) : anything;
    if (is_of(f, logic)) {
        return between(0, 1);
    }
    if (is_of(f, within_one)) {
        return between(-1, 1);
    }
    if (is_of(f, steps)) {
        return between(floor(x.low), ceil(x.high));
    }
    if (strcmp(f->function, "abs") == 0) {
        return between(x.low > 0 ? x.low : x.high < 0 ? -x.high : 0, fmax(-x.low, x.high));
    }
    if (strcmp(f->function, "uramp") == 0) {
        return between(fmax(x.low, 0), fmax(x.high, 0));
    }
    if (strcmp(f->function, "limit") == 0 && f->n == 3) {
        return limit_range(search, f);
    }
    if ((strcmp(f->function, "table") == 0 || strcmp(f->function, "tbl") == 0) && f->n > 2) {
        struct dalcs_range r = range_of(search, f->argument[2]);
        for (int k = 4; k < f->n; k += 2) {
            r = hull(r, range_of(search, f->argument[k]));
        }
        return r;
    }
    return strcmp(f->function, "max") == 0   ? fold(search, f, fmax)
           : strcmp(f->function, "min") == 0 ? fold(search, f, fmin)
                                             : anything;
}

static struct dalcs_range range_of(struct search *search, const struct dalcs_formula *f) {
    if (search->depth >= DEEPEST || search->n_parts >= MOST_PARTS) {
        return anything;
    }
    struct dalcs_range r = anything;
    search->depth++;
    search->n_parts++;
    switch (f->kind) {
    case DALCS_FORMULA_NUMBER:
        r = between(f->number, f->number);
        break;
    case DALCS_FORMULA_VOLTAGE:
        r = sum(voltage_range(search, f->signal[0]), -1, voltage_range(search, f->signal[1]));
        break;
    case DALCS_FORMULA_OPERATION:
        r = operation_range(f->code, range_of(search, f->argument[0]),
                            f->n > 1 ? range_of(search, f->argument[1]) : anything);
        break;
    case DALCS_FORMULA_CHOICE:
        r = hull(range_of(search, f->argument[1]), range_of(search, f->argument[2]));
        break;
    case DALCS_FORMULA_CALL:
        r = call_range(search, f);
        break;
    default:
        break;
    }
    search->depth--;
    return r;
}

/* Does the script have a command that gives sources other values while the circuit stays? */
static bool script_alters(const struct dalcs_netlist *netlist) {
    bool alters = false;
    for (size_t k = 0; k < netlist->commands.n && !alters; k++) {
        const char *text = netlist->commands.line[k].text;
        text += strspn(text, " \t");
        alters = strncmp(text, "alter", 5) == 0 || strncmp(text, "dc ", 3) == 0;
    }
    return alters;
}

struct dalcs_range dalcs_formula_range(const struct dalcs_compiler *c,
                                       const struct dalcs_formula *f) {
    struct search search = {.compiler = c, .may_change = script_alters(c->builder->netlist)};
    return range_of(&search, f);
}
