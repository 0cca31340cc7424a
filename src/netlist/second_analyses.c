/* second_analyses.c - more than one .tran, .op, .dc or .ac.
 *
 * A circuit has one analysis of each kind. ngspice runs them all: so does the script's `run`, which has the others
 * as commands. The branch of an .if is chosen later, so analyses between .if and .endif stay cards. */
#include "netlist.h"

#include <string.h>

static int kind_of(const struct dalcs_card *card) {
    static const char *const kinds[] = {".op", ".dc", ".ac", ".tran"};
    for (int k = 0; k < 4 && card->letter == '.'; k++) {
        if (strcmp(card->token[0].text, kinds[k]) == 0) {
            return k;
        }
    }
    return -1;
}

/* At the card's place. */
static enum dalcs_status add_command(struct dalcs_source_lines *lines,
                                     const struct dalcs_card *card, const char *text) {
    const struct dalcs_source_line *at = card->token->line;
    return dalcs_source_lines_add(
        lines,
        (struct dalcs_source_line){.source = at->source, .text = text, .number = at->number});
}

/* The card as a command: "tran 1m {2*t}". NULL: out of memory. */
static const char *command_of(struct dalcs_netlist *netlist, const struct dalcs_card *card) {
    const char *text = card->token[0].text + 1;
    for (int k = 1; k < card->n && text != NULL; k++) {
        const struct dalcs_token *t = &card->token[k];
        const bool is_expression = t->kind == DALCS_TOKEN_EXPRESSION;
        text =
            dalcs_arena_printf(&netlist->arena, is_expression ? "%s {%s}" : "%s %s", text, t->text);
    }
    return text;
}

/* By how much a card is deeper in .if than the one before. */
static int deeper(const struct dalcs_card *card) {
    const char *text = card->letter == '.' ? card->token[0].text : "";
    return strcmp(text, ".if") == 0 ? 1 : strcmp(text, ".endif") == 0 ? -1 : 0;
}

enum dalcs_status dalcs_second_analyses(struct dalcs_netlist *netlist, struct dalcs_diag *diag) {
    bool has[4] = {false, false, false, false};
    size_t n = 0;
    int depth = 0;
    const size_t n_cards = netlist->n_cards;
    for (size_t k = 0; k < n_cards; k++) {
        const struct dalcs_card *card = &netlist->card[k];
        depth += deeper(card);
        const int kind = depth > 0 ? -1 : kind_of(card);
        const bool is_second = kind >= 0 && has[kind];
        if (kind >= 0) {
            has[kind] = true;
        }
        if (!is_second) {
            netlist->card[n++] = *card;
            continue;
        }
        const struct dalcs_location where = dalcs_token_location(card->token);
        const char *text = command_of(netlist, card);
        dalcs_diag_add(diag, DALCS_NOTE, &where, NULL,
                       "a second %s: it is run after those before it", card->token[0].text);
        if (text == NULL) {
            return DALCS_E_NOMEM;
        }
        DALCS_TRY(add_command(&netlist->later, card, text));
        if (netlist->commands.n == 0) {
            DALCS_TRY(add_command(&netlist->commands, card, "run"));
        }
    }
    netlist->n_cards = n;
    return DALCS_OK;
}
