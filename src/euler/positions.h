/* positions.h - where switches stand whose control reads the circuit, at one instant.
 *
 * Given where they stand, the one-step problem tells the mode of the diodes and the answer; given the answer, their
 * controls tell where they stand. Positions that agree with their own answer are looked for: all that want to move do,
 * until nothing changes. Where that comes to positions that have no answer, or round to where it was, they move one at
 * a time. What still has no agreement lies between the sides of a switch (sliding.h). */
#ifndef DALCS_POSITIONS_H
#define DALCS_POSITIONS_H

#include "osnsp.h"

struct dalcs_positions {
    struct dalcs_osnsp *osnsp;
    int n;
    int *pair; /* [n] switches whose control reads the circuit */
    int n_jumps;
    int *jump; /* [n_jumps] first pairs of jumps of formulas, where there are such switches */
    double *
        slack; /* [n + n_jumps] V or A: a control that is no farther beyond its threshold moves nothing */
    bool keeps;     /* switches with hysteresis stand as they are */
    bool moved;     /* the last call has moved one, if only for a while */
    bool settled;   /* and all agree with the answer */
    bool has_first; /* the positions that it began from had an answer */
    bool
        alternates; /* if not: all that want to move go to and fro, and stand otherwise in two positions, each with an answer */
    bool
        goes_on; /* a slide does, between the same two positions: p->other is the mode in the other one, a step ago */
    bool are_led;              /* so do jumps of formulas, and switches with them (led_jumps.c) */
    double *other_y, *other_w; /* then: the answer in the other one, [n_columns] and [n_pairs] */
    uint64_t *other;           /* and its mode, [n_words] */
    bool joined;               /* sliding.h */
    double *gap;               /* [n + n_jumps] between both sides, in a micro-step */
    bool *follows;             /* [n + n_jumps] it turns since another one does */
    bool *is_compared;         /* [n + n_jumps] that is known */
    bool *leads;               /* [n + n_jumps] a jump that others follow, at present */
    uint64_t *mask;            /* [n_words] bits of these switches */
    uint64_t *turned;          /* [n_words] of them, that have turned in the last call */
    uint64_t *first, *present, *mark; /* [n_words] */

    struct dalcs_slide_sides { /* of a mean */
        int *
            kin; /* [n + n_jumps] the first of those that one part of the time suits, -1: no leading one */
        int *group;     /* [n + n_jumps] of those that slide, -1: not of them */
        bool *is_other; /* [n + n_jumps] of first ones that do not: the side that they stay on */
        double *y, *w;  /* [DALCS_MOST_SIDES][n_columns], [][n_pairs] */
        double *off;    /* [2][n_columns + n_pairs] led_readers.c */
        double *w_of_y; /* [n_pairs] of the answer on one side of all */
        uint64_t *mode; /* [DALCS_MOST_SIDES][n_words] */
        uint64_t *conducted; /* [n_words] on some side */
        bool *leading;       /* [n + n_jumps] */
        int *standing;       /* [n + n_jumps] off on all sides, on some, on all */
        bool have_changed;   /* others lead than in the mean before */
        bool remember;       /* formulas that turn hold themselves: there is no mean */
        double sigma;        /* of the step */
    } sides;

    struct dalcs_tried_positions { /* one at a time */
        int n;
        uint64_t *mode; /* [][n_words], NULL: never needed so far */
    } tried;
};

/* May something stand between two positions: a switch, or a jump that leads or is led, or that diodes and smooth formulas read? */
static inline bool dalcs_positions_may_slide(const struct dalcs_positions *p) {
    return p->n > 0 || p->n_jumps > 1 ||
           (p->n_jumps == 1 && (p->osnsp->system->n_pairs > 2 || p->osnsp->smooth.newton != NULL));
}

/* Those of a system; memory of `arena`, but for what is rarely needed. */
enum dalcs_status dalcs_positions_setup(struct dalcs_positions *p, struct dalcs_osnsp *osnsp,
                                        struct dalcs_arena *arena) DALCS_MUST_CHECK;

void dalcs_positions_finish(struct dalcs_positions *p);

/* As dalcs_osnsp_solve(), with positions in p->osnsp->mode that agree with the answer, from those that are there. Where
 * none that were tried do (!p->settled) it is the answer in some of them. Not DALCS_OK: all that want to move come to
 * positions without an answer; p->osnsp->mode and its witness are such ones. */
enum dalcs_status dalcs_positions_solve(struct dalcs_positions *p, double sigma, const double *u,
                                        double *y) DALCS_MUST_CHECK;

/* Behind dalcs_positions_solve() with p->settled, where jumps between their sides lead none: does what reads them stand otherwise on
 * their sides than between them? Into p->osnsp->latches.are_read. y: the answer, which stays. */
enum dalcs_status dalcs_positions_compare_readers(struct dalcs_positions *p, double sigma,
                                                  const double *u, double *y) DALCS_MUST_CHECK;

/* Behind dalcs_positions_solve() of a step, for who takes its answer as it is: *held is a formula between its sides that what reads it
 * should follow from side to side; NULL: there is none. */
enum dalcs_status dalcs_positions_find_held(struct dalcs_positions *p, double sigma,
                                            const double *u, double *y,
                                            const char **held) DALCS_MUST_CHECK;

/* Behind it, where jumps of formulas are led (osnsp.h): the answer on one side of those that lead, if it has them there; else
 * on both, as of switches that alternate. */
enum dalcs_status dalcs_positions_part_led(struct dalcs_positions *p, double sigma, const double *u,
                                           double *y) DALCS_MUST_CHECK;

/* The same at an instant, without a step. Where none agree it is the answer in the positions that were there, if it has one. */
enum dalcs_status dalcs_positions_solve_at_rest(struct dalcs_positions *p, const double *u,
                                                double *y) DALCS_MUST_CHECK;

/* Does the answer y move the i-th switch? */
bool dalcs_positions_moves(const struct dalcs_positions *p, int i, const double *y);

/* The same where one with hysteresis remembers where it stands in `memory`, a mode, not where it stands now. */
bool dalcs_positions_moves_from(const struct dalcs_positions *p, int i, const uint64_t *memory,
                                const double *y);

/* All that the answer y moves do. Returns whether there are any: none is where they agree with it. */
bool dalcs_positions_move_all_once(struct dalcs_positions *p, const double *y);

/* The first switch that does not agree with the answer y; NULL: all do. */
const char *dalcs_positions_restless(const struct dalcs_positions *p, const double *y);

#endif
