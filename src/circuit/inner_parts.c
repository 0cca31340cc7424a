/* inner_parts.c - sources that products and functions in a formula add to the circuit: room for them, and the
 * compilers of their own formulas. */
#include "behaviour.h"

#include <stdlib.h>
#include <string.h>

bool dalcs_builder_reserve_devices(struct dalcs_builder *builder, size_t n_more) {
    struct dalcs_circuit *circuit = builder->circuit;
    const size_t n = (size_t)circuit->n_devices;
    if (n + n_more <= builder->elements.device_capacity) {
        return true;
    }
    const size_t most = 2 * (n + n_more);
    struct dalcs_device *device = dalcs_arena_alloc(&circuit->arena, most, sizeof *device);
    const struct dalcs_token **token =
        dalcs_arena_alloc(&builder->scratch, most, sizeof(const struct dalcs_token *));
    const struct dalcs_token **control =
        dalcs_arena_alloc(&builder->scratch, most, sizeof(const struct dalcs_token *));
    int *current_of = dalcs_arena_alloc(&builder->scratch, most, sizeof *current_of);
    if (device == NULL || token == NULL || control == NULL || current_of == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    memcpy(device, circuit->device, n * sizeof *device);
    memcpy(token, builder->elements.device_token, n * sizeof(const struct dalcs_token *));
    memcpy(control, builder->elements.control_token, n * sizeof(const struct dalcs_token *));
    memcpy(current_of, builder->elements.current_of, n * sizeof *current_of);
    circuit->device = device;
    builder->elements.device_token = token;
    builder->elements.control_token = control;
    builder->elements.current_of = current_of;
    builder->elements.device_capacity = most;
    return true;
}

bool dalcs_compiler_start_inner(struct dalcs_compiler *c, struct dalcs_compiler *inner,
                                size_t n_forms) {
    *inner = (struct dalcs_compiler){.builder = c->builder,
                                     .arena = c->arena,
                                     .element = c->element,
                                     .n_forms = n_forms,
                                     .is_silent = c->is_silent,
                                     .storage.is_it = c->storage.is_it,
                                     .storage.start = c->storage.start,
                                     .depth = c->depth + 1,
                                     .n_nodes = c->n_nodes,
                                     .smooth_node = c->smooth_node,
                                     .stimulus = c->stimulus,
                                     .n_stimuli = c->n_stimuli,
                                     .stimulus_capacity = c->stimulus_capacity};
    inner->form_of = dalcs_arena_alloc(c->arena, n_forms, sizeof(const struct dalcs_form *));
    if (inner->form_of == NULL) {
        c->builder->out_of_memory = c->failed = true;
    }
    return inner->form_of != NULL;
}

void dalcs_compiler_finish_inner(struct dalcs_compiler *c, struct dalcs_compiler *inner) {
    c->failed = c->failed || inner->failed;
    c->n_nodes = inner->n_nodes;
    c->stimulus = inner->stimulus;
    c->n_stimuli = inner->n_stimuli;
    c->stimulus_capacity = inner->stimulus_capacity;
    free(inner->wave);
    free(inner->cell);
}
