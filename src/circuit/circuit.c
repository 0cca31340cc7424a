/* circuit.c - from cards to a circuit: finds the reader of each card, and the order in which cards are read.
 *
 *     classify   every card once: its reader, the memory that it needs, whether it is supported
 *     options    .options: what models may ask for
 *     models     .model, .tran, .op: what elements refer to
 *     elements   devices and nodes
 *     references K, F, H, .ic, .save, .dc, .ac, .step: what refers to elements
 *     measures   .meas, .four: what refers to analyses
 *     checks     of the whole
 *
 * Every pass goes on after an error, so that all errors are reported. */
#include "analysis_cards.h"
#include "card_table.h"
#include "element_cards.h"
#include "history.h"
#include "later.h"
#include "model_cards.h"
#include "output_resistance.h"
#include "result_cards.h"
#include "slips.h"
#include "storage.h"

#include <stdlib.h>
#include <string.h>

/* Counts what the arrays must hold, reports what is not supported. */
static enum dalcs_status classify_cards(struct dalcs_builder *builder, unsigned char *class_of) {
    const struct dalcs_deck *deck = builder->deck;
    size_t count[DALCS_N_CARD_CLASSES] = {0};
    struct dalcs_card_table table = {.builder = builder};
    for (size_t k = 0; k < deck->n_cards; k++) {
        const enum dalcs_card_class c = dalcs_card_table_classify(&table, &deck->card[k]);
        class_of[k] = (unsigned char)c;
        count[c]++;
    }
    dalcs_card_table_make_room(&table);
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_arena *arena = &circuit->arena;
    const size_t n_couplings = count[DALCS_CARD_COUPLING];
    const size_t n_devices = count[DALCS_CARD_ELEMENT] + table.n_inner;
    const size_t n_cards = count[DALCS_CARD_MODEL];
    /* and those that diodes name and the table knows, of which there are fewer than this */
    builder->logic.gate_capacity = table.n_gates;
    builder->logic.comparator_capacity = table.n_gate_inputs;
    const size_t n_models = n_cards + (table.n_diodes < 512 ? table.n_diodes : 512);
    builder->elements.n_device_cards = (int)n_devices;
    builder->elements.device_capacity = n_devices;
    builder->models.capacity = (int)n_models;
    builder->models.switch_capacity = n_cards;
    circuit->device = dalcs_arena_alloc(arena, n_devices, sizeof *circuit->device);
    circuit->stimulus = dalcs_arena_alloc(arena, table.n_stimuli, sizeof *circuit->stimulus);
    circuit->coupling = dalcs_arena_alloc(arena, table.n_pairs, sizeof *circuit->coupling);
    circuit->models.of_diode =
        dalcs_arena_alloc(arena, n_models + 1 + table.n_scaled, sizeof *circuit->models.of_diode);
    circuit->models.of_switch =
        dalcs_arena_alloc(arena, n_cards, sizeof *circuit->models.of_switch);
    builder->models.model =
        dalcs_arena_alloc(&builder->scratch, n_models, sizeof *builder->models.model);
    builder->elements.device_token = dalcs_arena_alloc(&builder->scratch, n_devices + n_couplings,
                                                       sizeof *builder->elements.device_token);
    builder->elements.control_token =
        dalcs_arena_alloc(&builder->scratch, n_devices, sizeof *builder->elements.control_token);
    builder->elements.current_of =
        dalcs_arena_alloc(&builder->scratch, n_devices, sizeof *builder->elements.current_of);
    const bool ok = circuit->device != NULL && circuit->stimulus != NULL &&
                    circuit->coupling != NULL && circuit->models.of_diode != NULL &&
                    circuit->models.of_switch != NULL && builder->models.model != NULL &&
                    builder->elements.device_token != NULL &&
                    builder->elements.control_token != NULL && builder->elements.current_of != NULL;
    if (dalcs_dialect_is_told(builder->netlist->dialect, DALCS_DIALECT_LTSPICE)) {
        builder->elements.default_rser =
            dalcs_arena_alloc(&builder->scratch, n_devices, sizeof *builder->elements.default_rser);
        return ok && builder->elements.default_rser != NULL ? DALCS_OK : DALCS_E_NOMEM;
    }
    return ok ? DALCS_OK : DALCS_E_NOMEM;
}

/* Before any card was understood. */
static bool has_errors(const struct dalcs_builder *builder) {
    return builder->netlist->has_errors || builder->deck->has_errors;
}

