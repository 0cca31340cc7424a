/* tolerance.c - what DEV and LOT make of the values on flat cards, in runs of .mc and .wcase.
 *
 * A value with both is nominal (1 + dev + lot). DEV is drawn for each device: one that has it by its model gets a
 * model of its own. LOT is drawn once: for the model as it is written, whatever subcircuit calls make of it; of elements
 * without a model for all with this letter; of LOT/1 for all that say so. */
#include "tolerance.h"

#include <stdlib.h>
#include <string.h>

static bool is_passive(const struct dalcs_card *card) {
    return card->letter == 'r' || card->letter == 'l' || card->letter == 'c';
}

/* ---- Elements ---------------------------------------------------------------------------------- */

/* The model that a card names, if it has tolerances: its token, or 0. It is used now. */
static int model_token(struct dalcs_tolerant *all, const struct dalcs_card *card,
                       const unsigned char *role) {
    for (int k = 3; k < card->n && all->n_models > 0; k++) {
        const bool may = card->token[k].kind == DALCS_TOKEN_WORD &&
                         (role[k] == DALCS_ROLE_MODEL ||
                          (is_passive(card) && card->token[k - 1].kind != DALCS_TOKEN_EQUAL &&
                           (k + 1 == card->n || card->token[k + 1].kind != DALCS_TOKEN_EQUAL)));
        const int found = may ? dalcs_names_find(&all->models, card->token[k].text) : -1;
        if (found >= 0) {
            all->model[found].is_used = true;
            return k;
        }
    }
    return 0;
}

