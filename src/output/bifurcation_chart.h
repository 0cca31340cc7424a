/* bifurcation_chart.h - states at the multiples of a period over a parameter, and the multiplier of the orbit. */
#ifndef DALCS_BIFURCATION_CHART_H
#define DALCS_BIFURCATION_CHART_H

#include "gnuplot.h"

/* Zero-initialise; finish frees everything. */
struct dalcs_bifurcation_chart {
    const struct dalcs_plot *plot; /* the last one; its names live as long as the session */
    size_t n_states;
    double parameter; /* of the rows that come */
    size_t n, capacity;
    double *value; /* [n] rows of the parameter and the plot's signals */
};

/* As a sink is told; the parameter is the innermost of .step. */
void dalcs_bifurcation_chart_begin(struct dalcs_bifurcation_chart *chart,
                                   const struct dalcs_plot *plot);
enum dalcs_status dalcs_bifurcation_chart_row(struct dalcs_bifurcation_chart *chart,
                                              const double *value) DALCS_MUST_CHECK;

/* Writes it to path, .svg, .png, .pdf or .html, which must end so. On failure message says why. */
enum dalcs_status
dalcs_bifurcation_chart_draw(const struct dalcs_bifurcation_chart *chart, const char *path,
                             char message[DALCS_GNUPLOT_MESSAGE]) DALCS_MUST_CHECK;

void dalcs_bifurcation_chart_finish(struct dalcs_bifurcation_chart *chart);

#endif
