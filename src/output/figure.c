/* figure.c - chooses what to draw and collects it; gnuplot.c does the drawing. */
#include "figure.h"

#include "gnuplot.h"
#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define CLIP     3.0  /* an impulse that stretches a panel by less is left in */
#define SWING    0.2  /* of a signal's range: smaller ripple is no turn */
#define VISIBLE  0.01 /* of a panel's range */
#define ROUNDING 1e-7 /* of a panel's largest value: all in so small a range is constant */

/* Turns of the densest signal: beyond the first number nobody sees a single period; the second is
 * what the end of the run then shows. */
enum { MAX_TURNS = 120, TURNS_AT_END = 8 };

bool dalcs_figure_can_write(const char *path) {
    const char *dot = strrchr(path, '.');
    return dot && (strcasecmp(dot, ".svg") == 0 || strcasecmp(dot, ".png") == 0 ||
                   strcasecmp(dot, ".pdf") == 0);
}

void dalcs_figure_init(struct dalcs_figure *figure, const char *path, double start, double stop) {
    *figure = (struct dalcs_figure){.path = path,
                                    .axis = {"time", "s", false},
                                    .theme = &dalcs_theme_light,
                                    .width = DALCS_FIGURE_WIDTH,
                                    .view[0] = {.start = start, .stop = stop}};
}

/* Where there are too many signals, outputs come first, then inductor and diode currents. */
static int rank_signal(const char *name) {
    if (strstr(name, "out")) {
        return 0;
    }
    if (strncmp(name, "i(", 2) == 0) {
        return name[2] == 'l' ? 0 : name[2] == 'd' ? 1 : 2;
    }
    return 1;
}

void dalcs_figure_choose(struct dalcs_figure_panel *panel, const char *const *name,
                         const int *group, size_t n, int wanted) {
    enum { N_RANKS = 3 };

    size_t n_of_rank[N_RANKS] = {0};
    size_t room[N_RANKS];
    for (size_t i = 0; i < n; i++) {
        n_of_rank[rank_signal(name[i])] += group[i] == wanted ? 1 : 0;
    }
    size_t left = DALCS_FIGURE_MAX_CURVES;
    for (int rank = 0; rank < N_RANKS; rank++) {
        room[rank] = n_of_rank[rank] < left ? n_of_rank[rank] : left;
        left -= room[rank];
        panel->n_left_out += n_of_rank[rank] - room[rank];
    }
    for (size_t i = 0; i < n; i++) {
        int rank = rank_signal(name[i]);
        if (group[i] == wanted && room[rank] > 0) {
            room[rank]--;
            panel->signal[panel->n++] = i;
        }
    }
}

static enum dalcs_status init_view(struct dalcs_figure *figure, double start, double stop) {
    struct dalcs_figure_view *view = &figure->view[figure->n_views++];
    *view = (struct dalcs_figure_view){.start = start, .stop = stop};
    for (int p = 0; p < figure->n_panels; p++) {
        for (int i = 0; i < figure->panel[p].n; i++) {
            DALCS_TRY(dalcs_curve_init(&view->curve[p][i], start, stop));
            view->curve[p][i].logarithmic = figure->axis.logarithmic;
        }
    }
    return DALCS_OK;
}

/* value[] are those of panel 0's curves, then of the next ones'. */
static void add_to_view(struct dalcs_figure *figure, int v, double time, const double *value) {
    for (int p = 0; p < figure->n_panels; p++) {
        for (int i = 0; i < figure->panel[p].n; i++) {
            dalcs_curve_add(&figure->view[v].curve[p][i], time, *value++);
        }
    }
}

enum dalcs_status dalcs_figure_begin_panels(struct dalcs_figure *figure, const char *title,
                                            const char *const *name,
                                            const struct dalcs_figure_panel *panel, int n_panels) {
    size_t n = 0;
    figure->title = title ? title : "";
    figure->name = name;
    figure->n_panels = n_panels;
    for (int p = 0; p < n_panels; p++) {
        figure->panel[p] = panel[p];
        n += (size_t)panel[p].n;
    }
    DALCS_TRY(init_view(figure, figure->view[0].start, figure->view[0].stop));
    DALCS_TRY(dalcs_tail_init(&figure->tail, n));
    return figure->path ? dalcs_atomic_file_open(&figure->file, figure->path) : DALCS_OK;
}

