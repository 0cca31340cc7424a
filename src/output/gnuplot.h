/* gnuplot.h - draws a figure with gnuplot. */
#ifndef DALCS_GNUPLOT_H
#define DALCS_GNUPLOT_H

#include "figure.h"

/* Writes the gnuplot script with its data. Errors stay in the stream. */
void dalcs_gnuplot_write(FILE *stream, const struct dalcs_figure *figure);

enum { DALCS_GNUPLOT_MESSAGE = 256 };

/* Runs gnuplot on a script, its output going to the file, which is open. On failure message says why, or
 * file->error. */
enum dalcs_status dalcs_gnuplot_run(FILE *script, struct dalcs_atomic_file *file,
                                    char message[DALCS_GNUPLOT_MESSAGE]) DALCS_MUST_CHECK;

/* Runs gnuplot on the script, its output going to figure->file. On failure figure->message says
 * why, or figure->file.error. */
enum dalcs_status dalcs_gnuplot_draw(struct dalcs_figure *figure) DALCS_MUST_CHECK;

#endif
