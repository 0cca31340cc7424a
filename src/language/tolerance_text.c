/* tolerance_text.c - DEV and LOT are read and taken off their cards, whose readers do not know them.
 *
 *     R1 a b 1k DEV=5% LOT=2%
 *     .model RB RES (R=1 DEV/gauss=1% LOT/1=5%)
 *
 * Cadence, PSpice Reference Guide: DEV is of each device, LOT of all devices of a model together; without a per cent
 * sign the size is in the unit of the value. */
#include "number.h"
#include "tolerance.h"

#include <string.h>

static const char USAGE[] = "a tolerance is: DEV=5%, LOT=2%, DEV/gauss=1%, LOT/1/uniform=0.1";

static bool is_tolerance(const struct dalcs_token *token) {
    const char *text = token->text;
    return token->kind == DALCS_TOKEN_WORD &&
           (strncmp(text, "dev", 3) == 0 || strncmp(text, "lot", 3) == 0) &&
           (text[3] == '\0' || text[3] == '/');
}

static bool fail(struct dalcs_language *language, const struct dalcs_token *token, const char *hint,
                 const char *what) {
    dalcs_language_report(language, DALCS_ERROR, NULL, token, hint, "%s", what);
    return false;
}

/* What stands between DEV and its size: /3, /gauss. */
static bool read_qualifiers(struct dalcs_language *language, const struct dalcs_token *token,
                            struct dalcs_tolerance *t) {
    for (const char *at = token->text + 3; *at == '/';) {
        const char *word = ++at;
        const size_t n = strcspn(word, "/");
        at += n;
        if (n == 1 && *word >= '0' && *word <= '9') {
            t->generator = *word;
        } else if (n > 0 && n <= strlen("gauss") && strncmp(word, "gauss", n) == 0) {
            t->is_gauss = true;
        } else if (!(n > 0 && n <= strlen("uniform") && strncmp(word, "uniform", n) == 0)) {
            dalcs_language_report(language, DALCS_ERROR, NULL, token,
                                  "there are uniform and gauss, and generators 0 to 9; any other "
                                  "distribution is a value with table(rand(), ...)",
                                  "there is no distribution '%.*s'", (int)n, word);
            return false;
        }
    }
    return true;
}

/* A size at token *at, which moves behind it: 5%, 0.1, {x}, {x}%. */
static bool read_size(struct dalcs_language *language, const struct dalcs_card *card, int *at,
                      struct dalcs_tolerance *t) {
    const struct dalcs_token *token = *at < card->n ? &card->token[*at] : NULL;
    struct dalcs_number number;
    char digits[64];
    if (token == NULL || (token->kind != DALCS_TOKEN_NUMBER && token->kind != DALCS_TOKEN_WORD)) {
        return token != NULL && token->kind == DALCS_TOKEN_BAD
                   ? false
                   : fail(language, t->token, USAGE, "the size of this tolerance is missing");
    }
    ++*at;
    if (token->kind == DALCS_TOKEN_NUMBER) {
        t->size = token->value;
        t->is_relative = *at < card->n && dalcs_token_is_word(&card->token[*at], "%");
        *at += t->is_relative ? 1 : 0;
    } else {
        const size_t n = strlen(token->text);
        t->is_relative = token->text[n - 1] == '%';
        const size_t n_digits = t->is_relative ? n - 1 : n;
        if (n_digits >= sizeof digits) {
            return fail(language, token, USAGE, "this is no number");
        }
        memcpy(digits, token->text, n_digits);
        digits[n_digits] = '\0';
        if (dalcs_number_parse_as(digits, language->netlist->dialect.name, &number) !=
            DALCS_NUMBER_OK) {
            dalcs_language_report(language, DALCS_ERROR, NULL, token, USAGE, "'%s' is no number",
                                  token->text);
            return false;
        }
        t->size = number.value;
    }
    t->size /= t->is_relative ? 100 : 1;
    return t->size >= 0 || fail(language, token, USAGE, "a tolerance cannot be negative");
}

