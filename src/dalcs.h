/* dalcs.h - the public interface of libdalcs.
 *
 * A session holds one netlist: read it, run it, ask for results. Nothing is global: two sessions
 * may live in two threads, one session belongs to one thread at a time. Every call that can fail
 * returns an enum dalcs_status; what a person should read about a failure is in the session's
 * messages.
 *
 * Units are SI throughout: seconds, volts, amperes, coulombs, webers.
 */
#ifndef DALCS_H
#define DALCS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#pragma GCC visibility push(default) /* all else in the library is hidden */
#endif

/* The number of this interface, and of the library's file: libdalcs.so.1. It is raised when a program
 * that was built with an older header could not go on with a newer library. */
#define DALCS_ABI 1

/* 0 is success, > 0 a numerical failure that a smaller step may cure, < 0 is final. */
#define DALCS_STATUS_LIST(ENTRY)                                                                   \
    ENTRY(DALCS_OK, 0, "ok")                                                                       \
    ENTRY(DALCS_SINGULAR, 1, "singular matrix")                                                    \
    ENTRY(DALCS_NOT_CONVERGED, 2, "no certified solution of the one-step problem was found")       \
    ENTRY(DALCS_INFEASIBLE, 3, "the one-step problem has no solution")                             \
    ENTRY(DALCS_REFUTED, 4, "the audit finds a law broken")                                        \
    ENTRY(DALCS_E_NOMEM, -1, "out of memory")                                                      \
    ENTRY(DALCS_E_IO, -2, "input/output error")                                                    \
    ENTRY(DALCS_E_NETLIST, -3, "error in the netlist")                                             \
    ENTRY(DALCS_E_OPTION, -4, "invalid option")                                                    \
    ENTRY(DALCS_E_LIMIT, -5, "problem too large")                                                  \
    ENTRY(DALCS_E_CANCELLED, -6, "cancelled")                                                      \
    ENTRY(DALCS_E_INTERNAL, -7, "internal error")

enum dalcs_status {

#define DALCS_STATUS_ENUM(name, value, text) name = (value),
    DALCS_STATUS_LIST(DALCS_STATUS_ENUM)
#undef DALCS_STATUS_ENUM
};

#if defined(__GNUC__)
#define DALCS_MUST_CHECK __attribute__((warn_unused_result))
#else
#define DALCS_MUST_CHECK
#endif

/* A short English phrase for a status; never NULL, do not free it. */
const char *dalcs_status_text(enum dalcs_status status);

/* "0.1.0", never NULL, do not free it. */
const char *dalcs_version(void);

/* A number as SPICE writes it, "1u", "2.5meg", "10kOhm". DALCS_E_OPTION when text is something else
 * or has anything after it; *value is then unchanged. */
enum dalcs_status dalcs_parse_number(const char *text, double *value) DALCS_MUST_CHECK;

/* ---- Reading ------------------------------------------------------------------------------- */

struct dalcs_session;

/* Makes an empty session in *session; on failure *session is NULL. The caller destroys it. */
enum dalcs_status dalcs_session_create(struct dalcs_session **session) DALCS_MUST_CHECK;

/* Accepts NULL. Everything that a session handed out dies with it. */
void dalcs_session_destroy(struct dalcs_session *session);

/* The simulators whose netlists are known by name, ngspice first; NULL when index is too large. */
const char *dalcs_dialect_name(size_t index);

/* Before a netlist is read: the seed of its random values, a whole number, whatever .options seed= says. */
enum dalcs_status dalcs_session_set_seed(struct dalcs_session *session,
                                         double seed) DALCS_MUST_CHECK;

/* Says, before a netlist is read, for which of them it was written; NULL: what the netlist says or shows,
 * else ngspice. What this changes is in doc/netlist.md. DALCS_E_OPTION: there is no such dialect (a message
 * names them), or a netlist was read. */
enum dalcs_status dalcs_session_set_dialect(struct dalcs_session *session,
                                            const char *name) DALCS_MUST_CHECK;

/* Says, before a netlist is read, what stands on .tran in place of the netlist's times: all of them ("1u 5m uic"), and
 * when it ends ("5m"); NULL: what the netlist says. Copied. DALCS_E_OPTION: a netlist was read. */
enum dalcs_status dalcs_session_set_transient(struct dalcs_session *session, const char *times,
                                              const char *stop) DALCS_MUST_CHECK;

/* Says, before a netlist is read, that a steady state will be asked for (dalcs_run_options.steady): it need not ask for
 * any analysis itself. DALCS_E_OPTION: a netlist was read. */
enum dalcs_status dalcs_session_ask_steady(struct dalcs_session *session) DALCS_MUST_CHECK;

/* The same, and of how its measurements depend on the values of elements, as if there were a .sens. */
enum dalcs_status dalcs_session_ask_sensitivities(struct dalcs_session *session) DALCS_MUST_CHECK;

/* The same of the response around a steady state (dalcs_run_options.bode). */
enum dalcs_status dalcs_session_ask_response(struct dalcs_session *session) DALCS_MUST_CHECK;

/* Asks, before a netlist is read, for the losses of its steady state, if it has one, and of its .tran from one time to another (s; `to` may be
 * INFINITY, the end of the run), or, where `from` is not a number, over the window of its .losses card, else
 * over all of the run. */
enum dalcs_status dalcs_session_ask_losses(struct dalcs_session *session, double from,
                                           double to) DALCS_MUST_CHECK;

/* Says, before a netlist is read, that it will be run with other values: dalcs_session_set_value, _alter
 * and _parameter then do without a script. DALCS_E_OPTION: a netlist was read. */
enum dalcs_status dalcs_session_keep_netlist(struct dalcs_session *session) DALCS_MUST_CHECK;

