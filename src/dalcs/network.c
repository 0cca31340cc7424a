/* network.c - the whole circuit: coil groups, components, and the probes that read the results. */
#include "network.h"

#include "capacitive_parts.h"
#include "current.h"
#include "source_conflicts.h"
#include "stamp.h"
#include "union_find.h"

#include <math.h>
#include <stdlib.h>

static void layout_finish(struct dalcs_layout *l) {
    dalcs_topology_finish(&l->topology);
    dalcs_initial_voltages_finish(&l->initial_voltages);
    free(l->held_start);
    free(l->held);
    for (int g = 0; g < l->n_groups; g++) {
        free(l->group[g].L);
        dalcs_inductance_finish(&l->group[g].split);
    }
    free(l->group);
    free(l->group_of);
    free(l->grouped_coil);
    free(l->node_column);
    free(l->kcl_row);
    free(l->state_column);
    free(l->current_column);
    free(l->branch_row);
    free(l->pair);
    free(l->input);
    *l = (struct dalcs_layout){0};
}

static enum dalcs_status layout_allocate(struct dalcs_layout *l) {
    size_t n_nodes = (size_t)l->circuit->n_nodes;
    size_t n_devices = (size_t)l->circuit->n_devices;
    int **per_node[] = {&l->node_column, &l->kcl_row};
    int **per_device[] = {&l->state_column, &l->current_column, &l->branch_row,
                          &l->pair,         &l->input,          &l->group_of};
    for (size_t k = 0; k < sizeof(per_node) / sizeof(per_node[0]); k++) {
        *per_node[k] = dalcs_alloc(n_nodes, sizeof(int));
        if (*per_node[k] == NULL) {
            return DALCS_E_NOMEM;
        }
        for (size_t i = 0; i < n_nodes; i++) {
            (*per_node[k])[i] = -1;
        }
    }
    for (size_t k = 0; k < sizeof(per_device) / sizeof(per_device[0]); k++) {
        *per_device[k] = dalcs_alloc(n_devices, sizeof(int));
        if (*per_device[k] == NULL) {
            return DALCS_E_NOMEM;
        }
        for (size_t i = 0; i < n_devices; i++) {
            (*per_device[k])[i] = -1;
        }
    }
    return DALCS_OK;
}

/* Lists the members of each part, part[n_items] or -1, by a counting sort: items keep their order.
 * Those of part k are item[start[k]..start[k + 1] - 1]. The caller frees both, also on failure. */
static enum dalcs_status list_members(int n_items, const int *part, int n_parts, int **start,
                                      int **item) {
    *start = dalcs_alloc((size_t)n_parts + 2, sizeof(**start));
    *item = dalcs_alloc((size_t)n_items, sizeof(**item));
    if (*start == NULL || *item == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < n_items; i++) {
        if (part[i] >= 0) {
            (*start)[part[i] + 2]++;
        }
    }
    for (int k = 0; k < n_parts; k++) {
        (*start)[k + 2] += (*start)[k + 1];
    }
    for (int i = 0; i < n_items; i++) {
        if (part[i] >= 0) {
            (*item)[(*start)[part[i] + 1]++] = i;
        }
    }
    return DALCS_OK;
}

/* ---- Coupled coils ------------------------------------------------------------------------- */

/* Coils coupled among each other, at most: their inductance matrix is dense. */
enum { MOST_COUPLED_COILS = 5000 };

/* The matrix of a group, its diagonal filled, and the place of each coil in it. */
static enum dalcs_status start_group(const struct dalcs_circuit *c, struct coil_group *g,
                                     int *position /* [n_devices] */, struct dalcs_diag *diag) {
    const struct dalcs_device *first = &c->device[g->device[0]];
    if (g->n > MOST_COUPLED_COILS) {
        dalcs_diag_add(diag, DALCS_ERROR, &first->where, NULL,
                       "%d coils are coupled with '%s', more than %d", g->n - 1, first->name,
                       MOST_COUPLED_COILS - 1);
        return DALCS_E_LIMIT;
    }
    g->L = dalcs_alloc((size_t)g->n * (size_t)g->n, sizeof(*g->L));
    if (g->L == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < g->n; i++) {
        position[g->device[i]] = i;
        g->L[i * g->n + i] = c->device[g->device[i]].value;
    }
    return DALCS_OK;
}

