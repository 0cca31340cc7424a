/* signal_card.c - .save, .print, .plot and .probe: the signals that a card names, and of .print and .plot a table. */
#include "reader.h"
#include "result_cards.h"
#include "signals.h"

#include <string.h>

/* Xyce's `format=csv`, `file=name` and the like on .print: how a file looks is said when dalcs is called. */
static void skip_print_options(struct dalcs_reader *reader) {
    static const char *const name[] = {"format",    "file",   "width",          "precision",
                                       "delimiter", "filter", "timescalefactor"};
    for (;;) {
        const struct dalcs_token *option = dalcs_reader_peek(reader, 0);
        if (option == NULL ||
            !dalcs_builder_is_one_of(option->text, name, sizeof name / sizeof name[0]) ||
            dalcs_reader_take_parameter(reader) == NULL) {
            return;
        }
        dalcs_builder_note(reader->builder, option, "files and formats are options: -o out.csv",
                           "%s= on .print is ignored", option->text);
        reader->at += dalcs_reader_at_end(reader) ? 0 : 1;
    }
}

/* `(0,5)` after a signal of .plot: its limits. */
static void skip_limits(struct dalcs_reader *reader) {
    const struct dalcs_token *open = dalcs_reader_peek(reader, 0);
    if (strcmp(reader->card->token->text, ".plot") != 0 || open == NULL ||
        open->kind != DALCS_TOKEN_OPEN) {
        return;
    }
    while (!dalcs_reader_at_end(reader) && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        reader->at++;
    }
}

/* The table of a .print: of one analysis, or of all. */
static bool start_print(struct dalcs_builder *builder, int analysis) {
    if (dalcs_grow(&builder->results.print, &builder->results.print_capacity,
                   builder->results.n_prints + 1, sizeof *builder->results.print) != DALCS_OK) {
        builder->out_of_memory = true;
        return false;
    }
    struct dalcs_print_card *print = &builder->results.print[builder->results.n_prints++];
    *print = (struct dalcs_print_card){0};
    for (int k = 0; k <= DALCS_MEASURED_AC; k++) {
        print->is_of[k] = analysis < 0 || k == analysis;
    }
    return true;
}

/* The analysis that a card names, -1: none; false: one that there is not, and the card is ignored. */
static bool take_analysis(struct dalcs_reader *reader, int *analysis) {
    static const char *const ours[] = {[DALCS_MEASURED_TRAN] = "tran",
                                       [DALCS_MEASURED_OP] = "op",
                                       [DALCS_MEASURED_DC] = "dc",
                                       [DALCS_MEASURED_AC] = "ac"};
    static const char *const other[] = {"noise", "sens",     "hb",        "four",
                                        "hb_ic", "homotopy", "hb_startup"};
    const struct dalcs_token *type = dalcs_reader_peek(reader, 0);
    *analysis = -1;
    for (size_t k = 0; k < sizeof other / sizeof other[0]; k++) {
        if (dalcs_reader_take_word(reader, other[k])) {
            dalcs_builder_note(reader->builder, type, NULL,
                               "there is no %s analysis: this is ignored", type->text);
            return false;
        }
    }
    for (int k = 0; k <= DALCS_MEASURED_AC && *analysis < 0; k++) {
        *analysis = dalcs_reader_take_word(reader, ours[k]) ? k : -1;
    }
    return true;
}

void dalcs_signals_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, DALCS_SIGNALS_USAGE);
    builder->signals.are_named = true;
    const char *name = card->token->text;
    const bool takes_options = strcmp(name, ".print") == 0;
    const bool has_type = strcmp(name, ".save") != 0;
    int analysis = -1;
    if (has_type && !take_analysis(&reader, &analysis)) {
        return;
    }
    if (takes_options) {
        skip_print_options(&reader);
    }
    if (dalcs_reader_at_end(&reader)) {
        /* A bare .probe records everything, as in PSpice. */
        if (dalcs_signals_is_probe(card)) {
            dalcs_signals_add_default(builder);
        } else {
            dalcs_reader_missing(&reader, "a signal");
        }
        return;
    }
    const bool is_print = strcmp(name, ".print") == 0 || strcmp(name, ".plot") == 0;
    if (is_print && !start_print(builder, analysis)) {
        return;
    }
    builder->results.is_print = is_print;
    while (!dalcs_reader_at_end(&reader)) {
        builder->results.print_before = NULL;
        builder->results.print_part = DALCS_PART_PLAIN;
        if (!dalcs_signals_read(&reader)) {
            break;
        }
        skip_limits(&reader);
        if (takes_options) {
            skip_print_options(&reader);
        }
    }
    builder->results.is_print = false;
}
