/* definition.c - the netlist's cards sorted into definitions: the netlist and its subcircuits.
 *
 * Nothing is evaluated here. Errors inside a subcircuit that is never called are not reported, as far
 * as it can be read at all. */
#include "language.h"

#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 100 };

/* An .if that is not closed yet. */
struct open_if {
    int first; /* its item */
    bool has_else;
};

struct collector {
    struct dalcs_language *language;
    struct dalcs_definition *definition; /* the one being read */
    struct open_if *open;                /* heap */
    size_t n_open, open_capacity;
    size_t base[DEEPEST + 1]; /* n_open where each definition started */
    int depth;
};

static void error_at(struct collector *c, const struct dalcs_token *token, const char *hint,
                     const char *what) {
    dalcs_language_report(c->language, DALCS_ERROR, NULL, token, hint, "%s", what);
}

static void missing(struct collector *c, const struct dalcs_token *after, const char *usage,
                    const char *what) {
    dalcs_language_report_at(c->language, DALCS_ERROR, NULL, dalcs_token_end(after), usage,
                             "%s is missing", what);
}

static bool is_conditional(const struct collector *c) {
    return c->n_open > c->base[c->depth];
}

/* The same line of a file that was included twice? */
static bool is_same_place(const struct dalcs_token *a, const struct dalcs_token *b) {
    const struct dalcs_source *x = a->line->source;
    const struct dalcs_source *y = b->line->source;
    return a->line->number == b->line->number && x != y && x->real != NULL && y->real != NULL &&
           strcmp(x->real, y->real) == 0;
}

static enum dalcs_status add_item(struct collector *c, const struct dalcs_card *card,
                                  enum dalcs_item_kind kind) {
    struct dalcs_definition *d = c->definition;
    DALCS_TRY(dalcs_grow(&d->item, &d->item_capacity, d->n_items + 1, sizeof *d->item));
    d->item[d->n_items++] = (struct dalcs_item){.card = card, .kind = kind};
    return DALCS_OK;
}

/* ---- Parameters and functions ------------------------------------------------------------------ */

