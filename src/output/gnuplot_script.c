/* gnuplot_script.c - the looks of a figure: a gnuplot script with its data inside.
 *
 * Panels share an axis, engineering prefixes on all axes, legends to the right. The end of a dense
 * run is a second column of panels beside the first. Whatever comes from a netlist or a file is
 * quoted: it cannot become a command. */
#include "gnuplot.h"

#include "band.h"
#include "gnuplot_page.h"
#include "quantity.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#define COINCIDENT 1e-3 /* of a panel's range: less cannot be seen */
#define OVERLAP    0.02 /* of a panel's width */

enum { MAX_TITLE = 100, PIXELS_PER_INCH = 100, LEFT_OUT = 220 };

static const char *unit_prefix(double scale) {
    const char *prefix = dalcs_quantity_prefix(scale);
    return strcmp(prefix, "u") == 0 ? "\302\265" : prefix;
}

/* Of the whole of a run too dense to see its periods, the range that each signal moves in, and its mean, are drawn. Of
 * other axes there are no means. */
static bool has_bands(const struct dalcs_figure *figure, int v) {
    return v == 0 && figure->period > 0.0 && !figure->axis.logarithmic &&
           strcmp(figure->axis.unit, "s") == 0;
}

/* With the opacity a the last of n bands on each other adds a (1 - a)^(n - 1) to what is beneath, which is most where
 * a = 1/n. The line in it adds (1 - a)^n: of one band alone both are told apart best where they are the same. */
static double band_opacity(int n) {
    return 1.0 / (n > 2 ? n : 2);
}

static void write_band(FILE *stream, const struct dalcs_figure *figure, int p, int i,
                       double time_scale) {
    struct dalcs_band_point point[DALCS_CURVE_COLUMNS];
    const double scale = dalcs_gnuplot_panel_scale(figure, 0, p);
    const int n = dalcs_band_find(&figure->view[0].curve[p][i], figure->period, point);
    fprintf(stream, "$v0p%dc%d << end_of_data\n", p, i);
    for (int k = 0; k < n; k++) {
        fprintf(stream, "%.7g %.5g %.5g %.5g\n", point[k].time / time_scale, point[k].mean / scale,
                point[k].low / scale, point[k].high / scale);
    }
    fputs(n > 0 ? "end_of_data\n" : "0 NaN NaN NaN\nend_of_data\n", stream);
}

static void write_data(FILE *stream, const struct dalcs_figure *figure, int v, int p,
                       double time_scale) {
    const struct dalcs_figure_view *view = &figure->view[v];
    double scale = dalcs_gnuplot_panel_scale(figure, v, p);
    /* A hundredth of the resolution of the numbers at the axis. */
    const int digits = 2 + dalcs_gnuplot_count_digits(view->low[p] / scale, view->high[p] / scale);
    for (int i = 0; i < figure->panel[p].n; i++) {
        if (has_bands(figure, v)) {
            write_band(stream, figure, p, i, time_scale);
            continue;
        }
        fprintf(stream, "$v%dp%dc%d << end_of_data\n", v, p, i);
        for (int column = 0; column < DALCS_CURVE_COLUMNS; column++) {
            struct dalcs_curve_point point[4];
            const struct dalcs_curve_column *drawn = &view->curve[p][i].column[column];
            int n = dalcs_curve_column_points(drawn, point);
            fputs(drawn->follows_gap ? "\n" : "", stream); /* which ends a line in gnuplot */
            for (int k = 0; k < n; k++) {
                fprintf(stream, "%.15g %.*g\n", point[k].time / time_scale, digits,
                        point[k].value / scale);
            }
        }
        if (view->curve[p][i].lowest > view->curve[p][i].highest) {
            fputs("0 NaN\n", stream); /* the data must not be empty */
        }
        fputs("end_of_data\n", stream);
    }
}

static bool is_svg(const struct dalcs_figure *figure) {
    return strcasecmp(strrchr(figure->path, '.'), ".svg") == 0;
}

static void write_terminal(FILE *stream, const struct dalcs_figure *figure,
                           const struct dalcs_gnuplot_page *page) {
    const char *dot = strrchr(figure->path, '.');
    const char *background = figure->theme->background;
    if (is_svg(figure)) {
        fprintf(stream, "set terminal svg size %d,%d", page->width, page->height);
    } else if (strcasecmp(dot, ".pdf") == 0) {
        fprintf(stream, "set terminal pdfcairo size %gin,%gin",
                (double)page->width / PIXELS_PER_INCH, (double)page->height / PIXELS_PER_INCH);
    } else {
        fprintf(stream, "set terminal pngcairo size %d,%d", page->width, page->height);
    }
    fprintf(stream, " font 'DejaVu Sans,%d' noenhanced rounded background '%s'\n", page->font,
            background);
}

