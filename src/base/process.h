/* process.h - runs another program and waits for it, but not for ever. */
#ifndef DALCS_PROCESS_H
#define DALCS_PROCESS_H

#include "dalcs.h"

#include <signal.h>

struct dalcs_process {
    const char *const
        *argument; /* the program, looked up in PATH, and what follows; NULL at the end */
    const char *const *environment; /* NAME=VALUE, NULL at the end; NULL: this program's */
    FILE *input, *output, *errors;  /* its standard streams; input may be NULL: nothing to read */
    double limit;                   /* s of its CPU time; 0: none */
    const volatile sig_atomic_t *interrupted; /* not 0: end it; may be NULL */

    /* Set by the run. */
    bool is_missing;  /* there is no such program */
    bool is_too_slow; /* ended at the limit */
    int exit_status;  /* -1: ended by a signal */
    double cpu_s;     /* user and system */
};

/* DALCS_OK once it ran, whatever its exit status and even where it ran too long. DALCS_E_CANCELLED:
 * interrupted. DALCS_E_IO: it could not be started; is_missing, or errno, says why. */
enum dalcs_status dalcs_process_run(struct dalcs_process *process) DALCS_MUST_CHECK;

#endif
