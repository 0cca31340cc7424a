/* gnuplot_page.h - where the parts of a figure lie on its page; shared by the files that write its
 * script. */
#ifndef DALCS_GNUPLOT_PAGE_H
#define DALCS_GNUPLOT_PAGE_H

#include "figure.h"

/* Where a column of panels is on the page, 0 to 1. */
struct dalcs_gnuplot_place {
    double left, right;
    double label; /* the middle of the vertical axes' labels */
    bool legend;
};

/* Heights are parts of the page's, from below. */
struct dalcs_gnuplot_page {
    int width, height; /* in pixels */
    int font;          /* size, in the terminal's units */
    int n_panels;
    int panel[DALCS_FIGURE_MAX_PANELS]; /* those that hold something */
    double top[DALCS_FIGURE_MAX_PANELS], bottom[DALCS_FIGURE_MAX_PANELS];
    size_t n_bars;
    double bars_top, bars_bottom;
    double title_at, marks_at;
    double time_scale;
    struct dalcs_gnuplot_place place[2]; /* of each view */
};

enum { DALCS_GNUPLOT_MAX_NAME = 24 };

struct dalcs_gnuplot_page dalcs_gnuplot_lay_out(const struct dalcs_figure *figure);

/* 'text' in gnuplot's single quotes, where nothing but the quote is special. At most max_length
 * characters, then an ellipsis; what is not printable UTF-8 becomes a question mark. */
void dalcs_gnuplot_write_quoted(FILE *stream, const char *text, int max_length);

/* The power of 1000 that the axis of a panel is in: 1 for numbers, degrees, decibels and squares of units, which
 * have no prefix. */
double dalcs_gnuplot_panel_scale(const struct dalcs_figure *figure, int v, int p);

/* Significant digits that the numbers of an axis need. */
int dalcs_gnuplot_count_digits(double low, double high);

/* Margins of what lies between `bottom` and `top` in view v. */
void dalcs_gnuplot_write_margins(FILE *stream, const struct dalcs_gnuplot_page *page, int v,
                                 double bottom, double top);

/* Label and numbers of the axis below the lowest part of a view. */
void dalcs_gnuplot_write_axis(FILE *stream, const struct dalcs_figure *figure,
                              const struct dalcs_gnuplot_page *page, int v);

/* The bars of diodes and switches, with the data that they need. */
void dalcs_gnuplot_write_bars(FILE *stream, const struct dalcs_figure *figure,
                              const struct dalcs_gnuplot_page *page, int v);

/* Lines at events and jumps, for all parts of a view; their labels stand above its first panel. */
void dalcs_gnuplot_write_marks(FILE *stream, const struct dalcs_figure *figure,
                               const struct dalcs_gnuplot_page *page, int v);

#endif
