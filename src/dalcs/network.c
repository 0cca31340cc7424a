/* network.c - the whole circuit: coil groups, components, and the probes that read the results. */
#include "network.h"

#include "capacitive_parts.h"
#include "coil_groups.h"
#include "layout.h"
#include "network_probes.h"
#include "source_conflicts.h"

#include <stdlib.h>

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
    status =
        dalcs_list_members(c->n_devices, l->topology.device_component, n, &device_start, &device);
    if (status == DALCS_OK) {
        status = dalcs_list_members(c->n_nodes, representative, n, &node_start, &node);
    }
    for (int k = 0; k < n && status == DALCS_OK; k++) {
        const struct dalcs_members members = {
            .n_devices = device_start[k + 1] - device_start[k],
            .device = device + device_start[k],
            .n_nodes = node_start[k + 1] - node_start[k],
            .node = node + node_start[k],
        };
        status = dalcs_assemble_component(l, &members, &network->system[k], &network->initial[k]);
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

/* Does any element stand at ground? Of most netlists in which none does, ground was forgotten. */
static bool has_ground(const struct dalcs_circuit *c) {
    bool found = false;
    for (int i = 0; i < c->n_devices; i++) {
        found = found || c->device[i].node[0] == 0 || c->device[i].node[1] == 0;
    }
    return found;
}

/* The voltages of islands without a connection to ground are a convention: a message says so. */
static void note_references(const struct dalcs_layout *l, struct dalcs_diag *diag) {
    const struct dalcs_circuit *c = l->circuit;
    const char *hint =
        has_ground(c) ? NULL : "no element is connected to ground: call the ground node 0 or gnd";
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

/* Checks of the graph, before there are equations. */
static enum dalcs_status look_at_graph(struct dalcs_layout *layout, const bool *wants_current,
                                       struct dalcs_diag *diag) {
    const struct dalcs_circuit *circuit = layout->circuit;
    const bool tells = !layout->options->clamp_initial_conditions && !layout->options->silent;
    DALCS_TRY(dalcs_topology_build(&layout->topology, circuit, wants_current));
    DALCS_TRY(dalcs_source_mark_idle(circuit, wants_current, layout->topology.is_idle));
    if (tells) {
        DALCS_TRY(dalcs_capacitive_parts_note(circuit, diag));
        note_references(layout, diag);
    }
    DALCS_TRY(check_initial_conditions(layout, diag));
    DALCS_TRY(dalcs_coil_groups_find(layout, diag));
    DALCS_TRY(
        dalcs_initial_voltages_setup(&layout->initial_voltages, circuit, layout->topology.node_of));
    return dalcs_layout_list_held(layout);
}

static enum dalcs_status build(struct dalcs_network *network, struct dalcs_layout *layout,
                               const bool *wants_current, struct dalcs_diag *diag) {
    DALCS_TRY(dalcs_layout_setup(layout));
    DALCS_TRY(look_at_graph(layout, wants_current, diag));
    DALCS_TRY(assemble_all(network, layout));
    DALCS_TRY(dalcs_network_build_outputs(network, layout));
    DALCS_TRY(dalcs_network_build_states(network, layout));
    DALCS_TRY(dalcs_power_build(network, layout));
    return layout->options->with_readout ? dalcs_readout_build(network, layout) : DALCS_OK;
}

enum dalcs_status dalcs_network_build(struct dalcs_network *network,
                                      const struct dalcs_circuit *circuit,
                                      const struct dalcs_network_options *options,
                                      struct dalcs_diag *diag) {
    *network = (struct dalcs_network){.n_nodes = circuit->n_nodes - 1};
    struct dalcs_layout layout = {.circuit = circuit, .options = options};
    enum dalcs_status status = DALCS_E_NOMEM;
    bool *wants_current = dalcs_alloc((size_t)circuit->n_devices, sizeof(*wants_current));
    if (wants_current != NULL) {
        dalcs_circuit_mark_wanted_currents(circuit, wants_current);
        status = build(network, &layout, wants_current, diag);
    }
    free(wants_current);
    dalcs_layout_finish(&layout);
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
