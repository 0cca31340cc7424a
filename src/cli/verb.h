/* verb.h - what the command lines of several verbs share. */
#ifndef DALCS_VERB_H
#define DALCS_VERB_H

#include "atomic_file.h"
#include "cli.h"

#include <getopt.h>

/* Reports the error of getopt_long with this code and returns DALCS_E_OPTION. `option` ends with zeros. */
enum dalcs_status dalcs_verb_refuse(const struct dalcs_cli *cli, const char *verb,
                                    const struct option *option, int code, char **argv);

/* The one netlist that is left at argv[optind], or a message. */
/* Says that `word` is one too many, and for which option it was probably meant. */
void dalcs_verb_one_too_many(const struct dalcs_cli *cli, const char *verb, const char *word);

enum dalcs_status dalcs_verb_take_netlist(const struct dalcs_cli *cli, const char *verb, int argc,
                                          char **argv, const char **netlist) DALCS_MUST_CHECK;

/* The value of option `name`, a number greater than 0 in the spelling of netlists, or a message. */
enum dalcs_status dalcs_verb_take_positive(const struct dalcs_cli *cli, const char *name,
                                           const char *text, double *value) DALCS_MUST_CHECK;

/* ... a whole number from 1 on. */
enum dalcs_status dalcs_verb_take_count(const struct dalcs_cli *cli, const char *name,
                                        const char *text, size_t *count) DALCS_MUST_CHECK;

/* An output named `path` must have one of these endings, NULL at the end, and must not be the
 * netlist. */
enum dalcs_status dalcs_verb_check_output(const struct dalcs_cli *cli, const char *path,
                                          const char *const *ending,
                                          const char *netlist) DALCS_MUST_CHECK;

/* Parts of a list separated by commas: up to `most` of them, terminated in place. DALCS_E_OPTION where
 * one is empty or there are more. */
enum dalcs_status dalcs_verb_split(char *list, const char **part, size_t most,
                                   size_t *n) DALCS_MUST_CHECK;

/* The value of --dialect, or a message. */
enum dalcs_status dalcs_verb_take_dialect(const struct dalcs_cli *cli, const char *text,
                                          const char **dialect) DALCS_MUST_CHECK;

/* Reads the netlist into the session, in this dialect; NULL: the one that its cards show. */
enum dalcs_status dalcs_verb_read(struct dalcs_session *session, const char *netlist,
                                  const char *dialect) DALCS_MUST_CHECK;

/* A session that has read the netlist, which must have a .tran. Messages go to cli->err. */
enum dalcs_status dalcs_verb_open(const struct dalcs_cli *cli, const char *netlist,
                                  const char *dialect, struct dalcs_session **session,
                                  size_t *n_messages) DALCS_MUST_CHECK;

/* The session's messages that came since, errors only; where there are none, the status in words. */
void dalcs_verb_explain(const struct dalcs_cli *cli, const struct dalcs_session *session,
                        size_t n_messages, enum dalcs_status status);

/* Opens an output before the work begins, so that a path which cannot be written is known then. NULL:
 * there is none, and the other call does nothing. */
enum dalcs_status dalcs_verb_begin_output(const struct dalcs_cli *cli,
                                          struct dalcs_atomic_file *file,
                                          const char *path) DALCS_MUST_CHECK;

/* Gives it its name when all went well so far, else removes it. */
enum dalcs_status dalcs_verb_end_output(const struct dalcs_cli *cli, struct dalcs_atomic_file *file,
                                        const char *path,
                                        enum dalcs_status so_far) DALCS_MUST_CHECK;

#endif
