/* family_chart.h - one signal in many runs over each other, coloured by a value that differs, with a bar beside. */
#ifndef DALCS_FAMILY_CHART_H
#define DALCS_FAMILY_CHART_H

#include "curve.h"
#include "gnuplot.h"

struct dalcs_family {
    const char *title, *signal, *unit; /* of the signal, "" for numbers */
    struct dalcs_figure_axis axis;
    const char *by; /* what colours them */
    size_t n;
    double *value;             /* [n] of that; heap */
    struct dalcs_curve *curve; /* [n] heap */
    const struct dalcs_theme *theme;
};

enum dalcs_status dalcs_family_chart_draw(const struct dalcs_family *family, const char *path,
                                          char message[DALCS_GNUPLOT_MESSAGE]) DALCS_MUST_CHECK;

void dalcs_family_finish(struct dalcs_family *family);

#endif
