/* euler.h - implicit Euler with a fixed step, the scheme of Brogliato 2022, eq. (3.1).
 *
 * Sources are sampled at the end of a step, and edges are landed on exactly. State jumps need no
 * special case: the step computes them. That there is one, and the values just after a discontinuity,
 * are found by solving two steps of a millionth of h from the same state and extrapolating to 0; what
 * it is, exactly, tells jumps.h. They are reported, the trajectory itself stays the scheme's. */
#ifndef DALCS_EULER_H
#define DALCS_EULER_H

#include "component.h"
#include "grid.h"
#include "jumps.h"
#include "observer.h"

/* Called when a component's state jumps: x before and after, impulses of lambda (C) and w (Wb). */
struct dalcs_euler_jump {
    double time;
    int system;
    const uint64_t *mode; /* just after */
    const double *before,
        *after;  /* [n_known] just before and after; equal where rounding alone tells them apart */
    int n_known; /* columns: the states, or all of the equations */
    const double *charge, *flux; /* [n_pairs] */
    double energy_lost;          /* J */
    double source_work;          /* J, delivered by the sources in the jump */
};

struct dalcs_euler;

/* Where an answer may be one of several: component[system]'s y and u are the present ones. */
struct dalcs_open_instant {
    double time; /* s */
    const struct dalcs_euler *engine;
    int system;
    bool at_operating_point;
    const uint64_t *mode;
    const double *w;  /* [n_pairs] V, of open pairs */
    const bool *tied; /* [n_pairs] diodes with neither current nor voltage */
    double scale[2];  /* V, A: the largest so far, or 0; smaller than their rounding is nothing */
};

/* Who is told of what. Each may be NULL. */
struct dalcs_euler_listener {
    bool detects_jumps; /* also where a circuit's own voltage moves a switch */
    void *jump_user;
    enum dalcs_status (*on_jump)(void *user, const struct dalcs_euler_jump *jump);
    void *open_user; /* *vanishes: some signal is open, but has only one value just now */
    enum dalcs_status (*on_open)(void *user, const struct dalcs_open_instant *instant,
                                 bool *vanishes);
    /* An operating point was found, before anything is said of it. */
    enum dalcs_status (*on_operating_point)(const struct dalcs_circuit *circuit,
                                            struct dalcs_euler *e);
    const struct dalcs_observer *observer; /* borrowed */

    /* A part of radau begins to try a segment of a slide; all sides of an answer at a node of it, with their `times`, at node 0
     * once. What was told of its last try is void, unless that one has been passed through. */
    void *sides_user;
    void (*on_slide_begun)(void *user, int k);
    void (*on_slide_node)(void *user, int k, const struct dalcs_observed_sides *sides,
                          const double *inputs);
};

struct dalcs_euler {
    const struct dalcs_circuit *circuit;
    const struct dalcs_network *network;
    int n_components;
    struct dalcs_component *component;
    struct dalcs_grid grid;
    double t, t_before; /* s */
    double h;           /* length of the last step */
    bool at_jump;       /* a source jumps at t: dalcs_euler_cross comes next */
    long steps;

    struct { /* of all steps so far */
        struct dalcs_certificate certificate;
        double time;
        int system;
    } worst;

    struct {                     /* where it was, after one */
        int system;              /* which component */
        double time, h;          /* s */
        bool at_operating_point; /* there; set as long as one is looked for */
        bool looks_behind;       /* or just behind the time, not in a step that ends there */
    } failure;

    struct dalcs_euler_listener listener;
    double *after, *charge, *flux; /* what micro-steps see, the largest component */

    struct {               /* of a jump: */
        double *noise;     /* [n_x] what is rounding; the caller fills it */
        double *from, *to; /* work: the columns that it is told with */
    } telling;

    struct dalcs_jumps jumps;
    struct dalcs_jump_answer jump; /* the last one */
    struct dalcs_arena arena;      /* what has the same size during the run */
};

/* Sets up for a transient with step h (s). network and circuit must outlive it. */
enum dalcs_status dalcs_euler_setup(struct dalcs_euler *e, const struct dalcs_circuit *circuit,
                                    const struct dalcs_network *network,
                                    const struct dalcs_osnsp_options *options, double h,
                                    double stop) DALCS_MUST_CHECK;

void dalcs_euler_finish(struct dalcs_euler *e);

/* Solves the operating point (sigma = 0) into every component's y. */
enum dalcs_status dalcs_euler_operating_point(struct dalcs_euler *e,
                                              bool transient_follows) DALCS_MUST_CHECK;

/* Starts at t = 0. initial[k][n_x] is the state x(0-) of component k, which may be inconsistent; y
 * becomes the values just after t = 0. NULL: the operating point in y is the start. */
enum dalcs_status dalcs_euler_start(struct dalcs_euler *e, double *const *initial) DALCS_MUST_CHECK;

/* One step: y moves to y_before, y is the answer at e->t. */
enum dalcs_status dalcs_euler_step(struct dalcs_euler *e) DALCS_MUST_CHECK;

/* At a jump of the sources: y becomes the values just after e->t; the state stays. */
enum dalcs_status dalcs_euler_cross(struct dalcs_euler *e) DALCS_MUST_CHECK;

/* Tells of a jump of component k from before[n_x] to e->jump.after: the ledger always, on_jump only if a state changes by
 * more than e->telling.noise. If no voltage does, impulses of charge are rounding and become 0; if no current does, those of flux
 * likewise. from and to[n_columns]: all columns just before and after; NULL: unknown. */
enum dalcs_status dalcs_euler_report_jump(struct dalcs_euler *e, int k, double time,
                                          const double *before, const double *from,
                                          const double *to) DALCS_MUST_CHECK;

/* Finds the jump of component k from u = (x, s) in the mode that the component has after it, into e->jump. Where the
 * networks of charge and flux (jumps.h) have an answer it is exact, else it is what two micro-steps told of it: e->after,
 * e->charge and e->flux. */
enum dalcs_status dalcs_euler_find_jump(struct dalcs_euler *e, int k,
                                        const double *u) DALCS_MUST_CHECK;

/* Calls on_open if the last answer of component k, now in its y, may be one of several. */
enum dalcs_status dalcs_euler_tell_open(struct dalcs_euler *e, int k) DALCS_MUST_CHECK;

/* 1/2 x' storage x for states [n_x], J. */
double dalcs_euler_stored_energy(const struct dalcs_system *s, const double *x);

/* 1/2 d' storage d for d = after - before, states [n_x]: what a jump dissipates, J. */
double dalcs_euler_jump_energy(const struct dalcs_system *s, const double *before,
                               const double *after);

/* J, in the thresholds of diodes that charge[n_pairs] passes; power NULL: of a system file, none. */
double dalcs_euler_jump_in_thresholds(const struct dalcs_power *power, const double *charge);

#endif
