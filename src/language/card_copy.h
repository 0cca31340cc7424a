/* card_copy.h - copies of cards for the flat netlist. */
#ifndef DALCS_CARD_COPY_H
#define DALCS_CARD_COPY_H

#include "status.h"

struct dalcs_item;
struct dalcs_language;
struct dalcs_scope;

/* Appends the card of `item` as `scope` has it to the deck, which owns the copy. A card that cannot stand there or whose
 * values cannot be known is reported; only memory that is out is a status. */
enum dalcs_status dalcs_card_copy(struct dalcs_language *language, struct dalcs_scope *scope,
                                  struct dalcs_item *item) DALCS_MUST_CHECK;

#endif
