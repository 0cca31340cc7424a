/* definition_values.c - the parameters and functions that a card defines, as .param and .func in the spellings of all
 * simulators. */
#include "collector.h"

#include <string.h>

static enum dalcs_status assign(struct dalcs_collector *c, const struct dalcs_token *name,
                                const struct dalcs_token *value, int n, bool is_formal) {
    struct dalcs_definition *d = c->definition;
    int slot = dalcs_names_find(&d->parameters.names, name->text);
    if (slot >= 0) {
        const struct dalcs_assignment *last =
            &d->parameters.assignment[d->parameters.last_of[slot]];
        const bool both_formal = is_formal && last->item < 0;
        if (both_formal ||
            (last->item >= 0 && !last->is_conditional && !dalcs_collector_is_conditional(c) &&
             !dalcs_token_is_same_place(last->name, name))) {
            dalcs_language_report(c->language, both_formal ? DALCS_ERROR : DALCS_WARNING, NULL,
                                  name, both_formal ? "give it another name" : NULL,
                                  both_formal
                                      ? "there are two parameters '%s', the first at %s"
                                      : "parameter '%s' is set twice: this value counts, not "
                                        "that at %s",
                                  name->text, dalcs_language_place(c->language, last->name));
        }
    } else {
        slot = d->parameters.n_slots;
        DALCS_TRY(dalcs_grow(&d->parameters.last_of, &d->parameters.last_capacity, (size_t)slot + 1,
                             sizeof *d->parameters.last_of));
        DALCS_TRY(dalcs_names_add(&d->parameters.names, name->text, slot));
        d->parameters.n_slots++;
    }
    d->parameters.last_of[slot] = d->parameters.n_assignments;
    DALCS_TRY(dalcs_grow(&d->parameters.assignment, &d->parameters.capacity,
                         d->parameters.n_assignments + 1, sizeof *d->parameters.assignment));
    d->parameters.assignment[d->parameters.n_assignments++] = (struct dalcs_assignment){
        .name = name,
        .value = value,
        .n_tokens = n,
        .slot = slot,
        .item = is_formal ? -1 : (int)d->n_items,
        .is_conditional = !is_formal && dalcs_collector_is_conditional(c)};
    return DALCS_OK;
}

/* name(argument, ...) from token `at` on; the token after it, 0 when it is not of that form. */
static int function_head(const struct dalcs_card *card, int at) {
    const struct dalcs_token *token = card->token;
    if (at + 2 >= card->n || token[at].kind != DALCS_TOKEN_WORD ||
        token[at + 1].kind != DALCS_TOKEN_OPEN) {
        return 0;
    }
    int k = at + 2;
    while (k < card->n && token[k].kind == DALCS_TOKEN_WORD) {
        k++;
    }
    return k < card->n && token[k].kind == DALCS_TOKEN_CLOSE ? k + 1 : 0;
}

static const char FUNC_USAGE[] = ".func name(argument, ...) {expression}";

/* Under a condition there may be several of a name, and where a file is read twice. */
static enum dalcs_status name_function(struct dalcs_collector *c,
                                       struct dalcs_user_function *function) {
    struct dalcs_definition *d = c->definition;
    const struct dalcs_token *name = function->name;
    const int first = dalcs_names_find(&d->functions.names, name->text);
    if (first < 0) {
        return dalcs_names_add(&d->functions.names, name->text, (int)d->functions.n - 1);
    }
    struct dalcs_user_function *known = d->functions.function[first];
    if (!dalcs_collector_is_conditional(c) && !dalcs_token_is_same_place(known->name, name)) {
        dalcs_language_report(c->language, DALCS_ERROR, NULL, name, "give it another name",
                              "there are two functions '%s', the first at %s", name->text,
                              dalcs_language_place(c->language, known->name));
        return DALCS_OK;
    }
    function->other = known->other;
    known->other = function;
    return DALCS_OK;
}

/* A function whose head is token[at..head-1] and whose body is token[body..end-1]. */
static enum dalcs_status add_function(struct dalcs_collector *c, const struct dalcs_card *card,
                                      int at, int head, int body, int end) {
    struct dalcs_definition *d = c->definition;
    const struct dalcs_token *name = &card->token[at];
    bool is_bad = body >= end;
    if (is_bad) {
        dalcs_collector_missing(c, &card->token[body - 1], FUNC_USAGE, "the expression");
    }
    for (int k = body; k < end; k++) {
        is_bad = is_bad || card->token[k].kind == DALCS_TOKEN_BAD;
    }
    if (is_bad) {
        c->language->misses_assignment = true;
        return DALCS_OK;
    }
    struct dalcs_user_function *function =
        dalcs_arena_alloc(c->language->arena, 1, sizeof *function);
    if (function == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_grow(&d->functions.function, &d->functions.capacity, d->functions.n + 1,
                         sizeof *d->functions.function));
    d->functions.function[d->functions.n++] =
        function; /* from here on it is freed with the definition */
    function->name = name;
    function->body = &card->token[body];
    function->n_tokens = end - body;
    function->item = (int)d->n_items;
    for (int k = at + 2; k < head - 1; k++) {
        const char *argument = card->token[k].text;
        if (dalcs_names_find(&function->arguments, argument) >= 0) {
            dalcs_language_report(c->language, DALCS_ERROR, NULL, &card->token[k], NULL,
                                  "there are two arguments '%s'", argument);
        } else {
            DALCS_TRY(dalcs_names_add(&function->arguments, argument, k - at - 2));
        }
    }
    function->n_arguments = head - at - 3;
    return name_function(c, function);
}

