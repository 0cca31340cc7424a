/* convergence.h - errors of fixed steps, and the orders that they show. */
#ifndef DALCS_CONVERGENCE_H
#define DALCS_CONVERGENCE_H

#include "deviation.h"

/* One way to step. */
struct dalcs_stepping {
    const char *method; /* "euler" or "radau" */
    int stages;         /* of radau, else 0 */
};

struct dalcs_convergence_row {
    struct dalcs_stepping stepping;
    double step;         /* s */
    bool failed;         /* the rest is not set */
    double largest, rms; /* worst over the signals, over their scales */
    size_t worst;        /* the signal with the largest error */
    double order;        /* from the row before; NAN: the first, or too near to what is known */
    long steps;
    double cpu_s;
};

struct dalcs_convergence {
    const char *path;
    struct dalcs_session *session; /* borrowed; has read the netlist */
    const volatile sig_atomic_t *interrupted;
    struct dalcs_reference reference;
    size_t n_rows;
    struct dalcs_convergence_row *row; /* [n_rows] by stepping, then by falling step */
};

/* Runs all of step[n_steps], s, falling, each a fraction of the first, with each stepping.
 * DALCS_E_OPTION: no multiple of the first step is away from all breaks. */
enum dalcs_status dalcs_convergence_make(struct dalcs_convergence *convergence, const double *step,
                                         size_t n_steps, const struct dalcs_stepping *stepping,
                                         size_t n_steppings) DALCS_MUST_CHECK;

/* Rows from `first` on of one stepping; and the median of their orders, NAN when there are none. */
size_t dalcs_convergence_group(const struct dalcs_convergence *convergence, size_t first);
double dalcs_convergence_order(const struct dalcs_convergence *convergence, size_t first);

/* "euler", "radau, 3 stages" */
void dalcs_stepping_write(FILE *stream, const struct dalcs_stepping *stepping);

/* Accepts a zeroed one. */
void dalcs_convergence_finish(struct dalcs_convergence *convergence);

/* ---- For people ------------------------------------------------------------------------------ */

/* What was measured, a sentence a line, each after `before` and in front of `after`. */
void dalcs_convergence_write_method(FILE *stream, const struct dalcs_convergence *convergence,
                                    const char *before, const char *after);
void dalcs_convergence_write_text(FILE *stream, const struct dalcs_convergence *convergence);
void dalcs_convergence_write_csv(FILE *stream, const struct dalcs_convergence *convergence);

/* As dalcs_comparison_write_page. */
enum dalcs_status dalcs_convergence_write_page(FILE *stream,
                                               const struct dalcs_convergence *convergence,
                                               char message[256]) DALCS_MUST_CHECK;

#endif
