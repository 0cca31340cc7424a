/* lexer_cards.c - tokens to cards, and what a card may need before it is flat. */
#include "lexer.h"

#include <limits.h>
#include <stdint.h>
#include <string.h>

/* A card that is not of a flat netlist of numbers. */
static bool is_language(const struct dalcs_token *name) {
    static const char *const words[] = {
        ".param",  ".params", ".csparam", ".global_param", ".func",   ".function",
        ".subckt", ".ends",   ".global",  ".if",           ".elseif", ".else",
        ".endif",  ".step",   ".wcase",   ".wc",           ".params:"};
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
        if (strcmp(name->text, words[k]) == 0) {
            return true;
        }
    }
    return false;
}

/* B sources, E, G, S and R with name=expression, L with Flux=, C with Q=: formulas need no braces. */
static bool may_have_formula(const struct dalcs_card *card) {
    bool may = card->letter == 'b';
    const bool has_forms = card->letter == 'e' || card->letter == 'g' || card->letter == 's' ||
                           (card->letter == 'r' && card->n > 6);
    for (int k = 3; k < card->n && has_forms && !may; k++) {
        may = card->token[k].kind == DALCS_TOKEN_EQUAL;
    }
    const bool is_coil = card->letter == 'l';
    for (int k = 4; k < card->n && (is_coil || card->letter == 'c') && !may; k++) {
        may = card->token[k].kind == DALCS_TOKEN_EQUAL &&
              strcmp(card->token[k - 1].text, is_coil ? "flux" : "q") == 0;
    }
    return may;
}

/* DEV=5%, LOT/1/gauss=2%, on an element or in a model. */
static bool may_have_tolerance(const struct dalcs_card *card) {
    bool may = false;
    for (int k = 3; k < card->n && !may; k++) {
        const char *text = card->token[k].text;
        may = card->token[k].kind == DALCS_TOKEN_WORD &&
              (strncmp(text, "dev", 3) == 0 || strncmp(text, "lot", 3) == 0) &&
              (text[3] == '\0' || text[3] == '/');
    }
    return may;
}

/* The brace or bracket that closes a model, which is the end of its last word or a word of its own. */
static enum dalcs_status close_model(struct dalcs_lexer *lexer) {
    const bool may = lexer->n_tokens > 4 && strcmp(lexer->token[0].text, ".model") == 0 &&
                     lexer->token[3].kind == DALCS_TOKEN_OPEN && lexer->token[3].text[0] != '(';
    struct dalcs_token *last = &lexer->token[lexer->n_tokens - 1];
    if (!may || last->kind != DALCS_TOKEN_WORD) {
        return DALCS_OK;
    }
    const char close = lexer->token[3].text[0] == '{' ? '}' : ']';
    const size_t n = strlen(last->text);
    if (last->text[n - 1] != close) {
        return DALCS_OK;
    }
    struct dalcs_token token = *last;
    token.kind = DALCS_TOKEN_CLOSE;
    token.text = ")";
    token.offset += (int)n - 1;
    token.length = 1;
    if (n == 1) {
        *last = token;
        return DALCS_OK;
    }
    ((char *)(uintptr_t)last->text)[n - 1] = '\0'; /* in `low`, which is the lexer's own */
    last->length--;
    DALCS_TRY(
        dalcs_grow(&lexer->token, &lexer->capacity, lexer->n_tokens + 1, sizeof *lexer->token));
    lexer->token[lexer->n_tokens++] = token;
    return DALCS_OK;
}

/* PARAMS:name=value without a blank, as PSpice takes it, is two words. */
static enum dalcs_status split_params(struct dalcs_lexer *lexer) {
    static const char word[] = "params:";
    const size_t n = sizeof word - 1;
    const bool may = lexer->token[0].text[0] == 'x' || strcmp(lexer->token[0].text, ".subckt") == 0;
    for (size_t k = 2; may && k < lexer->n_tokens; k++) {
        const struct dalcs_token whole = lexer->token[k];
        if (whole.kind != DALCS_TOKEN_WORD || strncmp(whole.text, word, n) != 0 ||
            whole.text[n] == '\0') {
            continue;
        }
        DALCS_TRY(
            dalcs_grow(&lexer->token, &lexer->capacity, lexer->n_tokens + 1, sizeof *lexer->token));
        struct dalcs_token *token = &lexer->token[k];
        memmove(token + 1, token, (lexer->n_tokens - k) * sizeof *token);
        lexer->n_tokens++;
        token[0].text = word;
        token[0].length = (int)n;
        token[1].text += n;
        token[1].offset += (int)n;
        token[1].length -= (int)n;
    }
    return DALCS_OK;
}

bool dalcs_card_is_derived_model(const struct dalcs_card *card) {
    return card->n > 2 && strcmp(card->token->text, ".model") == 0 &&
           card->token[2].kind == DALCS_TOKEN_WORD && strncmp(card->token[2].text, "ako:", 4) == 0;
}

/* The first letter; LTspice's F a b value={formula} and H a b value={formula} are G and E. */
static char letter_of(const struct dalcs_token *token, int n) {
    const char letter = token->text[0];
    const bool has_formula =
        n > 4 && (letter == 'f' || letter == 'h') && strcmp(token[3].text, "value") == 0 &&
        (token[4].kind == DALCS_TOKEN_EQUAL || token[4].kind == DALCS_TOKEN_EXPRESSION);
    return has_formula && letter == 'f' ? 'g' : has_formula ? 'e' : letter;
}

enum dalcs_status dalcs_lexer_flush(struct dalcs_lexer *lexer) {
    struct dalcs_netlist *netlist = lexer->netlist;
    if (lexer->n_tokens == 0) {
        return DALCS_OK;
    }
    DALCS_TRY(close_model(lexer));
    DALCS_TRY(split_params(lexer));
    if (lexer->n_tokens > INT_MAX / 2) {
        return DALCS_E_LIMIT;
    }
    struct dalcs_token *token = dalcs_arena_alloc(&netlist->arena, lexer->n_tokens, sizeof *token);
    if (token == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(token, lexer->token, lexer->n_tokens * sizeof *token);
    const struct dalcs_card card = {token, (int)lexer->n_tokens,
                                    letter_of(token, (int)lexer->n_tokens), 0};
    lexer->n_tokens = 0;
    if (card.letter == '.' && dalcs_include_is_card(token->text)) {
        return dalcs_include_card(lexer, &card);
    }
    netlist->has_tolerances = netlist->has_tolerances || may_have_tolerance(&card);
    netlist->has_language = netlist->has_language || netlist->has_tolerances ||
                            card.letter == 'x' || (card.letter == '.' && is_language(token)) ||
                            may_have_formula(&card) || dalcs_card_is_derived_model(&card);
    DALCS_TRY(dalcs_grow(&netlist->card, &netlist->capacity, netlist->n_cards + 1,
                         sizeof *netlist->card));
    netlist->card[netlist->n_cards++] = card;
    return DALCS_OK;
}
