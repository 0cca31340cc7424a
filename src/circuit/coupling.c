/* coupling.c - K: mutual inductance k sqrt(L1 L2) of two coils, or of every two of several.
 *
 * Whether three or more coils can be coupled like this is for the equations to say (inductance.c). */
#include "element_cards.h"
#include "reader.h"
#include "storage.h"

#include <math.h>
#include <string.h>

static const char USAGE[] = "a coupling is: Kname Lfirst Lsecond [Lthird ...] k, k from -1 to 1";

/* On one card. The pairs grow as the square. */
enum { MOST_COILS = 1000 };

static int find_coil(struct dalcs_builder *builder, const struct dalcs_token *name) {
    const int device = dalcs_builder_find_device(builder, name);
    if (device < 0) {
        return -1;
    }
    if (dalcs_storage_is(builder, device)) {
        dalcs_builder_error(
            builder, name,
            "put it across a winding of coils with k = 1, or of an ideal transformer",
            "the flux of '%s' is no multiple of its current: it cannot be coupled", name->text);
        return -1;
    }
    /* An inductance of 0 became a resistor: coupling nothing. */
    if (builder->circuit->device[device].kind != DALCS_INDUCTOR) {
        dalcs_builder_error(builder, name, USAGE, "'%s' is %s, only inductors can be coupled",
                            name->text,
                            builder->circuit->device[device].letter == 'l'
                                ? "an inductor of 0 H"
                                : dalcs_builder_kind_text(builder->circuit->device[device].kind));
        return -1;
    }
    return device;
}

/* A second K of the same two coils is an error. */
static bool is_new_pair(struct dalcs_builder *builder, const struct dalcs_token *card_name,
                        const int *inductor, int place) {
    const int low = inductor[0] < inductor[1] ? inductor[0] : inductor[1];
    const int high = inductor[0] < inductor[1] ? inductor[1] : inductor[0];
    const char *pair = dalcs_builder_hint(builder, "%d %d", low, high);
    if (pair == NULL) {
        return false;
    }
    const int first = dalcs_names_find(&builder->elements.pairs, pair);
    if (first >= 0) {
        dalcs_builder_error(
            builder, card_name, NULL, "'%s' and '%s' are coupled twice, first at %s",
            builder->circuit->device[inductor[0]].name, builder->circuit->device[inductor[1]].name,
            dalcs_builder_place(builder, builder->elements.device_token[first]));
        return false;
    }
    if (dalcs_names_add(&builder->elements.pairs, pair, place) != DALCS_OK) {
        builder->out_of_memory = true;
        return false;
    }
    return true;
}

/* The coils that a card names, in the builder's scratch, -1 where there is none; NULL when an error
 * was reported. */
static int *read_coils(struct dalcs_reader *reader, int n) {
    struct dalcs_builder *builder = reader->builder;
    int *coil = dalcs_arena_alloc(&builder->scratch, (size_t)n, sizeof *coil);
    if (coil == NULL) {
        builder->out_of_memory = true;
        return NULL;
    }
    for (int k = 0; k < n; k++) {
        const struct dalcs_token *name;
        if (!dalcs_reader_name(reader, "the name of an inductor", &name)) {
            return NULL;
        }
        coil[k] = find_coil(builder, name);
        for (int j = 0; j < k && coil[k] >= 0; j++) {
            if (coil[j] == coil[k]) {
                dalcs_builder_error(builder, name, NULL, "'%s' is coupled to itself", name->text);
                return NULL;
            }
        }
    }
    return coil;
}

static bool read_factor(struct dalcs_reader *reader, double *k) {
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "a coupling factor", k)) {
        return false;
    }
    if (fabs(*k) > 1) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), USAGE,
                            "a coupling factor of %g: its magnitude is at most 1", *k);
        return false;
    }
    const struct dalcs_token *core = dalcs_reader_peek(reader, 0);
    if (core != NULL && core->kind == DALCS_TOKEN_WORD) {
        dalcs_builder_error(reader->builder, core,
                            "the values of its coils are turns: write henries and no core, or a "
                            "coil that saturates, L1 a b Hc=16 Bs=0.44 Br=0.1 A=1e-4 Lm=0.1 N=100",
                            "the core '%s' is not supported", core->text);
        return false;
    }
    return dalcs_reader_end(reader);
}

int dalcs_coupling_count_coils(const struct dalcs_card *card) {
    const int first = card->n > 1 && card->token[1].kind == DALCS_TOKEN_OPEN ? 2 : 1;
    int n = 0;
    while (n + first < card->n && card->token[n + first].kind == DALCS_TOKEN_WORD &&
           dalcs_builder_letter(&card->token[n + first]) == 'l') {
        n++;
    }
    return n < 2 || n > MOST_COILS ? 2 : n;
}

static void add_pair(struct dalcs_builder *builder, const struct dalcs_token *card_name, int place,
                     struct dalcs_coupling coupling) {
    struct dalcs_circuit *circuit = builder->circuit;
    if (coupling.inductor[0] >= 0 && coupling.inductor[1] >= 0 &&
        is_new_pair(builder, card_name, coupling.inductor, place)) {
        circuit->coupling[circuit->n_couplings++] = coupling;
    }
}

void dalcs_coupling_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_coupling coupling = {.where = dalcs_builder_keep_location(builder, card->token)};
    const int place = builder->elements.n_device_cards + builder->elements.n_couplings_seen++;
    builder->elements.device_token[place] = card->token;
    dalcs_builder_add_name(builder, card->token, place);
    coupling.name = dalcs_arena_copy(&circuit->arena, card->token->text, strlen(card->token->text));
    if (coupling.name == NULL) {
        builder->out_of_memory = true;
        return;
    }
    const int n = dalcs_coupling_count_coils(card);
    const bool opened = dalcs_reader_take(&reader, DALCS_TOKEN_OPEN); /* K1 (L1 L2) 0.9 */
    const int *coil = read_coils(&reader, n);
    if (coil != NULL && opened && !dalcs_reader_take(&reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(&reader, "')'");
        return;
    }
    const struct dalcs_token *next = dalcs_reader_peek(&reader, 0);
    if (coil != NULL && next != NULL && next->kind == DALCS_TOKEN_WORD &&
        dalcs_builder_letter(next) == 'l') {
        dalcs_builder_error(builder, next, NULL, "one card couples %d coils at most", MOST_COILS);
        return;
    }
    if (coil == NULL || !read_factor(&reader, &coupling.k)) {
        return;
    }
    for (int i = 0; i < n; i++) {
        for (int j = i + 1; j < n && !builder->out_of_memory; j++) {
            coupling.inductor[0] = coil[i];
            coupling.inductor[1] = coil[j];
            add_pair(builder, card->token, place, coupling);
        }
    }
}