/* Reads a netlist from a file, or from text[0..length-1] that messages call `name`. A session reads
 * one netlist, once: a second call is DALCS_E_OPTION. Files that it includes are read too, relative to
 * the folder of `path` or `name`. Errors in the netlist: DALCS_E_NETLIST, all
 * of them in the messages. */
enum dalcs_status dalcs_session_read_file(struct dalcs_session *session,
                                          const char *path) DALCS_MUST_CHECK;
enum dalcs_status dalcs_session_read_text(struct dalcs_session *session, const char *name,
                                          const char *text, size_t length) DALCS_MUST_CHECK;

enum dalcs_level { DALCS_LEVEL_NOTE, DALCS_LEVEL_WARNING, DALCS_LEVEL_ERROR };

/* The messages so far, oldest first: one may have several lines, the place, the line with a caret,
 * a hint. Text has no final newline and lives as long as the session. NULL when index is too large;
 * level may be NULL. */
size_t dalcs_session_n_messages(const struct dalcs_session *session);
const char *dalcs_session_message(const struct dalcs_session *session, size_t index,
                                  enum dalcs_level *level);

/* What the netlist asks for; times in s, 0 where not given. All zero before a netlist was read. */
struct dalcs_request {
    bool operating_point;
    bool transient;
    bool dc_sweep;
    bool ac;
    size_t n_steps; /* of .step: how often each of these is run; 1 without */
    double step, stop, start, max_step;
    size_t n_prints; /* .print and .plot cards */
    bool ascii;      /* .options filetype=ascii: raw files as text */
    bool periodic;   /* .pss */
    bool worst_case; /* .wcase */
    bool euler;      /* .options method=euler */
    bool compresses; /* .options compress: most rows are left out */
};
struct dalcs_request dalcs_session_request(const struct dalcs_session *session);

/* What .step sets in step number `step`, counted from 0: parameter number `index` ("rload", "dmod(vfwd)") and its
 * value; NULL when either is too large. Of the netlist as it was read: ask a session that has not run. */
const char *dalcs_session_step_parameter(const struct dalcs_session *session, size_t step,
                                         size_t index, double *value);

/* What gauss, mc and the like made of the circuit that was read or run last: the name of the place ("c" of .param,
 * "r1", "dmod(vfwd)") and its value, NAN where this step has no such place; NULL when index is too large. */
const char *dalcs_session_drawn(const struct dalcs_session *session, size_t index, double *value);

/* The names of .meas in the order in which a report has them; NULL when index is too large. */
const char *dalcs_session_measure_name(const struct dalcs_session *session, size_t index);

/* What a .print shows of a signal; the plain value of an .ac is complex. */
enum dalcs_print_part {
    DALCS_PRINT_PLAIN,
    DALCS_PRINT_MAGNITUDE,
    DALCS_PRINT_DECIBEL,
    DALCS_PRINT_PHASE, /* radians */
    DALCS_PRINT_REAL,
    DALCS_PRINT_IMAGINARY
};

struct dalcs_print {
    const char *signal; /* by its name in struct dalcs_plot */
    const char *title;  /* "v(out)", "vdb(out)" */
    enum dalcs_print_part part;
};

/* A column of the .print or .plot card number `card`; false when it does not show this analysis (enum
 * dalcs_analysis) or has fewer columns. Valid as long as the plot that it is about. */
bool dalcs_session_print(const struct dalcs_session *session, size_t card, int analysis,
                         size_t column, struct dalcs_print *print);

/* ---- Equations ----------------------------------------------------------------------------- */

/* Files that begin with "dalcs-system 2" are read by the calls above as well: a DALCS, an LCS or a
 * mechanical system given by its matrices (doc/system-file.md). */

/* The same from a program's own matrices: row by row and dense, NULL where all 0. Cards that have no
 * matrices, such as ".tran 1m 1\ninput u SIN(0 1 50)\n", are in `cards`, as in a system file. Copied:
 * nothing is borrowed after the call. */
struct dalcs_matrices {
    const char *title;
    const char *cards;
    size_t n_x, n_z, n_lambda, n_inputs; /* inputs: those of `cards`, in their order */
    const char *const *x_name;           /* [n_x]; NULL: x1, x2, ... */
    const char *const *z_name;           /* [n_z]; NULL: z1, z2, ... */
    const double *x0;                    /* [n_x]; NULL: .tran starts from its operating point */
    const double *low, *high; /* [n_lambda] of the cones: 0 and INFINITY a half line, both infinite
                                 free, both finite a box; NULL: 0 and INFINITY */
    const double *P;          /* [n_x][n_x]; NULL: the identity */
    const double *A_I, *B_I, *Bbar_I, *E_I, *constant_I;      /* n_x rows; constants [n_x] */
    const double *A_II, *B_II, *Bbar_II, *E_II, *constant_II; /* n_z rows */
    const double *C_I, *C_II, *D, *F, *constant_F;            /* n_lambda rows */
    const double *storage; /* [n_x][n_x] of the stored energy 1/2 x' storage x; NULL: P */
};
enum dalcs_status
dalcs_session_read_matrices(struct dalcs_session *session, const char *name,
                            const struct dalcs_matrices *matrices) DALCS_MUST_CHECK;

/* A mechanical system, mass q'' + damping q' + stiffness q = force s(t) + constant_force + G' lambda. The rows
 * of G and constant_G are those of the contacts (0 <= lambda _|_ G q + c >= 0, impacts are inelastic), then of
 * the joints (0 = G q + c), then of the frictions (|lambda| <= limit against G q' + c). Row by row and dense,
 * NULL where all 0; units are the caller's. Copied. */
