/* sweep_card.h - what the cards of sweeps share. Private to this folder. */
#ifndef DALCS_SWEEP_CARD_H
#define DALCS_SWEEP_CARD_H

#include "analysis_cards.h"
#include "reader.h"

/* A copy that lives as long as the circuit; NULL: out of memory. */
const char *dalcs_sweep_keep_text(struct dalcs_builder *builder, const char *text);

/* How many values there are from `first` to `last`; 0 after a message. */
bool dalcs_sweep_count_values(struct dalcs_builder *builder, const struct dalcs_token *const *place,
                              const char *usage, struct dalcs_sweep *sweep);

/* start stop step. */
bool dalcs_sweep_read_range(struct dalcs_reader *reader, const char *usage,
                            struct dalcs_sweep *sweep);

/* list value ... */
bool dalcs_sweep_read_list(struct dalcs_reader *reader, struct dalcs_sweep *sweep);

/* file=name. */
bool dalcs_sweep_read_file(struct dalcs_reader *reader, struct dalcs_sweep *sweep);

/* lin, dec or oct, if one is there. */
bool dalcs_sweep_take_spacing(struct dalcs_reader *reader, enum dalcs_spacing *spacing);

#endif
