/* monte_carlo_card.c - .mc: the same circuit again and again, with random values drawn anew.
 *
 *     .mc runs [seed=number]
 *
 * PSpice's card goes on with an analysis and what to look at there, which .meas does here. */

#include "analysis_cards.h"
#include "draws.h"
#include "reader.h"

#include <string.h>

static const char USAGE[] = ".mc runs [seed=number], such as .mc 1000";

bool dalcs_monte_carlo_read_seed(struct dalcs_reader *reader) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    double seed;
    if (token != NULL && strcmp(token->text, "random") == 0) {
        reader->at++;
        dalcs_builder_warn(builder, token, "write a number, or give another one by --seed",
                           "seed=random is ignored: a run could not be repeated");
        return true;
    }
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a whole number", &seed)) {
        return false;
    }
    if (!(seed >= 0 && seed <= DALCS_MOST_SEED) || seed != (double)(uint64_t)seed) {
        dalcs_builder_error(builder, token, "seed=1, seed=2, ... draw different values",
                            "a seed is a whole number from 0 to 2^53");
        return false;
    }
    return true;
}

static bool read_count(struct dalcs_reader *reader, int *n) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    double value;
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a number of runs", &value)) {
        return false;
    }
    if (!(value >= 1 && value <= DALCS_SWEEP_MOST) || value != (double)(int)value) {
        dalcs_builder_error(reader->builder, token, USAGE,
                            "the number of runs is a whole one, from 1 to %d",
                            (int)DALCS_SWEEP_MOST);
        return false;
    }
    *n = (int)value;
    return true;
}

/* The rest of PSpice's card is said to be ignored, but for its seed. */
static bool read_rest(struct dalcs_reader *reader) {
    bool is_told = false;
    while (!dalcs_reader_at_end(reader)) {
        if (dalcs_reader_take_word(reader, "seed")) {
            dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
            if (!dalcs_monte_carlo_read_seed(reader)) {
                return false;
            }
            continue;
        }
        if (!is_told) {
            is_told = true;
            dalcs_builder_warn(reader->builder, dalcs_reader_peek(reader, 0),
                               "write a .meas for each result that a run should give",
                               "what .mc looks at in PSpice is ignored");
        }
        reader->at++;
    }
    return true;
}

void dalcs_monte_carlo_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_sweep sweep = {.target = DALCS_SWEEP_RUN,
                                .name = "run",
                                .label = "run",
                                .device = -1,
                                .spacing = DALCS_LINEAR,
                                .start = 1,
                                .step = 1,
                                .where = dalcs_builder_keep_location(builder, card->token)};
    if (!read_count(&reader, &sweep.n) || !read_rest(&reader)) {
        return;
    }
    sweep.stop = sweep.n;
    if (builder->deck->n_drawn == 0 && !builder->deck->has_random_formula) {
        dalcs_builder_warn(builder, card->token,
                           "write a value such as R1 a b {mc(1k, 0.05)}, or R1 a b 1k DEV=5%",
                           "nothing in the netlist is random: all runs are the same");
    }
    (void)dalcs_sweep_add_step(builder, card, &sweep);
}

enum dalcs_status dalcs_monte_carlo_collect(struct dalcs_builder *builder) {
    const struct dalcs_deck *deck = builder->deck;
    struct dalcs_circuit *circuit = builder->circuit;
    circuit->random.drawn =
        dalcs_arena_alloc(&circuit->arena, deck->n_drawn, sizeof *circuit->random.drawn);
    if (circuit->random.drawn == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < deck->n_drawn; k++) {
        const char *name = deck->drawn[k].name;
        circuit->random.drawn[k] = (struct dalcs_drawn_value){
            dalcs_arena_copy(&circuit->arena, name, strlen(name)), deck->drawn[k].value};
        if (circuit->random.drawn[k].name == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    circuit->random.n_drawn = (int)deck->n_drawn;
    circuit->random.is_random = deck->n_drawn > 0 || deck->has_random_formula;
    if (circuit->random.is_random && circuit->analyses.n_steps == 0 && !deck->is_step &&
        !circuit->analyses.worst_case.present) {
        dalcs_diag_add(builder->diag, DALCS_NOTE, NULL, ".mc 100 runs it with 100 of them",
                       "random values are drawn once");
    }
    return DALCS_OK;
}