/* Of the title, in characters, so that it neither leaves the page nor reaches the note on its right. A character of
 * a title has 0.5 to 0.54 em, in a font of 18 pixels in SVG and of 15 pt elsewhere, 21 pixels at most. */
static int title_length(const struct dalcs_gnuplot_page *page, bool in_pixels, bool has_left_out) {
    const double room = (1.0 - page->place[0].left) * page->width - (has_left_out ? LEFT_OUT : 0);
    return (int)fmin(MAX_TITLE, room / (in_pixels ? 10.0 : 11.3));
}

static void write_header(FILE *stream, const struct dalcs_figure *figure,
                         const struct dalcs_gnuplot_page *page) {
    const struct dalcs_theme *theme = figure->theme;
    fputs("set encoding utf8\n", stream);
    write_terminal(stream, figure, page);
    fprintf(stream,
            "set border 3 lc rgb '%s' lw 1\n"
            "set grid xtics ytics lc rgb '%s' lw 1 lt 1\n"
            "set tics nomirror out scale 0.5 textcolor rgb '%s'\n"
            "set xzeroaxis lc rgb '%s' lw 1 lt 1\n"
            "set key at graph 1.012, graph 1.0 left top Left reverse samplen 1.8 spacing 1.3 "
            "textcolor rgb '%s'\n",
            theme->border, theme->grid, theme->text, theme->mark, theme->text);
    if (figure->axis.logarithmic) {
        fputs("set logscale x\n", stream);
    }
}

static void write_title(FILE *stream, const struct dalcs_figure *figure,
                        const struct dalcs_gnuplot_page *page) {
    size_t n_left_out = 0;
    for (int p = 0; p < figure->n_panels; p++) {
        n_left_out += figure->panel[p].n_left_out;
    }
    fputs("set label 1 ", stream);
    dalcs_gnuplot_write_quoted(stream, figure->title + strspn(figure->title, "* "),
                               title_length(page, is_svg(figure), n_left_out > 0));
    fprintf(stream, " at screen %.4f, screen %.4f left font ',%d' textcolor rgb '%s'\n",
            page->place[0].left, page->title_at, page->font + 4, figure->theme->text);
    if (n_left_out > 0) {
        fprintf(stream,
                "set label 2 '%zu more signal%s not drawn' at screen 0.985, screen %.4f "
                "right textcolor rgb '%s'\n",
                n_left_out, n_left_out == 1 ? "" : "s", page->title_at, figure->theme->quiet_text);
    }
}

/* A curve that others lie on later is wider, so that its colour shows beside theirs. */
static double choose_width(const struct dalcs_figure *figure, const struct dalcs_figure_view *view,
                           int p, int i) {
    double width = 2.0, tolerance = COINCIDENT * (view->high[p] - view->low[p]);
    const struct dalcs_curve *curve = view->curve[p];
    for (int k = i + 1; k < figure->panel[p].n && width < 5.0; k++) {
        width += dalcs_curve_overlap(&curve[i], &curve[k], tolerance) > OVERLAP ? 1.7 : 0.0;
    }
    return width;
}

enum { FIRST_LINE = 500 };

static void write_lines(FILE *stream, const struct dalcs_figure *figure,
                        const struct dalcs_gnuplot_page *page, int p) {
    for (int k = 0; k < figure->n_lines; k++) {
        const struct dalcs_figure_line *line = &figure->line[k];
        const double at = line->at / (line->is_level ? 1.0 : page->time_scale);
        if (line->is_level && line->panel == p) {
            fprintf(stream, "set arrow %d from graph 0, first %.12g to graph 1, first %.12g",
                    FIRST_LINE + k, at, at);
        } else if (!line->is_level) {
            fprintf(stream, "set arrow %d from first %.12g, graph 0 to first %.12g, graph 1",
                    FIRST_LINE + k, at, at);
        } else {
            fprintf(stream, "unset arrow %d\n", FIRST_LINE + k);
            continue;
        }
        fprintf(stream, " nohead back lw 1 dt (4,4) lc rgb '%s'\n", figure->theme->text);
        if (line->text && line->panel == p) {
            fprintf(stream, "set label %d ", FIRST_LINE + k);
            dalcs_gnuplot_write_quoted(stream, line->text, MAX_TITLE);
            fprintf(stream, " at first %.12g, graph %.3f right offset -0.6,0 textcolor rgb '%s'\n",
                    at, 0.93 - 0.07 * (k % 3), figure->theme->text);
        }
    }
}

