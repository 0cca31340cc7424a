/* transistor_gate.c - what voltage sources, and outputs of logic, say of a transistor's gate.
 *
 * The gate against the source, or both against ground where V sources or nothing but resistors hold the source; gate
 * resistors are passed over. */
#include "transistor.h"

#include <math.h>

enum { MOST_HOPS = 16 }; /* nodes that resistors lead to */

bool dalcs_gate_list_links(struct dalcs_builder *builder, struct dalcs_gate_links *links) {
    const struct dalcs_circuit *c = builder->circuit;
    links->first = dalcs_arena_alloc(&builder->scratch, (size_t)c->n_nodes, sizeof *links->first);
    links->next = dalcs_arena_alloc(&builder->scratch, (size_t)c->n_devices, sizeof *links->next);
    if (links->first == NULL || links->next == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    for (int i = c->n_devices - 1; i >= 0; i--) {
        const struct dalcs_device *d = &c->device[i];
        for (int e = 0; e < 2 && (d->kind == DALCS_VSOURCE || d->kind == DALCS_RESISTOR); e++) {
            links->next[i][e] = links->first[d->node[e]];
            links->first[d->node[e]] = 2 * i + e + 1;
        }
    }
    return true;
}

/* ---- Voltages that sources decide -------------------------------------------------------------------- */

static struct dalcs_gate_range between(double a, double b) {
    return (struct dalcs_gate_range){true, fmin(a, b), fmax(a, b)};
}

static struct dalcs_gate_range minus(const struct dalcs_gate_range *a,
                                     const struct dalcs_gate_range *b) {
    return (struct dalcs_gate_range){a->is_known && b->is_known, a->low - b->high,
                                     a->high - b->low};
}

/* What a gate puts out lies between its levels, also on its way; of a sample it is what was taken. */
static bool is_of_gate(const struct dalcs_circuit *c, int stimulus, struct dalcs_gate_range *r) {
    for (int k = 0; k < c->control.n_gates && !r->is_known; k++) {
        const struct dalcs_logic_gate *g = &c->control.gate[k];
        if (g->kind != DALCS_GATE_SAMPLE &&
            (g->output[0] == stimulus || g->output[1] == stimulus)) {
            *r = between(g->low, g->high);
        }
    }
    return r->is_known;
}

/* Of the V source that an end of a device is; from there to its other end. */
static struct dalcs_gate_range across(const struct dalcs_circuit *c, const struct dalcs_device *d,
                                      int end) {
    struct dalcs_gate_range r = {0};
    r.is_known = is_of_gate(c, d->stimulus, &r) ||
                 dalcs_stimulus_bounds(&c->stimulus[d->stimulus], &r.low, &r.high);
    return end == 0 ? r : (struct dalcs_gate_range){r.is_known, -r.high, -r.low};
}

/* v(node) against `reference` where a V source joins them; with_resistors: or one behind resistors. */
static struct dalcs_gate_range voltage(const struct dalcs_circuit *c,
                                       const struct dalcs_gate_links *links, int node,
                                       int reference, bool with_resistors) {
    int seen[MOST_HOPS] = {node};
    int n = 1;
    for (int k = 0; k < n; k++) {
        if (seen[k] == reference) {
            return between(0, 0);
        }
        for (int at = links->first[seen[k]]; at != 0;
             at = links->next[(at - 1) / 2][(at - 1) % 2]) {
            const struct dalcs_device *d = &c->device[(at - 1) / 2];
            const int end = (at - 1) % 2;
            if (d->kind == DALCS_VSOURCE && d->node[1 - end] == reference) {
                return across(c, d, end);
            }
        }
        for (int at = links->first[seen[k]]; at != 0 && with_resistors;
             at = links->next[(at - 1) / 2][(at - 1) % 2]) {
            const struct dalcs_device *d = &c->device[(at - 1) / 2];
            const int other = d->node[1 - (at - 1) % 2];
            bool is_new = d->kind == DALCS_RESISTOR && other != reference && n < MOST_HOPS;
            for (int i = 0; i < n; i++) {
                is_new = is_new && seen[i] != other;
            }
            if (is_new) {
                seen[n++] = other;
            }
        }
    }
    return (struct dalcs_gate_range){0};
}

struct dalcs_gate_range dalcs_gate_voltage(const struct dalcs_circuit *c,
                                           const struct dalcs_gate_links *links, int node,
                                           int reference) {
    return voltage(c, links, node, reference, false);
}

/* Do resistors alone lead to ground? */
static bool is_grounded(const struct dalcs_circuit *c, const struct dalcs_gate_links *links,
                        int node) {
    for (int at = links->first[node]; at != 0; at = links->next[(at - 1) / 2][(at - 1) % 2]) {
        const struct dalcs_device *d = &c->device[(at - 1) / 2];
        if (d->kind == DALCS_RESISTOR && d->node[1 - (at - 1) % 2] == 0) {
            return true;
        }
    }
    return false;
}

/* ---- Drives ------------------------------------------------------------------------------------------------ */

static struct dalcs_gate_range turned(const struct dalcs_gate_range *r, bool is_p) {
    return is_p ? (struct dalcs_gate_range){r->is_known, -r->high, -r->low} : *r;
}

struct dalcs_gate_drive dalcs_gate_drive_of(const struct dalcs_circuit *c,
                                            const struct dalcs_gate_links *links,
                                            const struct dalcs_transistor_use *use) {
    const bool is_p = use->of->is_p;
    struct dalcs_gate_range gate = voltage(c, links, use->gate, use->source, true);
    if (gate.is_known) {
        return (struct dalcs_gate_drive){.gate = turned(&gate, is_p), .is_decided = true};
    }
    gate = voltage(c, links, use->gate, 0, true);
    const struct dalcs_gate_range source = voltage(c, links, use->source, 0, false);
    if (source.is_known) {
        gate = minus(&gate, &source);
        return (struct dalcs_gate_drive){.gate = turned(&gate, is_p), .is_decided = gate.is_known};
    }
    const struct dalcs_gate_range drain = voltage(c, links, use->drain, 0, false);
    if (gate.is_known && drain.is_known) {
        gate = minus(&gate, &drain);
        return (struct dalcs_gate_drive){.gate = turned(&gate, is_p), .is_follower = true};
    }
    gate.is_known = gate.is_known && is_grounded(c, links, use->source);
    return (struct dalcs_gate_drive){.gate = turned(&gate, is_p)};
}
