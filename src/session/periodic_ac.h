/* periodic_ac.h - .ac around an orbit: the parts of the circuit at one frequency, and what is made of them. */
#ifndef DALCS_PERIODIC_AC_H
#define DALCS_PERIODIC_AC_H

#include "audit_periodic.h"
#include "measures.h"
#include "periodic_margins.h"
#include "periodic_response.h"
#include "steady.h"

struct dalcs_periodic_ac_part {
    struct dalcs_periodic_flow flow;
    struct dalcs_periodic_response response;
    double complex *source; /* [n_inputs] */
    bool rests;             /* no small signal reaches it, and nothing else is set up */
    double *y[2], *s[2];    /* [n_columns], [n_inputs] re and im; of sidebands sources have none */
};

struct dalcs_periodic_ac {
    struct dalcs_steady *st;
    struct dalcs_run *run;
    const struct dalcs_sweep *sweep;
    struct dalcs_sweep own_sweep; /* where the netlist has none, or another one is asked for */
    int sideband;

    struct dalcs_periodic_loop { /* the source in a loop */
        int device;              /* -1: none is asked for */
        int system, column[2];   /* of its nodes; -1: ground */
        bool is_loaded;          /* a current is injected as well, by the part below */
        int probe;               /* the current source that does */
    } loop;

    struct dalcs_margins margins;
    struct dalcs_audit_periodic audit;
    struct dalcs_response_columns *answer; /* [n_parts] of parts, for the audit */
    bool is_audited;                       /* the present frequency */
    struct dalcs_euler euler;
    struct dalcs_radau radau;
    struct dalcs_orbit_log log;
    int n_parts;
    struct dalcs_periodic_ac_part *part;
    struct dalcs_periodic_ac_part by_current; /* of the loop's system */
    double *row;                              /* [2 n_outputs] */
    double *shown;                            /* [2 n_shown + 2] with the gain of the loop last */
    const char **name;                        /* [n_shown + 1] likewise */
    enum dalcs_unit *unit;
    struct dalcs_measures measures;
    struct dalcs_arena arena;
};

/* ---- periodic_ac_setup.c ----------------------------------------------------------------------- */

/* The parts and the row. DALCS_NOT_CONVERGED, with a message: small signals are not accurate enough over a period. */
enum dalcs_status dalcs_periodic_ac_setup(struct dalcs_periodic_ac *ac) DALCS_MUST_CHECK;

/* ---- periodic_frequencies.c -------------------------------------------------------------------- */

/* The sweep, with a message where what is asked for is none. */
enum dalcs_status dalcs_periodic_frequencies_choose(struct dalcs_periodic_ac *ac) DALCS_MUST_CHECK;

/* ---- periodic_loop.c --------------------------------------------------------------------------- */

/* Which sources have a small signal: those of the netlist, or that in the loop alone. */
enum dalcs_status dalcs_periodic_loop_find(struct dalcs_periodic_ac *ac) DALCS_MUST_CHECK;

/* The small signal of a source, by its stimulus: its AC value, or 1 of the device `of` and 0 of others; of < 0: none. */
double complex dalcs_periodic_loop_source(const struct dalcs_periodic_ac *ac, int of, int stimulus);

/* Columns of the loop's system that its gain is made of. */
void dalcs_periodic_loop_mark(const struct dalcs_periodic_ac *ac, bool *is_read);

/* Of the frequency that was solved last. */
double complex dalcs_periodic_loop_gain(const struct dalcs_periodic_ac *ac);

/* Margins into the report. */
enum dalcs_status dalcs_periodic_loop_report(struct dalcs_periodic_ac *ac) DALCS_MUST_CHECK;

/* Behind the rows: which diodes small signals take to another side than the rows have it, as warnings. */
void dalcs_periodic_ac_tell(struct dalcs_periodic_ac *ac);

#endif
