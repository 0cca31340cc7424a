/* figure.h - the waveforms of a run as a picture: voltages above, currents below; beside them the
 * end of the run where it has too many periods to see one. */
#ifndef DALCS_FIGURE_H
#define DALCS_FIGURE_H

#include "atomic_file.h"
#include "curve.h"
#include "tail.h"

enum { DALCS_FIGURE_MAX_CURVES = 8 }; /* in a panel */

struct dalcs_figure_panel {
    enum dalcs_unit unit;
    size_t n_left_out;
    int n;
    size_t signal[DALCS_FIGURE_MAX_CURVES]; /* ascending indices into the row */
};

/* Both panels from start to stop. */
struct dalcs_figure_view {
    double start, stop;
    struct dalcs_curve curve[2][DALCS_FIGURE_MAX_CURVES];
    double largest[2];      /* magnitude that is to be seen; chooses the unit's prefix */
    double low[2], high[2]; /* of the axis: a margin wider */
    bool clipped[2];        /* impulses, which depend on the step, leave this range */
};

struct dalcs_figure {
    const char *path;              /* borrowed */
    const struct dalcs_plot *plot; /* borrowed; NULL until there is something to draw */
    size_t n_rows;
    struct dalcs_figure_panel panel[2];
    int n_views;
    struct dalcs_figure_view view[2]; /* the whole run, its end */
    struct dalcs_tail tail;           /* of the chosen signals */
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

/* Settles what is to be seen, once all rows are there. `report` knows the jumps; may be NULL. */
enum dalcs_status dalcs_figure_compose(struct dalcs_figure *figure,
                                       const struct dalcs_report *report) DALCS_MUST_CHECK;

/* Composes and draws with gnuplot. `left_at` is NULL for a complete run, which gets the file's name;
 * else see dalcs_atomic_file_keep. */
enum dalcs_status dalcs_figure_draw(struct dalcs_figure *figure, const struct dalcs_report *report,
                                    char **left_at) DALCS_MUST_CHECK;

void dalcs_figure_finish(struct dalcs_figure *figure);

#endif
