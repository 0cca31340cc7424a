/* held_start.c - .ic of voltages that sources hold.
 *
 * SPICE holds an initial voltage behind a conductance while it seeks the operating point (1e10 S in ngspice), so a source
 * between the same nodes wins. Here both would be equations, and contradict each other: what sources hold is left out,
 * and where they give another value that is said. With uic it is the voltage of capacitors, as in SPICE. Nodes that
 * sources join are a tree, with a voltage of each against its root (Tarjan 1975, union by offsets). What
 * formulas put out is not known before the start: such a source stays in contradiction, as an error. A gate of LTspice
 * has a resistance there (output_resistance.c), and .ic wins, as in LTspice. */

#include "analysis_cards.h"
#include "rounding.h"
#include "stimulus.h"

#include <math.h>
#include <string.h>

/* Nodes below their roots; above[node]: V of a node above its parent. */
struct held {
    int *parent;
    double *above;
};

static int find(struct held *h, int node, double *above) {
    *above = 0;
    while (h->parent[node] != node) {
        *above += h->above[node];
        node = h->parent[node];
    }
    return node;
}

/* v(a) - v(b) = volts; what the tree has already stays. */
static void join(struct held *h, int a, int b, double volts) {
    double above_a;
    double above_b;
    const int root_a = find(h, a, &above_a);
    const int root_b = find(h, b, &above_b);
    if (root_a != root_b) {
        h->parent[root_a] = root_b;
        h->above[root_a] = volts + above_b - above_a;
    }
}

static bool make(struct dalcs_builder *builder, struct held *h) {
    const struct dalcs_circuit *circuit = builder->circuit;
    const size_t n = (size_t)circuit->n_nodes;
    h->parent = dalcs_arena_alloc(&builder->scratch, n, sizeof *h->parent);
    h->above = dalcs_arena_alloc(&builder->scratch, n, sizeof *h->above);
    if (h->parent == NULL || h->above == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    for (size_t k = 0; k < n; k++) {
        h->parent[k] = (int)k;
    }
    for (int k = 0; k < circuit->n_devices; k++) {
        const struct dalcs_device *d = &circuit->device[k];
        const struct dalcs_stimulus *s =
            d->kind == DALCS_VSOURCE && d->stimulus >= 0 ? &circuit->stimulus[d->stimulus] : NULL;
        if (s != NULL && !s->is_written && s->kind != DALCS_STIMULUS_DELAYED &&
            s->kind != DALCS_STIMULUS_FORMULA) {
            join(h, d->node[0], d->node[1], dalcs_stimulus_operating_value(s, true));
        }
    }
    return true;
}

static void tell(struct dalcs_builder *builder, const struct dalcs_initial_condition *ic,
                 double held) {
    const char *a = builder->elements.node_name[ic->node[0]];
    const char *b = ic->node[1] != 0 ? builder->elements.node_name[ic->node[1]] : NULL;
    dalcs_diag_add(
        builder->diag, DALCS_WARNING, &ic->where,
        "initial voltages are of nodes that nothing holds but what is stored",
        "sources hold v(%s%s%s) at %.9g V, and win against the %.9g V of .ic, as in SPICE", a,
        b != NULL ? "," : "", b != NULL ? b : "", held, ic->value);
}

void dalcs_initial_leave_held(struct dalcs_builder *builder) {
    struct held h;
    size_t n = 0;
    if (builder->analyses.n_initial_conditions == 0 || builder->failed ||
        builder->circuit->analyses.transient.use_initial_conditions ||
        builder->circuit->analyses.periodic.use_initial_conditions || !make(builder, &h)) {
        return;
    }
    for (size_t k = 0; k < builder->analyses.n_initial_conditions; k++) {
        const struct dalcs_initial_condition ic = builder->analyses.initial_condition[k];
        double above[2];
        const bool is_held = find(&h, ic.node[0], &above[0]) == find(&h, ic.node[1], &above[1]);
        const double held = above[0] - above[1];
        const double size = fmax(fabs(above[0]), fabs(above[1]));
        if (is_held && !(fabs(held - ic.value) <= dalcs_rounded * size)) {
            tell(builder, &ic, held);
        }
        if (!is_held) {
            builder->analyses.initial_condition[n++] = ic;
        }
    }
    builder->analyses.n_initial_conditions = n;
}
