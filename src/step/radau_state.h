/* radau_state.h - a component on its way through time: what it is made of, the present segment, and what is known;
 * and the run that has several of them. */
#ifndef DALCS_RADAU_STATE_H
#define DALCS_RADAU_STATE_H

#include "commands.h"
#include "euler.h"
#include "stage_brief.h"
#include "stages.h"

/* Why a segment ends. */
enum dalcs_radau_end {
    DALCS_END_OF_STEP,
    DALCS_END_AT_EVENT,
    DALCS_END_AT_EDGE /* or at a command, or where the search for one goes on */
};

/* Components with more pairs than this are large: what is looked up for each pair in each mode would cost too much. */
enum { DALCS_MANY_PAIRS = 64 };

/* Spans between commands that maps are made for: one PULSE has two. */
enum { DALCS_SPANS = 4 };

/* A step from t of length h in one mode, which holds from t to t_end. */
struct dalcs_part_segment {
    long number; /* no other segment of the part has it, nor this one before it was cut short */
    double t, h; /* s */
    double end;  /* in steps */
    double t_end;
    enum dalcs_radau_end why;
    bool jumped;     /* at t, when the segment began */
    bool anew;       /* something happened there: an event, an edge, a command */
    bool by_euler;   /* the segment is a step of implicit Euler, or is extrapolated from some */
    bool is_coarse;  /* then: nobody controls its error */
    bool open;       /* its mode leaves something open, and nobody was told */
    double ratio;    /* the error of the step over what is allowed, up to 1 */
    double rounding; /* of out, over that of a dense map */
    double *in, *out;
    double *in_before, *out_before; /* the segment before, which ended there, in its steps */
    double end_before;
    /* Entries by which out and out_before are still to be filled; NULL: they are (recurrence.h) */
    struct dalcs_stage_entry *late, *late_before;
    const struct dalcs_stage_brief
        *brief;                      /* that made the present segment; NULL: it did not recur */
    struct dalcs_stage_entry *entry; /* that gave out, where guards are looked at */
};

/* How long a step is: step_length.h. */
struct dalcs_part_length {
    double rung;          /* s, of level 0 */
    int level;            /* h = rung 2^-level */
    int held_level;       /* of the step before; what is refused may be shortened to that */
    int level_before;     /* a guess of a transition */
    int waited, patience; /* steps since the length changed; until a longer one is tried anyhow */
    bool grew;            /* the present length is such a try */
    double longest;       /* s, step worth trying */
    double
        longest_needed; /* s; with longer ones segments are no longer, for something ends them all */
    int n_spans;        /* between two commands, that steps are fitted to: step_length.h */
    double span[DALCS_SPANS]; /* s */
    int tries;                /* falls back to implicit Euler in a row */
    double fell_back;         /* s, length of the last */
    double slide;             /* s, of a step along a threshold; 0: none so far */
    double
        slide_rounding; /* of currents of pairs in it, over what is allowed: shorter ones have as much */
    double slide_until; /* s, a time that the present slide does not reach */
    int slides_kept;    /* segments of it since their length last changed */
    int slides_patient; /* so many are kept before a longer one is tried, whatever their error */
    long held_back;     /* steps that would have been longer, had the longest one been */
};

/* The scales of signals, and the errors of currents by rounding: step_error.h, current_error.h. */
struct dalcs_part_scales {
    double *column;    /* [n_columns] largest magnitudes so far; this and the next in whole quads */
    double *magnitude; /* [n_columns] in the present step up to magnitude_end, in steps */
    double magnitude_end;
    double unit[2];  /* V, A: the largest of each */
    double cross[2]; /* V per A, A per V: the part of one unit's scale that counts for the other */
    /* V, A: the largest that equations add, as limits of formulas do, and others may cancel. */
    double constant[2];
    /* A per V, what rounding of conductances that meet makes of nothing between them and ground. */
    double leak;
    struct dalcs_column_kinds *kinds; /* see step_scales.h */
    double *current_drift;            /* of these, in whole eights: current_error.c */
    double *current_parts;            /* [n_levered] what they are made of, at most; ditto */
};

/* Which guards are on which side of 0, and how surely: guards.h, doubt.h, tied.h. */
struct dalcs_part_guards {
    bool fresh;    /* something just happened at t: nothing is known of how pairs start */
    bool flipped;  /* and it is that pairs changed sides */
    bool bends;    /* and it is no more than an edge at which sources go on with other slopes */
    bool leaps;    /* or an edge at which sources jump */
    bool *armed;   /* [n_pairs + n_watched] was clear of 0, so that a fall is an event */
    double *bound; /* [n_pairs + n_watched] in whole quads: none is below it in the present step */
    bool
        slips; /* what crosses in the first step of a mode does so early, from no more than its doubt */
    bool may_dip; /* one in doubt is below 0 in the present step, by less than its error */
    int n_doubtful;
    int *doubtful; /* [n_pairs + n_watched] those whose bound is below 0 */
    int n_crossed;
    int *crossed; /* [n_pairs + n_watched] what ended the segment; watched behind pairs */
    bool slides;  /* micro-steps: a switch opens what closes it, and closes what opens it */
    bool
        undecided; /* a segment by implicit Euler: no position suits a switch, however short a step is */
    bool *tied; /* [n_pairs] work */
};

