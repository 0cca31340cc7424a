/* override.c - puts other values into flat cards.
 *
 * A card that an override names is copied with a NUMBER in the place of its value. The reader of its
 * family then finds a card like any other, so a resistance of 0 is a short here too. */
#include "language.h"
#include "number.h"

#include <stdlib.h>
#include <string.h>

static bool is_word(const struct dalcs_token *token, const char *word) {
    return token->kind == DALCS_TOKEN_WORD && strcmp(token->text, word) == 0;
}

static bool is_number(const struct dalcs_token *token) {
    const char *text = token->text;
    if (token->kind != DALCS_TOKEN_WORD) {
        return token->kind == DALCS_TOKEN_NUMBER;
    }
    text += *text == '+' || *text == '-';
    text += *text == '.';
    return *text >= '0' && *text <= '9';
}

/* Where `name =` stands on a card from token `from` on, or on a model `name` and a number: the token of its
 * value; 0: nowhere. */
static int find_assigned(const struct dalcs_card *card, int from, const char *name) {
    const bool is_model = card->letter == '.';
    for (int k = from; k + 1 < card->n; k++) {
        const bool is_name = is_word(&card->token[k], name);
        if (is_name && k + 2 < card->n && card->token[k + 1].kind == DALCS_TOKEN_EQUAL) {
            return k + 2;
        }
        if (is_name && is_model && is_number(&card->token[k + 1])) {
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

/* Where the value of an element stands; *is_there: false when it has to be put in. */
static int place_of_value(const struct dalcs_card *card, bool *is_there) {
    const char own[] = {card->letter, '\0'};
    const int first = first_after_names(card);
    const int assigned = find_assigned(card, first, own);
    *is_there = true;
    if (assigned > 0) {
        return assigned;
    }
    for (int k = first; k + 1 < card->n; k++) {
        if (is_word(&card->token[k], "dc")) {
            return card->token[k + 1].kind == DALCS_TOKEN_EQUAL ? k + 2 : k + 1;
        }
    }
    *is_there = first < card->n && is_number(&card->token[first]);
    return first;
}

/* A copy of the card with `value` at token `at`, before it `name =` where a name is given; the tokens
 * from `at` on come after that, without the first when it is replaced. */
static enum dalcs_status edit(struct dalcs_language *language, struct dalcs_card *card, int at,
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

int dalcs_card_find_value(const struct dalcs_card *card, bool *is_there) {
    return place_of_value(card, is_there);
}

enum dalcs_status dalcs_card_set(struct dalcs_language *language, struct dalcs_card *card, int at,
                                 double value) {
    return edit(language, card, at, true, NULL, value);
}

static bool is_waveform(const struct dalcs_token *token) {
    static const char *const name[] = {"pulse", "sin", "exp", "pwl", "sffm", "am"};
    bool is = false;
    for (size_t k = 0; k < sizeof name / sizeof name[0]; k++) {
        is = is || is_word(token, name[k]);
    }
    return is;
}

/* Behind a function and its values, in parentheses or not. */
static int end_of_waveform(const struct dalcs_card *card, int at) {
    int k = at + 1;
    int depth = 0;
    while (k < card->n &&
           (depth > 0 || card->token[k].kind != DALCS_TOKEN_WORD || is_number(&card->token[k]))) {
        depth +=
            (card->token[k].kind == DALCS_TOKEN_OPEN) - (card->token[k].kind == DALCS_TOKEN_CLOSE);
        k++;
    }
    return k;
}

/* A copy of the card with this function behind all the rest, and no other. */
static enum dalcs_status edit_waveform(struct dalcs_language *language, struct dalcs_card *card,
                                       const struct dalcs_override *override) {
    const size_t room = (size_t)card->n + override->n_list + 3;
    struct dalcs_token *token = dalcs_arena_alloc(language->arena, room, sizeof *token);
    if (token == NULL) {
        return DALCS_E_NOMEM;
    }
    int n = 0;
    for (int k = 0; k < card->n; k++) {
        if (k > 2 && is_waveform(&card->token[k])) {
            k = end_of_waveform(card, k) - 1;
        } else {
            token[n++] = card->token[k];
        }
    }
    struct dalcs_token made = card->token[0];
    made.after_comma = false;
    made.kind = DALCS_TOKEN_WORD;
    made.text = override->field;
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

static enum dalcs_status edit_model(struct dalcs_language *language, struct dalcs_card *card,
                                    const struct dalcs_override *override) {
    const int at = find_assigned(card, 3, override->field);
    if (at > 0) {
        return edit(language, card, at, true, NULL, override->value);
    }
    const int end = card->token[card->n - 1].kind == DALCS_TOKEN_CLOSE ? card->n - 1 : card->n;
    return edit(language, card, end, false, override->field, override->value);
}

static enum dalcs_status apply(struct dalcs_language *language,
                               const struct dalcs_override *override) {
    const bool is_model = override->kind == DALCS_OVERRIDE_MODEL;
    struct dalcs_deck *deck = language->deck;
    for (size_t k = 0; k < deck->n_cards; k++) {
        struct dalcs_card *card = &deck->own[k];
        const int name = is_model ? 1 : 0;
        if (is_model != is_word(card->token, ".model") || name >= card->n ||
            !is_word(&card->token[name], override->name)) {
            continue;
        }
        if (is_model) {
            return edit_model(language, card, override);
        }
        if (override->kind == DALCS_OVERRIDE_WAVEFORM) {
            return edit_waveform(language, card, override);
        }
        bool is_there;
        const int at = place_of_value(card, &is_there);
        return edit(language, card, at, is_there, NULL, override->value);
    }
    return DALCS_OK;
}

bool dalcs_deck_value(const struct dalcs_deck *deck, const struct dalcs_override *override,
                      enum dalcs_dialect_name dialect, double *value) {
    const bool is_model = override->kind == DALCS_OVERRIDE_MODEL;
    if (override->kind == DALCS_OVERRIDE_PARAMETER) {
        return dalcs_deck_parameter(deck, override->name, value);
    }
    for (size_t k = 0; k < deck->n_cards; k++) {
        const struct dalcs_card *card = &deck->card[k];
        const int name = is_model ? 1 : 0;
        if (is_model != is_word(card->token, ".model") || name >= card->n ||
            !is_word(&card->token[name], override->name)) {
            continue;
        }
        bool is_there = true;
        const int at =
            is_model ? find_assigned(card, 3, override->field) : place_of_value(card, &is_there);
        const struct dalcs_token *token =
            at > 0 && at < card->n && is_there ? &card->token[at] : NULL;
        struct dalcs_number number = {0};
        if (token != NULL && token->kind == DALCS_TOKEN_NUMBER) {
            *value = token->value;
            return true;
        }
        const bool is_value =
            token != NULL && token->kind == DALCS_TOKEN_WORD &&
            dalcs_number_parse_as(token->text, dialect, &number) == DALCS_NUMBER_OK;
        *value = number.value;
        return is_value;
    }
    return false;
}

/* ---- Parameters ------------------------------------------------------------------------------ */

/* A parameter of the netlist: one that .param declares, else one more. */
static struct dalcs_value *declare(struct dalcs_language *language, const char *name) {
    struct dalcs_scope *top = language->top;
    const int slot = dalcs_names_find(&top->definition->parameters, name);
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
    while (k < card->n && (is_word(&card->token[k], "lin") || is_word(&card->token[k], "dec") ||
                           is_word(&card->token[k], "oct"))) {
        k++;
    }
    if (!is_word(card->token, ".step") || k + 1 >= card->n || !is_word(&card->token[k], "param") ||
        card->token[k + 1].kind != DALCS_TOKEN_WORD) {
        return NULL;
    }
    *first = k + 2;
    if (*first < card->n && is_word(&card->token[*first], "file")) {
        return NULL; /* which is read later */
    }
    while (*first < card->n &&
           (card->token[*first].kind == DALCS_TOKEN_EQUAL ||
            (card->token[*first].kind == DALCS_TOKEN_WORD && !is_number(&card->token[*first])))) {
        ++*first;
    }
    return *first < card->n ? &card->token[k + 1] : NULL;
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
        room += is_word(root->item[k].card->token, ".step");
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
    /* LTspice declares a parameter by stepping it: until then it has the first value. */
    for (size_t k = 0; k < root->n_items; k++) {
        int first;
        const struct dalcs_card *card = root->item[k].card;
        const struct dalcs_token *name = stepped(card, &first);
        if (name == NULL || dalcs_names_find(&root->parameters, name->text) >= 0) {
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
    for (size_t k = 0; k < deck->n_overrides; k++) {
        const struct dalcs_override *override = &deck->override[k];
        if (override->kind != DALCS_OVERRIDE_PARAMETER) {
            continue;
        }
        DALCS_TRY(declare_known(language, override->name, override->value));
        if (strcmp(override->name, "temp") == 0 &&
            dalcs_names_find(&root->parameters, "temper") < 0) {
            DALCS_TRY(declare_known(language, "temper", override->value));
        }
    }
    return DALCS_OK;
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

/* ---- Which parameters there are ---------------------------------------------------------------- */

bool dalcs_deck_has_parameter(const struct dalcs_deck *deck, const char *name) {
    return deck->language != NULL && dalcs_scope_find_value(deck->language->top, name) != NULL;
}

bool dalcs_deck_uses_parameter(const struct dalcs_deck *deck, const char *name) {
    const struct dalcs_value *value =
        deck->language != NULL ? dalcs_scope_find_value(deck->language->top, name) : NULL;
    return value != NULL && value->is_used;
}

const char *dalcs_deck_nearest_parameter(const struct dalcs_deck *deck, const char *name) {
    return deck->language == NULL ? NULL
                                  : dalcs_names_nearest(&deck->language->root.parameters, name);
}
