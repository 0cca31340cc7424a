/* script.h - the lines of .control, and runs with other cards and values. Part of dalcs.h, which includes it. */
#ifndef LIBDALCS_SCRIPT_H
#define LIBDALCS_SCRIPT_H

#ifndef DALCS_H
#error "include dalcs.h"
#endif

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

/* A value of an element, as the next run has it: "resistance" or "r" of R, "capacitance" or
 * "c", "inductance" or "l", "gain" of E, F, G and H, "dc", "acmag" and "acphase" (degrees) of V and I. Lower case.
 * DALCS_E_OPTION: there is no such element, or it has no such value. Only for a netlist with a script. */
enum dalcs_status dalcs_session_element_value(struct dalcs_session *session, const char *name,
                                              const char *field, double *value) DALCS_MUST_CHECK;

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

#endif
