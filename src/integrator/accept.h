/* accept.h - a step that holds becomes a segment. Private to src/integrator. */
#ifndef DALCS_ACCEPT_H
#define DALCS_ACCEPT_H

#include "search.h"

/* A step that has been tried. */
struct dalcs_trial {
    struct dalcs_stage_entry *entry;
    struct dalcs_step_quality quality;
    bool holds;
    double next; /* where it ends to hold, in steps */
    bool done;   /* there is a segment, this or another one */
};

enum dalcs_status dalcs_trial_accept(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     const struct dalcs_search *search,
                                     const struct dalcs_trial *trial) DALCS_MUST_CHECK;

#endif