/* The curves of panel p, before them the bands that they are in. */
static void write_curves(FILE *stream, const struct dalcs_figure *figure,
                         const struct dalcs_gnuplot_page *page, int v, int p) {
    const struct dalcs_figure_view *view = &figure->view[v];
    const struct dalcs_figure_panel *panel = &figure->panel[p];
    const bool bands = has_bands(figure, v);
    for (int i = 0; bands && i < panel->n; i++) {
        fprintf(
            stream,
            "%s $v%dp%dc%d using 1:3:4 with filledcurves fs transparent solid %.2g noborder fc rgb "
            "'%s' notitle",
            i == 0 ? "plot" : ",", v, p, i, band_opacity(panel->n), figure->theme->curve[i]);
    }
    for (int i = 0; i < panel->n; i++) {
        fprintf(stream, "%s $v%dp%dc%d using 1:2 with lines lw %.1f lc rgb '%s' ",
                i == 0 && !bands ? "plot" : ",", v, p, i, choose_width(figure, view, p, i),
                figure->theme->curve[i]);
        if (figure->theme->dash[i]) {
            fprintf(stream, "dt %s ", figure->theme->dash[i]);
        }
        if (page->place[v].legend) {
            fputs("title ", stream);
            dalcs_gnuplot_write_quoted(stream, figure->name[panel->signal[i]],
                                       DALCS_GNUPLOT_MAX_NAME);
        } else {
            fputs("notitle", stream);
        }
    }
}

/* Panel k of the page. */
static void write_panel(FILE *stream, const struct dalcs_figure *figure,
                        const struct dalcs_gnuplot_page *page, int v, int k) {
    const int p = page->panel[k];
    const struct dalcs_figure_view *view = &figure->view[v];
    const struct dalcs_figure_panel *panel = &figure->panel[p];
    double scale = dalcs_gnuplot_panel_scale(figure, v, p);
    dalcs_gnuplot_write_margins(stream, page, v, page->bottom[k], page->top[k]);
    fprintf(stream, "set yrange [%.12g:%.12g]\nset format y '%%.%dg'\n", view->low[p] / scale,
            view->high[p] / scale,
            dalcs_gnuplot_count_digits(view->low[p] / scale, view->high[p] / scale));
    fprintf(stream, "set label 4 '%s", panel->quantity);
    if (panel->unit[0]) {
        fprintf(stream, " (%s%s)", unit_prefix(scale), panel->unit);
    }
    fprintf(stream, "' at screen %.4f, screen %.4f center rotate textcolor rgb '%s'\n",
            page->place[v].label, 0.5 * (page->bottom[k] + page->top[k]), figure->theme->text);
    if (k == page->n_panels - 1 && page->n_bars == 0) {
        dalcs_gnuplot_write_axis(stream, figure, page, v);
    } else {
        fputs("unset xlabel\nset format x ''\n", stream);
    }
    if (view->clipped[p]) {
        fprintf(stream,
                "set label 3 'impulses of jumps leave the scale' at graph 1.0, graph 1.04 "
                "right textcolor rgb '%s'\n",
                figure->theme->quiet_text);
    }
    write_lines(stream, figure, page, p);
    write_curves(stream, figure, page, v, p);
    fputs("\nunset label\n", stream);
}

/* 1, 2 or 5 times a power of ten: a distance between tics that leaves room for their numbers. */
static double choose_tics(double range) {
    double power = pow(10.0, floor(log10(range / 4.0))), ratio = range / 4.0 / power;
    return power * (ratio < 2.0 ? 1.0 : ratio < 5.0 ? 2.0 : 5.0);
}

void dalcs_gnuplot_write(FILE *stream, const struct dalcs_figure *figure) {
    const struct dalcs_gnuplot_page page = dalcs_gnuplot_lay_out(figure);
    write_header(stream, figure, &page);
    fputs("set multiplot\n", stream);
    write_title(stream, figure, &page);
    for (int v = 0; v < figure->n_views; v++) {
        fprintf(stream, "set xrange [%.15g:%.15g]\n", figure->view[v].start / page.time_scale,
                figure->view[v].stop / page.time_scale);
        if (v == 1) {
            double range = figure->view[v].stop - figure->view[v].start;
            fprintf(stream, "set xtics %.9g\n", choose_tics(range / page.time_scale));
        }
        dalcs_gnuplot_write_marks(stream, figure, &page, v);
        for (int k = 0; k < page.n_panels; k++) {
            write_data(stream, figure, v, page.panel[k], page.time_scale);
            write_panel(stream, figure, &page, v, k);
        }
        dalcs_gnuplot_write_bars(stream, figure, &page, v);
    }
    fputs("unset multiplot\n", stream);
}
