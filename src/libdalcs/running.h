/* running.h - a run: its options, and what receives its rows. Part of dalcs.h, which includes it. */
#ifndef LIBDALCS_RUNNING_H
#define LIBDALCS_RUNNING_H

#ifndef DALCS_H
#error "include dalcs.h"
#endif

enum dalcs_analysis {
    DALCS_OPERATING_POINT,
    DALCS_TRANSIENT,
    DALCS_DC_SWEEP,
    DALCS_AC,
    DALCS_PERIODIC, /* one period of a steady state */
    DALCS_TRANSFER, /* .tf */
    DALCS_N_ANALYSES
};

/* Has a plot of it one row and no scale? */
static inline bool dalcs_analysis_is_point(enum dalcs_analysis analysis) {
    return analysis == DALCS_OPERATING_POINT || analysis == DALCS_TRANSFER;
}

/* What a signal's values are in. */
enum dalcs_unit {
    DALCS_VOLT,
    DALCS_AMPERE,
    DALCS_UNIT_SECOND,
    DALCS_UNIT_HERTZ,
    DALCS_UNIT_OHM,
    DALCS_UNIT_NONE
};

/* One table of results. Borrowed: valid until the session is destroyed. */
struct dalcs_plot {
    enum dalcs_analysis analysis;
    const char *title;             /* the netlist's title line */
    const char *scale;             /* what a row is at: "time", "frequency", "v1" of .dc */
    enum dalcs_unit scale_unit;    /* s, Hz, or the unit of what .dc sweeps */
    size_t n_signals;              /* the scale not counted */
    const char *const *name;       /* [n_signals] "v(out)", "i(d1)"; of a nested .dc the outer
                                    source's value comes first, under its name */
    const enum dalcs_unit *unit;   /* [n_signals] */
    bool is_complex;               /* of .ac: a row has 2 n_signals values, re and im of each */
    size_t step, n_steps;          /* of .step: number step, from 0, of n_steps; else 0 of 1 */
    size_t n_parameters;           /* that .step changes, the innermost first */
    const char *const *parameter;  /* [n_parameters] "rload", "v1", "dmod(vfwd)" */
    const double *parameter_value; /* [n_parameters] in this step */
};

/* Receives results while they are made: for each analysis begin, rows, end, in this order: .op, .dc, .tf,
 * .pss, .ac, .tran; with .step all steps of an analysis before the next analysis. Any
 * callback may be NULL, or return a status other than DALCS_OK, which ends the run with that
 * status; end is then not called. Nor is it for a step of .step that fails: the next begin follows. */
struct dalcs_sink {
    void *user;
    enum dalcs_status (*begin)(void *user, const struct dalcs_plot *plot);
    /* `time` is the row's scale. Times ascend; two rows of equal time are the two sides of a
     * discontinuity. Values are borrowed until the callback returns. An operating point and a .tf have one row,
     * at 0. A nested .dc runs through its inner sweep again and again. Where rows are
     * left out (compress) the newest is held back: it may come after progress said to stop. */
    enum dalcs_status (*row)(void *user, double time, const double *value /* [n_signals] */);
    enum dalcs_status (*end)(void *user);
    /* Called every few thousand steps, of a large circuit more often, also while no row is due; not
     * within a step. Simulated time and stop in s; of .dc and .ac points. Return DALCS_OK to go on, DALCS_E_CANCELLED to stop: because
     * of a flag that another thread or a signal handler has set, for example. */
    enum dalcs_status (*progress)(void *user, double time, double stop);
    /* Several of a transient's rows at once, for those who want many rows fast: their times and, row after
     * row, their values. In order with those of `row`, which still gets what stands beside a
     * discontinuity or comes alone. NULL: `row` gets all. */
    enum dalcs_status (*rows)(void *user, size_t n, const double *time /* [n] */,
                              const double *value /* [n * n_signals] */);
};

/* The methods by name, the default first; NULL when index is too large. */
const char *dalcs_method_name(size_t index);

