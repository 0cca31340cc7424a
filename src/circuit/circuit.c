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
#include "oscillator.h"
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
    circuit->diode_model =
        dalcs_arena_alloc(arena, n_models + 1 + table.n_scaled, sizeof *circuit->diode_model);
    circuit->switch_model = dalcs_arena_alloc(arena, n_cards, sizeof *circuit->switch_model);
    builder->models.model =
        dalcs_arena_alloc(&builder->scratch, n_models, sizeof *builder->models.model);
    builder->elements.device_token = dalcs_arena_alloc(&builder->scratch, n_devices + n_couplings,
                                                       sizeof *builder->elements.device_token);
    builder->elements.control_token =
        dalcs_arena_alloc(&builder->scratch, n_devices, sizeof *builder->elements.control_token);
    builder->elements.current_of =
        dalcs_arena_alloc(&builder->scratch, n_devices, sizeof *builder->elements.current_of);
    const bool ok = circuit->device != NULL && circuit->stimulus != NULL &&
                    circuit->coupling != NULL && circuit->diode_model != NULL &&
                    circuit->switch_model != NULL && builder->models.model != NULL &&
                    builder->elements.device_token != NULL &&
                    builder->elements.control_token != NULL && builder->elements.current_of != NULL;
    if (dalcs_dialect_is_told(builder->netlist->dialect, DALCS_DIALECT_LTSPICE)) {
        builder->elements.default_rser =
            dalcs_arena_alloc(&builder->scratch, n_devices, sizeof *builder->elements.default_rser);
        return ok && builder->elements.default_rser != NULL ? DALCS_OK : DALCS_E_NOMEM;
    }
    return ok ? DALCS_OK : DALCS_E_NOMEM;
}

/* XSPICE's, by the model that the last word names; NULL: it is none of them. */
static const struct dalcs_block *block_of(const struct dalcs_builder *builder,
                                          const struct dalcs_card *card) {
    const int index = dalcs_names_find(&builder->models.names, card->token[card->n - 1].text);
    return index >= 0 ? builder->models.model[index].block : NULL;
}

static void read_element(struct dalcs_builder *builder, const struct dalcs_card *card) {
    if (card->parallel > 0 && dalcs_parallel_is_refused(builder, card)) {
        return;
    }
    switch (card->letter) {
    case 'r':
        dalcs_passive_parse(builder, card, DALCS_RESISTOR);
        return;
    case 'l':
        dalcs_passive_parse(builder, card, DALCS_INDUCTOR);
        return;
    case 'c':
        dalcs_passive_parse(builder, card, DALCS_CAPACITOR);
        return;
    case 'v':
        dalcs_source_parse(builder, card, DALCS_VSOURCE);
        return;
    case 'i':
        if (dalcs_behavioural_has_own_table(card)) {
            dalcs_behavioural_parse_own_table(builder, card);
        } else {
            dalcs_source_parse(builder, card, DALCS_ISOURCE);
        }
        return;
    case 'e':
        dalcs_controlled_parse(builder, card, DALCS_VCVS);
        return;
    case 'f':
        dalcs_controlled_parse(builder, card, DALCS_CCCS);
        return;
    case 'g':
        dalcs_controlled_parse(builder, card, DALCS_VCCS);
        return;
    case 'h':
        dalcs_controlled_parse(builder, card, DALCS_CCVS);
        return;
    case 'd':
        dalcs_diode_parse(builder, card);
        return;
    case 'a':
        if (dalcs_card_is_logic(card)) {
            dalcs_logic_parse(builder, card);
        } else if (block_of(builder, card) != NULL) {
            dalcs_block_parse(builder, card, block_of(builder, card));
        } else if (dalcs_thyristor_is(builder, card)) {
            dalcs_thyristor_parse(builder, card);
        } else {
            dalcs_diode_parse_block(builder, card);
        }
        return;
    case 'm':
    case 'z':
    case 'q':
        dalcs_transistor_parse(builder, card);
        return;
    case 'b':
        dalcs_behavioural_parse(builder, card);
        return;
    case 't':
        dalcs_line_parse(builder, card);
        return;
    default:
        dalcs_switch_parse(builder, card);
        return;
    }
}

