/* resolve.c - sources with a formula, once all elements are known: each after those whose voltages it reads. */
#include "behaviour.h"
#include "element_cards.h"
#include "later.h"

#include <stdlib.h>
#include <string.h>

static const struct dalcs_form *input_of(struct dalcs_compiler *c,
                                         const struct dalcs_formula_source *source,
                                         const struct dalcs_device *device) {
    if (source->token != NULL) {
        const struct dalcs_formula *formula = source->token->formula;
        c->n_forms = (size_t)formula->number_of + 1;
        c->form_of = dalcs_arena_alloc(c->arena, c->n_forms, sizeof(const struct dalcs_form *));
        c->smooth_node = dalcs_arena_alloc(c->arena, c->n_forms, sizeof *c->smooth_node);
        const bool fits = c->form_of != NULL && c->smooth_node != NULL;
        c->builder->out_of_memory = c->builder->out_of_memory || !fits;
        return fits ? dalcs_compile(c, formula) : NULL;
    }
    struct dalcs_affine sum = dalcs_affine_constant(0);
    for (int k = 0; k < 2; k++) {
        const int node = device->node[2 + k];
        const struct dalcs_affine v = dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, node);
        sum = node != 0 ? dalcs_affine_add(c, &sum, k == 0 ? 1 : -1, &v) : sum;
    }
    return dalcs_form_affine(c, &sum);
}

const struct dalcs_formula *dalcs_behavioural_formula_of(const struct dalcs_builder *builder,
                                                         int device) {
    size_t low = 0;
    size_t high = builder->formulas.n;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const bool is_before = builder->formulas.source[middle].device < device;
        *(is_before ? &low : &high) = is_before ? middle + 1 : middle;
    }
    const struct dalcs_formula_source *source =
        low < builder->formulas.n ? &builder->formulas.source[low] : NULL;
    const bool is_one = source != NULL && source->device == device && source->token != NULL;
    return is_one && !source->has_table ? source->token->formula : NULL;
}

static const struct dalcs_form *form_of(struct dalcs_compiler *c,
                                        const struct dalcs_formula_source *source) {
    c->n_waves = 0;
    c->n_cells = 0;
    c->n_pairs = 0;
    const struct dalcs_form *form =
        input_of(c, source, &c->builder->circuit->device[source->device]);
    return source->has_table ? dalcs_form_apply(c, &source->table, form) : form;
}

/* Without pairs for what sources alone decide, if any do. Products have made parts of their own, which know nothing of
 * that. */
static const struct dalcs_behaviour *decide(struct dalcs_compiler *c,
                                            const struct dalcs_formula_source *source,
                                            const struct dalcs_potentials *potentials,
                                            const struct dalcs_behaviour *written) {
    if (written == NULL || potentials->n == 0 || c->n_nodes > 0 ||
        !dalcs_potentials_reach(potentials, written)) {
        return written;
    }
    c->is_silent = true;
    c->potentials = potentials;
    const struct dalcs_form *form = form_of(c, source);
    struct dalcs_behaviour *made =
        form != NULL && !c->failed ? dalcs_behaviour_make(c, form) : NULL;
    c->potentials = NULL;
    c->is_silent = c->failed = false;
    if (made == NULL) {
        return written;
    }
    made->written = written;
    return made;
}

static void resolve(struct dalcs_compiler *c, struct dalcs_formula_source *source,
                    struct dalcs_potentials *potentials) {
    c->failed = false;
    c->n_nodes = 0;
    c->storage.is_it = c->builder->circuit->device[source->device].is_storage;
    c->storage.start = c->builder->circuit->device[source->device].initial;
    c->element = c->builder->elements.device_token[source->device];
    const struct dalcs_form *form = form_of(c, source);
    /* products may have moved it */
    struct dalcs_device *device = &c->builder->circuit->device[source->device];
    const int control[2] = {device->node[2], device->node[3]};
    device->node[2] = device->node[3] = 0;
    if (form != NULL && !c->failed) {
        const struct dalcs_behaviour *written = dalcs_behaviour_make(c, form);
        source->gate = dalcs_gate_find(c, device, form);
        device->node[2] = control[0];
        device->node[3] = control[1];
        device->behaviour = decide(c, source, potentials, written);
        device->node[2] = device->node[3] = 0;
        dalcs_potentials_note(potentials, c->builder->circuit, source->device);
    }
}

/* ---- What is read first -------------------------------------------------------------------------- */

/* Formulas that read each other along a longer chain than this are resolved in the order of their cards: what sources
 * decide behind it has pairs. */
enum { LONGEST_CHAIN = 64 };

struct resolving {
    struct dalcs_compiler *compiler;
    struct dalcs_potentials *potentials;
    int *driver; /* [n_nodes] a source with a formula, and 1; 0: none */
    int n_nodes;
    int depth;
};

static void resolve_node(struct resolving *r, int node);

