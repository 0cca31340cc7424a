/* commutate.c - products of a step and a quantity that varies: an ideal switch makes them.
 *
 *     L q, L a step from 0 to 1:   a node whose current source of v(node) - q is shorted where L is 0
 *
 * Where the switch is open no current flows, so the node is at q; where it is closed the node is at 0.
 * In both the source gives no power. No complementarity pair does that: the height of a jump of pairs
 * is a number. The switch changes sides where L passes one half, and both are parts of the card. */
#include "behaviour.h"
#include "model_cards.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 4, MOST_NODES = 64 };

/* One that is on below one half. */
static int add_model(struct dalcs_builder *builder) {
    return dalcs_switch_add_model(builder, &(struct dalcs_switch_model){.name = "commutation",
                                                                        .roff = (double)INFINITY,
                                                                        .ilimit = (double)INFINITY,
                                                                        .vt = -0.5,
                                                                        .is_inverted = true});
}

/* ---- Steps ------------------------------------------------------------------------------------- */

/* low + (high - low) u(v - their middle): of a node that has no other values. */
static const struct dalcs_form *two_values(struct dalcs_compiler *c, const struct dalcs_form *v,
                                           double low, double high) {
    struct dalcs_knot knot = {0.5 * (low + high), fmin(low, high), low, fmax(low, high)};
    const struct dalcs_piecewise step = {.n = 1, .knot = &knot};
    return dalcs_form_apply(c, &step, v);
}

/* May .dc, .ac or .tf give it any other value? */
static bool is_varied(const struct dalcs_compiler *c, const struct dalcs_stimulus *s) {
    const struct dalcs_circuit *circuit = c->builder->circuit;
    const struct dalcs_transfer_card *tf = &circuit->analyses.transfer;
    const int output = tf->present ? tf->output_device : -1;
    return circuit->analyses.n_dc > 0 || s->ac_real != 0 || s->ac_imaginary != 0 ||
           (tf->present && s == &circuit->stimulus[circuit->device[tf->source].stimulus]) ||
           (output >= 0 && s == &circuit->stimulus[circuit->device[output].stimulus]);
}

/* A pulse whose edges take no time, or so little that they are steps at their middles. */
static const struct dalcs_form *pulse(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                      const struct dalcs_form *v, const struct dalcs_stimulus *s) {
    if (s->kind != DALCS_STIMULUS_PULSE) {
        return NULL;
    }
    const double edges = fmax(s->u.pulse.rise, s->u.pulse.fall);
    const double shortest = fmin(s->u.pulse.width, s->u.pulse.period - s->u.pulse.width);
    const bool is_free =
        is_varied(c, s) || (s->has_dc && s->dc != s->u.pulse.low && s->dc != s->u.pulse.high);
    if (is_free || s->u.pulse.low == s->u.pulse.high || !(edges <= 0.05 * shortest)) {
        return NULL;
    }
    if (edges > 0 && c->depth == 0) {
        dalcs_builder_warn_at(c->builder, &f->where, "write rise and fall times of 0",
                              "as a factor this pulse is a step at the middle of each edge, which "
                              "lasts up to %g s",
                              edges);
    }
    return two_values(c, v, s->u.pulse.low, s->u.pulse.high);
}

/* The values of another source with a formula, where there are two. */
static const struct dalcs_form *formula_steps(struct dalcs_compiler *c,
                                              const struct dalcs_formula *formula,
                                              const struct dalcs_form *v) {
    struct dalcs_compiler other;
    if (c->depth >= DEEPEST ||
        !dalcs_compiler_start_inner(c, &other, (size_t)formula->number_of + 1)) {
        return NULL;
    }
    other.is_silent = true;
    other.depth = DEEPEST;
    const struct dalcs_levels *levels = dalcs_levels_of(&other, dalcs_compile(&other, formula));
    const bool is_one = levels != NULL && levels->n == 1 && !other.failed;
    other.failed = c->failed; /* the other source will say itself what is wrong with it */
    dalcs_compiler_finish_inner(c, &other);
    return is_one ? two_values(c, v, levels->base, levels->base + levels->level[0].height) : NULL;
}

