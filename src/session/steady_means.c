/* steady_means.c - Gauss' rule on every stretch between two events, edges or ends of steps. */
#include "steady_means.h"

#include <math.h>
#include <stdlib.h>

/* A stretch of a sine is resolved up to this many radians, as in measures.c. */
static const double most_turn = 3.6;

/* Signals that sources drive without memory have the shape of these, however long the steps are. */
static enum dalcs_status find_longest(struct dalcs_steady_means *m) {
    int most = 1;
    for (int i = 0; i < m->circuit->n_stimuli; i++) {
        int n = dalcs_stimulus_n_terms(&m->circuit->stimulus[i]);
        most = n > most ? n : most;
    }
    struct dalcs_stimulus_term *term = dalcs_alloc((size_t)most, sizeof(*term));
    if (term == NULL) {
        return DALCS_E_NOMEM;
    }
    m->longest = INFINITY;
    for (int i = 0; i < m->circuit->n_stimuli; i++) {
        struct dalcs_stimulus_piece piece = {.term = term};
        if (dalcs_stimulus_n_terms(&m->circuit->stimulus[i]) == 0) {
            continue;
        }
        dalcs_stimulus_course_at(&m->circuit->stimulus[i], 0.0, &piece);
        for (int k = 0; k < piece.n_terms; k++) {
            if (term[k].omega != 0.0) {
                m->longest = fmin(m->longest, most_turn / fabs(term[k].omega));
            }
        }
    }
    free(term);
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_means_setup(struct dalcs_steady_means *m,
                                           const struct dalcs_circuit *circuit,
                                           const struct dalcs_network *network,
                                           struct dalcs_radau *radau) {
    const size_t n = (size_t)network->n_outputs + 1;
    *m = (struct dalcs_steady_means){.circuit = circuit};
    m->rule = dalcs_stretch_rule;
    m->sum = dalcs_alloc(n, sizeof(double));
    m->square = dalcs_alloc(n, sizeof(double));
    enum dalcs_status status =
        m->sum != NULL && m->square != NULL ? find_longest(m) : DALCS_E_NOMEM;
    if (status == DALCS_OK) {
        status = dalcs_edges_ahead_of_all(&m->edges, circuit->stimulus, circuit->n_stimuli);
    }
    if (status == DALCS_OK) {
        status = dalcs_rows_setup(&m->rows, radau, NULL, network->n_outputs);
    }
    if (status != DALCS_OK) {
        dalcs_steady_means_finish(m);
        return status;
    }
    m->next_edge = dalcs_edges_ahead_after(&m->edges, 0.0);
    return DALCS_OK;
}

void dalcs_steady_means_finish(struct dalcs_steady_means *m) {
    if (m->rows.radau != NULL) {
        dalcs_rows_finish(&m->rows);
    }
    dalcs_edges_ahead_finish(&m->edges);
    free(m->sum);
    free(m->square);
    *m = (struct dalcs_steady_means){0};
}

static enum dalcs_status add_stretch(struct dalcs_steady_means *m, double from, double to) {
    double time[DALCS_STRETCH_NODES];
    for (int i = 0; i < DALCS_STRETCH_NODES; i++) {
        time[i] = from + 0.5 * (1.0 + m->rule.node[i]) * (to - from);
    }
    int n_done;
    for (int first = 0; first < DALCS_STRETCH_NODES; first += n_done) {
        DALCS_TRY(dalcs_rows_fill(&m->rows, time + first, DALCS_STRETCH_NODES - first, DALCS_RIGHT,
                                  &n_done));
        for (int k = 0; k < m->rows.n_outputs; k++) {
            for (int i = 0; i < n_done; i++) {
                double value = m->rows.value[k].at[i];
                double weight = m->rule.weight[first + i] * (to - from);
                m->sum[k] += weight * value;
                m->square[k] += weight * value * value;
            }
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_means_reach(struct dalcs_steady_means *m, double t) {
    while (m->t < t) {
        double to = fmin(fmin(t, m->t + m->longest), m->next_edge);
        if (to - m->t > m->rows.radau->resolution) {
            DALCS_TRY(add_stretch(m, m->t, to));
        }
        m->t = to;
        m->next_edge = to >= m->next_edge ? dalcs_edges_ahead_after(&m->edges, to) : m->next_edge;
    }
    return DALCS_OK;
}
