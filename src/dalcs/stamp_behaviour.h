/* stamp_behaviour.h - sources with a formula, and their pairs. Private to src/dalcs. */
#ifndef DALCS_STAMP_BEHAVIOUR_H
#define DALCS_STAMP_BEHAVIOUR_H

#include "stamp.h"

/* Inputs that the behaviour needs beside those of V and I. */
int dalcs_behaviour_n_inputs(const struct dalcs_behaviour *behaviour);

/* The columns of a source with a formula, its rows and its pairs: when it is met, and what its formula
 * says once every device of the component has its columns. */
enum dalcs_status dalcs_stamp_behaviour_branch(struct stamps *b, int device) DALCS_MUST_CHECK;
enum dalcs_status dalcs_stamp_behaviour(struct stamps *b, int device) DALCS_MUST_CHECK;

#endif
