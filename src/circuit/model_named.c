/* model_named.c - which models of libraries the netlist names.
 *
 * A library has hundreds of models for one that is used. What is wrong with another one, or only approximated, is no
 * business of this netlist. What the netlist's own file has is read in any case: it may be a slip of its author. */
#include "card_table.h"
#include "model_cards.h"

static bool is_of_library(const struct dalcs_card *card, unsigned char class) {
    return class == DALCS_CARD_MODEL && card->n > 1 && card->token[0].line->source->outer != NULL;
}

/* An element has its own name and two nodes before that of a model. */
static int first_place(unsigned char class) {
    return class == DALCS_CARD_ELEMENT ? 3 : 1;
}

/* The models of libraries, each with a number; *n of them. */
static enum dalcs_status number(const struct dalcs_deck *deck, const unsigned char *class_of,
                                struct dalcs_names *models, size_t *n) {
    *n = 0;
    for (size_t k = 0; k < deck->n_cards; k++) {
        if (is_of_library(&deck->card[k], class_of[k])) {
            int found;
            DALCS_TRY(
                dalcs_names_find_or_add(models, deck->card[k].token[1].text, (int)*n, &found));
            *n += found == (int)*n ? 1 : 0;
        }
    }
    return DALCS_OK;
}

static void mark(const struct dalcs_names *models, const struct dalcs_card *card,
                 unsigned char class, bool *is_named) {
    for (int k = first_place(class); k < card->n; k++) {
        if (card->token[k].kind == DALCS_TOKEN_WORD) {
            const int found = dalcs_names_find(models, card->token[k].text);
            if (found >= 0) {
                is_named[found] = true;
            }
        }
    }
}

static void leave(const struct dalcs_deck *deck, unsigned char *class_of,
                  const struct dalcs_names *models, bool *is_named) {
    for (size_t k = 0; k < deck->n_cards; k++) {
        if (class_of[k] != DALCS_CARD_MODEL && class_of[k] != DALCS_CARD_NONE) {
            mark(models, &deck->card[k], class_of[k], is_named);
        }
    }
    for (size_t k = 0; k < deck->n_cards; k++) {
        if (is_of_library(&deck->card[k], class_of[k]) &&
            !is_named[dalcs_names_find(models, deck->card[k].token[1].text)]) {
            class_of[k] = DALCS_CARD_NONE;
        }
    }
}

enum dalcs_status dalcs_model_leave_unnamed(struct dalcs_builder *builder,
                                            unsigned char *class_of) {
    struct dalcs_names models = {0};
    size_t n;
    enum dalcs_status status = number(builder->deck, class_of, &models, &n);
    if (status == DALCS_OK && n > 0) {
        bool *is_named = dalcs_arena_alloc(&builder->scratch, n, sizeof *is_named);
        if (is_named != NULL) {
            leave(builder->deck, class_of, &models, is_named);
        } else {
            status = DALCS_E_NOMEM;
        }
    }
    dalcs_names_finish(&models);
    return status;
}