/* Errors that are nowhere: something that every netlist has is missing. */
static void check_presence(struct dalcs_builder *builder) {
    const struct dalcs_location where = {.file = builder->netlist->name};
    if (has_errors(builder)) {
        return;
    }
    if (builder->elements.n_device_cards == 0 && (builder->hidden & DALCS_HIDDEN_ELEMENTS) == 0) {
        dalcs_builder_error_at(builder, &where, "the first line is the title, never an element",
                               "the netlist has no elements");
    }
    const bool asks = builder->analyses.tran != NULL || builder->analyses.op != NULL ||
                      builder->analyses.dc != NULL || builder->analyses.ac != NULL ||
                      builder->analyses.pss != NULL || builder->analyses.tf != NULL ||
                      builder->netlist->commands.n > 0 || builder->netlist->asks.steady;
    if (!asks && (builder->hidden & DALCS_HIDDEN_ANALYSES) == 0) {
        dalcs_builder_error_at(builder, &where, "add a line such as: .tran 10u 20m",
                               "the netlist has no analysis: no .tran, .op, .dc or .ac");
    }
}

static enum dalcs_status collect_prints(struct dalcs_builder *builder) {
    struct dalcs_circuit *circuit = builder->circuit;
    const size_t n = builder->results.n_prints;
    const size_t n_columns = builder->results.n_print_columns;
    struct dalcs_print_column *column =
        dalcs_arena_alloc(&circuit->arena, n_columns, sizeof *column);
    circuit->results.print = dalcs_arena_alloc(&circuit->arena, n, sizeof *circuit->results.print);
    if (column == NULL || circuit->results.print == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n_columns; k++) {
        column[k] = builder->results.print_column[k];
    }
    circuit->results.n_prints = (int)n;
    for (size_t k = 0; k < n; k++) {
        circuit->results.print[k] = builder->results.print[k];
        circuit->results.print[k].column = column;
        column += circuit->results.print[k].n;
    }
    return DALCS_OK;
}

/* Moves what grew on the heap into the circuit's arena. */
static enum dalcs_status collect(struct dalcs_builder *builder) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_arena *arena = &circuit->arena;
    const size_t n_nodes = (size_t)circuit->n_nodes;
    circuit->node_name = dalcs_arena_alloc(arena, n_nodes, sizeof *circuit->node_name);
    circuit->results.signal = dalcs_arena_alloc(
        arena, builder->signals.n + builder->signals.n_measured, sizeof *circuit->results.signal);
    circuit->initial_condition = dalcs_arena_alloc(arena, builder->analyses.n_initial_conditions,
                                                   sizeof *circuit->initial_condition);
    circuit->title =
        dalcs_arena_copy(arena, builder->netlist->title, strlen(builder->netlist->title));
    if (circuit->node_name == NULL || circuit->results.signal == NULL ||
        circuit->initial_condition == NULL || circuit->title == NULL) {
        return DALCS_E_NOMEM;
    }
    circuit->node_name[0] = "0";
    for (size_t k = 1; k < n_nodes; k++) {
        circuit->node_name[k] = builder->elements.node_name[k];
    }
    circuit->results.n_signals = (int)builder->signals.n;
    circuit->results.n_shown = circuit->results.n_named = circuit->results.n_signals;
    for (size_t k = 0; k < builder->signals.n; k++) {
        circuit->results.signal[k] = builder->signals.signal[k];
    }
    circuit->n_initial_conditions = (int)builder->analyses.n_initial_conditions;
    for (size_t k = 0; k < builder->analyses.n_initial_conditions; k++) {
        circuit->initial_condition[k] = builder->analyses.initial_condition[k];
    }
    DALCS_TRY(dalcs_monte_carlo_collect(builder));
    DALCS_TRY(dalcs_worst_case_collect(builder));
    DALCS_TRY(collect_prints(builder));
    return dalcs_measured_collect(builder);
}

/* Gates carry what a small change of a state does from one part of a circuit to another one: where steady states are
 * looked for, all of it is one system. */
static bool is_whole(const struct dalcs_builder *builder) {
    const struct dalcs_circuit *c = builder->circuit;
    return builder->formulas.later != NULL ||
           (c->control.n_gates > 0 &&
            (builder->netlist->asks.steady || c->analyses.periodic.present ||
             c->analyses.transient.starts_steady || c->analyses.envelope.present));
}

