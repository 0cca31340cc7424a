/* loop_shorts.c - which shorts belong to a loop that has no solution.
 *
 * A short (R of 0 ohm, L of 0 H) makes its two nodes one and leaves no equation, so the engine cannot
 * name it. The loop passes through it where it lies between two nodes that other elements of the loop
 * are on: in a forest of shorts, what is left when branches that end at other nodes are cut off. */
#include "session_internal.h"

#include "union_find.h"

#include <stdlib.h>

/* A forest of shorts, for cutting leaves: a leaf's only branch is the sum of its branches. */
struct forest {
    int *parent;     /* [n_nodes] of a union-find */
    int *n_branches; /* [n_nodes] */
    int *branch_sum; /* [n_nodes] exclusive or of the branches' devices */
    bool *is_end;    /* [n_nodes] an element of the loop is on the node */
    bool *is_asked;  /* [n_devices] for its current: it has an equation after all */
};

static void plant(struct forest *f, const struct dalcs_circuit *c, const bool *is_named,
                  bool *is_part) {
    dalcs_union_reset(f->parent, c->n_nodes);
    dalcs_circuit_mark_wanted_currents(c, f->is_asked);
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        bool is_short = dalcs_device_is_short(d) && !f->is_asked[i];
        is_part[i] = is_short && dalcs_union_join(f->parent, d->node[0], d->node[1]);
        for (int e = 0; e < 2; e++) {
            f->is_end[d->node[e]] = f->is_end[d->node[e]] || is_named[i];
            f->n_branches[d->node[e]] += is_part[i] ? 1 : 0;
            f->branch_sum[d->node[e]] ^= is_part[i] ? i : 0;
        }
    }
}

static void cut_leaves(struct forest *f, const struct dalcs_circuit *c, bool *is_part) {
    for (int n = 0; n < c->n_nodes; n++) {
        for (int leaf = n; f->n_branches[leaf] == 1 && !f->is_end[leaf];) {
            int branch = f->branch_sum[leaf];
            const int *node = c->device[branch].node;
            int other = node[0] == leaf ? node[1] : node[0];
            is_part[branch] = false;
            f->n_branches[leaf] = 0;
            f->n_branches[other]--;
            f->branch_sum[other] ^= branch;
            leaf = other;
        }
    }
}

enum dalcs_status dalcs_loop_shorts_find(const struct dalcs_circuit *circuit, const bool *is_named,
                                         bool *is_part) {
    size_t n_nodes = (size_t)circuit->n_nodes;
    struct forest f = {.parent = dalcs_alloc(n_nodes, sizeof(int)),
                       .n_branches = dalcs_alloc(n_nodes, sizeof(int)),
                       .branch_sum = dalcs_alloc(n_nodes, sizeof(int)),
                       .is_end = dalcs_alloc(n_nodes, sizeof(bool)),
                       .is_asked = dalcs_alloc((size_t)circuit->n_devices, sizeof(bool))};
    bool complete = f.parent != NULL && f.n_branches != NULL && f.branch_sum != NULL &&
                    f.is_end != NULL && f.is_asked != NULL;
    if (complete) {
        plant(&f, circuit, is_named, is_part);
        cut_leaves(&f, circuit, is_part);
    }
    free(f.parent);
    free(f.n_branches);
    free(f.branch_sum);
    free(f.is_end);
    free(f.is_asked);
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}
