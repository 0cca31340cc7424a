/* look_behind.h - where switches stand just behind an instant, before anything begins there. */
#ifndef DALCS_LOOK_BEHIND_H
#define DALCS_LOOK_BEHIND_H

#include "radau_state.h"

/* mode[n_words]: that of the part just behind part->segment.t, with its sources as they then are. State and mode of the part
 * stay, for what reads it may change the sources. Where nothing is found it is the mode that is there. */
enum dalcs_status dalcs_look_behind(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    uint64_t *mode) DALCS_MUST_CHECK;

#endif
