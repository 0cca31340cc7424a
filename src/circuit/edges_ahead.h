/* edges_ahead.h - the next edge of several stimuli. What each one said is kept: to find the next edge of a formula takes a
 * search, and between two stops of a run most of them have none. */
#ifndef DALCS_EDGES_AHEAD_H
#define DALCS_EDGES_AHEAD_H

#include "dalcs.h"
#include "stimulus.h"

/* Its next edge after any time in [from, to) is `to`. */
struct dalcs_edge_ahead {
    const struct dalcs_stimulus *of;
    bool is_known; /* beforehand: nothing is written to it while a run goes on */
    double from, to;
};

struct dalcs_edges_ahead {
    int n;
    struct dalcs_edge_ahead *edge;
};

/* `most`: how many stimuli will be added. Zero-initialise what is not set up; to finish it does nothing. */
enum dalcs_status dalcs_edges_ahead_setup(struct dalcs_edges_ahead *ahead,
                                          size_t most) DALCS_MUST_CHECK;
/* The same with all of an array added. */
enum dalcs_status dalcs_edges_ahead_of_all(struct dalcs_edges_ahead *ahead,
                                           const struct dalcs_stimulus *first,
                                           int n) DALCS_MUST_CHECK;
void dalcs_edges_ahead_finish(struct dalcs_edges_ahead *ahead);

void dalcs_edges_ahead_add(struct dalcs_edges_ahead *ahead, const struct dalcs_stimulus *of);

/* The first edge strictly after t of any of them, INFINITY when there is none. */
double dalcs_edges_ahead_after(struct dalcs_edges_ahead *ahead, double t);

#endif