enum pass { OPTIONS, MODELS, ELEMENTS, REFERENCES, MEASURES, NEVER };

/* The readers of cards, and their passes. */
static const struct {
    enum pass pass;
    void (*parse)(struct dalcs_builder *builder, const struct dalcs_card *card);
} READ[DALCS_N_CARD_CLASSES] = {
    [DALCS_CARD_NONE] = {NEVER, NULL},
    [DALCS_CARD_OPTIONS] = {OPTIONS, dalcs_options_parse},
    [DALCS_CARD_TEMPERATURE] = {OPTIONS, dalcs_temperature_parse},
    [DALCS_CARD_MODEL] = {MODELS, dalcs_model_parse},
    [DALCS_CARD_TRAN] = {MODELS, dalcs_analysis_parse_tran},
    [DALCS_CARD_PSS] = {MODELS, dalcs_analysis_parse_pss},
    [DALCS_CARD_ENV] = {MODELS, dalcs_analysis_parse_env},
    [DALCS_CARD_OP] = {MODELS, dalcs_analysis_parse_op},
    [DALCS_CARD_ELEMENT] = {ELEMENTS, read_element},
    [DALCS_CARD_COUPLING] = {REFERENCES, dalcs_coupling_parse},
    [DALCS_CARD_IC] = {REFERENCES, dalcs_initial_parse},
    [DALCS_CARD_SIGNALS] = {REFERENCES, dalcs_signals_parse},
    [DALCS_CARD_NODESET] = {REFERENCES, dalcs_initial_parse_nodeset},
    [DALCS_CARD_DC] = {REFERENCES, dalcs_sweep_parse_dc},
    [DALCS_CARD_AC] = {REFERENCES, dalcs_sweep_parse_ac},
    [DALCS_CARD_SENS] = {REFERENCES, dalcs_sensitivity_parse},
    [DALCS_CARD_STEP] = {REFERENCES, dalcs_sweep_parse_step},
    [DALCS_CARD_MC] = {REFERENCES, dalcs_monte_carlo_parse},
    [DALCS_CARD_WORST_CASE] = {REFERENCES, dalcs_worst_case_parse},
    [DALCS_CARD_MEASURE] = {MEASURES, dalcs_measure_parse},
    [DALCS_CARD_FOURIER] = {MEASURES, dalcs_fourier_parse},
    [DALCS_CARD_LOSSES] = {MEASURES, dalcs_losses_parse},
    [DALCS_CARD_SWITCHLOSS] = {MEASURES, dalcs_switchloss_count},
};

static enum dalcs_status read_cards(struct dalcs_builder *builder, const unsigned char *class_of) {
    for (enum pass pass = OPTIONS; pass <= MEASURES; pass++) {
        for (size_t k = 0; k < builder->deck->n_cards; k++) {
            if (READ[class_of[k]].pass == pass) {
                READ[class_of[k]].parse(builder, &builder->deck->card[k]);
            }
            if (builder->out_of_memory) {
                return DALCS_E_NOMEM;
            }
        }
        if (pass == OPTIONS) {
            dalcs_temperature_settle(builder);
        }
        if (pass == ELEMENTS) {
            dalcs_oscillator_put_all(builder);
        }
    }
    return DALCS_OK;
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
                      builder->analyses.pss != NULL || builder->netlist->n_script_lines > 0 ||
                      builder->netlist->asks_steady;
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
    circuit->print = dalcs_arena_alloc(&circuit->arena, n, sizeof *circuit->print);
    if (column == NULL || circuit->print == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n_columns; k++) {
        column[k] = builder->results.print_column[k];
    }
    circuit->n_prints = (int)n;
    for (size_t k = 0; k < n; k++) {
        circuit->print[k] = builder->results.print[k];
        circuit->print[k].column = column;
        column += circuit->print[k].n;
    }
    return DALCS_OK;
}

