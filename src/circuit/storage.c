/* storage.c - coils whose flux is a function of their current, and capacitors whose charge is one of their voltage.
 *
 *     a --+-- coil of unit H -------+-- b         a -- capacitor of unit F -- source of x - q -- b
 *         +-- source of x - y ------+
 *
 * The flux over its unit is the current y of an ordinary coil across the two nodes, so that what is stored, kept and
 * checked is flux. The source beside it carries what the whole current x is more, with y = f(x)/unit: an inverse of
 * straight lines, whose corners are pairs, or else the voltage of a node of its own, at which a source has no current
 * where f agrees. Of a capacitor q, the charge over its unit, is the voltage of an ordinary one, and the source is in
 * series. The unit is the slope around 0: there the source has nothing to do. */
#include "storage.h"

#include "behaviour.h"
#include "element_cards.h"
#include "formula_writer.h"
#include "union_find.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct dalcs_storage {
    int device, core;
    int balance; /* the source that has no current where a smooth law agrees; -1: none */
    struct dalcs_storage_function f;
    const struct dalcs_storage *before;
};

/* ---- The parts --------------------------------------------------------------------------------------- */

/* The name of the core: a jump lists "linkage(l1)" in A. */
static const char *core_what(enum dalcs_device_kind kind) {
    return kind == DALCS_INDUCTOR ? "linkage" : "charge";
}

static const char *core_name(struct dalcs_builder *builder, enum dalcs_device_kind kind,
                             const struct dalcs_token *element) {
    return dalcs_arena_printf(&builder->scratch, "%s(%s)", core_what(kind), element->text);
}

/* A node by name, which formulas find it by from now on. */
static const struct dalcs_token *node_token(struct dalcs_builder *builder,
                                            const struct dalcs_token *element, int node) {
    const char *name = node == 0 ? "0" : builder->elements.node_name[node];
    int first;
    if (node != 0 &&
        dalcs_names_find_or_add(&builder->elements.nodes, name, node, &first) != DALCS_OK) {
        builder->out_of_memory = true;
    }
    return dalcs_formula_name(builder, element, name);
}

/* The ordinary coil or capacitor; NULL: out of memory. */
static struct dalcs_device *add_core(struct dalcs_builder *builder,
                                     const struct dalcs_token *element, struct dalcs_device *device,
                                     double unit) {
    const bool is_coil = device->kind == DALCS_INDUCTOR;
    const int index = (int)(device - builder->circuit->device);
    if (is_coil && builder->elements.current_of[index] == index &&
        !dalcs_builder_add_terminal(builder, element, device)) {
        return NULL;
    }
    const int inside =
        is_coil ? device->node[1] : dalcs_builder_inner_node(builder, "charge", element);
    struct dalcs_device *core =
        dalcs_builder_add_inner_device(builder, device->kind, core_what(device->kind), element);
    const char *name = core_name(builder, device->kind, element);
    if (inside < 0 || core == NULL || name == NULL ||
        dalcs_names_add(&builder->elements.devices, name, (int)(core - builder->circuit->device)) !=
            DALCS_OK) {
        builder->out_of_memory = true;
        return NULL;
    }
    core->node[0] = device->node[0];
    core->node[1] = inside;
    core->value = unit;
    if (is_coil) { /* the terminal has the whole current, and the name */
        struct dalcs_device *terminal =
            &builder->circuit->device[builder->elements.current_of[index]];
        terminal->name = device->name;
        terminal->letter = device->letter;
        device->name = dalcs_arena_printf(&builder->circuit->arena, "bend(%s)", element->text);
        builder->out_of_memory = builder->out_of_memory || device->name == NULL;
    }
    device->node[0] = is_coil ? device->node[0] : inside;
    device->kind = is_coil ? DALCS_VCCS : DALCS_VCVS;
    device->is_storage = true;
    device->value = 0;
    return core;
}

