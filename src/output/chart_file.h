/* chart_file.h - a script of gnuplot as a picture, or as a page that holds it. */
#ifndef DALCS_CHART_FILE_H
#define DALCS_CHART_FILE_H

#include "gnuplot.h"
#include "theme.h"

#include <stdbool.h>

/* Is that the name of a page? */
bool dalcs_chart_is_page(const char *path);

/* The terminal that follows from the file's name; in pixels. */
void dalcs_chart_write_terminal(FILE *script, const char *path, const struct dalcs_theme *theme,
                                int width, int height);

/* That, and the title, the border and the colours of a chart with two axes. */
void dalcs_chart_begin_script(FILE *script, const char *path, const struct dalcs_theme *theme,
                              int width, int height, const char *title);

/* What `write` puts into a script, drawn; title: of a page. `message` says why it fails. */
enum dalcs_status dalcs_chart_draw(void (*write)(FILE *script, const void *chart, const char *path),
                                   const void *chart, const char *path, const char *title,
                                   char message[DALCS_GNUPLOT_MESSAGE]) DALCS_MUST_CHECK;

#endif
