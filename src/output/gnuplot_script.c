/* gnuplot_script.c - the looks of a figure: a gnuplot script with its data inside.
 *
 * Two panels share a time axis, engineering prefixes on all axes, legends to the right. Whatever
 * comes from the netlist is quoted: it cannot become a command. */
#include "gnuplot.h"

#include "quantity.h"
#include "utf8.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#define COINCIDENT 1e-3 /* of a panel's range: less cannot be seen */

enum { WIDTH = 1200, HEIGHT = 720, MAX_LEGEND = 24, MAX_TITLE = 100 };

/* Eight colours that stay apart for colour-blind eyes and in print. */
static const char *const colour[DALCS_FIGURE_MAX_CURVES] = {
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a52a3", "#5f6368",
};

/* 'text' in gnuplot's single quotes, where nothing but the quote is special. At most max_length
 * characters; what is not printable UTF-8 becomes a question mark. */
static void write_quoted(FILE *stream, const char *text, int max_length) {
    fputc('\'', stream);
    for (const char *c = text; *c && max_length-- > 0;) {
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
    fputc('\'', stream);
}

static const char *unit_prefix(double scale) {
    const char *prefix = dalcs_quantity_prefix(scale);
    return strcmp(prefix, "u") == 0 ? "\302\265" : prefix;
}

/* Of a panel's lowest and highest value the larger in magnitude; 0 when it has none. */
static double find_range(const struct dalcs_figure_panel *panel, double *low, double *high) {
    *low = INFINITY;
    *high = -INFINITY;
    for (int i = 0; i < panel->n; i++) {
        *low = fmin(*low, panel->curve[i].lowest);
        *high = fmax(*high, panel->curve[i].highest);
    }
    if (*low > *high) {
        *low = *high = 0.0;
    }
    return fmax(fabs(*low), fabs(*high));
}

static void write_data(FILE *stream, const struct dalcs_figure *figure, int p, double time_scale) {
    const struct dalcs_figure_panel *panel = &figure->panel[p];
    double low = 0.0, high = 0.0;
    double scale = dalcs_quantity_scale(find_range(panel, &low, &high));
    for (int i = 0; i < panel->n; i++) {
        fprintf(stream, "$p%dc%d << end_of_data\n", p, i);
        for (int column = 0; column < DALCS_CURVE_COLUMNS; column++) {
            struct dalcs_curve_point point[4];
            int n = dalcs_curve_column_points(&panel->curve[i].column[column], point);
            for (int k = 0; k < n; k++) {
                fprintf(stream, "%.9g %.7g\n", point[k].time / time_scale, point[k].value / scale);
            }
        }
        fputs("end_of_data\n", stream);
    }
}

static void write_header(FILE *stream, const struct dalcs_figure *figure) {
    const char *dot = strrchr(figure->path, '.');
    bool svg = dot && strcasecmp(dot, ".svg") == 0;
    fprintf(stream, "set encoding utf8\n");
    fprintf(stream, "set terminal %s size %d,%d font 'DejaVu Sans,%d' noenhanced background %s\n",
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
    fputs(" at screen 0.065, screen 0.96 left font ',15' textcolor rgb '#202124'\n", stream);
    if (n_left_out > 0) {
        fprintf(stream,
                "set label 2 '%zu more signal%s not drawn' at screen 0.985, screen 0.96 "
                "right textcolor rgb '#80868b'\n",
                n_left_out, n_left_out == 1 ? "" : "s");
    }
}

static bool coincide(const struct dalcs_curve *a, const struct dalcs_curve *b, double tolerance) {
    for (int i = 0; i < DALCS_CURVE_COLUMNS; i++) {
        const struct dalcs_curve_column *p = &a->column[i], *q = &b->column[i];
        if (p->used != q->used || fabs(p->first.value - q->first.value) > tolerance ||
            fabs(p->lowest.value - q->lowest.value) > tolerance ||
            fabs(p->highest.value - q->highest.value) > tolerance ||
            fabs(p->last.value - q->last.value) > tolerance) {
            return false;
        }
    }
    return true;
}

/* A curve that lies on earlier ones is dashed, so that all their colours show. */
static const char *choose_dashes(const struct dalcs_figure_panel *panel, int i, double range) {
    static const char *const dashes[] = {"", " dt (10,10)", " dt (5,15)", " dt (2,18)"};
    int n_below = 0;
    for (int k = 0; k < i && n_below < 3; k++) {
        n_below += coincide(&panel->curve[k], &panel->curve[i], COINCIDENT * range) ? 1 : 0;
    }
    return dashes[n_below];
}

/* The panel between two heights of the page. */
static void write_panel(FILE *stream, const struct dalcs_figure *figure, int p, double bottom,
                        double top, bool last) {
    const struct dalcs_figure_panel *panel = &figure->panel[p];
    double low = 0.0, high = 0.0;
    double scale = dalcs_quantity_scale(find_range(panel, &low, &high));
    double margin = high > low ? 0.05 * (high - low) : fmax(0.1 * fabs(high), 0.5 * scale);
    fprintf(stream, "set bmargin at screen %.3f\nset tmargin at screen %.3f\n", bottom, top);
    fprintf(stream, "set yrange [%.9g:%.9g]\n", (low - margin) / scale, (high + margin) / scale);
    fprintf(stream, "set ylabel '%s (%s%s)' offset 0.5,0 textcolor rgb '#3c4043'\n",
            panel->unit == DALCS_VOLT ? "voltage" : "current", unit_prefix(scale),
            panel->unit == DALCS_VOLT ? "V" : "A");
    if (last) {
        fprintf(stream, "set xlabel 'time (%ss)' offset 0,0.2 textcolor rgb '#3c4043'\n",
                unit_prefix(dalcs_quantity_scale(figure->stop)));
    }
    fputs(last ? "set format x '%g'\n" : "set format x ''\n", stream);
    for (int i = 0; i < panel->n; i++) {
        fprintf(stream, "%s $p%dc%d using 1:2 with lines lw 2 lc rgb '%s'%s title ",
                i == 0 ? "plot" : ",", p, i, colour[i], choose_dashes(panel, i, high - low));
        write_quoted(stream, figure->plot->name[panel->signal[i]], MAX_LEGEND);
    }
    fputs("\nunset label\n", stream);
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
    double time_scale = dalcs_quantity_scale(figure->stop);
    write_header(stream, figure);
    write_data(stream, figure, 0, time_scale);
    write_data(stream, figure, 1, time_scale);
    fprintf(stream, "set multiplot\nset lmargin at screen 0.065\nset rmargin at screen %.3f\n",
            0.945 - 0.0082 * longest_name(figure));
    fprintf(stream, "set xrange [%.12g:%.12g]\n", figure->start / time_scale,
            figure->stop / time_scale);
    write_title(stream, figure);
    bool both = figure->panel[0].n > 0 && figure->panel[1].n > 0;
    if (figure->panel[0].n > 0) {
        write_panel(stream, figure, 0, both ? 0.53 : 0.09, 0.92, !both);
    }
    if (figure->panel[1].n > 0) {
        write_panel(stream, figure, 1, 0.09, both ? 0.48 : 0.92, true);
    }
    fputs("unset multiplot\n", stream);
}
