/* comparison.h - one netlist in dalcs and in ngspice: errors, times, points. */
#ifndef DALCS_COMPARISON_H
#define DALCS_COMPARISON_H

#include "ngspice_search.h"

enum { DALCS_MAX_ROWS = 24, DALCS_MAX_METHODS = 8 };

/* One setting of dalcs. */
struct dalcs_comparison_row {
    const char *method;
    double tolerance; /* of auto and radau */
    double step;      /* s; of euler */
    bool failed;      /* the rest is not set */
    struct dalcs_cost cost;
    struct dalcs_deviation deviation;
};

struct dalcs_comparison {
    const char *path;
    struct dalcs_session *session; /* borrowed; has read the netlist */
    const volatile sig_atomic_t *interrupted;
    struct dalcs_reference reference;
    double view; /* s; from here on waveforms are drawn */
    int n_rows;
    struct dalcs_comparison_row row[DALCS_MAX_ROWS]; /* the first: the first method as it comes */
    double *value;                                   /* of row 0, at the reference's times */
    struct dalcs_ngspice ngspice;
    struct dalcs_ngspice_search search;
};

/* Makes the comparison with ngspice already open; without a limit it gets one. `method` are names of dalcs's methods. The session's
 * messages say why dalcs failed. */
enum dalcs_status dalcs_comparison_make(struct dalcs_comparison *comparison,
                                        const char *const *method, int n_methods) DALCS_MUST_CHECK;

/* The fastest row of at most that error; -1: there is none. */
int dalcs_comparison_fastest(const struct dalcs_comparison *comparison, double level);

/* "auto, tolerance 1e-06" */
void dalcs_comparison_row_write(FILE *stream, const struct dalcs_comparison_row *row);

/* Accepts a zeroed one. */
void dalcs_comparison_finish(struct dalcs_comparison *comparison);

/* ---- For people ------------------------------------------------------------------------------ */

/* What was compared with what, a sentence a line, each after `before` and in front of `after`. */
void dalcs_comparison_write_method(FILE *stream, const struct dalcs_comparison *comparison,
                                   const char *before, const char *after);

/* What it comes to, likewise; ngspice's side of it first. */
void dalcs_comparison_write_verdict(FILE *stream, const struct dalcs_comparison *comparison,
                                    const char *before, const char *after);

void dalcs_comparison_write_text(FILE *stream, const struct dalcs_comparison *comparison);

/* One page of HTML with the figures in it, drawn by gnuplot; without it message says so, and the page
 * is complete but for them. */
enum dalcs_status dalcs_comparison_write_page(FILE *stream,
                                              const struct dalcs_comparison *comparison,
                                              char message[256]) DALCS_MUST_CHECK;

/* Scripts for gnuplot: error against time; waveforms of the least exact signals; their errors. */
void dalcs_comparison_draw_work(FILE *script, const struct dalcs_comparison *comparison);
void dalcs_comparison_draw_waveforms(FILE *script, const struct dalcs_comparison *comparison);
void dalcs_comparison_draw_errors(FILE *script, const struct dalcs_comparison *comparison);

#endif
