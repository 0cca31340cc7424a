/* steady.h - the periodic steady state: Newton's method on the map of a period.
 *
 * The map Phi takes the states just before the edges at t = 0 to those just before the edges at t = T, by
 * the run that any .tran is; M = dPhi/dx comes with it (variation.h). What the search proposes is worth
 * nothing by itself: the answer is a run of one more period, audited as any other, that comes back. */
#ifndef DALCS_STEADY_H
#define DALCS_STEADY_H

#include "logic_memory.h"
#include "orbit_analyses.h"
#include "stage_store.h"

struct dalcs_logic_run;
struct dalcs_orbit_log;
struct dalcs_steady_attractor;
struct dalcs_steady_watch;

/* Where the states of the systems lie side by side. What gates remember (logic_memory.h) lies behind: numbers behind the
 * states, bits behind the pairs; all of the circuit is one system then. */
struct dalcs_steady_layout {
    int n_systems;
    int n_x, n_pairs;                 /* of all */
    int n_states, n_switches;         /* of the systems alone */
    struct dalcs_logic_memory memory; /* of no gates, too */
    int *first;                       /* [n_systems + 1] state of each */
    int *first_pair;                  /* [n_systems + 1] */
    size_t *first_of_M;               /* [n_systems + 1] of its [n][n] in M, column after column */
};

/* States and the positions of switches. */
struct dalcs_orbit_point {
    double *x;    /* [n_x] V, A; of gates V, s */
    bool *closed; /* [n_pairs] switches; bits of gates */
    const struct dalcs_steady_layout *layout;
};

enum {
    DALCS_STEADY_STEPS = 10,    /* of Newton's method in a row */
    DALCS_STEADY_PERIODS = 4096 /* of runs between bursts of them, in all */
};

struct dalcs_steady {
    struct dalcs_run *run;
    struct dalcs_steady_layout layout;
    double period;                     /* s */
    struct dalcs_orbit_point at, then; /* now, and after the pass */
    bool has_point;                    /* `at` is known; else the run starts as any does */
    struct dalcs_stage_store store;    /* maps, from pass to pass */
    double *scale;                     /* [n_x] of each state on the way */
    double *step;                      /* [n_x] the last one of Newton's method */
    double distance;                   /* how far the orbit is from `at`, over the scales */

    struct dalcs_steady_pass { /* the last one */
        double residual;       /* over the scales */
        double *M;             /* of the last one with it */
        bool is_exact;         /* M is */
        double *first, *last;  /* [n_x] derivatives of the states where that pass began and ended */
        double *
            phase; /* [n_x] how the first event of that pass moves with the state where it began; 0: there was none */
        uint64_t signature; /* of the modes that followed each other */
    } pass;

    struct dalcs_steady_found { /* by the last pass with means */
        double *average, *rms;  /* [n_outputs] */
        double *state;          /* [n_states] of the network, where it ended; the session's */
    } found;

    struct dalcs_steady_own { /* period */
        bool is_free; /* no source has one: Newton's method looks for it, too (steady_free.h) */
        bool is_free_of_events; /* and no event comes again and again */
        double longer;          /* s, what a step of the method adds to it */
        int n;                  /* directions, beside that of the flow, in which nothing decides */
    } own;

    struct dalcs_steady_count {
        int newton, bursts, leaps;
        long periods;
    } n;

    struct dalcs_steady_base {             /* where a step begins (steady_shorter.c) */
        struct dalcs_orbit_point at, then; /* and a period later */
        double *M, *scale;
        double *work, *change; /* [n_x] */
    } base;

    struct dalcs_steady_crowd { /* steady_crowd.c */
        bool is_limited;        /* while a search goes on */
        double work, most;
    } crowd;

    struct dalcs_steady_conservation { /* quantities that are conserved */
        int n;

        struct dalcs_steady_conserved {
            int system;
            double *weight; /* [n] of the system's states */
            double growth;  /* of their sum in a period; 0: it does not grow, but for rounding */
        } * of;             /* [n] */

