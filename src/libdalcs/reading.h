/* reading.h - sessions, the netlist they read, and what it asks for. Part of dalcs.h, which includes it. */
#ifndef LIBDALCS_READING_H
#define LIBDALCS_READING_H

#ifndef DALCS_H
#error "include dalcs.h"
#endif

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

/* That of the netlist that was read, or 1. */
double dalcs_session_seed(const struct dalcs_session *session);

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
    bool transfer;   /* .tf */
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

#endif
