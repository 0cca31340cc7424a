/* losses_chart.c - one bar for each element that loses something and is no load, the largest on top:
 * conduction, then jumps, then switching by tables. */
#include "losses_chart.h"

#include "chart_file.h"
#include "gnuplot_page.h"
#include "memory.h"
#include "quantity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_BARS = 24, MOST_NAME = 40, ROW = 26, AROUND = 130, WIDTH = 900 };

/* A smaller part of the power that is moved is what rounding leaves. */
static const double ROUNDING = 1e-13;

struct bar {
    const char *element;
    double part[3]; /* W: conduction, jumps, switching */
};

struct bars {
    const char *title;
    const struct bar *bar; /* [n] */
    size_t n;
};

static double height(const struct bar *bar) {
    return bar->part[0] + bar->part[1] + bar->part[2];
}

static int compare_bars(const void *a, const void *b) {
    double p = height(a);
    double q = height(b);
    return (p < q) - (p > q);
}

/* Is it among "r1, r2"? */
static bool is_load(const struct dalcs_losses *l, const char *element) {
    const size_t n = strlen(element);
    const char *at = l->outputs;
    while (*at != '\0' && (strncmp(at, element, n) != 0 || (at[n] != ',' && at[n] != '\0'))) {
        at += strcspn(at, ",");
        at += strspn(at, ", ");
    }
    return *at != '\0';
}

static size_t list_bars(const struct dalcs_losses *l, struct bar *bar) {
    const double length = l->to - l->from;
    size_t n = 0;
    for (size_t k = 0; k < l->n_elements; k++) {
        const struct dalcs_element_losses *e = &l->element[k];
        const bool stores = strcmp(e->kind, "coil") == 0 || strcmp(e->kind, "capacitor") == 0;
        if (strcmp(e->kind, "source") != 0 && !stores && !is_load(l, e->element)) {
            bar[n++] = (struct bar){
                e->element,
                {e->power - e->jumps / length, e->jumps / length, e->switching / length}};
        }
    }
    if (n > 0) {
        qsort(bar, n, sizeof *bar, compare_bars);
    }
    return n;
}

static void write_boxes(FILE *script, const struct bar *bar, size_t n, double scale) {
    for (int part = 0; part < 3; part++) {
        fprintf(script, "$part%d << end_of_data\n", part);
        for (size_t k = 0; k < n; k++) {
            double from = 0.0;
            for (int before = 0; before < part; before++) {
                from += bar[k].part[before] / scale;
            }
            const double to = from + bar[k].part[part] / scale;
            const double y = (double)(n - k);
            fprintf(script, "%.9g %g %.9g %.9g %g %g\n", to, y, from, to, y - 0.32, y + 0.32);
        }
        fputs("end_of_data\n", script);
    }
}

static void write_script(FILE *script, const void *chart, const char *path) {
    const struct bars *bars = chart;
    const struct bar *bar = bars->bar;
    const size_t n_all = bars->n;
    const struct dalcs_theme *theme = &dalcs_theme_light;
    const size_t n = n_all < MOST_BARS ? n_all : MOST_BARS;
    const double scale = dalcs_quantity_scale(height(&bar[0]));
    const char *prefix = dalcs_quantity_prefix(scale);
    fputs("set encoding utf8\n", script);
    dalcs_chart_write_terminal(script, path, &dalcs_theme_light, WIDTH, AROUND + ROW * (int)n);
    fputs("set title ", script);
    dalcs_gnuplot_write_quoted(script, bars->title + strspn(bars->title, "* "), 2 * MOST_NAME);
    fprintf(script,
            " textcolor rgb '%s'\nset border 3 lc rgb '%s'\nset grid xtics lc rgb '%s' lt 1\n"
            "set tics nomirror out scale 0.5 textcolor rgb '%s'\nset xzeroaxis lc rgb '%s' lt 1\n"
            "set key outside right top\nset yrange [0.4:%zu.6]\n"
            "set xlabel 'losses (%sW)%s' textcolor rgb '%s'\nset ytics (",
            theme->text, theme->border, theme->grid, theme->text, theme->mark, n,
            strcmp(prefix, "u") == 0 ? "\302\265" : prefix, n < n_all ? ", the largest" : "",
            theme->text);
    for (size_t k = 0; k < n; k++) {
        fputs(k > 0 ? ", " : "", script);
        dalcs_gnuplot_write_quoted(script, bar[k].element, MOST_NAME);
        fprintf(script, " %zu", n - k);
    }
    fputs(")\n", script);
    write_boxes(script, bar, n, scale);
    fputs("plot ", script);
    static const char *const name[] = {"conduction", "jumps", "switching"};
    for (int part = 0; part < 3; part++) {
        fprintf(
            script,
            "%s$part%d using 1:2:3:4:5:6 with boxxyerror fs solid noborder lc rgb '%s' title '%s'",
            part > 0 ? ", " : "", part, theme->curve[part], name[part]);
    }
    fputc('\n', script);
}

enum dalcs_status dalcs_losses_chart_draw(const struct dalcs_losses *losses, const char *title,
                                          const char *path, char message[DALCS_GNUPLOT_MESSAGE]) {
    struct bar *bar = dalcs_alloc(losses->n_elements, sizeof *bar);
    if (bar == NULL) {
        snprintf(message, DALCS_GNUPLOT_MESSAGE, "%s", dalcs_status_text(DALCS_E_NOMEM));
        return DALCS_E_NOMEM;
    }
    const struct bars bars = {title, bar, list_bars(losses, bar)};
    enum dalcs_status status = DALCS_E_IO;
    const double least = ROUNDING * losses->turnover / (losses->to - losses->from);
    if (bars.n == 0 || !(height(&bar[0]) > least)) {
        snprintf(message, DALCS_GNUPLOT_MESSAGE,
                 "there is nothing to draw: all elements but sources and loads take 0 W");
    } else {
        status = dalcs_chart_draw(write_script, &bars, path, "Losses", message);
    }
    free(bar);
    return status;
}
