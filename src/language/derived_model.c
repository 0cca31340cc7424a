/* derived_model.c - a model that is another one but for some parameters: `.model new ako:old [type] [(name=value ...)]`,
 * a kind of, in PSpice and LTspice. */
#include "language.h"

#include "memory.h"

#include <string.h>

/* The word behind `ako:`, with a blank or without; *next: the place behind it. */
static const char *base_of(const struct dalcs_card *card, int *next) {
    const char *joined = card->token[2].text + strlen("ako:");
    const bool is_apart = *joined == '\0';
    *next = is_apart ? 4 : 3;
    return !is_apart ? joined : card->n > 3 ? card->token[3].text : "";
}

/* The type stands at *type, -1: none does; the parameters from *first up to *end, without the parentheses around them. */
static void find_parameters(const struct dalcs_card *card, int from, int *type, int *first,
                            int *end) {
    const bool has_type = from < card->n && card->token[from].kind == DALCS_TOKEN_WORD &&
                          (from + 1 == card->n || card->token[from + 1].kind != DALCS_TOKEN_EQUAL);
    *type = has_type ? from : -1;
    *first = from + (has_type ? 1 : 0);
    *end = card->n;
    if (*first < *end && card->token[*first].kind == DALCS_TOKEN_OPEN) {
        ++*first;
        *end -= card->token[*end - 1].kind == DALCS_TOKEN_CLOSE ? 1 : 0;
    }
}

static bool begins_parameter(const struct dalcs_card *card, int k, int end) {
    return k + 1 < end && card->token[k].kind == DALCS_TOKEN_WORD &&
           card->token[k + 1].kind == DALCS_TOKEN_EQUAL;
}

static bool gives(const struct dalcs_card *card, int first, int end, const char *name) {
    bool does = false;
    for (int k = first; k < end && !does; k++) {
        does = begins_parameter(card, k, end) && strcmp(card->token[k].text, name) == 0;
    }
    return does;
}

/* The card of a model that can be seen from a scope, and where that is. */
static const struct dalcs_card *find_card(const struct dalcs_scope *scope, const char *name) {
    for (const struct dalcs_scope *s = scope; s != NULL; s = s->enclosing) {
        const int item = dalcs_names_find(&s->definition->models, name);
        if (item >= 0) {
            return s->definition->item[item].card;
        }
    }
    return NULL;
}

/* Those of old that new does not give, then those of new. */
static const struct dalcs_card *join(struct dalcs_language *language, const struct dalcs_card *old,
                                     const struct dalcs_card *new, int from) {
    int old_type;
    int new_type;
    int first[2];
    int end[2];
    find_parameters(old, 2, &old_type, &first[0], &end[0]);
    find_parameters(new, from, &new_type, &first[1], &end[1]);
    struct dalcs_card *card = dalcs_arena_alloc(language->arena, 1, sizeof *card);
    struct dalcs_token *token =
        dalcs_arena_alloc(language->arena, (size_t)(old->n + new->n), sizeof *token);
    if (card == NULL || token == NULL) {
        language->out_of_memory = true;
        return NULL;
    }
    int n = 0;
    token[n++] = new->token[0];
    token[n++] = new->token[1];
    if (new_type >= 0 || old_type >= 0) {
        token[n++] = new_type >= 0 ? new->token[new_type] : old->token[old_type];
    }
    bool taken = true;
    for (int k = first[0]; k < end[0]; k++) {
        taken = begins_parameter(old, k, end[0]) ? !gives(new, first[1], end[1], old->token[k].text)
                                                 : taken;
        if (taken) {
            token[n++] = old->token[k];
        }
    }
    for (int k = first[1]; k < end[1]; k++) {
        token[n++] = new->token[k];
    }
    *card = (struct dalcs_card){token, n, new->letter, 0};
    return card;
}

static const struct dalcs_card *refused(struct dalcs_language *language,
                                        const struct dalcs_card *card) {
    struct dalcs_card *bad = dalcs_arena_alloc(language->arena, 1, sizeof *bad);
    struct dalcs_token *token = dalcs_arena_alloc(language->arena, 3, sizeof *token);
    if (bad == NULL || token == NULL) {
        language->out_of_memory = true;
        return NULL;
    }
    memcpy(token, card->token, 3 * sizeof *token);
    token[2].kind = DALCS_TOKEN_BAD;
    *bad = (struct dalcs_card){token, 3, card->letter, 0};
    return bad;
}

const struct dalcs_card *dalcs_model_derive(struct dalcs_language *language,
                                            const struct dalcs_scope *scope,
                                            const struct dalcs_card *card) {
    enum { DEEPEST = 100 }; /* models of models; a ring has no end */

    for (int depth = 0; card != NULL && dalcs_card_is_derived_model(card); depth++) {
        int next;
        const char *name = base_of(card, &next);
        const struct dalcs_card *old = find_card(scope, name);
        if (old == NULL || old == card || depth == DEEPEST) {
            dalcs_language_report(language, DALCS_ERROR, scope, &card->token[2],
                                  "`.model new ako:old` takes what a .model of the netlist has: "
                                  "write the model in full",
                                  old == NULL
                                      ? "there is no model '%s' that this one could be a kind of"
                                      : "'%s' is a kind of itself",
                                  name);
            return refused(language, card);
        }
        card = join(language, old, card, next);
    }
    return card;
}