/* Moves what grew on the heap into the circuit's arena. */
static enum dalcs_status collect(struct dalcs_builder *builder) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_arena *arena = &circuit->arena;
    const size_t n_nodes = (size_t)circuit->n_nodes;
    circuit->node_name = dalcs_arena_alloc(arena, n_nodes, sizeof *circuit->node_name);
    circuit->signal = dalcs_arena_alloc(arena, builder->signals.n + builder->signals.n_measured,
                                        sizeof *circuit->signal);
    circuit->initial_condition = dalcs_arena_alloc(arena, builder->analyses.n_initial_conditions,
                                                   sizeof *circuit->initial_condition);
    circuit->title =
        dalcs_arena_copy(arena, builder->netlist->title, strlen(builder->netlist->title));
    if (circuit->node_name == NULL || circuit->signal == NULL ||
        circuit->initial_condition == NULL || circuit->title == NULL) {
        return DALCS_E_NOMEM;
    }
    circuit->node_name[0] = "0";
    for (size_t k = 1; k < n_nodes; k++) {
        circuit->node_name[k] = builder->elements.node_name[k];
    }
    circuit->n_signals = (int)builder->signals.n;
    circuit->n_shown = circuit->n_named = circuit->n_signals;
    for (size_t k = 0; k < builder->signals.n; k++) {
        circuit->signal[k] = builder->signals.signal[k];
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
           (c->n_gates > 0 && (builder->netlist->asks_steady || c->periodic.present ||
                               c->transient.starts_steady || c->envelope.present));
}

static enum dalcs_status build(struct dalcs_builder *builder) {
    const size_t n_cards = builder->deck->n_cards;
    unsigned char *class_of = dalcs_arena_alloc(&builder->scratch, n_cards, 1);
    if (class_of == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_slip_check_title(builder);
    DALCS_TRY(classify_cards(builder, class_of));
    DALCS_TRY(read_cards(builder, class_of));
    builder->circuit->is_whole = is_whole(builder);
    dalcs_passive_add_default_rser(builder);
    dalcs_storage_resolve(builder);
    dalcs_controlled_resolve(builder);
    dalcs_transistor_resolve(builder);
    dalcs_behavioural_resolve(builder);
    dalcs_delay_resolve(builder);
    dalcs_later_resolve(builder);
    builder->circuit->is_whole = is_whole(builder);
    dalcs_logic_resolve(builder);
    dalcs_initial_leave_held(builder);
    dalcs_model_check(builder);
    check_presence(builder);
    builder->signals.are_named =
        builder->signals.are_named ||
        builder->signals.saves_currents; /* the defaults have some of them */
    if (builder->signals.n == 0) {
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

    dalcs_names_finish(&builder.elements.nodes);
    dalcs_names_finish(&builder.elements.devices);
    dalcs_names_finish(&builder.models.names);
    dalcs_names_finish(&builder.logic.comparators);
    dalcs_names_finish(&builder.elements.pairs);
    dalcs_names_finish(&builder.analyses.initial_pairs);
    dalcs_names_finish(&builder.signals.names);
    dalcs_names_finish(&builder.results.measure_names);
    dalcs_names_finish(&builder.signals.measured_keys);
    dalcs_arena_finish(&builder.scratch);
    free(builder.elements.node_name);
    free(builder.elements.node_token);
    free(builder.signals.signal);
    free(builder.signals.measured);
    free(builder.results.measure);
    free(builder.results.print);
    free(builder.results.print_column);
    free(builder.signals.computed);
    free(builder.results.fourier);
    free(builder.analyses.initial_condition);
    free(builder.formulas.source);
    dalcs_drivers_finish(&builder.formulas.drivers);
    dalcs_deck_finish(&deck);
    if (status != DALCS_OK) {
        dalcs_circuit_finish(circuit);
    }
    return status;
}

void dalcs_circuit_finish(struct dalcs_circuit *circuit) {
    struct dalcs_arena arena = circuit->arena;
    for (int k = 0; k < circuit->n_delayed; k++) {
        dalcs_history_finish(circuit->delayed[k].history);
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
