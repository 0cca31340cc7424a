/* recurrence.h - a span that recurs is stepped at once.
 *
 * In a converter with a fixed duty cycle the same pairs change sides again and again, and each time it is as
 * long until the next edge. Once it has been so often enough, a step is as long as that span, and where
 * its error, its states and its guards are far from what would need a closer look, it is the segment.
 *
 * Where a diode's current that dies out ends the span, or it begins with such an event, no two are of the same length.
 * But one step is enough, the same each time: where one guard falls plainly and no other comes near to 0, the
 * segment ends there, else at the next edge.
 *
 * If it is not so, nothing has happened, and a segment is looked for as always. */
#ifndef DALCS_RECURRENCE_H
#define DALCS_RECURRENCE_H

#include "radau_state.h"

/* After dalcs_transition_guess, which knew what follows. *holds: the segment is there, up to limit (s), an edge, or
 * to an event before it. */
enum dalcs_status dalcs_recurrence_try(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       double limit, bool *holds) DALCS_MUST_CHECK;

/* After pairs changed sides, one step has been accepted; the transition is known. */
void dalcs_recurrence_note(struct dalcs_radau_part *part);

/* What such a step is held to at a state: how large it may become, and its drift; in the present mode. */
void dalcs_recurrence_limits(const struct dalcs_radau_part *part,
                             const struct dalcs_stage_brief *step, int x, double *most_last,
                             double *most_drift);

/* The present segment, which recurred, has another state in part->in. */
void dalcs_recurrence_begin(struct dalcs_radau_part *part);

/* The states of the present segment, which recurred, at its end; NULL: part->segment.out has them. */
const double *dalcs_recurrence_end(const struct dalcs_radau_part *part);

/* Fills part->segment.out, or part->segment.out_before, which is computed on demand: few segments have rows. */
void dalcs_recurrence_complete(struct dalcs_radau_part *part);
void dalcs_recurrence_complete_before(struct dalcs_radau_part *part);

#endif