struct dalcs_mechanics {
    const char *title;
    const char *cards; /* as above */
    size_t n_q, n_inputs, n_contacts, n_joints, n_frictions;
    const char *const *q_name; /* [n_q]; NULL: q1, q2, ...; velocities are d(NAME) */
    const double *q0, *v0;     /* [n_q]; both NULL: .tran starts from its operating point */
    const double *mass, *damping, *stiffness; /* [n_q][n_q]; NULL: of mass the identity */
    const double *force, *constant_force;     /* [n_q][n_inputs], [n_q] */
    const double *G, *constant_G;             /* n_contacts + n_joints + n_frictions rows */
    const double *friction_limit;             /* [n_frictions] */
};
enum dalcs_status
dalcs_session_read_mechanics(struct dalcs_session *session, const char *name,
                             const struct dalcs_mechanics *mechanics) DALCS_MUST_CHECK;

enum dalcs_equations_format {
    DALCS_EQUATIONS_TEXT,
    DALCS_EQUATIONS_LATEX,
    DALCS_EQUATIONS_SYSTEM, /* a system file, which is read back to the bit; so are the next two */
    DALCS_EQUATIONS_JSON,
    DALCS_EQUATIONS_MATRIX_MARKET /* a system file with its matrices in files beside it */
};

enum dalcs_equations_form {
    DALCS_FORM_DALCS,   /* (2.1) of Brogliato 2022 */
    DALCS_FORM_LCS,     /* z eliminated where B_II is regular; a message says where it is not */
    DALCS_FORM_ONE_STEP /* (3.2) for a step: w = M lambda + q */
};

struct dalcs_equations_options {
    enum dalcs_equations_format format;
    enum dalcs_equations_form form;
    double step;      /* s, of DALCS_FORM_ONE_STEP */
    const char *stem; /* of Matrix Market: what its files' names begin with; without folders */
    void *user;
    /* Receives each file: "" or ".json" are no part of `suffix`, which is "" for the first and
     * ".A_I.mtx" for a matrix. Text is borrowed until the callback returns. */
    enum dalcs_status (*file)(void *user, const char *suffix, const char *text, size_t length);
};

/* Writes the equations of what was read. */
enum dalcs_status
dalcs_session_equations(struct dalcs_session *session,
                        const struct dalcs_equations_options *options) DALCS_MUST_CHECK;

/* ---- Running ------------------------------------------------------------------------------- */

enum dalcs_analysis {
    DALCS_OPERATING_POINT,
    DALCS_TRANSIENT,
    DALCS_DC_SWEEP,
    DALCS_AC,
    DALCS_PERIODIC, /* one period of a steady state */
    DALCS_N_ANALYSES
};

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

/* Receives results while they are made: for each analysis begin, rows, end, in this order: .op, .dc,
 * .pss, .ac, .tran; with .step all steps of an analysis before the next analysis. Any
 * callback may be NULL, or return a status other than DALCS_OK, which ends the run with that
 * status; end is then not called. Nor is it for a step of .step that fails: the next begin follows. */