/* What gives the current of a pair: pair_laws.h. */
struct dalcs_part_laws {
    double *held_charge, *held_flux; /* [n_pairs] F, H: storage next to a pair */
    struct dalcs_pair_law *law;      /* [n_pairs][3] what gives the current of a pair */
    struct dalcs_pair_rate *rate;
    struct dalcs_formula_places *places; /* formula_scale.h; NULL: no formula has a kink */
    int *charging_row; /* [n_equations] of the capacitor that a current charges, -1: none */
    int *pair_row;     /* [n_pairs][2] KCL rows that its current enters, ascending, -1: ground */
    int *
        next_parallel; /* [n_pairs] the next one between the same nodes, in a ring; NULL: on maps */
    double *inductance; /* [n_equations] H, at nodes; work */
    bool reads_rates; /* does an element read what charges a capacitor, or the voltage of a coil? */
};

/* Kept from the past. It proposes a mode and a length; a step, or a bound of its own, accepts them. */
struct dalcs_part_memory {
    struct dalcs_transition *transition; /* [n_transitions], see transition.h */
    int n_transitions;
    int present_transition; /* the slot of the latest guess */
    uint64_t *transition_modes;

    struct dalcs_beginning {
        int level;            /* to begin with where no transition is known, at least */
        int waited, patience; /* times that it held; until a longer step is tried anyhow */
    } beginning[2];           /* after pairs opened; after one closed */

    int fronts_refused;     /* guesses that a front goes on, which were wrong */
    uint64_t *modes_before; /* the one that held, the one after pairs changed sides */
    long flurry;            /* events, one close upon the other, up to the last one */
    double last_event;
    struct dalcs_periodic *periodic; /* NULL: nothing can come back (periodic.h) */
    struct dalcs_cycle *cycle;       /* NULL: no period is leapt over (cycle.h) */
    bool cycles;                     /* its segments are those of a period, of which all is known */
};

/* Vectors that hold nothing between two calls. */
struct dalcs_part_work {
    double *u, *y1, *y2, *w1, *after; /* y1 and y2 in whole quads */
    double *out_tried;                /* a step put aside while the state is projected */
    double *node_w;                   /* [n_nodes][n_pairs] of a slide; NULL: no switch can slide */
    double *before; /* [n_x] the state before a jump, while the one behind is looked for */
    double *size;   /* [n_columns] how large each column is, where a clash is looked at */
    uint64_t *mode_tied, *mode_turned;
    uint64_t *mode_first;  /* of the first of two micro-steps */
    uint64_t *mode_longer; /* behind two micro-steps of twice the length */
    uint64_t *mode_before; /* of a jump of sources */
};

/* Inputs that probes read. */
struct dalcs_used_inputs {
    int n, *input; /* [n] */
};

struct dalcs_radau_part {
    struct dalcs_component *component; /* its OSNSP, and y and u when evaluated */
    int index;

    enum dalcs_radau_kind {
        DALCS_PART_ALGEBRAIC, /* no memory, nothing that changes sides: solved where asked for */
        DALCS_PART_STEPPED
    } kind;

    bool is_answered;   /* without memory: y is the one answer for u */
    double answered_at; /* s: for the last time that was asked for and has one */

    const char *because;    /* why this kind and number of stages; NULL: asked for */
    double tolerance;       /* that its waveforms are held to */
    double inner_tolerance; /* error that a step may have, over the scale of a signal */
    struct dalcs_excitation excitation;
    struct dalcs_commands commands;
    struct dalcs_stages stages;
    struct dalcs_used_inputs used;
    double *x; /* [n_x] the state at segment.t, in whole quads */
    struct dalcs_part_segment segment;
    bool waits; /* its segment has ended at segment.t, and the next one is still to begin */
    struct dalcs_part_length length;
    struct dalcs_part_scales scales;
    struct dalcs_part_guards guards;
    struct dalcs_part_laws laws;
    struct dalcs_part_memory memory;
    struct dalcs_smooth_step *smooth; /* NULL: the system has no smooth sources (smooth_step.h) */
    struct dalcs_part_work work;
    struct dalcs_arena arena; /* what has the same size during the run */
};

/* Has nobody controlled the error of the present segment? */
static inline bool dalcs_segment_is_coarse(const struct dalcs_radau_part *part) {
    return part->segment.by_euler && part->segment.is_coarse;
}

struct dalcs_radau_options {
    double tolerance;     /* largest error over each waveform's scale */
    double abstol, vntol; /* A, V: error allowed besides */
    enum dalcs_family family;
    int stages;                      /* 0: chosen */
    double fixed_step;               /* s; 0: the error is controlled */
    double max_step;                 /* s; 0: none */
    double stop;                     /* s */
    struct dalcs_stage_store *store; /* maps of runs before, and for those behind; NULL: none */
};

/* What decides sources at an instant, gates: asked where segments have ended and none has begun. */
struct dalcs_radau_decider {
    void *user;
    enum dalcs_status (*decide)(void *user, double t);
    bool is_asked; /* now: what it disturbs does not begin yet */
};

struct dalcs_radau {
    struct dalcs_euler *base;           /* components, start, what failed; borrowed */
    struct dalcs_radau_decider decider; /* decide NULL: there is none */
    struct dalcs_radau_options options;
    bool is_given; /* the states at 0 are: they need not fit together */
    int n_parts;
    struct dalcs_radau_part *part;
    int n_stepped;
    int *stepped;                     /* [n_stepped] parts that are not algebraic, ascending */
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

#endif
