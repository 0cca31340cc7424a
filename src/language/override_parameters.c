/* override_parameters.c - parameters that the command line or .step sets, and which parameters there are. */
#include "card_value.h"

#include <string.h>

/* A parameter of the netlist: one that .param declares, else one more. */
static struct dalcs_value *declare(struct dalcs_language *language, const char *name) {
    struct dalcs_scope *top = language->top;
    const int slot = dalcs_names_find(&top->definition->parameters.names, name);
    if (slot >= 0) {
        return &top->value[slot];
    }
    for (int k = 0; k < top->n_extra; k++) {
        if (strcmp(top->extra[k].name->text, name) == 0) {
            return &top->extra[k];
        }
    }
    return &top->extra[top->n_extra++];
}

/* The parameter that a .step card names, and the token of its first value; NULL: it names another
 * thing. */
static const struct dalcs_token *stepped(const struct dalcs_card *card, int *first) {
    int k = 1;
    while (k < card->n && (dalcs_token_is_word(&card->token[k], "lin") ||
                           dalcs_token_is_word(&card->token[k], "dec") ||
                           dalcs_token_is_word(&card->token[k], "oct"))) {
        k++;
    }
    if (!dalcs_token_is_word(card->token, ".step") || k + 1 >= card->n ||
        !dalcs_token_is_word(&card->token[k], "param") ||
        card->token[k + 1].kind != DALCS_TOKEN_WORD) {
        return NULL;
    }
    *first = k + 2;
    if (*first < card->n && dalcs_token_is_word(&card->token[*first], "file")) {
        return NULL; /* which is read later */
    }
    while (*first < card->n && (card->token[*first].kind == DALCS_TOKEN_EQUAL ||
                                (card->token[*first].kind == DALCS_TOKEN_WORD &&
                                 !dalcs_token_is_number(&card->token[*first])))) {
        ++*first;
    }
    return *first < card->n ? &card->token[k + 1] : NULL;
}

/* LTspice declares a parameter by stepping it: until then it has the first value. */
static enum dalcs_status declare_stepped(struct dalcs_language *language) {
    const struct dalcs_definition *root = &language->root;
    for (size_t k = 0; k < root->n_items; k++) {
        int first;
        const struct dalcs_card *card = root->item[k].card;
        const struct dalcs_token *name = stepped(card, &first);
        if (name == NULL || dalcs_names_find(&root->parameters.names, name->text) >= 0) {
            continue;
        }
        struct dalcs_value *value = declare(language, name->text);
        struct dalcs_expression **expression =
            dalcs_arena_alloc(language->arena, 1, sizeof(struct dalcs_expression *));
        if (expression == NULL) {
            return DALCS_E_NOMEM;
        }
        *value = (struct dalcs_value){.name = name,
                                      .token = &card->token[first],
                                      .n_tokens = 1,
                                      .expression = expression,
                                      .where = language->top};
    }
    return DALCS_OK;
}

static enum dalcs_status declare_known(struct dalcs_language *language, const char *text,
                                       double value) {
    struct dalcs_token *name = dalcs_arena_alloc(language->arena, 1, sizeof *name);
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    *name = (struct dalcs_token){.kind = DALCS_TOKEN_WORD, .text = text};
    *declare(language, text) = (struct dalcs_value){.name = name,
                                                    .token = name,
                                                    .where = language->top,
                                                    .state = DALCS_VALUE_KNOWN,
                                                    .value = value,
                                                    .is_given = true};
    return DALCS_OK;
}

enum dalcs_status dalcs_override_parameters(struct dalcs_language *language) {
    struct dalcs_deck *deck = language->deck;
    const struct dalcs_definition *root = &language->root;
    size_t room = deck->n_overrides;
    for (size_t k = 0; k < root->n_items; k++) {
        room += dalcs_token_is_word(root->item[k].card->token, ".step");
    }
    const struct dalcs_token *temperature = dalcs_temperature_find(language);
    if (room == 0 && temperature == NULL) {
        return DALCS_OK;
    }
    language->top->extra = dalcs_arena_alloc(language->arena, room + DALCS_TEMPERATURE_NAMES,
                                             sizeof(struct dalcs_value));
    if (language->top->extra == NULL) {
        return DALCS_E_NOMEM;
    }
    if (temperature != NULL) {
        DALCS_TRY(dalcs_temperature_declare(language, temperature));
    }
    DALCS_TRY(declare_stepped(language));
    for (size_t k = 0; k < deck->n_overrides; k++) {
        const struct dalcs_override *override = &deck->override[k];
        if (override->kind != DALCS_OVERRIDE_PARAMETER) {
            continue;
        }
        DALCS_TRY(declare_known(language, override->name, override->value));
        if (strcmp(override->name, "temp") == 0 &&
            dalcs_names_find(&root->parameters.names, "temper") < 0) {
            DALCS_TRY(declare_known(language, "temper", override->value));
        }
    }
    return DALCS_OK;
}

bool dalcs_deck_has_parameter(const struct dalcs_deck *deck, const char *name) {
    return deck->language != NULL && dalcs_scope_find_value(deck->language->top, name) != NULL;
}

bool dalcs_deck_uses_parameter(const struct dalcs_deck *deck, const char *name) {
    const struct dalcs_value *value =
        deck->language != NULL ? dalcs_scope_find_value(deck->language->top, name) : NULL;
    return value != NULL && value->is_used;
}

const char *dalcs_deck_nearest_parameter(const struct dalcs_deck *deck, const char *name) {
    return deck->language == NULL
               ? NULL
               : dalcs_names_nearest(&deck->language->root.parameters.names, name);
}