static void add_mutual_inductances(struct dalcs_layout *l, const int *position) {
    const struct dalcs_circuit *c = l->circuit;
    for (int k = 0; k < c->n_couplings; k++) {
        const struct dalcs_coupling *m = &c->coupling[k];
        const struct coil_group *g = &l->group[l->group_of[m->inductor[0]]];
        int i = position[m->inductor[0]];
        int j = position[m->inductor[1]];
        double mutual = m->k * sqrt(g->L[i * g->n + i] * g->L[j * g->n + j]);
        g->L[i * g->n + j] = mutual;
        g->L[j * g->n + i] = mutual;
    }
}

static int place_in(const struct coil_group *g, int device) {
    int k = 0;
    while (k < g->n && g->device[k] != device) {
        k++;
    }
    return k;
}

/* A factor of 0 on a K card is no missing one; of the matrix nobody asks any more. */
static void mark_zeros(const struct dalcs_circuit *c, const struct coil_group *g) {
    for (int k = 0; k < c->n_couplings; k++) {
        const struct dalcs_coupling *m = &c->coupling[k];
        const int i = m->k == 0.0 ? place_in(g, m->inductor[0]) : g->n;
        if (i < g->n) {
            const int j = place_in(g, m->inductor[1]);
            g->L[i * g->n + j] = g->L[j * g->n + i] = -0x1p-1000;
        }
    }
}

/* Two coils of a group that no K card couples; false: there are none. */
static bool find_uncoupled(const struct coil_group *g, int *first, int *second, int *n_pairs) {
    *n_pairs = 0;
    for (int i = 0; i < g->n; i++) {
        for (int j = i + 1; j < g->n; j++) {
            if (g->L[i * g->n + j] == 0.0 && (*n_pairs)++ == 0) {
                *first = i;
                *second = j;
            }
        }
    }
    return *n_pairs > 0;
}

static double factor_of(const struct coil_group *g, int i, int j) {
    return g->L[i * g->n + j] / sqrt(g->L[i * g->n + i] * g->L[j * g->n + j]);
}

/* What is missing on K cards: a chain of them leaves the factors in between at 0. NULL: nothing is. */
static const char *name_uncoupled(const struct dalcs_circuit *c, const struct coil_group *g,
                                  struct dalcs_arena *arena) {
    int i = 0;
    int j = 0;
    int n_pairs;
    mark_zeros(c, g);
    if (!find_uncoupled(g, &i, &j, &n_pairs)) {
        return g->n > 2 ? "of three coils, k12 = k13 = 1 leaves only k23 = 1" : NULL;
    }
    const char *a = c->device[g->device[i]].name;
    const char *b = c->device[g->device[j]].name;
    if (n_pairs > 1) {
        return dalcs_arena_printf(
            arena,
            "no K card couples '%s' with '%s', nor %d other pair%s: write one "
            "card with all of them, K1 %s ... %s 0.99",
            a, b, n_pairs - 1, n_pairs == 2 ? "" : "s", a, b);
    }
    if (g->n != 3) {
        return dalcs_arena_printf(arena, "no K card couples '%s' with '%s': add one, K9 %s %s k", a,
                                  b, a, b);
    }
    const double ki = factor_of(g, i, 3 - i - j);
    const double kj = factor_of(g, j, 3 - i - j);
    const double width = sqrt((1.0 - ki * ki) * (1.0 - kj * kj));
    const double low = ki * kj - width;
    const double high = ki * kj + width;
    return width < 1e-9
               ? dalcs_arena_printf(arena,
                                    "no K card couples '%s' with '%s': add K9 %s %s %.9g, the only "
                                    "factor that can be",
                                    a, b, a, b, ki * kj)
               : dalcs_arena_printf(arena,
                                    "no K card couples '%s' with '%s': add K9 %s %s k, k from %.4g "
                                    "to %.4g",
                                    a, b, a, b, low, high);
}

static enum dalcs_status split_group(const struct dalcs_circuit *c, struct coil_group *g,
                                     struct dalcs_diag *diag) {
    bool valid;
    DALCS_TRY(dalcs_inductance_split(&g->split, g->n, g->L, &valid));
    if (!valid) {
        const struct dalcs_device *first = &c->device[g->device[0]];
        struct dalcs_arena arena = {0};
        dalcs_diag_add(diag, DALCS_ERROR, &first->where, name_uncoupled(c, g, &arena),
                       "the %d coils coupled with '%s' cannot exist: their inductance matrix has a "
                       "negative eigenvalue, and they could supply more energy than they took",
                       g->n - 1, first->name);
        dalcs_arena_finish(&arena);
        return DALCS_E_NETLIST;
    }
    return DALCS_OK;
}

