/* stage_choice.h - a small system in a mode that is singular, whatever the step length.
 *
 * In a passive circuit null vectors of S have no state in them: they are those of its columns, and of its rows, of what
 * has no memory, and as many. Where sources only read, blocks follow each other (partition.h). What one reads of another
 * follows, states included, and so the null vectors of the columns are those of the blocks by themselves. With the null vectors l of the rows and as many
 * conditions c y = g, S + l c' is regular, and what it makes of the right-hand sides and l g is the solution of S with
 * these conditions, states that read what is open included. The conditions are those of the least norm
 * (least_norm.h): of the diodes, then the switches, then all unknowns. */
#ifndef DALCS_STAGE_CHOICE_H
#define DALCS_STAGE_CHOICE_H

#include "stage_workshop.h"

/* b->nullity, b->left, b->choice and b->chosen of the workshop's mode, in its present scales. */
enum dalcs_status dalcs_stage_choice_find(struct dalcs_stage_workshop *b) DALCS_MUST_CHECK;

#endif
