/* card_copy.c - one card of a definition as an instance has it: flat names, values in the place of parameters. */
#include "card_copy.h"

#include "language.h"

#include <string.h>

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
        if (scope->definition->parameters.n_slots > 0 || scope->n_extra > 0) {
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
    /* five are those of LTspice's state machine, which is refused as one block wherever it stands */
    static const char *const inside[] = {".model",  ".ic",         ".save",    ".print", ".plot",
                                         ".probe",  ".nodeset",    ".machine", ".state", ".rule",
                                         ".output", ".endmachine", ".backanno"};
    for (size_t k = 0; k < sizeof inside / sizeof inside[0]; k++) {
        if (strcmp(card->token->text, inside[k]) == 0) {
            return false;
        }
    }
    return card->letter == '.';
}

/* Token k of an item's card as it is in the flat netlist: `role` is what the card has it for. */
static void copy_token(struct dalcs_language *language, struct dalcs_scope *scope,
                       struct dalcs_item *item, int k, struct dalcs_token *token,
                       enum dalcs_role role) {
    const struct dalcs_card *card = item->card;
    const bool is_expression = token->kind == DALCS_TOKEN_EXPRESSION;
    if (k == 0) {
        if (card->letter != '.') {
            rename_token(language, scope, DALCS_ROLE_DEVICE, token);
        }
    } else if (is_expression && role == DALCS_ROLE_SIGNAL &&
               dalcs_formula_reads_value(token->text)) {
        token->kind = DALCS_TOKEN_WORD; /* no signal, as who reads the card says */
    } else if (is_expression && role == DALCS_ROLE_SIGNAL) {
        const struct dalcs_draw_place before = dalcs_drawn_enter(
            language, (struct dalcs_draw_place){.scope = scope, .card = card, .at = k});
        token->formula = dalcs_formula_make(language, scope, &card->token[k], 1);
        dalcs_drawn_leave(language, before, NULL);
        token->kind = token->formula != NULL ? DALCS_TOKEN_FORMULA : DALCS_TOKEN_BAD;
    } else if (is_expression && role != DALCS_ROLE_RAW) {
        evaluate_token(language, scope, item, k, token);
    } else if (token->kind == DALCS_TOKEN_WORD && role != DALCS_ROLE_VALUE) {
        rename_token(language, scope, role, token);
    } else if ((k == 1 && item->kind == DALCS_ITEM_MODEL) || is_passive_model(scope, card, k)) {
        rename_token(language, scope, DALCS_ROLE_MODEL, token);
    } else if (has_parameters(scope) && is_parameter(scope, card, k)) {
        evaluate_token(language, scope, item, k, token);
    }
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
        copy_token(language, scope, item, k, &token[k], (enum dalcs_role)role[k]);
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

enum dalcs_status dalcs_card_copy(struct dalcs_language *language, struct dalcs_scope *scope,
                                  struct dalcs_item *item) {
    if (!dalcs_card_is_derived_model(item->card)) {
        return copy_card(language, scope, item);
    }
    struct dalcs_item whole = {.card = dalcs_model_derive(language, scope, item->card),
                               .kind = item->kind};
    return whole.card != NULL ? copy_card(language, scope, &whole) : DALCS_E_NOMEM;
}
