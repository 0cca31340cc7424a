/* multipliers_chart.h - Floquet multipliers in the complex plane, with the unit circle. */
#ifndef DALCS_MULTIPLIERS_CHART_H
#define DALCS_MULTIPLIERS_CHART_H

#include "gnuplot.h"

/* Writes it to path, .svg, .png or .pdf, which must end so; the report has a steady state. On failure message says why. */
enum dalcs_status
dalcs_multipliers_chart_draw(const struct dalcs_report *report, const char *path,
                             char message[DALCS_GNUPLOT_MESSAGE]) DALCS_MUST_CHECK;

#endif
