/* roles.c - which words of a card are names of nodes, elements or models.
 *
 * The expansion of subcircuits needs only this of an element: the tokens to rename. What is wrong
 * with a card is said later, by the reader of its family. */
#include "language.h"

#include <stdlib.h>
#include <string.h>

/* The words after an element's name, by its first letter: nodes, then elements, then a model. */
struct shape {
    char letter;
    int n_nodes;
    int n_devices;
    bool has_model;
};

static const struct shape *shape_of(char letter) {
    static const struct shape shapes[] = {
        {'r', 2, 0, false}, {'l', 2, 0, false}, {'c', 2, 0, false}, {'v', 2, 0, false},
        {'i', 2, 0, false}, {'e', 4, 0, false}, {'g', 4, 0, false}, {'f', 2, 1, false},
        {'h', 2, 1, false}, {'d', 2, 0, true},  {'s', 4, 0, true},  {'w', 2, 1, true},
        {'b', 2, 0, false}, {'t', 4, 0, false}, {'q', 3, 0, true},  {'j', 3, 0, true},
        {'m', 4, 0, true},  {'z', 3, 0, true},
    };
    for (size_t k = 0; k < sizeof shapes / sizeof shapes[0]; k++) {
        if (shapes[k].letter == letter) {
            return &shapes[k];
        }
    }
    return NULL;
}

/* POLY, VALUE= and the like: the controlling nodes of E and G are elsewhere. */
static bool is_form(const struct dalcs_token *token) {
    static const char *const forms[] = {"poly", "value", "table", "laplace",
                                        "freq", "vol",   "cur",   "chebyshev"};
    for (size_t k = 0; k < sizeof forms / sizeof forms[0]; k++) {
        if (dalcs_token_is_word(token, forms[k])) {
            return true;
        }
    }
    return false;
}

static bool starts_number(const char *text) {
    text += *text == '+' || *text == '-';
    text += *text == '.';
    return *text >= '0' && *text <= '9';
}

/* K1 L1 L2 ... k: coils up to the last word or the first number. */
static void coupling_roles(const struct dalcs_card *card, unsigned char *role) {
    for (int k = 1; k < card->n - 1; k++) {
        const struct dalcs_token *token = &card->token[k];
        if (token->kind != DALCS_TOKEN_WORD || starts_number(token->text)) {
            return;
        }
        role[k] = DALCS_ROLE_DEVICE;
    }
}

/* ... POLY(n) and what controls it: 2 n nodes for E and G, n elements for F and H. The words before
 * POLY have their roles. */
static void poly_roles(const struct dalcs_card *card, int poly, unsigned char *role) {
    const struct dalcs_token *token = card->token;
    const bool by_voltage = card->letter == 'e' || card->letter == 'g';
    int k = poly + 1;
    k += k < card->n && token[k].kind == DALCS_TOKEN_OPEN;
    long n = k < card->n && token[k].kind == DALCS_TOKEN_WORD ? strtol(token[k].text, NULL, 10) : 0;
    k++;
    k += k < card->n && token[k].kind == DALCS_TOKEN_CLOSE;
    n = n < card->n ? n : card->n;
    for (n = by_voltage ? 2 * n : n; k < card->n && n > 0; k++) {
        if (token[k].kind == DALCS_TOKEN_WORD) {
            role[k] = by_voltage ? DALCS_ROLE_NODE : DALCS_ROLE_DEVICE;
            n--;
        }
    }
}

bool dalcs_card_is_logic(const struct dalcs_card *card) {
    static const char *const words[] = {
        "and",        "or",    "xor",         "inv",          "buf",          "schmitt", "schmtbuf",
        "schmtinv",   "dflop", "diffschmitt", "diffschmtbuf", "diffschmtinv", "srflop",  "counter",
        "samplehold", "ota",   "varistor",    "modulator",    "modulate",     "phasedet"};
    bool is = false;
    for (size_t k = 0; k < sizeof words / sizeof words[0] && card->n > DALCS_LOGIC_MODEL; k++) {
        is = is || dalcs_token_is_word(&card->token[DALCS_LOGIC_MODEL], words[k]);
    }
    return is && card->letter == 'a';
}

