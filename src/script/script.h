/* script.h - runs the .control block of a netlist.
 *
 *     lines -> statements (statement.c) -> runs of the session, vectors (vectors.c), formulas of them
 *     (vector_formula.c) -> text and files (writing.c)
 *
 * The whole block is checked before anything runs: what no simulator knows is an error, what other
 * simulators know and is skipped here a warning for each word. */
#ifndef DALCS_SCRIPT_H
#define DALCS_SCRIPT_H

#include "dalcs.h"

#include <stdio.h>

struct dalcs_plot_vectors;

/* What the script works with; borrowed. */
struct dalcs_script_host {
    struct dalcs_session *session;
    const struct dalcs_run_options *options;
    const struct dalcs_sink *sink; /* gets all results, besides the script */
    FILE *out;                     /* of print and echo */
    void *user;
    const char *const *set; /* [n_set] what is set before: "name", "name=value" */
    size_t n_set;
    bool
        is_strict; /* a command that has no equivalent is an error: a program waits for its result */
    bool lacks_circuit; /* nothing can be run or altered: the netlist stands for none */
    /* Does the host execute this word itself? NULL: none. */
    bool (*knows)(void *user, const char *word);
    enum dalcs_status (*execute)(void *user, const char *word, const char *rest);
    /* A measurement that follows no analysis of the same lines; NULL: it is left out. */
    enum dalcs_status (*measure)(void *user, const char *rest);
    /* Before what sets, makes or alters something, or runs, with variables replaced; may be NULL. */
    enum dalcs_status (*heard)(void *user, const char *word, const char *rest);
    /* A command has made a plot of vectors, which is the current one now: linearize, fft. May be NULL. */
    enum dalcs_status (*made)(void *user, const struct dalcs_plot_vectors *plot);
    /* What the host calls the plot that has just begun, or that was made; NULL: the script names them. */
    const char *(*name_of_plot)(void *user);
    /* After each run, while the session has its report; may be NULL. */
    void (*after_run)(void *user, struct dalcs_session *session, enum dalcs_status status);
};

struct dalcs_script;
struct dalcs_vectors;

/* For a host that gives lines as they come: variables, saved signals and options last from one call to the
 * next. The host outlives the script, whose vectors it may read and set between calls. */
enum dalcs_status dalcs_script_open(struct dalcs_script **script,
                                    const struct dalcs_script_host *host) DALCS_MUST_CHECK;

/* Reads lines `first` to `end` - 1 of the session's script. DALCS_E_NETLIST: an error in their words; nothing
 * may be executed. */
enum dalcs_status dalcs_script_read(struct dalcs_script *script, size_t first,
                                    size_t end) DALCS_MUST_CHECK;

/* Of which the host may set those that the lines name (dalcs_vectors_is_used). */
struct dalcs_vectors *dalcs_script_vectors_of(struct dalcs_script *script);

/* Of `set`; NULL: it is not set. */
const char *dalcs_script_variable(const struct dalcs_script *script, const char *name);

/* What was read. *quits, unless NULL: the script said so. */
enum dalcs_status dalcs_script_execute(struct dalcs_script *script, bool *quits) DALCS_MUST_CHECK;

/* Another circuit, or none: what was saved and set as an option is forgotten. */
void dalcs_script_change_circuit(struct dalcs_script *script);

/* Accepts NULL. */
void dalcs_script_close(struct dalcs_script *script);

/* *is_there: is there a block with anything in it, and which is the main analysis of those that it names itself?
 * *main is left as it is when there is none. */
enum dalcs_status dalcs_script_look(const struct dalcs_session *session, bool *is_there,
                                    enum dalcs_analysis *main) DALCS_MUST_CHECK;

/* Runs it, after a `run` if it asks for no analysis at all. Messages go to the session. DALCS_E_NETLIST: an error in the script. */
enum dalcs_status dalcs_script_run(const struct dalcs_script_host *host) DALCS_MUST_CHECK;

#endif
