/* twins.h - diodes in parallel that obey the same law change sides together.
 *
 * Their reverse voltages are one and the same, so where one conducts the others have neither current nor
 * voltage, or a share of its current. By the least norm they all have one; but which of them close is
 * rounding's choice where there is next to no current yet, behind an event or at a start from rest, and so is
 * which of them open first. Only in a passive system of no more than DALCS_MANY_PAIRS pairs: there what one
 * does the others may do. */
#ifndef DALCS_TWINS_H
#define DALCS_TWINS_H

#include "radau_state.h"

enum dalcs_status dalcs_twins_setup(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* What crossed changes sides (guards.h), and its twins with it. */
void dalcs_twins_flip(struct dalcs_radau_part *part);

/* Closes the twins of what has a current in the present step. false: they are, or there are none. */
bool dalcs_twins_close(struct dalcs_radau_part *part, const double *unit);

#endif