struct dalcs_sink {
    void *user;
    enum dalcs_status (*begin)(void *user, const struct dalcs_plot *plot);
    /* `time` is the row's scale. Times ascend; two rows of equal time are the two sides of a
     * discontinuity. Values are borrowed until the callback returns. An operating point has one row,
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

/* Runs .op, .dc, .ac and .tran, whichever the netlist has, for each .step, with options and a sink that
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
 * that another thread, or a signal handler, may make while the session runs. */
void dalcs_session_cancel(struct dalcs_session *session);

/* ---- Co-simulation ---------------------------------------------------------------------------- */

/* What the circuit and a program outside exchange at one time. */
struct dalcs_exchange {
    double time; /* s; first 0, before there is anything to read */
    size_t n_signals, n_inputs;
    const char *const *name; /* [n_signals] "v(out)", "i(l1)" */
    const double *value;     /* [n_signals] just before `time`; NULL the first time */
    const char *const *
        input; /* [n_inputs] V and I with the word EXTERNAL on their card, as dalcs_session_input_name */
    double
        *given;  /* [n_inputs] V or A, as it was; the program gives what they are from `time` on */
    double next; /* s, > time: the program gives its next call; INFINITY, as it was: none */
};

/* Names of the external sources, in the netlist's order; NULL when index is too large. */
const char *dalcs_session_input_name(const struct dalcs_session *session, size_t index);

/* Before runs of a netlist with external sources: nothing else gives them values. In each .tran, of .step in each step,
 * exchange is called at 0 and at the times that it asks for, the end of the run among them, and between them sources stay
 * as they are. Events and steps are not tied to these times. A status other than DALCS_OK ends the run with that. NULL: no
 * more. DALCS_E_OPTION: there is no external source. */
enum dalcs_status dalcs_session_couple(struct dalcs_session *session,
                                       enum dalcs_status (*exchange)(void *user,
                                                                     struct dalcs_exchange *e),
                                       void *user) DALCS_MUST_CHECK;

/* ---- Rows in memory --------------------------------------------------------------------------- */

/* What a run gave a sink, kept: for languages in which a callback for each row costs more than the row. */
struct dalcs_tables;

struct dalcs_row_table {
    struct dalcs_plot plot; /* all of it lives as long as the tables */
    size_t n_rows;
    const double *scale; /* [n_rows] NULL without rows */
    const double *value; /* [n_rows * n_signals], of complex signals twice as many: row after row */
};

/* Like dalcs_session_run. *tables is made, whatever the status but DALCS_E_NOMEM, with the rows up to where
 * the run ended, and is NULL or the caller's to destroy; it may outlive the session. progress is that of a sink; it may be NULL. */
enum dalcs_status
dalcs_session_run_tables(struct dalcs_session *session, const struct dalcs_run_options *options,
                         enum dalcs_status (*progress)(void *user, double time, double stop),
                         void *user, struct dalcs_tables **tables) DALCS_MUST_CHECK;

/* In the order in which a sink gets them. NULL when index is too large. */
size_t dalcs_tables_count(const struct dalcs_tables *tables);
const struct dalcs_row_table *dalcs_tables_get(const struct dalcs_tables *tables, size_t index);

/* Accepts NULL. */
void dalcs_tables_destroy(struct dalcs_tables *tables);

/* Events of diodes and switches since the run at hand began, or of the last one; 0 where the options
 * say not to record them. May be asked for in a callback. */
size_t dalcs_session_n_events(const struct dalcs_session *session);

/* ---- Runs of other kinds --------------------------------------------------------------------- */

/* The lines between .control and .endc, which the library does not run: without their newline; NULL
 * when index is too large. */
size_t dalcs_session_n_script_lines(const struct dalcs_session *session);
const char *dalcs_session_script_line(const struct dalcs_session *session, size_t index);

/* Adds a message at column..column+length-1 (from 1, in bytes) of a script line. hint may be NULL. */
void dalcs_session_script_message(struct dalcs_session *session, size_t line, size_t column,
                                  size_t length, enum dalcs_level level, const char *hint,
                                  const char *text);

/* Adds a line as if it stood at the end of .control: for programs that are told commands one by one. It is
 * copied; messages call it "command:1", then 2 and so on. Only for a netlist with a script. */
enum dalcs_status dalcs_session_add_script_line(struct dalcs_session *session,
                                                const char *text) DALCS_MUST_CHECK;

/* A card that is added to the netlist for one run, as if it stood on that script line; without its
 * first dot: "tran 1u 1m", "meas tran vavg avg v(out)". */
struct dalcs_extra_card {
    size_t line;
    const char *text;
};

/* Like dalcs_session_run, with cards added. Where analyses (tran, op, dc, ac) are among them, those are
 * run and not the netlist's. Errors in the cards: DALCS_E_NETLIST. Only for a netlist with a script. */
enum dalcs_status dalcs_session_run_cards(struct dalcs_session *session,
                                          const struct dalcs_extra_card *card, size_t n_cards,
                                          const struct dalcs_run_options *options,
                                          const struct dalcs_sink *sink) DALCS_MUST_CHECK;

/* A netlist's .tran, .op, .dc and .ac after the first of their kind: the runs above are without them. Each is a run of its
 * own, with cards that are no analyses. DALCS_E_OPTION: index is too large. Only for a netlist with a script. */
size_t dalcs_session_n_second_analyses(const struct dalcs_session *session);
enum dalcs_status dalcs_session_run_second(struct dalcs_session *session, size_t index,
                                           const struct dalcs_extra_card *card, size_t n_cards,
                                           const struct dalcs_run_options *options,
                                           const struct dalcs_sink *sink) DALCS_MUST_CHECK;

/* Gives what the netlist names another value in all later runs: "r1", "v1" (its DC value),
 * "x1.c2", a parameter of a model ("dmod", field "vfwd") or, is_parameter, of .param. Lower case.
 * DALCS_E_OPTION: there is no such thing, *nearest (may be NULL) is the name most like it or NULL.
 * Only for a netlist with a script. */
enum dalcs_status dalcs_session_alter(struct dalcs_session *session, bool is_parameter,
                                      const char *name, const char *field, double value,
                                      const char **nearest) DALCS_MUST_CHECK;

/* The same of the function of a V or I: "pulse", "sin", "exp", "pwl", "sffm" or "am" with its values in their order. */
enum dalcs_status dalcs_session_alter_waveform(struct dalcs_session *session, const char *name,
                                               const char *function, const double *value, size_t n,
                                               const char **nearest) DALCS_MUST_CHECK;

/* The value of a parameter of .param outside of subcircuits, as the next run has it. Lower case.
 * DALCS_E_OPTION: there is none of that name. Only for a netlist with a script. */
enum dalcs_status dalcs_session_parameter(const struct dalcs_session *session, const char *name,
                                          double *value) DALCS_MUST_CHECK;

/* Gives a value by its name as a person writes it, in any case: a parameter of .param, else an element, or
 * "dmod(vfwd)", a parameter of a model. For a netlist with a script, or that is kept. DALCS_E_OPTION: a
 * message says why. */
enum dalcs_status dalcs_session_set_value(struct dalcs_session *session, const char *name,
                                          double value) DALCS_MUST_CHECK;

/* With what a capacitor (V) or coil (A) starts all later runs of .tran, which then begin as with uic: those of which nothing is
 * said have their IC=, else 0. A report's state_name and final go on where its run ended, if the sources are there what
 * they were at 0. For a netlist with a script, or that is kept. DALCS_E_OPTION: a message says why. */
enum dalcs_status dalcs_session_set_state(struct dalcs_session *session, const char *element,
                                          double value) DALCS_MUST_CHECK;

/* Builds the circuit with the values that were set, as the next run or check does by itself: what
 * the netlist then asks for may be another. DALCS_E_NETLIST: it is none; the messages say why. */
enum dalcs_status dalcs_session_apply_values(struct dalcs_session *session) DALCS_MUST_CHECK;

/* The names that may be set: the parameters outside of subcircuits of a netlist with a script, or that is
 * kept; the elements, those of subcircuits too, and parts of elements, "rser(l1)", which have no value of their own.
 * NULL when index is too large. */
const char *dalcs_session_parameter_name(const struct dalcs_session *session, size_t index);
const char *dalcs_session_element_name(const struct dalcs_session *session, size_t index);

/* Forgets what dalcs_session_alter said of elements and models; parameters stay. */
void dalcs_session_reset(struct dalcs_session *session);

/* ---- The report ---------------------------------------------------------------------------- */

/* A diode or switch changed sides. */
struct dalcs_event {
    double time;         /* s; of euler the end of the step that found it */
    const char *element; /* "d1", "s1" */
    bool on;             /* now conducts, or is closed */
};

/* States of one component that changed at once. */
struct dalcs_jump {
    double time; /* s */
    size_t n_states;

