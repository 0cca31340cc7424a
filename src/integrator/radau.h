/* radau.h - Radau IIA with error control over all components, events located by their polynomials.
 *
 * Each component goes its own way: from a consistent state it makes a step in its present mode, and
 * on the step's polynomials looks for the first time when the mode ends: a lambda or w that falls
 * below 0, a voltage that moves a switch. There, at edges of its sources and at commanded switches
 * the segment ends, though the step may have gone further; a new one starts. Which mode comes next is
 * first guessed (what crossed changes sides) and then certified, by a step whose lambda and w are
 * positive from the start; where that fails, two micro-steps of implicit Euler decide mode and jump.
 *
 * The loop over time is the caller's, dalcs_radau_next_stop telling where to go next. */
#ifndef DALCS_RADAU_H
#define DALCS_RADAU_H

#include "commands.h"
#include "euler.h"
#include "stage_brief.h"
#include "stages.h"

struct dalcs_radau_options {
    double tolerance;     /* largest error over each waveform's scale */
    double abstol, vntol; /* A, V: error allowed besides */
    int stages;           /* 0: chosen */
    double fixed_step;    /* s; 0: the error is controlled */
    double max_step;      /* s; 0: none */
    double stop;          /* s */
};

/* Why a segment ends. */
enum dalcs_radau_end {
    DALCS_END_OF_STEP,
    DALCS_END_AT_EVENT,
    DALCS_END_AT_EDGE /* or at a command, or where the search for one goes on */
};

/* Components with more pairs than this are large: what is looked up for each pair in each mode would be dear. */
enum { DALCS_MANY_PAIRS = 64 };

/* Spans between commands that maps are made for: one PULSE has two. */
enum { DALCS_SPANS = 4 };

/* A length that may come back, and is then stepped at once; see recurrence.h. */
struct dalcs_recurring {
    double length;                   /* s, the last time; 0: none */
    int times;                       /* in a row that it was the same */
    int patience;                    /* until it is tried at once; 0: not looked at yet */
    struct dalcs_stage_brief *brief; /* a step as long; NULL: none yet */
};

struct dalcs_radau_part {
    struct dalcs_component *component; /* its OSNSP, and y and u when evaluated */
    int index;

    enum dalcs_radau_kind {
        DALCS_PART_ALGEBRAIC, /* no memory, nothing that changes sides: solved where asked for */
        DALCS_PART_STEPPED
    } kind;

    const char *because;    /* why this kind and number of stages; NULL: asked for */
    double tolerance;       /* that its waveforms are held to */
    double inner_tolerance; /* error that a step may have, over the scale of a signal */
    struct dalcs_excitation excitation;
    struct dalcs_commands commands;
    struct dalcs_stages stages;
    double t, h; /* s: the step of the present segment */
    double end;  /* of the segment, in steps */
    double t_end;
    enum dalcs_radau_end why;
    double rung;          /* s, of level 0 */
    int level;            /* h = rung 2^-level */
    int held_level;       /* of the step before; what is refused may be shortened to that */
    int waited, patience; /* steps since the length changed; until a longer one is tried anyhow */
    bool grew;            /* the present length is such a try */
    double longest;       /* s, step worth trying */
    double
        longest_needed; /* s; with longer ones segments are no longer, for something ends them all */
    int n_spans;        /* between two commands, that steps are fitted to: step_length.h */
    double span[DALCS_SPANS]; /* s */
    int tries;                /* falls back to implicit Euler in a row */
    double fell_back;         /* s, length of the last */
    bool fresh;   /* something just happened at t: nothing is known of how pairs start */
    bool flipped; /* and it is that pairs changed sides */
    double *x;    /* [n_x] at t, in whole quads */
    double *in, *out;
    double *in_before, *out_before; /* the segment before, which ended there, in its steps */
    double end_before;
    /* Entries by which out and out_before are still to be filled; NULL: they are (recurrence.h) */
    struct dalcs_stage_entry *late, *late_before;
    const struct dalcs_stage_brief
        *brief;                      /* that made the present segment; NULL: it did not recur */
    double *out_tried;               /* a step put aside while the state is projected */
    struct dalcs_stage_entry *entry; /* that gave out, where guards are looked at */
    double ratio;                    /* the error of the step over what is allowed, up to 1 */
    double rounding;                 /* of out, over that of a dense map */
    double *scale;     /* [n_columns] largest magnitudes so far; this and the next in whole quads */
    double *magnitude; /* [n_columns] in the present step up to magnitude_end, in steps */
    double magnitude_end;
    struct dalcs_column_kinds *kinds; /* see step_error.c */
    double *current_drift;            /* of these or of pairs, in whole eights: current_error.c */
    double *current_parts;            /* [n_levered] what they are made of, at most; ditto */
    double *pair_parts;               /* [n_pairs] likewise; ditto */

    struct dalcs_lever_probe {                 /* ditto */
        const struct dalcs_stage_entry *entry; /* on factors, that was probed; NULL: none */
        double *rounding;                      /* [n_levered] V, in the drift of voltages */
        double *in, *drift;                    /* work, with out_tried */
    } probe;

