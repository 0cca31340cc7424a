/* assignment.c - `name = expression name = expression ...` on .param, .subckt and X cards.
 *
 * The expression needs no braces: it ends where the next `name =` starts. */
#include "language.h"

#include <string.h>

static bool is_name(const char *text) {
    const bool starts =
        (*text >= 'a' && *text <= 'z') || *text == '_' || (unsigned char)*text >= 0x80;
    for (const char *p = text; *p != '\0'; p++) {
        const bool letter = (*p >= 'a' && *p <= 'z') || (*p >= '0' && *p <= '9');
        if (!letter && strchr("_.$#@", *p) == NULL && (unsigned char)*p < 0x80) {
            return false;
        }
    }
    return starts;
}

static bool is_kind(const struct dalcs_card *card, int k, enum dalcs_token_kind kind) {
    return k >= 0 && k < card->n && card->token[k].kind == kind;
}

/* Some libraries have the name in braces: PARAMS: {RATIO}=1. */
bool dalcs_assignment_starts(const struct dalcs_card *card, int k) {
    return (is_kind(card, k, DALCS_TOKEN_WORD) || is_kind(card, k, DALCS_TOKEN_EXPRESSION)) &&
           is_name(card->token[k].text) && is_kind(card, k + 1, DALCS_TOKEN_EQUAL) &&
           !is_kind(card, k + 2, DALCS_TOKEN_EQUAL);
}

bool dalcs_assignment_is_params(const struct dalcs_token *token) {
    return token->kind == DALCS_TOKEN_WORD &&
           (strcmp(token->text, "params:") == 0 || strcmp(token->text, "param:") == 0);
}

const struct dalcs_token *dalcs_assignment_next(struct dalcs_language *language,
                                                const struct dalcs_scope *scope,
                                                const struct dalcs_card *card, int *at,
                                                int *value) {
    static const char usage[] = "name=value name={expression} ...";
    while (*at < card->n && dalcs_assignment_is_params(&card->token[*at])) {
        ++*at;
    }
    const struct dalcs_token *name = &card->token[*at];
    if (*at >= card->n) {
        return NULL;
    }
    if (!dalcs_assignment_starts(card, *at)) {
        if (name->kind != DALCS_TOKEN_BAD) {
            dalcs_language_report(language, DALCS_ERROR, scope, name, usage,
                                  is_kind(card, *at + 1, DALCS_TOKEN_EQUAL) && !is_name(name->text)
                                      ? "'%s' cannot be the name of a parameter"
                                      : "expected name=value, not '%s'",
                                  name->text);
        }
        return NULL;
    }
    *value = *at + 2;
    int k = *value;
    while (k < card->n && !dalcs_assignment_starts(card, k) &&
           !dalcs_assignment_is_params(&card->token[k])) {
        if (card->token[k].kind == DALCS_TOKEN_BAD) {
            return NULL; /* reported when it was read */
        }
        k++;
    }
    if (k == *value) {
        const struct dalcs_location where = dalcs_token_end(&card->token[k - 1]);
        dalcs_language_report_at(language, DALCS_ERROR, scope, where, usage,
                                 "the value of '%s' is missing", name->text);
        return NULL;
    }
    *at = k;
    return name;
}