    const struct dalcs_jump_state {
        const char *element; /* "c1": V, "l1": A */
        double before, after;
    } * state;

    size_t n_impulses;

    const struct dalcs_impulse {
        const char *element; /* diode or switch */
        bool is_flux;        /* Wb across it, of a diode in reverse; else C through it */
        double value;
    } * impulse;

    double energy_lost; /* J, 1/2 |dx|^2 in the storage metric */
    double source_work; /* J, what the sources delivered in the jump */
};

/* A signal that the circuit does not determine: any value between the bounds belongs to an exact
 * solution. */
struct dalcs_nonunique {
    const char *signal;  /* "i(d1)" */
    double time;         /* s, when it was found first */
    double lower, upper; /* V or A; may be infinite */
    double value;        /* the least-norm choice, which the results have */
    const char *because; /* "d1 parallel to d2" */
};

/* What a .meas gave. */
struct dalcs_measurement {
    const char *name;
    const char
        *step; /* of .step, "r = 500, c = 1e-06", one text for all of a step of an analysis; NULL
                         without */
    bool found;
    double value;        /* in the unit of what was measured; 0 unless found */
    const char *failure; /* why not; NULL when found */
    int n_details;

    struct dalcs_measurement_detail {
        const char *name; /* "from", "to", "at", "with", "targ", "trig", as ngspice prints them */
        double value;
    } detail[2];
};

/* What a .four gave: signal = magnitude[0] + sum of magnitude[k] sin(2 pi k frequency (t - from) +
 * phase[k]) over the periods from `from` to `to`. */
struct dalcs_fourier {
    const char *signal;
    const char *step;   /* as of a measurement */
    double frequency;   /* Hz */
    double from, to;    /* s */
    double thd;         /* harmonics from the second on over the first; not finite without that */
    size_t n_harmonics; /* the constant counted */
    const double *magnitude; /* [n_harmonics] */
    const double *phase;     /* [n_harmonics] degrees */
};

/* What an element took over a window of the run, by voltage from its first node to its second and the current
 * that flows so inside it. */
struct dalcs_element_losses {
    const char *element;
    const char
        *kind; /* "source", "resistor", "winding" (Rser of a coil), "diode", "switch", "coil",
                         "capacitor" */
    double v_average, v_rms, i_average, i_rms; /* V, A */
    double power;         /* W, the mean of what it takes; what a source delivers is negative */
    double jumps;         /* J of that, at instants when states jumped */
    double stored_change; /* J, of coils and capacitors */
    double switching;     /* J by the tables of .switchloss, besides the circuit's own */
    long n_on, n_off;     /* of diodes and switches: how often they turned on and off */
    long n_clamped;       /* of these, those outside their table, at its edge */
    double frequency;     /* Hz, of a source with a period; else 0 */
    double
        power_factor; /* of a source over whole periods, else not a number; so with the next two */
    double displacement; /* the cosine between the fundamentals of voltage and current */
    double thd; /* rms of what is neither constant nor fundamental, over the fundamental's */
};

/* Where the power went, of a .tran between two times or of all of an orbit. */
struct dalcs_losses {
    const char *step; /* as of a measurement */
    bool of_orbit;    /* .pss; else .tran */
    double from, to;  /* s */
    size_t n_elements;
    const struct dalcs_element_losses *element;
    double sources, resistors, windings, diodes, switches; /* J; the first delivered */
    double jumps;         /* J lost in jumps that no switch or diode carried */
    double stored_change; /* J */
    double balance;       /* J: the sources less all the others */
    double turnover;      /* J: the sum of all that was moved, whatever its sign */
    double switching;     /* J, by tables */
    double input, output; /* W */
    double efficiency;    /* output over input and what switching takes; not a number where neither
                             has a meaning */
    const char *inputs, *outputs; /* which elements these are of */
};

/* A step of .step that failed. */
struct dalcs_failed_step {
    size_t step;        /* from 0 */
    const char *values; /* "r = 500, c = 1e-06" */
    enum dalcs_status status;
    const char *because; /* the sentence of its first error */
};

/* What a run did. Strings and arrays are borrowed from the session and live until its next run. */
struct dalcs_report {
    const char *netlist; /* path or name */
    const char *title;
    const char *method; /* as asked for, or the default */
    double tolerance;   /* of radau and auto, else 0 */
    double step;        /* s, the fixed step of .tran; 0 when there was none */
    double stop;        /* s */
    size_t n_components;

    const struct dalcs_component_method {
        const char *method;  /* "euler", "radau", or "algebraic": no memory, solved where wanted */
        int stages;          /* of radau, else 1 */
        const char *because; /* "very small, held to 1e-9"; NULL: asked for */
    } * component;           /* [n_components], .tran only */

    struct {
        int nodes, x, z, lambda, switches, components;
        int corners; /* of the lambdas, those of sources with a formula */
    } size;

    struct {
        long steps;          /* accepted time steps, over all components */
        long rejected;       /* steps repeated with a smaller one */
        long restarts;       /* pairs of micro-steps that decided a mode or a jump */
        long euler_steps;    /* steps where radau fell back to implicit Euler */
        long periodic_steps; /* steps that were those of a period before */
        long leapt_steps;    /* steps in periods that were taken as one */
        long osnsp;          /* one-step problems solved, over all components */
        long pivots;         /* mode changes tried */
        long factorizations; /* of KLU and LAPACK */
        long cache_hits;
        long singular; /* problems in a singular mode, answered by the least-norm solution */
        double cpu_s, wall_s;
    } work;

