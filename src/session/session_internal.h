/* session_internal.h - what the files of src/session share. */
#ifndef DALCS_SESSION_INTERNAL_H
#define DALCS_SESSION_INTERNAL_H

#include "explain.h"
#include "names.h"
#include "netlist.h"
#include "override.h"
#include "recorder.h"
#include "spice.h"
#include "undetermined.h"

#include <stdatomic.h>

struct dalcs_cosimulation;
struct dalcs_impulses;
struct dalcs_logic_run;
struct dalcs_losses_run;
struct dalcs_orbit_point;
struct dalcs_steady_near;
struct dalcs_stroboscope;
struct dalcs_radau;
struct dalcs_radau_options;

/* Steps that share an anchor: it costs a search more in so many, and what is searched lies no farther away. */
enum { DALCS_STEPS_OF_AN_ANCHOR = 8 };

/* The orbit that steps of .step start their search from (steady_anchor.c). */
struct dalcs_steady_anchor {
    bool is_known;  /* that of `step`; where that has none, it does not serve */
    bool serves;    /* stable, and the only one nearby */
    bool leaves;    /* of a .tran that starts on it */
    bool is_sought; /* by a run without output */
    size_t step;
    int n_x, n_pairs;
    double period; /* s */
    double *x;     /* heap */
    bool *closed;
};

/* What .step and .mc step, of the netlist with what alter said. The circuit of a step is no place to read this from:
 * its values may be others there. */
struct dalcs_steps {
    bool is_known;
    int n;
    struct dalcs_sweep *sweep; /* [n] the innermost first */
    size_t n_drawn;
    const char **drawn; /* [n_drawn] the values that are drawn, by name */
};

#define DALCS_KEEP_HINT "call dalcs_session_keep_netlist() before the netlist is read"

/* The initial value of a capacitor or coil. */
struct dalcs_set_state {
    const char *element;
    double value; /* V or A */
};

/* What the circuit is built from, again where values change. */
struct dalcs_session_source {
    bool keeps_netlist;           /* it may be run with other values */
    struct dalcs_netlist netlist; /* kept where the circuit may have to be built again */
    bool has_netlist;
    bool is_altered;                 /* the circuit is not the netlist's with what alter said */
    struct dalcs_override *override; /* what alter said; heap */
    size_t n_altered, override_capacity;
    struct dalcs_override *own; /* of the present step; heap */
    size_t n_own;
    struct dalcs_steps steps;
    struct dalcs_drawn_value *unbuilt; /* [n_unbuilt] drawn for a step that could not be built */
    size_t n_unbuilt;
    const char *why_unbuilt; /* the first error of that; the arena's */
    size_t n_resets;         /* of a circuit with random values: each draws them anew */
};

/* Where the search for an orbit begins. */
struct dalcs_session_steady {
    struct dalcs_stroboscope *stroboscope; /* while .step is looked at with it; else NULL */
    struct dalcs_steady_near *near;        /* NULL: as it does */
    struct dalcs_steady_anchor anchor;
    struct dalcs_run_options anchor_options; /* that it was looked for with */
};

/* Of the last run. */
struct dalcs_session_results {
    enum dalcs_status ended;
    struct dalcs_recorder recorder; /* owns the report's events and jumps */
    struct dalcs_report report;
    bool has_report;
    char *document; /* the last one handed out as text; heap */
    double *start, *final;
    struct dalcs_nonunique *nonunique; /* of the report */
    size_t n_nonunique, nonunique_capacity;
    struct dalcs_spice_names spice; /* made when first asked for */
};

struct dalcs_session {
    char *name;
    struct dalcs_dialect dialect; /* that the netlist will be read in, if it is told */
    struct dalcs_asks asks;       /* of the next run */
    struct dalcs_session_source source;
    struct dalcs_diag diag;
    struct dalcs_circuit circuit;
    bool has_circuit;
    struct dalcs_network network;
    bool has_network;
    struct dalcs_lu_patterns patterns; /* of modes, kept from step to step: values do not matter */

