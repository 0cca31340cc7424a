/* jumps_setup.c - the data of the circuit that the two networks of a jump use. */
#include "jumps_internal.h"

#include "names.h"

#include <stdlib.h>
#include <string.h>

/* Names of states, pairs and inputs; each belongs to one device. */
struct places {
    struct dalcs_names names;
    struct dalcs_arena arena; /* of names made up here */
    int *system, *index;      /* by the value of a name */
    size_t n;
};

static enum dalcs_status add_place(struct places *p, const char *name, int system, int index) {
    if (dalcs_names_find(&p->names, name) >= 0) {
        return DALCS_OK; /* the first pair of a diode */
    }
    DALCS_TRY(dalcs_names_add(&p->names, name, (int)p->n));
    p->system[p->n] = system;
    p->index[p->n++] = index;
    return DALCS_OK;
}

static enum dalcs_status find_places(struct places *p, const struct dalcs_network *network) {
    size_t n = 0;
    for (int k = 0; k < network->n_systems; k++) {
        const struct dalcs_system *s = &network->system[k];
        n += (size_t)(s->n_x + s->n_pairs + s->n_inputs);
    }
    p->system = dalcs_alloc(n, sizeof(*p->system));
    p->index = dalcs_alloc(n, sizeof(*p->index));
    if (p->system == NULL || p->index == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < network->n_systems; k++) {
        const struct dalcs_system *s = &network->system[k];
        for (int x = 0; x < s->n_x; x++) {
            DALCS_TRY(add_place(p, s->column[x].element, k, x));
        }
        for (int d = 0; d < s->n_pairs; d++) {
            const char *name = s->pair[d].element;
            if (s->pair[d].is_breakdown) {
                name = dalcs_breakdown_name(&p->arena, name);
            }
            DALCS_TRY(name == NULL ? DALCS_E_NOMEM : add_place(p, name, k, d));
        }
        for (int i = 1; i < s->n_inputs; i++) {
            DALCS_TRY(add_place(p, s->input_element[i], k, i));
        }
    }
    return DALCS_OK;
}

static void places_finish(struct places *p) {
    dalcs_names_finish(&p->names);
    dalcs_arena_finish(&p->arena);
    free(p->system);
    free(p->index);
}

static int look_up(const struct places *p, const char *name, int *owner) {
    int place = dalcs_names_find(&p->names, name);
    *owner = place < 0 ? *owner : p->system[place];
    return place < 0 ? -1 : p->index[place];
}

static enum dalcs_status part_setup(struct dalcs_jump_part *part,
                                    const struct dalcs_network *impulse, int k,
                                    const struct places *places,
                                    const struct dalcs_osnsp_options *options) {
    const struct dalcs_system *s = &impulse->system[k];
    DALCS_TRY(dalcs_osnsp_setup(&part->osnsp, s, options));
    part->osnsp.asks.refines = true;
    part->u = dalcs_alloc((size_t)(s->n_x + s->n_inputs), sizeof(double));
    part->y = dalcs_alloc((size_t)dalcs_system_n_columns(s), sizeof(double));
    part->state = dalcs_alloc((size_t)s->n_x, sizeof(int));
    part->pair = dalcs_alloc((size_t)s->n_pairs, sizeof(int));
    part->input = dalcs_alloc((size_t)s->n_inputs, sizeof(int));
    part->source = dalcs_alloc((size_t)impulse->n_outputs, sizeof(*part->source));
    if (part->u == NULL || part->y == NULL || part->state == NULL || part->pair == NULL ||
        part->input == NULL || part->source == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int x = 0; x < s->n_x; x++) {
        part->state[x] = look_up(places, s->column[x].element, &part->owner);
    }
    for (int d = 0; d < s->n_pairs; d++) {
        part->pair[d] = look_up(places, s->pair[d].element, &part->owner);
    }
    for (int i = 1; i < s->n_inputs; i++) {
        /* those of a formula follow each other */
        part->input[i] = look_up(places, s->input_element[i], &part->owner);
        part->input[i] += i > 1 && strcmp(s->input_element[i], s->input_element[i - 1]) == 0
                              ? part->input[i - 1] - part->input[i] + 1
                              : 0;
    }
    return DALCS_OK;
}

