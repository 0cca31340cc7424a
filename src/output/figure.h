/* figure.h - the waveforms of a run as a picture: voltages above, currents below. */
#ifndef DALCS_FIGURE_H
#define DALCS_FIGURE_H

#include "atomic_file.h"
#include "curve.h"

enum { DALCS_FIGURE_MAX_CURVES = 8 }; /* in a panel */

struct dalcs_figure_panel {
    enum dalcs_unit unit;
    size_t n_left_out;
    int n;
    size_t signal[DALCS_FIGURE_MAX_CURVES]; /* ascending indices into the row */
    struct dalcs_curve curve[DALCS_FIGURE_MAX_CURVES];
};

struct dalcs_figure {
    const char *path;              /* borrowed */
    const struct dalcs_plot *plot; /* borrowed; NULL until there is something to draw */
    double start, stop;
    size_t n_rows;
    struct dalcs_figure_panel panel[2];
    struct dalcs_atomic_file file;
    char message[256]; /* why drawing failed; "" when file.error says it */
};

/* True for .svg and .png, in any case. */
bool dalcs_figure_can_write(const char *path);

/* The time axis goes from `start` to `stop`. */
void dalcs_figure_init(struct dalcs_figure *figure, const char *path, double start, double stop);

/* The callbacks of struct dalcs_sink; an operating point is not drawn. Begin opens the file, so
 * that a path which cannot be written is known before the run. */
enum dalcs_status dalcs_figure_begin(struct dalcs_figure *figure, const struct dalcs_plot *plot);
void dalcs_figure_row(struct dalcs_figure *figure, double time, const double *value);

/* Draws with gnuplot. `left_at` is NULL for a complete run, which gets the file's name; else see
 * dalcs_atomic_file_keep. */
enum dalcs_status dalcs_figure_draw(struct dalcs_figure *figure, char **left_at) DALCS_MUST_CHECK;

void dalcs_figure_finish(struct dalcs_figure *figure);

#endif