static enum dalcs_status build(struct dalcs_builder *builder) {
    const size_t n_cards = builder->deck->n_cards;
    unsigned char *class_of = dalcs_arena_alloc(&builder->scratch, n_cards, 1);
    if (class_of == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_slip_check_title(builder);
    DALCS_TRY(classify_cards(builder, class_of));
    DALCS_TRY(dalcs_model_leave_unnamed(builder, class_of));
    DALCS_TRY(dalcs_card_table_read(builder, class_of));
    dalcs_output_resolve(builder);
    builder->circuit->control.is_whole = is_whole(builder);
    dalcs_passive_add_default_rser(builder);
    dalcs_storage_resolve(builder);
    dalcs_controlled_resolve(builder);
    dalcs_transistor_resolve(builder);
    dalcs_behavioural_resolve(builder);
    dalcs_delay_resolve(builder);
    dalcs_later_resolve(builder);
    builder->circuit->control.is_whole = is_whole(builder);
    dalcs_logic_resolve(builder);
    dalcs_initial_leave_held(builder);
    dalcs_model_check(builder);
    check_presence(builder);
    builder->signals.are_named =
        builder->signals.are_named ||
        builder->signals.saves_currents; /* the defaults have some of them */
    if (builder->signals.n == 0 && builder->signals.n_computed == 0) {
        dalcs_signals_add_default(builder);
    }
    if (builder->signals.saves_currents) {
        dalcs_signals_add_currents(builder);
    }
    dalcs_losses_collect(builder);
    if (builder->out_of_memory) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(collect(builder));
    /* Checks of the whole make no sense of a half. */
    if (!builder->failed && !has_errors(builder)) {
        dalcs_source_check(builder);
        dalcs_topology_check(builder);
        dalcs_threshold_check(builder);
        dalcs_initial_check(builder);
        dalcs_sweep_check(builder);
        dalcs_sensitivity_check(builder);
        dalcs_worst_case_check(builder);
        dalcs_own_resistance_replace(builder);
    }
    return builder->out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}

enum dalcs_status dalcs_circuit_build(struct dalcs_circuit *circuit,
                                      const struct dalcs_netlist *netlist,
                                      struct dalcs_diag *diag) {
    return dalcs_circuit_build_with(circuit, netlist, NULL, 0, diag);
}

static void finish_builder(struct dalcs_builder *builder) {
    dalcs_names_finish(&builder->elements.nodes);
    dalcs_names_finish(&builder->elements.devices);
    dalcs_names_finish(&builder->models.names);
    dalcs_names_finish(&builder->logic.comparators);
    dalcs_names_finish(&builder->elements.pairs);
    dalcs_names_finish(&builder->analyses.initial_pairs);
    dalcs_names_finish(&builder->signals.names);
    dalcs_names_finish(&builder->results.measure_names);
    dalcs_names_finish(&builder->signals.measured_keys);
    dalcs_arena_finish(&builder->scratch);
    free(builder->elements.node_name);
    free(builder->elements.node_token);
    free(builder->signals.signal);
    free(builder->signals.measured);
    free(builder->results.measure);
    free(builder->results.print);
    free(builder->results.print_column);
    free(builder->signals.computed);
    free(builder->results.fourier);
    free(builder->analyses.initial_condition);
    free(builder->formulas.source);
    dalcs_drivers_finish(&builder->formulas.drivers);
}

enum dalcs_status dalcs_circuit_build_with(struct dalcs_circuit *circuit,
                                           const struct dalcs_netlist *netlist,
                                           const struct dalcs_override *override,
                                           size_t n_overrides, struct dalcs_diag *diag) {
    struct dalcs_deck deck = {.override = override, .n_overrides = n_overrides};
    struct dalcs_builder builder = {.circuit = circuit,
                                    .netlist = netlist,
                                    .deck = &deck,
                                    .diag = diag,
                                    .models = {.ideal_diode = -1, .diode_current = 1}};
    *circuit = (struct dalcs_circuit){.n_nodes = 1};

    enum dalcs_status status = dalcs_deck_expand(&deck, netlist, diag);
    if (status == DALCS_OK) {
        builder.hidden = deck.hides_all        ? DALCS_HIDDEN_ALL
                         : deck.hides_elements ? DALCS_HIDDEN_ELEMENTS
                                               : 0;
        status = build(&builder);
    }
    if (status == DALCS_OK && (builder.failed || has_errors(&builder))) {
        /* More errors would explain nothing. */
        status = diag->out_of_memory ? DALCS_E_NOMEM : DALCS_E_NETLIST;
    }
    dalcs_diag_sort(diag);
    finish_builder(&builder);
    dalcs_deck_finish(&deck);
    if (status != DALCS_OK) {
        dalcs_circuit_finish(circuit);
    }
    return status;
}

void dalcs_circuit_finish(struct dalcs_circuit *circuit) {
    struct dalcs_arena arena = circuit->arena;
    for (int k = 0; k < circuit->control.n_delayed; k++) {
        dalcs_history_finish(circuit->control.delayed[k].history);
    }
    *circuit = (struct dalcs_circuit){0};
    dalcs_arena_finish(&arena);
}

static bool depends(const struct dalcs_circuit *circuit, const struct dalcs_stimulus *s,
                    const bool *changed) {
    const struct dalcs_stimulus *first = circuit->stimulus;
    if (s >= first && s < first + circuit->n_stimuli && changed[s - first]) {
        return true;
    }
    bool does = false;
    for (int k = 0; s->kind == DALCS_STIMULUS_FORMULA && k < s->u.formula.argument.n && !does;
         k++) {
        does = depends(circuit, s->u.formula.argument.part[k].of, changed);
    }
    return does;
}

bool dalcs_stimulus_depends(const struct dalcs_circuit *circuit, int k, const bool *changed) {
    return k >= 0 && depends(circuit, &circuit->stimulus[k], changed);
}