/* XSPICE: nodes, types such as %v, parentheses and brackets; the last word is the model. */
static void block_roles(const struct dalcs_card *card, unsigned char *role) {
    if (dalcs_card_is_logic(card)) {
        memset(role + 1, DALCS_ROLE_NODE, DALCS_LOGIC_MODEL - 1);
        role[DALCS_LOGIC_MODEL] = DALCS_ROLE_RAW;
        return;
    }
    int last = 0;
    for (int k = 1; k < card->n; k++) {
        if (card->token[k].kind == DALCS_TOKEN_WORD && card->token[k].text[0] != '%') {
            const char *text = card->token[k].text;
            const bool is_list = strchr("[~", text[0]) != NULL || text[strlen(text) - 1] == ']';
            role[k] = is_list || strcmp(text, "null") == 0 ? DALCS_ROLE_PORT : DALCS_ROLE_NODE;
            last = k;
        }
    }
    role[last] = DALCS_ROLE_MODEL;
}

int dalcs_roles_count_terminals(const struct dalcs_card *card) {
    int last = 0;
    for (int k = 1; k < card->n && card->token[k].kind == DALCS_TOKEN_WORD; k++) {
        const bool is_parameter = k + 1 < card->n && card->token[k + 1].kind == DALCS_TOKEN_EQUAL;
        if (is_parameter || (k > 4 && dalcs_token_is_word(&card->token[k], "off"))) {
            break;
        }
        const char *text = card->token[k].text; /* an area, not 2n7002 */
        const bool is_number = starts_number(text) && text[strspn(text, "0123456789.+-e")] == '\0';
        last = k <= 3 || !is_number ? k : last;
    }
    return last - 1;
}

static void element_roles(const struct dalcs_card *card, const struct shape *shape,
                          unsigned char *role) {
    const struct dalcs_token *token = card->token;
    int n_nodes = shape->n_nodes;
    int n_devices = shape->n_devices;
    bool has_model = shape->has_model;
    if (shape->letter == 's' && dalcs_formula_find_control(card) < card->n) {
        n_nodes = 2; /* its control is a formula */
    }
    if (strchr("mqz", shape->letter) != NULL) {
        n_nodes = dalcs_roles_count_terminals(card);
    }
    for (int k = 1; k < card->n; k++) {
        if (token[k].kind != DALCS_TOKEN_WORD) {
            continue;
        }
        const bool is_parameter = k + 1 < card->n && token[k + 1].kind == DALCS_TOKEN_EQUAL;
        const bool is_controlled = strchr("efgh", shape->letter) != NULL;
        const int n_controls = shape->letter == 'e' || shape->letter == 'g' ? 2 : 0;
        if (is_controlled && n_nodes == n_controls && is_form(&token[k])) {
            if (dalcs_token_is_word(&token[k], "poly")) {
                poly_roles(card, k, role);
            }
            return;
        }
        if (n_nodes > 0) {
            role[k] = DALCS_ROLE_NODE;
            n_nodes--;
        } else if (is_parameter) {
            return;
        } else if (n_devices > 0) {
            role[k] = DALCS_ROLE_DEVICE;
            n_devices--;
        } else if (has_model) {
            role[k] = DALCS_ROLE_MODEL;
            return;
        } else {
            return;
        }
    }
}