/* Parts that are used more than once are there once. */
static void resolve_read(struct resolving *r, const struct dalcs_formula *f, bool *seen) {
    if (seen[f->number_of]) {
        return;
    }
    seen[f->number_of] = true;
    for (int k = 0; f->kind == DALCS_FORMULA_VOLTAGE && k < 2; k++) {
        if (f->signal[k] != NULL) {
            resolve_node(
                r, dalcs_names_find(&r->compiler->builder->elements.nodes, f->signal[k]->text));
        }
    }
    for (int k = 0; k < f->n; k++) {
        resolve_read(r, f->argument[k], seen);
    }
}

static void resolve_formula(struct resolving *r, const struct dalcs_formula *f) {
    bool *seen = dalcs_arena_alloc(r->compiler->arena, (size_t)f->number_of + 1, sizeof *seen);
    if (seen != NULL) {
        resolve_read(r, f, seen);
    } else {
        r->compiler->builder->out_of_memory = true;
    }
}

static void resolve_in_order(struct resolving *r, struct dalcs_formula_source *source) {
    if (source->is_resolved || r->depth > LONGEST_CHAIN || r->compiler->builder->out_of_memory) {
        return;
    }
    source->is_resolved = true;
    r->depth++;
    const struct dalcs_device *device = &r->compiler->builder->circuit->device[source->device];
    if (source->token != NULL) {
        resolve_formula(r, source->token->formula);
    } else {
        const int control[2] = {device->node[2], device->node[3]};
        resolve_node(r, control[0]);
        resolve_node(r, control[1]);
    }
    r->depth--;
    resolve(r->compiler, source, r->potentials);
}

static void resolve_node(struct resolving *r, int node) {
    if (node > 0 && node < r->n_nodes && r->driver[node] > 0) {
        resolve_in_order(r, &r->compiler->builder->formulas.source[r->driver[node] - 1]);
    }
}

static void resolve_all(struct dalcs_compiler *c, struct dalcs_potentials *potentials) {
    struct dalcs_builder *builder = c->builder;
    const struct dalcs_circuit *circuit = builder->circuit;
    struct resolving r = {.compiler = c,
                          .potentials = potentials,
                          .driver = calloc((size_t)circuit->n_nodes, sizeof *r.driver),
                          .n_nodes = circuit->n_nodes};
    builder->out_of_memory = builder->out_of_memory || r.driver == NULL;
    for (size_t k = 0; k < builder->formulas.n && !builder->out_of_memory; k++) {
        const struct dalcs_device *device = &circuit->device[builder->formulas.source[k].device];
        if (device->kind == DALCS_VCVS) {
            r.driver[device->node[0]] = (int)k + 1;
        }
    }
    for (size_t k = 0; k < builder->formulas.n; k++) {
        resolve_in_order(&r, &builder->formulas.source[k]);
    }
    free(r.driver);
}

/* Those that formulas made come after those of V and I. */
static void take_stimuli(struct dalcs_compiler *c) {
    struct dalcs_circuit *circuit = c->builder->circuit;
    const size_t n = (size_t)circuit->n_stimuli;
    const size_t n_more = dalcs_delay_pending(c->builder) + dalcs_later_pending(c->builder);
    struct dalcs_stimulus *all =
        dalcs_arena_alloc(&circuit->arena, n + c->n_stimuli + n_more, sizeof *all);
    if (all == NULL) {
        c->builder->out_of_memory = true;
        return;
    }
    if (n > 0) {
        memcpy(all, circuit->stimulus, n * sizeof *all);
    }
    memcpy(all + n, c->stimulus, c->n_stimuli * sizeof *all);
    circuit->stimulus = all;
    circuit->n_stimuli += (int)c->n_stimuli;
}

/* The last of them. */
static void add_smooth_stimulus(struct dalcs_compiler *c) {
    struct dalcs_circuit *circuit = c->builder->circuit;
    const struct dalcs_stimulus zero = {.kind = DALCS_STIMULUS_DC, .has_dc = true};
    circuit->control.smooth_stimulus =
        circuit->control.n_smooth > 0 ? dalcs_compiler_add_stimulus(c, &zero) : -1;
}

void dalcs_behavioural_resolve(struct dalcs_builder *builder) {
    struct dalcs_compiler c = {.builder = builder, .arena = &builder->scratch};
    struct dalcs_potentials potentials = {0};
    if (builder->formulas.n > 0) {
        dalcs_potentials_find(&potentials, builder);
        resolve_all(&c, &potentials);
        dalcs_potentials_finish(&potentials);
    }
    struct dalcs_gate_readers readers = {0};
    for (size_t k = 0; k < builder->formulas.n && !builder->out_of_memory; k++) {
        if (builder->formulas.source[k].gate != NULL) {
            dalcs_gate_settle(builder, &readers, builder->formulas.source[k].gate);
        }
    }
    dalcs_gate_readers_finish(&readers);
    add_smooth_stimulus(&c);
    if (c.n_stimuli > 0 && !builder->out_of_memory) {
        take_stimuli(&c);
    }
    free(c.wave);
    free(c.cell);
    free(c.stimulus);
}
