/* definition_end.c - where a subcircuit ends: at its .ends, or with its file. */
#include "collector.h"

#include <string.h>

void dalcs_collector_close_conditions(struct dalcs_collector *c) {
    while (dalcs_collector_is_conditional(c)) {
        const struct dalcs_open_if *open = &c->open[--c->n_open];
        dalcs_collector_error(c, c->definition->item[open->first].card->token, "add a line: .endif",
                              "this .if is never closed");
    }
}

static bool ends_outer(const struct dalcs_definition *d, const char *name) {
    for (const struct dalcs_definition *outer = d->enclosing;
         outer != NULL && outer->enclosing != NULL; outer = outer->enclosing) {
        if (strcmp(outer->name->text, name) == 0) {
            return true;
        }
    }
    return false;
}

void dalcs_collector_end(struct dalcs_collector *c, const struct dalcs_card *card) {
    struct dalcs_definition *d = c->definition;
    if (d->enclosing == NULL) {
        dalcs_collector_error(c, card->token, NULL, ".ends without a .subckt");
        return;
    }
    if (card->n > 1 && card->token[1].kind == DALCS_TOKEN_WORD &&
        strcmp(card->token[1].text, d->name->text) != 0) {
        /* Of one around it, this one lacks its own .ends; another name is a slip without a meaning, as elsewhere. */
        const bool is_outer = ends_outer(d, card->token[1].text);
        dalcs_language_report(c->language, is_outer ? DALCS_ERROR : DALCS_WARNING, NULL,
                              &card->token[1], NULL,
                              "the subcircuit that ends here is '%s', from %s", d->name->text,
                              dalcs_language_place(c->language, d->card));
    }
    dalcs_collector_close_conditions(c);
    c->definition = d->enclosing;
    c->depth--;
}

bool dalcs_collector_lacks_end(const struct dalcs_netlist *netlist) {
    long n = 0; /* begun, less those ended */
    for (size_t k = 0; k < netlist->n_cards; k++) {
        const struct dalcs_token *first = netlist->card[k].token;
        if (netlist->card[k].letter == '.') {
            n += dalcs_token_is_word(first, ".subckt") || dalcs_token_is_word(first, ".macro");
            n -= dalcs_token_is_word(first, ".ends") || dalcs_token_is_word(first, ".eom");
        }
    }
    return n > 0;
}

static bool is_part_of(const struct dalcs_source *source, const struct dalcs_source *whole) {
    while (source != NULL && source != whole) {
        source = source->outer;
    }
    return source != NULL;
}

void dalcs_collector_end_with_file(struct dalcs_collector *c, const struct dalcs_card *next) {
    while (c->definition->enclosing != NULL &&
           !is_part_of(next->token->line->source, c->definition->card->line->source)) {
        dalcs_collector_close_conditions(c);
        dalcs_language_report(c->language, DALCS_WARNING, NULL, c->definition->card, "add: .ends",
                              "'%s' has no .ends: it ends with its file",
                              c->definition->name->text);
        c->definition = c->definition->enclosing;
        c->depth--;
    }
}