/* Of coils that are dependent without any |k| = 1 (three of them may be) the charge network does not
 * have the ideal transformer that they are. */
static enum dalcs_status leave_out_dependent_coils(struct dalcs_jumps *j,
                                                   const struct dalcs_circuit *circuit,
                                                   const struct places *places) {
    bool *is_transformer = dalcs_alloc((size_t)circuit->n_devices, sizeof(*is_transformer));
    if (is_transformer == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_mark_transformers(circuit, is_transformer);
    for (int k = 0; k < circuit->n_couplings; k++) {
        const int *coil = circuit->coupling[k].inductor;
        int owner[2] = {-1, -1};
        bool is_state[2];
        for (int e = 0; e < 2; e++) {
            is_state[e] = look_up(places, circuit->device[coil[e]].name, &owner[e]) >= 0;
        }
        if (is_state[0] != is_state[1] && !is_transformer[coil[0]]) {
            j->is_covered[owner[is_state[0] ? 0 : 1]] = false;
        }
    }
    free(is_transformer);
    return DALCS_OK;
}

static void mark_driven(const struct dalcs_jumps *j, struct dalcs_jump_part *part) {
    const bool *is_driven = j->is_driven[part->owner];
    for (int x = 0; x < part->osnsp.system->n_x && is_driven != NULL; x++) {
        part->is_driven = part->is_driven || is_driven[part->state[x]];
    }
}

/* The systems with states of one of the two networks. */
static enum dalcs_status add_parts(struct dalcs_jumps *j, enum dalcs_impulse_kind kind,
                                   const struct places *places,
                                   const struct dalcs_osnsp_options *options) {
    const struct dalcs_network *network = j->network[kind];
    int *part_of = dalcs_alloc((size_t)network->n_systems, sizeof(*part_of));
    enum dalcs_status status = part_of == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (int k = 0; status == DALCS_OK && k < network->n_systems; k++) {
        part_of[k] = -1;
        if (network->system[k].n_x > 0) {
            struct dalcs_jump_part *part = &j->part[j->n_parts];
            part_of[k] = j->n_parts++;
            part->kind = kind;
            status = part_setup(part, network, k, places, options);
            if (status == DALCS_OK) {
                mark_driven(j, part);
            }
            part->next = j->first_part[part->owner];
            j->first_part[part->owner] = part_of[k];
        }
    }
    for (int i = 1; status == DALCS_OK && i < network->n_outputs; i++) {
        const struct dalcs_output *impulse = &network->output[i - 1];
        const struct dalcs_output *driven = &network->output[i];
        int k = impulse->plus.system >= 0 ? impulse->plus.system : impulse->minus.system;
        if (k >= 0 && part_of[k] >= 0 && strcmp(impulse->name, driven->name) == 0) {
            struct dalcs_jump_part *part = &j->part[part_of[k]];
            part->source[part->n_sources++] = (struct source){impulse, driven};
        }
    }
    free(part_of);
    return status;
}

/* Sources that only read, and act on no state, take no part in a jump; states that they act on come behind the others. */
static enum dalcs_status find_whether_covered(struct dalcs_jumps *j,
                                              const struct dalcs_network *network, int k) {
    if (network->jumps_are_covered != NULL) {
        j->is_covered[k] = network->jumps_are_covered[k];
        return DALCS_OK;
    }
    const size_t n_x = (size_t)network->system[k].n_x;
    struct dalcs_partition p;
    DALCS_TRY(dalcs_partition_find(&p, &network->system[k]));
    j->is_covered[k] = p.all_monotone && p.jumps_as_usual;
    enum dalcs_status status = DALCS_OK;
    if (p.all_monotone && !p.jumps_as_usual) {
        j->is_driven[k] = dalcs_alloc(n_x, sizeof(bool));
        status = j->is_driven[k] == NULL ? DALCS_E_NOMEM : DALCS_OK;
    }
    for (size_t x = 0; status == DALCS_OK && j->is_driven[k] != NULL && x < n_x; x++) {
        j->is_driven[k][x] = p.is_driven[x];
    }
    dalcs_partition_finish(&p);
    return status;
}

static enum dalcs_status find_parts(struct dalcs_jumps *j, const struct dalcs_circuit *circuit,
                                    const struct dalcs_network *network,
                                    const struct dalcs_osnsp_options *options) {
    struct places places = {0};
    size_t n = 0;
    for (int kind = 0; kind < DALCS_N_IMPULSES; kind++) {
        n += (size_t)j->network[kind]->n_systems;
    }
    j->n_systems = network->n_systems;
    j->part = dalcs_alloc(n, sizeof(*j->part));
    j->first_part = dalcs_alloc((size_t)j->n_systems, sizeof(int));
    j->is_covered = dalcs_alloc((size_t)j->n_systems, sizeof(bool));
    j->is_driven = dalcs_alloc((size_t)j->n_systems, sizeof(*j->is_driven));
    if (j->part == NULL || j->first_part == NULL || j->is_covered == NULL || j->is_driven == NULL) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = find_places(&places, network);
    if (status == DALCS_OK) {
        for (int k = 0; k < j->n_systems && status == DALCS_OK; k++) {
            j->first_part[k] = -1;
            status = find_whether_covered(j, network, k);
        }
    }
    if (status == DALCS_OK) {
        status = leave_out_dependent_coils(j, circuit, &places);
    }
    for (int kind = 0; status == DALCS_OK && kind < DALCS_N_IMPULSES; kind++) {
        status = add_parts(j, (enum dalcs_impulse_kind)kind, &places, options);
    }
    places_finish(&places);
    return status;
}

/* The two networks: of a circuit, or those that a system file came with. */
static enum dalcs_status find_networks(struct dalcs_jumps *j, const struct dalcs_circuit *circuit,
                                       const struct dalcs_network *network) {
    enum dalcs_status status = DALCS_OK;
    for (int kind = 0; kind < DALCS_N_IMPULSES && status == DALCS_OK; kind++) {
        j->network[kind] = network->jump[kind];
        if (network->jump[kind] == NULL) {
            status = dalcs_impulse_network_build(&j->impulse[kind], circuit,
                                                 (enum dalcs_impulse_kind)kind);
            j->network[kind] = &j->impulse[kind].network;
        }
    }
    return status;
}

enum dalcs_status dalcs_jumps_build(struct dalcs_jumps *j, const struct dalcs_circuit *circuit,
                                    const struct dalcs_network *network,
                                    const struct dalcs_osnsp_options *options) {
    if (j->is_built) {
        return DALCS_OK;
    }
    j->of = network;
    enum dalcs_status status = find_networks(j, circuit, network);
    if (status == DALCS_OK) {
        status = find_parts(j, circuit, network, options);
    }
    j->is_built = status == DALCS_OK;
    if (status != DALCS_OK) {
        dalcs_jumps_finish(j);
    }
    return status;
}

static void part_finish(struct dalcs_jump_part *part) {
    if (part->osnsp.system != NULL) {
        dalcs_osnsp_finish(&part->osnsp);
    }
    free(part->u);
    free(part->y);
    free(part->state);
    free(part->pair);
    free(part->input);
    free(part->source);
}

void dalcs_jumps_finish(struct dalcs_jumps *j) {
    for (int p = 0; p < j->n_parts; p++) {
        part_finish(&j->part[p]);
    }
    free(j->part);
    free(j->first_part);
    free(j->is_covered);
    for (int k = 0; j->is_driven != NULL && k < j->n_systems; k++) {
        free(j->is_driven[k]);
    }
    free(j->is_driven);
    for (int kind = 0; kind < DALCS_N_IMPULSES; kind++) {
        dalcs_impulse_network_finish(&j->impulse[kind]);
    }
    *j = (struct dalcs_jumps){0};
}