    struct {
        double worst;      /* largest scaled residual of any accepted step */
        double time;       /* s */
        const char *where; /* "KCL at out", "branch v1", "complementarity of d1", "stages" */
        double wrong_sign; /* of radau: most negative current or reverse voltage of a diode, over
                              the largest current or voltage; where one has just changed sides it may
                              be as large as the tolerance */
    } certificate;

    /* Of .tran: laws of the netlist's devices, checked on the finished waveform; of .op and .dc at rest. */
    struct {
        const char *mode; /* "sample" or "full"; NULL: nothing was audited */
        long instants;    /* at which laws were checked, operating points among them */
        long segments;    /* between two events or ends of steps, of all parts; 0: points alone */
        long audited;     /* of them, those that were looked into */
        long screened;    /* those of which all linear laws were checked at once */
        long positions;   /* of switches, compared with their controls */
        double worst, allowed; /* the worst defect over its scale, and what it was held to */
        double time;           /* s, of that */
        const char *where;     /* "d1", "i(d1)", "KCL at out", "position of s1", "Tellegen" */
        size_t n_laws;

        const struct dalcs_audited {
            const char *law;
            double defect; /* the worst, over its scale */
            double time;   /* s */
        } * law;           /* [n_laws] whose defect is not 0 */
    } audit;

    size_t n_states;
    const char *const *state_name; /* [n_states] element names of capacitors and inductors */
    const double *start;           /* [n_states] just after t = 0: V, A */
    const double *final;           /* [n_states] */
    size_t n_events, n_events_dropped;
    const struct dalcs_event *event;
    size_t n_jumps, n_jumps_dropped;
    const struct dalcs_jump *jump;
    size_t n_nonunique; /* each signal once */
    const struct dalcs_nonunique *nonunique;

    size_t n_measurements; /* .meas of the analyses that were run, in the netlist's order; of all
                              steps of .step */
    const struct dalcs_measurement *measurement;
    size_t n_fourier;
    const struct dalcs_fourier *fourier;
    size_t n_losses; /* one for each .pss and .tran that was asked for its losses */
    const struct dalcs_losses *losses;

    /* J, over .tran: sources = resistors + diodes + jumps + stored_change + method + balance */
    struct {
        bool present;
        double sources;       /* delivered by V and I, and by controlled sources */
        double resistors;     /* dissipated; in switches and in Roff of diodes as well */
        double diodes;        /* in Vfwd, Ron and breakdown */
        double jumps;         /* lost when states jumped */
        double stored_change; /* in capacitors and inductors, end minus start */
        double method;        /* dissipated by the method: no circuit does */
        double balance;       /* left side minus right side: rounding; if it is more than that, or
                                 if the method of radau is more than its tolerance explains, the run
                                 ends with DALCS_E_INTERNAL */
    } energy;

    size_t n_sides; /* of .ac: where each diode and switch stands at the operating point */

    const struct dalcs_side_taken {
        const char *element;
        bool on;         /* conducts, or is closed */
        bool degenerate; /* a diode with neither current nor voltage: either side fits */
    } * side;            /* [n_sides] */

    struct {
        bool present;
        double time;      /* s */
        const char *kind; /* "loop", "cutset", "mode": no mode of a circuit that is not passive,
                             "equations": those of its elements contradict each other, or
                             "derivative": states would jump by the derivative of an impulse */
        size_t n_elements;
        const char *const *element; /* a loop's in its order, from the source that drives on */
        const char *because;        /* the sentence of the message */
    } infeasible;

    /* Of .pss (doc/steady.md). */
    struct {
        bool present;
        double period; /* s */
        int newton, bursts, leaps;
        long periods;    /* that the search has run */
        double residual; /* by how much a period misses where it began, over each state's scale */
        double distance; /* how far the steady state is from there, by one more Newton step */
        double defect;   /* the same as residual of the period that was written */
        bool exact;      /* the multipliers are: no step of implicit Euler, nothing slides */
        bool stable;
        const char *verdict;
        size_t
            n_multipliers; /* the largest first; those of states that last no period are left out */

        const struct dalcs_floquet {
            double re, im;
            const char *state; /* "v(c1)" which has most of it */
        } * multiplier;

        const double *state; /* [n_states] at its beginning, before any edge there */
        size_t n_conserved;  /* quantities with a multiplier of 1, "v(c2) - 0.5 v(c1)" */
        const char *const *conserved;
        size_t n_signals;

        const struct dalcs_steady_signal {
            const char *name; /* "v(out)" */
            double average, rms;
        } * signal; /* [n_signals] over the period, exact */

        struct {
            double period; /* s; 0: of two periods of the sources none was found, or looked for */
            bool stable;
            size_t n_multipliers;
            const struct dalcs_floquet *multiplier; /* over both periods */
        } doubled; /* where a multiplier below -1 says that a run leaves the orbit for such a one */

        struct {
            const char *
                kind; /* "orbit", "quasi-periodic", "chaos"; NULL: not known, or the orbit is stable */
            int periods;   /* of the sources; 0: of no orbit */
            double period; /* s; likewise */
            double growth; /* of a small difference: in each period; of an orbit in all of them */
        } attractor;       /* what a run comes to that leaves an unstable orbit */

        bool self_oscillating; /* no source has a period: the circuit's own was found */
        double
            flow; /* its multiplier along the orbit, 1 but for rounding, which is none of those above */
    } steady;

    /* Of .env. */
    struct {
        bool present;
        double period;         /* s, of the sources */
        long periods;          /* from the start to the end */
        long run;              /* of them, those that were run to find the others */
        long leaps, rejected;  /* over periods that were not; tried, but not accurate */
        double worst, allowed; /* the largest error of a leap, over each state's largest value */
    } envelope;

