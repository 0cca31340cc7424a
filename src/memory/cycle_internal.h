/* cycle_internal.h - what is known of a cycle. Private to cycle.c and cycle_leap.c. */
#ifndef DALCS_CYCLE_INTERNAL_H
#define DALCS_CYCLE_INTERNAL_H

#include "affine.h"
#include "cycle.h"

/* Spans of a period, and doubles of all conditions on its start, at most. */
enum { DALCS_CYCLE_MOST_SEGMENTS = 32, DALCS_CYCLE_MOST_DOUBLES = 1 << 16 };

struct dalcs_cycle_segment {
    struct dalcs_stage_brief *brief;
    struct dalcs_leap_moment began;
    struct dalcs_affine_rows last;      /* states at its end */
    struct dalcs_affine_rows condition; /* what must not be negative */
    bool is_composed; /* the following are known, of the period that begins with it */
    struct dalcs_affine_rows period_last;
    struct dalcs_affine_quads period_condition; /* in parts of the states' scales */
    int n_events;
    struct dalcs_leap_event *event; /* of that period */
};

struct dalcs_cycle {
    double period; /* s; 0: there is none */
    int at;        /* the present one */
    int in_a_row;  /* segments that recurred, up to the present one */
    int n;
    bool is_closed; /* they have come back to the first */
    int n_taken;    /* of those whose rows are known: one after the other, in the next period */
    struct dalcs_cycle_segment segment[DALCS_CYCLE_MOST_SEGMENTS];
    uint64_t *mode;    /* [DALCS_CYCLE_MOST_SEGMENTS][n_words] */
    double *tail;      /* [n_in - n_x] inputs of all steps that are no states */
    double *x, *later; /* [n_x] work, as are these */
    double *near, *most;
    int waits, patience;
    struct dalcs_leap leap;
};

#endif
