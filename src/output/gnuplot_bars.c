/* gnuplot_bars.c - what diodes and switches do: bars below the panels, lines at events.
 *
 * A bar is drawn column by column. Where an element changes sides within a column the bar's shade
 * there is the part of the time in which it conducts. */
#include "gnuplot_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FAINTEST 0.25
#define NOTHING  1e-9 /* of a column: rounding */

enum { COLUMNS = DALCS_CURVE_COLUMNS, MAX_MARKS = 120, LABEL = 200, LABEL_CHARACTER = 7 };

/* ---- Bars ----------------------------------------------------------------------------------- */

static int channel(const char *color, int k) {
    const char digits[3] = {color[1 + 2 * k], color[2 + 2 * k], '\0'};
    return (int)strtol(digits, NULL, 16);
}

/* From a colour that is just seen, for next to nothing, to the bars' colour. */
static long shade(const struct dalcs_theme *theme, double fraction) {
    long color = 0;
    for (int k = 0; k < 3; k++) {
        double from = channel(theme->background, k), to = channel(theme->bar, k);
        color = 256 * color + lround(from + (to - from) * (FAINTEST + (1.0 - FAINTEST) * fraction));
    }
    return color;
}

/* Boxes of one element: neighbouring columns of one shade are one box. */
static void write_boxes(FILE *stream, const struct dalcs_figure *figure, int v, size_t row,
                        const struct dalcs_conduction_element *element, double time_scale) {
    const struct dalcs_figure_view *view = &figure->view[v];
    double fraction[COLUMNS], width = (view->stop - view->start) / COLUMNS;
    dalcs_conduction_fractions(element, view->start, view->stop, COLUMNS, fraction);
    for (int i = 0, end; i < COLUMNS; i = end) {
        bool conducts = fraction[i] > NOTHING;
        long color = shade(figure->theme, fraction[i]);
        for (end = i + 1; end < COLUMNS && (fraction[end] > NOTHING) == conducts &&
                          shade(figure->theme, fraction[end]) == color;
             end++) {
        }
        if (conducts) {
            double from = (view->start + i * width) / time_scale;
            double to = (view->start + end * width) / time_scale;
            fprintf(stream, "%.12g %zu %.12g %.12g %g %g %ld\n", 0.5 * (from + to), row, from, to,
                    (double)row - 0.32, (double)row + 0.32, color);
        }
    }
    /* A bar that never conducts is an empty line, and the data must not be empty. */
    fprintf(stream, "%.12g %zu %.12g %.12g %zu %zu 0\n", view->start / time_scale, row,
            view->start / time_scale, view->start / time_scale, row, row);
}

/* What a bar says. A diode or a switch conducts, one of a subcircuit too: x1.d1. A relay and a pair of a system file are
 * on or off: lambda of a pair may be a voltage. */
static const char *caption(const struct dalcs_conduction *conduction, size_t n) {
    for (size_t i = 0; i < n; i++) {
        const char *name = conduction->element[i].name, *last = strrchr(name, '.');
        if (conduction->of_matrices || !strchr("djmqswz", (last ? last + 1 : name)[0])) {
            return "on";
        }
    }
    return "conducts";
}

void dalcs_gnuplot_write_bars(FILE *stream, const struct dalcs_figure *figure,
                              const struct dalcs_gnuplot_page *page, int v) {
    const struct dalcs_conduction *conduction = figure->conduction;
    const size_t n = page->n_bars;
    if (n == 0) {
        return;
    }
    fprintf(stream, "$v%dbars << end_of_data\n", v);
    for (size_t i = 0; i < n; i++) {
        write_boxes(stream, figure, v, n - i, &conduction->element[i], page->time_scale);
    }
    fputs("end_of_data\n", stream);
    dalcs_gnuplot_write_margins(stream, page, v, page->bars_bottom, page->bars_top);
    fprintf(stream, "set yrange [0.4:%zu.6]\nunset xzeroaxis\nset ytics (", n);
    for (size_t i = 0; i < n; i++) {
        fputs(i > 0 ? ", " : "", stream);
        dalcs_gnuplot_write_quoted(stream, conduction->element[i].name, DALCS_GNUPLOT_MAX_NAME);
        fprintf(stream, " %zu", n - i);
    }
    fputs(")\n", stream);
    if (page->place[v].legend) {
        fprintf(stream,
                "set label 4 '%s' at graph 1.0, graph 1.0 offset 1,-0.6 left "
                "textcolor rgb '%s'\n",
                caption(conduction, n), figure->theme->quiet_text);
    }
    if (conduction->n > n) {
        fprintf(stream,
                "set label 5 '%zu more not drawn' at graph 1.0, graph 1.0 offset 0,0.7 "
                "right textcolor rgb '%s'\n",
                conduction->n - n, figure->theme->quiet_text);
    }
    dalcs_gnuplot_write_axis(stream, figure, page, v);
    fprintf(stream,
            "plot $v%dbars using 1:2:3:4:5:6:7 with boxxyerror fs solid noborder "
            "lc rgb variable notitle\n",
            v);
    fputs("unset label 4\nunset label 5\n", stream);
    fprintf(stream, "set ytics autofreq\nset xzeroaxis lc rgb '%s' lw 1 lt 1\n",
            figure->theme->mark);
}

