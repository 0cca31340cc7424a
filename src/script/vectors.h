/* vectors.h - results in memory, for the formulas of a .control block.
 *
 * The plot of the last run, and what `let` made before any run, which all later ones can see. */
#ifndef DALCS_VECTORS_H
#define DALCS_VECTORS_H

#include "dalcs.h"
#include "memory.h"

#include <complex.h>

struct dalcs_vector {
    const char *name; /* "v(out)", "time" */
    enum dalcs_unit unit;
    size_t n;
    bool is_complex;
    double complex *value; /* [n] */
};

struct dalcs_plot_vectors {
    enum dalcs_analysis analysis;
    const char *title;
    struct dalcs_vector **vector; /* [n] heap; the scale first, but for an operating point */
    size_t n, capacity;
    struct dalcs_arena arena; /* names, values of `let` */
};

/* Zero-initialise. */
struct dalcs_vectors {
    const char *text; /* of the whole script, lower case without blanks: what it may name */
    const struct dalcs_session *session; /* whose parameters formulas may name */
    bool keeps_all;
    bool has_plot;
    bool prefers_parameters;        /* to node voltages: in braces */
    struct dalcs_plot_vectors plot; /* of the last run */
    struct dalcs_plot_vectors own;  /* what was made without one */
    size_t *column;                 /* of each kept signal; heap, of the plot being received */
    size_t n_columns, row_capacity;
};

/* The callbacks of struct dalcs_sink. */
enum dalcs_status dalcs_vectors_begin(struct dalcs_vectors *vectors, const struct dalcs_plot *plot);
enum dalcs_status dalcs_vectors_row(struct dalcs_vectors *vectors, double scale,
                                    const double *value);

/* May the script ask for this signal? */
bool dalcs_vectors_is_used(const struct dalcs_vectors *vectors, const char *name);

/* By any of its names: v(out), out, i(l1), l1#branch, @l1[i], time; NULL: there is none. */
const struct dalcs_vector *dalcs_vectors_find(const struct dalcs_vectors *vectors,
                                              const char *name);

/* The same by its own name alone. */
const struct dalcs_vector *dalcs_vectors_find_exactly(const struct dalcs_vectors *vectors,
                                                      const char *name);

/* The scale of the present plot: the first vector; NULL without one. */
const struct dalcs_vector *dalcs_vectors_scale(const struct dalcs_vectors *vectors);

/* Makes or replaces a vector in the present plot; copies. */
enum dalcs_status dalcs_vectors_let(struct dalcs_vectors *vectors, const char *name,
                                    const struct dalcs_vector *value) DALCS_MUST_CHECK;

/* All vectors. */
void dalcs_vectors_forget(struct dalcs_vectors *vectors);

void dalcs_vectors_finish(struct dalcs_vectors *vectors);

#endif
