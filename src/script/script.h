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

/* What the script works with; borrowed. */
struct dalcs_script_host {
    struct dalcs_session *session;
    const struct dalcs_run_options *options;
    const struct dalcs_sink *sink; /* gets all results, besides the script */
    FILE *out;                     /* of print and echo */
    void *user;
    /* After each run, while the session has its report; may be NULL. */
    void (*after_run)(void *user, struct dalcs_session *session, enum dalcs_status status);
};

/* *is_there: is there a block with anything in it, and which is the main analysis of those that it names itself?
 * *main is left as it is when there is none. */
enum dalcs_status dalcs_script_look(const struct dalcs_session *session, bool *is_there,
                                    enum dalcs_analysis *main) DALCS_MUST_CHECK;

/* Runs it, after a `run` if it asks for no analysis at all. Messages go to the session. DALCS_E_NETLIST: an error in the script. */
enum dalcs_status dalcs_script_run(const struct dalcs_script_host *host) DALCS_MUST_CHECK;

#endif
