/* audit_members.c - which nodes, currents and pairs belong to a part, and where its columns are. */
#include "audit_reader.h"

#include <string.h>

static bool is_new(bool *seen, int node) {
    const bool was = seen[node];
    seen[node] = true;
    return !was;
}

/* Counts, or lists where there is room, the nodes and currents of all parts. */
static void list_members(const struct dalcs_audit_run *a, bool *seen, bool lists) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    const struct dalcs_readout *r = a->run->s->network.readout;
    int next_lambda = 0;
    memset(seen, 0, (size_t)c->n_nodes * sizeof *seen);
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        const int n_lambdas = d->behaviour != NULL ? d->behaviour->n_pairs : 0;
        if (r->device_system[i] < 0) {
            next_lambda += n_lambdas;
            continue;
        }
        struct audit_members *m = &a->part[r->device_system[i]];
        for (int e = 0; e < 4; e++) {
            const int node = d->node[e];
            if (node > 0 && r->node_column[node] >= 0 && is_new(seen, node)) {
                if (lists) {
                    m->node[m->n_nodes] = node;
                    m->node_column[m->n_nodes] = r->node_column[node];
                }
                m->n_nodes++;
            }
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
}

enum dalcs_status dalcs_audit_members_make(struct dalcs_audit_run *a) {
    const int n = a->run->s->network.n_systems;
    bool *seen = dalcs_arena_alloc(&a->arena, (size_t)a->run->s->circuit.n_nodes, sizeof(*seen));
    a->part = dalcs_arena_alloc(&a->arena, (size_t)n, sizeof(*a->part));
    if (seen == NULL || a->part == NULL) {
        return DALCS_E_NOMEM;
    }
    list_members(a, seen, false);
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
        m->last_mode = dalcs_arena_alloc(&a->arena, (size_t)a->euler->component[k].osnsp.n_words,
                                         sizeof(uint64_t));
        if (m->last_mode == NULL || m->node == NULL || m->node_column == NULL ||
            m->device == NULL || m->lambda == NULL || m->lambda_pair == NULL) {
            return DALCS_E_NOMEM;
        }
        m->n_nodes = m->n_devices = m->n_lambdas = 0;
    }
    list_members(a, seen, true);
    return DALCS_OK;
}
