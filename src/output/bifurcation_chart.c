/* bifurcation_chart.c - a panel of dots for each state, coils first, and one of multipliers below. */
#include "bifurcation_chart.h"

#include "chart_file.h"
#include "gnuplot_page.h"
#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_STATES = 3, WIDTH = 1000, PANEL = 300, MOST_TITLE = 90 };

/* Values over more than this are drawn on a logarithmic axis. */
static const double wide = 100.0;

void dalcs_bifurcation_chart_begin(struct dalcs_bifurcation_chart *chart,
                                   const struct dalcs_plot *plot) {
    chart->plot = plot;
    chart->n_states = plot->n_signals / 2; /* each has an orbit, and there is the multiplier */
    chart->parameter = plot->n_parameters > 0 ? plot->parameter_value[0] : 0.0;
}

enum dalcs_status dalcs_bifurcation_chart_row(struct dalcs_bifurcation_chart *chart,
                                              const double *value) {
    const size_t n = chart->plot->n_signals + 1;
    DALCS_TRY(dalcs_grow(&chart->value, &chart->capacity, (chart->n + 1) * n, sizeof(double)));
    double *row = chart->value + chart->n++ * n;
    row[0] = chart->parameter;
    memcpy(row + 1, value, (n - 1) * sizeof(double));
    return DALCS_OK;
}

static const double *row_of(const struct dalcs_bifurcation_chart *chart, size_t k) {
    return chart->value + k * (chart->plot->n_signals + 1);
}

/* ---- The script ---------------------------------------------------------------------------------- */

/* Which states are drawn: currents of coils, then others. */
static int choose(const struct dalcs_bifurcation_chart *chart, size_t *state) {
    int n = 0;
    for (int round = 0; round < 2; round++) {
        for (size_t k = 0; k < chart->n_states && n < MOST_STATES; k++) {
            if ((chart->plot->unit[k] == DALCS_AMPERE) == (round == 0)) {
                state[n++] = k;
            }
        }
    }
    return n;
}

static void write_dots(FILE *script, const char *name, const struct dalcs_bifurcation_chart *chart,
                       size_t column) {
    fprintf(script, "$%s%zu << end_of_data\n", name, column);
    for (size_t k = 0; k < chart->n; k++) {
        const double *row = row_of(chart, k);
        if (isfinite(row[1 + column])) {
            fprintf(script, "%.10g %.10g\n", row[0], row[1 + column]);
        }
    }
    fputs("NaN NaN\nend_of_data\n", script);
}

/* One point of each value: of orbits that are stable, or of those that are not. */
static void write_orbit(FILE *script, const char *name, const struct dalcs_bifurcation_chart *chart,
                        size_t state, bool stable) {
    const size_t multiplier = 2 * chart->n_states;
    fprintf(script, "$%s%zu << end_of_data\n", name, state);
    for (size_t k = 0; k < chart->n; k++) {
        const double *row = row_of(chart, k);
        const bool is_first = k == 0 || row_of(chart, k - 1)[0] != row[0];
        if (is_first && isfinite(row[1 + multiplier]) && (row[1 + multiplier] <= 1.0) == stable) {
            fprintf(script, "%.10g %.10g\n", row[0], row[1 + chart->n_states + state]);
        }
    }
    fputs("NaN NaN\nend_of_data\n", script);
}

static void write_header(FILE *script, const struct dalcs_bifurcation_chart *chart,
                         const char *path, int n_panels) {
    const struct dalcs_theme *theme = &dalcs_theme_light;
    double low = INFINITY;
    double high = -INFINITY;
    for (size_t k = 0; k < chart->n; k++) {
        low = fmin(low, row_of(chart, k)[0]);
        high = fmax(high, row_of(chart, k)[0]);
    }
    fputs("set encoding utf8\n", script);
    dalcs_chart_write_terminal(script, path, &dalcs_theme_light, WIDTH, 80 + PANEL * n_panels);
    fprintf(script, "set multiplot layout %d,1 title ", n_panels);
    dalcs_gnuplot_write_quoted(script, chart->plot->title + strspn(chart->plot->title, "* "),
                               MOST_TITLE);
    fprintf(script,
            "\nset border 3 lc rgb '%s'\nset grid lc rgb '%s' lt 1\n"
            "set tics nomirror out scale 0.5 textcolor rgb '%s'\n"
            "set key outside right top textcolor rgb '%s'\nset lmargin 12\nset rmargin 24\n",
            theme->border, theme->grid, theme->text, theme->text);
    if (high > low) {
        fprintf(script, "set xrange [%.10g:%.10g]\n", low, high);
    }
    if (low > 0.0 && high > wide * low) {
        fputs("set logscale x\n", script);
    }
    fputs("set xlabel ", script);
    dalcs_gnuplot_write_quoted(
        script, chart->plot->n_parameters > 0 ? chart->plot->parameter[0] : "", MOST_TITLE);
    fprintf(script, " textcolor rgb '%s'\n", theme->text);
}

static void write_script(FILE *script, const void *of, const char *path) {
    const struct dalcs_bifurcation_chart *chart = of;
    const struct dalcs_theme *theme = &dalcs_theme_light;
    const size_t multiplier = 2 * chart->n_states;
    size_t state[MOST_STATES];
    char label[4 * DALCS_GNUPLOT_MAX_NAME + 8];
    const int n = choose(chart, state);
    write_header(script, chart, path, n + 1);
    for (int k = 0; k < n; k++) {
        const size_t s = state[k];
        write_dots(script, "run", chart, s);
        write_orbit(script, "stable", chart, s, true);
        write_orbit(script, "unstable", chart, s, false);
        fputs("set ylabel ", script);
        snprintf(label, sizeof label, "%.*s (%s)", DALCS_GNUPLOT_MAX_NAME, chart->plot->name[s],
                 chart->plot->unit[s] == DALCS_AMPERE ? "A" : "V");
        dalcs_gnuplot_write_quoted(script, label, (int)sizeof label);
        fprintf(script, " textcolor rgb '%s'\n", theme->text);
        fprintf(script,
                "plot $run%zu using 1:2 with points pt 7 ps 0.2 lc rgb '%s' title 'run', "
                "$stable%zu using 1:2 with points pt 7 ps 0.4 lc rgb '%s' title 'stable orbit', "
                "$unstable%zu using 1:2 with points pt 6 ps 0.4 lc rgb '%s' "
                "title 'unstable orbit'\n",
                s, theme->curve[0], s, theme->curve[2], s, theme->curve[1]);
    }
    write_dots(script, "multiplier", chart, multiplier);
    fprintf(script,
            "set ylabel 'largest multiplier' textcolor rgb '%s'\n"
            "plot $multiplier%zu using 1:2 with points pt 7 ps 0.4 lc rgb '%s' notitle, "
            "1 with lines dt 2 lc rgb '%s' title 'border of stability'\nunset multiplot\n",
            theme->text, multiplier, theme->curve[3], theme->text);
}

enum dalcs_status dalcs_bifurcation_chart_draw(const struct dalcs_bifurcation_chart *chart,
                                               const char *path,
                                               char message[DALCS_GNUPLOT_MESSAGE]) {
    if (chart->plot == NULL || chart->n == 0) {
        snprintf(message, DALCS_GNUPLOT_MESSAGE, "there are no rows");
        return DALCS_E_IO;
    }
    return dalcs_chart_draw(write_script, chart, path, "Bifurcation diagram", message);
}

void dalcs_bifurcation_chart_finish(struct dalcs_bifurcation_chart *chart) {
    free(chart->value);
    *chart = (struct dalcs_bifurcation_chart){0};
}