/* Bounds of the tolerance: below the first rounding decides, above the second little is left of a
 * waveform. */
#define DALCS_TOLERANCE_MIN 1e-13
#define DALCS_TOLERANCE_MAX 0.1

/* Is there a method with so many stages? Of any number, whole or not. */
#define DALCS_HAS_STAGES(n) ((n) == 1 || (n) == 3 || (n) == 5 || (n) == 7 || (n) == 9)

/* How much of a waveform is checked against the netlist's devices (doc/methods.md). */
enum dalcs_audit_mode {
    DALCS_AUDIT_SAMPLE, /* each segment by a screen, some more closely, drawn with a fixed seed */
    DALCS_AUDIT_FULL,   /* every segment */
    DALCS_AUDIT_OFF
};

/* Made by dalcs_run_options_default(). Later versions add fields at the end, and only there: a program that was built
 * with an older header has their defaults, which are 0. */
struct dalcs_run_options {
    size_t size; /* of the struct as the program knows it */
    const char
        *method; /* "auto", "radau", "lobatto" or "euler", the papers' implicit Euler; NULL: the
                           netlist's or the default */
    double tolerance;  /* of radau and auto: largest error of a waveform over its scale; 0: .options
                           reltol, else 1e-6. Small parts are held to 1e-9 where more is allowed,
                           unless stages or a fixed step are given */
    int stages;        /* of radau, auto: 1, 3, 5, 7 or 9; 0: .options stages, else chosen */
    double step;       /* s; the fixed step of euler and radau, the largest of auto; 0: .options
                           step; without either euler takes the tmax of .tran, else its tstep, and
                           radau controls its error with steps of at most tmax */
    double fill;       /* add rows where those of .tran are far apart, until curves through all are
                           this near, over each signal's largest value so far; 0: .options fill,
                           else the tolerance but at least 1e-6; INFINITY: none. At most 100,000,
                           and four for each row that there is anyway */
    const char *curve; /* which: "cubics", and lines beside events (doc/output.md), or "lines";
                           NULL: .options curve, else cubics */
    double compress;  /* leave rows out as long as straight lines through the others stay this near,
                           over each signal's scale; 0: .options compress, else keep all rows */
    const double *at; /* [n_at] ascending output times in s, none after the stop time,
                           interpolated linearly between steps by euler;
                           NULL: the .tran grid (euler: where it falls on steps, else every step),
                           both sides of every event and what fill adds */
    size_t n_at;
    bool record; /* keep events and jumps for the report */
    bool
        energy; /* keep the ledger of energies for the report; of a netlist, not of a system file */

    /* Tolerances of the certificate and of the OSNSP; see doc/output.md. All dimensionless. */
    double certificate_tolerance; /* residual over its physical scale, 2e-13 */
    double proximal_weight;       /* eps of regularised problems, 1e-8 */
    double rcond_min;   /* a mode whose 1/condition is estimated smaller is singular, 1e-14 */
    int max_outer;      /* proximal iterations, 40 */
    int max_pivots;     /* per solve, on top of twice the number of pairs, 200 */
    size_t cache_bytes; /* bound on factorisations kept over all components, 256 MiB */
    int dense_limit;    /* components up to this many unknowns use dense step maps, 64 (radau:
                              see doc/output.md); this and the bound may change the last bits of
                              results */
    size_t max_events;  /* events and jumps kept when recording, 1e6 */
    enum dalcs_audit_mode
        audit; /* of .tran, .op and .dc; a defect above the tolerance is DALCS_REFUTED */
    const char *dump_path; /* where to write an OSNSP that failed; NULL: nowhere */

    bool steady; /* the periodic steady state and nothing else, as if .pss were the only analysis */
    double period; /* s, of it; 0: that of .pss, else it follows from the sources */
    int samples; /* with steady, for each value of .step: rows are not a period, but the states once
                      in each of so many periods of a run, and the orbit of one period; 0: no */
    int settle;  /* periods that such a run takes before */

