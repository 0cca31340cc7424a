/* logic_inputs.c - what becomes of a gate's inputs: comparators, and who reads whom.
 *
 * An input that another gate's output drives reads its bit; any other is a comparator: a switch that nothing flows in,
 * from an inner node with a resistor to ground, so that its control, its threshold and its events are those of all
 * switches. Gates that read the same against the same threshold have one comparator, for their inputs change together. */
#include "logic_parts.h"

#include "element_cards.h"
#include "model_cards.h"
#include "result_cards.h"

#include <math.h>

/* A switch that closes there. */
static struct dalcs_device *add_comparator(struct dalcs_builder *builder,
                                           const struct dalcs_logic_card *of, int k) {
    const struct dalcs_logic_pin *pin = &of->pin[k];
    const char *what = dalcs_builder_hint(builder, "in%d", k + 1);
    struct dalcs_device *s = dalcs_builder_add_inner_device(builder, DALCS_SWITCH, what, of->name);
    struct dalcs_device *r =
        dalcs_builder_add_inner_device(builder, DALCS_RESISTOR, what, of->name);
    const int node = dalcs_builder_inner_node(builder, what, of->name);
    const struct dalcs_switch_model model = {.name = "comparator",
                                             .ron = 1,
                                             .roff = (double)INFINITY,
                                             .vt = 0.5 * (of->on + of->off),
                                             .vh = 0.5 * (of->on - of->off)};
    const int index = dalcs_switch_add_model(builder, &model);
    if (s == NULL || r == NULL || node < 0 || index < 0) {
        return NULL;
    }
    s->node[0] = r->node[0] = node;
    s->node[1] = r->node[1] = 0;
    s->node[2] = pin->node;
    s->node[3] = pin->reference;
    s->model = index;
    r->value = 1;
    return s;
}

/* The place among comparators of one that closes there; -1: out of memory. */
static int find_comparator(struct dalcs_builder *builder, const struct dalcs_logic_card *of,
                           int k) {
    struct dalcs_circuit *circuit = builder->circuit;
    const struct dalcs_logic_pin *pin = &of->pin[k];
    const char *key =
        dalcs_builder_hint(builder, "%d %d %a %a", pin->node, pin->reference, of->on, of->off);
    int place;
    if (key == NULL ||
        dalcs_names_find_or_add(&builder->logic.comparators, key, circuit->control.n_comparators,
                                &place) != DALCS_OK) {
        builder->out_of_memory = true;
        return -1;
    }
    if (place == circuit->control.n_comparators) {
        const struct dalcs_device *s = add_comparator(builder, of, k);
        if (s == NULL) {
            return -1;
        }
        circuit->control.comparator[circuit->control.n_comparators++] = (int)(s - circuit->device);
    }
    return place;
}

/* Its outputs jump from one level to the other, and nothing pulls at them. */
static bool is_exact(const struct dalcs_logic_card *of) {
    return of->gate->kind != DALCS_GATE_SAMPLE && of->gate->rise == 0 && of->gate->fall == 0 &&
           of->ohms[0] == 0 && of->ohms[1] == 0;
}

/* A gate that drives a pin: twice its number, and one more where by its complement; -1: none, or not as this input
 * reads it: against another node, in the course of a ramp, or on one side of the threshold alone. */
static int driver_of(const struct dalcs_builder *builder,
                     const struct dalcs_logic_card *const *driver,
                     const struct dalcs_logic_card *of, const struct dalcs_logic_pin *pin) {
    const struct dalcs_logic_card *by = driver[pin->node];
    if (by == NULL || !is_exact(by) || by->common != pin->reference || by->gate->low >= of->off ||
        by->gate->high <= of->on) {
        return -1;
    }
    return 2 * (int)(by->gate - builder->circuit->control.gate) + (by->node[0] != pin->node);
}

static void resolve_input(struct dalcs_builder *builder,
                          const struct dalcs_logic_card *const *driver,
                          const struct dalcs_logic_card *of, int k) {
    const struct dalcs_logic_pin *pin = &of->pin[k];
    struct dalcs_logic_input *input = &of->gate->input[k];
    if (!pin->is_wired) {
        return;
    }
    const int by = driver_of(builder, driver, of, pin);
    if (by >= 0) {
        builder->logic.read_by_gates[pin->node] = true;
        *input =
            (struct dalcs_logic_input){DALCS_GATE_GATE, by / 2, (by % 2 != 0) != pin->is_inverted};
        return;
    }
    const int index = find_comparator(builder, of, k);
    if (index >= 0) {
        *input = (struct dalcs_logic_input){DALCS_GATE_COMPARATOR, index, pin->is_inverted};
    }
}

static void measure_sample(struct dalcs_builder *builder, const struct dalcs_logic_card *of) {
    builder->logic.read_by_gates[of->sampled.node] = true;
    builder->logic.read_by_gates[of->sampled.reference] = true;
    of->gate->sampled = dalcs_signals_measure(
        builder, (struct dalcs_signal){.name = of->gate->name,
                                       .kind = DALCS_SIGNAL_VOLTAGE,
                                       .device = -1,
                                       .node = {of->sampled.node, of->sampled.reference}});
}

void dalcs_logic_resolve(struct dalcs_builder *builder) {
    if (builder->logic.gate_card == NULL) {
        return;
    }
    const size_t n_nodes = (size_t)builder->circuit->n_nodes;
    const struct dalcs_logic_card **driver =
        dalcs_arena_alloc(&builder->scratch, n_nodes, sizeof(const struct dalcs_logic_card *));
    builder->logic.read_by_gates = dalcs_arena_alloc(&builder->scratch, n_nodes, sizeof(bool));
    if (driver == NULL || builder->logic.read_by_gates == NULL) {
        builder->out_of_memory = true;
        return;
    }
    /* Parts of formulas may have taken the room that was counted for them. */
    if (!dalcs_builder_reserve_devices(builder, 2 * builder->logic.comparator_capacity)) {
        return;
    }
    builder->logic.n_nodes_of_gates = n_nodes;
    for (const struct dalcs_logic_card *of = builder->logic.gate_card; of != NULL;
         of = of->before) {
        for (int k = 0; k < 2; k++) {
            if (of->node[k] >= 0) {
                driver[of->node[k]] = of;
            }
        }
    }
    for (const struct dalcs_logic_card *of = builder->logic.gate_card; of != NULL;
         of = of->before) {
        for (int k = 0; k < of->gate->n_inputs; k++) {
            resolve_input(builder, driver, of, k);
        }
        if (of->sampled.node != of->sampled.reference) {
            measure_sample(builder, of);
        }
    }
}
