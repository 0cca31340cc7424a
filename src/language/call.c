/* call.c - the X card: which definition it calls, with which nodes and parameters.
 *
 * A definition that is open already is a recursion of the netlist, an error. */
#include "call.h"

#include "language.h"

#include <string.h>

enum { DEEPEST = 200 };

static void fail(const struct dalcs_call *call, const struct dalcs_token *token, const char *hint,
                 const char *what) {
    dalcs_language_report(call->language, DALCS_ERROR, call->scope, token, hint, "%s", what);
    call->language->deck->hides_elements = true;
}

/* Nodes, then the name, then name=value; false when an error was reported. */
static bool read_call(struct dalcs_call *call) {
    static const char usage[] = "a call is: Xname node ... subcircuit [name=value ...]";
    const struct dalcs_card *card = call->item->card;
    int k = 1;
    for (; k < card->n && !dalcs_assignment_starts(card, k); k++) {
        const struct dalcs_token *token = &card->token[k];
        if (token->kind == DALCS_TOKEN_OPEN || token->kind == DALCS_TOKEN_CLOSE) {
            continue;
        }
        if (token->kind != DALCS_TOKEN_WORD) {
            call->language->deck->hides_elements = true;
            if (token->kind != DALCS_TOKEN_BAD) {
                fail(call, token, usage, "neither a node nor the name of a subcircuit");
            }
            return false;
        }
        if (dalcs_assignment_is_params(token)) {
            break;
        }
        call->n_nodes += call->name > 0;
        call->name = k;
    }
    call->parameters = k;
    if (call->name == 0) {
        dalcs_language_report_at(call->language, DALCS_ERROR, call->scope,
                                 dalcs_token_end(&card->token[k - 1]), usage,
                                 "the name of the subcircuit is missing");
        call->language->deck->hides_elements = true;
        return false;
    }
    return true;
}

static void report_unknown(const struct dalcs_call *call) {
    struct dalcs_language *language = call->language;
    const struct dalcs_card *card = call->item->card;
    const struct dalcs_token *name = &card->token[call->name];
    struct dalcs_scope *owner;
    const char *missing = language->netlist->missing_library;
    const char *hint =
        missing != NULL
            ? dalcs_language_text(language, "it may be in '%s', which was not found", missing)
            : NULL;
    language->deck->hides_elements = true;
    language->deck->has_errors = true;
    if (language->netlist->misses_file || language->deck->hides_all) {
        return; /* it may stand there */
    }
    for (int k = 1; k < call->name && hint == NULL; k++) {
        if (card->token[k].kind == DALCS_TOKEN_WORD &&
            dalcs_scope_find_subcircuit(call->scope, card->token[k].text, &owner) != NULL) {
            hint = dalcs_language_text(language, "after the subcircuit '%s' write name=value",
                                       card->token[k].text);
        }
    }
    for (struct dalcs_scope *s = call->scope; s != NULL && hint == NULL; s = s->enclosing) {
        hint = dalcs_language_suggest(language, &s->definition->subcircuits, name->text,
                                      "subcircuits");
    }
    dalcs_language_report(
        language, DALCS_ERROR, call->scope, name,
        hint != NULL
            ? hint
            : "a subcircuit is: .subckt name port ... .ends; .include reads a file that has it",
        "there is no subcircuit '%s'", name->text);
}

/* "a b": the ports, for a message. */
static const char *port_list(struct dalcs_language *language,
                             const struct dalcs_definition *definition) {
    const char *list = "";
    for (int k = 0; k < definition->n_ports && k < 20 && list != NULL; k++) {
        list = dalcs_language_text(language, "%s %s", list, definition->port[k]->text);
    }
    return list != NULL ? list : "";
}

static bool connect(const struct dalcs_call *call, const struct dalcs_definition *definition,
                    struct dalcs_scope *inner) {
    struct dalcs_language *language = call->language;
    const struct dalcs_card *card = call->item->card;
    if (call->n_nodes != definition->n_ports) {
        dalcs_language_report(
            language, DALCS_ERROR, call->scope, &card->token[call->name],
            dalcs_language_text(language, "%s: .subckt %s%s",
                                dalcs_language_place(language, definition->name),
                                definition->name->text, port_list(language, definition)),
            "%d node%s for '%s', which has %d port%s", call->n_nodes, call->n_nodes == 1 ? "" : "s",
            definition->name->text, definition->n_ports, definition->n_ports == 1 ? "" : "s");
        language->deck->hides_elements = true;
        return false;
    }
    inner->port = dalcs_arena_alloc(language->arena, (size_t)call->n_nodes, sizeof *inner->port);
    if (inner->port == NULL) {
        language->out_of_memory = true;
        return false;
    }
    int n = 0;
    for (int k = 1; k < call->name; k++) {
        if (card->token[k].kind == DALCS_TOKEN_WORD) {
            inner->port[n++] =
                dalcs_scope_flat_name(language, call->scope, true, card->token[k].text);
        }
    }
    return !language->out_of_memory;
}

/* The parameter `name` of the scope, or a new one that nothing declares. */
static struct dalcs_value *parameter_of(struct dalcs_scope *inner, const struct dalcs_token *name) {
    const int slot = dalcs_names_find(&inner->definition->parameters.names, name->text);
    if (slot >= 0) {
        return &inner->value[slot];
    }
    for (int k = 0; k < inner->n_extra; k++) {
        if (strcmp(inner->extra[k].name->text, name->text) == 0) {
            return &inner->extra[k];
        }
    }
    return &inner->extra[inner->n_extra++];
}

