/* gnuplot_script.c - the looks of a figure: a gnuplot script with its data inside.
 *
 * Two panels share a time axis, engineering prefixes on all axes, legends to the right. The end of a
 * dense run is a second pair of panels beside the first. Whatever comes from the netlist is quoted:
 * it cannot become a command. */
#include "gnuplot.h"

#include "quantity.h"
#include "utf8.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#define COINCIDENT 1e-3 /* of a panel's range: less cannot be seen */
#define OVERLAP    0.02 /* of a panel's width */

enum { WIDTH = 1200, HEIGHT = 720, MAX_LEGEND = 24, MAX_TITLE = 100 };

/* Eight colours that stay apart for colour-blind eyes and in print. */
static const char *const colour[DALCS_FIGURE_MAX_CURVES] = {
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a52a3", "#5f6368",
};

/* 'text' in gnuplot's single quotes, where nothing but the quote is special. At most max_length
 * characters, then an ellipsis; what is not printable UTF-8 becomes a question mark. */
static void write_quoted(FILE *stream, const char *text, int max_length) {
    fputc('\'', stream);
    const char *c = text;
    while (*c && max_length-- > 0) {
        size_t length = dalcs_utf8_length(c);
        if (length == 0 || (unsigned char)*c < 0x20 || *c == 0x7f) {
            fputc('?', stream);
            c++;
            continue;
        }
        if (*c == '\'') {
            fputc('\'', stream);
        }
        fwrite(c, 1, length, stream);
        c += length;
    }
    fputs(*c ? "\342\200\246'" : "'", stream);
}

static const char *unit_prefix(double scale) {
    const char *prefix = dalcs_quantity_prefix(scale);
    return strcmp(prefix, "u") == 0 ? "\302\265" : prefix;
}

static double panel_scale(const struct dalcs_figure_view *view, int p) {
    return dalcs_quantity_scale(view->largest[p]);
}

static void write_data(FILE *stream, const struct dalcs_figure *figure, int v, int p,
                       double time_scale) {
    const struct dalcs_figure_view *view = &figure->view[v];
    double scale = panel_scale(view, p);
    for (int i = 0; i < figure->panel[p].n; i++) {
        fprintf(stream, "$v%dp%dc%d << end_of_data\n", v, p, i);
        for (int column = 0; column < DALCS_CURVE_COLUMNS; column++) {
            struct dalcs_curve_point point[4];
            int n = dalcs_curve_column_points(&view->curve[p][i].column[column], point);
            for (int k = 0; k < n; k++) {
                fprintf(stream, "%.12g %.7g\n", point[k].time / time_scale, point[k].value / scale);
            }
        }
        fputs("end_of_data\n", stream);
    }
}

static bool is_svg(const struct dalcs_figure *figure) {
    const char *dot = strrchr(figure->path, '.');
    return dot && strcasecmp(dot, ".svg") == 0;
}

static void write_header(FILE *stream, const struct dalcs_figure *figure) {
    bool svg = is_svg(figure);
    fprintf(stream, "set encoding utf8\n");
    fprintf(stream,
            "set terminal %s size %d,%d font 'DejaVu Sans,%d' noenhanced rounded background %s\n",
            svg ? "svg" : "pngcairo", WIDTH, HEIGHT, svg ? 14 : 11, svg ? "'white'" : "'#ffffff'");
    fputs("set border 3 lc rgb '#80868b' lw 1\n"
          "set grid xtics ytics lc rgb '#e3e6ea' lw 1 lt 1\n"
          "set tics nomirror out scale 0.5 textcolor rgb '#3c4043'\n"
          "set xzeroaxis lc rgb '#9aa0a6' lw 1 lt 1\n"
          "set key at graph 1.012, graph 1.0 left top Left reverse samplen 1.8 spacing 1.3 "
          "textcolor rgb '#202124'\n",
          stream);
}