/* Gives every coil that is coupled the number of its group. */
static void number_groups(struct dalcs_layout *l, int *parent /* work [n_devices] */) {
    const struct dalcs_circuit *c = l->circuit;
    dalcs_union_reset(parent, c->n_devices);
    for (int k = 0; k < c->n_couplings; k++) {
        dalcs_union_join(parent, c->coupling[k].inductor[0], c->coupling[k].inductor[1]);
    }
    for (int i = 0; i < c->n_devices; i++) {
        int first = dalcs_union_find(parent, i);
        if (first == i) {
            continue;
        }
        if (l->group_of[first] < 0) {
            l->group_of[first] = l->n_groups++;
        }
        l->group_of[i] = l->group_of[first];
    }
}

/* Groups of coils that couplings join, each split into independent and dependent ones. */
static enum dalcs_status find_groups(struct dalcs_layout *l, struct dalcs_diag *diag) {
    const struct dalcs_circuit *c = l->circuit;
    if (c->n_couplings == 0) {
        return DALCS_OK;
    }
    enum dalcs_status status = DALCS_E_NOMEM;
    int *start = NULL;
    /* Of a union-find first, then the place of each coil in its group. */
    int *work = dalcs_alloc((size_t)c->n_devices, sizeof(*work));
    l->group = dalcs_alloc((size_t)c->n_couplings, sizeof(*l->group));
    if (work == NULL || l->group == NULL) {
        goto done;
    }
    number_groups(l, work);
    status = list_members(c->n_devices, l->group_of, l->n_groups, &start, &l->grouped_coil);
    for (int g = 0; g < l->n_groups && status == DALCS_OK; g++) {
        struct coil_group *group = &l->group[g];
        group->n = start[g + 1] - start[g];
        group->device = l->grouped_coil + start[g];
        status = start_group(c, group, work, diag);
    }
    if (status == DALCS_OK) {
        add_mutual_inductances(l, work);
    }
    for (int g = 0; g < l->n_groups && status == DALCS_OK; g++) {
        status = split_group(c, &l->group[g], diag);
    }
done:
    free(start);
    free(work);
    return status;
}

/* ---- Components ---------------------------------------------------------------------------- */

/* The component that holds a .ic voltage; -1 when there is nothing to hold, because a short joins
 * its nodes or no equation knows one of them. */
static int holding_component(const struct dalcs_layout *l,
                             const struct dalcs_initial_condition *ic) {
    const struct dalcs_topology *t = &l->topology;
    const int node[2] = {t->node_of[ic->node[0]], t->node_of[ic->node[1]]};
    int component = -1;
    for (int e = 0; e < 2; e++) {
        if (node[e] != 0 && t->node_component[node[e]] < 0) {
            return -1;
        }
        component = node[e] != 0 ? t->node_component[node[e]] : component;
    }
    return node[0] == node[1] ? -1 : component;
}

static enum dalcs_status list_held(struct dalcs_layout *l) {
    const struct dalcs_circuit *c = l->circuit;
    if (!l->options->clamp_initial_conditions) {
        return DALCS_OK;
    }
    int *component = dalcs_alloc((size_t)c->n_initial_conditions, sizeof(*component));
    if (component == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < c->n_initial_conditions; k++) {
        component[k] = holding_component(l, &c->initial_condition[k]);
    }
    enum dalcs_status status = list_members(c->n_initial_conditions, component,
                                            l->topology.n_components, &l->held_start, &l->held);
    free(component);
    return status;
}

static enum dalcs_status assemble_all(struct dalcs_network *network, struct dalcs_layout *l) {
    const struct dalcs_circuit *c = l->circuit;
    int n = l->topology.n_components;
    int *device_start = NULL;
    int *device = NULL;
    int *node_start = NULL;
    int *node = NULL;
    int *representative = dalcs_alloc((size_t)c->n_nodes, sizeof(*representative));
    network->system = dalcs_alloc((size_t)n, sizeof(*network->system));
    network->initial = dalcs_alloc((size_t)n, sizeof(*network->initial));
    enum dalcs_status status = DALCS_E_NOMEM;
    if (representative == NULL || network->system == NULL || network->initial == NULL) {
        goto done;
    }
    for (int i = 0; i < c->n_nodes; i++) {
        representative[i] = l->topology.node_of[i] == i ? l->topology.node_component[i] : -1;
    }
    status = list_members(c->n_devices, l->topology.device_component, n, &device_start, &device);
    if (status == DALCS_OK) {
        status = list_members(c->n_nodes, representative, n, &node_start, &node);
    }
    for (int k = 0; k < n && status == DALCS_OK; k++) {
        status = dalcs_assemble_component(l, device_start[k + 1] - device_start[k],
                                          device + device_start[k],
                                          node_start[k + 1] - node_start[k], node + node_start[k],
                                          &network->system[k], &network->initial[k]);
        network->n_systems = k + 1;
    }
done:
    free(device_start);
    free(device);
    free(node_start);
    free(node);
    free(representative);
    return status;
}

