/* vectors.h - results in memory, for the formulas of a .control block: plots of vectors, as ngspice has them.
 *
 * Each run makes a plot, "tran1", and so do linearize, fft and setplot new. One of them is the current one; its
 * vectors go by their own names, those of others by "tran1.v(out)". What `let` makes before any run is in
 * "const", which all can see. Older plots are kept where the script looks back at them. */
#ifndef DALCS_VECTORS_H
#define DALCS_VECTORS_H

#include "dalcs.h"
#include "memory.h"

#include <complex.h>
#include <stdint.h>

enum { DALCS_PLOT_TYPE = 32, DALCS_VECTOR_NAME = 256 };

struct dalcs_vector {
    const char *name; /* "v(out)", "time" */
    enum dalcs_unit unit;
    size_t n;
    bool is_complex;
    double complex *value;            /* [n] */
    const struct dalcs_vector *scale; /* of what a formula gives: that of its plot; NULL: none */
};

/* The grid that a transient's rows were asked for on. */
struct dalcs_grid {
    double start, step, stop; /* s; step 0: none */
};

struct dalcs_plot_vectors {
    enum dalcs_analysis analysis;
    char type[DALCS_PLOT_TYPE]; /* "tran1" */
    const char *kind;           /* "Transient Analysis" */
    const char *title;
    struct dalcs_vector **vector; /* [n] heap */
    size_t n, capacity;
    struct dalcs_vector *scale; /* one of them; NULL: none */
    struct dalcs_grid grid;
    struct dalcs_arena arena; /* names */
};

/* Zero-initialise. */
struct dalcs_vectors {
    const char *text; /* of the whole script, lower case without blanks: what it may name */
    struct dalcs_session *session; /* whose parameters and elements formulas may name */
    uint64_t *random;              /* where the row of random values is; the script's */
    bool in_degrees;               /* angles, as `set units = degrees` has them; else in radians */
    bool keeps_all;
    bool keeps_plots;                   /* the script may look back at older ones */
    bool prefers_parameters;            /* to node voltages: in braces */
    struct dalcs_plot_vectors own;      /* "const" */
    struct dalcs_plot_vectors **plot;   /* [n] heap, in the order of their making */
    struct dalcs_plot_vectors *current; /* one of them; NULL: own */
    size_t n, capacity;
    int number;     /* of the newest name of a plot */
    size_t *column; /* of each kept signal; heap, of the plot being received */
    size_t n_columns, row_capacity;
};

/* ---- vectors.c ------------------------------------------------------------------------------------ */

/* The callbacks of struct dalcs_sink. */
enum dalcs_status dalcs_vectors_begin(struct dalcs_vectors *vectors, const struct dalcs_plot *plot);
enum dalcs_status dalcs_vectors_row(struct dalcs_vectors *vectors, double scale,
                                    const double *value);

/* May the script read this signal? */
bool dalcs_vectors_is_used(const struct dalcs_vectors *vectors, const char *name);

/* By any of its names: v(out), out, i(l1), l1#branch, @l1[i], time; of the plot, else of "const". NULL: there is
 * none. */
const struct dalcs_vector *dalcs_vectors_find_in(const struct dalcs_vectors *vectors,
                                                 const struct dalcs_plot_vectors *plot,
                                                 const char *name);

/* The same of the current plot, or of the one before a dot: "tran1.out". */
const struct dalcs_vector *dalcs_vectors_find(const struct dalcs_vectors *vectors,
                                              const char *name);

/* The same by its own name alone. */
const struct dalcs_vector *dalcs_vectors_find_exactly(const struct dalcs_vectors *vectors,
                                                      const char *name);

/* The scale of the current plot; NULL without one. */
const struct dalcs_vector *dalcs_vectors_scale(const struct dalcs_vectors *vectors);

/* Makes or replaces a vector in the current plot, or in the one before a dot; copies. */
enum dalcs_status dalcs_vectors_let(struct dalcs_vectors *vectors, const char *name,
                                    const struct dalcs_vector *value) DALCS_MUST_CHECK;

/* Makes or replaces a vector in a plot, whose scale it becomes where there is none. */
enum dalcs_status dalcs_plot_set(struct dalcs_plot_vectors *plot, const char *name,
                                 const struct dalcs_vector *value) DALCS_MUST_CHECK;

/* All vectors. */
void dalcs_vectors_forget(struct dalcs_vectors *vectors);

void dalcs_vectors_finish(struct dalcs_vectors *vectors);

/* ---- plots.c --------------------------------------------------------------------------------------- */

/* Never NULL: "const" without another. */
const struct dalcs_plot_vectors *dalcs_plots_current(const struct dalcs_vectors *vectors);

/* A new plot without vectors, which becomes the current one: "tran" is called tran1, or tran2. */
enum dalcs_status dalcs_plots_make(struct dalcs_vectors *vectors, const char *word,
                                   const char *kind, const char *title) DALCS_MUST_CHECK;

/* "tran1", or "tran" for the newest of these; NULL: there is none. */
const struct dalcs_plot_vectors *dalcs_plots_find(const struct dalcs_vectors *vectors,
                                                  const char *type);

/* The plot before a dot, *rest is what follows it; the current plot, and *rest = name, where there is none. */
const struct dalcs_plot_vectors *dalcs_plots_split(const struct dalcs_vectors *vectors,
                                                   const char *name, const char **rest);

/* Makes it the current one. */
void dalcs_plots_choose(struct dalcs_vectors *vectors, const struct dalcs_plot_vectors *plot);

/* "const" stays. */
void dalcs_plots_destroy(struct dalcs_vectors *vectors, const struct dalcs_plot_vectors *plot);
void dalcs_plots_destroy_all(struct dalcs_vectors *vectors);

/* Takes a vector out of the current plot, or else of "const"; false: there is none. */
bool dalcs_plots_unlet(struct dalcs_vectors *vectors, const char *name);

/* Frees what it holds. */
void dalcs_plot_forget(struct dalcs_plot_vectors *plot);

#endif
