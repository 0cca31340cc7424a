/* coil_groups.h - coils that couplings join. Private to src/dalcs. */
#ifndef DALCS_COIL_GROUPS_H
#define DALCS_COIL_GROUPS_H

#include "assemble.h"

/* Groups of coils that couplings join, each split into independent and dependent ones. */
enum dalcs_status dalcs_coil_groups_find(struct dalcs_layout *l,
                                         struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
