/* override.c - puts other values into flat cards.
 *
 * The reader of a card's family finds a card like any other afterwards, so a resistance of 0 is a short here too. */
#include "card_value.h"

#include "number.h"

static enum dalcs_status edit_model(struct dalcs_language *language, struct dalcs_card *card,
                                    const struct dalcs_override *override) {
    const int at = dalcs_card_find_assigned(card, 3, override->field);
    if (at > 0) {
        return dalcs_card_edit(language, card, at, true, NULL, override->value);
    }
    const int end = card->token[card->n - 1].kind == DALCS_TOKEN_CLOSE ? card->n - 1 : card->n;
    return dalcs_card_edit(language, card, end, false, override->field, override->value);
}

/* The card that an override is for among card[0..n-1]; n: there is none. */
static size_t find_card(const struct dalcs_card *card, size_t n,
                        const struct dalcs_override *override) {
    const bool is_model = override->kind == DALCS_OVERRIDE_MODEL;
    const int name = is_model ? 1 : 0;
    size_t k = 0;
    while (k < n &&
           (is_model != dalcs_token_is_word(card[k].token, ".model") || name >= card[k].n ||
            !dalcs_token_is_word(&card[k].token[name], override->name))) {
        k++;
    }
    return k;
}

static enum dalcs_status apply(struct dalcs_language *language,
                               const struct dalcs_override *override) {
    struct dalcs_deck *deck = language->deck;
    const size_t k = find_card(deck->own, deck->n_cards, override);
    struct dalcs_card *card = &deck->own[k];
    if (k == deck->n_cards) {
        return DALCS_OK;
    }
    if (override->kind == DALCS_OVERRIDE_MODEL) {
        return edit_model(language, card, override);
    }
    if (override->kind == DALCS_OVERRIDE_WAVEFORM) {
        return dalcs_card_edit_waveform(language, card, override);
    }
    bool is_there;
    const int at = dalcs_card_find_value(card, &is_there);
    return dalcs_card_edit(language, card, at, is_there, NULL, override->value);
}

bool dalcs_deck_value(const struct dalcs_deck *deck, const struct dalcs_override *override,
                      enum dalcs_dialect_name dialect, double *value) {
    if (override->kind == DALCS_OVERRIDE_PARAMETER) {
        return dalcs_deck_parameter(deck, override->name, value);
    }
    const size_t k = find_card(deck->card, deck->n_cards, override);
    const struct dalcs_card *card = &deck->card[k];
    if (k == deck->n_cards) {
        return false;
    }
    bool is_there = true;
    const int at = override->kind == DALCS_OVERRIDE_MODEL
                       ? dalcs_card_find_assigned(card, 3, override->field)
                       : dalcs_card_find_value(card, &is_there);
    const struct dalcs_token *token = at > 0 && at < card->n && is_there ? &card->token[at] : NULL;
    struct dalcs_number number = {0};
    if (token != NULL && token->kind == DALCS_TOKEN_NUMBER) {
        *value = token->value;
        return true;
    }
    const bool is_value = token != NULL && token->kind == DALCS_TOKEN_WORD &&
                          dalcs_number_parse_as(token->text, dialect, &number) == DALCS_NUMBER_OK;
    *value = number.value;
    return is_value;
}

enum dalcs_status dalcs_override_cards(struct dalcs_language *language) {
    const struct dalcs_deck *deck = language->deck;
    for (size_t k = 0; k < deck->n_overrides; k++) {
        const enum dalcs_override_kind kind = deck->override[k].kind;
        if (kind != DALCS_OVERRIDE_PARAMETER && kind != DALCS_OVERRIDE_RUN &&
            kind != DALCS_OVERRIDE_CORNER) {
            DALCS_TRY(apply(language, &deck->override[k]));
        }
    }
    return language->out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}