/* What a source between this node and ground makes of its voltage, where it has two values. */
static const struct dalcs_form *source_steps(struct dalcs_compiler *c,
                                             const struct dalcs_formula *f, int node) {
    const struct dalcs_circuit *circuit = c->builder->circuit;
    const struct dalcs_affine voltage = dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, node);
    const struct dalcs_form *v = dalcs_form_affine(c, &voltage);
    for (int k = dalcs_drivers_first(c->builder, node); k >= 0 && v != NULL;
         k = dalcs_drivers_next(c->builder, k)) {
        const struct dalcs_device *device = &circuit->device[k];
        if (device->kind == DALCS_VSOURCE && device->stimulus >= 0) {
            const struct dalcs_stimulus *s = &circuit->stimulus[device->stimulus];
            const bool is_number = s->kind == DALCS_STIMULUS_DC && !is_varied(c, s);
            return is_number ? dalcs_form_number(c, s->dc) : pulse(c, f, v, s);
        }
        const struct dalcs_formula *formula =
            device->kind == DALCS_VCVS ? dalcs_behavioural_formula_of(c->builder, k) : NULL;
        if (formula != NULL) {
            return formula_steps(c, formula, v);
        }
    }
    return NULL;
}

/* The same of a multiple of one voltage and a number. */
const struct dalcs_form *dalcs_commutation_steps(struct dalcs_compiler *c,
                                                 const struct dalcs_formula *f,
                                                 const struct dalcs_form *form) {
    const struct dalcs_affine *a = form != NULL ? &form->affine : NULL;
    if (a == NULL || form->n > 0 || a->n != 1 || a->term[0].kind != DALCS_QUANTITY_VOLTAGE) {
        return NULL;
    }
    const struct dalcs_form *steps = source_steps(c, f, a->term[0].index);
    return steps != NULL
               ? dalcs_form_add(c, dalcs_form_number(c, a->constant), a->term[0].coefficient, steps)
               : NULL;
}

static const struct dalcs_levels *steps_of(struct dalcs_compiler *c,
                                           const struct dalcs_commutation *what) {
    const struct dalcs_form *steps = dalcs_compile(c, what->steps);
    const struct dalcs_form *form =
        steps != NULL && what->is_over ? dalcs_form_reciprocal(c, steps) : steps;
    if (what->is_condition) {
        const struct dalcs_form *logic = dalcs_compile_truth(c, form);
        return dalcs_levels_of(c, logic != NULL && what->is_opposite ? dalcs_form_negated(c, logic)
                                                                     : logic);
    }
    const struct dalcs_levels *levels = dalcs_levels_of(c, form);
    return levels != NULL ? levels
                          : dalcs_levels_of(c, dalcs_commutation_steps(c, what->steps, form));
}

static const struct dalcs_form *quantity_of(struct dalcs_compiler *c,
                                            const struct dalcs_commutation *what) {
    const struct dalcs_form *form = dalcs_compile(c, what->quantity);
    return what->less == NULL ? form : dalcs_form_add(c, form, -1, dalcs_compile(c, what->less));
}

/* ---- Parts ------------------------------------------------------------------------------------- */

