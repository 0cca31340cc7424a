/* recorder.h - from the engine's answers to rows of signals; events and jumps are in its log.
 *
 * Rows appear on a schedule of output times; between steps a signal is interpolated linearly. */
#ifndef DALCS_RECORDER_H
#define DALCS_RECORDER_H

#include "event_log.h"
#include "rows.h"

struct dalcs_schedule {
    enum dalcs_schedule_kind {
        DALCS_EVERY_STEP, /* from `start` on */
        DALCS_ON_GRID,    /* start + k * step, and the stop time */
        DALCS_AT_TIMES    /* the listed times */
    } kind;

    double start, step, stop;
    const double *at; /* [n_at] ascending, borrowed */
    size_t n_at;
    size_t next; /* grid point or list entry to come */
};

struct dalcs_recorder {
    const struct dalcs_network *network;
    const struct dalcs_sink *sink;
    struct dalcs_schedule schedule;
    double *now, *before; /* [n_outputs] at the end and the beginning of the step */
    double *row;          /* work [DALCS_MOST_ROWS * n_outputs]: what is handed on */
    int n_shown;          /* the first outputs, which rows have: all, unless set after the setup */
    bool have_before;
    bool starts_on_edge; /* `before` is what was before an edge at t = 0 */
    int n_watched;       /* outputs whose largest value in all rows is recorded */

    struct dalcs_watched {
        int output;
        double sign;        /* 1, or -1: the lowest value is wanted, its sign turned */
        double largest, at; /* not below 0; s */
    } * watched;            /* borrowed */

    struct dalcs_event_log log;
    struct dalcs_arena arena;
};

enum dalcs_status dalcs_recorder_setup(struct dalcs_recorder *r,
                                       const struct dalcs_network *network,
                                       const struct dalcs_sink *sink,
                                       const struct dalcs_schedule *schedule, bool keep,
                                       size_t limit) DALCS_MUST_CHECK;

void dalcs_recorder_finish(struct dalcs_recorder *r);

/* At the operating point before an edge at t = 0: a row of its own, and the modes to compare with. */
enum dalcs_status dalcs_recorder_before_start(struct dalcs_recorder *r,
                                              const struct dalcs_euler *e) DALCS_MUST_CHECK;

/* After the start: the row at t = 0 and the modes to compare with. */
enum dalcs_status dalcs_recorder_start(struct dalcs_recorder *r,
                                       const struct dalcs_euler *e) DALCS_MUST_CHECK;

/* After a step: the rows due in (t_before, t]. */
enum dalcs_status dalcs_recorder_step(struct dalcs_recorder *r,
                                      const struct dalcs_euler *e) DALCS_MUST_CHECK;

/* After crossing a discontinuity: a second row at t. */
enum dalcs_status dalcs_recorder_cross(struct dalcs_recorder *r,
                                       const struct dalcs_euler *e) DALCS_MUST_CHECK;

/* For a run that says itself where it is, with values exact at any time: the next time a row is due,
 * INFINITY when none is. */
double dalcs_recorder_due(const struct dalcs_recorder *r);

/* The next rows that are due more than `near` before `until`, after so many: their times into due[most]; how
 * many. */
int dalcs_recorder_list_due(const struct dalcs_recorder *r, int after, double until, double near,
                            double *due, int most);

/* Should there be rows at edges and on both sides of events, besides the due ones, at time t? */
bool dalcs_recorder_wants_sides(const struct dalcs_recorder *r, double t);

/* A row at time t, the first of `rows`, of all outputs; is_due: the one that was due. */
enum dalcs_status dalcs_recorder_row(struct dalcs_recorder *r, const struct dalcs_rows *rows,
                                     double t, bool is_due) DALCS_MUST_CHECK;

/* Rows at these times: the first n of `rows`; n_due of them are the next that are due. */
enum dalcs_status dalcs_recorder_rows(struct dalcs_recorder *r, const struct dalcs_rows *rows,
                                      const double *time, int n, int n_due) DALCS_MUST_CHECK;

/* Every output's present value. */
void dalcs_recorder_evaluate(const struct dalcs_network *network, const struct dalcs_euler *e,
                             double *value /* [n_outputs] */);

/* One output's. */
double dalcs_recorder_signal(const struct dalcs_network *network, const struct dalcs_euler *e,
                             int output);

/* Every state's present value, by element. */
void dalcs_recorder_states(const struct dalcs_network *network, const struct dalcs_euler *e,
                           double *value /* [n_states] */);

#endif
