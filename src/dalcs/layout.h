/* layout.h - room for a layout, and lists of what goes into each component. Private to src/dalcs. */
#ifndef DALCS_LAYOUT_H
#define DALCS_LAYOUT_H

#include "assemble.h"

void dalcs_layout_finish(struct dalcs_layout *l);

enum dalcs_status dalcs_layout_setup(struct dalcs_layout *l) DALCS_MUST_CHECK;

/* Lists the members of each part, part[n_items] or -1, by a counting sort: items keep their order.
 * Those of part k are item[start[k]..start[k + 1] - 1]. The caller frees both, also on failure. */
enum dalcs_status dalcs_list_members(int n_items, const int *part, int n_parts, int **start,
                                     int **item) DALCS_MUST_CHECK;

enum dalcs_status dalcs_layout_list_held(struct dalcs_layout *l) DALCS_MUST_CHECK;

#endif
