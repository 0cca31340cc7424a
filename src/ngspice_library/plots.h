/* plots.h - what runs have given: plots of vectors, in columns as ngspice's programs read them.
 *
 * The thread of a background run makes vectors longer while another one reads them. What it replaces by something
 * longer stays where it is until the plot is destroyed: programs hold pointers to it. */
#ifndef DALCS_NG_PLOTS_H
#define DALCS_NG_PLOTS_H

#include "dalcs.h"
#include "memory.h"
#include "ngspice_abi.h"
#include "vector.h"
#include "vectors.h"

#include <pthread.h>

struct ng_plot {
    enum dalcs_analysis analysis;
    char *type;             /* "tran1" */
    const char *kind;       /* "Transient Analysis" */
    char *title, *date;     /* of the circuit, of its beginning */
    bool has_scale;         /* vector[0] */
    struct dalcs_grid grid; /* of a transient */
    struct ng_vector **vector;
    size_t n, capacity;
};

/* Zero-initialise, then open. */
struct ng_plots {
    struct ng_plot **plot; /* in the order of their making; the first is "const" */
    size_t n, capacity;
    size_t current;
    int number;                 /* of the newest names; 0: none since all were destroyed */
    bool is_shared;             /* the run at hand goes on while the program reads */
    pthread_mutex_t lock;       /* held while vectors change */
    struct ng_vector_info info; /* what was handed out last */
    char **name;                /* list that was handed out last; heap */
};

enum dalcs_status ng_plots_open(struct ng_plots *plots) DALCS_MUST_CHECK;
void ng_plots_close(struct ng_plots *plots);

/* A new plot, which becomes the current one; its vectors are empty. */
enum dalcs_status ng_plots_begin(struct ng_plots *plots,
                                 const struct dalcs_plot *about) DALCS_MUST_CHECK;

/* An empty one without a scale, for what let makes ("unknown") and others. kind is borrowed for good. */
enum dalcs_status ng_plots_make(struct ng_plots *plots, const char *word, const char *kind,
                                const char *title) DALCS_MUST_CHECK;

/* Rows for the current plot, as a sink gets them. */
enum dalcs_status ng_plots_add_rows(struct ng_plots *plots, size_t n, const double *scale,
                                    const double *value) DALCS_MUST_CHECK;

struct ng_plot *ng_plots_current(const struct ng_plots *plots);

/* By "tran1", in any case; NULL: there is none. */
struct ng_plot *ng_plots_find(const struct ng_plots *plots, const char *type);

/* Makes it the current one; false: there is none. */
bool ng_plots_choose(struct ng_plots *plots, const char *type);

/* All but "const", or one. */
void ng_plots_destroy_all(struct ng_plots *plots);
bool ng_plots_destroy(struct ng_plots *plots, const char *type);

/* "out", "v(out)", "tran1.out", "const.pi"; NULL: there is none. */
struct ng_vector *ng_plots_vector(const struct ng_plots *plots, const char *name);

/* Of that plot, by its own name or its signal's. */
struct ng_vector *ng_plot_vector(const struct ng_plot *plot, const char *name);

/* Takes one of its vectors away; false: there is none. */
bool ng_plots_unlet(struct ng_plots *plots, struct ng_plot *plot, const char *name);

/* Makes or replaces one that is no signal of a run. */
enum dalcs_status ng_plots_set(struct ng_plots *plots, struct ng_plot *plot, const char *name,
                               enum dalcs_unit unit, bool is_complex, size_t n,
                               const double *value) DALCS_MUST_CHECK;

#endif
