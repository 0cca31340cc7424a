/* cli.h - the command line: verbs, what they print to, how they end. */
#ifndef DALCS_CLI_H
#define DALCS_CLI_H

#include "dalcs.h"

#include <signal.h>
#include <stdio.h>

/* The process's exit status. */
enum dalcs_exit {
    DALCS_EXIT_OK = 0,
    DALCS_EXIT_RUN = 1, /* the run failed: numerical, infeasible, cancelled, out of memory */
    DALCS_EXIT_USAGE = 2,
    DALCS_EXIT_NETLIST = 3,
    DALCS_EXIT_IO = 4,
};

/* Borrowed from main(). Results go to out, everything else to err. */
struct dalcs_cli {
    FILE *out, *err;
    bool err_is_terminal;
    const volatile sig_atomic_t *interrupted; /* not 0: stop soon */
    struct dalcs_session *volatile *running;  /* that a signal is to cancel; may be NULL */
};

enum dalcs_exit dalcs_cli_exit(enum dalcs_status status);

/* Runs the verb in argv[1]. */
enum dalcs_exit dalcs_cli_eval(const struct dalcs_cli *cli, int argc, char **argv);

/* "dalcs: error: ..." and a newline on err. */
void dalcs_cli_error(const struct dalcs_cli *cli, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Prints a message of a session; the program's name goes before one that has no place in a file. */
void dalcs_cli_write_message(const struct dalcs_cli *cli, const char *text);

/* Prints the session's messages that came since the last call; notes are not for `quiet`. */
void dalcs_cli_write_messages(const struct dalcs_cli *cli, const struct dalcs_session *session,
                              size_t *n_written, bool quiet);

/* One verb each; argv[0] is the verb. */
enum dalcs_exit dalcs_cli_run(const struct dalcs_cli *cli, int argc, char **argv);
enum dalcs_exit dalcs_cli_equations(const struct dalcs_cli *cli, int argc, char **argv);
enum dalcs_exit dalcs_cli_check(const struct dalcs_cli *cli, int argc, char **argv);
enum dalcs_exit dalcs_cli_audit(const struct dalcs_cli *cli, int argc, char **argv);
enum dalcs_exit dalcs_cli_plot(const struct dalcs_cli *cli, int argc, char **argv);
enum dalcs_exit dalcs_cli_compare(const struct dalcs_cli *cli, int argc, char **argv);
enum dalcs_exit dalcs_cli_converge(const struct dalcs_cli *cli, int argc, char **argv);
enum dalcs_exit dalcs_cli_as_ngspice(const struct dalcs_cli *cli, int argc, char **argv);

#endif
