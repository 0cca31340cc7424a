/* temperature.c - temp and temper in formulas: the degrees Celsius that .temp, .options or a .step sets.
 *
 * An override of temp, of a .step, comes after this. Without one of these both are the constant 27. A parameter of the netlist's own with such a name is
 * that parameter. */
#include "language.h"

#include <string.h>

static bool is_word(const struct dalcs_token *token, const char *word) {
    return token->kind == DALCS_TOKEN_WORD && strcmp(token->text, word) == 0;
}

/* The k-th token, or the one behind it where it is an equal sign; NULL: there is none. */
static const struct dalcs_token *value_at(const struct dalcs_card *card, int k) {
    k += k < card->n && card->token[k].kind == DALCS_TOKEN_EQUAL ? 1 : 0;
    return k < card->n ? &card->token[k] : NULL;
}

/* The value that a card sets, or NULL. */
static const struct dalcs_token *set_by(const struct dalcs_card *card) {
    if (is_word(card->token, ".temp")) {
        return value_at(card, 1);
    }
    if (!is_word(card->token, ".options") && !is_word(card->token, ".option") &&
        !is_word(card->token, ".opt")) {
        return NULL;
    }
    for (int k = 1; k + 1 < card->n; k++) {
        if (is_word(&card->token[k], "temp")) {
            return value_at(card, k + 1);
        }
    }
    return NULL;
}

const struct dalcs_token *dalcs_temperature_find(const struct dalcs_language *language) {
    const struct dalcs_definition *root = &language->root;
    const struct dalcs_token *token = NULL;
    for (size_t k = 0; k < root->n_items; k++) {
        const struct dalcs_token *set = set_by(root->item[k].card);
        token = set != NULL ? set : token;
    }
    return token;
}

enum dalcs_status dalcs_temperature_declare(struct dalcs_language *language,
                                            const struct dalcs_token *token) {
    static const char *const names[DALCS_TEMPERATURE_NAMES] = {"temp", "temper"};
    struct dalcs_scope *top = language->top;
    const struct dalcs_token *first = token;
    for (int k = 0; k < DALCS_TEMPERATURE_NAMES; k++) {
        if (dalcs_names_find(&language->root.parameters.names, names[k]) >= 0) {
            continue;
        }
        struct dalcs_token *name = dalcs_arena_alloc(language->arena, 1, sizeof *name);
        struct dalcs_expression **expression =
            dalcs_arena_alloc(language->arena, 1, sizeof(struct dalcs_expression *));
        if (name == NULL || expression == NULL) {
            return DALCS_E_NOMEM;
        }
        first = k == 0 ? name : first;
        *name = *token;
        name->kind = DALCS_TOKEN_WORD;
        name->text = names[k];
        /* temper is temp, which a .step may set. */
        top->extra[top->n_extra++] = (struct dalcs_value){.name = name,
                                                          .token = k == 0 ? token : first,
                                                          .n_tokens = 1,
                                                          .expression = expression,
                                                          .where = top};
    }
    return DALCS_OK;
}

bool dalcs_deck_temperature(const struct dalcs_deck *deck, double *value) {
    return deck->language != NULL &&
           dalcs_names_find(&deck->language->root.parameters.names, "temp") < 0 &&
           dalcs_deck_parameter(deck, "temp", value);
}
