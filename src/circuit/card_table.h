/* card_table.h - the readers of the cards, and cards that are not supported. */
#ifndef DALCS_CARD_TABLE_H
#define DALCS_CARD_TABLE_H

#include "builder.h"

enum dalcs_card_class {
    DALCS_CARD_NONE, /* nothing more to do: refused, skipped or without meaning */
    DALCS_CARD_ELEMENT,
    DALCS_CARD_COUPLING,
    DALCS_CARD_MODEL,
    DALCS_CARD_TRAN,
    DALCS_CARD_PSS,
    DALCS_CARD_ENV,
    DALCS_CARD_OP,
    DALCS_CARD_DC,
    DALCS_CARD_AC,
    DALCS_CARD_SENS,
    DALCS_CARD_TRANSFER,
    DALCS_CARD_STEP,
    DALCS_CARD_MC,
    DALCS_CARD_WORST_CASE,
    DALCS_CARD_NODESET,
    DALCS_CARD_OPTIONS,
    DALCS_CARD_TEMPERATURE,
    DALCS_CARD_IC,
    DALCS_CARD_SIGNALS,
    DALCS_CARD_MEASURE,
    DALCS_CARD_FOURIER,
    DALCS_CARD_LOSSES,
    DALCS_CARD_SWITCHLOSS,
    DALCS_N_CARD_CLASSES
};

/* Zero-initialise all but builder. */
struct dalcs_card_table {
    struct dalcs_builder *builder;
    const char *block_end; /* inside a refused block: the card that ends it, else NULL */
    const char *block_begin;
    int block_depth;
    size_t n_stimuli; /* V and I, and C, which may turn into one */
    size_t n_pairs;   /* of coupled coils */
    size_t n_gates, n_gate_inputs;
    size_t n_inner; /* devices that parts of cards may become */
    size_t n_diodes;
    size_t n_scaled; /* diodes that may need a model of their own */
    size_t n_switches;
    bool has_limits; /* a model limits the current */
    bool has_series; /* a model puts Lser or Vser in series */
};

/* Call once for each card in order. Reports cards that are not supported, once for a block. */
enum dalcs_card_class dalcs_card_table_classify(struct dalcs_card_table *table,
                                                const struct dalcs_card *card);

/* ---- card_room.c ---------------------------------------------------------------------------------- */

/* Formulas on a card that names signals: each may become a source. */
size_t dalcs_card_table_count_formulas(const struct dalcs_card *card);

/* Adds what the card of an element may become. */
void dalcs_card_table_count(struct dalcs_card_table *table, const struct dalcs_card *card);

/* When all cards are classified: what diodes need whose models limit their current, and switches whose models
 * put something in series. */
void dalcs_card_table_make_room(struct dalcs_card_table *table);

/* ---- circuit_cards.c ------------------------------------------------------------------------------ */

/* Reads all cards of the deck, whose classes these are, pass by pass. */
enum dalcs_status dalcs_card_table_read(struct dalcs_builder *builder,
                                        const unsigned char *class_of);

#endif
