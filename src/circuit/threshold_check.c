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
};

/* Of the values of a formula between these nodes. */
static struct dalcs_gate_range of_formula(const struct check *c, int node, int reference) {
    struct dalcs_gate_range r = {0};
    for (size_t k = 0; k < c->builder->formulas.n && !r.is_known; k++) {
        const struct dalcs_gate *gate = c->builder->formulas.source[k].gate;
        r.is_known = gate != NULL && dalcs_gate_bounds(gate, node, reference, &r.low, &r.high);
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

/* Is it the comparator of a gate's input? */
static bool is_input(const struct dalcs_circuit *c, int device) {
    bool is = false;
    for (int k = 0; k < c->control.n_comparators && !is; k++) {
        is = c->control.comparator[k] == device;
    }
    return is;
}

static void check_switch(const struct check *c, int k) {
    struct dalcs_builder *builder = c->builder;
    const struct dalcs_device *device = &builder->circuit->device[k];
    const struct dalcs_switch_model *m = &builder->circuit->models.of_switch[device->model];
    const bool is_gate = is_input(builder->circuit, k);
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
    if (circuit->models.n_switches == 0 || !dalcs_gate_list_links(builder, &check.links)) {
        return;
    }
    for (int k = 0; k < circuit->n_devices; k++) {
        const struct dalcs_device *device = &circuit->device[k];
        if (device->kind == DALCS_SWITCH && device->model >= 0 && device->behaviour == NULL &&
            (device->letter == 's' || is_input(circuit, k))) {
            check_switch(&check, k);
        }
    }
}
