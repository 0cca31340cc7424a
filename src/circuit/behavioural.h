/* behavioural.h - what the cards of sources with formulas share. Private to this folder. */
#ifndef DALCS_BEHAVIOURAL_H
#define DALCS_BEHAVIOURAL_H

#include "behaviour.h"
#include "element_cards.h"
#include "reader.h"

/* One more source with a formula or a table; NULL: out of memory. */
struct dalcs_formula_source *dalcs_behavioural_add_source(struct dalcs_builder *builder,
                                                          const struct dalcs_device *device);

/* A formula; `false` when an error was reported. */
bool dalcs_behavioural_read_formula(struct dalcs_reader *reader, const struct dalcs_token **token);

/* tc1=, temp= and the like behind a formula: nothing depends on a temperature. And what LTspice's steps are told there. */
bool dalcs_behavioural_skip_temperature(struct dalcs_reader *reader);

/* The end of such a card. */
void dalcs_behavioural_add_element(struct dalcs_reader *reader, struct dalcs_device *device,
                                   const struct dalcs_token *token, char quantity, double n);

/* m=, if it is there; false after a message. */
bool dalcs_behavioural_read_parallel(struct dalcs_reader *reader, double *n);

#endif
