/* audit_run.h - radau's segments, handed to the auditor. Of euler each step has a certificate. */
#ifndef DALCS_AUDIT_RUN_H
#define DALCS_AUDIT_RUN_H

#include "session_internal.h"

#include "audit.h"
#include "audit_delays.h"
#include "audit_gates.h"
#include "radau.h"
#include "rows.h"

#include <math.h>

struct dalcs_audit_run {
    struct dalcs_run *run;
    struct dalcs_euler *euler;
    struct dalcs_radau *radau;
    struct dalcs_audit *audit;  /* NULL: nothing is audited */
    struct audit_members *part; /* [n_systems] */
    int *stepped, n_stepped;    /* parts with segments */
    bool has_algebraic;         /* parts without memory, which are looked at beside rows */

    struct audit_rows {
        double work, share; /* of a row, in instructions; of that, what comparisons may cost */

        struct audit_row_budget {
            double earned, credit, threshold; /* instructions that comparisons may cost */
        } side[2];                            /* from each */

        double since; /* instructions of rows since the last segment ended */
        bool has_any; /* since then */
    } rows;

    struct audit_told {
        size_t n_events, n_jumps; /* of the report, up to the last instant */
        double time;              /* s, of that */
        double credit, threshold; /* instructions */
        int n_looked;
    } told;

    int *pair_of_lambda; /* [n_lambdas] in its system */

    struct audit_leaps {
        double began;      /* s */
        double *tried;     /* states that one would lead to, and work */
        double tried_time; /* s, when; INFINITY: none is tried */
        bool has_tried;    /* at least once */
        bool was_tried;    /* the next one needs no trial */
        double *passed;    /* states from which a whole period was stepped last, behind one */
        double landed;     /* s, where one ended from which a period has to be; INFINITY: none */
        bool has_passed;   /* one was compared, at least once */
    } leaps;

    bool ends_at_pole; /* of a formula, which tells more than what is broken on the way to it */
    bool was_left;     /* a segment that was looked at ended at the present time */
    struct dalcs_audit_gates gates;
    struct dalcs_audit_delays delays;
    uint64_t seed; /* of what is drawn besides by the auditor itself */
    struct dalcs_arena arena;
};

enum dalcs_status dalcs_audit_run_start(struct dalcs_audit_run *a, struct dalcs_run *run,
                                        struct dalcs_euler *euler,
                                        struct dalcs_radau *radau) DALCS_MUST_CHECK;

void dalcs_audit_run_finish(struct dalcs_audit_run *a);

/* 0 <= chance < 1, the same in each run; what the auditor draws does not depend on it. */
double dalcs_audit_run_chance(struct dalcs_audit_run *a);

/* All parts of radau have begun their first segments. */
void dalcs_audit_run_begin(struct dalcs_audit_run *a);

/* Segments that end at t, before and after they are passed; the ones that go on at the end of the run. */
void dalcs_audit_run_leave(struct dalcs_audit_run *a, double t);
void dalcs_audit_run_enter_now(struct dalcs_audit_run *a);

/* Where a segment was looked at there is something to do. */
static inline void dalcs_audit_run_enter(struct dalcs_audit_run *a) {
    if (a->was_left || (a->audit != NULL && a->leaps.tried_time < INFINITY)) {
        dalcs_audit_run_enter_now(a);
    }
}

/* Segments have been passed at t: compares the entries of the report up to t, if there are any. */
void dalcs_audit_run_told_now(struct dalcs_audit_run *a, double t);

static inline void dalcs_audit_run_told(struct dalcs_audit_run *a, double t) {
    const struct dalcs_event_log *r = &a->run->s->results.recorder.log;
    if (a->audit != NULL && (r->n_events > a->told.n_events || r->n_jumps > a->told.n_jumps)) {
        dalcs_audit_run_told_now(a, t);
    }
}

/* What the report has by now is not asked. */
void dalcs_audit_run_tell(struct dalcs_audit_run *a, double t);

/* May the cycling part leap now? Not while periods are stepped that a leap was tried over. */
enum dalcs_status dalcs_audit_run_leap(struct dalcs_audit_run *a, double until,
                                       bool *may) DALCS_MUST_CHECK;

/* A time up to `until` that the leap may go to: now and then it lands on its way, and the segment there is audited. */
double dalcs_audit_run_until(struct dalcs_audit_run *a, double until);

/* Around a leap: the states behind it are those that the power of the period's map leads to, for the time that has
 * passed. */
void dalcs_audit_run_start_leap(struct dalcs_audit_run *a);
void dalcs_audit_run_end_leap(struct dalcs_audit_run *a);

/* The recorder has handed rows on, at time[n]. */
void dalcs_audit_run_rows_now(struct dalcs_audit_run *a, const struct dalcs_recorder *recorder,
                              const double *time, enum dalcs_side side, int n);

static inline void dalcs_audit_run_rows(struct dalcs_audit_run *a,
                                        const struct dalcs_recorder *recorder, const double *time,
                                        enum dalcs_side side, int n) {
    if (a->audit == NULL) {
        return;
    }
    struct audit_row_budget *rows = &a->rows.side[side];
    a->rows.has_any = true;
    a->rows.since += a->rows.work * n;
    rows->earned += a->rows.share * n;
    rows->credit += a->rows.share * n;
    if (rows->credit >= rows->threshold || a->has_algebraic) {
        dalcs_audit_run_rows_now(a, recorder, time, side, n);
    }
}

/* Into the report. A message where a defect is more than is allowed, and DALCS_REFUTED where that ends the
 * run. */
enum dalcs_status dalcs_audit_run_report(struct dalcs_audit_run *a) DALCS_MUST_CHECK;

/* Is there a defect that is more than is allowed, and does it end the run? */
bool dalcs_audit_run_fails(const struct dalcs_audit_run *a);

/* Nothing has happened at t yet: what samples may take. */
enum dalcs_status dalcs_audit_run_sample(struct dalcs_audit_run *a, double t) DALCS_MUST_CHECK;

/* Gates have decided at t. */
enum dalcs_status dalcs_audit_run_gates(struct dalcs_audit_run *a,
                                        const struct dalcs_logic_run *logic,
                                        double t) DALCS_MUST_CHECK;

/* Between leave and enter: a part's segment ends at t, before its time. */
void dalcs_audit_run_cut(struct dalcs_audit_run *a, int part, double t);

#endif