/* f(-s) */
static bool mirror(struct dalcs_arena *arena, const struct dalcs_piecewise *f,
                   struct dalcs_piecewise *mirrored) {
    struct dalcs_knot *knot = dalcs_arena_alloc(arena, (size_t)f->n, sizeof *knot);
    for (int k = 0; knot != NULL && k < f->n; k++) {
        const struct dalcs_knot *from = &f->knot[f->n - 1 - k];
        knot[k] = (struct dalcs_knot){-from->at, from->right, from->value, from->left};
    }
    *mirrored = (struct dalcs_piecewise){.n = f->n,
                                         .knot = knot,
                                         .before = -f->after,
                                         .after = -f->before,
                                         .has_zero = f->has_zero,
                                         .zero = f->zero};
    return knot != NULL;
}

/* What the straight lines of the source read: the current or the voltage of the core. */
static struct dalcs_affine core_state(struct dalcs_compiler *c, const struct dalcs_device *core) {
    if (core->kind == DALCS_INDUCTOR) {
        return dalcs_affine_of(c, DALCS_QUANTITY_CURRENT,
                               (int)(core - c->builder->circuit->device));
    }
    struct dalcs_affine sum = dalcs_affine_constant(0);
    for (int k = 0; k < 2; k++) {
        const struct dalcs_affine v = dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, core->node[k]);
        sum = core->node[k] != 0 ? dalcs_affine_add(c, &sum, k == 0 ? 1 : -1, &v) : sum;
    }
    return sum;
}

/* inverse(state) - state, as pairs. */
static void put_lines(struct dalcs_builder *builder, const struct dalcs_token *element,
                      struct dalcs_device *device, const struct dalcs_device *core,
                      const struct dalcs_storage_function *f) {
    struct dalcs_compiler c = {
        .builder = builder, .arena = &builder->scratch, .element = element, .n_forms = 1};
    const struct dalcs_affine state = core_state(&c, core);
    struct dalcs_form_part part;
    struct dalcs_piecewise inverse;
    const bool is_turned = dalcs_affine_direction(&c, &state, &part.direction) < 0;
    bool ok = dalcs_storage_function_invert(&builder->scratch, f, &inverse);
    part.f = inverse;
    ok = ok && (!is_turned || mirror(&builder->scratch, &inverse, &part.f));
    const struct dalcs_affine zero = dalcs_affine_constant(0);
    const struct dalcs_form form = {
        .affine = dalcs_affine_add(&c, &zero, -1, &state), .n = 1, .part = &part};
    device->behaviour = ok && !c.failed ? dalcs_behaviour_make(&c, &form) : NULL;
    builder->out_of_memory = builder->out_of_memory || device->behaviour == NULL;
    free(c.cell);
}

/* The core's state as a formula has it. */
static const struct dalcs_formula *write_state(struct dalcs_formula_writer *w,
                                               const struct dalcs_device *core) {
    if (core->kind == DALCS_INDUCTOR) {
        const char *name = core_name(w->builder, core->kind, w->element);
        return dalcs_formula_signal(w, DALCS_FORMULA_CURRENT,
                                    dalcs_formula_name(w->builder, w->element, name), NULL);
    }
    return dalcs_formula_signal(w, DALCS_FORMULA_VOLTAGE,
                                node_token(w->builder, w->element, core->node[0]),
                                node_token(w->builder, w->element, core->node[1]));
}