enum dalcs_status dalcs_figure_begin(struct dalcs_figure *figure, const struct dalcs_plot *plot) {
    if (plot->analysis != DALCS_TRANSIENT || plot->n_signals == 0) {
        return DALCS_OK;
    }

    enum { N_PANELS = 3 };

    struct dalcs_figure_panel panel[N_PANELS] = {{.quantity = "voltage", .unit = "V"},
                                                 {.quantity = "current", .unit = "A"},
                                                 {.quantity = "value", .unit = ""}};
    int *group = dalcs_alloc(plot->n_signals, sizeof *group);
    if (!group) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < plot->n_signals; i++) {
        group[i] = plot->unit[i] == DALCS_VOLT ? 0 : plot->unit[i] == DALCS_AMPERE ? 1 : 2;
    }
    for (int p = 0; p < N_PANELS; p++) {
        dalcs_figure_choose(&panel[p], plot->name, group, plot->n_signals, p);
    }
    free(group);
    return dalcs_figure_begin_panels(figure, plot->title, plot->name, panel, N_PANELS);
}

void dalcs_figure_row(struct dalcs_figure *figure, double time, const double *value) {
    if (!figure->name) {
        return;
    }
    figure->n_rows++;
    double chosen[DALCS_FIGURE_MAX_PANELS * DALCS_FIGURE_MAX_CURVES];
    int n = 0;
    for (int p = 0; p < figure->n_panels; p++) {
        for (int i = 0; i < figure->panel[p].n; i++) {
            chosen[n++] = value[figure->panel[p].signal[i]];
        }
    }
    add_to_view(figure, 0, time, chosen);
    dalcs_tail_add(&figure->tail, time, chosen);
}

/* The signal with the most turns that can be seen, as a column of the tail; *n_turns of it. */
static size_t find_densest(const struct dalcs_figure *figure, long *n_turns) {
    const struct dalcs_figure_view *view = &figure->view[0];
    size_t densest = 0, column = 0;
    *n_turns = 0;
    for (int p = 0; p < figure->n_panels; p++) {
        double visible = VISIBLE * (view->high[p] - view->low[p]);
        for (int i = 0; i < figure->panel[p].n; i++) {
            const struct dalcs_curve *curve = &view->curve[p][i];
            column++;
            if (curve->turns.n > *n_turns && curve->highest - curve->lowest > visible) {
                *n_turns = curve->turns.n;
                densest = column;
            }
        }
    }
    return densest;
}

/* The row of the tail from which on a signal turns TURNS_AT_END times. */
static size_t find_end(const struct dalcs_tail *tail, size_t column) {
    size_t n = dalcs_tail_n_rows(tail);
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        low = fmin(low, dalcs_tail_row(tail, i)[column]);
        high = fmax(high, dalcs_tail_row(tail, i)[column]);
    }
    struct dalcs_turns turns = {.extreme = dalcs_tail_row(tail, n - 1)[column]};
    size_t row = n - 1;
    while (row > 0 && turns.n <= TURNS_AT_END) {
        row--;
        dalcs_turns_add(&turns, dalcs_tail_row(tail, row)[column], SWING * (high - low));
    }
    return row;
}

static enum dalcs_status add_end(struct dalcs_figure *figure) {
    const struct dalcs_tail *tail = &figure->tail;
    long n_turns = 0;
    size_t densest = find_densest(figure, &n_turns);
    if (n_turns <= MAX_TURNS) {
        return DALCS_OK;
    }
    size_t n = dalcs_tail_n_rows(tail), first = find_end(tail, densest);
    double start = *dalcs_tail_row(tail, first), stop = *dalcs_tail_row(tail, n - 1);
    if (!(start < stop)) {
        return DALCS_OK;
    }
    figure->period = 2.0 * (figure->view[0].stop - figure->view[0].start) / (double)n_turns;
    enum dalcs_status status = init_view(figure, start, stop);
    for (size_t i = first; status == DALCS_OK && i < n; i++) {
        const double *row = dalcs_tail_row(tail, i);
        add_to_view(figure, 1, row[0], row + 1);
    }
    return status;
}

static void widen_by_levels(const struct dalcs_figure *figure, struct dalcs_figure_view *view,
                            int p) {
    for (int k = 0; k < figure->n_lines; k++) {
        const struct dalcs_figure_line *line = &figure->line[k];
        if (line->is_level && line->panel == p) {
            view->low[p] = fmin(view->low[p], line->at);
            view->high[p] = fmax(view->high[p], line->at);
        }
    }
}

