/* slips.h - cards in the place of the title, and cards without their dot. */
#ifndef DALCS_SLIPS_H
#define DALCS_SLIPS_H

#include "builder.h"

/* Is this an element that is a card whose dot is missing? */
bool dalcs_slip_lacks_dot(const struct dalcs_card *card);

/* Warns when the first line looks like a card: it is the title all the same. */
void dalcs_slip_check_title(struct dalcs_builder *builder);

#endif
