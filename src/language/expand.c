/* expand.c - walks through a definition for each of its instances and copies its cards.
 *
 * Calls are followed by recursion, so many levels as dalcs_call_open() allows. */
#include "expand.h"

#include "call.h"
#include "card_copy.h"
#include "language.h"

#include <stdlib.h>
#include <string.h>

static enum dalcs_status expand_scope(struct dalcs_language *language, struct dalcs_scope *scope);

static enum dalcs_status expand_call(struct dalcs_language *language, struct dalcs_scope *scope,
                                     struct dalcs_item *item) {
    struct dalcs_call call = {.language = language, .scope = scope, .item = item};
    DALCS_TRY(dalcs_call_open(&call));
    if (call.inner == NULL) {
        return DALCS_OK;
    }
    struct dalcs_definition *definition = call.inner->definition;
    const size_t first = language->deck->n_cards;
    definition->is_open = true;
    language->depth++;
    DALCS_TRY(expand_scope(language, call.inner));
    language->depth--;
    definition->is_open = false;
    dalcs_call_close(&call, first);
    return DALCS_OK;
}

static bool is_too_large(struct dalcs_language *language, struct dalcs_scope *scope,
                         const struct dalcs_item *item) {
    const size_t most = language->netlist->most_cards > 0 ? language->netlist->most_cards
                                                          : (size_t)DALCS_MOST_CARDS;
    if (language->n_emitted++ < most || scope->caller == NULL) {
        return false;
    }
    if (!language->too_large) {
        language->too_large = true;
        language->deck->hides_all = true;
        dalcs_language_report(language, DALCS_ERROR, scope, item->card->token, NULL,
                              "the subcircuits hold more than %zu cards", most);
    }
    return true;
}

/* A step has its values, which the cards need not say again: with as many values as runs that would take the square of
 * their number. */
static bool is_of_steps(const struct dalcs_language *language, const struct dalcs_item *item) {
    const char *text = item->card->token->text;
    return language->deck->is_step && item->card->letter == '.' &&
           (strcmp(text, ".step") == 0 || strcmp(text, ".mc") == 0);
}

static enum dalcs_status expand_scope(struct dalcs_language *language, struct dalcs_scope *scope) {
    struct dalcs_definition *definition = scope->definition;
    dalcs_scope_settle(language, scope);
    for (size_t k = 0; k < definition->n_items; k++) {
        struct dalcs_item *item = &definition->item[k];
        if (!dalcs_scope_is_active(scope, (int)k) || is_of_steps(language, item)) {
            continue;
        }
        if (is_too_large(language, scope, item)) {
            return DALCS_OK;
        }
        if (item->kind == DALCS_ITEM_CALL) {
            DALCS_TRY(expand_call(language, scope, item));
        } else if (item->kind == DALCS_ITEM_CARD || item->kind == DALCS_ITEM_MODEL) {
            DALCS_TRY(dalcs_card_copy(language, scope, item));
        }
        if (language->out_of_memory) {
            return DALCS_E_NOMEM;
        }
    }
    return DALCS_OK;
}

/* ---- The whole netlist --------------------------------------------------------------------------- */

