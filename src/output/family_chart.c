/* family_chart.c - curves from blue over green to yellow, as the map viridis of Smith and van der Walt: even in
 * lightness, also for colour-blind eyes and in grey. */
#include "family_chart.h"

#include "chart_file.h"
#include "gnuplot_page.h"
#include "quantity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 1200, HEIGHT = 600, MOST_NAME = 48 };

/* Values over more than this have a logarithmic bar. */
static const double wide = 30.0;

/* Its first colours cannot be seen on a dark page. */
static void write_palette(FILE *script, const struct dalcs_theme *theme) {
    static const char *const color[] = {"#440154", "#482878", "#3e4a89", "#31688e", "#26828e",
                                        "#1f9e89", "#35b779", "#6dcd59", "#b4de2c", "#fde725"};

    enum { N_COLORS = sizeof color / sizeof color[0], OF_DARK = 3 };

    const int first = theme == &dalcs_theme_dark ? OF_DARK : 0;
    fputs("set palette defined (", script);
    for (int k = first; k < N_COLORS; k++) {
        fprintf(script, "%s%d '%s'", k > first ? ", " : "", k, color[k]);
    }
    fputs(")\n", script);
}

static void write_curve(FILE *script, const struct dalcs_curve *curve, double time_scale,
                        double scale) {
    for (int c = 0; c < DALCS_CURVE_COLUMNS; c++) {
        struct dalcs_curve_point point[4];
        const int n =
            curve->column[c].used ? dalcs_curve_column_points(&curve->column[c], point) : 0;
        fputs(n > 0 && curve->column[c].follows_gap ? "\n" : "",
              script); /* which ends a line in gnuplot */
        for (int k = 0; k < n; k++) {
            fprintf(script, "%.10g %.10g\n", point[k].time / time_scale, point[k].value / scale);
        }
    }
}

static void write_label(FILE *script, const char *axis, const char *name, const char *unit,
                        double scale, const struct dalcs_theme *theme) {
    char text[2 * MOST_NAME];
    const char *prefix = dalcs_quantity_prefix(scale);
    snprintf(text, sizeof text, unit[0] != '\0' ? "%.*s (%s%s)" : "%.*s", MOST_NAME, name,
             strcmp(prefix, "u") == 0 ? "\302\265" : prefix, unit);
    fprintf(script, "set %slabel ", axis);
    dalcs_gnuplot_write_quoted(script, text, (int)sizeof text);
    fprintf(script, " textcolor rgb '%s'\n", theme->text);
}

/* 1 where the numbers are short without: gnuplot writes 5 decimals at most. */
static double values_scale_of(double largest) {
    return largest >= 0.01 && largest < 1e6 ? 1 : dalcs_quantity_scale(largest);
}

/* Of the colours: the table gives no unit for what differs between the runs. */
static void write_values_label(FILE *script, const struct dalcs_family *f, double scale) {
    char factor[16] = "";
    if (scale != 1) {
        snprintf(factor, sizeof factor, "1e%ld", lround(log10(scale)));
    }
    write_label(script, "cb", f->by, factor, 1, f->theme);
}

/* Decibels, degrees and plain numbers have no prefix. */
static double prefix_scale(const char *unit, double largest) {
    const bool is_plain = unit[0] == '\0' || strpbrk(unit, "^ ") != NULL ||
                          strcmp(unit, "dB") == 0 || strcmp(unit, "\302\260") == 0;
    return is_plain ? 1 : dalcs_quantity_scale(largest);
}

static void write_script(FILE *script, const void *chart, const char *path) {
    const struct dalcs_family *f = chart;
    double largest = 0;
    double least = f->value[0];
    double most = f->value[0];
    for (size_t k = 0; k < f->n; k++) {
        if (f->curve[k].lowest <= f->curve[k].highest) {
            largest = fmax(largest, fmax(fabs(f->curve[k].lowest), fabs(f->curve[k].highest)));
        }
        least = fmin(least, f->value[k]);
        most = fmax(most, f->value[k]);
    }
    const double scale = prefix_scale(f->unit, largest);
    const double values_scale = values_scale_of(fmax(fabs(least), fabs(most)));
    const double end = fmax(fabs(f->curve[0].start), fabs(f->curve[0].stop));
    const double time_scale = f->axis.logarithmic ? 1 : prefix_scale(f->axis.unit, end);
    dalcs_chart_begin_script(script, path, f->theme, WIDTH, HEIGHT, f->title);
    write_label(script, "x", f->axis.quantity, f->axis.unit, time_scale, f->theme);
    write_label(script, "y", f->signal, f->unit, scale, f->theme);
    write_values_label(script, f, values_scale);
    write_palette(script, f->theme);
    const double spread = most > least ? most - least : fmax(fabs(least), 1);
    fprintf(script, "set cbrange [%.12g:%.12g]\nset xrange [%.12g:%.12g]\n%s%s",
            least / values_scale, (least + spread) / values_scale, f->curve[0].start / time_scale,
            f->curve[0].stop / time_scale, f->axis.logarithmic ? "set logscale x\n" : "",
            least > 0 && most > wide * least ? "set logscale cb\n" : "");
    for (size_t k = 0; k < f->n; k++) {
        fprintf(script, "$run%zu << end_of_data\n", k);
        write_curve(script, &f->curve[k], time_scale, scale);
        fputs("NaN NaN\nend_of_data\n", script);
    }
    fputs("plot ", script);
    for (size_t k = 0; k < f->n; k++) {
        fprintf(script, "%s$run%zu using 1:2:(%.12g) with lines lw 1.4 lc palette notitle",
                k > 0 ? ", " : "", k, f->value[k] / values_scale);
    }
    fputc('\n', script);
}

enum dalcs_status dalcs_family_chart_draw(const struct dalcs_family *family, const char *path,
                                          char message[DALCS_GNUPLOT_MESSAGE]) {
    return dalcs_chart_draw(write_script, family, path, "Family of curves", message);
}

void dalcs_family_finish(struct dalcs_family *family) {
    for (size_t k = 0; k < family->n; k++) {
        dalcs_curve_finish(&family->curve[k]);
    }
    free(family->curve);
    free(family->value);
    family->n = 0;
    family->curve = NULL;
    family->value = NULL;
}
