/* measuring_sides.h - measurements over slides. Private to this folder. */
#ifndef DALCS_MEASURING_SIDES_H
#define DALCS_MEASURING_SIDES_H

#include "measuring.h"

/* Does the formula read a slide in the present stretch, though it is not linear? */
bool dalcs_measuring_is_bent(const struct dalcs_measuring *m,
                             const struct dalcs_signal_formula *formula);

/* Is what the present stretch adds to the item made of means over the sides of a slide, though it is not linear in them? */
bool dalcs_measuring_adds_means(const struct dalcs_measuring *m, const struct dalcs_measured *item);

#endif