    /* Of .ac around it (doc/bode.md). */
    struct {
        bool present;
        double period; /* s, of the orbit */
        int sideband;  /* rows are of the components so many orbit's frequencies higher */
        bool
            exact; /* no step of implicit Euler, nothing slides, no commands at one time that move apart */
        double tail; /* what polynomials of its pieces leave out at most, over what they are of */
        const char *loop;    /* the source in the loop; NULL: none was asked for */
        bool loop_is_loaded; /* by a voltage and a current */
        size_t n_crossovers, n_reversals;

        const struct dalcs_margin {
            double frequency; /* Hz */
            double margin;    /* deg where the gain is 1, dB where the phase is 180 deg */
        } * crossover,        /* [n_crossovers] */
            *reversal;        /* [n_reversals] */
    } response;

    /* Of .sens behind .pss: what the measurements of the orbit change by with a value (doc/steady.md). */
    struct {
        bool present;
        size_t n_parameters, n_results;

        const struct dalcs_sensitivity_parameter {
            const char *name; /* "l1", "duty", "dmod(vfwd)" */
            double value;
        } * parameter; /* [n_parameters] */

        const struct dalcs_sensitivity_result {
            const char *name; /* "v(out)", "ripple" */
            const char
                *kind; /* "average", "rms", "measurement", "magnitude", "phase", "thd", "period" */
            int harmonic; /* of magnitude and phase */
            double value;
            const double *derivative; /* [n_parameters] by the value; not a number: there is none */
        } * result;                   /* [n_results] */
    } sensitivity;

    /* .wcase: first all in the middle, then each tolerance at its ends alone, then all of them where these say that
     * each measurement is smallest and largest, and all corners where these are few. */
    struct {
        bool present, has_corners;
        size_t n_parameters, n_results, n_runs, n_failed;

        const struct dalcs_worst_case_parameter {
            const char *name;          /* "r1", "d1(vfwd)", "lot(rb)" */
            double low, nominal, high; /* values; -1, 0 and 1 of what has no value of its own */
        } * parameter;                 /* [n_parameters] */

        const struct dalcs_worst_case_result {
            const char *name;               /* of .meas */
            size_t smallest, largest;       /* runs */
            const double *at_low, *at_high; /* [n_parameters] with this one there alone */
        } * result;                         /* [n_results] */

        const struct dalcs_worst_case_run {
            const signed char *place; /* [n_parameters] -1: low, 0: nominal, 1: high */
            const double *value;      /* [n_results] NaN: it could not be measured */
            const char *error;        /* NULL: there is none */
        } * run;                      /* [n_runs] */
    } worst_case;

    size_t n_steps, n_failed_steps; /* of .step, 0 without; of those that were asked for */
    const struct dalcs_failed_step *failed_step; /* each once; all other steps were run */
};

/* Valid after dalcs_session_run, whatever its status but DALCS_E_NOMEM; NULL before. */
const struct dalcs_report *dalcs_session_report(const struct dalcs_session *session);

/* One measurement of the last run's report, for languages that do not read this header; NULL when index is
 * too large. */
const struct dalcs_measurement *dalcs_session_measurement(const struct dalcs_session *session,
                                                          size_t index);

/* ---- As JSON ---------------------------------------------------------------------------------- */

/* Texts that belong to the session and live until the next of them. The report of the last run, by
 * doc/report.schema.json; DALCS_E_OPTION: there is none. */
enum dalcs_status dalcs_session_report_json(struct dalcs_session *session,
                                            const char **json) DALCS_MUST_CHECK;

/* What dalcs_session_check says, by doc/check.schema.json. */
enum dalcs_status dalcs_session_check_json(struct dalcs_session *session, double step,
                                           const char **json) DALCS_MUST_CHECK;

/* What dalcs_session_equations writes as DALCS_EQUATIONS_JSON. */
enum dalcs_status dalcs_session_equations_json(struct dalcs_session *session,
                                               enum dalcs_equations_form form, double step,
                                               const char **json) DALCS_MUST_CHECK;

/* ---- Checking ------------------------------------------------------------------------------ */

/* What theory says of a circuit before it runs. Everything here is borrowed from the session and
 * lives until its next check. */
enum dalcs_answer {
    DALCS_NO,
    DALCS_YES,
    DALCS_CONDITIONAL, /* it depends on what the sentence says */
    DALCS_UNDECIDED,   /* no condition tried decides it */
    DALCS_NOT_CHECKED  /* too large, or a solver is missing: the sentence says which */
};

/* "no", "yes", "depends", "undecided", "not checked" */
const char *dalcs_answer_text(enum dalcs_answer answer);

/* Numbers that prove a claim, for whoever wants to compute it again. */
struct dalcs_evidence {
    const char *kind; /* "P", "X", "point", "multipliers", "mode", "eigenvector", "motion",
                         "minor", "kernel", "powers" */
    size_t n_entries;

    const struct dalcs_evidence_entry {
        const char *name; /* "v(c1)", "i(d1)", "d1", "sigma" */
        double re, im;
    } * entry;