/* Behavioural sources: their formulas are of voltages and currents. */
static void raw_roles(const struct dalcs_card *card, unsigned char *role) {
    bool is_transfer = false; /* of s: whoever reads the card refuses it */
    for (int k = 1; k < card->n; k++) {
        is_transfer = is_transfer || dalcs_token_is_word(&card->token[k], "laplace") ||
                      dalcs_token_is_word(&card->token[k], "freq");
        const bool is_formula = card->letter == 'b' || is_transfer ||
                                (k >= 2 && card->token[k - 1].kind == DALCS_TOKEN_EQUAL &&
                                 is_form(&card->token[k - 2])) ||
                                is_form(&card->token[k - 1]);
        const bool is_number = k >= 2 && (dalcs_token_is_word(&card->token[k - 2], "m") ||
                                          dalcs_token_is_word(&card->token[k - 2], "rpar") ||
                                          dalcs_token_is_word(&card->token[k - 2], "cpar"));
        if (card->token[k].kind == DALCS_TOKEN_EXPRESSION && is_formula && !is_number) {
            role[k] = DALCS_ROLE_RAW;
        }
    }
}

/* v(a), v(a,b) and i(x) on .ic, .save and the like. */
static void signal_roles(const struct dalcs_card *card, unsigned char *role) {
    enum dalcs_role inside = DALCS_ROLE_VALUE;
    for (int k = 1; k < card->n; k++) {
        const struct dalcs_token *token = &card->token[k];
        if (token->kind == DALCS_TOKEN_OPEN) {
            inside = dalcs_token_is_word(token - 1, "v")   ? DALCS_ROLE_NODE
                     : dalcs_token_is_word(token - 1, "i") ? DALCS_ROLE_DEVICE
                                                           : DALCS_ROLE_VALUE;
        } else if (token->kind == DALCS_TOKEN_CLOSE) {
            inside = DALCS_ROLE_VALUE;
        } else if (token->kind == DALCS_TOKEN_WORD) {
            role[k] = (unsigned char)inside;
        }
    }
}

static bool is_one_of(const struct dalcs_token *token, const char *const *list, size_t n) {
    bool found = false;
    for (size_t k = 0; k < n; k++) {
        found = found || dalcs_token_is_word(token, list[k]);
    }
    return found;
}

/* Formulas of measurements, whose reader compiles them, on cards of others, which are left out, and on cards that name
 * signals. */
static void formula_roles(const struct dalcs_card *card, unsigned char *role) {
    static const char *const measures[] = {".meas", ".measure", ".result", ".sens"};
    static const char *const signals[] = {".save", ".print", ".plot", ".probe", ".probe64"};
    const bool is_measure = is_one_of(card->token, measures, sizeof measures / sizeof measures[0]);
    for (int k = 1; k < card->n && (is_measure || is_one_of(card->token, signals,
                                                            sizeof signals / sizeof signals[0]));
         k++) {
        if (card->token[k].kind == DALCS_TOKEN_EXPRESSION) {
            role[k] = is_measure ? DALCS_ROLE_RAW : DALCS_ROLE_SIGNAL;
        }
    }
    /* The numbers ahead of the signals of a .four may be expressions, too. */
    for (int k = 1; k < card->n && dalcs_token_is_word(card->token, ".four"); k++) {
        if (card->token[k].kind == DALCS_TOKEN_EXPRESSION &&
            dalcs_formula_has_signal(card->token[k].text)) {
            role[k] = DALCS_ROLE_RAW;
        }
    }
}

void dalcs_roles(const struct dalcs_card *card, unsigned char *role) {
    memset(role, DALCS_ROLE_VALUE, (size_t)card->n);
    const struct shape *shape = shape_of(card->letter);
    if (shape != NULL) {
        element_roles(card, shape, role);
        if (strchr("beg", card->letter) != NULL) {
            raw_roles(card, role);
        }
    } else if (card->letter == 'a') {
        block_roles(card, role);
    } else if (card->letter == 'k') {
        coupling_roles(card, role);
    } else if (card->letter == '.' && strcmp(card->token->text, ".model") != 0) {
        const bool is_measure = dalcs_token_is_word(card->token, ".meas") ||
                                dalcs_token_is_word(card->token, ".measure");
        if (!is_measure) {
            signal_roles(card, role);
        }
        formula_roles(card, role);
    }
}
