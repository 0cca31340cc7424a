/* expand.c - walks through a definition for each of its instances and copies its cards.
 *
 * Calls are followed by recursion, DEEPEST levels at most. A definition that is open already is a
 * recursion of the netlist, an error. */
#include "expand.h"

#include "language.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 200 };

/* ---- Names ------------------------------------------------------------------------------------- */

/* A name of this scope as the flat netlist has it. */
static const char *flat_name(struct dalcs_language *language, const struct dalcs_scope *scope,
                             const char *name) {
    return scope->caller == NULL ? name : dalcs_language_text(language, "%s.%s", scope->name, name);
}

static const char *node_name(struct dalcs_language *language, const struct dalcs_scope *scope,
                             const char *name) {
    if (scope->caller == NULL) {
        return name;
    }
    const int port = dalcs_names_find(&scope->definition->port_index, name);
    if (port >= 0) {
        return scope->port[port];
    }
    if (strcmp(name, "0") == 0 || strcmp(name, "gnd") == 0 ||
        dalcs_names_find(&language->globals, name) >= 0) {
        return name;
    }
    return flat_name(language, scope, name);
}

const char *dalcs_scope_flat_name(struct dalcs_language *language, const struct dalcs_scope *scope,
                                  bool is_node, const char *name) {
    return is_node ? node_name(language, scope, name) : flat_name(language, scope, name);
}

static const char *model_name(struct dalcs_language *language, const struct dalcs_scope *scope,
                              const char *name) {
    for (const struct dalcs_scope *s = scope; s != NULL; s = s->enclosing) {
        if (dalcs_names_find(&s->definition->models, name) >= 0) {
            return flat_name(language, s, name);
        }
    }
    return name;
}

/* ---- Copying a card ---------------------------------------------------------------------------- */

static enum dalcs_status emit(struct dalcs_language *language, const struct dalcs_card *card) {
    struct dalcs_deck *deck = language->deck;
    DALCS_TRY(dalcs_grow(&deck->own, &deck->own_capacity, deck->n_cards + 1, sizeof *deck->own));
    deck->own[deck->n_cards++] = *card;
    return DALCS_OK;
}

/* The line of a token, as this instance has it. */
static const struct dalcs_source_line *line_of(struct dalcs_language *language,
                                               struct dalcs_scope *scope,
                                               const struct dalcs_source_line *line) {
    if (scope->origin == NULL) {
        return line;
    }
    if (scope->line != line) {
        struct dalcs_source_line *copy = dalcs_arena_alloc(language->arena, 1, sizeof *copy);
        if (copy == NULL) {
            language->out_of_memory = true;
            return line;
        }
        *copy = *line;
        copy->instance = scope->origin;
        scope->line = line;
        scope->copy = copy;
    }
    return scope->copy;
}

/* The value of {...} on a card, or of the name of a parameter. */
static void evaluate_token(struct dalcs_language *language, struct dalcs_scope *scope,
                           struct dalcs_item *item, int k, struct dalcs_token *token) {
    if (item->expression == NULL) {
        item->expression =
            dalcs_arena_alloc(language->arena, (size_t)item->card->n, sizeof *item->expression);
        if (item->expression == NULL) {
            language->out_of_memory = true;
            return;
        }
    }
    const struct dalcs_draw_place before = dalcs_drawn_enter(
        language, (struct dalcs_draw_place){.scope = scope, .card = item->card, .at = k});
    const bool ok = dalcs_scope_compile(language, scope, &item->card->token[k], 1, NULL,
                                        &item->expression[k]) &&
                    dalcs_scope_evaluate(language, scope, item->expression[k], &token->value);
    dalcs_drawn_leave(language, before, ok ? &token->value : NULL);
    token->kind = ok ? DALCS_TOKEN_NUMBER : DALCS_TOKEN_BAD;
}

/* A bare word where a value stands: a parameter's name? */
static bool is_parameter(struct dalcs_scope *scope, const struct dalcs_card *card, int k) {
    const struct dalcs_token *token = &card->token[k];
    const bool after_equal = card->token[k - 1].kind == DALCS_TOKEN_EQUAL;
    const bool is_name = (token->text[0] >= 'a' && token->text[0] <= 'z') || token->text[0] == '_';
    const bool is_assigned = after_equal && (strcmp(card->token->text, ".model") == 0 ||
                                             strcmp(card->token->text, ".ic") == 0);
    const bool may = card->letter == '.' ? is_assigned : true;
    if (token->kind != DALCS_TOKEN_WORD || !is_name || !may) {
        return false;
    }
    if (k + 1 < card->n && (card->token[k + 1].kind == DALCS_TOKEN_EQUAL ||
                            card->token[k + 1].kind == DALCS_TOKEN_OPEN)) {
        return false;
    }
    return dalcs_scope_find_value(scope, token->text) != NULL;
}