static enum dalcs_status assign(struct collector *c, const struct dalcs_token *name,
                                const struct dalcs_token *value, int n, bool is_formal) {
    struct dalcs_definition *d = c->definition;
    int slot = dalcs_names_find(&d->parameters, name->text);
    if (slot >= 0) {
        const struct dalcs_assignment *last = &d->assignment[d->last_of[slot]];
        const bool both_formal = is_formal && last->item < 0;
        if (both_formal || (last->item >= 0 && !last->is_conditional && !is_conditional(c) &&
                            !is_same_place(last->name, name))) {
            dalcs_language_report(c->language, both_formal ? DALCS_ERROR : DALCS_WARNING, NULL,
                                  name, both_formal ? "give it another name" : NULL,
                                  both_formal
                                      ? "there are two parameters '%s', the first at %s"
                                      : "parameter '%s' is set twice: this value counts, not "
                                        "that at %s",
                                  name->text, dalcs_language_place(c->language, last->name));
        }
    } else {
        slot = d->n_slots;
        DALCS_TRY(dalcs_grow(&d->last_of, &d->last_capacity, (size_t)slot + 1, sizeof *d->last_of));
        DALCS_TRY(dalcs_names_add(&d->parameters, name->text, slot));
        d->n_slots++;
    }
    d->last_of[slot] = d->n_assignments;
    DALCS_TRY(dalcs_grow(&d->assignment, &d->assignment_capacity, d->n_assignments + 1,
                         sizeof *d->assignment));
    d->assignment[d->n_assignments++] =
        (struct dalcs_assignment){.name = name,
                                  .value = value,
                                  .n_tokens = n,
                                  .slot = slot,
                                  .item = is_formal ? -1 : (int)d->n_items,
                                  .is_conditional = !is_formal && is_conditional(c)};
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

/* A function whose head is token[at..head-1] and whose body is token[body..end-1]. */
static enum dalcs_status add_function(struct collector *c, const struct dalcs_card *card, int at,
                                      int head, int body, int end) {
    struct dalcs_definition *d = c->definition;
    const struct dalcs_token *name = &card->token[at];
    bool is_bad = body >= end;
    if (is_bad) {
        missing(c, &card->token[body - 1], FUNC_USAGE, "the expression");
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
    DALCS_TRY(
        dalcs_grow(&d->function, &d->function_capacity, d->n_functions + 1, sizeof *d->function));
    d->function[d->n_functions++] = function; /* from here on it is freed with the definition */
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
    const int first = dalcs_names_find(&d->functions, name->text);
    if (first < 0) {
        return dalcs_names_add(&d->functions, name->text, (int)d->n_functions - 1);
    }
    struct dalcs_user_function *known = d->function[first];
    if (!is_conditional(c) && !is_same_place(known->name, name)) {
        dalcs_language_report(c->language, DALCS_ERROR, NULL, name, "give it another name",
                              "there are two functions '%s', the first at %s", name->text,
                              dalcs_language_place(c->language, known->name));
        return DALCS_OK;
    }
    function->other = known->other;
    known->other = function;
    return DALCS_OK;
}

static enum dalcs_status read_function(struct collector *c, const struct dalcs_card *card) {
    const int head = function_head(card, 1);
    c->language->misses_assignment = c->language->misses_assignment || head == 0;
    if (head == 0) {
        missing(c, card->n > 1 ? &card->token[1] : card->token, FUNC_USAGE,
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
static bool is_set_elsewhere(const struct collector *c, const char *name) {
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
static const struct dalcs_token *script_name(struct collector *c, const struct dalcs_token *name) {
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
static enum dalcs_status assign_parameter(struct collector *c, const struct dalcs_card *card,
                                          const struct dalcs_token *name,
                                          const struct dalcs_token *value, int n) {
    if (strcmp(card->token->text, ".csparam") == 0 && is_set_elsewhere(c, name->text)) {
        name = script_name(c, name);
    }
    return name != NULL ? assign(c, name, value, n, false) : DALCS_E_NOMEM;
}

static enum dalcs_status read_assignments(struct collector *c, const struct dalcs_card *card,
                                          int at, bool is_formal) {
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

static enum dalcs_status read_param(struct collector *c, const struct dalcs_card *card) {
    if (card->n < 2) {
        missing(c, card->token, ".param name=value ...", "a parameter");
        return DALCS_OK;
    }
    return read_assignments(c, card, 1, false);
}

/* ---- Subcircuits ------------------------------------------------------------------------------- */

static enum dalcs_status read_ports(struct collector *c, const struct dalcs_card *card, int end) {
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
                error_at(c, port, ".subckt name port ... [name=value ...]",
                         "this is not the name of a port");
            }
        } else if (strcmp(port->text, "0") == 0) {
            error_at(c, port, NULL, "node 0 is ground everywhere: it cannot be a port");
        } else if (strcmp(port->text, "optional:") == 0) {
            error_at(c, port, "leave it out and write the node",
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
static bool check_second(struct collector *c, const struct dalcs_definition *known,
                         const struct dalcs_token *name) {
    if (is_conditional(c) || is_same_place(known->name, name)) {
        return true;
    }
    dalcs_language_report(c->language, DALCS_ERROR, NULL, name, "give it another name",
                          "there are two subcircuits '%s', the first at %s", name->text,
                          dalcs_language_place(c->language, known->name));
    return false;
}

static enum dalcs_status begin_subcircuit(struct collector *c, const struct dalcs_card *card) {
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
        missing(c, card->token, ".subckt name port ... [name=value ...]",
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
    if (c->depth == DEEPEST) {
        dalcs_language_report(c->language, DALCS_ERROR, NULL, card->token, NULL,
                              "subcircuits are defined inside each other more than %d deep",
                              DEEPEST);
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
    return read_assignments(c, card, ports, true);
}

/* Reports the .if that are open in the present definition. */
static void close_conditions(struct collector *c) {
    while (is_conditional(c)) {
        const struct open_if *open = &c->open[--c->n_open];
        error_at(c, c->definition->item[open->first].card->token, "add a line: .endif",
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

static void end_subcircuit(struct collector *c, const struct dalcs_card *card) {
    struct dalcs_definition *d = c->definition;
    if (d->enclosing == NULL) {
        error_at(c, card->token, NULL, ".ends without a .subckt");
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
    close_conditions(c);
    c->definition = d->enclosing;
    c->depth--;
}

/* ---- Conditions -------------------------------------------------------------------------------- */

static enum dalcs_status read_condition(struct collector *c, const struct dalcs_card *card,
                                        enum dalcs_item_kind kind) {
    const int item = (int)c->definition->n_items;
    if ((kind == DALCS_ITEM_IF || kind == DALCS_ITEM_ELSEIF) && card->n < 2) {
        missing(c, card->token, ".if (condition)", "the condition");
    }
    if (kind == DALCS_ITEM_IF) {
        DALCS_TRY(dalcs_grow(&c->open, &c->open_capacity, c->n_open + 1, sizeof *c->open));
        c->open[c->n_open++] = (struct open_if){item, false};
        const int depth = (int)(c->n_open - c->base[c->depth]);
        if (depth > c->definition->condition_depth) {
            c->definition->condition_depth = depth;
        }
        return add_item(c, card, kind);
    }
    if (!is_conditional(c)) {
        dalcs_language_report(c->language, DALCS_ERROR, NULL, card->token, NULL,
                              "%s without an .if", card->token->text);
        return DALCS_OK;
    }
    struct open_if *open = &c->open[c->n_open - 1];
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

static enum dalcs_status read_model(struct collector *c, const struct dalcs_card *card) {
    struct dalcs_definition *d = c->definition;
    enum dalcs_item_kind kind = DALCS_ITEM_MODEL;
    if (card->n > 1 && card->token[1].kind == DALCS_TOKEN_WORD) {
        const int first = dalcs_names_find(&d->models, card->token[1].text);
        if (first < 0) {
            DALCS_TRY(dalcs_names_add(&d->models, card->token[1].text, (int)d->n_items));
        } else if (is_same_place(d->item[first].card->token, card->token)) {
            kind = DALCS_ITEM_NONE;
        }
    }
    return add_item(c, card, kind);
}

static enum dalcs_status read_global(struct collector *c, const struct dalcs_card *card) {
    struct dalcs_names *globals = &c->language->globals;
    for (int k = 1; k < card->n; k++) {
        if (card->token[k].kind == DALCS_TOKEN_WORD &&
            dalcs_names_find(globals, card->token[k].text) < 0) {
            DALCS_TRY(dalcs_names_add(globals, card->token[k].text, 0));
        }
    }
    if (card->n < 2) {
        missing(c, card->token, ".global node ...", "a node");
    }
    return DALCS_OK;
}

static enum dalcs_status read_card(struct collector *c, const struct dalcs_card *card) {
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
            DALCS_TRY(read_param(c, card));
            return add_item(c, card, DALCS_ITEM_NONE);
        case FUNC:
            DALCS_TRY(read_function(c, card));
            return add_item(c, card, DALCS_ITEM_NONE);
        case SUBCKT:
            return begin_subcircuit(c, card);
        case ENDS:
            end_subcircuit(c, card);
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
    struct collector c = {.language = language, .definition = &language->root};
    enum dalcs_status status = DALCS_OK;
    for (size_t k = 0; k < language->netlist->n_cards && status == DALCS_OK; k++) {
        status = read_card(&c, &language->netlist->card[k]);
    }
    while (status == DALCS_OK && c.definition->enclosing != NULL) {
        close_conditions(&c);
        error_at(&c, c.definition->card, "add a line: .ends", "this subcircuit is never closed");
        c.definition = c.definition->enclosing;
        c.depth--;
    }
    if (status == DALCS_OK) {
        close_conditions(&c);
    }
    free(c.open);
    return status;
}

void dalcs_definition_finish(struct dalcs_definition *definition) {
    for (size_t k = 0; k < definition->n_inner; k++) {
        dalcs_definition_finish(definition->inner[k]);
    }
    for (size_t k = 0; k < definition->n_functions; k++) {
        dalcs_names_finish(&definition->function[k]->arguments);
    }
    dalcs_names_finish(&definition->port_index);
    dalcs_names_finish(&definition->parameters);
    dalcs_names_finish(&definition->functions);
    dalcs_names_finish(&definition->subcircuits);
    dalcs_names_finish(&definition->models);
    free(definition->item);
    free(definition->assignment);
    free(definition->last_of);
    free(definition->function);
    free(definition->inner);
}
