/* drawn.c - what is drawn in one run of the netlist, and where. */
#include "language.h"
#include "number.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { USUAL_SEED = 1 };

static bool is_word(const struct dalcs_card *card, int k, const char *word) {
    return k < card->n && card->token[k].kind == DALCS_TOKEN_WORD &&
           strcmp(card->token[k].text, word) == 0;
}

/* .options seed=17; what is no whole number, its reader says. */
static void read_seed(const struct dalcs_card *card, uint64_t *seed) {
    for (int k = 1; k + 1 < card->n; k++) {
        const int at = card->token[k + 1].kind == DALCS_TOKEN_EQUAL ? k + 2 : k + 1;
        struct dalcs_number number;
        if (is_word(card, k, "seed") && at < card->n &&
            dalcs_number_parse(card->token[at].text, &number) == DALCS_NUMBER_OK &&
            number.value >= 0 && number.value <= DALCS_MOST_SEED) {
            *seed = (uint64_t)number.value;
        }
    }
}

double dalcs_deck_seed(const struct dalcs_netlist *netlist) {
    uint64_t seed = netlist->asks.has_seed ? netlist->asks.seed : USUAL_SEED;
    for (size_t k = 0; k < netlist->n_cards && !netlist->asks.has_seed; k++) {
        const struct dalcs_card *card = &netlist->card[k];
        if (is_word(card, 0, ".mc") || is_word(card, 0, ".options") ||
            is_word(card, 0, ".option") || is_word(card, 0, ".opt")) {
            read_seed(card, &seed);
        }
    }
    return (double)seed;
}

void dalcs_drawn_start(struct dalcs_language *language) {
    const struct dalcs_netlist *netlist = language->netlist;
    const struct dalcs_deck *deck = language->deck;
    language->drawing.seed = (uint64_t)dalcs_deck_seed(netlist);
    language->drawing.run = 1;
    for (size_t k = 0; k < netlist->n_cards; k++) {
        const struct dalcs_card *card = &netlist->card[k];
        const bool is_mc = is_word(card, 0, ".mc");
        const bool is_worst = is_word(card, 0, ".wcase") || is_word(card, 0, ".wc");
        language->drawing.is_worst_case = language->drawing.is_worst_case || is_worst;
        language->drawing.has_runs = language->drawing.has_runs || is_mc || is_worst;
        if (is_mc || is_worst || is_word(card, 0, ".step")) {
            language->drawing.run =
                0; /* what all runs have in common may not fail for a draw of one */
        }
    }
    for (size_t k = 0; k < deck->n_overrides; k++) {
        if (deck->override[k].kind == DALCS_OVERRIDE_RUN) {
            language->drawing.run = (uint32_t)deck->override[k].value;
            language->deck->is_step = deck->override[k].is_step;
        } else if (deck->override[k].kind == DALCS_OVERRIDE_CORNER) {
            language->drawing.corner = &deck->override[k];
        }
    }
}

/* Of an element its name and which word; of another card all that is before it, as there is no name. */
static uint64_t key_of(const struct dalcs_draw_place *p) {
    uint64_t hash = dalcs_draw_hash(dalcs_draw_hash_start, p->scope->name);
    if (p->card == NULL) {
        return dalcs_draw_hash(dalcs_draw_hash(hash, ".param"), p->parameter);
    }
    const bool has_name = p->card->letter != '.';
    for (int k = 0; k < (has_name ? 1 : p->at); k++) {
        hash = dalcs_draw_hash(hash, p->card->token[k].text);
    }
    const char at[] = {(char)('0' + (p->at >> 12 & 63)), (char)('0' + (p->at >> 6 & 63)),
                       (char)('0' + (p->at & 63)), '\0'};
    return has_name ? dalcs_draw_hash(hash, at) : hash;
}

static const char *name_of(struct dalcs_language *language, const struct dalcs_draw_place *p);

/* Of value k of a place, by its name in .wcase. */
static uint64_t key_of_value(uint64_t key, uint32_t k) {
    char text[16];
    snprintf(text, sizeof text, "%u", (unsigned)k);
    return k == 0 ? key : dalcs_draw_hash(key, text);
}

double dalcs_drawn_place(struct dalcs_language *language, uint64_t key, uint32_t k) {
    const struct dalcs_override *corner = language->drawing.corner;
    if (corner != NULL) {
        const uint64_t sought = key_of_value(key, k);
        for (size_t i = 0; i < corner->n_list; i++) {
            if (corner->key[i] == sought) {
                return 0.5 + corner->list[i] / 2;
            }
        }
    }
    return corner != NULL || language->drawing.run == 0
               ? 0.5
               : dalcs_draw_uniform(language->drawing.seed, language->drawing.run, key, k);
}

