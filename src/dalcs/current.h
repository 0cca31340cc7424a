/* current.h - the current through a device as a linear function of its system's columns and inputs.
 * Private to src/dalcs. */
#ifndef DALCS_CURRENT_H
#define DALCS_CURRENT_H

#include "assemble.h"

struct dalcs_current {
    int n_terms, n_inputs;
    struct dalcs_probe_term *term; /* [n_terms + n_inputs], columns first; in the arena */
};

/* From the first to the second node of `device`, which is part of *system. Once all devices of the
 * system have their columns. */
enum dalcs_status dalcs_layout_current(const struct dalcs_layout *layout,
                                       const struct dalcs_system *system, int device,
                                       struct dalcs_arena *arena,
                                       struct dalcs_current *current) DALCS_MUST_CHECK;

#endif
