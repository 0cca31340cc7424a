/* chart.h - a figure of a page, drawn by gnuplot. */
#ifndef DALCS_CHART_H
#define DALCS_CHART_H

#include "dalcs.h"

/* Colours that stay apart for colour-blind eyes and in print. */
enum { DALCS_CHART_COLOURS = 8 };

extern const char *const dalcs_chart_colour[DALCS_CHART_COLOURS];

/* An unnamed script that begins with the terminal and looks. `name` is a word, the figure's own on its
 * page. NULL with errno. */
FILE *dalcs_chart_begin(const char *name, int width, int height);

/* 'text', which cannot become a command. */
void dalcs_chart_write_quoted(FILE *script, const char *text);

/* Closes the script and puts its picture on the page. On failure message says why, and nothing is
 * written. */
enum dalcs_status dalcs_chart_end(FILE *script, FILE *page, char message[256]) DALCS_MUST_CHECK;

#endif
