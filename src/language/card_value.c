/* card_value.c - where the value of an element or a model stands on its card, and copies of cards with another one. */
#include "card_value.h"

#include <string.h>

bool dalcs_token_is_number(const struct dalcs_token *token) {
    const char *text = token->text;
    if (token->kind != DALCS_TOKEN_WORD) {
        return token->kind == DALCS_TOKEN_NUMBER;
    }
    text += *text == '+' || *text == '-';
    text += *text == '.';
    return *text >= '0' && *text <= '9';
}

int dalcs_card_find_assigned(const struct dalcs_card *card, int from, const char *name) {
    const bool is_model = card->letter == '.';
    for (int k = from; k + 1 < card->n; k++) {
        const bool is_name = dalcs_token_is_word(&card->token[k], name);
        if (is_name && k + 2 < card->n && card->token[k + 1].kind == DALCS_TOKEN_EQUAL) {
            return k + 2;
        }
        if (is_name && is_model && dalcs_token_is_number(&card->token[k + 1])) {
            return k + 1;
        }
    }
    return 0;
}

/* Tokens before the value of an element: its name, nodes and controls, with any parentheses. */
static int first_after_names(const struct dalcs_card *card) {
    int n_names = strchr("eg", card->letter) != NULL   ? 4
                  : strchr("fh", card->letter) != NULL ? 3
                                                       : 2;
    int k = 1;
    for (; k < card->n && n_names > 0; k++) {
        n_names -= card->token[k].kind == DALCS_TOKEN_WORD;
    }
    while (k < card->n && card->token[k].kind == DALCS_TOKEN_CLOSE) {
        k++;
    }
    return k;
}

int dalcs_card_find_value(const struct dalcs_card *card, bool *is_there) {
    const char own[] = {card->letter, '\0'};
    const int first = first_after_names(card);
    const int assigned = dalcs_card_find_assigned(card, first, own);
    *is_there = true;
    if (assigned > 0) {
        return assigned;
    }
    for (int k = first; k + 1 < card->n; k++) {
        if (dalcs_token_is_word(&card->token[k], "dc")) {
            return card->token[k + 1].kind == DALCS_TOKEN_EQUAL ? k + 2 : k + 1;
        }
    }
    *is_there = first < card->n && dalcs_token_is_number(&card->token[first]);
    return first;
}

enum dalcs_status dalcs_card_edit(struct dalcs_language *language, struct dalcs_card *card, int at,
                                  bool replaces, const char *name, double value) {
    struct dalcs_token *token =
        dalcs_arena_alloc(language->arena, (size_t)card->n + 3, sizeof *token);
    const char *text = dalcs_language_text(language, "%.12g", value);
    if (token == NULL || text == NULL) {
        return DALCS_E_NOMEM;
    }
    int n = 0;
    for (; n < at; n++) {
        token[n] = card->token[n];
    }
    struct dalcs_token number = card->token[at < card->n && replaces ? at : 0];
    if (name != NULL) {
        token[n] = number;
        token[n].kind = DALCS_TOKEN_WORD;
        token[n++].text = name;
        token[n] = number;
        token[n].kind = DALCS_TOKEN_EQUAL;
        token[n++].text = "=";
    }
    number.kind = DALCS_TOKEN_NUMBER;
    number.text = text;
    number.value = value;
    number.after_comma = false;
    token[n++] = number;
    for (int k = replaces ? at + 1 : at; k < card->n; k++) {
        token[n++] = card->token[k];
    }
    *card = (struct dalcs_card){token, n, card->letter, card->parallel};
    return DALCS_OK;
}

enum dalcs_status dalcs_card_set(struct dalcs_language *language, struct dalcs_card *card, int at,
                                 double value) {
    return dalcs_card_edit(language, card, at, true, NULL, value);
}

static bool is_waveform(const struct dalcs_token *token) {
    static const char *const name[] = {"pulse", "sin", "exp", "pwl", "sffm", "am"};
    bool is = false;
    for (size_t k = 0; k < sizeof name / sizeof name[0]; k++) {
        is = is || dalcs_token_is_word(token, name[k]);
    }
    return is;
}

/* Behind a function and its values, in parentheses or not. */
static int end_of_waveform(const struct dalcs_card *card, int at) {
    int k = at + 1;
    int depth = 0;
    while (k < card->n && (depth > 0 || card->token[k].kind != DALCS_TOKEN_WORD ||
                           dalcs_token_is_number(&card->token[k]))) {
        depth +=
            (card->token[k].kind == DALCS_TOKEN_OPEN) - (card->token[k].kind == DALCS_TOKEN_CLOSE);
        k++;
    }
    return k;
}

enum dalcs_status dalcs_card_edit_waveform(struct dalcs_language *language, struct dalcs_card *card,
                                           const struct dalcs_override *override) {
    const size_t room = (size_t)card->n + override->n_list + 3;
    struct dalcs_token *token = dalcs_arena_alloc(language->arena, room, sizeof *token);
    if (token == NULL) {
        return DALCS_E_NOMEM;
    }
    struct dalcs_token made = card->token[0];
    made.after_comma = false;
    made.kind = DALCS_TOKEN_WORD;
    made.text = override->field;
    int n = 0;
    for (int k = 0; k < card->n; k++) {
        if (k > 2 && is_waveform(&made) && is_waveform(&card->token[k])) {
            k = end_of_waveform(card, k) - 1;
        } else {
            token[n++] = card->token[k];
        }
    }
    token[n++] = made;
    made.kind = DALCS_TOKEN_OPEN;
    made.text = "(";
    token[n++] = made;
    for (size_t k = 0; k < override->n_list; k++) {
        struct dalcs_token number = made;
        number.kind = DALCS_TOKEN_NUMBER;
        number.value = override->list[k];
        number.text = dalcs_language_text(language, "%.12g", override->list[k]);
        if (number.text == NULL) {
            return DALCS_E_NOMEM;
        }
        token[n++] = number;
    }
    made.kind = DALCS_TOKEN_CLOSE;
    made.text = ")";
    token[n++] = made;
    *card = (struct dalcs_card){token, n, card->letter, card->parallel};
    return DALCS_OK;
}