/* The tolerance at token *at, which moves behind it. */
static bool read_one(struct dalcs_language *language, const struct dalcs_card *card, int *at,
                     struct dalcs_tolerances *of) {
    const struct dalcs_token *token = &card->token[*at];
    struct dalcs_tolerance *t = token->text[0] == 'd' ? &of->dev : &of->lot;
    if (t->token != NULL) {
        dalcs_language_report(language, DALCS_ERROR, NULL, token, NULL,
                              "a second %s of the same value",
                              token->text[0] == 'd' ? "DEV" : "LOT");
        return false;
    }
    t->token = token;
    if (!read_qualifiers(language, token, t)) {
        return false;
    }
    ++*at;
    *at += *at < card->n && card->token[*at].kind == DALCS_TOKEN_EQUAL ? 1 : 0;
    return read_size(language, card, at, t);
}

/* The name before a value: `name = value`, or on a model `name value`. */
static const char *name_before(const struct dalcs_card *card, int value) {
    if (card->token[value].kind != DALCS_TOKEN_WORD &&
        card->token[value].kind != DALCS_TOKEN_NUMBER) {
        return NULL;
    }
    int k = value - 1;
    k -= k > 0 && card->token[k].kind == DALCS_TOKEN_EQUAL ? 1 : 0;
    const bool is_named = k == value - 2 || card->letter == '.';
    return k > 0 && is_named && card->token[k].kind == DALCS_TOKEN_WORD ? card->token[k].text
                                                                        : NULL;
}

/* A card that is copied without its tolerances. */
struct stripping {
    const struct dalcs_card *from;
    struct dalcs_card left;
    struct dalcs_token *token; /* of `left` */
    struct dalcs_tolerances *found;
    int n_found;
};

/* The tolerance at token *at, which moves behind it, and whose value it is. */
static bool strip_one(struct dalcs_language *language, struct stripping *s, int *at) {
    const int first = *at;
    const int value = s->left.n - 1;
    if (s->n_found == 0 || s->found[s->n_found - 1].at != value) {
        s->found[s->n_found++] =
            (struct dalcs_tolerances){.name = name_before(&s->left, value), .at = value};
    }
    if (!read_one(language, s->from, at, &s->found[s->n_found - 1])) {
        s->token[s->left.n] = s->from->token[first];
        s->token[s->left.n++].kind = DALCS_TOKEN_BAD; /* its reader says no more of it */
        return false;
    }
    return true;
}

bool dalcs_tolerances_take(struct dalcs_language *language, struct dalcs_card *card,
                           struct dalcs_tolerances **found, int *n_found) {
    int n = 0;
    unsigned char role[64];
    *n_found = 0;
    for (int k = 3; k < card->n; k++) {
        n += is_tolerance(&card->token[k]) ? 1 : 0;
    }
    /* no element with a tolerance is so long; nodes may be called dev */
    if (n == 0 || (card->letter != '.' && card->n > (int)sizeof role)) {
        return true;
    }
    struct stripping s = {.from = card, .left = *card};
    s.left.token = s.token = dalcs_arena_alloc(language->arena, (size_t)card->n, sizeof *s.token);
    s.found = dalcs_arena_alloc(language->arena, (size_t)n, sizeof *s.found);
    s.left.n = 0;
    if (s.token == NULL || s.found == NULL) {
        language->out_of_memory = true;
        return false;
    }
    memset(role, DALCS_ROLE_VALUE, sizeof role);
    if (card->letter != '.') {
        dalcs_roles(card, role);
    }
    bool ok = true;
    for (int k = 0; k < card->n && ok;) {
        const bool is_value = card->letter == '.' || role[k] == DALCS_ROLE_VALUE;
        if (k >= 3 && is_value && is_tolerance(&card->token[k])) {
            ok = strip_one(language, &s, &k);
        } else {
            s.token[s.left.n++] = card->token[k++];
        }
    }
    *card = s.left;
    *found = s.found;
    *n_found = s.n_found;
    return ok;
}