/* ---- Marks ---------------------------------------------------------------------------------- */

struct mark {
    double time;
    bool jump;
    char label[LABEL]; /* "s1 off, d1 on" */
};

static int compare_marks(const void *a, const void *b) {
    double s = ((const struct mark *)a)->time, t = ((const struct mark *)b)->time;
    return (s > t) - (s < t);
}

/* Up to MAX_MARKS marks of a view into mark[]; returns how many there are. */
static size_t collect_marks(const struct dalcs_figure *figure, int v, struct mark *mark) {
    const struct dalcs_conduction *conduction = figure->conduction;
    double start = figure->view[v].start, stop = figure->view[v].stop;
    size_t n = 0;
    for (size_t i = 0; i < conduction->n; i++) {
        const struct dalcs_conduction_element *element = &conduction->element[i];
        for (size_t k = 0; k < element->n; k++) {
            const struct dalcs_conduction_change *change = &element->change[k];
            if (change->time >= start && change->time <= stop && n++ < MAX_MARKS) {
                mark[n - 1] = (struct mark){.time = change->time};
                snprintf(mark[n - 1].label, LABEL, "%.*s %s", DALCS_GNUPLOT_MAX_NAME, element->name,
                         change->on ? "on" : "off");
            }
        }
    }
    for (size_t k = 0; k < conduction->n_jumps; k++) {
        double time = conduction->jump[k];
        if (time >= start && time <= stop && n++ < MAX_MARKS) {
            mark[n - 1] = (struct mark){.time = time, .jump = true, .label = "jump"};
        }
    }
    return n;
}

/* Marks that lie together become one; returns how many are left. */
static size_t merge_marks(struct mark *mark, size_t n, double width) {
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        if (kept == 0 || mark[i].time - mark[kept - 1].time > width) {
            mark[kept++] = mark[i];
            continue;
        }
        struct mark *last = &mark[kept - 1];
        size_t length = strlen(last->label);
        snprintf(last->label + length, LABEL - length, ", %s", mark[i].label);
        last->jump = last->jump || mark[i].jump;
    }
    return kept;
}

static void write_marks(FILE *stream, const struct dalcs_figure *figure,
                        const struct dalcs_gnuplot_page *page, int v, const struct mark *mark,
                        size_t n) {
    const struct dalcs_figure_view *view = &figure->view[v];
    const struct dalcs_gnuplot_place *place = &page->place[v];
    double width = place->right - place->left, free_from = place->left - 0.03;
    for (size_t i = 0; i < n; i++) {
        fprintf(stream,
                "set arrow %zu from first %.12g, graph 0 to first %.12g, graph 1 nohead "
                "back lw 1 dt %d lc rgb '%s'\n",
                i + 1, mark[i].time / page->time_scale, mark[i].time / page->time_scale,
                mark[i].jump ? 1 : 2, figure->theme->mark);
        /* A label stands where there is room for it. */
        double at = place->left + width * (mark[i].time - view->start) / (view->stop - view->start);
        double half = 0.5 * LABEL_CHARACTER * (double)strlen(mark[i].label) / page->width;
        at = fmin(fmax(at, place->left - 0.02 + half), place->right + 0.05 - half);
        if (at - half < free_from) {
            continue;
        }
        free_from = at + 1.1 * half;
        fputs("set label ", stream);
        fprintf(stream, "%zu ", i + 100);
        dalcs_gnuplot_write_quoted(stream, mark[i].label, LABEL);
        fprintf(stream, " at screen %.5f, screen %.5f center font ',%d' textcolor rgb '%s'\n", at,
                page->marks_at, page->font - 3, figure->theme->quiet_text);
    }
}

void dalcs_gnuplot_write_marks(FILE *stream, const struct dalcs_figure *figure,
                               const struct dalcs_gnuplot_page *page, int v) {
    const struct dalcs_figure_view *view = &figure->view[v];
    if (!figure->marks || !figure->conduction) {
        return;
    }
    struct mark mark[MAX_MARKS];
    size_t n = collect_marks(figure, v, mark);
    fputs("unset arrow\n", stream);
    if (n > MAX_MARKS) {
        fprintf(stream,
                "set label 100 '%zu events: too many to mark' at screen %.5f, screen %.5f "
                "left font ',%d' textcolor rgb '%s'\n",
                n, page->place[v].left, page->marks_at, page->font - 3, figure->theme->quiet_text);
        return;
    }
    qsort(mark, n, sizeof *mark, compare_marks);
    n = merge_marks(mark, n, (view->stop - view->start) / (2.0 * COLUMNS));
    write_marks(stream, figure, page, v, mark, n);
}
