/* row_grid.h - times at equal distances, for linearize and spectra. Private to this folder. */
#ifndef DALCS_ROW_GRID_H
#define DALCS_ROW_GRID_H

#include "script_internal.h"

enum { DALCS_MOST_GRID_ROWS = 100000000 };

/* How many times lie on it, by ngspice's rule; 0: none. */
size_t dalcs_grid_rows(const struct dalcs_grid *grid);

/* Time k of it. */
double dalcs_grid_time(const struct dalcs_grid *grid, size_t k);

/* The vector at these times; NULL: out of memory. */
double complex *dalcs_grid_sample(struct dalcs_script *script, const struct dalcs_vector *v,
                                  const struct dalcs_vector *scale, const struct dalcs_grid *grid,
                                  size_t n);

/* Is the plot one of a .tran? */
bool dalcs_plot_is_transient(const struct dalcs_plot_vectors *plot);

/* There is no transient to do this with. */
enum dalcs_status dalcs_grid_refuse_plot(struct dalcs_script *script,
                                         const struct dalcs_statement *s);

/* Tells of the plot that was made. */
enum dalcs_status dalcs_grid_tell_made(struct dalcs_script *script);

#endif
