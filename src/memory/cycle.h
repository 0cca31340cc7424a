/* cycle.h - whole periods of the switches' commands in which nothing but states change are leapt over.
 *
 * Where every span between two commands recurs (recurrence.h), a period takes the states to those of the next
 * by one affine map, and all that a span is looked at for, its errors, its states and its guards, are affine
 * functions of the states at the period's start as well. As long as these are positive, period after
 * period is taken by that map alone: a converter on its way to its steady state, or in it. What ends that
 * is a row that is due, an edge of a source, or states at which a function may get near to 0; there segments
 * are looked for as always.
 *
 * Of a component that is the only one to step, whose commanded switches all follow PULSEs of one period. */
#ifndef DALCS_CYCLE_H
#define DALCS_CYCLE_H

#include "radau_state.h"

/* Where one segment of a period ends and the next begins: some commands move at once, but for rounding of their
 * times, and the first one's counts. */
enum { DALCS_MOST_MOVES = 8 };

struct dalcs_leap_moment {
    int n_moves;

    struct {
        const struct dalcs_command *command;
        int way; /* commands.h */
        long n;  /* of its move in the first of the periods */
    } move[DALCS_MOST_MOVES];
};

/* s; in the k-th of the periods. */
static inline double dalcs_leap_time(const struct dalcs_leap_moment *m, long k) {
    double time = dalcs_command_time(m->move[0].command, m->move[0].way, m->move[0].n + k);
    for (int i = 1; i < m->n_moves; i++) {
        double other = dalcs_command_time(m->move[i].command, m->move[i].way, m->move[i].n + k);
        time = other < time ? other : time;
    }
    return time;
}

/* What changed sides in each of the periods that were leapt over. */
struct dalcs_leap_event {
    const struct dalcs_leap_moment *moment;
    int pair;
    bool is_on;
};

struct dalcs_leap {
    const struct dalcs_system *system;
    long n_periods, n_steps; /* steps: of all */
    int n_events;
    const struct dalcs_leap_event *event; /* [n_events] of a period, in order; owned by the cycle */
};

/* r->cycling, the part that may have a cycle, and its part->memory.cycle; NULL where there is none: then the
 * functions below are not called. */
enum dalcs_status dalcs_cycle_setup(struct dalcs_radau *r) DALCS_MUST_CHECK;

void dalcs_cycle_finish(struct dalcs_radau_part *part);

/* The present segment has just begun: it recurred, or the cycle has ended. */
enum dalcs_status dalcs_cycle_note(const struct dalcs_radau *r,
                                   struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* Puts the present segment off by as many periods as it can be so that it begins before `until` (s), but by
 * no more than about `most_steps`. Only while part->cycles. *leap: NULL where that is none. */
enum dalcs_status dalcs_cycle_leap(struct dalcs_radau *r, double until, long most_steps,
                                   const struct dalcs_leap **leap) DALCS_MUST_CHECK;

/* Segments of a period, and s. */
int dalcs_cycle_n_segments(const struct dalcs_cycle *cycle);
double dalcs_cycle_period(const struct dalcs_cycle *cycle);

/* [n_x][n_x + 1] with which the present segment begins a period on, as a function of those with which it begins. Just after
 * a leap. */
const double *dalcs_cycle_map(const struct dalcs_radau_part *part);

/* Where a leap of at most so many periods would lead to, which then are stepped all the same, so that the two can be
 * compared: the states x[n_x] with which the present segment begins at *t (s; INFINITY: no leap). */
enum dalcs_status dalcs_cycle_try(const struct dalcs_radau *r, double until, long most_periods,
                                  double *x, double *t) DALCS_MUST_CHECK;

#endif
