/* read_networks.c - the systems of a network, and its outputs, when its cards are read. */
#include "reader.h"
#include "reading.h"

#include <stdlib.h>
#include <string.h>

void dalcs_reading_drop_system(struct dalcs_described_system *s) {
    free(s->state);
    free(s->unknown);
    free(s->row);
    free(s->multiplier);
    free(s->input);
    for (int k = 0; k < DALCS_N_BLOCKS; k++) {
        dalcs_triplets_finish(&s->block[k].entries);
    }
}

struct dalcs_described_system *dalcs_reading_new_system(struct dalcs_reading *r,
                                                        const struct dalcs_card *card) {
    if (dalcs_grow(&r->system, &r->system_capacity, r->n_systems + 1, sizeof *r->system) !=
        DALCS_OK) {
        r->builder.out_of_memory = true;
        return NULL;
    }
    struct dalcs_described_system *s = &r->system[r->n_systems++];
    s->token = card->token;
    return s;
}

/* The system that a card belongs to: the last one, or the first. */
struct dalcs_described_system *dalcs_reading_present_system(struct dalcs_reading *r,
                                                            const struct dalcs_card *card) {
    return r->n_systems > 0 ? &r->system[r->n_systems - 1] : dalcs_reading_new_system(r, card);
}

static enum dalcs_status list_inputs(struct dalcs_reading *r, struct dalcs_described_system *s) {
    for (size_t k = 0; !s->names_inputs && k < r->n_inputs; k++) {
        DALCS_TRY(dalcs_grow(&s->input, &s->input_capacity, s->n_inputs + 1, sizeof *s->input));
        s->input[s->n_inputs++] = (int)k;
    }
    return DALCS_OK;
}

/* A system that does not use an input has nothing to do at its edges. */
static enum dalcs_status drop_unused_inputs(struct dalcs_described_system *s) {
    static const enum dalcs_block_name of_inputs[] = {DALCS_BLOCK_E_I, DALCS_BLOCK_E_II,
                                                      DALCS_BLOCK_F, DALCS_BLOCK_DIRECT_CONTROL};

    const size_t n_blocks = sizeof of_inputs / sizeof of_inputs[0];
    int *index = dalcs_alloc(s->n_inputs, sizeof *index);
    if (index == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t b = 0; b < n_blocks; b++) {
        const struct dalcs_triplets *t = &s->block[of_inputs[b]].entries;
        for (size_t k = 0; k < t->n; k++) {
            index[t->entry[k].column] = 1;
        }
    }
    int n = 0;
    for (size_t k = 0; k < s->n_inputs; k++) {
        s->input[n] = s->input[k];
        index[k] = index[k] != 0 ? n++ : -1;
    }
    s->n_inputs = (size_t)n;
    for (size_t b = 0; b < n_blocks; b++) {
        struct dalcs_triplets *t = &s->block[of_inputs[b]].entries;
        for (size_t k = 0; k < t->n; k++) {
            t->entry[k].column = index[t->entry[k].column];
        }
    }
    free(index);
    return DALCS_OK;
}

static bool check_multipliers(struct dalcs_reading *r, const struct dalcs_described_system *s) {
    for (size_t j = 0; j < s->n_multipliers; j++) {
        if (s->n_coordinates == 0 && s->multiplier[j].constraint != DALCS_NO_CONSTRAINT) {
            dalcs_builder_error(&r->builder, s->token, NULL,
                                "'%s' belongs to a system of coordinates, of which there are none",
                                s->multiplier[j].pair.element);
            return false;
        }
    }
    return true;
}

static enum dalcs_status finish_system(struct dalcs_reading *r, size_t k) {
    struct dalcs_described_system *s = &r->system[k];
    DALCS_TRY(list_inputs(r, s));
    DALCS_TRY(dalcs_reading_fill_blocks(r, s));
    if (r->builder.failed || !check_multipliers(r, s)) {
        return DALCS_OK;
    }
    if (s->n_coordinates > 0) {
        DALCS_TRY(dalcs_mechanical_to_first_order(r, s));
        if (r->builder.failed) {
            return DALCS_OK;
        }
    }
    if (!s->names_inputs) {
        DALCS_TRY(drop_unused_inputs(s));
    }
    struct dalcs_network *n = r->network;
    DALCS_TRY(dalcs_system_of_description(r, s, &n->system[k], &n->initial[k]));
    n->n_systems = (int)k + 1;
    n->jumps_are_covered[k] = s->jumps_are_covered;
    return DALCS_OK;
}

