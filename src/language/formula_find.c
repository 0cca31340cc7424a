/* formula_find.c - where a card has a formula, by its letter and the words before it. */
#include "language.h"

#include <string.h>

static bool is_word(const struct dalcs_token *token, const char *const *list, size_t n) {
    bool found = false;
    for (size_t k = 0; k < n; k++) {
        found = found || (token->kind == DALCS_TOKEN_WORD && strcmp(token->text, list[k]) == 0);
    }
    return found;
}

static bool is_kind(const struct dalcs_card *card, int k, enum dalcs_token_kind kind) {
    return k < card->n && card->token[k].kind == kind;
}

/* B p n V=formula: its first token, card->n when there is none. */
static int start_of_source(const struct dalcs_card *card) {
    static const char *const quantities[] = {"v", "i", "r", "p"};
    int k = 2;
    while (k < card->n &&
           !(is_word(&card->token[k], quantities, sizeof quantities / sizeof quantities[0]) &&
             is_kind(card, k + 1, DALCS_TOKEN_EQUAL))) {
        k++;
    }
    return k < card->n ? k + 2 : k;
}

/* E p n VALUE={formula}, E p n TABLE {formula} = points: the same. */
static int start_of_controlled(const struct dalcs_card *card, bool *is_table) {
    static const char *const forms[] = {"value", "vol", "cur", "table", "laplace"};
    int k = 1;
    for (int n_nodes = 0; n_nodes < 2 && k < card->n; k++) {
        n_nodes += card->token[k].kind == DALCS_TOKEN_WORD;
    }
    k += is_kind(card, k, DALCS_TOKEN_CLOSE);
    if (k >= card->n || !is_word(&card->token[k], forms, sizeof forms / sizeof forms[0])) {
        return card->n;
    }
    const bool is_transfer = strcmp(card->token[k].text, "laplace") == 0;
    *is_table = is_transfer || strcmp(card->token[k].text, "table") == 0;
    k++;
    return is_kind(card, k, DALCS_TOKEN_EQUAL) ? k + 1 : k;
}

int dalcs_formula_find_control(const struct dalcs_card *card) {
    static const char *const control[] = {"control"};
    int k = 1;
    while (k < card->n &&
           !(is_word(&card->token[k], control, 1) && is_kind(card, k + 1, DALCS_TOKEN_EQUAL))) {
        k++;
    }
    return k;
}

static bool is_of_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
           (c != '\0' && strchr("_.$#@", c) != NULL);
}

/* Does a text read the time, a voltage or a current? opens: a parenthesis follows it. */
static bool text_has_signal(const char *text, bool opens) {
    for (const char *p = text; *p != '\0';) {
        const char *end = p;
        while (is_of_name(*end)) {
            end++;
        }
        const size_t n = (size_t)(end - p);
        const char *next = end + strspn(end, " \t");
        const bool is_call = *next == '(' || (*next == '\0' && opens);
        if ((n == 4 && strncmp(p, "time", 4) == 0) ||
            (n == 1 && is_call && (*p == 'v' || *p == 'i'))) {
            return true;
        }
        p = n > 0 ? end : p + 1;
    }
    return false;
}

bool dalcs_formula_has_signal(const char *text) {
    return text_has_signal(text, false);
}

static bool has_signal(const struct dalcs_card *card, int first, int n) {
    bool has = false;
    for (int k = first; k < first + n && !has; k++) {
        const struct dalcs_token *token = &card->token[k];
        has = (token->kind == DALCS_TOKEN_WORD || token->kind == DALCS_TOKEN_EXPRESSION) &&
              text_has_signal(token->text, is_kind(card, k + 1, DALCS_TOKEN_OPEN));
    }
    return has;
}

/* L p n FLUX=formula, C p n Q=formula; also {formula} in the place of a value, where it has signals. */
static int start_of_storage(const struct dalcs_card *card) {
    static const char *const coil[] = {"flux"};
    static const char *const capacitor[] = {"q"};
    int k = 3;
    while (k < card->n) {
        const bool is_assigned = card->token[k - 1].kind == DALCS_TOKEN_EQUAL;
        if (is_assigned &&
            is_word(&card->token[k - 2], card->letter == 'l' ? coil : capacitor, 1)) {
            return k;
        }
        if (card->token[k].kind == DALCS_TOKEN_EXPRESSION && (is_assigned || k == 3) &&
            has_signal(card, k, 1)) {
            return k;
        }
        k++;
    }
    return k;
}

bool dalcs_formula_reads_value(const char *text) {
    int depth = 0;
    bool reads = false;
    for (const char *p = text; *p != '\0' && !reads; p++) {
        depth += (*p == '(') - (*p == ')');
        reads = depth == 0 && *p == ':' && p > text && is_of_name(p[-1]) && is_of_name(p[1]);
    }
    return reads && strchr(text, '?') == NULL;
}

