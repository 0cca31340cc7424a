/* refusal.h - a problem without a solution, seen on the circuit: which loop is driven or which part is
 * fed, and a sentence that says so. */
#ifndef DALCS_REFUSAL_H
#define DALCS_REFUSAL_H

#include "session_internal.h"

struct dalcs_refusal {
    struct dalcs_session *s;
    const struct dalcs_circuit *circuit;
    const struct dalcs_osnsp *osnsp; /* the problem */
    enum dalcs_witness_kind kind;
    size_t n_elements; /* of the witness; in a loop then in its order */
    const char **element;
    bool *is_named;  /* [n_devices] those elements */
    double time;     /* s, since when */
    bool is_certain; /* a contradiction has been confirmed; else no solution was found, no more */
    bool is_static;  /* no capacitor carries current, no coil has a voltage */
    bool is_from;    /* the problem was just behind `time`; else at it */
    double *value;   /* [n_stimuli] in the problem */
    double *shown;   /* [n_stimuli] at `time` */
    const char *because; /* the sentence */
};

/* A part of a loop, passed from one node to the other. */
struct dalcs_loop_arc {
    int device; /* ~k for the k-th .ic that is held */
    int from, to;
    double gain; /* V, what it adds to the drive */
};

/* The witness's elements as one loop that the sources drive, from the strongest source on:
 * arc[at most 2 (n_elements + n_initial_conditions)]. *n_arcs is 0 where it is no single loop of two-terminal
 * elements, as with transformers. */
enum dalcs_status dalcs_driven_loop_find(const struct dalcs_refusal *refusal,
                                         struct dalcs_loop_arc *arc, int *n_arcs) DALCS_MUST_CHECK;

/* A part of the circuit that current sources charge or discharge, with no other way for this current. */
struct dalcs_fed_part {
    bool found;
    bool is_filled; /* else drained */
    bool *contains; /* [n_nodes] */
    double net;     /* A, into it */
    double *into;   /* [n_devices] A, of the current sources that cross into it */
    bool *blocks;   /* [n_devices] between the part and the rest, and blocks such a current */
    int n_sources, n_blockers;
};

/* The arrays belong to the session's arena. */
enum dalcs_status dalcs_fed_part_find(const struct dalcs_refusal *refusal,
                                      struct dalcs_fed_part *part) DALCS_MUST_CHECK;

/* Sets refusal->because and puts the elements in order. Without memory the sentence is shorter. */
void dalcs_refusal_explain(struct dalcs_refusal *refusal);

/* May a run have a solution that begins without an operating point? Not where a loop of sources, or of coils that no
 * switch opens, or a part without a capacitor has none. */
bool dalcs_refusal_is_of_start(const struct dalcs_refusal *refusal);

#endif