/* x as the voltage of a node, at which dalcs_charging (f(x)/unit - state) is no current. */
static void put_smooth(struct dalcs_builder *builder, const struct dalcs_token *element,
                       struct dalcs_device *device, const struct dalcs_device *core,
                       struct dalcs_storage *s) {
    const struct dalcs_storage_function *f = &s->f;
    const int node = dalcs_builder_inner_node(builder, "argument", element);
    struct dalcs_formula_writer w;
    if (node < 0 || !dalcs_formula_writer_start(&w, builder, element)) {
        return;
    }
    const struct dalcs_token *name = node_token(builder, element, node);
    const struct dalcs_formula *x = dalcs_formula_signal(&w, DALCS_FORMULA_VOLTAGE, name, NULL);
    const struct dalcs_formula *more =
        dalcs_formula_operation(&w, DALCS_SUBTRACT, x, write_state(&w, core));
    dalcs_behavioural_add_formula(builder, device, dalcs_formula_token(&w, more));
    const struct dalcs_formula *law =
        dalcs_formula_operation(&w, DALCS_SUBTRACT, dalcs_storage_function_write(&w, f, x),
                                dalcs_formula_number(&w, f->at_0));
    law = dalcs_formula_operation(&w, DALCS_MULTIPLY,
                                  dalcs_formula_number(&w, dalcs_charging / f->unit), law);
    const struct dalcs_formula *state = dalcs_formula_operation(
        &w, DALCS_MULTIPLY, dalcs_formula_number(&w, dalcs_charging), write_state(&w, core));
    law = dalcs_formula_operation(&w, DALCS_SUBTRACT, law, state);
    struct dalcs_device *balance =
        dalcs_builder_add_inner_device(builder, DALCS_VCCS, "balance", element);
    if (balance != NULL) {
        balance->node[0] = node;
        balance->is_storage = true;
        s->balance = (int)(balance - builder->circuit->device);
        dalcs_behavioural_add_formula(builder, balance, dalcs_formula_token(&w, law));
    }
}

