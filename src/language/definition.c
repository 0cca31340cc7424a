/* definition.c - the netlist's cards sorted into definitions: the netlist and its subcircuits.
 *
 * Nothing is evaluated here. Errors inside a subcircuit that is never called are not reported, as far
 * as it can be read at all. */
#include "collector.h"

#include <stdlib.h>
#include <string.h>

void dalcs_collector_error(struct dalcs_collector *c, const struct dalcs_token *token,
                           const char *hint, const char *what) {
    dalcs_language_report(c->language, DALCS_ERROR, NULL, token, hint, "%s", what);
}

void dalcs_collector_missing(struct dalcs_collector *c, const struct dalcs_token *after,
                             const char *usage, const char *what) {
    dalcs_language_report_at(c->language, DALCS_ERROR, NULL, dalcs_token_end(after), usage,
                             "%s is missing", what);
}

bool dalcs_collector_is_conditional(const struct dalcs_collector *c) {
    return c->n_open > c->base[c->depth];
}

bool dalcs_token_is_same_place(const struct dalcs_token *a, const struct dalcs_token *b) {
    const struct dalcs_source *x = a->line->source;
    const struct dalcs_source *y = b->line->source;
    return a->line->number == b->line->number && x != y && x->real != NULL && y->real != NULL &&
           strcmp(x->real, y->real) == 0;
}

static enum dalcs_status add_item(struct dalcs_collector *c, const struct dalcs_card *card,
                                  enum dalcs_item_kind kind) {
    struct dalcs_definition *d = c->definition;
    DALCS_TRY(dalcs_grow(&d->item, &d->item_capacity, d->n_items + 1, sizeof *d->item));
    d->item[d->n_items++] = (struct dalcs_item){.card = card, .kind = kind};
    return DALCS_OK;
}

/* ---- Subcircuits ------------------------------------------------------------------------------- */

static enum dalcs_status read_ports(struct dalcs_collector *c, const struct dalcs_card *card,
                                    int end) {
    struct dalcs_definition *d = c->definition;
    d->port = dalcs_arena_alloc(c->language->arena, (size_t)end, sizeof *d->port);
    if (d->port == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 2; k < end; k++) {
        const struct dalcs_token *port = &card->token[k];
        if (port->kind == DALCS_TOKEN_OPEN || port->kind == DALCS_TOKEN_CLOSE) {
            continue;
        }
        if (port->kind != DALCS_TOKEN_WORD) {
            if (port->kind != DALCS_TOKEN_BAD) {
                dalcs_collector_error(c, port, ".subckt name port ... [name=value ...]",
                                      "this is not the name of a port");
            }
        } else if (strcmp(port->text, "0") == 0) {
            dalcs_collector_error(c, port, NULL,
                                  "node 0 is ground everywhere: it cannot be a port");
        } else if (strcmp(port->text, "optional:") == 0) {
            dalcs_collector_error(c, port, "leave it out and write the node",
                                  "optional ports are not supported");
            return DALCS_OK;
        } else if (dalcs_names_find(&d->port_index, port->text) >= 0) {
            dalcs_language_report(c->language, DALCS_ERROR, NULL, port, NULL,
                                  "there are two ports '%s'", port->text);
        } else {
            DALCS_TRY(dalcs_names_add(&d->port_index, port->text, d->n_ports));
        }
        d->port[d->n_ports++] = port;
    }
    return DALCS_OK;
}

/* May there be a second definition of a name? Under a condition, and where a file is read twice. */
static bool check_second(struct dalcs_collector *c, const struct dalcs_definition *known,
                         const struct dalcs_token *name) {
    if (dalcs_collector_is_conditional(c) || dalcs_token_is_same_place(known->name, name)) {
        return true;
    }
    dalcs_language_report(c->language, DALCS_ERROR, NULL, name, "give it another name",
                          "there are two subcircuits '%s', the first at %s", name->text,
                          dalcs_language_place(c->language, known->name));
    return false;
}