/* ---- Probes -------------------------------------------------------------------------------- */

struct probe_terms {
    int n;
    struct dalcs_probe_term term[1];
};

static void put(struct probe_terms *t, int column, double coefficient) {
    if (column >= 0) {
        t->term[t->n++] = (struct dalcs_probe_term){column, coefficient};
    }
}

static enum dalcs_status keep_probe(struct dalcs_network *network, struct dalcs_probe *probe,
                                    int system, const struct dalcs_probe_term *term, int n_terms,
                                    int n_inputs) {
    if (n_terms + n_inputs == 0) {
        *probe = (struct dalcs_probe){.system = -1};
        return DALCS_OK;
    }
    *probe = (struct dalcs_probe){.system = system, .n_terms = n_terms, .n_inputs = n_inputs};
    size_t n = (size_t)(n_terms + n_inputs);
    probe->term = dalcs_arena_alloc(&network->arena, n, sizeof(*probe->term));
    if (probe->term == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        probe->term[k] = term[k];
    }
    return DALCS_OK;
}

static enum dalcs_status current_probe(struct dalcs_network *network, const struct dalcs_layout *l,
                                       int device, struct dalcs_probe *probe) {
    int system = l->topology.device_component[device];
    if (system < 0) {
        return keep_probe(network, probe, -1, NULL, 0, 0);
    }
    struct dalcs_current current;
    DALCS_TRY(dalcs_layout_current(l, &network->system[system], device, &network->arena, &current));
    return keep_probe(network, probe, system, current.term, current.n_terms, current.n_inputs);
}

static enum dalcs_status node_probe(struct dalcs_network *network, const struct dalcs_layout *l,
                                    int node, struct dalcs_probe *probe) {
    struct probe_terms t = {0};
    put(&t, dalcs_stamp_node_column(l, node), 1.0);
    int system = l->topology.node_component[l->topology.node_of[node]];
    return keep_probe(network, probe, system, t.term, t.n, 0);
}

