/* memory_parts.c - ddt(x), idt(x) and sdt(x) in a formula: the current of a capacitor that follows x, and the voltage of
 * one that x charges. What idt() begins at is added behind the capacitor, whose voltage is held at 0 where the run
 * starts; while a condition holds, a switch across it brings it back there. Where that varies, the capacitor itself begins
 * at it, and the switch leads to it. */
#include "analysis_cards.h"
#include "behaviour.h"
#include "model_cards.h"

#include <math.h>
#include <string.h>

struct dalcs_device *dalcs_memory_add_device(struct dalcs_compiler *c, enum dalcs_device_kind kind,
                                             const char *what, int from, int to) {
    struct dalcs_builder *builder = c->builder;
    const char *name = dalcs_arena_printf(&builder->scratch, "%s%d", what, c->n_nodes);
    struct dalcs_device *device =
        name != NULL && dalcs_builder_reserve_devices(builder, 1)
            ? dalcs_builder_add_inner_device(builder, kind, name, c->element)
            : NULL;
    if (device == NULL) {
        c->failed = true;
        return NULL;
    }
    device->node[0] = from;
    device->node[1] = to;
    return device;
}

static int add_capacitor(struct dalcs_compiler *c, const char *what, int node) {
    struct dalcs_device *device = dalcs_memory_add_device(c, DALCS_CAPACITOR, what, node, 0);
    if (device == NULL) {
        return -1;
    }
    device->value = dalcs_charging;
    return node;
}

/* A node whose voltage is the derivative of x; -1 after an error. */
static int add_derivative(struct dalcs_compiler *c, const struct dalcs_formula *x) {
    int source = -1;
    const int copy = dalcs_compiler_node_at(c, "copy", x, false, &source);
    const int rate = copy >= 0 ? dalcs_compiler_new_node(c, "rate") : -1;
    if (rate < 0 || add_capacitor(c, "copy", copy) < 0) {
        return -1;
    }
    struct dalcs_device *h = dalcs_memory_add_device(c, DALCS_CCVS, "rate", rate, 0);
    if (h == NULL) {
        return -1;
    }
    h->control = source;
    h->value = -1 / dalcs_charging;
    return rate;
}

/* To what it begins at, while the condition holds. */
static bool add_reset(struct dalcs_compiler *c, const struct dalcs_formula *condition, int state,
                      int first) {
    static const struct dalcs_switch_model model = {
        .name = "reset", .roff = (double)INFINITY, .vt = 0.5};
    int source;
    const int control = dalcs_compiler_node_at(c, "reset", condition, false, &source);
    struct dalcs_device *s =
        control >= 0 ? dalcs_memory_add_device(c, DALCS_SWITCH, "reset", state, first) : NULL;
    if (s == NULL) {
        return false;
    }
    s->node[2] = control;
    s->model = dalcs_switch_add_model(c->builder, &model);
    return s->model >= 0;
}

/* A node whose voltage is the integral of x, from 0 or, where that varies, from its second argument on; -1 after an
 * error. */
static int add_integral(struct dalcs_compiler *c, const struct dalcs_formula *f, bool varies) {
    int source;
    const int first =
        varies ? dalcs_compiler_node_at(c, "first", f->argument[1], false, &source) : 0;
    const int input = dalcs_compiler_node_at(c, "integrand", f->argument[0], false, &source);
    const int state = input >= 0 ? dalcs_compiler_new_node(c, "integral") : -1;
    if (first < 0 || state < 0 || add_capacitor(c, "integral", state) < 0) {
        return -1;
    }
    struct dalcs_device *g = dalcs_memory_add_device(c, DALCS_VCCS, "charge", 0, state);
    if (g == NULL) {
        return -1;
    }
    g->node[2] = input;
    g->value = dalcs_charging;
    dalcs_initial_hold(c->builder, c->element, (int[]){state, first}, 0);
    return f->n < 3 || add_reset(c, f->argument[2], state, first) ? state : -1;
}

bool dalcs_memory_is(const struct dalcs_formula *f) {
    int least;
    int most;
    return f->kind == DALCS_FORMULA_CALL && dalcs_function_remembers(f->function, &least, &most);
}

const struct dalcs_form *dalcs_memory_form(struct dalcs_compiler *c,
                                           const struct dalcs_formula *f) {
    const bool is_derivative = strcmp(f->function, "ddt") == 0;
    const struct dalcs_form *first = f->n > 1 ? dalcs_compile(c, f->argument[1]) : NULL;
    if (c->is_silent || c->smooth_node == NULL || c->failed) {
        c->failed = true;
        return NULL;
    }
    const bool varies = first != NULL && !dalcs_form_is_number(first);
    if (varies && strcmp(f->function, "idtmod") == 0) {
        dalcs_builder_error_at(c->builder, &f->argument[1]->where, NULL,
                               "the initial value of '%s' must be a number", f->function);
        c->failed = true;
        return NULL;
    }
    if (strcmp(f->function, "idtmod") == 0 && f->n > 2) {
        return dalcs_wrapped_integral_form(c, f, first->affine.constant);
    }
    int *node = &c->smooth_node[f->number_of];
    if (*node == 0) {
        const int made =
            is_derivative ? add_derivative(c, f->argument[0]) : add_integral(c, f, varies);
        c->failed = c->failed || made < 0;
        *node = made > 0 ? made : 0;
    }
    struct dalcs_affine v = dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, *node);
    v.constant = first != NULL && !varies ? first->affine.constant : 0;
    return c->failed ? NULL : dalcs_form_affine(c, &v);
}