void dalcs_drawn_list(struct dalcs_language *language, uint64_t key, const char *name,
                      bool is_lot) {
    struct dalcs_deck *deck = language->deck;
    if (!language->drawing.is_worst_case) {
        return;
    }
    if (name == NULL || dalcs_grow(&deck->draw, &deck->draw_capacity, deck->n_draws + 1,
                                   sizeof *deck->draw) != DALCS_OK) {
        language->out_of_memory = true;
        return;
    }
    deck->draw[deck->n_draws++] = (struct dalcs_draw){name, key, is_lot};
}

/* What is drawn is of a value, or one of several of it. */
static void list_next(struct dalcs_language *language, uint64_t key) {
    const uint32_t k = language->drawing.place.n;
    const char *name =
        language->drawing.is_worst_case ? name_of(language, &language->drawing.place) : NULL;
    if (name != NULL) {
        name = k > 0 ? dalcs_language_text(language, "%s:%u", name, (unsigned)k + 1) : name;
        dalcs_drawn_list(language, key_of_value(key, k), name, false);
    }
}

double dalcs_drawn_next(struct dalcs_language *language, dalcs_draw *draw, const double *x, int n) {
    const bool is_wanted = language->drawing.run > 0 || language->drawing.is_worst_case;
    const uint64_t key = is_wanted ? key_of(&language->drawing.place) : 0;
    const double u = dalcs_drawn_place(language, key, language->drawing.place.n);
    list_next(language, key);
    language->drawing.place.n++;
    return draw(x, n, u);
}

struct dalcs_draw_place dalcs_drawn_enter(struct dalcs_language *language,
                                          struct dalcs_draw_place place) {
    const struct dalcs_draw_place before = language->drawing.place;
    language->drawing.place = place;
    return before;
}

/* "r1", "l1(rser)", "dmod(vfwd)", ".ic(a)": the word before = says what it is. */
static const char *name_of(struct dalcs_language *language, const struct dalcs_draw_place *p) {
    const char *field = NULL;
    if (p->card == NULL) {
        return dalcs_scope_flat_name(language, p->scope, false, p->parameter);
    }
    for (int k = p->at - 1; k > 0 && field == NULL; k--) {
        const bool is_set = p->card->token[k].kind == DALCS_TOKEN_EQUAL;
        field = is_set && p->card->token[k - 1].kind == DALCS_TOKEN_WORD
                    ? p->card->token[k - 1].text
                    : NULL;
        if (!is_set && p->card->token[k].kind != DALCS_TOKEN_OPEN) {
            break;
        }
    }
    const int named = p->card->letter == '.' && is_word(p->card, 0, ".model") ? 1 : 0;
    const char *name = dalcs_scope_flat_name(language, p->scope, false, p->card->token[named].text);
    const bool is_value = field != NULL && field[0] == p->card->letter && field[1] == '\0';
    return name == NULL || field == NULL || is_value
               ? name
               : dalcs_language_text(language, "%s(%s)", name, field);
}

/* A card that draws several values has several of its name. */
static const char *tell_apart(struct dalcs_language *language, const struct dalcs_card *card,
                              const char *name) {
    const struct dalcs_deck *deck = language->deck;
    int n = 1;
    for (size_t k = deck->n_drawn; card != NULL && k > 0 && deck->drawn[k - 1].card == card; k--) {
        const size_t length = strlen(name);
        const char *known = deck->drawn[k - 1].name;
        n += strncmp(known, name, length) == 0 && (known[length] == '\0' || known[length] == ':');
    }
    return n > 1 ? dalcs_language_text(language, "%s:%d", name, n) : name;
}

void dalcs_drawn_keep(struct dalcs_language *language, const char *name, double value) {
    struct dalcs_deck *deck = language->deck;
    if (!language->drawing.has_runs) {
        return;
    }
    if (name == NULL || dalcs_grow(&deck->drawn, &deck->drawn_capacity, deck->n_drawn + 1,
                                   sizeof *deck->drawn) != DALCS_OK) {
        language->out_of_memory = true;
        return;
    }
    deck->drawn[deck->n_drawn++] = (struct dalcs_drawn){.name = name, .value = value};
}

void dalcs_drawn_leave(struct dalcs_language *language, struct dalcs_draw_place before,
                       const double *value) {
    const struct dalcs_draw_place place = language->drawing.place;
    struct dalcs_deck *deck = language->deck;
    language->drawing.place = before;
    deck->has_random_formula = deck->has_random_formula || place.n > 0;
    if (place.n == 0 || value == NULL) {
        return;
    }
    const char *name = name_of(language, &place);
    name = name != NULL ? tell_apart(language, place.card, name) : NULL;
    if (name == NULL || dalcs_grow(&deck->drawn, &deck->drawn_capacity, deck->n_drawn + 1,
                                   sizeof *deck->drawn) != DALCS_OK) {
        language->out_of_memory = true;
        return;
    }
    deck->drawn[deck->n_drawn++] = (struct dalcs_drawn){name, place.card, *value};
}
