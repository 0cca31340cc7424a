/* variants.h - a netlist with .step of which a table of its measurements is all that is wanted. */
#ifndef DALCS_VARIANTS_H
#define DALCS_VARIANTS_H

#include "arguments.h"

/* Is it that? With a message where the command line says so and it cannot be. */
enum dalcs_status dalcs_variants_ask(const struct dalcs_cli *cli,
                                     const struct dalcs_arguments *arguments,
                                     const struct dalcs_session *session, bool has_script,
                                     bool *wanted) DALCS_MUST_CHECK;

/* Runs them; the session has read the netlist. DALCS_NOT_CONVERGED: some failed, which a message counts and the table
 * explains. */
enum dalcs_status dalcs_variants_run(const struct dalcs_cli *cli,
                                     const struct dalcs_arguments *arguments,
                                     const struct dalcs_session *session,
                                     const struct dalcs_run_options *options) DALCS_MUST_CHECK;

#endif
