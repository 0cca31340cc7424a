/* figure.c - chooses what to draw and collects it; gnuplot.c does the drawing. */
#include "figure.h"

#include "gnuplot.h"

#include <string.h>
#include <strings.h>

bool dalcs_figure_can_write(const char *path) {
    const char *dot = strrchr(path, '.');
    return dot && (strcasecmp(dot, ".svg") == 0 || strcasecmp(dot, ".png") == 0);
}

void dalcs_figure_init(struct dalcs_figure *figure, const char *path, double start, double stop) {
    *figure = (struct dalcs_figure){.path = path, .start = start, .stop = stop};
    figure->panel[0].unit = DALCS_VOLT;
    figure->panel[1].unit = DALCS_AMPERE;
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

static void choose_signals(struct dalcs_figure_panel *panel, const struct dalcs_plot *plot) {
    enum { N_RANKS = 3 };

    size_t n_of_rank[N_RANKS] = {0};
    size_t room[N_RANKS];
    for (size_t i = 0; i < plot->n_signals; i++) {
        n_of_rank[rank_signal(plot->name[i])] += plot->unit[i] == panel->unit ? 1 : 0;
    }
    size_t left = DALCS_FIGURE_MAX_CURVES;
    for (int rank = 0; rank < N_RANKS; rank++) {
        room[rank] = n_of_rank[rank] < left ? n_of_rank[rank] : left;
        left -= room[rank];
        panel->n_left_out += n_of_rank[rank] - room[rank];
    }
    for (size_t i = 0; i < plot->n_signals; i++) {
        int rank = rank_signal(plot->name[i]);
        if (plot->unit[i] == panel->unit && room[rank] > 0) {
            room[rank]--;
            panel->signal[panel->n++] = i;
        }
    }
}

enum dalcs_status dalcs_figure_begin(struct dalcs_figure *figure, const struct dalcs_plot *plot) {
    if (plot->analysis != DALCS_TRANSIENT || plot->n_signals == 0) {
        return DALCS_OK;
    }
    figure->plot = plot;
    for (int p = 0; p < 2; p++) {
        struct dalcs_figure_panel *panel = &figure->panel[p];
        choose_signals(panel, plot);
        for (int i = 0; i < panel->n; i++) {
            enum dalcs_status status =
                dalcs_curve_init(&panel->curve[i], figure->start, figure->stop);
            if (status != DALCS_OK) {
                return status;
            }
        }
    }
    return dalcs_atomic_file_open(&figure->file, figure->path);
}

void dalcs_figure_row(struct dalcs_figure *figure, double time, const double *value) {
    if (!figure->plot) {
        return;
    }
    figure->n_rows++;
    for (int p = 0; p < 2; p++) {
        struct dalcs_figure_panel *panel = &figure->panel[p];
        for (int i = 0; i < panel->n; i++) {
            dalcs_curve_add(&panel->curve[i], time, value[panel->signal[i]]);
        }
    }
}

enum dalcs_status dalcs_figure_draw(struct dalcs_figure *figure, char **left_at) {
    if (left_at) {
        *left_at = NULL;
    }
    if (!figure->plot || figure->n_rows == 0) {
        return DALCS_OK;
    }
    enum dalcs_status status = dalcs_gnuplot_draw(figure);
    if (status != DALCS_OK) {
        return status;
    }
    return left_at ? dalcs_atomic_file_keep(&figure->file, left_at)
                   : dalcs_atomic_file_commit(&figure->file);
}

void dalcs_figure_finish(struct dalcs_figure *figure) {
    for (int p = 0; p < 2; p++) {
        for (int i = 0; i < figure->panel[p].n; i++) {
            dalcs_curve_finish(&figure->panel[p].curve[i]);
        }
    }
    dalcs_atomic_file_discard(&figure->file);
    *figure = (struct dalcs_figure){0};
}
