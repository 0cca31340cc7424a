/* figure.h - waveforms as a picture: a panel for each unit, voltages above currents; below them when
 * diodes and switches conduct; beside them the end of the run where it has too many periods to see
 * one. */
#ifndef DALCS_FIGURE_H
#define DALCS_FIGURE_H

#include "atomic_file.h"
#include "conduction.h"
#include "curve.h"
#include "tail.h"
#include "theme.h"

/* V, A: a signal that stays below is the rounding of a 0, some 50 units in the last place of 1 V or 1 A. */
#define DALCS_FIGURE_NOTHING 1e-14

enum { DALCS_FIGURE_MAX_CURVES = 8 /* in a panel */, DALCS_FIGURE_MAX_PANELS = 8 };

/* In pixels, or hundredths of an inch. A narrower picture has the same text in smaller panels. */
enum { DALCS_FIGURE_WIDTH = 1200, DALCS_FIGURE_LEAST_WIDTH = 400, DALCS_FIGURE_MOST_WIDTH = 4000 };

struct dalcs_figure_panel {
    const char *quantity, *unit; /* "voltage", "V"; borrowed, unit "" for numbers */
    size_t n_left_out;
    int n;
    size_t signal[DALCS_FIGURE_MAX_CURVES]; /* ascending indices into the row */
};

/* What the panels have in common. */
struct dalcs_figure_axis {
    const char *quantity, *unit; /* "time", "s" */
    bool logarithmic;
};

/* One that is drawn through panels whatever the curves. */
struct dalcs_figure_line {
    int panel;     /* that it, or its text, is in */
    bool is_level; /* else across all panels, at a place of the axis */
    double at;
    const char *text; /* borrowed; NULL: none */
};

/* All panels from start to stop. */
struct dalcs_figure_view {
    double start, stop;
    struct dalcs_curve curve[DALCS_FIGURE_MAX_PANELS][DALCS_FIGURE_MAX_CURVES];
    double largest[DALCS_FIGURE_MAX_PANELS]; /* magnitude to be seen; chooses the unit's prefix */
    double low[DALCS_FIGURE_MAX_PANELS], high[DALCS_FIGURE_MAX_PANELS]; /* of the axis: wider */
    bool
        clipped[DALCS_FIGURE_MAX_PANELS]; /* impulses, which depend on the step, leave this range */
};

struct dalcs_figure {
    const char *path;        /* borrowed */
    const char *title;       /* borrowed */
    const char *const *name; /* of the signals, borrowed; NULL until there is something to draw */
    struct dalcs_figure_axis axis;
    const struct dalcs_theme *theme;
    int width;
    const struct dalcs_conduction *conduction; /* borrowed; NULL: no bars, no marks */
    bool bars, marks; /* of conduction: bars below the panels, lines through them at events */
    int n_lines;
    const struct dalcs_figure_line *line; /* [n_lines] borrowed */
    size_t n_rows;
    int n_panels;
    struct dalcs_figure_panel panel[DALCS_FIGURE_MAX_PANELS]; /* some may be empty */
    int n_views;
    struct dalcs_figure_view view[2]; /* the whole run, its end */
    double period; /* about, of what is too dense for the first view where there are two; else 0 */
    struct dalcs_tail tail; /* of the chosen signals */
    struct dalcs_atomic_file file;
    char message[256]; /* why drawing failed; "" when file.error says it */
};

/* True for .svg, .png and .pdf, in any case. */
bool dalcs_figure_can_write(const char *path);

/* The axis, time unless changed, goes from `start` to `stop`. The theme is the light one. */
void dalcs_figure_init(struct dalcs_figure *figure, const char *path, double start, double stop);

/* The callbacks of struct dalcs_sink; an operating point is not drawn. Begin opens the file, so
 * that a path which cannot be written is known before the run. */
enum dalcs_status dalcs_figure_begin(struct dalcs_figure *figure, const struct dalcs_plot *plot);
void dalcs_figure_row(struct dalcs_figure *figure, double time, const double *value);

/* The other beginning, for signals that come from elsewhere: with panels of the caller's choice.
 * Where figure->path is NULL no file is opened: a figure to be shown in another way. */
enum dalcs_status dalcs_figure_begin_panels(struct dalcs_figure *figure, const char *title,
                                            const char *const *name,
                                            const struct dalcs_figure_panel *panel, int n_panels);

/* Puts those of the n signals whose group is `wanted` into a panel, the most telling ones where they
 * are too many. */
void dalcs_figure_choose(struct dalcs_figure_panel *panel, const char *const *name,
                         const int *group, size_t n, int wanted);

/* Chooses what is drawn, once all rows are there. `report` has the jumps; may be NULL. */
enum dalcs_status dalcs_figure_compose(struct dalcs_figure *figure,
                                       const struct dalcs_report *report) DALCS_MUST_CHECK;

/* Composes and draws with gnuplot; bars show what `report` knows where figure->conduction is NULL.
 * `left_at` is NULL for a complete run, which gets the file's name;
 * else see dalcs_atomic_file_keep. */
enum dalcs_status dalcs_figure_draw(struct dalcs_figure *figure, const struct dalcs_report *report,
                                    char **left_at) DALCS_MUST_CHECK;

void dalcs_figure_finish(struct dalcs_figure *figure);

#endif
