/* text_plot.h - a figure on a terminal: a strip for each signal, drawn with Braille dots. */
#ifndef DALCS_TEXT_PLOT_H
#define DALCS_TEXT_PLOT_H

#include "figure.h"

#include <stdio.h>

struct dalcs_text_plot_options {
    int width;   /* in characters */
    bool dots;   /* the terminal shows Braille; otherwise plain ASCII */
    bool colors; /* and colours */
};

/* The whole range of a composed figure. Errors stay in the stream. */
enum dalcs_status
dalcs_text_plot_write(FILE *stream, const struct dalcs_figure *figure,
                      const struct dalcs_text_plot_options *options) DALCS_MUST_CHECK;

#endif