static enum dalcs_status begin_subcircuit(struct dalcs_collector *c,
                                          const struct dalcs_card *card) {
    struct dalcs_definition *outer = c->definition;
    struct dalcs_definition *d = dalcs_arena_alloc(c->language->arena, 1, sizeof *d);
    if (d == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_grow(&outer->inner, &outer->inner_capacity, outer->n_inner + 1,
                         sizeof *outer->inner));
    outer->inner[outer->n_inner++] = d;
    d->enclosing = outer;
    d->place = (int)outer->n_items;
    d->card = card->token;
    const bool has_name = card->n > 1 && card->token[1].kind == DALCS_TOKEN_WORD;
    d->name = has_name ? &card->token[1] : card->token;
    if (!has_name) {
        dalcs_collector_missing(c, card->token, ".subckt name port ... [name=value ...]",
                                "the name of the subcircuit");
    } else {
        const int first = dalcs_names_find(&outer->subcircuits, d->name->text);
        if (first < 0) {
            DALCS_TRY(dalcs_names_add(&outer->subcircuits, d->name->text, (int)outer->n_inner - 1));
        } else if (check_second(c, outer->inner[first], d->name)) {
            d->other = outer->inner[first]->other;
            outer->inner[first]->other = d;
        }
    }
    DALCS_TRY(add_item(c, card, DALCS_ITEM_NONE));
    if (c->depth == DALCS_DEEPEST_DEFINITION) {
        dalcs_language_report(c->language, DALCS_ERROR, NULL, card->token, NULL,
                              "subcircuits are defined inside each other more than %d deep",
                              DALCS_DEEPEST_DEFINITION);
        return DALCS_OK;
    }
    c->definition = d;
    c->base[++c->depth] = c->n_open;
    int ports = has_name ? 2 : 1;
    while (ports < card->n && !dalcs_assignment_is_params(&card->token[ports]) &&
           !dalcs_assignment_starts(card, ports)) {
        ports++;
    }
    if (has_name) {
        DALCS_TRY(read_ports(c, card, ports));
    }
    return dalcs_collector_read_assignments(c, card, ports, true);
}

/* ---- Conditions -------------------------------------------------------------------------------- */

static enum dalcs_status read_condition(struct dalcs_collector *c, const struct dalcs_card *card,
                                        enum dalcs_item_kind kind) {
    const int item = (int)c->definition->n_items;
    if ((kind == DALCS_ITEM_IF || kind == DALCS_ITEM_ELSEIF) && card->n < 2) {
        dalcs_collector_missing(c, card->token, ".if (condition)", "the condition");
    }
    if (kind == DALCS_ITEM_IF) {
        DALCS_TRY(dalcs_grow(&c->open, &c->open_capacity, c->n_open + 1, sizeof *c->open));
        c->open[c->n_open++] = (struct dalcs_open_if){item, false};
        const int depth = (int)(c->n_open - c->base[c->depth]);
        if (depth > c->definition->condition_depth) {
            c->definition->condition_depth = depth;
        }
        return add_item(c, card, kind);
    }
    if (!dalcs_collector_is_conditional(c)) {
        dalcs_language_report(c->language, DALCS_ERROR, NULL, card->token, NULL,
                              "%s without an .if", card->token->text);
        return DALCS_OK;
    }
    struct dalcs_open_if *open = &c->open[c->n_open - 1];
    if (open->has_else && kind != DALCS_ITEM_ENDIF) {
        dalcs_language_report(
            c->language, DALCS_ERROR, NULL, card->token, NULL, "%s after .else: the .if is at %s",
            card->token->text,
            dalcs_language_place(c->language, c->definition->item[open->first].card->token));
    }
    open->has_else = open->has_else || kind == DALCS_ITEM_ELSE;
    c->n_open -= kind == DALCS_ITEM_ENDIF;
    return add_item(c, card, kind);
}

/* ---- All cards --------------------------------------------------------------------------------- */

static enum dalcs_status read_model(struct dalcs_collector *c, const struct dalcs_card *card) {
    struct dalcs_definition *d = c->definition;
    enum dalcs_item_kind kind = DALCS_ITEM_MODEL;
    if (card->n > 1 && card->token[1].kind == DALCS_TOKEN_WORD) {
        const int first = dalcs_names_find(&d->models, card->token[1].text);
        if (first < 0) {
            DALCS_TRY(dalcs_names_add(&d->models, card->token[1].text, (int)d->n_items));
        } else if (dalcs_token_is_same_place(d->item[first].card->token, card->token)) {
            kind = DALCS_ITEM_NONE;
        }
    }
    return add_item(c, card, kind);
}

