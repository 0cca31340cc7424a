/* dialect.c - what .options dialect= says, else what the cards show.
 *
 * A sign is something that ngspice refuses and one other simulator has. .step, which LTspice and Xyce both
 * have, is LTspice's unless another card shows Xyce. A .control block is ngspice's: then nothing else
 * counts. */
#include "dialect.h"

#include "netlist.h"

#include <stdlib.h>
#include <string.h>

static const char *const NAMES[] = {"ngspice", "ltspice", "xyce"};

enum { N_NAMES = sizeof NAMES / sizeof NAMES[0] };

const char DALCS_DIALECTS[] = "the dialects are: ngspice ltspice xyce";

static const char HINT[] = ".options dialect=ngspice, ltspice or xyce says what it is";

const char *dalcs_dialect_name(size_t index) {
    return index < N_NAMES ? NAMES[index] : NULL;
}

bool dalcs_dialect_find(const char *text, enum dalcs_dialect_name *name) {
    for (int k = 0; k < N_NAMES; k++) {
        if (strcmp(NAMES[k], text) == 0) {
            *name = (enum dalcs_dialect_name)(k + 1);
            return true;
        }
    }
    return false;
}

static bool is_one_of(const char *text, const char *const *list) {
    for (; *list != NULL; list++) {
        if (strcmp(text, *list) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_equal_sign(const struct dalcs_card *card, int k) {
    return k < card->n && card->token[k].kind == DALCS_TOKEN_EQUAL;
}

/* ---- .options dialect= ----------------------------------------------------------------------- */

static bool is_options(const struct dalcs_card *card) {
    static const char *const names[] = {".options", ".option", ".opt", NULL};
    return card->letter == '.' && is_one_of(card->token[0].text, names);
}

/* The name behind `dialect`, or NULL: then the card is wrong, which its reader says. */
static const struct dalcs_token *find_told(const struct dalcs_card *card) {
    for (int k = 1; k < card->n; k++) {
        if (card->token[k].kind == DALCS_TOKEN_WORD && !is_equal_sign(card, k - 1) &&
            strcmp(card->token[k].text, "dialect") == 0) {
            const int value = is_equal_sign(card, k + 1) ? k + 2 : k + 1;
            return value < card->n && card->token[value].kind == DALCS_TOKEN_WORD
                       ? &card->token[value]
                       : NULL;
        }
    }
    return NULL;
}

static void take_told(struct dalcs_netlist *netlist, const struct dalcs_token *token,
                      const struct dalcs_token **first, struct dalcs_diag *diag) {
    const struct dalcs_location where = dalcs_token_location(token);
    enum dalcs_dialect_name name;
    if (!dalcs_dialect_find(token->text, &name)) {
        dalcs_diag_add(diag, DALCS_ERROR, &where, DALCS_DIALECTS, "unknown dialect '%s'",
                       token->text);
        netlist->has_errors = true;
    } else if (*first != NULL && strcmp((*first)->text, token->text) != 0) {
        const struct dalcs_location other = dalcs_token_location(*first);
        dalcs_diag_add(diag, DALCS_ERROR, &where, NULL, "the dialect is already %s, by %s:%d:%d",
                       (*first)->text, other.file, other.line, other.column);
        netlist->has_errors = true;
    } else {
        *first = token;
        if (!netlist->dialect.is_told) {
            netlist->dialect = (struct dalcs_dialect){name, false};
        }
    }
}

/* ---- Signs ------------------------------------------------------------------------------------- */

/* The first sign of each, or NULL. */
struct signs {
    const struct dalcs_token *ltspice, *xyce, *step;
};

static void keep_first(const struct dalcs_token **first, const struct dalcs_token *token) {
    *first = *first != NULL ? *first : token;
}

static void look_at_words(const struct dalcs_card *card, const char *const *words,
                          const struct dalcs_token **first) {
    for (int k = 1; k < card->n; k++) {
        bool is_value = is_equal_sign(card, k - 1);
        if (!is_value && card->token[k].kind == DALCS_TOKEN_WORD &&
            is_one_of(card->token[k].text, words)) {
            keep_first(first, &card->token[k]);
        }
    }
}

/* Parameters of an element, such as rser= */
static void look_at_parameters(const struct dalcs_card *card, const char *const *words,
                               const struct dalcs_token **first) {
    for (int k = 2; k < card->n; k++) {
        if (is_equal_sign(card, k) && is_one_of(card->token[k - 1].text, words)) {
            keep_first(first, &card->token[k - 1]);
        }
    }
}

static void look_at_card(const struct dalcs_card *card, struct signs *signs) {
    static const char *const ltspice_cards[] = {".backanno", ".wave", ".ferret", NULL};
    static const char *const xyce_cards[] = {".global_param", ".preprocess", ".sampling", NULL};
    static const char *const ltspice_tran[] = {"startup", "steady", "nodiscard", NULL};
    static const char *const xyce_tran[] = {"noop", NULL};
    static const char *const packages[] = {"timeint", "linsol", "nonlin", "device",
                                           "output",  "parser", NULL};
    static const char *const format[] = {"format", NULL};
    const struct dalcs_token *name = &card->token[0];
    if (is_one_of(name->text, ltspice_cards)) {
        keep_first(&signs->ltspice, name);
    } else if (is_one_of(name->text, xyce_cards)) {
        keep_first(&signs->xyce, name);
    } else if (strcmp(name->text, ".step") == 0) {
        keep_first(&signs->step, name);
    } else if (strcmp(name->text, ".tran") == 0) {
        look_at_words(card, ltspice_tran, &signs->ltspice);
        look_at_words(card, xyce_tran, &signs->xyce);
    } else if (strcmp(name->text, ".print") == 0) {
        look_at_parameters(card, format, &signs->xyce);
    } else if (is_options(card) && card->n > 1 && is_one_of(card->token[1].text, packages)) {
        keep_first(&signs->xyce, &card->token[1]);
    }
}

static void look_at_element(const struct dalcs_card *card, struct signs *signs) {
    static const char *const parasitics[] = {"rser", "lser", "rpar", "cpar", "rlshunt", NULL};
    static const char *const control[] = {"control", NULL};
    if (card->letter == 'c' || card->letter == 'l' || card->letter == 'v') {
        look_at_parameters(card, parasitics, &signs->ltspice);
    } else if (card->letter == 's') {
        look_at_parameters(card, control, &signs->xyce);
    }
}

static void judge(struct dalcs_netlist *netlist, const struct signs *signs,
                  struct dalcs_diag *diag) {
    const struct dalcs_token *ltspice = signs->ltspice;
    if (signs->xyce == NULL) {
        ltspice = ltspice != NULL ? ltspice : signs->step;
    }
    const struct dalcs_token *sign = ltspice != NULL ? ltspice : signs->xyce;
    if (sign == NULL) {
        return;
    }
    const struct dalcs_location where = dalcs_token_location(sign);
    if (ltspice != NULL && signs->xyce != NULL) {
        const struct dalcs_location other = dalcs_token_location(signs->xyce);
        dalcs_diag_add(diag, DALCS_NOTE, &where, HINT,
                       "'%s' is LTspice's and '%s' at %s:%d:%d is Xyce's: the netlist is read as "
                       "ngspice would",
                       sign->text, signs->xyce->text, other.file, other.line, other.column);
        return;
    }
    netlist->dialect.name = ltspice != NULL ? DALCS_DIALECT_LTSPICE : DALCS_DIALECT_XYCE;
    dalcs_diag_add(diag, DALCS_NOTE, &where, HINT,
                   "'%s' is not ngspice's: the netlist is taken for one of %s", sign->text,
                   dalcs_dialect_simulator(netlist->dialect.name));
}

void dalcs_dialect_settle(struct dalcs_netlist *netlist, struct dalcs_diag *diag) {
    const struct dalcs_token *told = NULL;
    struct signs signs = {NULL, NULL, NULL};
    const bool looks = !netlist->dialect.is_told && netlist->commands.n == 0;
    for (size_t k = 0; k < netlist->n_cards; k++) {
        const struct dalcs_card *card = &netlist->card[k];
        const struct dalcs_token *name = is_options(card) ? find_told(card) : NULL;
        if (name != NULL) {
            take_told(netlist, name, &told, diag);
        }
        if (looks && card->letter == '.') {
            look_at_card(card, &signs);
        } else if (looks) {
            look_at_element(card, &signs);
        }
    }
    netlist->dialect.is_told = netlist->dialect.is_told || told != NULL;
    if (looks && !netlist->dialect.is_told) {
        judge(netlist, &signs, diag);
    }
}