    bool bode; /* .ac around the periodic steady state and nothing else, as if there were a .pss */
    double bode_from, bode_to; /* Hz; 0: those of .ac, else 1e-4 and 1/2 of the orbit's frequency */
    int bode_points;           /* in each decade; 0: those of .ac, else 20 */
    const double *bode_at; /* [n_bode_at] Hz, ascending, > 0: these and no others; none: as above */
    size_t n_bode_at;
    const char *loop;    /* the V source in a loop whose gain is computed; NULL: .ac's, else none */
    bool loop_is_loaded; /* it is injected a current besides, as where the loop goes on takes one */
    int sideband;        /* as dalcs_report.response; 0: .ac's, else none */

    bool
        envelope; /* .env and nothing else; without one the .tran of the netlist becomes it, and sources that repeat
                      are run for a few of their periods */
    double envelope_stop; /* s, when it ends; 0: as .env or .tran say */
    const double *
        envelope_at; /* [n_envelope_at] times in s whose periods are written with all rows; none: .env's */
    size_t n_envelope_at;

    size_t only_step; /* of .step: this one alone, counted from 1; 0: all */
    size_t
        workers; /* threads that the runs of .wcase are made in; 0: 1. Callbacks come in the caller's */
};

enum { DALCS_MOST_SIDEBAND = 1000000 };

/* Writes the values named above, all else 0, into the first `size` bytes. */
void dalcs_run_options_init(struct dalcs_run_options *options, size_t size);

/* The same, by the size that this header has. Owns nothing. */
static inline struct dalcs_run_options dalcs_run_options_default(void) {
    struct dalcs_run_options options;
    dalcs_run_options_init(&options, sizeof(options));
    return options;
}

/* The same for languages that do not read this header: made, set by name, destroyed by the caller. */
enum dalcs_status dalcs_run_options_create(struct dalcs_run_options **options) DALCS_MUST_CHECK;
void dalcs_run_options_destroy(struct dalcs_run_options *options);

/* Their names, "tol" and so on as on the command line; NULL when index is too large. */
const char *dalcs_run_option_name(size_t index);

/* Text is a number ("1u", "inf"), a word of the field's ("radau", "lines", "full"), or "yes" or "no"; that of
 * "bode_loop", a name, is borrowed until the run is over. DALCS_E_OPTION: there is no such option, or that is no value of it; nothing is changed. */
enum dalcs_status dalcs_run_options_set(struct dalcs_run_options *options, const char *name,
                                        const char *text) DALCS_MUST_CHECK;

/* Output times, which are borrowed until the run is over. None at all, n = 0: no rows of .tran. */
void dalcs_run_options_set_times(struct dalcs_run_options *options, const double *at, size_t n);

/* Frequencies of .ac around a steady state (bode_at), borrowed likewise. */
void dalcs_run_options_set_frequencies(struct dalcs_run_options *options, const double *at,
                                       size_t n);

/* Runs .op, .dc, .tf, .ac and .tran, whichever the netlist has, for each .step, with options and a sink that
 * are read during the call only. DALCS_E_NETLIST: no netlist was read. DALCS_E_OPTION: a message says
 * which. What a callback returned, where that ended the run. DALCS_NOT_CONVERGED, DALCS_INFEASIBLE: the
 * messages name the time and the elements; rows already handed to the sink stay true. DALCS_REFUTED: they name the law
 * that the rows break, and where. A second run
 * replaces the report of the first. With .step the report is that of the last step that was run, but for
 * its work, measurements and failed steps, which are of all. A step that fails loses none of the others: the status is
 * that of the first one that did. */
enum dalcs_status dalcs_session_run(struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const struct dalcs_sink *sink) DALCS_MUST_CHECK;

/* Ends the run at hand with DALCS_E_CANCELLED, or where none is, the next one as it begins. The one call
 * that another thread, or a signal handler, may make while the session runs. It is served within a step, too: between one-step
 * problems and between modes of one. */
void dalcs_session_cancel(struct dalcs_session *session);

#endif
