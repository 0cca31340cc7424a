/* envelope.h - .env: a run of many periods of the sources, most of which are not run.
 *
 * Where states x change slowly from period to period, x_{n+1} = Phi(x_n), a few periods determine the others: with
 * F = Phi(x) - x and M = dPhi/dx,
 *
 *     F_{j+1} = M F_j + g + j h,    x_{j+1} = x_j + F_j
 *
 * is exact, with h = 0, while the map is linear and what else moves it, such as a ramp of a source, is straight: fast
 * modes that die away are in M, so that a leap may be as long as the slow ones allow. g follows from two periods in a
 * row, and so does h, by how M has changed from one to the other. */
#ifndef DALCS_ENVELOPE_H
#define DALCS_ENVELOPE_H

#include "steady.h"

/* The recurrence of one system of n states, at one period. */
struct dalcs_envelope_leap {
    int n;
    double *
        B; /* [n + 2][n + 2] column after column: (M, g, h; 0, 1, 0; 0, 1, 1) to the power of 2^level */
    double *S; /* [n + 2][n + 2] the sum of all lower powers */
    double *work;
    double *F; /* [n + 2] F, 1 and j = 0 */
};

/* Room for n states, in the arena. */
bool dalcs_envelope_leap_setup(struct dalcs_envelope_leap *leap, struct dalcs_arena *arena, int n);

/* B and S over 2^level periods, of M[n][n], g[n], h[n] and F[n]. */
void dalcs_envelope_leap_make(struct dalcs_envelope_leap *leap, const double *M, const double *g,
                              const double *h, const double *F, int level);

/* by[n] that x changes by over the leap; then[n] = F behind it. */
void dalcs_envelope_leap_go(const struct dalcs_envelope_leap *leap, double *by, double *then);

/* error[n] in x of an F that is off by off[n] at the end, and by as much less as it is nearer to the start. */
void dalcs_envelope_leap_error(const struct dalcs_envelope_leap *leap, const double *off,
                               double *error);

/* ---- envelope_sources.c ------------------------------------------------------------------------- */

/* Sources that do not repeat: PWL, and pulses that end, which are as good as PWL; EXP and sines that die away or end. In a
 * run of one period each is the part of itself there. All periods are run in which one of the latter two goes on. */
struct dalcs_envelope_sources {
    struct dalcs_run *run;
    double period; /* s */
    double delay;  /* s, the longest of those that repeat */
    int n;
    int *index;                   /* [n] in the circuit */
    struct dalcs_stimulus *whole; /* [n] */
    struct dalcs_arena arena;
};

/* Before the period is looked for: they are levels then. What grows for ever is refused. */
enum dalcs_status dalcs_envelope_sources_setup(struct dalcs_envelope_sources *s,
                                               struct dalcs_run *r) DALCS_MUST_CHECK;
void dalcs_envelope_sources_finish(struct dalcs_envelope_sources *s);

/* The circuit's sources become those of period n. */
enum dalcs_status dalcs_envelope_sources_take(struct dalcs_envelope_sources *s,
                                              long n) DALCS_MUST_CHECK;

/* The first period from n on in which one of them turns a corner, or is curved. */
long dalcs_envelope_sources_next_corner(const struct dalcs_envelope_sources *s, long n);

/* The run. */
struct dalcs_envelope {
    struct dalcs_run *run;
    struct dalcs_steady st;
    struct dalcs_envelope_sources sources;
    bool has_pass; /* st.at to st.then is the period at n */
    double tolerance;
    long n, n_all; /* periods: where st.at is; the last one, which is written */
    long n_G; /* the second of the two periods that G is of; 0: it is not known since a corner */
    double apart; /* periods that at.more is over; INFINITY: it is not known since a corner */
    int level;    /* the next leap is over 2^level periods */
    struct dalcs_envelope_leap *leap; /* [n_systems] */
    double *M;                        /* of the first of two periods */
    bool *closed;                     /* [n_pairs] at the base */

    struct dalcs_envelope_rows {
        const struct dalcs_sink *to;
        struct dalcs_sink sink; /* of the run of one period */
        bool has_begun;
        double offset, stop; /* s */
    } rows;

    struct { /* [n_x] each */
        double *F, *G, *g, *h, *expected, *off, *error, *scale;
        double *base; /* where a leap begins */
        double *more; /* that G gains each period, as it was found last */
        double *turn; /* that `more` gains each period */
        double *work;
    } at;

    struct dalcs_arena arena;
};

/* ---- envelope_asked.c --------------------------------------------------------------------------- */

/* The card that a message is about, or NULL. */
const struct dalcs_location *dalcs_envelope_place(const struct dalcs_run *r);

/* ---- envelope_rows.c ---------------------------------------------------------------------------- */

/* What the run of one period hands its rows to. */
void dalcs_envelope_rows_setup(struct dalcs_envelope *e);

/* The run of one period from there, or of what is left of the last one; with all its rows, or that at its beginning.
 * from NULL: the beginning, which e->st.at is the end of. */
enum dalcs_status dalcs_envelope_write(struct dalcs_envelope *e, double duration, bool all,
                                       const struct dalcs_orbit_point *from) DALCS_MUST_CHECK;

/* ---- envelope_leaps.c --------------------------------------------------------------------------- */

/* The map of period n from st.at. *fails: its run does. */
enum dalcs_status dalcs_envelope_pass(struct dalcs_envelope *e, long n,
                                      bool *fails) DALCS_MUST_CHECK;

/* Has every switch come back to where it was before the last pass? */
bool dalcs_envelope_returns(const struct dalcs_envelope *e);

/* The last pass is the first one of those that leaps are made of, or another one behind it. */
void dalcs_envelope_note(struct dalcs_envelope *e, bool is_first);

/* From st.at at period n, whose pass is the last one that was noted: over no more than `most` periods. *by: 0, none is
 * made. */
enum dalcs_status dalcs_envelope_try_leaps(struct dalcs_envelope *e, long n, long most,
                                           long *by) DALCS_MUST_CHECK;

#endif