/* The node that is at the quantity where step k is 1, at 0 where it is 0; -1 after an error. */
static int add_node(struct dalcs_compiler *c, const struct dalcs_commutation *what, int k) {
    struct dalcs_builder *builder = c->builder;
    struct dalcs_compiler control;
    struct dalcs_compiler source;
    const struct dalcs_behaviour *behaviour[2] = {NULL, NULL};
    int node[2] = {-1, -1};
    for (int i = 0; i < 2 && !c->failed; i++) {
        const char *name = dalcs_arena_printf(&builder->scratch, "%s%d",
                                              i == 0 ? "commutation" : "product", ++c->n_nodes);
        node[i] = name != NULL ? dalcs_builder_inner_node(builder, name, c->element) : -1;
        c->failed = c->failed || node[i] < 0;
    }
    if (c->failed || !dalcs_compiler_start_inner(c, &control, c->n_forms)) {
        return -1;
    }
    const struct dalcs_levels *levels = steps_of(&control, what);
    if (levels != NULL && k < levels->n && !control.failed) {
        behaviour[0] = dalcs_behaviour_make(&control, levels->level[k].logic);
    }
    dalcs_compiler_finish_inner(c, &control);
    if (behaviour[0] == NULL || c->failed || !dalcs_compiler_start_inner(c, &source, c->n_forms)) {
        return -1;
    }
    const struct dalcs_form *quantity = quantity_of(&source, what);
    const struct dalcs_affine v = dalcs_affine_of(&source, DALCS_QUANTITY_VOLTAGE, node[1]);
    const struct dalcs_form *own = dalcs_form_affine(&source, &v);
    const struct dalcs_form *current =
        own != NULL && quantity != NULL ? dalcs_form_add(&source, own, -1, quantity) : NULL;
    behaviour[1] = current != NULL ? dalcs_behaviour_make(&source, current) : NULL;
    dalcs_compiler_finish_inner(c, &source);
    if (behaviour[1] == NULL || c->failed || !dalcs_builder_reserve_devices(builder, 3)) {
        return -1;
    }

    static const enum dalcs_device_kind kind[] = {DALCS_VCVS, DALCS_VCCS, DALCS_SWITCH};

    static const char *const name[] = {"control", "quantity", "commutator"};
    for (int i = 0; i < 3; i++) {
        struct dalcs_device *device =
            dalcs_builder_add_inner_device(builder, kind[i], name[i], c->element);
        if (device == NULL) {
            return -1;
        }
        device->node[0] = i == 0 ? node[0] : node[1];
        device->behaviour = i < 2 ? behaviour[i] : NULL;
        device->node[2] = i == 2 ? node[0] : 0;
        device->model = i == 2 ? add_model(builder) : -1;
    }
    return node[1];
}

/* Choices inside choices are compiled again in the compilers of the outer ones' parts: a choice has one node in all of
 * them, so that n of them, each in the last branch of another, have n nodes and not 2^n. */
static int *known_node(struct dalcs_compiler *c, const struct dalcs_commutation *what) {
    return what->of == NULL || c->is_silent || c->smooth_node == NULL
               ? NULL
               : &c->smooth_node[what->of->number_of];
}

const struct dalcs_form *dalcs_commutate(struct dalcs_compiler *c,
                                         const struct dalcs_commutation *what) {
    int *known = known_node(c, what);
    const int sign = what->is_opposite ? -1 : 1; /* it is kept with that of its node */
    if (known != NULL && sign * *known > 0 && !c->failed) {
        const struct dalcs_affine v = dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, sign * *known);
        return dalcs_form_affine(c, &v);
    }
    if (c->depth >= DEEPEST || c->failed) {
        return NULL;
    }
    const struct dalcs_levels *levels = steps_of(c, what);
    if (levels == NULL || c->n_nodes + 2 * levels->n > MOST_NODES) {
        return NULL;
    }
    const struct dalcs_form *sum = levels->base != 0
                                       ? dalcs_form_scale(c, levels->base, quantity_of(c, what))
                                       : dalcs_form_number(c, 0);
    for (int k = 0; k < levels->n && sum != NULL; k++) {
        const int node = add_node(c, what, k);
        if (node < 0) {
            c->failed = true;
            return NULL;
        }
        const struct dalcs_affine v = dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, node);
        sum = dalcs_form_add(c, sum, levels->level[k].height, dalcs_form_affine(c, &v));
        if (known != NULL && levels->n == 1 && levels->base == 0 && levels->level[0].height == 1) {
            *known = sign * node;
        }
    }
    return sum;
}
