/* delays.h - what delayed sources put out later is kept, segment by segment. */
#ifndef DALCS_DELAYS_H
#define DALCS_DELAYS_H

#include "radau_state.h"

/* Of a run that begins: the histories have its polynomials, and nothing was before. */
void dalcs_delays_setup(struct dalcs_radau *r, const struct dalcs_circuit *circuit);

/* The present segment of the part holds up to its end. */
enum dalcs_status dalcs_delays_note(const struct dalcs_radau *r,
                                    struct dalcs_radau_part *part) DALCS_MUST_CHECK;

#endif