static bool has_parameters(const struct dalcs_scope *scope) {
    for (; scope != NULL; scope = scope->caller) {
        if (scope->definition->n_slots > 0 || scope->n_extra > 0) {
            return true;
        }
    }
    return false;
}

/* Does the card stay as it is? */
static bool is_flat(struct dalcs_scope *scope, const struct dalcs_card *card) {
    int first;
    int n;
    if (scope->caller != NULL || has_parameters(scope) || dalcs_formula_find(card, &first, &n) ||
        dalcs_transfer_find(card, &first, &n)) {
        return false;
    }
    for (int k = 1; k < card->n; k++) {
        if (card->token[k].kind == DALCS_TOKEN_EXPRESSION) {
            return false;
        }
    }
    return true;
}

/* [~a and a], as XSPICE writes lists of nodes. */
static const char *port_name(struct dalcs_language *language, const struct dalcs_scope *scope,
                             const char *text) {
    const size_t before = strspn(text, "[~");
    size_t end = strlen(text);
    while (end > before && text[end - 1] == ']') {
        end--;
    }
    const char *name = dalcs_language_text(language, "%.*s", (int)(end - before), text + before);
    const char *flat = end == before || name == NULL || strcmp(name, "null") == 0
                           ? name
                           : node_name(language, scope, name);
    return flat == NULL
               ? NULL
               : dalcs_language_text(language, "%.*s%s%s", (int)before, text, flat, text + end);
}

static void rename_token(struct dalcs_language *language, struct dalcs_scope *scope,
                         enum dalcs_role role, struct dalcs_token *token) {
    const char *name = role == DALCS_ROLE_NODE     ? node_name(language, scope, token->text)
                       : role == DALCS_ROLE_PORT   ? port_name(language, scope, token->text)
                       : role == DALCS_ROLE_DEVICE ? flat_name(language, scope, token->text)
                                                   : model_name(language, scope, token->text);
    token->text = name != NULL ? name : token->text;
}

/* Puts one token in the place of those that a formula has; how many are left. */
static int put_formula(struct dalcs_language *language, struct dalcs_scope *scope,
                       const struct dalcs_card *card, struct dalcs_token *token, int first, int n) {
    struct dalcs_token *place = &token[first];
    const struct dalcs_token *last = &token[first + n - 1];
    int transfer;
    int n_transfer;
    const bool is_transfer = dalcs_transfer_find(card, &transfer, &n_transfer) && transfer == first;
    const bool is_storage = card->letter == 'l' || card->letter == 'c';
    const struct dalcs_draw_place before = dalcs_drawn_enter(
        language, (struct dalcs_draw_place){.scope = scope, .card = card, .at = first});
    place->formula = dalcs_formula_make_of(language, scope, &card->token[first], n,
                                           is_transfer  ? "s"
                                           : is_storage ? "x"
                                                        : NULL);
    dalcs_drawn_leave(language, before, NULL);
    place->kind = place->formula != NULL ? DALCS_TOKEN_FORMULA : DALCS_TOKEN_BAD;
    if (last->line == place->line) {
        place->length = last->offset + last->length - place->offset;
    }
    memmove(place + 1, last + 1, (size_t)(card->n - first - n) * sizeof *token);
    return card->n - n + 1;
}

/* The name of a model beside or before the value of R, L or C: a word that means nothing else there. */
static bool is_passive_model(const struct dalcs_scope *scope, const struct dalcs_card *card,
                             int k) {
    bool found = false;
    if (card->letter != 'r' && card->letter != 'l' && card->letter != 'c') {
        return false;
    }
    for (const struct dalcs_scope *s = scope; s != NULL && !found; s = s->enclosing) {
        found = k >= 3 && card->token[k].kind == DALCS_TOKEN_WORD &&
                card->token[k - 1].kind != DALCS_TOKEN_EQUAL &&
                dalcs_names_find(&s->definition->models, card->token[k].text) >= 0;
    }
    return found;
}

/* Cards that steer the run belong to the whole netlist. */
static bool belongs_outside(const struct dalcs_card *card) {
    static const char *const inside[] = {".model", ".ic",    ".save",   ".print",
                                         ".plot",  ".probe", ".nodeset"};
    for (size_t k = 0; k < sizeof inside / sizeof inside[0]; k++) {
        if (strcmp(card->token->text, inside[k]) == 0) {
            return false;
        }
    }
    return card->letter == '.';
}