    size_t n_rows, n_columns; /* of a matrix, else 0 */
    const char *const *row;   /* [n_rows] */
    const char *const *column;
    const double *value; /* [n_rows * n_columns] by rows */
};

/* One condition of a theorem. */
struct dalcs_condition {
    const char *id;     /* "A9" */
    const char *source; /* "Brogliato 2022, assumption 9" */
    const char *text;   /* the condition */
    enum dalcs_answer holds;
    const char *because; /* the numbers, or what was not checked; or NULL */
    size_t n_witnesses;
    const struct dalcs_evidence *witness;
};

/* The answer to a question of an engineer. */
struct dalcs_verdict {
    const char *question; /* "exists", "unique", "multipliers", "jumps", "step", "convergence",
                             "stable", "contracting", "periodic", "passive" */
    enum dalcs_answer answer;
    const char *sentence; /* without a full stop */
    const char *source;
    double value; /* a bound on the step in s, a rate in 1/s; NAN: none */
    size_t n_elements;
    const char *const *element; /* sources that jump, elements that give energy, diodes of a mode */
    size_t n_witnesses;
    const struct dalcs_evidence *witness;
};

/* A part of the circuit that shares only ground with the rest. */
struct dalcs_checked_part {
    size_t n_equal;      /* parts that are exactly like it, itself included */
    const char *element; /* one of its elements */
    int states, algebraic, diodes, switches;
    const char *summary; /* plain words, several sentences */
    size_t n_verdicts;
    const struct dalcs_verdict *verdict;
    size_t n_conditions;
    const struct dalcs_condition *condition;
};

struct dalcs_check {
    const char *netlist, *title;
    double step; /* s, of the conditions on one step */
    size_t n_parts;
    const struct dalcs_checked_part *part;
};

/* Checks the netlist that was read, without running it. step is the h of the conditions that speak of
 * one step, in s; 0: .options step, else the tmax or tstep of .tran, else 1e-6. */
enum dalcs_status dalcs_session_check(struct dalcs_session *session, double step,
                                      const struct dalcs_check **check) DALCS_MUST_CHECK;

/* ---- Auditing a file --------------------------------------------------------------------------- */

/* Waveforms that anybody made, of a .tran: the time in s is column 0. One row at time 0 is an operating point.
 * Borrowed during a call. */
struct dalcs_wave_table {
    size_t n_columns, n_rows;
    const char *const
        *name; /* [n_columns] "time", "V(out)", "i(d1)", "v1#branch", "@r1[i]", "I(x1:D1)" */
    const double *
        value; /* [n_rows * n_columns] row after row, no time before the one above; NAN: not known */
    const double *relative,
        *absolute; /* [n_columns] by its digits x may be off by relative |x| + absolute */
};

struct dalcs_table_audit_options {
    double tolerance; /* over the largest value of a signal; 0: 1e-3, the reltol of SPICE */
    size_t run;       /* of .step: its number, from 0; the circuit has its values */
};

/* A law of an element or node, where it is broken most. */
struct dalcs_table_law {
    const char *law;        /* "KCL", "BRANCH", "CURRENT", "POSITION" */
    const char *where;      /* "out", "d1" */
    const char *unit;       /* of the next two: "V", "A", "C", "Wb", "J" */
    double defect, allowed; /* broken where the first is larger */
    double from, to;        /* s; the same where it is about one time */
    double since;           /* s, broken for the first time */
    double
        sees; /* of coils and capacitors: an element that is off by more than this part of its value
                    would have been noticed; INFINITY: nothing moved. Of others 0 */
    size_t n_checked, n_broken;
};

/* A law that could not be checked. */
struct dalcs_table_gap {
    const char *law, *where;
    const char *because; /* "v(a), i(d1) are not in the file" */
};

struct dalcs_table_audit {
    const char *netlist, *title;
    double tolerance, from, to; /* s */
    size_t n_rows, n_used;      /* signals of the circuit among the columns */
    size_t n_laws, n_broken;
    const struct dalcs_table_law *law; /* [n_laws] the worst over what is allowed first */
    size_t n_gaps;
    const struct dalcs_table_gap *gap;
    size_t n_foreign;
    const char *const *foreign; /* columns that are nothing of the circuit */
};

/* Which laws of the netlist's elements does the table break, and by how much (doc/audit.md)? Needs no run.
 * The answer lives until the session's next one. DALCS_E_OPTION: the table is not one of this circuit; a
 * message says why. */
enum dalcs_status
dalcs_session_audit_table(struct dalcs_session *session, const struct dalcs_wave_table *table,
                          const struct dalcs_table_audit_options *options,
                          const struct dalcs_table_audit **audit) DALCS_MUST_CHECK;

/* ---- In ngspice's language ------------------------------------------------------------------ */

/* What stands for a diode. */
enum dalcs_spice_diode {
    DALCS_SPICE_STOCK,       /* ngspice's own default, whatever the netlist says of lines */
    DALCS_SPICE_EXPONENTIAL, /* a steep exponential between the lines of the netlist */
    DALCS_SPICE_LINES        /* XSPICE's sidiode, the lines themselves */
};

/* How near to ideal, and how hard ngspice is to try. */
struct dalcs_spice_options {
    enum dalcs_spice_diode diode;
    double emission;           /* N of the exponential, > 0 */
    double series;             /* ohm; of an exponential where the netlist's diode has none */
    double on, off;            /* ohm; of switches that are a wire and a cut, and of sidiodes */
    double edge;               /* s; the longest ramp that an edge of no width may become, > 0 */
    double max_step;           /* s; tmax and tstep of .tran, 0: the netlist's */
    double reltol;             /* 0: ngspice's own */
    const char *method;        /* "trap" or "gear" */
    const char *extra_options; /* more of .options; NULL: none */
};

/* Writes the circuit as a netlist for ngspice: flat, parameters resolved, ideal devices replaced. An
 * edge of no width becomes a ramp centred on it, a short one node. Errors of the stream stay there.
 * What ngspice cannot express: DALCS_E_NETLIST and a message with its place. */
enum dalcs_status dalcs_session_write_spice(struct dalcs_session *session,
                                            const struct dalcs_spice_options *options,
                                            FILE *stream) DALCS_MUST_CHECK;

/* The signal of that name in ngspice's raw file is its column `plus` minus its column `minus`; either
 * may be NULL: 0. They belong to the session. DALCS_E_OPTION: the netlist has no such signal. */
enum dalcs_status dalcs_session_spice_columns(struct dalcs_session *session, const char *signal,
                                              const char **plus,
                                              const char **minus) DALCS_MUST_CHECK;

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif

#ifdef __cplusplus
}
#endif

#endif
