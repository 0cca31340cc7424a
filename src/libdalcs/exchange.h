/* exchange.h - co-simulation with other programs, and rows kept in memory. Part of dalcs.h, which includes it. */
#ifndef LIBDALCS_EXCHANGE_H
#define LIBDALCS_EXCHANGE_H

#ifndef DALCS_H
#error "include dalcs.h"
#endif

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

#endif
