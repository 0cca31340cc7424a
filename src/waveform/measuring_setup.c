/* measuring_setup.c - what is to be measured, and room for it. */
#include "measuring.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>

bool dalcs_measuring_has_time(enum dalcs_measured_analysis analysis) {
    return analysis == DALCS_MEASURED_TRAN || analysis == DALCS_MEASURED_PSS;
}

bool dalcs_measuring_is_wanted(const struct dalcs_circuit *circuit,
                               enum dalcs_measured_analysis analysis) {
    bool wanted = dalcs_measuring_has_time(analysis) &&
                  (circuit->results.n_fouriers > 0 ||
                   (circuit->results.losses != NULL && circuit->results.losses->present));
    for (int k = 0; k < circuit->results.n_measures && !wanted; k++) {
        wanted = circuit->results.measure[k].analysis == analysis;
    }
    return wanted;
}

static enum dalcs_status set_up_harmonics(struct dalcs_measuring *m, double stop) {
    const struct dalcs_circuit *c = m->circuit;
    if (!dalcs_measuring_has_time(m->analysis)) {
        return DALCS_OK;
    }
    m->harmonics = dalcs_alloc((size_t)c->results.n_fouriers, sizeof(*m->harmonics));
    if (m->harmonics == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < c->results.n_fouriers; k++) {
        const bool is_orbit = m->analysis == DALCS_MEASURED_PSS;
        DALCS_TRY(dalcs_harmonics_setup(&m->harmonics[k], &c->results.fourier[k], stop, is_orbit));
        m->n_harmonics++;
    }
    return DALCS_OK;
}

/* Is one measured late, by what it keeps? */
static bool start_items(struct dalcs_measuring *m) {
    bool keeps = false;
    for (int k = 0; k < m->n; k++) {
        const struct dalcs_measure_card *card = &m->circuit->results.measure[k];
        m->item[k] = (struct dalcs_measured){.card = card,
                                             .instant = {dalcs_instant_start(&card->instant[0]),
                                                         dalcs_instant_start(&card->instant[1])},
                                             .mean = -1,
                                             .from = card->from,
                                             .to = card->to,
                                             .begin = INFINITY,
                                             .end = -INFINITY,
                                             .least = INFINITY,
                                             .most = -INFINITY};
        keeps = keeps || (card->is_late && card->analysis == m->analysis);
    }
    return keeps;
}

enum dalcs_status dalcs_measuring_setup(struct dalcs_measuring *m,
                                        const struct dalcs_circuit *circuit,
                                        enum dalcs_measured_analysis analysis, double start,
                                        double stop) {
    size_t n_signals = (size_t)circuit->results.n_measured;
    *m = (struct dalcs_measuring){.circuit = circuit,
                                  .analysis = analysis,
                                  .start = start,
                                  .stop = stop,
                                  .n = circuit->results.n_measures};
    m->rule = dalcs_stretch_rule;
    m->values = dalcs_alloc(3 * n_signals, sizeof(*m->values));
    m->row = dalcs_alloc(n_signals, sizeof(double));
    m->row_imaginary = dalcs_alloc(n_signals, sizeof(double));
    m->impulse = dalcs_alloc(n_signals, sizeof(double));
    m->item = dalcs_alloc((size_t)m->n, sizeof(*m->item));
    enum dalcs_status status = m->values == NULL || m->row == NULL || m->row_imaginary == NULL ||
                                       m->impulse == NULL || m->item == NULL
                                   ? DALCS_E_NOMEM
                                   : set_up_harmonics(m, stop);
    if (status != DALCS_OK) {
        dalcs_measuring_finish(m);
        return status;
    }
    m->stretch = (struct dalcs_stretch){.rule = &m->rule,
                                        .n_signals = circuit->results.n_measured,
                                        .value = m->values,
                                        .coefficient = m->values + n_signals};
    if (analysis == DALCS_MEASURED_AC) {
        m->stretch.imaginary = m->values + 2 * n_signals;
    }
    const bool keeps = start_items(m);
    m->kept = keeps ? dalcs_kept_stretches_create(&m->stretch) : NULL;
    if (keeps && m->kept == NULL) {
        dalcs_measuring_finish(m);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

void dalcs_measuring_finish(struct dalcs_measuring *m) {
    for (int k = 0; k < m->n_harmonics; k++) {
        dalcs_harmonics_finish(&m->harmonics[k]);
    }
    dalcs_kept_stretches_destroy(m->kept);
    free(m->harmonics);
    free(m->values);
    free(m->row);
    free(m->row_imaginary);
    free(m->impulse);
    free(m->item);
    *m = (struct dalcs_measuring){0};
}

double dalcs_measuring_begin(const struct dalcs_measuring *m) {
    double begin = m->kept != NULL ? m->start : INFINITY;
    for (int k = 0; k < m->n; k++) {
        const struct dalcs_measure_card *card = m->item[k].card;
        if (card->analysis == m->analysis && card->kind != DALCS_MEASURE_PARAM && !card->is_late) {
            begin = fmin(begin, fmax(m->start, m->item[k].from));
        }
    }
    for (int k = 0; k < m->n_harmonics; k++) {
        begin = fmin(begin, m->harmonics[k].from);
    }
    return begin;
}