bool dalcs_storage_expand(struct dalcs_builder *builder, const struct dalcs_card *card,
                          struct dalcs_device *device, const struct dalcs_storage_law *law,
                          double m) {
    struct dalcs_storage *s = dalcs_arena_alloc(&builder->scratch, 1, sizeof *s);
    if (s == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    *s = (struct dalcs_storage){.device = (int)(device - builder->circuit->device),
                                .balance = -1,
                                .before = builder->formulas.storage};
    if (!dalcs_storage_function_make(builder, card, device, law, m, &s->f)) {
        return false;
    }
    if (s->f.formula == NULL && dalcs_piecewise_is_line(&s->f.curve)) {
        device->value = s->f.unit; /* an ordinary one */
        return false;
    }
    struct dalcs_device *core = add_core(builder, card->token, device, s->f.unit);
    if (core == NULL) {
        return false;
    }
    s->core = (int)(core - builder->circuit->device);
    builder->formulas.storage = s;
    if (s->f.formula == NULL) {
        put_lines(builder, card->token, device, core, &s->f);
    } else {
        put_smooth(builder, card->token, device, core, s);
    }
    return true;
}

bool dalcs_storage_follow(struct dalcs_builder *builder, const struct dalcs_card *card,
                          struct dalcs_device *device, const struct dalcs_storage_law *law,
                          double m) {
    const bool is_coil = device->kind == DALCS_INDUCTOR;
    if (law->formula == NULL || law->is_slope ||
        !dalcs_storage_formula_follows(builder, card, law->formula->formula)) {
        return false;
    }
    if (device->has_initial && device->initial != 0) {
        dalcs_builder_error(builder, card->token, "start it by a source or a switch",
                            "'%s' changes with other quantities, and then it begins at 0",
                            card->token->text);
        return true;
    }
    struct dalcs_formula_writer w;
    if (!dalcs_formula_writer_start(&w, builder, card->token)) {
        return true;
    }
    const struct dalcs_formula *x =
        is_coil ? dalcs_formula_signal(&w, DALCS_FORMULA_CURRENT, card->token, NULL)
                : dalcs_formula_signal(&w, DALCS_FORMULA_VOLTAGE,
                                       node_token(builder, card->token, device->node[0]),
                                       node_token(builder, card->token, device->node[1]));
    const struct dalcs_formula *one =
        is_coil ? dalcs_formula_operation(&w, DALCS_DIVIDE, x, dalcs_formula_number(&w, m)) : x;
    const struct dalcs_formula *stored =
        dalcs_storage_formula_copy(&w, card, law->formula->formula, one, true);
    if (stored == NULL) {
        return true;
    }
    const struct dalcs_formula *all =
        is_coil ? stored
                : dalcs_formula_operation(&w, DALCS_MULTIPLY, dalcs_formula_number(&w, m), stored);
    device->kind = is_coil ? DALCS_VCVS : DALCS_VCCS;
    device->has_initial = false;
    device->value = 0;
    dalcs_behavioural_add_formula(builder, device,
                                  dalcs_formula_token(&w, dalcs_formula_call(&w, "ddt", 1, &all)));
    return true;
}

/* ---- Initial states ------------------------------------------------------------------------------------ */

bool dalcs_storage_is(const struct dalcs_builder *builder, int device) {
    return builder->circuit->device[device].is_storage;
}

/* Nodes that resistors of 0 ohm join are one for .ic, as they are in the equations; NULL: no memory. */
static int *join_nodes(struct dalcs_builder *builder) {
    const struct dalcs_circuit *c = builder->circuit;
    int *joined = dalcs_arena_alloc(&builder->scratch, (size_t)c->n_nodes + 1, sizeof *joined);
    if (joined == NULL) {
        builder->out_of_memory = true;
        return NULL;
    }
    dalcs_union_reset(joined, c->n_nodes);
    for (int k = 0; k < c->n_devices; k++) {
        if (dalcs_device_is_short(&c->device[k])) {
            (void)dalcs_union_join(joined, c->device[k].node[0], c->device[k].node[1]);
        }
    }
    return joined;
}

/* The voltage of a node against ground by .ic, 0: none. */
static double initial_voltage(const struct dalcs_builder *builder, int *joined, int node) {
    double v = 0;
    for (size_t k = 0; k < builder->analyses.n_initial_conditions; k++) {
        const struct dalcs_initial_condition *ic = &builder->analyses.initial_condition[k];
        const bool is_there = dalcs_union_find(joined, ic->node[0]) == node &&
                              dalcs_union_find(joined, ic->node[1]) == 0;
        v = node != 0 && is_there ? ic->value : v;
    }
    return v;
}

/* Of a capacitor's card: no current flows before a run, so nothing is across its Rser and Lser. */
static double initial_difference(const struct dalcs_builder *builder, int *joined,
                                 const struct dalcs_device *device, int first) {
    const int a =
        dalcs_union_find(joined, device->before_series != 0 ? device->before_series : first);
    const int b = dalcs_union_find(joined, device->node[1]);
    for (size_t k = 0; k < builder->analyses.n_initial_conditions; k++) {
        const struct dalcs_initial_condition *ic = &builder->analyses.initial_condition[k];
        const int end[2] = {dalcs_union_find(joined, ic->node[0]),
                            dalcs_union_find(joined, ic->node[1])};
        if ((end[0] == a && end[1] == b) || (end[0] == b && end[1] == a)) {
            return end[0] == a ? ic->value : -ic->value;
        }
    }
    return initial_voltage(builder, joined, a) - initial_voltage(builder, joined, b);
}

void dalcs_storage_resolve(struct dalcs_builder *builder) {
    int *joined = builder->formulas.storage != NULL ? join_nodes(builder) : NULL;
    for (const struct dalcs_storage *s = builder->formulas.storage; s != NULL && joined != NULL;
         s = s->before) {
        struct dalcs_device *device = &builder->circuit->device[s->device];
        struct dalcs_device *core = &builder->circuit->device[s->core];
        const double x = device->has_initial ? device->initial
                         : core->kind == DALCS_CAPACITOR
                             ? initial_difference(builder, joined, device, core->node[0])
                             : 0;
        const double state = dalcs_storage_function_at(builder, &s->f, x);
        if (!isfinite(state)) {
            dalcs_builder_error(builder, builder->elements.device_token[s->device], NULL,
                                "'%s' has no %s at %g %s, where it begins",
                                builder->elements.device_token[s->device]->text,
                                core->kind == DALCS_INDUCTOR ? "flux" : "charge", x,
                                core->kind == DALCS_INDUCTOR ? "A" : "V");
            continue;
        }
        core->initial = state;
        core->has_initial = true;
        device->has_initial = false;
        if (s->balance >= 0) {
            builder->circuit->device[s->balance].initial = x;
        }
    }
}
