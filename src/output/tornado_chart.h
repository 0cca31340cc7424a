/* tornado_chart.h - how far a result moves with each of many values, the one that moves it farthest on top. */
#ifndef DALCS_TORNADO_CHART_H
#define DALCS_TORNADO_CHART_H

#include "gnuplot.h"

struct dalcs_tornado_bar {
    const char *name;
    double low, high;       /* of the value */
    double at_low, at_high; /* of the result with the value there */
};

struct dalcs_tornado {
    const char *title, *result;
    double middle; /* where all values are in the middle */
    size_t n;
    struct dalcs_tornado_bar *bar; /* [n] */
    const struct dalcs_theme *theme;
};

/* The farthest first. */
void dalcs_tornado_sort(struct dalcs_tornado *tornado);

enum dalcs_status dalcs_tornado_chart_draw(const struct dalcs_tornado *tornado, const char *path,
                                           char message[DALCS_GNUPLOT_MESSAGE]) DALCS_MUST_CHECK;

/* The same as text of so many characters a line. */
void dalcs_tornado_text_write(FILE *out, const struct dalcs_tornado *tornado, int width);

#endif
