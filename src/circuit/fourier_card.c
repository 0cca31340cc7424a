/* fourier_card.c - .four frequency [harmonics [periods]] formula ... */

#include "reader.h"
#include "result_cards.h"

#include <math.h>
#include <string.h>

static const char USAGE[] = ".four frequency [harmonics [periods]] v(node) ...";

enum { USUAL_HARMONICS = 9, MOST_HARMONICS = 10000 };

static bool read_whole(struct dalcs_reader *reader, const char *what, int *value) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    double number;
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, what, &number)) {
        return false;
    }
    if (!(number >= 1.0 && number <= MOST_HARMONICS) || number != floor(number)) {
        dalcs_builder_error(reader->builder, token, USAGE, "%s is a whole number from 1 to %d",
                            what, MOST_HARMONICS);
        return false;
    }
    *value = (int)number;
    return true;
}

static bool next_is_number(const struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    return token != NULL && token->kind != DALCS_TOKEN_EXPRESSION && dalcs_reader_is_number(token);
}

static void add(struct dalcs_builder *builder, const struct dalcs_fourier_card *fourier) {
    if (dalcs_grow(&builder->results.fourier, &builder->results.fourier_capacity,
                   builder->results.n_fouriers + 1, sizeof *builder->results.fourier) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    builder->results.fourier[builder->results.n_fouriers++] = *fourier;
}

/* The end of the signal that starts at token k: what stands behind its parenthesis. */
static int signal_end(const struct dalcs_card *card, int k) {
    int depth = 0;
    do {
        depth +=
            (card->token[k].kind == DALCS_TOKEN_OPEN) - (card->token[k].kind == DALCS_TOKEN_CLOSE);
        k++;
    } while (k < card->n && (depth > 0 || card->token[k].kind == DALCS_TOKEN_OPEN));
    return k;
}

/* LTspice's -1: as many periods as the run has. */
static int all_periods(const struct dalcs_transient *tran, double frequency) {
    const double n = floor((tran->stop - tran->start) * frequency * (1.0 + 1e-12));
    return (int)fmax(1.0, fmin(n, 1e9));
}

void dalcs_fourier_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    const struct dalcs_signal_formula_rules rules = {.variable = "time"};
    const struct dalcs_token *place = dalcs_reader_peek(&reader, 0);
    struct dalcs_fourier_card fourier = {.n_harmonics = USUAL_HARMONICS, .n_periods = 1};
    if (!dalcs_reader_number(&reader, DALCS_HERTZ, "a frequency", &fourier.frequency)) {
        return;
    }
    if (!(fourier.frequency > 0.0)) {
        dalcs_builder_error(builder, place, USAGE, "the frequency must be positive");
        return;
    }
    if (next_is_number(&reader) &&
        !read_whole(&reader, "the number of harmonics", &fourier.n_harmonics)) {
        return;
    }
    if (dalcs_reader_take_word(&reader, "-1")) {
        fourier.n_periods = all_periods(&builder->circuit->analyses.transient, fourier.frequency);
    } else if (next_is_number(&reader) &&
               !read_whole(&reader, "the number of periods", &fourier.n_periods)) {
        return;
    }
    if (dalcs_reader_at_end(&reader)) {
        dalcs_reader_missing(&reader, "a signal");
        return;
    }
    if (builder->analyses.tran == NULL && builder->analyses.pss == NULL &&
        !builder->netlist->asks.steady) {
        dalcs_builder_note(builder, card->token, NULL,
                           "there is no .tran and no .pss: this is left out");
        return;
    }
    while (!dalcs_reader_at_end(&reader)) {
        const struct dalcs_token *token = dalcs_reader_peek(&reader, 0);
        const int end = signal_end(card, reader.at);
        if (!dalcs_signal_formula_compile(builder, token, end - reader.at, &rules,
                                          &fourier.formula)) {
            return;
        }
        reader.at = end;
        fourier.where = dalcs_builder_keep_location(builder, token);
        add(builder, &fourier);
    }
}
