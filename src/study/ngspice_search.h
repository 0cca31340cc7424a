/* ngspice_search.h - settings of ngspice, from its stock devices to near-ideal ones, and what each
 * gives. */
#ifndef DALCS_NGSPICE_SEARCH_H
#define DALCS_NGSPICE_SEARCH_H

#include "deviation.h"
#include "ngspice.h"

enum { DALCS_MAX_TRIALS = 128 };

struct dalcs_trial {
    struct dalcs_spice_options options;
    char reason[DALCS_NGSPICE_TEXT_SIZE]; /* why it gave up; "": it did not */
    bool is_too_slow;                     /* it was ended at the limit: no rescue helps */
    double reached;                       /* s */
    double cpu_s;
    size_t points;
    struct dalcs_deviation deviation; /* where it did not give up */
};

struct dalcs_ngspice_search {
    struct dalcs_ngspice *ngspice;           /* borrowed */
    const struct dalcs_reference *reference; /* borrowed */
    double step, edge;                       /* s; of the netlist, of gates */
    bool has_diodes, has_switches;
    int n_trials, n_gave_up;
    struct dalcs_trial trial[DALCS_MAX_TRIALS]; /* in the order tried */
    int stock,
        best; /* the most exact with stock devices; the most exact; -1: none got to the end */
    double *stock_value, *best_value; /* [n_times * n_signals] at the reference's times */
    char *best_netlist;
    void *user; /* told of each trial before it begins; may be NULL */
    void (*on_trial)(void *user, int n);
};

/* The errors, worst rms, for which the fastest setting is asked. */
enum { DALCS_N_LEVELS = 5 };

extern const double dalcs_error_level[DALCS_N_LEVELS];

/* Tries them, and times again what is fastest for each level. */
enum dalcs_status dalcs_ngspice_search_run(struct dalcs_ngspice_search *search) DALCS_MUST_CHECK;

/* The fastest trial of at most that error; -1: there is none. */
int dalcs_ngspice_search_fastest(const struct dalcs_ngspice_search *search, double level);

/* "D N=0.001; S Ron 1 mohm, Roff 1 Gohm; gear, reltol 1e-05, tmax 100 ns" */
void dalcs_trial_write(FILE *stream, const struct dalcs_ngspice_search *search,
                       const struct dalcs_spice_options *options);

/* Accepts a zeroed one. */
void dalcs_ngspice_search_finish(struct dalcs_ngspice_search *search);

#endif
