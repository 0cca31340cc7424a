/* grid.c - counting multiples of h and landing on edges. */
#include "grid.h"

#include <math.h>

static double next_edge(const struct dalcs_grid *g) {
    double edge = INFINITY;
    for (int i = 0; i < g->n_stimuli; i++) {
        edge = fmin(edge, dalcs_stimulus_next_edge(&g->stimulus[i], g->t));
    }
    return edge;
}

void dalcs_grid_init(struct dalcs_grid *grid, double h, double stop, int n_stimuli,
                     const struct dalcs_stimulus *stimulus) {
    int exponent;
    (void)frexp(stop, &exponent);
    *grid = (struct dalcs_grid){.h = h,
                                .stop = stop,
                                .resolution = ldexp(1.0, exponent - 50),
                                .n_stimuli = n_stimuli,
                                .stimulus = stimulus};
    grid->next_edge = next_edge(grid);
}

void dalcs_grid_disturb(struct dalcs_grid *grid, double due) {
    grid->next_edge = fmin(next_edge(grid), due);
}

double dalcs_grid_advance(struct dalcs_grid *g, bool *jumps) {
    double from = g->t;
    double near = 4.0 * g->resolution;
    double regular = (double)(g->k + 1) * g->h;
    bool whole = fabs((double)g->k * g->h - from) <= near;
    if (regular >= g->stop - near) {
        regular = g->stop;
        whole = whole && fabs((double)(g->k + 1) * g->h - g->stop) <= near;
    }
    bool on_edge = g->next_edge <= regular + near;
    if (on_edge && g->next_edge < regular - near) {
        g->t = g->next_edge;
        whole = false;
    } else {
        /* An edge on the grid is met at the edge's own time, where its two limits are exact. */
        g->t = on_edge && regular < g->stop ? g->next_edge : regular;
        g->k++;
    }
    *jumps = false;
    if (on_edge) {
        for (int i = 0; i < g->n_stimuli && !*jumps; i++) {
            *jumps = dalcs_stimulus_jumps_at(&g->stimulus[i], g->t);
        }
        g->next_edge = next_edge(g);
    }
    return whole ? g->h : fmax(g->resolution, rint((g->t - from) / g->resolution) * g->resolution);
}