static bool give_parameters(const struct dalcs_call *call, struct dalcs_scope *inner) {
    struct dalcs_language *language = call->language;
    struct dalcs_item *item = call->item;
    const struct dalcs_card *card = item->card;
    int at = call->parameters;
    int value_at;
    if (at >= card->n) {
        return true;
    }
    inner->extra =
        dalcs_arena_alloc(language->arena, (size_t)(card->n - at) / 3 + 1, sizeof *inner->extra);
    if (item->expression == NULL) {
        item->expression =
            dalcs_arena_alloc(language->arena, (size_t)card->n, sizeof *item->expression);
    }
    if (inner->extra == NULL || item->expression == NULL) {
        language->out_of_memory = true;
        return false;
    }
    while (at < card->n) {
        const struct dalcs_token *name =
            dalcs_assignment_next(language, call->scope, card, &at, &value_at);
        if (name == NULL) {
            language->deck->has_errors = true;
            return false;
        }
        struct dalcs_value *value = parameter_of(inner, name);
        if (value->is_given) {
            dalcs_language_report(language, DALCS_ERROR, call->scope, name, NULL,
                                  "'%s' is given twice", name->text);
            return false;
        }
        *value = (struct dalcs_value){.name = name,
                                      .token = &card->token[value_at],
                                      .n_tokens = at - value_at,
                                      .expression = &item->expression[value_at],
                                      .where = call->scope,
                                      .owner = inner,
                                      .is_given = true};
    }
    return true;
}

/* So many of the cards from the first on lie in parallel, with those that were so already. */
static void multiply(struct dalcs_deck *deck, size_t first, double m) {
    for (size_t k = first; k < deck->n_cards; k++) {
        struct dalcs_card *card = &deck->own[k];
        card->parallel = (card->parallel > 0 ? card->parallel : 1) * m;
    }
}

/* Names the instance; *is_new is false when there is one of the name, an error. */
static enum dalcs_status name_instance(const struct dalcs_call *call, struct dalcs_scope *inner,
                                       bool *is_new) {
    struct dalcs_language *language = call->language;
    const struct dalcs_token *x = call->item->card->token;
    struct dalcs_origin *origin = dalcs_arena_alloc(language->arena, 1, sizeof *origin);
    inner->name = dalcs_scope_flat_name(language, call->scope, false, x->text);
    if (origin == NULL || inner->name == NULL) {
        return DALCS_E_NOMEM;
    }
    *origin = (struct dalcs_origin){inner->name, x->line->source->name, x->line->number,
                                    call->scope->origin};
    inner->origin = origin;
    const int first = dalcs_names_find(&language->deck->instances, inner->name);
    *is_new = first < 0;
    if (first >= 0) {
        const struct dalcs_origin *known = language->instances.scope[first]->origin;
        dalcs_language_report(language, DALCS_ERROR, call->scope, x, "give it another name",
                              "there are two calls '%s', the first at %s:%d", inner->name,
                              known->file, known->line);
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_grow(&language->instances.scope, &language->instances.capacity,
                         language->instances.n + 1, sizeof(struct dalcs_scope *)));
    DALCS_TRY(dalcs_names_add(&language->deck->instances, inner->name, (int)language->instances.n));
    language->instances.scope[language->instances.n++] = inner;
    return DALCS_OK;
}

enum dalcs_status dalcs_call_open(struct dalcs_call *call) {
    struct dalcs_language *language = call->language;
    struct dalcs_scope *owner = NULL;
    if (!read_call(call)) {
        return DALCS_OK;
    }
    const struct dalcs_token *name = &call->item->card->token[call->name];
    struct dalcs_definition *definition =
        dalcs_scope_find_subcircuit(call->scope, name->text, &owner);
    if (definition == NULL) {
        report_unknown(call);
        return DALCS_OK;
    }
    if (definition->is_open || language->depth >= DEEPEST) {
        fail(call, name, NULL,
             definition->is_open ? "this subcircuit calls itself"
                                 : "subcircuits call each other more than 200 deep");
        return DALCS_OK;
    }
    struct dalcs_scope *inner = dalcs_scope_make(language, definition, call->scope, owner);
    if (inner == NULL) {
        return DALCS_E_NOMEM;
    }
    bool is_new;
    DALCS_TRY(name_instance(call, inner, &is_new));
    if (!is_new) {
        return DALCS_OK;
    }
    if (!connect(call, definition, inner) || !give_parameters(call, inner)) {
        language->deck->hides_elements = true;
        return language->out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
    }
    call->inner = inner;
    return DALCS_OK;
}

void dalcs_call_close(const struct dalcs_call *call, size_t first) {
    struct dalcs_language *language = call->language;
    const struct dalcs_scope *inner = call->inner;
    for (int k = 0; k < inner->n_extra; k++) {
        const struct dalcs_value *extra = &inner->extra[k];
        const char *name = extra->name->text;
        if (extra->is_used) {
            continue;
        }
        if (strcmp(name, "m") == 0) {
            if (extra->state == DALCS_VALUE_KNOWN && extra->value <= 0) {
                dalcs_language_report(language, DALCS_ERROR, call->scope, extra->name, NULL,
                                      "m=%g: a number in parallel must be positive", extra->value);
            } else if (extra->state == DALCS_VALUE_KNOWN && extra->value != 1) {
                multiply(language->deck, first, extra->value);
            }
            continue;
        }
        dalcs_language_report(language, DALCS_WARNING, call->scope, extra->name,
                              dalcs_language_suggest(language, &inner->definition->parameters.names,
                                                     name, "parameters"),
                              "'%s' has no parameter '%s': it is ignored",
                              inner->definition->name->text, name);
    }
}