/* A model of its own for the device of the card, at the end of the deck. */
static enum dalcs_status give_model(struct dalcs_tolerant *all, struct dalcs_card *card, int at,
                                    const struct dalcs_tolerant_model *m) {
    struct dalcs_language *language = all->language;
    struct dalcs_deck *deck = language->deck;
    const char *device = card->token[0].text;
    const char *name = dalcs_language_text(language, "%s@%s", card->token[at].text, device);
    struct dalcs_card model = deck->own[m->card];
    struct dalcs_token *of_model =
        dalcs_arena_alloc(language->arena, (size_t)model.n, sizeof *of_model);
    struct dalcs_token *of_card =
        dalcs_arena_alloc(language->arena, (size_t)card->n, sizeof *of_card);
    if (name == NULL || of_model == NULL || of_card == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(of_model, model.token, (size_t)model.n * sizeof *of_model);
    memcpy(of_card, card->token, (size_t)card->n * sizeof *of_card);
    of_model[1].text = of_card[at].text = name;
    model.token = of_model;
    DALCS_TRY(dalcs_tolerance_set_model(all, m, device, &model));
    if (model.token == of_model) {
        return DALCS_OK; /* nothing is other than in the model itself */
    }
    card->token = of_card;
    DALCS_TRY(dalcs_grow(&deck->own, &deck->own_capacity, deck->n_cards + 1, sizeof *deck->own));
    deck->own[deck->n_cards++] = model;
    return DALCS_OK;
}

/* What the card has of its own comes before what its model has. */
static struct dalcs_tolerances join(const struct dalcs_tolerances *own,
                                    const struct dalcs_tolerant_model *m) {
    struct dalcs_tolerances t = own != NULL ? *own : (struct dalcs_tolerances){0};
    for (int k = 0; m != NULL && k < m->n; k++) {
        t.dev = t.dev.token == NULL ? m->value[k].dev : t.dev;
        t.lot = t.lot.token == NULL ? m->value[k].lot : t.lot;
    }
    return t;
}

static enum dalcs_status set_element(struct dalcs_tolerant *all, struct dalcs_card *card,
                                     const struct dalcs_tolerances *t,
                                     const struct dalcs_tolerant_model *m) {
    struct dalcs_language *language = all->language;
    const struct dalcs_token *token = t->dev.token != NULL ? t->dev.token : t->lot.token;
    const char letter[] = {card->letter, '\0'};
    const char *device = card->token[0].text;
    bool is_there;
    int at = dalcs_card_find_value(card, &is_there); /* or it is behind a model */
    at = t->name != NULL ? t->at : is_there || m == NULL ? at : at + 1;
    double nominal;
    if (!dalcs_tolerance_nominal(language, card, at, token, &nominal)) {
        return DALCS_OK;
    }
    double value = nominal;
    if (t->dev.token != NULL) {
        value += dalcs_tolerance_size(&t->dev, nominal) *
                 dalcs_tolerance_draw_dev(all, &t->dev, device, "", device);
    }
    if (t->lot.token != NULL) {
        value += dalcs_tolerance_size(&t->lot, nominal) *
                 dalcs_tolerance_draw_lot(all, &t->lot, m != NULL ? m->lot : letter, NULL);
    }
    if (value != nominal) {
        DALCS_TRY(dalcs_card_set(language, card, at, value));
    }
    dalcs_tolerance_keep(all, device, value);
    return DALCS_OK;
}

/* DEV of an element is of its value. */
static bool check_element(struct dalcs_tolerant *all, const struct dalcs_card *card,
                          const struct dalcs_tolerances *t, int n) {
    struct dalcs_language *language = all->language;
    const struct dalcs_token *token = t->dev.token != NULL ? t->dev.token : t->lot.token;
    const char own[] = {card->letter, '\0'};
    const char *name = t->name;
    all->first = all->first != NULL ? all->first : token;
    if (strchr("rlcviefgh", card->letter) == NULL) {
        dalcs_language_report(
            language, DALCS_ERROR, NULL, token,
            card->letter == 'k' || card->letter == 'b'
                ? "write the value with mc, unif or agauss, such as {mc(0.9, 0.05)}"
                : "write it behind a parameter of the model, such as "
                  ".model dm D(vfwd=0.7 DEV=5%)",
            "'%s' has no value that could have a tolerance", card->token[0].text);
        return false;
    }
    const bool is_other = name != NULL && strcmp(name, own) != 0 && strcmp(name, "dc") != 0 &&
                          strcmp(name, "resistance") != 0 && strcmp(name, "capacitance") != 0 &&
                          strcmp(name, "inductance") != 0 && strcmp(name, "cap") != 0 &&
                          strcmp(name, "ind") != 0;
    if (is_other || n > 1) {
        dalcs_language_report(language, DALCS_ERROR, NULL, token,
                              "write it behind the value; any other value may be written with mc, "
                              "unif or agauss, such as {mc(1m, 0.2)}",
                              "a tolerance of '%s' is of its value%s%s%s", card->token[0].text,
                              is_other ? ", not of '" : ", which has one", is_other ? name : "",
                              is_other ? "'" : "");
        return false;
    }
    return true;
}

/* ---- All cards --------------------------------------------------------------------------------- */

static enum dalcs_status apply_to_element(struct dalcs_tolerant *all, size_t k) {
    struct dalcs_language *language = all->language;
    struct dalcs_card card = language->deck->own[k];
    unsigned char few[64];
    struct dalcs_tolerances *own = NULL;
    int n;
    const bool ok = dalcs_tolerances_take(language, &card, &own, &n) &&
                    (n == 0 || check_element(all, &card, own, n));
    language->deck->own[k] = card;
    if (!ok) {
        return DALCS_OK;
    }
    unsigned char *role =
        card.n <= (int)sizeof few ? few : dalcs_arena_alloc(language->arena, (size_t)card.n, 1);
    if (role == NULL) {
        return DALCS_E_NOMEM;
    }
    memset(role, DALCS_ROLE_VALUE, (size_t)card.n);
    dalcs_roles(&card, role);
    const int at = model_token(all, &card, role);
    const struct dalcs_tolerant_model *m =
        at > 0 ? &all->model[dalcs_names_find(&all->models, card.token[at].text)] : NULL;
    enum dalcs_status status = DALCS_OK;
    if (is_passive(&card) && (n > 0 || (m != NULL && m->n > 0))) {
        const struct dalcs_tolerances t = join(n > 0 ? own : NULL, m);
        status = set_element(all, &card, &t, m);
    } else if (n > 0) {
        status = set_element(all, &card, own, NULL);
    } else if (m != NULL && !is_passive(&card) && dalcs_tolerance_model_has_dev(m)) {
        status = give_model(all, &card, at, m);
    }
    language->deck->own[k] = card; /* which may have moved */
    return status;
}

static enum dalcs_status apply_to_models(struct dalcs_tolerant *all) {
    struct dalcs_deck *deck = all->language->deck;
    for (size_t k = 0; k < all->n_models; k++) {
        struct dalcs_card *card = &deck->own[all->model[k].card];
        if (dalcs_tolerance_passive_type(card) == '\0' && all->model[k].is_used) {
            struct dalcs_card made = *card;
            DALCS_TRY(dalcs_tolerance_set_model(all, &all->model[k], NULL, &made));
            *card = made;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_tolerances_apply(struct dalcs_language *language) {
    struct dalcs_deck *deck = language->deck;
    struct dalcs_tolerant all = {.language = language, .n_functions = deck->n_drawn};
    const size_t n_cards = deck->n_cards; /* models of single devices come behind them */
    enum dalcs_status status = DALCS_OK;
    for (size_t k = 0; k < n_cards; k++) {
        const struct dalcs_card *card = &deck->own[k];
        if (card->letter == '.' && card->n > 2 && strcmp(card->token->text, ".model") == 0) {
            (void)dalcs_tolerance_take_model(&all, k);
        }
    }
    for (size_t k = 0; k < n_cards && status == DALCS_OK; k++) {
        if (deck->own[k].letter != '.') {
            status = apply_to_element(&all, k);
        }
    }
    if (status == DALCS_OK) {
        status = apply_to_models(&all);
    }
    if (all.first != NULL && !language->drawing.has_runs) {
        dalcs_language_report(language, DALCS_NOTE, NULL, all.first,
                              ".mc 100 draws them, .wcase looks for the worst case",
                              "tolerances (DEV, LOT) count in runs of .mc and .wcase only");
    }
    dalcs_names_finish(&all.models);
    dalcs_names_finish(&all.listed);
    free(all.model);
    return status == DALCS_OK && language->out_of_memory ? DALCS_E_NOMEM : status;
}
