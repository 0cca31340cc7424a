/* sweep_card.c - .dc and .step: sweeps inside each other.
 *
 *     .dc source start stop step [source start stop step]
 *     .step [lin|dec|oct] item start stop step, .step item list value ..., .step item file=name
 *
 * An item is an element, `param name`, a model's parameter `D name(parameter)` or `temp`. The first
 * sweep is the innermost. */
#include "sweep_card.h"

#include <string.h>

static const char DC_USAGE[] =
    ".dc [lin|dec|oct] source start stop step [source start stop step], .dc source list value ...";
static const char STEP_USAGE[] =
    ".step [lin|dec|oct] item start stop step; .step item list value value ...; .step item "
    "file=name; an item is an "
    "element, param name, D model(parameter) or temp";

enum { MOST_NESTED = 8 };

void dalcs_sweep_parse_dc(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, DC_USAGE);
    if (!dalcs_analysis_is_first(builder, card, &builder->analyses.dc)) {
        return;
    }
    int n = 0;
    do {
        struct dalcs_sweep *sweep = &circuit->analyses.dc[n];
        const bool is_spaced = dalcs_sweep_take_spacing(&reader, &sweep->spacing);
        if (!dalcs_sweep_read_item(&reader, "vir", sweep)) {
            return;
        }
        const bool is_list = !is_spaced && dalcs_reader_take_word(&reader, "list");
        (void)dalcs_sweep_take_spacing(&reader, &sweep->spacing);
        if (is_list ? !dalcs_sweep_read_list(&reader, sweep)
                    : !dalcs_sweep_read_range(&reader, DC_USAGE, sweep)) {
            return;
        }
        n++;
    } while (!dalcs_reader_at_end(&reader) && n < DALCS_MOST_DC);
    if (!dalcs_reader_end(&reader)) {
        return;
    }
    if (n == 2 && strcmp(circuit->analyses.dc[0].label, circuit->analyses.dc[1].label) == 0) {
        dalcs_builder_error(builder, card->token, DC_USAGE, "both sweeps are of '%s'",
                            circuit->analyses.dc[0].label);
        return;
    }
    circuit->analyses.n_dc = n;
}

bool dalcs_sweep_add_step(struct dalcs_builder *builder, const struct dalcs_card *card,
                          const struct dalcs_sweep *sweep) {
    struct dalcs_circuit *circuit = builder->circuit;
    if (circuit->analyses.step == NULL) {
        circuit->analyses.step =
            dalcs_arena_alloc(&circuit->arena, MOST_NESTED, sizeof *circuit->analyses.step);
        builder->out_of_memory = builder->out_of_memory || circuit->analyses.step == NULL;
    }
    if (builder->out_of_memory) {
        return false;
    }
    if (circuit->analyses.n_steps == MOST_NESTED) {
        dalcs_builder_error(builder, card->token, NULL, "more than %d .step cards",
                            (int)MOST_NESTED);
        return false;
    }
    for (int k = 0; k < circuit->analyses.n_steps; k++) {
        if (strcmp(circuit->analyses.step[k].label, sweep->label) == 0) {
            dalcs_builder_error(builder, card->token, NULL, "a second %s of '%s'",
                                card->token->text, sweep->label);
            return false;
        }
    }
    circuit->analyses.step[circuit->analyses.n_steps++] = *sweep;
    return true;
}

void dalcs_sweep_parse_step(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, STEP_USAGE);
    struct dalcs_sweep sweep = {.spacing = DALCS_LINEAR};
    bool is_spaced = dalcs_sweep_take_spacing(&reader, &sweep.spacing);
    if (!dalcs_sweep_read_item(&reader, "vircleghf", &sweep)) {
        return;
    }
    is_spaced = dalcs_sweep_take_spacing(&reader, &sweep.spacing) || is_spaced;
    if (!is_spaced && dalcs_reader_take_word(&reader, "file")) {
        if (!dalcs_sweep_read_file(&reader, &sweep) || !dalcs_reader_end(&reader)) {
            return;
        }
    } else if (!is_spaced && dalcs_reader_take_word(&reader, "list")) {
        dalcs_reader_take(&reader, DALCS_TOKEN_EQUAL);
        if (!dalcs_sweep_read_list(&reader, &sweep)) {
            return;
        }
    } else if (!dalcs_sweep_read_range(&reader, STEP_USAGE, &sweep) || !dalcs_reader_end(&reader)) {
        return;
    }
    (void)dalcs_sweep_add_step(builder, card, &sweep);
}

void dalcs_sweep_check(struct dalcs_builder *builder) {
    const struct dalcs_circuit *circuit = builder->circuit;
    long total = 1;
    for (int k = 0; k < circuit->analyses.n_steps; k++) {
        const int device = circuit->analyses.step[k].device;
        const int stimulus = device >= 0 ? circuit->device[device].stimulus : -1;
        if (stimulus >= 0 && circuit->stimulus[stimulus].kind != DALCS_STIMULUS_DC &&
            circuit->analyses.transient.present) {
            dalcs_builder_warn_at(builder, &circuit->analyses.step[k].where,
                                  "put a parameter into the function and step that",
                                  "this steps the DC value of '%s'; .tran uses its function",
                                  circuit->analyses.step[k].name);
        }
        total *= circuit->analyses.step[k].n;
        if (total > DALCS_SWEEP_MOST) {
            dalcs_builder_error_at(builder, &circuit->analyses.step[k].where, NULL,
                                   "these are more than %d steps", (int)DALCS_SWEEP_MOST);
            return;
        }
    }
    bool has_ac = circuit->analyses.ac.n == 0 || circuit->analyses.orbit_ac.loop != NULL;
    for (int k = 0; k < circuit->n_stimuli && !has_ac; k++) {
        has_ac = circuit->stimulus[k].ac_real != 0.0 || circuit->stimulus[k].ac_imaginary != 0.0;
    }
    if (!has_ac) {
        dalcs_builder_error_at(
            builder, &circuit->analyses.ac.where,
            "write AC 1 on the source that drives it, such as: V1 in 0 DC 5 AC 1",
            ".ac without a source that has an AC value: everything would be 0");
    }
}
