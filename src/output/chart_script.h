/* chart_script.h - what the scripts of single charts have in common: the picture's kind and size, its title, colours. */
#ifndef DALCS_CHART_SCRIPT_H
#define DALCS_CHART_SCRIPT_H

#include "gnuplot.h"

/* The beginning of a script for a picture of wide x tall pixels, of the kind that the path's ending says. */
void dalcs_chart_script_begin(FILE *script, const char *path, int wide, int tall,
                              const struct dalcs_theme *theme, const char *title);

/* Runs it; the picture gets its name when it is complete. On failure message says why. */
enum dalcs_status dalcs_chart_script_draw(FILE *script, const char *path,
                                          char message[DALCS_GNUPLOT_MESSAGE]) DALCS_MUST_CHECK;

#endif
