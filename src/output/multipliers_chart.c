/* multipliers_chart.c - the multipliers and the unit circle. Those outside have the name of their state. */
#include "multipliers_chart.h"

#include "chart_file.h"
#include "gnuplot_page.h"

#include <math.h>
#include <string.h>

enum { SIZE = 700, LEGEND = 30, MOST_TITLE = 70, MOST_NAMES = 12 };

static const double margin = 1.15; /* of the plane around the circle, or around what leaves it */

static void write_points(FILE *script, const char *name, const struct dalcs_floquet *m, size_t n) {
    fprintf(script, "$%s << end_of_data\n", name);
    for (size_t k = 0; k < n; k++) {
        fprintf(script, "%.15g %.15g\n", m[k].re, m[k].im);
    }
    fputs(n == 0 ? "NaN NaN\nend_of_data\n" : "end_of_data\n", script);
}

static double farthest(const struct dalcs_floquet *m, size_t n, double at_least) {
    for (size_t k = 0; k < n; k++) {
        at_least = fmax(at_least, fmax(fabs(m[k].re), fabs(m[k].im)));
    }
    return at_least;
}

/* Of a pair, at the upper one. */
static void write_names(FILE *script, const struct dalcs_floquet *m, size_t n) {
    for (size_t k = 0; k < n && k < MOST_NAMES; k++) {
        if (m[k].im >= 0.0) {
            fprintf(script, "set label %zu ", k + 1);
            dalcs_gnuplot_write_quoted(script, m[k].state, DALCS_GNUPLOT_MAX_NAME);
            fprintf(script, " at %.15g,%.15g offset 0.8,0.8 textcolor rgb '%s'\n", m[k].re, m[k].im,
                    dalcs_theme_light.quiet_text);
        }
    }
}

static void write_script(FILE *script, const void *chart, const char *path) {
    const struct dalcs_report *report = chart;
    const struct dalcs_theme *theme = &dalcs_theme_light;
    const struct dalcs_floquet *m = report->steady.multiplier;
    const size_t n = report->steady.n_multipliers;
    const size_t n_doubled =
        report->steady.doubled.period > 0.0 ? report->steady.doubled.n_multipliers : 0;
    const double reach =
        margin * farthest(report->steady.doubled.multiplier, n_doubled, farthest(m, n, 1.0));
    fputs("set encoding utf8\n", script);
    dalcs_chart_write_terminal(script, path, &dalcs_theme_light, SIZE, SIZE + LEGEND);
    fputs("set title ", script);
    dalcs_gnuplot_write_quoted(script, report->title + strspn(report->title, "* "), MOST_TITLE);
    fprintf(script,
            " textcolor rgb '%s'\nset border 3 lc rgb '%s'\nset grid lc rgb '%s' lt 1\n"
            "set tics nomirror out scale 0.5 textcolor rgb '%s'\n"
            "set xzeroaxis lc rgb '%s' lt 1\nset yzeroaxis lc rgb '%s' lt 1\n"
            "set key outside bottom center horizontal textcolor rgb '%s'\nset size ratio -1\n"
            "set xrange [%.9g:%.9g]\nset yrange [%.9g:%.9g]\n"
            "set xlabel 'real part' textcolor rgb '%s'\n"
            "set ylabel 'imaginary part' textcolor rgb '%s'\nset parametric\n"
            "set trange [0:2*pi]\nset samples 400\n",
            theme->text, theme->border, theme->grid, theme->text, theme->mark, theme->mark,
            theme->text, -reach, reach, -reach, reach, theme->text, theme->text);
    write_points(script, "one", m, n);
    write_points(script, "two", report->steady.doubled.multiplier, n_doubled);
    write_names(script, m, n);
    fprintf(script,
            "plot cos(t),sin(t) with lines lw 1.5 lc rgb '%s' notitle, "
            "$one using 1:2 with points pt 7 ps 1 lc rgb '%s' title 'multipliers of a period'",
            theme->border, theme->curve[0]);
    if (n_doubled > 0) {
        fprintf(script,
                ", $two using 1:2 with points pt 6 ps 1.2 lc rgb '%s' "
                "title 'of the orbit of two periods'",
                theme->curve[1]);
    }
    fputc('\n', script);
}

enum dalcs_status dalcs_multipliers_chart_draw(const struct dalcs_report *report, const char *path,
                                               char message[DALCS_GNUPLOT_MESSAGE]) {
    return dalcs_chart_draw(write_script, report, path, "Multipliers", message);
}
