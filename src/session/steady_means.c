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

/* ---- Jumps --------------------------------------------------------------------------------------- */

void dalcs_steady_means_close(struct dalcs_steady_means *m) {
    if (!m->impulses.is_noted || !dalcs_impulses_at(&m->impulses, m->impulses.time)) {
        return;
    }
    for (int k = 0; k < m->impulses.network->n_outputs; k++) {
        const double area = dalcs_impulses_of(&m->impulses, &m->circuit->results.signal[k]);
        m->sum[k] += area;
        m->has_impulse[k] = m->has_impulse[k] || area != 0.0;
    }
    m->impulses.is_noted = false;
}

/* Those of all parts at one time belong together. */
static enum dalcs_status note_jump(void *user, const struct dalcs_euler_jump *jump) {
    struct dalcs_steady_means *m = user;
    if (m->impulses.is_noted && fabs(m->impulses.time - jump->time) > m->impulses.near) {
        dalcs_steady_means_close(m);
    }
    dalcs_impulses_note(&m->impulses, jump);
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_means_listen(struct dalcs_steady_means *m,
                                            const struct dalcs_circuit *circuit,
                                            const struct dalcs_network *network,
                                            struct dalcs_euler *engine, double near) {
    const size_t n = (size_t)network->n_outputs + 1;
    m->circuit = circuit;
    m->sum = dalcs_alloc(n, sizeof(double));
    m->square = dalcs_alloc(n, sizeof(double));
    m->has_impulse = dalcs_alloc(n, sizeof(bool));
    if (m->sum == NULL || m->square == NULL || m->has_impulse == NULL) {
        return DALCS_E_NOMEM;
    }
    if (circuit->n_devices == 0) {
        return DALCS_OK; /* of a system file, whose signals are of no elements */
    }
    engine->listener.jump_user = m;
    engine->listener.on_jump = note_jump;
    return dalcs_impulses_setup(&m->impulses, circuit, network, near);
}

double dalcs_steady_means_average(const struct dalcs_steady_means *m, int output, double duration) {
    return m->sum[output] / duration;
}

double dalcs_steady_means_rms(const struct dalcs_steady_means *m, int output, double duration) {
    return m->has_impulse[output] ? (double)NAN : sqrt(m->square[output] / duration);
}

/* ---- Stretches ----------------------------------------------------------------------------------- */

enum dalcs_status dalcs_steady_means_setup(struct dalcs_steady_means *m,
                                           const struct dalcs_circuit *circuit,
                                           const struct dalcs_network *network,
                                           struct dalcs_radau *radau) {
    m->rule = dalcs_stretch_rule;
    enum dalcs_status status = find_longest(m);
    if (status == DALCS_OK) {
        status = dalcs_edges_ahead_of_all(&m->edges, circuit->stimulus, circuit->n_stimuli);
    }
    if (status == DALCS_OK) {
        status = dalcs_rows_setup(&m->rows, radau, NULL, network->n_outputs);
    }
    m->next_edge = status == DALCS_OK ? dalcs_edges_ahead_after(&m->edges, 0.0) : 0.0;
    return status;
}

void dalcs_steady_means_finish(struct dalcs_steady_means *m) {
    if (m->rows.radau != NULL) {
        dalcs_rows_finish(&m->rows);
    }
    dalcs_edges_ahead_finish(&m->edges);
    free(m->sum);
    free(m->square);
    free(m->has_impulse);
    dalcs_impulses_finish(&m->impulses);
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
