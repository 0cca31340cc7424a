/* read_system.c - a system file: cards, in the words of a netlist, to a circuit and a network.
 *
 *     dalcs-system 2 TITLE        the first line
 *     .param .func .tran .op .options    as in a netlist
 *     input NAME ...              a source function
 *     network NAME                jumps of charge and flux, held .ic: see `equations`
 *     system [NAME]               the next one; its columns and matrices follow
 *     output, element             what is recorded
 *
 * dalcs_description_read_text at the end is the table of contents. */
#include "analysis_cards.h"
#include "element_cards.h"
#include "reader.h"
#include "reading.h"

#include <stdlib.h>
#include <string.h>

static const char MAGIC[] = "dalcs-system 2";
static const char JSON_MAGIC[] = "\"dalcs-system\"";

bool dalcs_description_is_text(const char *text, size_t length) {
    size_t n = sizeof MAGIC - 1;
    size_t skipped = length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    const char *at = text + skipped;
    length -= skipped;
    if (length >= n && memcmp(at, MAGIC, n) == 0) {
        return length == n || strchr(" \t\r\n", at[n]) != NULL;
    }
    /* JSON: the key is the first one. */
    size_t k = 0;
    while (k < length && strchr(" \t\r\n", at[k]) != NULL && at[k] != '\0') {
        k++;
    }
    bool is_object = k < length && at[k] == '{';
    for (k++; is_object && k < length && at[k] != '\0' && strchr(" \t\r\n", at[k]) != NULL; k++) {
    }
    return is_object && length - k >= sizeof JSON_MAGIC - 1 &&
           memcmp(at + k, JSON_MAGIC, sizeof JSON_MAGIC - 1) == 0;
}

static bool is_json(const char *text, size_t length) {
    return dalcs_description_is_text(text, length) && memchr(text, '{', length) != NULL &&
           strspn(text, " \t\r\n\xEF\xBB\xBF") == (size_t)(strchr(text, '{') - text);
}

/* ---- Cards --------------------------------------------------------------------------------- */

/* monotone yes|no: what is known of the OSNSP. */
static void take_claim(struct dalcs_reading *r, struct dalcs_described_system *s,
                       const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(&r->builder, card, "monotone yes, or no");
    if (dalcs_reader_take_word(&reader, "yes")) {
        s->monotone = DALCS_CLAIM_YES;
    } else if (dalcs_reader_take_word(&reader, "no")) {
        s->monotone = DALCS_CLAIM_NO;
    }
    (void)dalcs_reader_end(&reader);
}

static void take_system_card(struct dalcs_reading *r, const struct dalcs_card *card) {
    struct dalcs_described_system *s = dalcs_reading_present_system(r, card);
    const char *word = card->token->text;
    if (s == NULL) {
        return;
    }
    if (strcmp(word, "matrix") == 0) {
        dalcs_reading_take_matrix(r, s, card);
    } else if (strcmp(word, "monotone") == 0) {
        take_claim(r, s, card);
    } else if (strcmp(word, "jumps_are_covered") == 0) {
        s->jumps_are_covered = true;
    } else if (!dalcs_reading_take_column(r, s, card)) {
        static const char *const known[] = {
            "input",  "network", "system",   "inputs", "state",      "unknown", "row",
            "pair",   "switch",  "interval", "free",   "contact",    "joint",   "friction",
            "corner", "reverse", "matrix",   "output", "coordinate", "element", "monotone"};
        const char *hint =
            dalcs_reading_is_matrix(word)
                ? dalcs_builder_hint(&r->builder, "write: matrix %s, and its rows behind +", word)
                : dalcs_builder_suggest_of(&r->builder, known, sizeof known / sizeof known[0], word,
                                           "doc/system-file.md lists the cards");
        dalcs_builder_error(&r->builder, card->token, hint, "unknown card '%s' in a system file",
                            word);
    }
}

