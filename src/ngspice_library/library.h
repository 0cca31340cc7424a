/* library.h - the one simulator that a process has through libngspice.so.0, and what its files share.
 *
 *     interface.c   what programs call to begin, with commands and circuits
 *     results.c     what they ask for
 *     execute.c     lines of commands and circuits -> the language of .control (src/script)
 *     commands.c    commands that are not of that language: plots, circuits
 *     measure.c     meas after a run
 *     lending.c     plots <-> the vectors of that language
 *     receive.c     rows -> plots, and the program's callbacks
 *     background.c  bg_run, bg_halt, bg_resume
 *
 * The interface has no handle, so there is one of it in a process. */
#ifndef DALCS_NG_LIBRARY_H
#define DALCS_NG_LIBRARY_H

#include "background.h"
#include "circuit.h"
#include "plots.h"
#include "script.h"
#include "talk.h"

/* The arguments of ngSpice_Init; any may be NULL. At the end of the program all become NULL while a thread may be about to
 * call one: it reads each once. */
struct ng_callbacks {
    ng_send_status *_Atomic status;
    ng_controlled_exit *_Atomic exit;
    ng_send_data *_Atomic data;
    ng_send_init_data *_Atomic init_data;
};

/* Of one row, as SendData gets it. */
struct ng_sent_row {
    struct ng_row row;
    struct ng_value *value;    /* [n]; heap */
    struct ng_value **pointer; /* [n]; heap */
};

struct ng_library {
    struct ng_callbacks tell;
    struct ng_talk talk;
    struct ng_plots plots;
    struct ng_circuit *circuit; /* never NULL: one that stands for none */
    struct ng_lines by_line;    /* of circbyline */
    char *input_path;           /* heap; NULL: none */
    struct dalcs_run_options options;
    struct dalcs_sink sink;
    struct dalcs_script_host host;
    struct dalcs_script *script;
    struct ng_background background;
    struct ng_sent_row sent;
    double told;              /* s; when progress was told last */
    bool is_open;             /* all of the above is there */
    bool control_waits;       /* set controlswait: .control runs after the background */
    bool has_waiting;         /* such a block is waiting */
    bool is_busy;             /* a command is executed */
    bool reads_no_start_file; /* before ngSpice_Init was called */
    bool fails;               /* the present command, in a part of which the script does not know */
};

/* ---- interface.c ---------------------------------------------------------------------------------- */

/* The interface has no handle: a process has one simulator. */
extern struct ng_library ng_the;

/* It is opened by the first call. */
bool ng_is_ready(void);

/* May something be executed now? What was halted ends; else the program is told. */
bool ng_is_free(const char *command);

/* ---- execute.c ------------------------------------------------------------------------------------ */

/* A circuit and interpreter that wait for commands. */
enum dalcs_status ng_library_open(struct ng_library *library) DALCS_MUST_CHECK;
void ng_library_close(struct ng_library *library);

/* Commands, `;` between them. false: one of them failed; the program was told. */
bool ng_execute(struct ng_library *library, const char *commands);

/* The circuit becomes the current one and its .control block is executed. */
bool ng_execute_circuit(struct ng_library *library, const char *name, const char *text);

/* A .control block that has waited. */
void ng_execute_waiting(struct ng_library *library);

/* No circuit, no plots, no variables. */
bool ng_forget_all(struct ng_library *library);
bool ng_forget_circuit(struct ng_library *library);

/* ---- lending.c ------------------------------------------------------------------------------------ */

/* The vectors of the current plot that the lines may name go to the interpreter; those that it made come back. */
enum dalcs_status ng_lend_vectors(struct ng_library *library) DALCS_MUST_CHECK;
enum dalcs_status ng_take_vectors(struct ng_library *library) DALCS_MUST_CHECK;

/* A plot that the interpreter has made becomes the current one. */
enum dalcs_status ng_take_plot(void *user, const struct dalcs_plot_vectors *made);
const char *ng_name_of_plot(void *user);

/* ---- commands.c ----------------------------------------------------------------------------------- */

bool ng_commands_know(void *user, const char *word);
enum dalcs_status ng_commands_execute(void *user, const char *word, const char *rest);

/* `set curplot = tran1` chooses a plot, `set curplot = new` makes one. */
enum dalcs_status ng_commands_hear_set(struct ng_library *library,
                                       const char *rest) DALCS_MUST_CHECK;

/* ---- measure.c ------------------------------------------------------------------------------------- */

/* "tran name MAX v(out)" of the last run of that kind. */
enum dalcs_status ng_measure(void *user, const char *rest);

/* ---- receive.c -------------------------------------------------------------------------------------- */

/* Fills library->sink and library->host.after_run. */
void ng_receive_open(struct ng_library *library);
void ng_receive_close(struct ng_library *library);

#endif