    struct { /* what external sources are told by; exchange may be NULL */
        enum dalcs_status (*exchange)(void *user, struct dalcs_exchange *e);
        void *user;
    } outside;

    struct { /* what runs start with; heap, names are the arena's */
        struct dalcs_set_state *state;
        size_t n, capacity;
    } initial;

    struct dalcs_session_steady steady;
    struct dalcs_session_results results;
    atomic_bool
        is_cancelled; /* written by other threads and signal handlers, which write nothing else */
    const atomic_bool *is_cancelled_with; /* of the session that it works for; NULL: its own */
    struct dalcs_arena arena;             /* names of the report and of the plots */
    struct dalcs_arena checked;           /* the last check */
    struct dalcs_arena audited;           /* the last audit of a table */
};

/* In the order of dalcs_method_name. */
enum dalcs_method {
    DALCS_METHOD_AUTO,
    DALCS_METHOD_RADAU,
    DALCS_METHOD_LOBATTO,
    DALCS_METHOD_EULER
};

/* What the audit has found at operating points and frequencies. */
struct dalcs_audited_points {
    long n, positions, frequencies;
    double worst, allowed;
    const char *where; /* NULL: nothing was audited */
};

struct dalcs_run {
    struct dalcs_session *s;
    const struct dalcs_run_options *options;
    const struct dalcs_sink *sink;

    /* From here to rows: chosen by dalcs_run_choose. */
    struct dalcs_osnsp_options osnsp;
    enum dalcs_method method;
    double tolerance; /* of radau and auto */
    double h;         /* s; the step of euler */

    struct dalcs_run_radau {
        double abstol, vntol; /* A, V; allowed on top of the tolerance */
        enum dalcs_family family;
        int stages;        /* of it; 0: not asked for */
        double fixed_step; /* s; without error control; 0: with it */
        double max_step;   /* s; with error control; 0: no bound */
    } radau;

    struct dalcs_run_rows {
        double compress; /* 0: keep all */
        double fill;     /* INFINITY: add none */
        bool lines;      /* of filled rows */
    } rows;

    const struct dalcs_orbit_point *orbit; /* where .tran starts; NULL: as the netlist says */
    struct dalcs_orbit_point *orbit_end;   /* receives the end of such a run; may be NULL */
    bool leaves_orbit;                     /* that is a .tran of its own; else a period of .pss */
    struct dalcs_stage_store *store;  /* of the runs of a search for a steady state; NULL: none */
    struct dalcs_steady_known *known; /* what .pss has found, for .ac behind it; NULL: nothing */

    struct dalcs_run_measures {             /* [n_measures] each */
        struct dalcs_measurement *reported; /* of the report; NULL: none yet */
        double *result;                     /* NAN: could not be measured */
    } measures;

    struct dalcs_audited_points points;
    const struct dalcs_location *response_at; /* the card of the response at hand; NULL: .ac */
    const struct dalcs_plot *step;            /* its step and parameters; NULL without .step */

    struct dalcs_run_signals { /* [n_outputs] each, of the network: */
        const char **name;     /* rows have the first n_shown, messages may name any */
        enum dalcs_unit *unit;
    } signals;

    struct dalcs_names interrupting; /* switches that a warning has named */

    struct dalcs_run_transient {                 /* of the one that runs */
        struct dalcs_losses_run *losses;         /* NULL: none */
        struct dalcs_impulses *impulses;         /* NULL: nothing asks for them */
        struct dalcs_cosimulation *cosimulation; /* likewise */
    } transient;

    struct dalcs_run_nonunique { /* what is not determined */
        struct dalcs_undetermined undetermined;
        int n_told[DALCS_FINDING_KINDS];    /* messages of it */
        long n_untold[DALCS_FINDING_KINDS]; /* signals of which there is no message */
        long n_unreported;                  /* and no entry in the report */
    } nonunique;
};