static void take_dot_card(struct dalcs_reading *r, const struct dalcs_card *card) {
    const char *word = card->token->text;
    if (strcmp(word, ".tran") == 0) {
        dalcs_analysis_parse_tran(&r->builder, card);
    } else if (strcmp(word, ".op") == 0) {
        dalcs_analysis_parse_op(&r->builder, card);
    } else if (strcmp(word, ".options") == 0 || strcmp(word, ".option") == 0 ||
               strcmp(word, ".opt") == 0) {
        dalcs_options_parse(&r->builder, card);
    } else {
        dalcs_builder_error(&r->builder, card->token,
                            "the cards are: .tran .op .options .param .func .end",
                            "'%s' has no meaning in a system file", word);
    }
}

static enum dalcs_status take_cards(struct dalcs_reading *r) {
    const struct dalcs_card *card = r->builder.deck->card;
    size_t n = r->builder.deck->n_cards;
    size_t first = 0;
    for (size_t k = 0; k < n && !r->builder.out_of_memory; k++) {
        const char *word = card[k].token->text;
        if (card[k].token->kind != DALCS_TOKEN_WORD) {
            dalcs_builder_error(&r->builder, card[k].token,
                                "rows of a matrix are on lines that start with +",
                                "a card cannot start with '%s'", word);
        } else if (card[k].letter == '.') {
            take_dot_card(r, &card[k]);
        } else if (strcmp(word, "input") == 0) {
            dalcs_reading_take_input(r, &card[k]);
        } else if (strcmp(word, "network") == 0) {
            if (k > 0 && (r->n_systems > 0 || r->network != &r->description->network)) {
                DALCS_TRY(dalcs_reading_finish_network(r, card + first, k - first));
            }
            first = k;
            if (!dalcs_reading_begin_network(r, &card[k])) {
                break;
            }
        } else if (strcmp(word, "system") == 0) {
            (void)dalcs_reading_new_system(r, &card[k]);
        } else if (!dalcs_reading_is_output(&card[k])) {
            take_system_card(r, &card[k]);
        }
    }
    if (r->builder.out_of_memory) {
        return DALCS_E_NOMEM;
    }
    return r->network == NULL ? DALCS_OK : dalcs_reading_finish_network(r, card + first, n - first);
}

/* ---- All together -------------------------------------------------------------------------- */

/* The circuit of no devices whose signals are the network's. */
static enum dalcs_status finish_circuit(struct dalcs_reading *r) {
    struct dalcs_circuit *c = &r->description->circuit;
    const struct dalcs_network *n = &r->description->network;
    c->stimulus = dalcs_arena_alloc(&c->arena, r->n_inputs, sizeof *c->stimulus);
    c->node_name = dalcs_arena_alloc(&c->arena, 1, sizeof *c->node_name);
    c->results.signal =
        dalcs_arena_alloc(&c->arena, (size_t)n->n_outputs, sizeof *c->results.signal);
    const char *title = r->builder.netlist->title + sizeof MAGIC - 1;
    title += strspn(title, " \t");
    c->title = dalcs_arena_copy(&c->arena, title, strlen(title));
    if (c->stimulus == NULL || c->node_name == NULL || c->results.signal == NULL ||
        c->title == NULL) {
        return DALCS_E_NOMEM;
    }
    c->node_name[0] = "0";
    for (size_t k = 0; k < r->n_inputs; k++) {
        c->stimulus[k] = r->input[k];
    }
    c->n_stimuli = (int)r->n_inputs;
    for (int k = 0; k < n->n_outputs; k++) {
        c->results.signal[k] = (struct dalcs_signal){.name = n->output[k].name, .device = -1};
    }
    c->results.n_signals = n->n_outputs;
    for (size_t k = 0; k < r->n_inputs; k++) {
        dalcs_stimulus_check(&r->builder, r->input_token[k], &c->stimulus[k]);
    }
    return DALCS_OK;
}

/* Values of states are where the run starts: there is no operating point to start from then. */
static void start_from_values(struct dalcs_reading *r, bool has_values) {
    struct dalcs_transient *t = &r->description->circuit.analyses.transient;
    t->use_initial_conditions = t->use_initial_conditions || has_values;
}

