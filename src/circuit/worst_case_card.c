/* worst_case_card.c - .wcase: how far tolerances move what .meas measures, at worst.
 *
 *     .wcase [vary dev|lot|both] [corners=yes|no]
 *
 * PSpice's card goes on with an analysis and what to look at there, which .meas does here. */

#include "analysis_cards.h"
#include "reader.h"

#include <string.h>

static const char USAGE[] = ".wcase [vary dev|lot|both] [corners=yes|no]";

static bool read_vary(struct dalcs_reader *reader, struct dalcs_worst_case_card *worst) {
    const bool is_dev = dalcs_reader_take_word(reader, "dev");
    const bool is_lot = !is_dev && dalcs_reader_take_word(reader, "lot");
    if (!is_dev && !is_lot && !dalcs_reader_take_word(reader, "both")) {
        dalcs_reader_missing(reader, "'dev', 'lot' or 'both'");
        return false;
    }
    worst->no_lot = is_dev;
    worst->no_dev = is_lot;
    return true;
}

static bool read_corners(struct dalcs_reader *reader, struct dalcs_worst_case_card *worst) {
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    worst->no_corners = dalcs_reader_take_word(reader, "no");
    if (!worst->no_corners && !dalcs_reader_take_word(reader, "yes")) {
        dalcs_reader_missing(reader, "'yes' or 'no'");
        return false;
    }
    return true;
}

void dalcs_worst_case_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_worst_case_card *worst = &builder->circuit->analyses.worst_case;
    bool is_told = false;
    bool ok = true;
    if (worst->present) {
        dalcs_builder_error(builder, card->token, NULL, "a second .wcase");
        return;
    }
    worst->present = true;
    worst->where = dalcs_builder_keep_location(builder, card->token);
    while (ok && !dalcs_reader_at_end(&reader)) {
        if (dalcs_reader_take_word(&reader, "vary")) {
            ok = read_vary(&reader, worst);
        } else if (dalcs_reader_take_word(&reader, "corners")) {
            ok = read_corners(&reader, worst);
        } else {
            if (!is_told) {
                dalcs_builder_warn(builder, dalcs_reader_peek(&reader, 0),
                                   "write a .meas for each quantity whose worst case you need",
                                   "what .wcase looks at in PSpice is ignored");
            }
            is_told = true;
            reader.at++;
        }
    }
}

enum dalcs_status dalcs_worst_case_collect(struct dalcs_builder *builder) {
    const struct dalcs_deck *deck = builder->deck;
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_worst_case_card *worst = &circuit->analyses.worst_case;
    if (!worst->present) {
        return DALCS_OK;
    }
    worst->place = dalcs_arena_alloc(&circuit->arena, deck->n_draws, sizeof *worst->place);
    if (worst->place == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < deck->n_draws; k++) {
        const struct dalcs_draw *draw = &deck->draw[k];
        if (draw->is_lot ? worst->no_lot : worst->no_dev) {
            continue;
        }
        struct dalcs_tolerance_place *place = &worst->place[worst->n++];
        *place = (struct dalcs_tolerance_place){
            dalcs_arena_copy(&circuit->arena, draw->name, strlen(draw->name)), draw->key};
        if (place->name == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    return DALCS_OK;
}

void dalcs_worst_case_check(struct dalcs_builder *builder) {
    const struct dalcs_circuit *circuit = builder->circuit;
    const struct dalcs_worst_case_card *worst = &circuit->analyses.worst_case;
    if (!worst->present) {
        return;
    }
    if (circuit->analyses.n_steps > 0 || circuit->analyses.sensitivity.present) {
        dalcs_builder_error_at(builder, &worst->where, "leave one of them out",
                               "a worst case belongs to one circuit, and %s",
                               circuit->analyses.n_steps > 0 ? ".step and .mc make several"
                                                             : ".sens varies its values itself");
    } else if (builder->netlist->commands.n > 0) {
        dalcs_builder_error_at(builder, &worst->where, "leave one of them out",
                               "a .control block and .wcase both choose the runs");
    } else if (circuit->results.n_measures == 0) {
        dalcs_builder_error_at(builder, &worst->where,
                               "write a card such as .meas tran low min v(out)",
                               "nothing is measured that could have a worst case");
    } else if (worst->n == 0) {
        dalcs_builder_error_at(builder, &worst->where,
                               "write R1 a b 1k DEV=5%, LOT=2% in a model, or {mc(1k, 0.05)}",
                               "nothing that .wcase varies has a tolerance");
    }
}