        bool is_stuck; /* one grows by `drift` */
        double *drift; /* [n_x] what grows by as much each period */
    } kept;

    struct dalcs_arena arena;
};

enum dalcs_status dalcs_steady_setup(struct dalcs_steady *st, struct dalcs_run *r,
                                     double period) DALCS_MUST_CHECK;
void dalcs_steady_finish(struct dalcs_steady *st);

/* ---- steady_period.c --------------------------------------------------------------------------- */

/* The period of all sources, s: the smallest common one, or `asked` (0: none is) if that is one; *is_free: no source has
 * a period, and *period is what was asked for. The circuit's stimuli
 * become what they are from a multiple of it on behind all delays; those that do not repeat, what they come to, or
 * at_start what they are at t = 0. DALCS_E_OPTION: there is none, and a message says
 * why. */
enum dalcs_status dalcs_steady_find_period(struct dalcs_run *r, double asked, bool at_start,
                                           double *period, bool *is_free) DALCS_MUST_CHECK;

/* Does it come again and again, by itself? */
bool dalcs_steady_repeats(const struct dalcs_stimulus *s);

/* The element whose stimulus that is. */
const char *dalcs_steady_source_name(const struct dalcs_circuit *c, int stimulus);

/* ---- steady_settle.c --------------------------------------------------------------------------- */

/* One that repeats T-periodically becomes what it is from a multiple of T on. */
enum dalcs_status dalcs_steady_settle(struct dalcs_run *r, struct dalcs_stimulus *s,
                                      const char *name, double T) DALCS_MUST_CHECK;

/* ---- steady_pass.c ----------------------------------------------------------------------------- */

/* Further outputs of a pass. */
enum dalcs_steady_asked {
    DALCS_STEADY_PLAIN,
    DALCS_STEADY_M,    /* of all its periods */
    DALCS_STEADY_MEANS /* of the signals; not M */
};

/* n periods on from st->at to st->then. */
enum dalcs_status dalcs_steady_pass(struct dalcs_steady *st, long n,
                                    enum dalcs_steady_asked asked) DALCS_MUST_CHECK;

/* So long on (s) from st->at to st->then; the watch is told of its events. *recurs with a watch: an event has come again,
 * between *from and *to of it. A watch that is full ends the run; then st->then is nothing. */
enum dalcs_status dalcs_steady_pass_watched(struct dalcs_steady *st, double duration,
                                            struct dalcs_steady_watch *watch, bool *recurs,
                                            int *from, int *to) DALCS_MUST_CHECK;

/* Runs one period from st->at and logs it. */
enum dalcs_status dalcs_steady_log(struct dalcs_steady *st, struct dalcs_euler *e,
                                   struct dalcs_radau *radau,
                                   struct dalcs_orbit_log *log) DALCS_MUST_CHECK;

/* ---- steady_point.c ---------------------------------------------------------------------------- */

/* st->pass.residual, of the last pass. */
void dalcs_steady_find_residual(struct dalcs_steady *st);

/* Goes on from where the last pass has arrived. */
void dalcs_steady_take(struct dalcs_steady *st);

/* The start of a run at such a point; gates decide then. */
enum dalcs_status dalcs_steady_start(const struct dalcs_orbit_point *point, struct dalcs_euler *e,
                                     struct dalcs_radau *radau,
                                     struct dalcs_logic_run *logic) DALCS_MUST_CHECK;

/* Where the components are that have been evaluated at t, and what gates remember. */
enum dalcs_status dalcs_steady_read(const struct dalcs_euler *e,
                                    const struct dalcs_logic_run *logic, double t,
                                    struct dalcs_orbit_point *point) DALCS_MUST_CHECK;

/* That of gates alone. */
enum dalcs_status dalcs_steady_read_gates(const struct dalcs_logic_run *logic, double t,
                                          struct dalcs_orbit_point *point) DALCS_MUST_CHECK;

/* ---- steady_derivative.c ----------------------------------------------------------------------- */