    double unit_scale[2]; /* V, A: the largest of each */
    double cross[2]; /* V per A, A per V: how far the scale of one unit vouches for the other */
    /* A per V, what rounding of conductances that meet makes of nothing between them and ground. */
    double leak;
    bool *armed;   /* [n_pairs + n_watched] was clear of 0, so that a fall is an event */
    double *bound; /* [n_pairs + n_watched] in whole quads: none is below it in the present step */
    bool
        slips; /* what crosses in the first step of a mode does so early, from no more than its doubt */
    bool may_dip; /* one in doubt is below 0 in the present step, by less than its error */
    int n_doubtful;
    int *doubtful; /* [n_pairs + n_watched] those whose bound is below 0 */
    int n_crossed;
    int *crossed; /* [n_pairs + n_watched] what ended the segment; watched behind pairs */
    double *held_charge, *held_flux; /* [n_pairs] F, H: storage next to a pair; pair_laws.c */
    struct dalcs_pair_law
        *pair_law; /* [n_pairs][3] what gives the current of a pair; pair_laws.c */
    struct dalcs_pair_rate *pair_rate; /* pair_laws.h */
    int *charging_row;      /* [n_equations] of the capacitor that a current charges, -1: none */
    int *pair_row;          /* [n_pairs][2] KCL rows that its current enters, -1: ground */
    int *cluster;           /* [n_equations] work of pair_laws.c */
    double *cluster_charge; /* [n_equations] work of pair_laws.c */
    bool jumped;            /* at t, when the segment began */
    long held_back;         /* steps that would have been longer, had the longest one been */
    double seen;   /* s: of the last micro-steps, both in one mode; INFINITY: not so, or none */
    bool slides;   /* micro-steps: a switch opens what closes it, and closes what opens it */
    bool by_euler; /* the segment is a step of implicit Euler */
    bool open;     /* its mode leaves something open, and nobody was told */
    bool *tied;    /* [n_pairs] work */
    int *twin;     /* [n_pairs] the first one with the same law; NULL: nobody asked (twins.h) */
    int n_twins;   /* that another one comes before */
    double *u, *y1, *y2, *w1, *after; /* work; y1 and y2 in whole quads */
    int n_used_inputs, *used_input;   /* that probes read */

    struct dalcs_transition { /* see transition.h */
        bool is_known;
        int level;
        int untried; /* rungs up to a length that was not tried when this one was found by analogy */
        int held;    /* times that `level` did */
        struct dalcs_recurring span; /* from it to the next edge */
        struct dalcs_recurring step; /* that was enough up to what came then */
        int step_level;              /* of the ladder, on which `step` was found */
    } * transition;

    int present_transition; /* the slot of the latest guess */

    uint64_t *transition_modes;
    int level_before;
    bool tries_longer; /* the guess is a rung above what is known */

    struct dalcs_beginning {
        int level;            /* to begin with where no transition is known, at least */
        int waited, patience; /* times that it held; until a longer step is tried anyhow */
    } beginning[2];           /* after pairs opened; after one closed */

    int fronts_refused;     /* guesses that a front goes on, which were wrong */
    uint64_t *modes_before; /* the one that held, the one after pairs changed sides */
    uint64_t *mode_tied, *mode_turned;
    long crowd; /* events since `crowd_since` */
    double crowd_since;
    long flurry; /* events, one close upon the other, up to the last one */
    double last_event;
    struct dalcs_periodic *periodic; /* NULL: nothing can come back (periodic.h) */
    struct dalcs_cycle *cycle;       /* NULL: no period is leapt over (cycle.h) */
    bool cycles;                     /* its segments are those of a period, of which all is known */
    struct dalcs_arena arena;        /* what has the same size during the run */
};

struct dalcs_radau {
    struct dalcs_euler *base; /* components, start, what failed; borrowed */
    struct dalcs_radau_options options;
    int n_parts;
    struct dalcs_radau_part *part;
    struct dalcs_radau_part *cycling; /* the one that may leap; NULL: none */
    double resolution;                /* s: times nearer than this are the same */
    double
        inner_tolerance; /* what a step may be off by where a part does no better than asked for */
    double besides[2];   /* V, A: error allowed besides, of a step */
    long steps, rejected, restarts, euler_steps;
    long periodic_steps;   /* of them; periodic.h */
    long leapt_steps;      /* likewise; cycle.h */
    double worst_residual; /* of the stage equations, over their terms */
    double worst_time;     /* s */
    double wrong_sign; /* largest negative lambda or w of an accepted step, over its unit's scale */
    double wrong_time; /* s, where that step begins */
};

enum dalcs_status dalcs_radau_setup(struct dalcs_radau *r, struct dalcs_euler *base,
                                    const struct dalcs_radau_options *options,
                                    const struct dalcs_osnsp_options *osnsp) DALCS_MUST_CHECK;

void dalcs_radau_finish(struct dalcs_radau *r);

/* Starts at t = 0 from the components' states: initial[k][n_x] = x(0-), or NULL for the operating
 * point that base has solved. */
enum dalcs_status dalcs_radau_start(struct dalcs_radau *r, double *const *initial) DALCS_MUST_CHECK;

/* The earliest end of a segment; INFINITY when nothing steps. *happens: not just the end of a step. */
double dalcs_radau_next_stop(const struct dalcs_radau *r, bool *happens);

/* Ends all segments that end at t and starts the next ones. */
enum dalcs_status dalcs_radau_pass(struct dalcs_radau *r, double t) DALCS_MUST_CHECK;

/* y and u of every component at t, which lies in the present segments: the left limit at their ends,
 * the right one at their starts. Of few outputs or at many times: rows.h. */
enum dalcs_status dalcs_radau_evaluate(struct dalcs_radau *r, double t,
                                       enum dalcs_side side) DALCS_MUST_CHECK;

/* y and u of one component that steps, likewise. */
void dalcs_radau_read(struct dalcs_radau *r, int part, double t, enum dalcs_side side);

/* After a failure at t: y as far as each component came. */
void dalcs_radau_break_off(struct dalcs_radau *r, double t);

#endif