/* Impulses last a step whatever its length, so their height has no meaning: they do not count for the
 * range where they would dwarf all the rest. */
static void find_ranges(const struct dalcs_figure *figure, struct dalcs_figure_view *view,
                        const struct dalcs_report *report) {
    static const bool none[DALCS_CURVE_COLUMNS];
    bool impulsive[DALCS_CURVE_COLUMNS] = {false};
    int drawn = 0;
    while (drawn + 1 < figure->n_panels && figure->panel[drawn].n == 0) {
        drawn++;
    }
    const struct dalcs_curve *any = &view->curve[drawn][0];
    for (size_t j = 0; report && j < report->n_jumps; j++) {
        double time = report->jump[j].time;
        if (time >= view->start && time <= view->stop) {
            int last = dalcs_curve_find_column(any, time + report->step);
            for (int i = dalcs_curve_find_column(any, time); i <= last; i++) {
                impulsive[i] = true;
            }
        }
    }
    for (int p = 0; p < figure->n_panels; p++) {
        double low = INFINITY, high = -INFINITY, all_low = INFINITY, all_high = -INFINITY;
        for (int i = 0; i < figure->panel[p].n; i++) {
            dalcs_curve_widen_range(&view->curve[p][i], none, &all_low, &all_high);
            dalcs_curve_widen_range(&view->curve[p][i], impulsive, &low, &high);
        }
        view->clipped[p] = low <= high && all_high - all_low > CLIP * (high - low);
        view->low[p] = view->clipped[p] ? low : all_low;
        view->high[p] = view->clipped[p] ? high : all_high;
        if (view->low[p] > view->high[p]) {
            view->low[p] = view->high[p] = 0.0;
        }
        widen_by_levels(figure, view, p);
        double largest = fmax(fabs(view->low[p]), fabs(view->high[p]));
        if (largest < DALCS_FIGURE_NOTHING) {
            largest = view->low[p] = view->high[p] = 0.0;
        }
        view->largest[p] = largest;
        double margin = 0.05 * (view->high[p] - view->low[p]);
        if (margin <= ROUNDING * largest) { /* a constant; 0 in a range of 1 */
            margin = largest > 0.0 ? 0.1 * largest : 0.5;
        }
        view->low[p] -= margin;
        view->high[p] += margin;
    }
}

enum dalcs_status dalcs_figure_compose(struct dalcs_figure *figure,
                                       const struct dalcs_report *report) {
    find_ranges(figure, &figure->view[0], report);
    enum dalcs_status status = add_end(figure);
    if (status == DALCS_OK && figure->n_views > 1) {
        find_ranges(figure, &figure->view[1], report);
    }
    return status;
}

enum dalcs_status dalcs_figure_draw(struct dalcs_figure *figure, const struct dalcs_report *report,
                                    char **left_at) {
    if (left_at) {
        *left_at = NULL;
    }
    if (!figure->name || figure->n_rows == 0) {
        return DALCS_OK;
    }
    struct dalcs_conduction conduction = {0};
    enum dalcs_status status = dalcs_figure_compose(figure, report);
    /* Where events were dropped the conducting elements at the end are unknown. */
    if (status == DALCS_OK && report && !figure->conduction && report->n_events_dropped == 0) {
        status = dalcs_conduction_add_report(&conduction, report);
        dalcs_conduction_sort(&conduction);
        figure->conduction = &conduction;
        figure->bars = true;
    }
    if (status == DALCS_OK) {
        status = dalcs_gnuplot_draw(figure);
    }
    figure->conduction = figure->conduction == &conduction ? NULL : figure->conduction;
    dalcs_conduction_finish(&conduction);
    if (status != DALCS_OK) {
        return status;
    }
    return left_at ? dalcs_atomic_file_keep(&figure->file, left_at)
                   : dalcs_atomic_file_commit(&figure->file);
}

void dalcs_figure_finish(struct dalcs_figure *figure) {
    for (int v = 0; v < figure->n_views; v++) {
        for (int p = 0; p < figure->n_panels; p++) {
            for (int i = 0; i < figure->panel[p].n; i++) {
                dalcs_curve_finish(&figure->view[v].curve[p][i]);
            }
        }
    }
    dalcs_tail_finish(&figure->tail);
    dalcs_atomic_file_discard(&figure->file);
    *figure = (struct dalcs_figure){0};
}
