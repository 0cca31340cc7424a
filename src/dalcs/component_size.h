/* component_size.h - the number of unknowns of each sort in a component. Private to src/dalcs. */
#ifndef DALCS_COMPONENT_SIZE_H
#define DALCS_COMPONENT_SIZE_H

#include "stamp.h"

void dalcs_find_best_conductor(struct dalcs_layout *l, const struct dalcs_members *m);

/* Counts the unknowns of each sort in the component. All offsets follow from the counts. */
void dalcs_count_unknowns(struct stamps *b, const struct dalcs_members *m, int component);

enum dalcs_status dalcs_allocate_system(struct stamps *b) DALCS_MUST_CHECK;

/* Node voltages are the first z; KCL rows: forest nodes in I, the others first in II. */
void dalcs_number_nodes(struct stamps *b, const struct dalcs_members *m);

#endif