/* The systems of the network at hand. */
static enum dalcs_status finish_systems(struct dalcs_reading *r) {
    struct dalcs_network *n = r->network;
    n->system = dalcs_alloc(r->n_systems, sizeof *n->system);
    n->initial = dalcs_alloc(r->n_systems, sizeof *n->initial);
    n->jumps_are_covered = dalcs_alloc(r->n_systems, sizeof *n->jumps_are_covered);
    if (n->system == NULL || n->initial == NULL || n->jumps_are_covered == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < r->n_systems && !r->builder.failed; k++) {
        DALCS_TRY(finish_system(r, k));
    }
    return DALCS_OK;
}

static enum dalcs_status keep_outputs(struct dalcs_reading *r) {
    struct dalcs_network *n = r->network;
    n->output = dalcs_arena_alloc(&n->arena, r->n_outputs, sizeof *n->output);
    n->state = dalcs_arena_alloc(&n->arena, r->n_elements, sizeof *n->state);
    if (n->output == NULL || n->state == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < r->n_outputs; k++) {
        n->output[k] = r->output[k];
    }
    for (size_t k = 0; k < r->n_elements; k++) {
        n->state[k] = r->element[k];
    }
    n->n_outputs = (int)r->n_outputs;
    n->is_without_units = !r->has_units;
    n->n_states = (int)r->n_elements;
    r->n_outputs = 0;
    r->n_elements = 0;
    return DALCS_OK;
}

bool dalcs_reading_is_output(const struct dalcs_card *card) {
    return strcmp(card->token->text, "output") == 0 || strcmp(card->token->text, "element") == 0;
}

/* Everything between two `network` cards. */
enum dalcs_status dalcs_reading_finish_network(struct dalcs_reading *r,
                                               const struct dalcs_card *card, size_t n_cards) {
    DALCS_TRY(finish_systems(r));
    for (size_t k = 0; k < n_cards && !r->builder.failed; k++) {
        if (dalcs_reading_is_output(&card[k])) {
            dalcs_reading_take_output(r, &card[k]);
        }
    }
    if (r->network == &r->description->network && !r->builder.failed) {
        DALCS_TRY(dalcs_reading_default_outputs(r));
    }
    if (!r->builder.failed) {
        DALCS_TRY(keep_outputs(r));
    }
    for (size_t k = 0; k < r->n_systems; k++) {
        dalcs_reading_drop_system(&r->system[k]);
        r->system[k] = (struct dalcs_described_system){0};
    }
    r->n_systems = 0;
    return r->builder.out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}

/* network main|charge|flux|held */
bool dalcs_reading_begin_network(struct dalcs_reading *r, const struct dalcs_card *card) {
    struct dalcs_reader reader =
        dalcs_reader_start(&r->builder, card, "network main, charge, flux or held");
    struct dalcs_network *main = &r->description->network;
    struct dalcs_network **place[] = {&main->jump[DALCS_IMPULSE_CHARGE],
                                      &main->jump[DALCS_IMPULSE_FLUX], &main->held};
    static const char *const name[] = {"charge", "flux", "held"};
    if (dalcs_reader_take_word(&reader, "main")) {
        r->network = main;
        return dalcs_reader_end(&reader);
    }
    for (int k = 0; k < 3; k++) {
        if (*place[k] == NULL && dalcs_reader_take_word(&reader, name[k])) {
            *place[k] = dalcs_alloc(1, sizeof **place[k]);
            r->builder.out_of_memory = r->builder.out_of_memory || *place[k] == NULL;
            r->network = *place[k];
            return r->network != NULL && dalcs_reader_end(&reader);
        }
    }
    dalcs_reader_unexpected(&reader);
    return false;
}