/* st->pass.signature, ...phase, and ...M with what belongs to it. */
struct dalcs_variation;
void dalcs_steady_read_signature(struct dalcs_steady *st, const struct dalcs_variation *variation);
void dalcs_steady_read_phase(struct dalcs_steady *st, const struct dalcs_variation *variation);
void dalcs_steady_read_M(struct dalcs_steady *st, const struct dalcs_variation *variation);

/* ---- steady_crowd.c ---------------------------------------------------------------------------- */

/* While a search goes on its work is. */
void dalcs_steady_limit_crowd(struct dalcs_steady *st, bool is_limited);

/* Is a search over, as steps of implicit Euler, so far and those of a run that goes on (NULL: none does), take too long? */
bool dalcs_steady_is_crowded(const struct dalcs_steady *st, const struct dalcs_radau *radau);

/* Behind a run. */
void dalcs_steady_count_crowd(struct dalcs_steady *st, const struct dalcs_radau *radau);

/* A message, and DALCS_NOT_CONVERGED. */
enum dalcs_status dalcs_steady_tell_crowd(struct dalcs_steady *st) DALCS_MUST_CHECK;

/* ---- steady_gates.c ---------------------------------------------------------------------------- */

/* st->at becomes a point of a run, from which on gates are where they were after *n periods of the sources; 0: after no
 * number that was tried. */
enum dalcs_status dalcs_steady_find_repeats(struct dalcs_steady *st, int *n) DALCS_MUST_CHECK;

/* A note, if that is more than one. */
void dalcs_steady_note_repeats(struct dalcs_steady *st, int n);

/* ---- steady_oscillation.c ---------------------------------------------------------------------- */

/* The orbit of a circuit that oscillates by itself, as dalcs_steady_search, and st->period; guess: s, 0 for none. *rests:
 * it comes to rest, at st->at. */
enum dalcs_status dalcs_steady_oscillation(struct dalcs_steady *st, double guess, bool *found,
                                           bool *rests) DALCS_MUST_CHECK;

/* ---- steady.c ---------------------------------------------------------------------------------- */

/* A burst of Newton's method from st->at. A run that fails on the way ends it, no more. */
enum dalcs_status dalcs_steady_burst(struct dalcs_steady *st, bool *done) DALCS_MUST_CHECK;

/* Where a multiplier is near to 1 a small residual leaves the states far from the steady state: further steps, as long
 * as they help. `best` is work. */
enum dalcs_status dalcs_steady_refine(struct dalcs_steady *st,
                                      struct dalcs_orbit_point *best) DALCS_MUST_CHECK;

/* Room for one, as long as st lives; false: there is none. */
bool dalcs_steady_make_point(struct dalcs_steady *st, struct dalcs_orbit_point *point);
/* From where any run starts to *found: st->at comes back, and the last pass is from there. *endless: there is none, as
 * st->drift goes on and on. Behind more than `most` periods of runs it ends. */
enum dalcs_status dalcs_steady_search(struct dalcs_steady *st, long most, bool *found,
                                      bool *endless) DALCS_MUST_CHECK;

/* ---- steady_continuation.c --------------------------------------------------------------------- */

/* Leaps from st->at on to where Newton's method may begin again, st->at; *is_near: they have led to such a point. most_failed:
 * behind so many of them the circuit may be farther from periodic than before; then they end. */
enum dalcs_status dalcs_steady_continue(struct dalcs_steady *st, long most_failed,
                                        bool *is_near) DALCS_MUST_CHECK;

/* F, Phi(x) - x, becomes a leap of k periods: (1 + 1/k - M) d = F. */
enum dalcs_status dalcs_steady_find_leap(const struct dalcs_steady *st, const double *M, double k,
                                         double *F) DALCS_MUST_CHECK;

/* Of [n_x], in units in which energies are alike. */
double dalcs_steady_size(const struct dalcs_steady *st, const double *x);

/* ---- steady_homotopy.c ------------------------------------------------------------------------- */

/* From st->at on along the periodic states of circuits that leak less and less; *is_near: it has come to where Newton's method
 * may begin again, and the last pass, with M, is from there. */
