/* audit_members.c - which nodes, currents and pairs belong to a part, and where its columns are. */
#include "audit_reader.h"

#include <string.h>

/* A node whose voltage system `of` has, if it is not listed yet. Returns whether it is. */
static bool add_node(const struct dalcs_audit_run *a, int *system, int node, int of, bool lists) {
    const int column = a->run->s->network.readout->node_column[node];
    if (node == 0 || column < 0 || system[node] >= 0) {
        return false;
    }
    struct audit_members *m = &a->part[of];
    if (lists) {
        m->node[m->n_nodes] = node;
        m->node_column[m->n_nodes] = column;
    }
    m->n_nodes++;
    system[node] = of;
    return true;
}

/* Nodes that hang on shorts alone, which are in no system: a formula may read them. */
static void add_shorted_nodes(const struct dalcs_audit_run *a, int *system, bool lists) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    bool grows = true;
    while (grows) {
        grows = false;
        for (int i = 0; i < c->n_devices; i++) {
            const int *node = c->device[i].node;
            for (int e = 0; e < 2 && dalcs_device_is_short(&c->device[i]); e++) {
                const int of = node[e] > 0 ? system[node[e]] : -1;
                grows = (of >= 0 && add_node(a, system, node[1 - e], of, lists)) || grows;
            }
        }
    }
}

/* Counts, or lists where there is room, the nodes and currents of all parts. */
static void list_members(const struct dalcs_audit_run *a, int *system, bool lists) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    const struct dalcs_readout *r = a->run->s->network.readout;
    int next_lambda = 0;
    memset(system, -1, (size_t)c->n_nodes * sizeof *system);
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        const int n_lambdas = d->behaviour != NULL ? d->behaviour->n_pairs : 0;
        if (r->device_system[i] < 0) {
            next_lambda += n_lambdas;
            continue;
        }
        struct audit_members *m = &a->part[r->device_system[i]];
        for (int e = 0; e < 4; e++) {
            add_node(a, system, d->node[e], r->device_system[i], lists);
        }
        if (r->start[i + 1] > r->start[i] || d->kind == DALCS_SWITCH) {
            if (lists) {
                m->device[m->n_devices] = i;
            }
            m->n_devices++;
        }
        for (int k = 0; k < n_lambdas; k++) {
            if (lists) {
                m->lambda[m->n_lambdas] = next_lambda + k;
                m->lambda_pair[m->n_lambdas] = r->first_pair[i] + k;
                a->pair_of_lambda[next_lambda + k] = r->first_pair[i] + k;
            }
            m->n_lambdas++;
        }
        next_lambda += n_lambdas;
    }
    add_shorted_nodes(a, system, lists);
}

enum dalcs_status dalcs_audit_members_make(struct dalcs_audit_run *a) {
    const int n = a->run->s->network.n_systems;
    int *system = dalcs_arena_alloc(&a->arena, (size_t)a->run->s->circuit.n_nodes, sizeof(*system));
    a->part = dalcs_arena_alloc(&a->arena, (size_t)n, sizeof(*a->part));
    if (system == NULL || a->part == NULL) {
        return DALCS_E_NOMEM;
    }
    list_members(a, system, false);
    int n_lambdas = 0;
    for (int i = 0; i < a->run->s->circuit.n_devices; i++) {
        const struct dalcs_behaviour *b = a->run->s->circuit.device[i].behaviour;
        n_lambdas += b != NULL ? b->n_pairs : 0;
    }
    a->pair_of_lambda = dalcs_arena_alloc(&a->arena, (size_t)n_lambdas, sizeof(int));
    if (a->pair_of_lambda == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < n; k++) {
        struct audit_members *m = &a->part[k];
        m->node = dalcs_arena_alloc(&a->arena, (size_t)m->n_nodes, sizeof(int));
        m->node_column = dalcs_arena_alloc(&a->arena, (size_t)m->n_nodes, sizeof(int));
        m->device = dalcs_arena_alloc(&a->arena, (size_t)m->n_devices, sizeof(int));
        m->lambda = dalcs_arena_alloc(&a->arena, (size_t)m->n_lambdas, sizeof(int));
        m->lambda_pair = dalcs_arena_alloc(&a->arena, (size_t)m->n_lambdas, sizeof(int));
        m->last.mode = dalcs_arena_alloc(&a->arena, (size_t)a->euler->component[k].osnsp.n_words,
                                         sizeof(uint64_t));
        if (m->last.mode == NULL || m->node == NULL || m->node_column == NULL ||
            m->device == NULL || m->lambda == NULL || m->lambda_pair == NULL) {
            return DALCS_E_NOMEM;
        }
        m->n_nodes = m->n_devices = m->n_lambdas = 0;
    }
    list_members(a, system, true);
    return DALCS_OK;
}
