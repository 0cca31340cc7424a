/* threshold_check.c - warnings about switches and inputs of gates whose control moves and never reaches the threshold.
 *
 * A gate of 1 V at a switch with Vt = 2.5, or at a flip-flop with Vhigh = 5, runs without an error and without a single
 * event. Only what sources decide is judged: V sources, outputs of gates, and formulas of few values, from the two
 * control nodes or from each of them to ground. A control that rests is meant to. */
#include "behaviour.h"
#include "compiler.h"
#include "element_cards.h"
#include "transistor.h"

#include <math.h>

struct check {
    struct dalcs_builder *builder;
    struct dalcs_gate_links links;
    size_t *first;  /* [n_nodes] a formula of few values that begins there, + 1; 0: there is none */
    size_t *next;   /* [formulas.n] the one behind it, likewise */
    bool *is_input; /* [n_devices] the comparator of a gate's input */
};

static bool set_up(struct check *c) {
    struct dalcs_builder *builder = c->builder;
    const struct dalcs_circuit *circuit = builder->circuit;
    const size_t n = builder->formulas.n;
    c->first = dalcs_arena_alloc(&builder->scratch, (size_t)circuit->n_nodes, sizeof *c->first);
    c->next = dalcs_arena_alloc(&builder->scratch, n + 1, sizeof *c->next);
    c->is_input = dalcs_arena_alloc(&builder->scratch, (size_t)circuit->n_devices, sizeof(bool));
    if (c->first == NULL || c->next == NULL || c->is_input == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    for (size_t k = n; k-- > 0;) {
        const struct dalcs_gate *gate = builder->formulas.source[k].gate;
        if (gate != NULL) {
            size_t *first = &c->first[dalcs_gate_node(gate)];
            c->next[k] = *first;
            *first = k + 1;
        }
    }
    for (int k = 0; k < circuit->control.n_comparators; k++) {
        c->is_input[circuit->control.comparator[k]] = true;
    }
    return dalcs_gate_list_links(builder, &c->links);
}

/* Of the values of a formula between these nodes, either way round. */
static struct dalcs_gate_range of_formula(const struct check *c, int node, int reference) {
    struct dalcs_gate_range r = {0};
    for (int turn = 0; turn < 2; turn++) {
        size_t k = c->first[turn == 0 ? node : reference];
        for (; k > 0 && !r.is_known; k = c->next[k - 1]) {
            r.is_known = dalcs_gate_bounds(c->builder->formulas.source[k - 1].gate, node, reference,
                                           &r.low, &r.high);
        }
    }
    return r;
}

/* v(node, reference), of the one source between them. */
static struct dalcs_gate_range potential(const struct check *c, int node, int reference) {
    const struct dalcs_gate_range r =
        dalcs_gate_voltage(c->builder->circuit, &c->links, node, reference);
    return r.is_known ? r : of_formula(c, node, reference);
}

static struct dalcs_gate_range control_range(const struct check *c, const int *node) {
    const struct dalcs_gate_range direct = potential(c, node[0], node[1]);
    if (direct.is_known) {
        return direct;
    }
    const struct dalcs_gate_range plus = potential(c, node[0], 0);
    const struct dalcs_gate_range minus = potential(c, node[1], 0);
    return (struct dalcs_gate_range){plus.is_known && minus.is_known, plus.low - minus.high,
                                     plus.high - minus.low};
}

static void check_switch(const struct check *c, int k) {
    struct dalcs_builder *builder = c->builder;
    const struct dalcs_device *device = &builder->circuit->device[k];
    const struct dalcs_switch_model *m = &builder->circuit->models.of_switch[device->model];
    const bool is_gate = c->is_input[k];
    const struct dalcs_gate_range r = control_range(c, device->node + 2);
    if (!r.is_known || !(r.low < r.high) || m->vh < 0) {
        return;
    }
    const double low = m->is_inverted ? -r.high : r.low;
    const double high = m->is_inverted ? -r.low : r.high;
    const bool stays_open = !device->initially_on && high <= m->vt + m->vh;
    const bool stays_closed = low > m->vt - m->vh && (device->initially_on || low > m->vt + m->vh);
    if (!stays_open && !stays_closed) {
        return;
    }
    const double at = (m->is_inverted ? -1 : 1) * (stays_open ? m->vt + m->vh : m->vt - m->vh);
    const char *side = stays_open != m->is_inverted ? "above" : "below";
    const char *stays = is_gate      ? stays_open ? "it stays 0" : "it stays 1"
                        : stays_open ? "it stays open"
                                     : "it stays closed";
    const char *hint = is_gate ? "Ref= is the threshold; without it that is half way between Vlow "
                                 "and Vhigh of what reads"
                               : "Vt= of its model is the threshold, the third and the fourth node "
                                 "are its control";
    dalcs_builder_warn_at(builder, &device->where, hint,
                          "what commands '%s' moves from %g to %g V and is never %s %g V: %s",
                          device->name, r.low + 0.0, r.high + 0.0, side, at, stays); /* no -0 */
}

void dalcs_threshold_check(struct dalcs_builder *builder) {
    const struct dalcs_circuit *circuit = builder->circuit;
    struct check check = {.builder = builder};
    if (circuit->models.n_switches == 0 || !set_up(&check)) {
        return;
    }
    for (int k = 0; k < circuit->n_devices; k++) {
        const struct dalcs_device *device = &circuit->device[k];
        if (device->kind == DALCS_SWITCH && device->model >= 0 && device->behaviour == NULL &&
            (device->letter == 's' || check.is_input[k])) {
            check_switch(&check, k);
        }
    }
}
