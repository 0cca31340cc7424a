/* history.h - what a signal was, for sources that put it out later: transmission lines and delay().
 *
 * The polynomials of the steps that are done, one behind the other. A source that is `delay` late needs of a step no
 * longer than that only what is in here, so it is known before the step is solved (Bellman's method of steps; Hairer,
 * Norsett and Wanner, Solving ODEs I, section II.17). Where the signal jumps or bends, the source has an edge later. */
#ifndef DALCS_HISTORY_H
#define DALCS_HISTORY_H

#include "stimulus.h"

#include <stddef.h>

enum { DALCS_HISTORY_NODES = 10 };

/* A step from t of length h, of which the part up to `end` (s) holds. */
struct dalcs_history_piece {
    double t, h, end;
    bool bends, jumps; /* the signal does, at t */
    double value[DALCS_HISTORY_NODES];
};

struct dalcs_history {
    double delay;                /* s, above 0 */
    double before;               /* V, until t = 0 */
    double known;                /* s, the end of the last piece; 0: there is none */
    double largest;              /* V, so far */
    double tolerance;            /* a jump or bend this part of that is none */
    int degree;                  /* of the polynomials */
    const double *node, *weight; /* [degree + 1] in steps; of the barycentric form. Borrowed */
    size_t first, n, capacity;   /* pieces before the first are no longer asked for */
    struct dalcs_history_piece *piece; /* [n] owned */
};

/* Forgets what was; from here on the signal was `before` until t = 0. */
void dalcs_history_start(struct dalcs_history *history, double before);

/* Adds a step, whose `bends` and `jumps` are found here: is_smooth: nothing happened where it begins. */
enum dalcs_status dalcs_history_add(struct dalcs_history *history,
                                    const struct dalcs_history_piece *piece,
                                    bool is_smooth) DALCS_MUST_CHECK;

void dalcs_history_finish(struct dalcs_history *history);

/* The signal as it was `delay` before t, which is no later than `known` + delay: beyond, the last polynomial goes on. */
double dalcs_history_value(const struct dalcs_history *history, double t, enum dalcs_side side);

/* The first edge after t; where what is known ends, it is one. */
double dalcs_history_next_edge(const struct dalcs_history *history, double t);

/* What the polynomial through value[degree + 1] at the nodes of a step from t of length h misses: the most at any node of the
 * pieces that are put out meanwhile, for a pulse as narrow as one of them may stand between the nodes of the step. 0 where
 * it is no more than what these pieces may be off by themselves, of which a shorter step would miss as much. */
double dalcs_history_missed(const struct dalcs_history *history, double t, double h,
                            const double *value);

bool dalcs_history_jumps_at(const struct dalcs_history *history, double t);

#endif
