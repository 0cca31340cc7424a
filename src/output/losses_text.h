/* losses_text.h - where the power went, as a table for people. */
#ifndef DALCS_LOSSES_TEXT_H
#define DALCS_LOSSES_TEXT_H

#include "dalcs.h"

void dalcs_losses_text_write(FILE *out, const struct dalcs_losses *losses);

#endif