static enum dalcs_status read_global(struct dalcs_collector *c, const struct dalcs_card *card) {
    struct dalcs_names *globals = &c->language->globals;
    for (int k = 1; k < card->n; k++) {
        if (card->token[k].kind == DALCS_TOKEN_WORD &&
            dalcs_names_find(globals, card->token[k].text) < 0) {
            DALCS_TRY(dalcs_names_add(globals, card->token[k].text, 0));
        }
    }
    if (card->n < 2) {
        dalcs_collector_missing(c, card->token, ".global node ...", "a node");
    }
    return DALCS_OK;
}

static enum dalcs_status read_card(struct dalcs_collector *c, const struct dalcs_card *card) {
    static const struct {
        const char *name;

        enum { PARAM, FUNC, SUBCKT, ENDS, GLOBAL, MODEL, IF, ELSEIF, ELSE, ENDIF } what;
    } cards[] = {
        {".param", PARAM},   {".params", PARAM},  {".csparam", PARAM}, {".global_param", PARAM},
        {".func", FUNC},     {".subckt", SUBCKT}, {".ends", ENDS},     {".eom", ENDS},
        {".function", FUNC}, {".params:", PARAM}, {".macro", SUBCKT},  {".global", GLOBAL},
        {".model", MODEL},   {".if", IF},         {".elseif", ELSEIF}, {".else", ELSE},
        {".endif", ENDIF},
    };

    if (card->letter == 'x') {
        return add_item(c, card, DALCS_ITEM_CALL);
    }
    for (size_t k = 0; card->letter == '.' && k < sizeof cards / sizeof cards[0]; k++) {
        if (strcmp(card->token->text, cards[k].name) != 0) {
            continue;
        }
        switch (cards[k].what) {
        case PARAM:
            DALCS_TRY(dalcs_collector_read_param(c, card));
            return add_item(c, card, DALCS_ITEM_NONE);
        case FUNC:
            DALCS_TRY(dalcs_collector_read_function(c, card));
            return add_item(c, card, DALCS_ITEM_NONE);
        case SUBCKT:
            return begin_subcircuit(c, card);
        case ENDS:
            dalcs_collector_end(c, card);
            return DALCS_OK;
        case GLOBAL:
            return read_global(c, card);
        case MODEL:
            return read_model(c, card);
        case IF:
            return read_condition(c, card, DALCS_ITEM_IF);
        case ELSEIF:
            return read_condition(c, card, DALCS_ITEM_ELSEIF);
        case ELSE:
            return read_condition(c, card, DALCS_ITEM_ELSE);
        case ENDIF:
            return read_condition(c, card, DALCS_ITEM_ENDIF);
        }
    }
    return add_item(c, card, DALCS_ITEM_CARD);
}

enum dalcs_status dalcs_definition_collect(struct dalcs_language *language) {
    struct dalcs_collector c = {.language = language, .definition = &language->root};
    const struct dalcs_netlist *netlist = language->netlist;
    const bool lacks_end = dalcs_collector_lacks_end(netlist);
    enum dalcs_status status = DALCS_OK;
    for (size_t k = 0; k < netlist->n_cards && status == DALCS_OK; k++) {
        if (lacks_end) {
            dalcs_collector_end_with_file(&c, &netlist->card[k]);
        }
        status = read_card(&c, &netlist->card[k]);
    }
    while (status == DALCS_OK && c.definition->enclosing != NULL) {
        dalcs_collector_close_conditions(&c);
        dalcs_collector_error(&c, c.definition->card,
                              "add a line: .ends; .end without an s ends the whole file",
                              "this subcircuit is never closed");
        c.definition = c.definition->enclosing;
        c.depth--;
    }
    if (status == DALCS_OK) {
        dalcs_collector_close_conditions(&c);
    }
    free(c.open);
    return status;
}

void dalcs_definition_finish(struct dalcs_definition *definition) {
    for (size_t k = 0; k < definition->n_inner; k++) {
        dalcs_definition_finish(definition->inner[k]);
    }
    for (size_t k = 0; k < definition->functions.n; k++) {
        dalcs_names_finish(&definition->functions.function[k]->arguments);
    }
    dalcs_names_finish(&definition->port_index);
    dalcs_names_finish(&definition->parameters.names);
    dalcs_names_finish(&definition->functions.names);
    dalcs_names_finish(&definition->subcircuits);
    dalcs_names_finish(&definition->models);
    free(definition->item);
    free(definition->parameters.assignment);
    free(definition->parameters.last_of);
    free(definition->functions.function);
    free(definition->inner);
}
