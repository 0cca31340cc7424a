/* takeover.c - is there a way for the current of a thyristor, from its cathode back to its anode, on which nothing drops?
 *
 * Where one is, its voltage stays at 0 behind the end of its current: an ideal diode or a thyristor against it, a switch
 * across it, or some of them in series with meters. Coils, capacitors, resistors and sources are no such way. Cards that are
 * are listed once, and few of them begin at a cathode. */
#include "element_cards.h"

#include <string.h>

struct dalcs_takeovers {
    int n;
    const struct dalcs_card **card; /* [n] */
    bool *is_used;                  /* [n] it begins where the current may come to */
};

/* A V source that only measures. */
static bool is_meter(const struct dalcs_card *card) {
    const int value = card->n > 3 && strcmp(card->token[3].text, "dc") == 0 ? 4 : 3;
    return card->n <= value || (card->n == value + 1 && strcmp(card->token[value].text, "0") == 0);
}

static bool drops_nothing(const struct dalcs_builder *builder, const struct dalcs_card *card) {
    switch (card->letter) {
    case 'v':
        return is_meter(card);
    case 's':
    case 'w':
        return true;
    case 'r':
        return card->n == 4 && strcmp(card->token[3].text, "0") == 0;
    case 'd': {
        const int index =
            card->n > 3 ? dalcs_names_find(&builder->models.names, card->token[3].text) : -1;
        const struct dalcs_model *m = index >= 0 ? &builder->models.model[index] : NULL;
        return m == NULL || (m->kind == DALCS_MODEL_DIODE && !m->diode.is_berkeley &&
                             builder->circuit->models.of_diode[m->index].vfwd == 0.0);
    }
    default:
        return card->letter == 'a' && card->n > 4 && dalcs_thyristor_is(builder, card) &&
               builder->circuit->models.of_diode[dalcs_thyristor_model(builder, card)->index]
                       .vfwd == 0.0;
    }
}

static bool both_ways(const struct dalcs_builder *builder, const struct dalcs_card *card) {
    return card->letter != 'd' &&
           (card->letter != 'a' ||
            strcmp(dalcs_thyristor_model(builder, card)->type->text, "triac") == 0);
}

static struct dalcs_takeovers *list(struct dalcs_builder *builder) {
    const struct dalcs_deck *deck = builder->deck;
    struct dalcs_takeovers *all = dalcs_arena_alloc(&builder->scratch, 1, sizeof *all);
    if (all == NULL) {
        return NULL;
    }
    for (int pass = 0; pass < 2; pass++) {
        all->n = 0;
        for (size_t k = 0; k < deck->n_cards; k++) {
            const struct dalcs_card *card = &deck->card[k];
            if (card->n > 2 && drops_nothing(builder, card)) {
                if (pass > 0) {
                    all->card[all->n] = card;
                }
                all->n++;
            }
        }
        if (pass == 0) {
            const size_t n = (size_t)all->n;
            all->card = dalcs_arena_alloc(&builder->scratch, n, sizeof(*all->card));
            all->is_used = dalcs_arena_alloc(&builder->scratch, n, sizeof(*all->is_used));
            if (all->card == NULL || all->is_used == NULL) {
                return NULL;
            }
        }
    }
    return all;
}

/* May the current that leaves `cathode` come to this node by the cards that are used? */
static bool is_reached(const struct dalcs_builder *builder, const struct dalcs_takeovers *all,
                       const char *cathode, const char *node) {
    bool is = strcmp(node, cathode) == 0;
    for (int k = 0; k < all->n && !is; k++) {
        if (all->is_used[k]) {
            const struct dalcs_token *t = all->card[k]->token;
            is = strcmp(node, t[2].text) == 0 ||
                 (both_ways(builder, all->card[k]) && strcmp(node, t[1].text) == 0);
        }
    }
    return is;
}

bool dalcs_thyristor_is_taken_over(struct dalcs_builder *builder, const struct dalcs_card *card) {
    if (builder->models.takeovers == NULL) {
        builder->models.takeovers = list(builder);
    }
    struct dalcs_takeovers *all = builder->models.takeovers;
    if (all == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    const char *cathode = card->token[2].text;
    const char *anode = card->token[1].text;
    memset(all->is_used, 0, (size_t)all->n * sizeof(*all->is_used));
    bool is = false;
    for (bool grows = true; grows && !is;) {
        grows = false;
        for (int k = 0; k < all->n && !is; k++) {
            const struct dalcs_token *t = all->card[k]->token;
            if (!all->is_used[k] && all->card[k] != card &&
                (is_reached(builder, all, cathode, t[1].text) ||
                 (both_ways(builder, all->card[k]) &&
                  is_reached(builder, all, cathode, t[2].text)))) {
                all->is_used[k] = grows = true;
                is = is_reached(builder, all, cathode, anode);
            }
        }
    }
    return is;
}