static enum dalcs_status copy_card(struct dalcs_language *language, struct dalcs_scope *scope,
                                   struct dalcs_item *item) {
    const struct dalcs_card *card = item->card;
    if (is_flat(scope, card)) {
        return emit(language, card);
    }
    if (scope->caller != NULL && belongs_outside(card)) {
        dalcs_language_report(language, DALCS_ERROR, scope, card->token, NULL,
                              "%s does not belong into a subcircuit", card->token->text);
        return DALCS_OK;
    }
    struct dalcs_token *token = dalcs_arena_alloc(language->arena, (size_t)card->n, sizeof *token);
    unsigned char few[64];
    unsigned char *role =
        card->n <= (int)sizeof few ? few : dalcs_arena_alloc(language->arena, (size_t)card->n, 1);
    if (token == NULL || role == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(token, card->token, (size_t)card->n * sizeof *token);
    dalcs_roles(card, role);
    const bool may_be_bare = has_parameters(scope);
    int formula = card->n;
    int n_formula = 0;
    if (!dalcs_formula_find(card, &formula, &n_formula)) {
        formula = card->n;
    }
    int transfer = card->n;
    int n_transfer = 0;
    if (!dalcs_transfer_find(card, &transfer, &n_transfer)) {
        transfer = card->n;
    }
    for (int k = 0; k < card->n; k++) {
        token[k].line = line_of(language, scope, token[k].line);
        if ((k >= formula && k < formula + n_formula) ||
            (k >= transfer && k < transfer + n_transfer)) {
            continue;
        }
        if (k == 0) {
            if (card->letter != '.') {
                rename_token(language, scope, DALCS_ROLE_DEVICE, token);
            }
        } else if (token[k].kind == DALCS_TOKEN_EXPRESSION && role[k] == DALCS_ROLE_SIGNAL &&
                   dalcs_formula_reads_value(token[k].text)) {
            token[k].kind = DALCS_TOKEN_WORD; /* no signal, as who reads the card says */
        } else if (token[k].kind == DALCS_TOKEN_EXPRESSION && role[k] == DALCS_ROLE_SIGNAL) {
            const struct dalcs_draw_place before = dalcs_drawn_enter(
                language, (struct dalcs_draw_place){.scope = scope, .card = card, .at = k});
            token[k].formula = dalcs_formula_make(language, scope, &card->token[k], 1);
            dalcs_drawn_leave(language, before, NULL);
            token[k].kind = token[k].formula != NULL ? DALCS_TOKEN_FORMULA : DALCS_TOKEN_BAD;
        } else if (token[k].kind == DALCS_TOKEN_EXPRESSION && role[k] != DALCS_ROLE_RAW) {
            evaluate_token(language, scope, item, k, &token[k]);
        } else if (token[k].kind == DALCS_TOKEN_WORD && role[k] != DALCS_ROLE_VALUE) {
            rename_token(language, scope, (enum dalcs_role)role[k], &token[k]);
        } else if (k == 1 && item->kind == DALCS_ITEM_MODEL) {
            rename_token(language, scope, DALCS_ROLE_MODEL, &token[k]);
        } else if (is_passive_model(scope, card, k)) {
            rename_token(language, scope, DALCS_ROLE_MODEL, &token[k]);
        } else if (may_be_bare && is_parameter(scope, card, k)) {
            evaluate_token(language, scope, item, k, &token[k]);
        }
    }
    struct dalcs_card left = *card; /* what is behind a formula moves */
    if (transfer < left.n) {
        left.n = put_formula(language, scope, &left, token, transfer, n_transfer);
    }
    const int n =
        formula < left.n ? put_formula(language, scope, &left, token, formula, n_formula) : left.n;
    const struct dalcs_card copy = {token, n, card->letter, 0};
    return language->out_of_memory ? DALCS_E_NOMEM : emit(language, &copy);
}

static enum dalcs_status copy_derived(struct dalcs_language *language, struct dalcs_scope *scope,
                                      const struct dalcs_item *item) {
    struct dalcs_item whole = {.card = dalcs_model_derive(language, scope, item->card),
                               .kind = item->kind};
    return whole.card != NULL ? copy_card(language, scope, &whole) : DALCS_E_NOMEM;
}

/* ---- Calls ------------------------------------------------------------------------------------- */

/* The parts of an X card. */
struct call {
    struct dalcs_language *language;
    struct dalcs_scope *scope; /* the caller's */
    struct dalcs_item *item;
    int name; /* the token that names the subcircuit; 0: none */
    int n_nodes;
    int parameters; /* where they start */
};

static void fail(const struct call *call, const struct dalcs_token *token, const char *hint,
                 const char *what) {
    dalcs_language_report(call->language, DALCS_ERROR, call->scope, token, hint, "%s", what);
    call->language->deck->hides_elements = true;
}

/* Nodes, then the name, then name=value; false when an error was reported. */
static bool read_call(struct call *call) {
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

static void report_unknown(const struct call *call) {
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

static bool connect(const struct call *call, const struct dalcs_definition *definition,
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
            inner->port[n++] = node_name(language, call->scope, card->token[k].text);
        }
    }
    return !language->out_of_memory;
}

/* The parameter `name` of the scope, or a new one that nothing declares. */
static struct dalcs_value *parameter_of(struct dalcs_scope *inner, const struct dalcs_token *name) {
    const int slot = dalcs_names_find(&inner->definition->parameters, name->text);
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

static bool give_parameters(const struct call *call, struct dalcs_scope *inner) {
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

/* Parameters that the call gives and nothing inside looks at; m= is then the number of such subcircuits in
 * parallel, as in every SPICE. `first`: of its cards. */
static void check_use(const struct call *call, const struct dalcs_scope *inner, size_t first) {
    struct dalcs_language *language = call->language;
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
        dalcs_language_report(
            language, DALCS_WARNING, call->scope, extra->name,
            dalcs_language_suggest(language, &inner->definition->parameters, name, "parameters"),
            "'%s' has no parameter '%s': it is ignored", inner->definition->name->text, name);
    }
}

/* Names the instance; *is_new is false when there is one of the name, an error. */
static enum dalcs_status name_instance(const struct call *call, struct dalcs_scope *inner,
                                       bool *is_new) {
    struct dalcs_language *language = call->language;
    const struct dalcs_token *x = call->item->card->token;
    struct dalcs_origin *origin = dalcs_arena_alloc(language->arena, 1, sizeof *origin);
    inner->name = flat_name(language, call->scope, x->text);
    if (origin == NULL || inner->name == NULL) {
        return DALCS_E_NOMEM;
    }
    *origin = (struct dalcs_origin){inner->name, x->line->source->name, x->line->number,
                                    call->scope->origin};
    inner->origin = origin;
    const int first = dalcs_names_find(&language->deck->instances, inner->name);
    *is_new = first < 0;
    if (first >= 0) {
        const struct dalcs_origin *known = language->scope[first]->origin;
        dalcs_language_report(language, DALCS_ERROR, call->scope, x, "give it another name",
                              "there are two calls '%s', the first at %s:%d", inner->name,
                              known->file, known->line);
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_grow(&language->scope, &language->scope_capacity, language->n_scopes + 1,
                         sizeof(struct dalcs_scope *)));
    DALCS_TRY(dalcs_names_add(&language->deck->instances, inner->name, (int)language->n_scopes));
    language->scope[language->n_scopes++] = inner;
    return DALCS_OK;
}

static enum dalcs_status expand_scope(struct dalcs_language *language, struct dalcs_scope *scope);

static enum dalcs_status expand_call(struct dalcs_language *language, struct dalcs_scope *scope,
                                     struct dalcs_item *item) {
    struct call call = {.language = language, .scope = scope, .item = item};
    struct dalcs_scope *owner = NULL;
    if (!read_call(&call)) {
        return DALCS_OK;
    }
    const struct dalcs_token *name = &item->card->token[call.name];
    struct dalcs_definition *definition = dalcs_scope_find_subcircuit(scope, name->text, &owner);
    if (definition == NULL) {
        report_unknown(&call);
        return DALCS_OK;
    }
    if (definition->is_open || language->depth >= DEEPEST) {
        fail(&call, name, NULL,
             definition->is_open ? "this subcircuit calls itself"
                                 : "subcircuits call each other more than 200 deep");
        return DALCS_OK;
    }
    struct dalcs_scope *inner = dalcs_scope_make(language, definition, scope, owner);
    if (inner == NULL) {
        return DALCS_E_NOMEM;
    }
    bool is_new;
    DALCS_TRY(name_instance(&call, inner, &is_new));
    if (!is_new) {
        return DALCS_OK;
    }
    if (!connect(&call, definition, inner) || !give_parameters(&call, inner)) {
        language->deck->hides_elements = true;
        return language->out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
    }
    const size_t first = language->deck->n_cards;
    definition->is_open = true;
    language->depth++;
    DALCS_TRY(expand_scope(language, inner));
    language->depth--;
    definition->is_open = false;
    check_use(&call, inner, first);
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
            DALCS_TRY(dalcs_card_is_derived_model(item->card) ? copy_derived(language, scope, item)
                                                              : copy_card(language, scope, item));
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
    const struct dalcs_scope *scope = deck->language->scope[k];
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
        free(language->stack);
        free(language->sought);
        free(language->scope);
    }
    dalcs_names_finish(&deck->instances);
    free(deck->own);
    free(deck->drawn);
    free(deck->draw);
    dalcs_arena_finish(&deck->arena);
    *deck = (struct dalcs_deck){0};
}
