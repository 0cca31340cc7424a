/* coupling.c - K: mutual inductance k sqrt(L1 L2) of two coils.
 *
 * Whether three or more coils can be coupled like this is for the equations to say (inductance.c). */
#include "builder.h"

#include <math.h>
#include <string.h>

static const char USAGE[] = "a coupling is: Kname Lfirst Lsecond k, with k from -1 to 1";

static int find_coil(struct dalcs_builder *builder, const struct dalcs_token *name) {
    const int device = dalcs_builder_find_device(builder, name);
    if (device < 0) {
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
    const int first = dalcs_names_find(&builder->pairs, pair);
    if (first >= 0) {
        dalcs_builder_error(
            builder, card_name, NULL, "'%s' and '%s' are coupled twice, first at %s",
            builder->circuit->device[inductor[0]].name, builder->circuit->device[inductor[1]].name,
            dalcs_builder_place(builder, builder->device_token[first]));
        return false;
    }
    if (dalcs_names_add(&builder->pairs, pair, place) != DALCS_OK) {
        builder->out_of_memory = true;
        return false;
    }
    return true;
}

/* Reads the coils and k; true when the coupling is complete and right. */
static bool read_coupling(struct dalcs_reader *reader, int place, struct dalcs_coupling *coupling) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *coil[2];
    for (int k = 0; k < 2; k++) {
        if (!dalcs_reader_name(reader, "the name of an inductor", &coil[k])) {
            return false;
        }
    }
    const struct dalcs_token *third = dalcs_reader_peek(reader, 0);
    if (third != NULL && third->kind == DALCS_TOKEN_WORD && dalcs_builder_letter(third) == 'l') {
        dalcs_builder_error(builder, third, "write one K for each pair of coils",
                            "coupling more than two coils at once is not supported yet");
        return false;
    }
    for (int k = 0; k < 2; k++) {
        coupling->inductor[k] = find_coil(builder, coil[k]);
    }
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "a coupling factor", &coupling->k)) {
        return false;
    }
    if (fabs(coupling->k) > 1) {
        dalcs_builder_error(builder, dalcs_reader_previous(reader), USAGE,
                            "a coupling factor of %g: its magnitude is at most 1", coupling->k);
        return false;
    }
    if (!dalcs_reader_end(reader) || coupling->inductor[0] < 0 || coupling->inductor[1] < 0) {
        return false;
    }
    if (coupling->inductor[0] == coupling->inductor[1]) {
        dalcs_builder_error(builder, coil[1], NULL, "'%s' is coupled to itself", coil[1]->text);
        return false;
    }
    return is_new_pair(builder, reader->card->token, coupling->inductor, place);
}

void dalcs_coupling_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_coupling *coupling = &circuit->coupling[circuit->n_couplings];
    const int place = builder->n_device_cards + builder->n_couplings_seen++;
    builder->device_token[place] = card->token;
    dalcs_builder_add_name(builder, card->token, place);
    coupling->name =
        dalcs_arena_copy(&circuit->arena, card->token->text, strlen(card->token->text));
    coupling->where = dalcs_builder_keep_location(builder, card->token);
    if (coupling->name == NULL) {
        builder->out_of_memory = true;
        return;
    }
    if (read_coupling(&reader, place, coupling)) {
        circuit->n_couplings++;
    }
}