static enum dalcs_status build_outputs(struct dalcs_network *network,
                                       const struct dalcs_layout *l) {
    const struct dalcs_circuit *c = l->circuit;
    network->n_outputs = c->n_signals;
    network->output =
        dalcs_arena_alloc(&network->arena, (size_t)c->n_signals, sizeof(*network->output));
    if (network->output == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < c->n_signals; i++) {
        const struct dalcs_signal *signal = &c->signal[i];
        struct dalcs_output *out = &network->output[i];
        out->name = signal->name;
        out->is_current = signal->kind == DALCS_SIGNAL_CURRENT;
        out->plus.system = -1;
        out->minus.system = -1;
        if (out->is_current) {
            DALCS_TRY(current_probe(network, l, signal->device, &out->plus));
        } else {
            DALCS_TRY(node_probe(network, l, signal->node[0], &out->plus));
            DALCS_TRY(node_probe(network, l, signal->node[1], &out->minus));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status build_states(struct dalcs_network *network, const struct dalcs_layout *l) {
    const struct dalcs_circuit *c = l->circuit;
    for (int i = 0; i < c->n_devices; i++) {
        network->n_states +=
            c->device[i].kind == DALCS_CAPACITOR || c->device[i].kind == DALCS_INDUCTOR ? 1 : 0;
    }
    network->state =
        dalcs_arena_alloc(&network->arena, (size_t)network->n_states, sizeof(*network->state));
    if (network->state == NULL) {
        return DALCS_E_NOMEM;
    }
    int k = 0;
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (d->kind == DALCS_CAPACITOR) {
            struct dalcs_state *state = &network->state[k++];
            state->element = d->name;
            struct probe_terms t = {0};
            put(&t, l->state_column[i], 1.0);
            DALCS_TRY(keep_probe(network, &state->probe, l->topology.device_component[i], t.term,
                                 t.n, 0));
        } else if (d->kind == DALCS_INDUCTOR) {
            struct dalcs_state *state = &network->state[k++];
            state->element = d->name;
            state->is_current = true;
            DALCS_TRY(current_probe(network, l, i, &state->probe));
        }
    }
    return DALCS_OK;
}

/* Does any element stand at ground? Of most netlists in which none does, ground was forgotten. */
static bool has_ground(const struct dalcs_circuit *c) {
    bool found = false;
    for (int i = 0; i < c->n_devices; i++) {
        found = found || c->device[i].node[0] == 0 || c->device[i].node[1] == 0;
    }
    return found;
}

/* Islands that nothing ties to ground have their voltages by convention, and a person should know. */
static void note_references(const struct dalcs_layout *l, struct dalcs_diag *diag) {
    const struct dalcs_circuit *c = l->circuit;
    const char *hint =
        has_ground(c) ? NULL : "no element is at ground: call the node that it is 0 or gnd";
    for (int n = 1; n < c->n_nodes; n++) {
        if (l->topology.is_reference[n]) {
            dalcs_diag_add(
                diag, DALCS_NOTE, NULL, hint,
                "nothing connects node '%s' and the part around it to ground: its voltage is 0 by "
                "convention, the others of that part are relative to it",
                c->node_name[n]);
        }
    }
}

/* A voltage across a short is 0, whatever .ic says. */
static enum dalcs_status check_initial_conditions(const struct dalcs_layout *l,
                                                  struct dalcs_diag *diag) {
    const struct dalcs_circuit *c = l->circuit;
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < c->n_initial_conditions; k++) {
        const struct dalcs_initial_condition *ic = &c->initial_condition[k];
        int node = l->topology.node_of[ic->node[0]];
        if (node == l->topology.node_of[ic->node[1]] && ic->value != 0.0) {
            dalcs_diag_add(diag, DALCS_ERROR, &ic->where, "shorts join its two nodes",
                           "this voltage is 0 always");
            status = DALCS_E_NETLIST;
        }
    }
    return status;
}

enum dalcs_status dalcs_network_build(struct dalcs_network *network,
                                      const struct dalcs_circuit *circuit,
                                      const struct dalcs_network_options *options,
                                      struct dalcs_diag *diag) {
    *network = (struct dalcs_network){.n_nodes = circuit->n_nodes - 1};
    struct dalcs_layout layout = {.circuit = circuit, .options = options};
    enum dalcs_status status = DALCS_E_NOMEM;
    bool *wants_current = dalcs_alloc((size_t)circuit->n_devices, sizeof(*wants_current));
    if (wants_current == NULL) {
        goto done;
    }
    dalcs_circuit_mark_wanted_currents(circuit, wants_current);
    status = layout_allocate(&layout);
    if (status == DALCS_OK) {
        status = dalcs_topology_build(&layout.topology, circuit, wants_current);
    }
    if (status == DALCS_OK) {
        status = dalcs_source_mark_idle(circuit, wants_current, layout.topology.is_idle);
    }
    if (status == DALCS_OK && !options->clamp_initial_conditions && !options->silent) {
        status = dalcs_capacitive_parts_note(circuit, diag);
    }
    if (status == DALCS_OK) {
        if (!options->clamp_initial_conditions && !options->silent) {
            note_references(&layout, diag);
        }
        status = check_initial_conditions(&layout, diag);
    }
    if (status == DALCS_OK) {
        status = find_groups(&layout, diag);
    }
    if (status == DALCS_OK) {
        status = dalcs_initial_voltages_setup(&layout.initial_voltages, circuit,
                                              layout.topology.node_of);
    }
    if (status == DALCS_OK) {
        status = list_held(&layout);
    }
    if (status == DALCS_OK) {
        status = assemble_all(network, &layout);
    }
    if (status == DALCS_OK) {
        status = build_outputs(network, &layout);
    }
    if (status == DALCS_OK) {
        status = build_states(network, &layout);
    }
    if (status == DALCS_OK) {
        status = dalcs_power_build(network, &layout);
    }
    if (status == DALCS_OK && options->with_readout) {
        status = dalcs_readout_build(network, &layout);
    }
done:
    free(wants_current);
    layout_finish(&layout);
    if (status != DALCS_OK) {
        dalcs_network_finish(network);
    }
    return status;
}

void dalcs_network_finish(struct dalcs_network *network) {
    for (int k = 0; k < network->n_systems; k++) {
        dalcs_system_finish(&network->system[k]);
        free(network->initial[k]);
    }
    free(network->system);
    free(network->initial);
    free(network->jumps_are_covered);
    struct dalcs_network *of_file[] = {network->held, network->jump[0], network->jump[1]};
    for (size_t k = 0; k < sizeof of_file / sizeof *of_file; k++) {
        if (of_file[k] != NULL) {
            dalcs_network_finish(of_file[k]);
            free(of_file[k]);
        }
    }
    dalcs_arena_finish(&network->arena);
    *network = (struct dalcs_network){0};
}
