/* selection.h - what of a file is drawn: which signals in which panels, from when to when. */
#ifndef DALCS_SELECTION_H
#define DALCS_SELECTION_H

#include "drawn_signal.h"
#include "figure.h"

/* Zero-initialise; finish frees everything. */
struct dalcs_selection {
    const struct dalcs_waveforms *waveforms; /* borrowed */
    size_t n;
    struct dalcs_signal *signal; /* [n] */
    const char **name;           /* [n] */
    int n_panels;
    struct dalcs_figure_panel panel[DALCS_FIGURE_MAX_PANELS]; /* of the signals above */
    struct dalcs_figure_axis axis;
    double start, stop; /* of the axis */
    bool continues;     /* an angle goes on beyond half a turn instead of coming back */
    struct dalcs_arena arena;
};

/* Each group is a list "v(a),v(b)*i(r1)" and gets panels of its own, one for each unit. Without
 * groups all signals are there; where they are more than a panel has room for, the most telling ones
 * are drawn. `from` and `to` may be NAN: as far as the file goes. Errors come with a message. */
enum dalcs_status dalcs_selection_make(struct dalcs_selection *selection,
                                       const struct dalcs_waveforms *waveforms,
                                       const char *const *group, size_t n_groups, double from,
                                       double to, struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* Calls `row` with the values [n] of all signals in each row of the range, ends included: where they
 * lie between two rows the values are interpolated. */
enum dalcs_status dalcs_selection_each_row(const struct dalcs_selection *selection,
                                           enum dalcs_status (*row)(void *user, double at,
                                                                    const double *value),
                                           void *user) DALCS_MUST_CHECK;

/* Rows within the range. */
size_t dalcs_selection_count_rows(const struct dalcs_selection *selection);

/* Adds the elements whose currents are in the file, but not those that are there already, and sorts
 * them all. One conducts where its current is more than 1e-6 of its largest. */
enum dalcs_status
dalcs_selection_add_conduction(const struct dalcs_selection *selection,
                               struct dalcs_conduction *conduction) DALCS_MUST_CHECK;

void dalcs_selection_finish(struct dalcs_selection *selection);

#endif