static bool check_request(struct dalcs_reading *r) {
    const struct dalcs_location where = {.file = r->builder.netlist->name};
    if (!r->builder.failed && r->description->network.n_systems == 0) {
        dalcs_builder_error_at(&r->builder, &where, "columns are: state, unknown, pair, ...",
                               "the file has no system");
    }
    if (!r->builder.failed && r->builder.analyses.tran == NULL && r->builder.analyses.op == NULL) {
        dalcs_builder_error_at(&r->builder, &where, "add a line such as: .tran 10u 20m",
                               "the file has no analysis: no .tran and no .op");
    }
    return !r->builder.failed;
}

static bool has_values(const struct dalcs_deck *deck) {
    for (size_t k = 0; k < deck->n_cards; k++) {
        const struct dalcs_card *card = &deck->card[k];
        bool is_state =
            strcmp(card->token->text, "state") == 0 || strcmp(card->token->text, "coordinate") == 0;
        for (int i = 2; is_state && i < card->n; i++) {
            bool is_parameter = card->token[i - 1].kind == DALCS_TOKEN_EQUAL;
            if (!is_parameter && dalcs_reader_is_number(&card->token[i])) {
                return true;
            }
        }
    }
    return false;
}

static enum dalcs_status read_netlist(struct dalcs_reading *r, const struct dalcs_netlist *netlist,
                                      struct dalcs_diag *diag) {
    struct dalcs_deck deck = {0};
    r->builder.netlist = netlist;
    r->builder.deck = &deck;
    r->builder.diag = diag;
    r->builder.circuit = &r->description->circuit;
    r->network = &r->description->network;
    enum dalcs_status status = dalcs_deck_expand(&deck, netlist, diag);
    if (status == DALCS_OK) {
        r->builder.failed = netlist->has_errors || deck.has_errors;
        status = take_cards(r);
    }
    if (status == DALCS_OK && check_request(r)) {
        start_from_values(r, has_values(&deck));
        status = finish_circuit(r);
    }
    status = status == DALCS_OK && r->builder.out_of_memory ? DALCS_E_NOMEM : status;
    if (status == DALCS_OK && r->builder.failed) {
        status = diag->out_of_memory ? DALCS_E_NOMEM : DALCS_E_NETLIST;
    }
    dalcs_diag_sort(diag);
    dalcs_deck_finish(&deck);
    return status;
}

static enum dalcs_status read_cards(struct dalcs_description *description, const char *name,
                                    const char *text, size_t length, struct dalcs_diag *diag) {
    struct dalcs_netlist netlist = {0};
    struct dalcs_reading r = {.description = description};
    *description = (struct dalcs_description){.circuit = {.n_nodes = 1}};
    enum dalcs_status status = dalcs_netlist_read_text(&netlist, name, text, length, diag);
    if (status == DALCS_OK) {
        status = read_netlist(&r, &netlist, diag);
    }
    for (size_t k = 0; k < r.n_systems; k++) {
        dalcs_reading_drop_system(&r.system[k]);
    }
    free(r.system);
    free(r.input);
    free(r.input_name);
    free(r.input_token);
    free(r.output);
    free(r.element);
    dalcs_arena_finish(&r.builder.scratch);
    dalcs_netlist_finish(&netlist);
    if (status != DALCS_OK) {
        dalcs_description_finish(description);
    }
    return status;
}

enum dalcs_status dalcs_description_read_text(struct dalcs_description *description,
                                              const char *name, const char *text, size_t length,
                                              struct dalcs_diag *diag) {
    *description = (struct dalcs_description){0};
    if (!is_json(text, length)) {
        return read_cards(description, name, text, length, diag);
    }
    char *cards = NULL;
    size_t n;
    enum dalcs_status status = dalcs_json_to_cards(name, text, length, &cards, &n, diag);
    if (status == DALCS_OK) {
        status = read_cards(description, name, cards, n, diag);
    }
    free(cards);
    return status;
}

void dalcs_description_finish(struct dalcs_description *description) {
    dalcs_network_finish(&description->network);
    dalcs_circuit_finish(&description->circuit);
}
