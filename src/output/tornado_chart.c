/* tornado_chart.c - a bar for each value, from the result at its low end to that at its high end, around the middle. */
#include "tornado_chart.h"

#include "chart_file.h"
#include "gnuplot_page.h"
#include "quantity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_BARS = 24, MOST_NAME = 32, ROW = 30, AROUND = 130, WIDTH = 900 };

static double length(const struct dalcs_tornado_bar *bar) {
    return fabs(bar->at_high - bar->at_low);
}

/* As far from each other as from the middle: an end that failed has no place. */
static int compare_bars(const void *a, const void *b) {
    const double p = length(a);
    const double q = length(b);
    return isnan(q) ? (isnan(p) ? 0 : -1) : isnan(p) ? 1 : (p < q) - (p > q);
}

void dalcs_tornado_sort(struct dalcs_tornado *tornado) {
    if (tornado->n > 0) {
        qsort(tornado->bar, tornado->n, sizeof *tornado->bar, compare_bars);
    }
}

/* ---- By gnuplot ------------------------------------------------------------------------------- */

static void write_boxes(FILE *script, const struct dalcs_tornado *t, size_t n, bool high) {
    fprintf(script, "$%s << end_of_data\n", high ? "high" : "low");
    for (size_t k = 0; k < n; k++) {
        const double to = high ? t->bar[k].at_high : t->bar[k].at_low;
        const double y = (double)(n - k);
        if (isfinite(to)) {
            fprintf(script, "%.12g %g %.12g %.12g %g %g\n", to, y, fmin(to, t->middle),
                    fmax(to, t->middle), y - 0.36, y + 0.36);
        }
    }
    fputs("NaN NaN NaN NaN NaN NaN\nend_of_data\n", script);
}

/* "37.6 u", and no blank where there is no prefix. */
static const char *plain(char text[DALCS_QUANTITY_SIZE], double value) {
    (void)dalcs_quantity_write(text, value, "", 4);
    const size_t n = strlen(text);
    text[n > 0 && text[n - 1] == ' ' ? n - 1 : n] = '\0';
    return text;
}

/* "c1 (37.6 u to 56.4 u)" */
static void write_name(FILE *script, const struct dalcs_tornado_bar *bar, double y) {
    char text[2 * MOST_NAME + 2 * DALCS_QUANTITY_SIZE];
    char low[DALCS_QUANTITY_SIZE];
    char high[DALCS_QUANTITY_SIZE];
    snprintf(text, sizeof text, "%.*s (%s to %s)", MOST_NAME, bar->name, plain(low, bar->low),
             plain(high, bar->high));
    dalcs_gnuplot_write_quoted(script, text, (int)sizeof text);
    fprintf(script, " %g", y);
}

static void write_script(FILE *script, const void *chart, const char *path) {
    const struct dalcs_tornado *t = chart;
    const struct dalcs_theme *theme = t->theme;
    const size_t n = t->n < MOST_BARS ? t->n : MOST_BARS;
    char label[MOST_NAME + 48];
    dalcs_chart_begin_script(script, path, theme, WIDTH, AROUND + ROW * (int)n, t->title);
    snprintf(label, sizeof label, "%.*s%s", MOST_NAME, t->result,
             n < t->n ? ", by the values that move it farthest" : "");
    fprintf(script,
            "set border 1\nunset grid\nset grid xtics lc rgb '%s' lt 1\nset yrange [0.4:%zu.6]\n"
            "set key outside right top\nset arrow from %.12g,graph 0 to %.12g,graph 1 nohead lc "
            "rgb '%s' front\nset xlabel ",
            theme->grid, n, t->middle, t->middle, theme->text);
    dalcs_gnuplot_write_quoted(script, label, (int)sizeof label);
    fprintf(script, " textcolor rgb '%s'\nset ytics scale 0 (", theme->text);
    for (size_t k = 0; k < n; k++) {
        fputs(k > 0 ? ", " : "", script);
        write_name(script, &t->bar[k], (double)(n - k));
    }
    fputs(")\n", script);
    write_boxes(script, t, n, false);
    write_boxes(script, t, n, true);
    static const char *const name[] = {"low", "high"};
    fputs("plot ", script);
    for (int k = 0; k < 2; k++) {
        fprintf(script,
                "%s$%s using 1:2:3:4:5:6 with boxxyerror fs solid noborder lc rgb '%s' title "
                "'%s end'",
                k > 0 ? ", " : "", name[k], theme->curve[k], name[k]);
    }
    fputc('\n', script);
}

enum dalcs_status dalcs_tornado_chart_draw(const struct dalcs_tornado *tornado, const char *path,
                                           char message[DALCS_GNUPLOT_MESSAGE]) {
    return dalcs_chart_draw(write_script, tornado, path, "Tornado chart", message);
}

/* ---- As text ---------------------------------------------------------------------------------- */

static int longest_name(const struct dalcs_tornado *t) {
    size_t longest = strlen(t->result);
    for (size_t k = 0; k < t->n; k++) {
        const size_t n = strlen(t->bar[k].name);
        longest = n > longest ? n : longest;
    }
    return (int)(longest < MOST_NAME ? longest : MOST_NAME);
}

void dalcs_tornado_text_write(FILE *out, const struct dalcs_tornado *t, int width) {
    const int name = longest_name(t);
    const int room = width - name - 28 > 10 ? width - name - 28 : 10;
    double low = t->middle;
    double high = t->middle;
    for (size_t k = 0; k < t->n; k++) {
        low = fmin(low, fmin(t->bar[k].at_low, t->bar[k].at_high));
        high = fmax(high, fmax(t->bar[k].at_low, t->bar[k].at_high));
    }
    const double scale = high > low ? (room - 1) / (high - low) : 0;
    const int middle = (int)lround((t->middle - low) * scale);
    fprintf(out, "  %-*s %12s %12s\n", name, t->result, "low end", "high end");
    for (size_t k = 0; k < t->n; k++) {
        const struct dalcs_tornado_bar *bar = &t->bar[k];
        const int at_low = isnan(bar->at_low) ? middle : (int)lround((bar->at_low - low) * scale);
        const int at_high =
            isnan(bar->at_high) ? middle : (int)lround((bar->at_high - low) * scale);
        fprintf(out, "  %-*.*s %12.6g %12.6g ", name, name, bar->name, bar->at_low, bar->at_high);
        int last = at_low > at_high ? at_low : at_high;
        last = last > middle ? last : middle;
        for (int c = 0; c <= last; c++) {
            const bool is_low = (c >= at_low && c < middle) || (c <= at_low && c > middle);
            const bool is_high = (c >= at_high && c < middle) || (c <= at_high && c > middle);
            fputc(c == middle ? '|' : is_high ? '#' : is_low ? '-' : ' ', out);
        }
        fputc('\n', out);
    }
}