enum dalcs_status dalcs_collector_read_function(struct dalcs_collector *c,
                                                const struct dalcs_card *card) {
    const int head = function_head(card, 1);
    c->language->misses_assignment = c->language->misses_assignment || head == 0;
    if (head == 0) {
        dalcs_collector_missing(c, card->n > 1 ? &card->token[1] : card->token, FUNC_USAGE,
                                card->n > 1 ? "the list of arguments" : "the name of the function");
        return DALCS_OK;
    }
    int body = head;
    body += body < card->n && card->token[body].kind == DALCS_TOKEN_EQUAL;
    return add_function(c, card, 1, head, body, card->n);
}

/* `name value` without an equal sign, as LTspice takes it on .param. */
static bool is_plain_pair(const struct dalcs_card *card, int k) {
    if (k + 1 >= card->n || card->token[k].kind != DALCS_TOKEN_WORD) {
        return false;
    }
    const char first = card->token[k].text[0];
    const enum dalcs_token_kind next = card->token[k + 1].kind;
    const bool is_name = (first >= 'a' && first <= 'z') || first == '_';
    const bool ends = k + 2 >= card->n || card->token[k + 2].kind != DALCS_TOKEN_EQUAL;
    return is_name && ends && (next == DALCS_TOKEN_WORD || next == DALCS_TOKEN_EXPRESSION);
}

/* `name expression`, which has parentheses and is all of the card. */
static bool is_plain_expression(const struct dalcs_card *card, int at) {
    bool has_parenthesis = false;
    for (int k = at + 1; k < card->n; k++) {
        if (card->token[k].kind == DALCS_TOKEN_EQUAL || card->token[k].kind == DALCS_TOKEN_BAD) {
            return false;
        }
        has_parenthesis =
            has_parenthesis || (k > at + 1 && card->token[k].kind == DALCS_TOKEN_OPEN);
    }
    return has_parenthesis && is_plain_pair(card, at);
}

/* Does a .param set the name? Then .csparam name={name}, ngspice's idiom, gives its value to the script alone. */
static bool is_set_elsewhere(const struct dalcs_collector *c, const char *name) {
    const struct dalcs_netlist *netlist = c->language->netlist;
    for (size_t k = 0; k < netlist->n_cards; k++) {
        const struct dalcs_card *card = &netlist->card[k];
        const bool sets = card->letter == '.' && (strcmp(card->token->text, ".param") == 0 ||
                                                  strcmp(card->token->text, ".params") == 0);
        for (int i = 1; sets && i < card->n; i++) {
            if (card->token[i].kind == DALCS_TOKEN_WORD && strcmp(card->token[i].text, name) == 0 &&
                (dalcs_assignment_starts(card, i) || (i == 1 && is_plain_pair(card, i)))) {
                return true;
            }
        }
    }
    return false;
}

/* The name that such a parameter of the script has among those of the netlist. */
static const struct dalcs_token *script_name(struct dalcs_collector *c,
                                             const struct dalcs_token *name) {
    struct dalcs_token *copy = dalcs_arena_alloc(c->language->arena, 1, sizeof *copy);
    const char *text = dalcs_language_text(c->language, DALCS_SCRIPT_PARAMETER, name->text);
    if (copy == NULL || text == NULL) {
        return NULL;
    }
    *copy = *name;
    copy->text = text;
    return copy;
}

/* On a card of parameters. */
static enum dalcs_status assign_parameter(struct dalcs_collector *c, const struct dalcs_card *card,
                                          const struct dalcs_token *name,
                                          const struct dalcs_token *value, int n) {
    if (strcmp(card->token->text, ".csparam") == 0 && is_set_elsewhere(c, name->text)) {
        name = script_name(c, name);
    }
    return name != NULL ? assign(c, name, value, n, false) : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_collector_read_assignments(struct dalcs_collector *c,
                                                   const struct dalcs_card *card, int at,
                                                   bool is_formal) {
    int value;
    while (at < card->n) {
        const int head = is_formal ? 0 : function_head(card, at);
        if (head > 0 && head + 1 < card->n && card->token[head].kind == DALCS_TOKEN_EQUAL) {
            int end = head + 1;
            while (end < card->n && !dalcs_assignment_starts(card, end)) {
                end++;
            }
            DALCS_TRY(add_function(c, card, at, head, head + 1, end));
            at = end;
            continue;
        }
        if (!is_formal && is_plain_expression(card, at)) {
            return assign_parameter(c, card, &card->token[at], &card->token[at + 1],
                                    card->n - at - 1);
        }
        if (!is_formal && is_plain_pair(card, at)) {
            DALCS_TRY(assign_parameter(c, card, &card->token[at], &card->token[at + 1], 1));
            at += 2;
            continue;
        }
        const struct dalcs_token *name =
            dalcs_assignment_next(c->language, NULL, card, &at, &value);
        if (name == NULL) {
            c->language->misses_assignment = c->language->misses_assignment || at < card->n;
            return DALCS_OK;
        }
        DALCS_TRY(is_formal ? assign(c, name, &card->token[value], at - value, true)
                            : assign_parameter(c, card, name, &card->token[value], at - value));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_collector_read_param(struct dalcs_collector *c,
                                             const struct dalcs_card *card) {
    if (card->n < 2) {
        dalcs_collector_missing(c, card->token, ".param name=value ...", "a parameter");
        return DALCS_OK;
    }
    return dalcs_collector_read_assignments(c, card, 1, false);
}