enum dalcs_status dalcs_steady_follow(struct dalcs_steady *st, bool *is_near) DALCS_MUST_CHECK;

/* ---- steady_shorter.c -------------------------------------------------------------------------- */

/* The largest of x [n_x], each over its largest value in the last pass and that of the base. */
double dalcs_steady_relative_size(const struct dalcs_steady *st, const double *x);

/* The last pass, with M, is where a step begins. */
void dalcs_steady_note_base(struct dalcs_steady *st);

/* The last pass began behind st->step of Newton's method from there. *helped: M has held on the way. */
enum dalcs_status dalcs_steady_find_helped(struct dalcs_steady *st, bool *helped) DALCS_MUST_CHECK;

/* A shorter step from the base, and a pass with M behind it. If none is found, not *helped, st is at the base again. */
enum dalcs_status dalcs_steady_shorten(struct dalcs_steady *st, bool *helped) DALCS_MUST_CHECK;

/* ---- steady_anchor.c --------------------------------------------------------------------------- */

/* What st has found is kept, if its step is an anchor; the last pass is with M. leaves: for a .tran from there. */
enum dalcs_status dalcs_steady_anchor_keep(struct dalcs_steady *st, bool leaves) DALCS_MUST_CHECK;

/* As dalcs_steady_search, from the anchor of the step, if it has one; else, and where that leads to nothing that counts,
 * not *found, and st is as before. */
enum dalcs_status dalcs_steady_anchor_try(struct dalcs_steady *st, bool leaves, bool is_free,
                                          bool *found) DALCS_MUST_CHECK;

/* ---- periodic_ac.c ----------------------------------------------------------------------------- */

/* .ac around the orbit through st->at, into the run's sink. */
enum dalcs_status dalcs_periodic_ac_walk(struct dalcs_steady *st) DALCS_MUST_CHECK;

/* ---- steady_kept.c: what the circuit and the run are while a period of it is run ----------------- */

struct dalcs_steady_kept {
    struct dalcs_transient transient;
    struct dalcs_stimulus *stimulus; /* [n_stimuli] heap */
    double h, max_step;
};

enum dalcs_status dalcs_steady_keep(struct dalcs_run *r,
                                    struct dalcs_steady_kept *kept) DALCS_MUST_CHECK;

/* all: else the sources that repeat stay what they are behind their delays. */
void dalcs_steady_put_back(struct dalcs_run *r, const struct dalcs_steady_kept *kept, bool all);

/* The orbit of st, into its run, as long as that lasts. */
enum dalcs_status dalcs_steady_remember(const struct dalcs_steady *st) DALCS_MUST_CHECK;

/* Is there one? Then st, which is set up, is as behind the search that has found it. */
bool dalcs_steady_recall(struct dalcs_steady *st);

/* ---- steady_failure.c -------------------------------------------------------------------------- */

/* A message, and DALCS_E_OPTION. */
enum dalcs_status dalcs_steady_refuse(struct dalcs_run *r, const char *hint,
                                      const char *text) DALCS_MUST_CHECK;

/* The last pass is the last period of a search, behind which a run comes to that; endless: st->drift goes on for ever.
 * DALCS_NOT_CONVERGED. */
enum dalcs_status
dalcs_steady_tell_failure(struct dalcs_steady *st, bool endless,
                          const struct dalcs_steady_attractor *a) DALCS_MUST_CHECK;

/* dalcs_steady_oscillation; without one a message says why. */
enum dalcs_status dalcs_steady_find_oscillation(struct dalcs_steady *st,
                                                double guess) DALCS_MUST_CHECK;

/* ---- steady_run.c ------------------------------------------------------------------------------ */

/* Is a run of a period that has just ended, in st->then, where it began? */
bool dalcs_steady_returns(struct dalcs_steady *st);

/* The same; if not, DALCS_NOT_CONVERGED and a message. */
enum dalcs_status dalcs_steady_find_defect(struct dalcs_steady *st) DALCS_MUST_CHECK;

#include "steady_multipliers.h"
#include "steady_verdict.h"

#endif
