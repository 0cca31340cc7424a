/* envelope.h - .env: a run of many periods of the sources, most of which are not run.
 *
 * Where states x change slowly from period to period, x_{n+1} = Phi(x_n), a few periods tell what the others do: with
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

/* Sources that move slowly and do not repeat: PWL. In a run of one period each is the part of itself there. */
struct dalcs_envelope_sources {
    struct dalcs_run *run;
    double period; /* s */
    double delay;  /* s, the longest of those that repeat */
    int n;
    int *index;                   /* [n] in the circuit */
    struct dalcs_stimulus *whole; /* [n] */
    struct dalcs_arena arena;
};

/* Before the period is looked for: they are levels then. Others that do not repeat are refused. */
enum dalcs_status dalcs_envelope_sources_setup(struct dalcs_envelope_sources *s,
                                               struct dalcs_run *r) DALCS_MUST_CHECK;
void dalcs_envelope_sources_finish(struct dalcs_envelope_sources *s);

/* The circuit's sources become those of period n. */
enum dalcs_status dalcs_envelope_sources_take(struct dalcs_envelope_sources *s,
                                              long n) DALCS_MUST_CHECK;

/* The first period from n on in which one of them turns a corner. */
long dalcs_envelope_sources_next_corner(const struct dalcs_envelope_sources *s, long n);

#endif
