/* settings.h - --set NAME=VALUE. */
#ifndef DALCS_SETTINGS_H
#define DALCS_SETTINGS_H

#include "arguments.h"

/* One of them: a name, and a number in the spelling of netlists; or a message. */
enum dalcs_status dalcs_settings_check(const struct dalcs_cli *cli,
                                       const char *text) DALCS_MUST_CHECK;

/* What a checked one says; the name's length is how much of `text` it is. */
double dalcs_settings_value(const char *text, size_t *name_length);

/* The number of threads: that of --jobs, else the number of processors. */
size_t dalcs_settings_threads(const struct dalcs_arguments *arguments);

/* Passes options of the command line to a session that has not read a netlist. */
enum dalcs_status dalcs_settings_prepare(struct dalcs_session *session,
                                         const struct dalcs_arguments *arguments) DALCS_MUST_CHECK;

/* A .control block with a `tran` of its own does not take --tran and --tstop: DALCS_E_OPTION, with a message. */
enum dalcs_status
dalcs_settings_check_script(const struct dalcs_cli *cli, const struct dalcs_session *session,
                            const struct dalcs_arguments *arguments) DALCS_MUST_CHECK;

/* All of them for a netlist that was read and is kept; the session's messages say what is wrong. */
enum dalcs_status dalcs_settings_apply(struct dalcs_session *session,
                                       const struct dalcs_arguments *arguments) DALCS_MUST_CHECK;

#endif
