/* plot_charts.h - what `dalcs plot` draws of the runs of a file, in the place of one run's waveforms. */
#ifndef DALCS_PLOT_CHARTS_H
#define DALCS_PLOT_CHARTS_H

#include "plot_arguments.h"
#include "waveforms.h"

/* The title of a picture of the file. */
const char *dalcs_plot_title(const struct dalcs_waveforms *waveforms, const char *file);

/* --tornado or --family. Messages about the file go to diag, about the picture to cli->err. */
enum dalcs_status dalcs_plot_chart_draw(const struct dalcs_cli *cli,
                                        const struct dalcs_plot_arguments *arguments, int width,
                                        struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
