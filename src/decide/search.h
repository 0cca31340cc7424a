/* search.h - what to do about a step that does not hold: the search for a segment from one point.
 *
 * segment.c tries a step. What is said here changes the mode, the state or the length of the next one, or, where all
 * of that fails, takes a step of implicit Euler instead (*done). */
#ifndef DALCS_SEARCH_H
#define DALCS_SEARCH_H

#include "radau_state.h"
#include "step_error.h"

/* Of a state that is off by what shorter steps do not mend: within what it is put on its mode. */
enum dalcs_settling {
    DALCS_SETTLES_WITHIN_OWN,  /* the tolerance of its own scale */
    DALCS_SETTLES_LATER,       /* it is off by more: a shorter step may show a transient */
    DALCS_SETTLES_WITHIN_UNIT, /* none has: the tolerance of the largest of its unit */
    DALCS_SETTLED
};

/* The search for a segment from one point. */
struct dalcs_search {
    double limit;    /* s: edge, command or stop */
    int first_level; /* where the ladder stood */
    int asked_level; /* where a search begins anew after the circuit was asked: there, or `closer` */
    bool fixed;      /* the step is given: no error control */
    int restarts, flips;

    struct dalcs_search_turns { /* of switches with hysteresis */
        int n;                  /* since the state has jumped, by what turns did */
        int jumps;              /* by such turns */
        bool any;

        enum dalcs_turning {
            DALCS_TURN_ALONE,
            DALCS_TURN_TOGETHER, /* more than one have, at once */
            DALCS_TURN_ONE_BY_ONE
        } how;
    } turns;

    bool guessed; /* the mode is one remembered from the last time, or that of a front */
    bool front;   /* the latter */
    int refined;  /* times that a step was shortened for the signs at its start */
    bool closer;  /* micro-steps have looked for a mode that lasts for a small part of the step */
    int flips_closer;
    int rested; /* answers, and one, after which comparisons at equality were put on the side that is written for it */

    enum dalcs_ties {
        DALCS_TIES_STAND,  /* nobody has looked at tied diodes */
        DALCS_TIES_TURNED, /* those have changed sides whose values tell where they go */
        DALCS_TIES_SHARED  /* all have been closed, for there may be many answers */
    } ties;

    bool opened; /* they are on their other sides now, to try */
    bool projected;
    bool
        jumps; /* a state would, in the mode of the last step, by what no problem has told: the mode is wrong */
    enum dalcs_settling settling;
    bool states_free; /* in the mode of the last step, which has nothing to project on */

    struct dalcs_search_errors { /* of steps in a row */
        int stuck;               /* so many are no better for being shorter */
        double before;           /* of the last one, over what is allowed */
        int level;               /* where the first of them stood */
        bool spared;             /* those of states alone count */
    } errors;
};

/* The error is too large for this step. */
enum dalcs_status dalcs_search_recover(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       struct dalcs_search *search,
                                       const struct dalcs_step_quality *quality,
                                       bool *done) DALCS_MUST_CHECK;

/* The mode is wrong from the start: asks the circuit, then tries the other sides. Unless it may be the
 * polynomial that is wrong there, as a shorter step will tell. unit[2]: V, A. */
enum dalcs_status dalcs_search_change_mode(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                           struct dalcs_search *search, const double *unit,
                                           bool *done) DALCS_MUST_CHECK;

/* By micro-steps: the mode, and where that is not all, the state (restart.c). */
enum dalcs_status dalcs_search_ask(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   struct dalcs_search *search, bool mode_only) DALCS_MUST_CHECK;

/* See projection.h. */
enum dalcs_status dalcs_search_project(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       struct dalcs_search *search, bool *moved) DALCS_MUST_CHECK;

/* A guess that was wrong: the search begins without it. */
enum dalcs_status dalcs_search_refuse(struct dalcs_radau_part *part,
                                      struct dalcs_search *search) DALCS_MUST_CHECK;

/* A shorter step, for signs that may be those of the polynomial alone. */
bool dalcs_search_may_refine(const struct dalcs_search *search);
enum dalcs_status dalcs_search_refine(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      struct dalcs_search *search) DALCS_MUST_CHECK;

/* A diode without current and voltage: the circuit is asked which of its sides is of least norm, and
 * where it does not know yet, as at the event itself, whether it can turn. Not beyond the next event, in
 * steps. */
enum dalcs_status dalcs_search_untie(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     struct dalcs_search *search, double next,
                                     const struct dalcs_step_quality *quality) DALCS_MUST_CHECK;

/* Do states end elsewhere in a step in which tied diodes share a current than before they did? All answers of a
 * monotone circuit have the same states (Heemels, Schumacher and Weiland 1999), so this is none. */
bool dalcs_search_moves_states(const struct dalcs_radau_part *part,
                               const struct dalcs_search *search, const double *unit);

/* A tied diode that was opened to try, or closed, cannot. */
enum dalcs_status dalcs_search_tie_again(struct dalcs_radau_part *part,
                                         struct dalcs_search *search) DALCS_MUST_CHECK;

/* With the others, if any is on the other side still. */
enum dalcs_status dalcs_search_go_on_trying(struct dalcs_radau_part *part,
                                            struct dalcs_search *search) DALCS_MUST_CHECK;

/* Implicit Euler instead, for `most` at first: where a step has been accurate, it is as short. It is certified and
 * takes every event and jump that the step covers. In a row its steps double, up to a part of the ladder's: sliding
 * and accumulating events pass in few. */
enum dalcs_status dalcs_search_fall_back(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                         double limit, int level, double most) DALCS_MUST_CHECK;

#endif
