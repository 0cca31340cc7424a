/* plot_arguments.h - the command line of `dalcs plot`. */
#ifndef DALCS_PLOT_ARGUMENTS_H
#define DALCS_PLOT_ARGUMENTS_H

#include "cli.h"
#include "theme.h"

/* Everything is borrowed from argv but the list of groups. */
struct dalcs_plot_arguments {
    const char *file, *output, *report; /* NULL: not given */
    bool is_page;                       /* the output is an HTML file */
    const char **group;                 /* [n_groups], each a list of signals */
    size_t n_groups;
    double from, to; /* NAN: not given */
    double spectrum; /* Hz, up to there; 0: waveforms are drawn as they are */
    const struct dalcs_theme *theme;
    bool has_theme;   /* --theme was given */
    size_t plot, run; /* from 1; 0: not given */
    size_t width;     /* of a picture; 0: not given */
    bool histogram;
    const char *tornado; /* the values, "" where the table says them; NULL: none */
    const char *family;  /* what colours the runs, "" for the first; NULL: none */
    bool marks, no_bars, quiet, help;
};

/* Messages go to cli->err. */
enum dalcs_status dalcs_plot_arguments_parse(struct dalcs_plot_arguments *arguments,
                                             const struct dalcs_cli *cli, int argc,
                                             char **argv) DALCS_MUST_CHECK;

void dalcs_plot_arguments_finish(struct dalcs_plot_arguments *arguments);

#endif