/* The netlist's own scope, whose parameters are known when it is settled. */
static enum dalcs_status begin(struct dalcs_deck *deck, const struct dalcs_netlist *netlist,
                               struct dalcs_diag *diag) {
    struct dalcs_language *language = dalcs_arena_alloc(&deck->arena, 1, sizeof *language);
    if (language == NULL) {
        return DALCS_E_NOMEM;
    }
    deck->language = language;
    language->deck = deck;
    language->netlist = netlist;
    language->diag = diag;
    language->arena = &deck->arena;
    dalcs_drawn_start(language);
    DALCS_TRY(dalcs_definition_collect(language));
    language->top = dalcs_scope_make(language, &language->root, NULL, NULL);
    return language->top != NULL ? dalcs_override_parameters(language) : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_deck_settle(struct dalcs_deck *deck, const struct dalcs_netlist *netlist,
                                    struct dalcs_diag *diag) {
    DALCS_TRY(begin(deck, netlist, diag));
    dalcs_scope_settle(deck->language, deck->language->top);
    return deck->language->out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}

enum dalcs_status dalcs_deck_expand(struct dalcs_deck *deck, const struct dalcs_netlist *netlist,
                                    struct dalcs_diag *diag) {
    deck->hides_all = netlist->misses_file;
    if (!netlist->has_language && deck->n_overrides == 0) {
        deck->card = netlist->card;
        deck->n_cards = netlist->n_cards;
        return DALCS_OK;
    }
    enum dalcs_status status = begin(deck, netlist, diag);
    struct dalcs_language *language = deck->language;
    if (status == DALCS_OK) {
        status = expand_scope(language, language->top);
    }
    if (status == DALCS_OK && deck->n_overrides > 0) {
        status = dalcs_override_cards(language);
    }
    if (status == DALCS_OK && netlist->has_tolerances) {
        status = dalcs_tolerances_apply(language);
    }
    deck->card = deck->own;
    return status == DALCS_OK && language->out_of_memory ? DALCS_E_NOMEM : status;
}

const char *dalcs_deck_port(const struct dalcs_deck *deck, const char *name) {
    const char *dot = strrchr(name, '.');
    char instance[256];
    if (deck->language == NULL || dot == NULL || (size_t)(dot - name) >= sizeof instance) {
        return NULL;
    }
    memcpy(instance, name, (size_t)(dot - name));
    instance[dot - name] = '\0';
    const int k = dalcs_names_find(&deck->instances, instance);
    if (k < 0) {
        return NULL;
    }
    const struct dalcs_scope *scope = deck->language->instances.scope[k];
    const int port = dalcs_names_find(&scope->definition->port_index, dot + 1);
    return port >= 0 && scope->port != NULL ? scope->port[port] : NULL;
}

bool dalcs_deck_parameter(const struct dalcs_deck *deck, const char *name, double *value) {
    struct dalcs_scope *top = deck->language != NULL ? deck->language->top : NULL;
    struct dalcs_value *found = NULL;
    if (top != NULL) {
        const char *own = dalcs_language_text(deck->language, DALCS_SCRIPT_PARAMETER, name);
        found = own != NULL ? dalcs_scope_find_value(top, own) : NULL;
        found = found != NULL ? found : dalcs_scope_find_value(top, name);
    }
    if (found == NULL || found->state != DALCS_VALUE_KNOWN) {
        return false;
    }
    found->is_used = true;
    *value = found->value;
    return true;
}

bool dalcs_deck_function(const struct dalcs_deck *deck, const char *name, int *n_arguments,
                         const struct dalcs_expression **body, bool *out_of_memory) {
    struct dalcs_language *language = deck->language;
    struct dalcs_user_function *function = language != NULL && language->top != NULL
                                               ? dalcs_scope_find_function(language->top, name)
                                               : NULL;
    if (function == NULL) {
        return false;
    }
    *n_arguments = function->n_arguments;
    *body = dalcs_scope_compile(language, NULL, function->body, function->n_tokens,
                                &function->arguments, &function->expression)
                ? function->expression
                : NULL;
    *out_of_memory = *out_of_memory || language->out_of_memory;
    return true;
}

void dalcs_deck_finish(struct dalcs_deck *deck) {
    struct dalcs_language *language = deck->language;
    if (language != NULL) {
        dalcs_definition_finish(&language->root);
        dalcs_names_finish(&language->globals);
        dalcs_language_finish_written(language);
        free(language->evaluation.stack);
        free(language->sought.value);
        free(language->instances.scope);
    }
    dalcs_names_finish(&deck->instances);
    free(deck->own);
    free(deck->drawn);
    free(deck->draw);
    dalcs_arena_finish(&deck->arena);
    *deck = (struct dalcs_deck){0};
}
