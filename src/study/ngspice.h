/* ngspice.h - runs ngspice on the session's circuit and reads its answer. */
#ifndef DALCS_NGSPICE_H
#define DALCS_NGSPICE_H

#include "ngspice_raw.h"
#include "reference.h"

enum { DALCS_NGSPICE_TEXT_SIZE = 256 };

struct dalcs_ngspice {
    const char *program; /* borrowed: "ngspice", or a path */
    double limit;        /* s of CPU time, for each run; 0: none */
    const volatile sig_atomic_t *interrupted;
    char *folder;       /* temporary */
    char *deck, *raw;   /* paths in it */
    char version[64];   /* "ngspice-39" */
    double start_cpu_s; /* of a process that reads the netlist and runs nothing */
};

/* Makes the folder and asks for the version. On failure message says why. */
enum dalcs_status dalcs_ngspice_open(struct dalcs_ngspice *ngspice, const char *program,
                                     double limit, const volatile sig_atomic_t *interrupted,
                                     char message[DALCS_NGSPICE_TEXT_SIZE]) DALCS_MUST_CHECK;

/* Removes the folder. Accepts a zeroed one. */
void dalcs_ngspice_close(struct dalcs_ngspice *ngspice);

/* Measures start_cpu_s with that netlist. */
enum dalcs_status dalcs_ngspice_time_start(struct dalcs_ngspice *ngspice,
                                           const char *netlist) DALCS_MUST_CHECK;

struct dalcs_ngspice_run {
    char reason[DALCS_NGSPICE_TEXT_SIZE]; /* why it gave up, in its words; "": it did not */
    bool is_too_slow;                     /* it was ended at the limit */
    double reached;                       /* s */
    double cpu_s;                         /* of its process less start_cpu_s, at least 0.1 ms */
    struct dalcs_ngspice_raw raw;
};

/* Runs a netlist up to `stop`. Giving up is no failure. */
enum dalcs_status dalcs_ngspice_simulate(struct dalcs_ngspice *ngspice, const char *netlist,
                                         double stop,
                                         struct dalcs_ngspice_run *run) DALCS_MUST_CHECK;

/* value[n_times * n_signals]: its answer at the reference's times, from the straight line between its
 * points or the cubic through four, whichever is nearer to the reference. */
enum dalcs_status dalcs_ngspice_sample(const struct dalcs_ngspice_raw *raw,
                                       const struct dalcs_reference *reference,
                                       double *value) DALCS_MUST_CHECK;

void dalcs_ngspice_run_finish(struct dalcs_ngspice_run *run);

#endif
