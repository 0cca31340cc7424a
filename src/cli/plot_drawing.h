/* plot_drawing.h - what `dalcs plot` has in hand while it draws a file (plot.c), and the page of it. */
#ifndef DALCS_PLOT_DRAWING_H
#define DALCS_PLOT_DRAWING_H

#include "cli.h"
#include "margin_lines.h"
#include "plot_arguments.h"
#include "runs.h"
#include "selection.h"

/* What a drawing is made of. */
struct dalcs_drawing {
    const struct dalcs_cli *cli;
    const struct dalcs_plot_arguments *arguments;
    struct dalcs_diag diag;
    size_t n_written;                       /* messages */
    struct dalcs_waveforms waveforms, made; /* the latter of --spectrum and --histogram */
    struct dalcs_selection selection;
    struct dalcs_runs runs; /* of a page: all of them are in it */
    struct dalcs_conduction conduction;
    struct dalcs_margin_lines lines;
    const char *response[2];        /* the signals of a Bode plot; NULL: none is chosen */
    const struct dalcs_report *run; /* that has just written the file; NULL: none has */
    const char *title;
};

/* The signals of one run. */
enum dalcs_status dalcs_drawing_select(struct dalcs_drawing *drawing,
                                       const struct dalcs_waveforms *waveforms,
                                       struct dalcs_selection *selection) DALCS_MUST_CHECK;

/* Says that the output cannot be written; DALCS_E_IO. */
enum dalcs_status dalcs_drawing_refuse_output(const struct dalcs_drawing *drawing, int error);

/* The HTML page, with all runs of a sweep. */
enum dalcs_status dalcs_drawing_write_page(struct dalcs_drawing *drawing) DALCS_MUST_CHECK;

#endif
