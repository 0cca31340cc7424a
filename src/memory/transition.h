/* transition.h - the mode and the step that followed the last such change of pairs.
 *
 * In a converter the same switch opens again and again, and the same diode takes over. What was found
 * out once, the mode and a length of step that suits its beginning, is tried first the next time, and
 * has to pass like any other guess. Where just this has not been before, as in a chain in which one diode
 * after the other closes, the length is, on factors, that of the last time that a pair closed, or opened. */
#ifndef DALCS_TRANSITION_H
#define DALCS_TRANSITION_H

#include "radau_state.h"

/* A length that may come back, and is then stepped at once; see recurrence.h. */
struct dalcs_recurring {
    double length;                   /* s, the last time; 0: none */
    int times;                       /* in a row that it was the same */
    int patience;                    /* until it is tried at once; 0: not looked at yet */
    struct dalcs_stage_brief *brief; /* a step as long; NULL: none yet */
};

struct dalcs_transition {
    bool is_known;
    int level;
    struct dalcs_recurring span; /* from it to the next edge */
    struct dalcs_recurring step; /* that was enough up to what came then */
    int step_level;              /* of the ladder, on which `step` was found */
};

enum dalcs_status dalcs_transition_setup(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

void dalcs_transition_finish(struct dalcs_radau_part *part);

/* At a fresh point, after pairs changed sides: takes the mode and the level of the ladder that
 * followed from the one that held and the present one. false: none is known, and no more than the level
 * changed. */
bool dalcs_transition_guess(struct dalcs_radau_part *part);

/* That of the longest step that suited the beginning of the present mode when another change led to it, if it is
 * longer than that of the part. */
int dalcs_transition_longest_level(const struct dalcs_radau_part *part);

/* The guess holds, and its step may be longer the next time by `spare` rungs. */
void dalcs_transition_pass(struct dalcs_radau_part *part, int spare);

/* The guess did not pass: back to what was before it. */
void dalcs_transition_refuse(struct dalcs_radau_part *part);

/* What the latest guess was taken from, or what was learned instead of it. */
struct dalcs_transition *dalcs_transition_known(const struct dalcs_radau_part *part);

/* It is counted from here how often `length` (s; 0: none) recurs, and the step of the one before is let go. */
void dalcs_transition_count(struct dalcs_radau_part *part, struct dalcs_recurring *recurring,
                            double length);

/* After a guess of false: the segment holds with the part's level, `tried` was the first that was tried,
 * and the error promises steps longer by so many rungs. */
void dalcs_transition_began(struct dalcs_radau_part *part, int tried, int promised);

/* The present mode is what followed, and `level` the step to begin with. */
enum dalcs_status dalcs_transition_learn(struct dalcs_radau_part *part, int level) DALCS_MUST_CHECK;

#endif