/* Does a formula go on here, as in {a}*exp({b}*v(x))? */
static bool goes_on(const struct dalcs_card *card, int k) {
    return is_kind(card, k, DALCS_TOKEN_WORD) &&
           strchr("*/+-<>&|?", card->token[k].text[0]) != NULL;
}

/* Rname a b R=formula, Rname a b {formula}: one of voltages and currents. A number is not for here. */
static bool find_resistance(const struct dalcs_card *card, int *first, int *n) {
    static const char *const names[] = {"r", "resistance"};
    const bool has_name =
        card->n > 5 && is_word(&card->token[3], names, 2) && is_kind(card, 4, DALCS_TOKEN_EQUAL);
    *first = has_name ? 5 : 3;
    *n = 1;
    if (card->n <= 3 || !(has_name || is_kind(card, 3, DALCS_TOKEN_EXPRESSION))) {
        return false;
    }
    const bool is_braced = is_kind(card, 5, DALCS_TOKEN_EXPRESSION) && !goes_on(card, 6);
    while (has_name && !is_braced && *first + *n < card->n &&
           !dalcs_assignment_starts(card, *first + *n)) {
        ++*n;
    }
    return has_signal(card, *first, *n);
}

/* Where a formula starts on a card that may have one; 0: on no card of this letter. */
static int start_of_formula(const struct dalcs_card *card, bool *is_table) {
    switch (card->letter) {
    case 'l':
    case 'c':
        return start_of_storage(card);
    case 'b':
        return start_of_source(card);
    case 'e':
    case 'g':
        return start_of_controlled(card, is_table);
    case 's':
        return dalcs_formula_find_control(card) + 2;
    default:
        return 0;
    }
}

bool dalcs_formula_find(const struct dalcs_card *card, int *first, int *n) {
    static const char *const behind[] = {"laplace", "nojacob"};
    bool is_table = false;
    if (card->letter == 'r') {
        return find_resistance(card, first, n);
    }
    const int start = start_of_formula(card, &is_table);
    if (start == 0) {
        return false;
    }
    *first = start;
    *n = 1;
    if (card->letter == 's' && is_kind(card, start, DALCS_TOKEN_EXPRESSION)) {
        return true;
    }
    int end = start;
    int depth = 0;
    while (end < card->n) {
        const enum dalcs_token_kind kind = card->token[end].kind;
        depth += (kind == DALCS_TOKEN_OPEN) - (kind == DALCS_TOKEN_CLOSE);
        /* LTspice needs no equal sign behind LAPLACE, nor a blank before its parenthesis; NoJacob is a word of its own */
        const bool is_behind = card->letter == 'b' && is_word(&card->token[end], behind, 2);
        const bool is_next =
            end > start && depth == 0 && (is_behind || dalcs_assignment_starts(card, end));
        const bool ends_here =
            is_table && (kind == DALCS_TOKEN_EQUAL ||
                         (end > start && is_kind(card, start, DALCS_TOKEN_EXPRESSION)));
        if (kind == DALCS_TOKEN_BAD) {
            return false;
        }
        if (is_next || ends_here) {
            break;
        }
        end++;
    }
    *n = end - start;
    return *n > 0;
}

/* Where the transfer function of a card begins: behind the formula of LAPLACE {formula} = {expression}, and behind the
 * word of LAPLACE=expression, which a formula may stand before but never holds. card->n when there is none. */
static int start_of_transfer(const struct dalcs_card *card) {
    static const char *const word[] = {"laplace"};
    int formula;
    int n_formula;
    int k = 3;
    if (dalcs_formula_find(card, &formula, &n_formula)) {
        const int before = formula - (is_kind(card, formula - 1, DALCS_TOKEN_EQUAL) ? 2 : 1);
        k = formula + n_formula;
        if (is_word(&card->token[before], word, 1)) {
            return k;
        }
    }
    while (k < card->n && !is_word(&card->token[k], word, 1)) {
        k++;
    }
    return k < card->n ? k + 1 : k;
}

bool dalcs_transfer_find(const struct dalcs_card *card, int *first, int *n) {
    if (strchr("beg", card->letter) == NULL || card->letter == '\0') {
        return false;
    }
    int k = start_of_transfer(card);
    k += is_kind(card, k, DALCS_TOKEN_EQUAL);
    *first = k;
    while (k < card->n && !(k > *first && dalcs_assignment_starts(card, k))) {
        if (card->token[k].kind == DALCS_TOKEN_BAD) {
            return false;
        }
        k++;
    }
    *n = k - *first;
    return *n > 0;
}
