/* variation.h - how the states of a run depend on those that it starts from: V = dx(t) / dx(0).
 *
 * In a mode a segment is linear in its states, so that V passes through the same stage equations as they
 * do; what a mode projects away there is projected out of V. An event of the circuit's own comes earlier
 * or later with its guard g: with dt = -dg / g' and the derivatives f of the states before and after,
 * V grows by (f- - f+) dt (Aizerman and Gantmakher 1958; Hiskens and Pai 2000). Edges and commands of
 * sources come when they come. */
#ifndef DALCS_VARIATION_H
#define DALCS_VARIATION_H

#include "gate_variation.h"
#include "stage_columns.h"

struct dalcs_variation_rank {   /* variation_rank.c */
    dalcs_four *basis, *weight; /* [fours of directions][n_x] Q, W */
    dalcs_four *other;          /* [n_x] work */
    long failed, wait;          /* segments */
};

struct dalcs_variation_part {
    struct dalcs_radau_part *part;
    int n_x;
    int n_columns;                      /* n_x, and the numbers of gates */
    struct dalcs_gate_variation *gates; /* NULL: there are none */
    double *v;                          /* [n_columns][n_x] column after column */
    double *in, *out, *guard;           /* of one column; [n_columns] of a guard, then dt */
    struct dalcs_stage_columns four;    /* of four columns; work is NULL: steps are dense maps */
    struct dalcs_variation_rank rank;   /* with them */
    struct dalcs_orbit_rates rates;
    double *before, *after; /* [n_x] f- and f+ */
    double *y;              /* work */
    double *first, *last;   /* [n_x] derivatives of the states where the run begins and ends */
    double *moves; /* [n_x] s, how the first event of the circuit's own moves with each column */
    double moved;  /* s, when it comes; INFINITY: none has come yet */
    bool begun;    /* `first` is known */
    bool pending;  /* an event has just been passed */
    bool jumped;   /* since the last segment, in jump_mode */
    uint64_t *jump_mode;           /* [n_words] */
    bool is_exact;                 /* no step of implicit Euler, nothing that slides */
    uint64_t signature, last_mode; /* of the modes that followed each other */
};

struct dalcs_variation {
    struct dalcs_radau *radau;
    enum dalcs_status status; /* of what could not be told while the run went on */
    int n_parts;
    struct dalcs_variation_part *part;  /* [n_parts] */
    struct dalcs_gate_variation *gates; /* of the one part, where there are gates; else NULL */
    struct dalcs_arena arena;
};

/* V = 1. The run is to tell it of its segments (dalcs_variation_observer), and its gates of what they do. modes_alone:
 * no V, no more than which modes follow each other. */
enum dalcs_status dalcs_variation_setup(struct dalcs_variation *variation,
                                        struct dalcs_radau *radau, struct dalcs_logic_run *logic,
                                        const struct dalcs_logic_memory *memory,
                                        bool modes_alone) DALCS_MUST_CHECK;

void dalcs_variation_finish(struct dalcs_variation *variation);

/* For radau->base->listener.observer; user is the variation. */
struct dalcs_observer dalcs_variation_observer(struct dalcs_variation *variation);

#endif