/* Does the run keep a ledger of energies? A system file has no devices to keep it of. */
static inline bool dalcs_run_keeps_ledger(const struct dalcs_run *r) {
    return r->options->energy && r->s->circuit.n_devices > 0;
}

/* Reports the progress to the sink. An error ends the run: of the sink, or after dalcs_session_cancel. */
enum dalcs_status dalcs_run_progress(const struct dalcs_run *r, double time,
                                     double stop) DALCS_MUST_CHECK;

/* Settles what the options of the run and of the netlist leave open; checks them. */
enum dalcs_status dalcs_run_choose(struct dalcs_run *r) DALCS_MUST_CHECK;

/* The caller's options as this library has them (sized_options.c). */
enum dalcs_status dalcs_run_options_take(struct dalcs_session *session,
                                         const struct dalcs_run_options *given,
                                         struct dalcs_run_options *own) DALCS_MUST_CHECK;

/* The option of the run, else that of the netlist, else the default. */
double dalcs_run_tolerance(const struct dalcs_run_options *options,
                           const struct dalcs_circuit *circuit);

/* Takes the tangents of exponential diodes at the currents that they carry. */
enum dalcs_status dalcs_operating_currents(struct dalcs_session *session,
                                           const struct dalcs_run_options *options,
                                           const struct dalcs_sink *sink) DALCS_MUST_CHECK;

/* The same circuit with another value has its tangents at the same currents; its network is built again where it has
 * exponential diodes. After an error there is none. */
