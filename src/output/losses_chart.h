/* losses_chart.h - what each element loses, as bars. */
#ifndef DALCS_LOSSES_CHART_H
#define DALCS_LOSSES_CHART_H

#include "gnuplot.h"

/* Draws them into a file whose name says its format (dalcs_figure_can_write). On failure message says why,
 * and no file of that name is touched. */
enum dalcs_status dalcs_losses_chart_draw(const struct dalcs_losses *losses, const char *title,
                                          const char *path,
                                          char message[DALCS_GNUPLOT_MESSAGE]) DALCS_MUST_CHECK;

#endif