static void write_title(FILE *stream, const struct dalcs_figure *figure) {
    size_t n_left_out = figure->panel[0].n_left_out + figure->panel[1].n_left_out;
    const char *title = figure->plot->title ? figure->plot->title : "";
    fputs("set label 1 ", stream);
    write_quoted(stream, title + strspn(title, "* "), MAX_TITLE);
    fprintf(stream, " at screen 0.065, screen 0.96 left font ',%d' textcolor rgb '#202124'\n",
            is_svg(figure) ? 19 : 15);
    if (n_left_out > 0) {
        fprintf(stream,
                "set label 2 '%zu more signal%s not drawn' at screen 0.985, screen 0.96 "
                "right textcolor rgb '#80868b'\n",
                n_left_out, n_left_out == 1 ? "" : "s");
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

/* Where a pair of panels is on the page, 0 to 1. */
struct place {
    double left, right;
    bool legend;
};

static void write_panel(FILE *stream, const struct dalcs_figure *figure, int v, int p,
                        const struct place *place) {
    const struct dalcs_figure_view *view = &figure->view[v];
    const struct dalcs_figure_panel *panel = &figure->panel[p];
    bool voltage = panel->unit == DALCS_VOLT;
    double scale = panel_scale(view, p);
    bool last = p == 1 || figure->panel[1].n == 0, first = p == 0 || figure->panel[0].n == 0;
    fprintf(stream, "set lmargin at screen %.3f\nset rmargin at screen %.3f\n", place->left,
            place->right);
    fprintf(stream, "set bmargin at screen %.3f\nset tmargin at screen %.3f\n", last ? 0.09 : 0.53,
            first ? 0.92 : 0.48);
    fprintf(stream, "set yrange [%.9g:%.9g]\n", view->low[p] / scale, view->high[p] / scale);
    fprintf(stream, "set ylabel '%s (%s%s)' offset 0.5,0 textcolor rgb '#3c4043'\n",
            voltage ? "voltage" : "current", unit_prefix(scale), voltage ? "V" : "A");
    if (last) {
        fprintf(stream, "set xlabel 'time (%ss)%s' offset 0,0.2 textcolor rgb '#3c4043'\n",
                unit_prefix(dalcs_quantity_scale(figure->view[0].stop)),
                v == 1 ? ", the end of the run" : "");
    } else {
        fputs("unset xlabel\n", stream);
    }
    fputs(last ? "set format x '%g'\n" : "set format x ''\n", stream);
    if (view->clipped[p]) {
        fputs("set label 3 'impulses of jumps leave the scale' at graph 1.0, graph 1.04 right "
              "textcolor rgb '#80868b'\n",
              stream);
    }
    for (int i = 0; i < panel->n; i++) {
        fprintf(stream, "%s $v%dp%dc%d using 1:2 with lines lw %.1f lc rgb '%s' ",
                i == 0 ? "plot" : ",", v, p, i, choose_width(figure, view, p, i), colour[i]);
        if (place->legend) {
            fputs("title ", stream);
            write_quoted(stream, figure->plot->name[panel->signal[i]], MAX_LEGEND);
        } else {
            fputs("notitle", stream);
        }
    }
    fputs("\nunset label\n", stream);
}

/* 1, 2 or 5 times a power of ten: a distance between tics that leaves room for their numbers. */
static double choose_tics(double range) {
    double power = pow(10.0, floor(log10(range / 4.0))), ratio = range / 4.0 / power;
    return power * (ratio < 2.0 ? 1.0 : ratio < 5.0 ? 2.0 : 5.0);
}

static int longest_name(const struct dalcs_figure *figure) {
    size_t longest = 0;
    for (int p = 0; p < 2; p++) {
        for (int i = 0; i < figure->panel[p].n; i++) {
            size_t length = strlen(figure->plot->name[figure->panel[p].signal[i]]);
            longest = length > longest ? length : longest;
        }
    }
    return longest < MAX_LEGEND ? (int)longest : MAX_LEGEND;
}

void dalcs_gnuplot_write(FILE *stream, const struct dalcs_figure *figure) {
    double time_scale = dalcs_quantity_scale(figure->view[0].stop);
    double left = 0.065, right = 0.945 - 0.0082 * longest_name(figure);
    double middle = 0.5 * (left + right);
    const struct place place[2] = {
        {left, figure->n_views > 1 ? middle - 0.02 : right, figure->n_views == 1},
        {middle + 0.05, right, true}};
    write_header(stream, figure);
    fputs("set multiplot\n", stream);
    write_title(stream, figure);
    for (int v = 0; v < figure->n_views; v++) {
        fprintf(stream, "set xrange [%.12g:%.12g]\n", figure->view[v].start / time_scale,
                figure->view[v].stop / time_scale);
        if (v == 1) {
            double range = figure->view[v].stop - figure->view[v].start;
            fprintf(stream, "set xtics %.9g\n", choose_tics(range / time_scale));
        }
        for (int p = 0; p < 2; p++) {
            if (figure->panel[p].n > 0) {
                write_data(stream, figure, v, p, time_scale);
                write_panel(stream, figure, v, p, &place[v]);
            }
        }
    }
    fputs("unset multiplot\n", stream);
}