enum dalcs_status dalcs_operating_currents_keep(struct dalcs_circuit *to,
                                                struct dalcs_network *network,
                                                const struct dalcs_circuit *from,
                                                struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* Runs one analysis of the session's circuit. */
enum dalcs_status dalcs_session_run_analysis(struct dalcs_session *session,
                                             const struct dalcs_run_options *options,
                                             const struct dalcs_sink *sink,
                                             enum dalcs_analysis analysis) DALCS_MUST_CHECK;

/* ---- steps.c: one circuit after the other ------------------------------------------------------ */

/* The steps of the session's circuit, if they are not known yet: it is that of no step then. */
enum dalcs_status dalcs_steps_find(struct dalcs_session *session) DALCS_MUST_CHECK;

/* How often .step and .mc have everything run; 1 without. */
size_t dalcs_steps_count(const struct dalcs_session *session);

/* Makes the values that were set the initial values of the circuit's elements. */
void dalcs_session_apply_states(const struct dalcs_session *session, struct dalcs_circuit *circuit);

/* A circuit and its network from the session's netlist, with what alter says and the overrides behind
 * that. Messages that the session has not said yet go to it. On failure nothing is left to free. */
enum dalcs_status dalcs_session_build(struct dalcs_session *session,
                                      const struct dalcs_override *more, size_t n_more,
                                      struct dalcs_circuit *circuit,
                                      struct dalcs_network *network) DALCS_MUST_CHECK;

/* What was drawn with these overrides, for a circuit that is none; DALCS_E_NETLIST, or DALCS_E_NOMEM. */
enum dalcs_status dalcs_drawn_keep_unbuilt(struct dalcs_session *session,
                                           const struct dalcs_override *override,
                                           size_t n_overrides) DALCS_MUST_CHECK;

/* Builds the session's circuit again that way. */
enum dalcs_status dalcs_session_rebuild(struct dalcs_session *session,
                                        const struct dalcs_override *more,
                                        size_t n_more) DALCS_MUST_CHECK;

/* The same with .step's values of step k, which *plot gets too; arrays are the session's. */
enum dalcs_status dalcs_session_take_step(struct dalcs_session *session, size_t k,
                                          struct dalcs_plot *plot) DALCS_MUST_CHECK;

/* The override that a value of a sweep is; false for one of the temperature. */
bool dalcs_override_of(const struct dalcs_sweep *sweep, double value,
                       struct dalcs_override *override);

/* Runs .dc into r->sink. */
enum dalcs_status dalcs_dc_sweep_run(struct dalcs_run *r) DALCS_MUST_CHECK;

/* Runs .tf into r->sink. */
enum dalcs_status dalcs_transfer_function_run(struct dalcs_run *r) DALCS_MUST_CHECK;

/* Runs .ac into r->sink. */
enum dalcs_status dalcs_small_signal_run(struct dalcs_run *r) DALCS_MUST_CHECK;

/* dalcs_transient_run with fewer rows, if that is asked for. */
enum dalcs_status dalcs_transient_run_thinned(struct dalcs_run *r) DALCS_MUST_CHECK;

/* Frees what the last run left. */
void dalcs_session_forget_run(struct dalcs_session *session);

/* Frees a session that another one made of its own netlist, with other values. */
void dalcs_session_finish_other(struct dalcs_session *other);

/* Starts a .tran; radau is NULL with implicit Euler. logic: its gates, if there are any. has_rows: else it is a period of
 * a search for a steady state: the recorder gets nothing of it. */
enum dalcs_status dalcs_transient_start(struct dalcs_run *r, struct dalcs_euler *e,
                                        struct dalcs_radau *radau, struct dalcs_logic_run *logic,
                                        bool has_rows) DALCS_MUST_CHECK;

/* As dalcs_run_choose has chosen them. */
struct dalcs_radau_options dalcs_transient_options(const struct dalcs_run *r, double stop);

/* Runs .tran into r->sink. */
enum dalcs_status dalcs_transient_run(struct dalcs_run *r) DALCS_MUST_CHECK;

/* Watches the currents of exponential diodes and MOSFETs; after the run, says which the idealised element is wrong for. */
enum dalcs_status dalcs_currents_watch(struct dalcs_run *r) DALCS_MUST_CHECK;
void dalcs_currents_judge(struct dalcs_run *r);

/* Hands a jump to the recorder, and warns once of each switch that interrupts a coil; user is the run.
 */
enum dalcs_status dalcs_note_jump(void *user, const struct dalcs_euler_jump *jump) DALCS_MUST_CHECK;

/* Names and units of the signals into r; `copies`: they outlive the circuit. */
enum dalcs_status dalcs_run_name_signals(struct dalcs_run *r, bool copies) DALCS_MUST_CHECK;

/* Announces a plot to the sink. */
enum dalcs_status dalcs_run_begin_plot(struct dalcs_run *r,
                                       enum dalcs_analysis analysis) DALCS_MUST_CHECK;

/* The same of one that is not as usual: analysis, scale, signals and is_complex are filled in. */
enum dalcs_status dalcs_run_announce(struct dalcs_run *r,
                                     const struct dalcs_plot *plot) DALCS_MUST_CHECK;

/* The counts of one engine run into the report. */
void dalcs_run_add_work(struct dalcs_run *r, const struct dalcs_euler *e);

/* dalcs_undetermined's on_finding: a warning, and entries of the report; user is the run. */
enum dalcs_status dalcs_nonunique_found(void *run,
                                        const struct dalcs_finding *finding) DALCS_MUST_CHECK;

/* At the end: how many there were besides. */
void dalcs_nonunique_count_rest(struct dalcs_run *r);

/* Which shorts close a loop with the devices that is_named[n_devices] marks: is_part[n_devices], zeroed
 * by the caller. */
enum dalcs_status dalcs_loop_shorts_find(const struct dalcs_circuit *circuit, const bool *is_named,
                                         bool *is_part) DALCS_MUST_CHECK;

/* ---- held_coils.c ---------------------------------------------------------------------------- */

/* The operating point of `held`, in which .ic are: coils do not carry what goes around loops with them. */
enum dalcs_status dalcs_held_coils_rest(const struct dalcs_circuit *circuit,
                                        struct dalcs_euler *held) DALCS_MUST_CHECK;

#endif
