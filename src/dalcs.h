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

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#pragma GCC visibility push(default) /* all else in the library is hidden */
#endif

/* The number of this interface, and of the library's file: libdalcs.so.0. It is raised when a program
 * that was built with an older header could not go on with a newer library. */
#define DALCS_ABI 0

/* 0 is success, > 0 a numerical failure that a smaller step may cure, < 0 is final. */
#define DALCS_STATUS_LIST(ENTRY)                                                                   \
    ENTRY(DALCS_OK, 0, "ok")                                                                       \
    ENTRY(DALCS_SINGULAR, 1, "singular matrix")                                                    \
    ENTRY(DALCS_NOT_CONVERGED, 2, "no certified solution of the one-step problem was found")       \
    ENTRY(DALCS_INFEASIBLE, 3, "the one-step problem has no solution")                             \
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
    double step, stop, start, max_step;
};
struct dalcs_request dalcs_session_request(const struct dalcs_session *session);

/* ---- Running ------------------------------------------------------------------------------- */

enum dalcs_analysis { DALCS_OPERATING_POINT, DALCS_TRANSIENT };

/* What a signal's values are in. */
enum dalcs_unit { DALCS_VOLT, DALCS_AMPERE };

/* One table of results. Borrowed: valid until the session is destroyed. */
struct dalcs_plot {
    enum dalcs_analysis analysis;
    const char *title;           /* the netlist's title line */
    size_t n_signals;            /* time not counted */
    const char *const *name;     /* [n_signals] "v(out)", "i(d1)" */
    const enum dalcs_unit *unit; /* [n_signals] */
};

/* Receives results while they are made: for .op and for .tran begin, rows, end, in this order. Any
 * callback may be NULL, or return a status other than DALCS_OK, which ends the run with that
 * status; end is then not called. */
struct dalcs_sink {
    void *user;
    enum dalcs_status (*begin)(void *user, const struct dalcs_plot *plot);
    /* Times ascend; two rows of equal time are the two sides of a discontinuity. Values are
     * borrowed until the callback returns. An operating point has one row, at time 0. Where rows are
     * left out (compress) the newest is held back: it may come after progress said to stop. */
    enum dalcs_status (*row)(void *user, double time, const double *value /* [n_signals] */);
    enum dalcs_status (*end)(void *user);
    /* Called every few thousand steps, of a large circuit more often, also while no row is due; not
     * within a step. time and stop in s. Return DALCS_OK to go on, DALCS_E_CANCELLED to stop: because
     * of a flag that another thread or a signal handler has set, for example. */
    enum dalcs_status (*progress)(void *user, double time, double stop);
};

/* The methods by name, the default first; NULL when index is too large. */
const char *dalcs_method_name(size_t index);

/* Bounds of the tolerance: below the first rounding decides, above the second little is left of a
 * waveform. */
#define DALCS_TOLERANCE_MIN 1e-13
#define DALCS_TOLERANCE_MAX 0.1

struct dalcs_run_options {
    const char *method; /* "auto", "radau" or "euler", the papers' implicit Euler; NULL: the
                           netlist's or the default */
    double tolerance; /* of radau and auto: largest error of a waveform over its scale; 0: .options
                           reltol, else 1e-6 */
    int stages;       /* of radau, auto: 1, 3, 5 or 7; 0: .options stages, else chosen */
    double step;      /* s; the fixed step of euler and radau, the largest of auto; 0: .options
                           step; without either euler takes the tmax of .tran, else its tstep, and
                           radau controls its error with steps of at most tmax */
    double compress;  /* leave rows out as long as straight lines through the others stay this near,
                           over each signal's scale; 0: .options compress, else keep all rows */
    const double *at; /* [n_at] ascending output times in s, none after the stop time,
                           interpolated linearly between steps by euler;
                           NULL: the .tran grid (euler: where it falls on steps, else every step)
                           and both sides of every event */
    size_t n_at;
    bool record; /* keep events and jumps for the report */
    bool energy; /* keep the ledger of energies for the report */

    /* Tolerances of the certificate and of the OSNSP; see doc/methods.md. All dimensionless. */
    double certificate_tolerance; /* residual over its physical scale, 2e-13 */
    double proximal_weight[3];    /* the eps ladder 1e-8, 1e-7, 1e-6 */
    double rcond_min;      /* a mode whose 1/condition is estimated smaller is singular, 1e-14 */
    int max_outer;         /* proximal iterations per rung, 40 */
    int max_pivots;        /* per solve, on top of twice the number of pairs, 200 */
    size_t cache_bytes;    /* bound on factorisations kept over all components, 256 MiB */
    int dense_limit;       /* components up to this many unknowns use dense step maps, 64 (radau:
                              see doc/methods.md); this and the bound may change the last bits of
                              results */
    size_t max_events;     /* events and jumps kept when recording, 1e6 */
    const char *dump_path; /* where to write an OSNSP that failed; NULL: nowhere */
};

/* The values named above, all else 0. Owns nothing. */
struct dalcs_run_options dalcs_run_options_default(void);

/* Runs .op, then .tran, whichever the netlist has, with options and a sink that are read during the
 * call only. DALCS_E_NETLIST: no netlist was read. DALCS_E_OPTION: a message says which. What a
 * callback returned, where that ended the run. DALCS_NOT_CONVERGED, DALCS_INFEASIBLE: the messages
 * name the time and the elements; rows already handed to the sink stay true. A second run
 * replaces the report of the first. */
enum dalcs_status dalcs_session_run(struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const struct dalcs_sink *sink) DALCS_MUST_CHECK;

/* Events of diodes and switches since the run at hand began, or of the last one; 0 where the options
 * say not to record them. May be asked for in a callback. */
size_t dalcs_session_n_events(const struct dalcs_session *session);

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
        const char *because; /* "tolerance 1e-06", "no state and no diode"; NULL: asked for */
    } * component;           /* [n_components], .tran only */

    struct {
        int nodes, x, z, lambda, switches, components;
    } size;

    struct {
        long steps;          /* accepted time steps, over all components */
        long rejected;       /* steps repeated with a smaller one */
        long restarts;       /* pairs of micro-steps that decided a mode or a jump */
        long euler_steps;    /* steps where radau fell back to implicit Euler */
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

    struct {
        bool present;
        double time;      /* s */
        const char *kind; /* "loop", "cutset", "mode": no mode of a circuit that is not passive, or
                             "derivative": states would jump by the derivative of an impulse */
        size_t n_elements;
        const char *const *element; /* a loop's in its order, from the source that drives on */
        const char *because;        /* the sentence of the message */
    } infeasible;
};

/* Valid after dalcs_session_run, whatever its status but DALCS_E_NOMEM; NULL before. */
const struct dalcs_report *dalcs_session_report(const struct dalcs_session *session);

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif

#ifdef __cplusplus
}
#endif

#endif
