/* measuring.c - measurements from stretch to stretch, values at instants. */
#include "measuring.h"

#include "measuring_extremes.h"
#include "measuring_rows.h"
#include "measuring_sides.h"
#include "measuring_sums.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

enum { N = DALCS_STRETCH_NODES };

/* ---- Values at instants ------------------------------------------------------------------------ */

struct slope {
    double time, value;
};

static bool find_slope(void *user, const struct dalcs_span *span) {
    struct slope *s = user;
    double derivative[N];
    dalcs_stretch_derive(span->coefficient, derivative);
    double length = span->to - span->from;
    double x = fmax(-1.0, fmin(1.0, 2.0 * ((s->time - span->from) / length) - 1.0));
    s->value = 2.0 * dalcs_stretch_at(derivative, x) / length;
    return s->time >= span->to; /* the span that holds it, from its start on */
}

/* FIND or DERIV at a time of the present stretch. */
static void evaluate(const struct dalcs_measuring *m, struct dalcs_measured *item, double time) {
    const struct dalcs_signal_formula *formula = &item->card->formula;
    item->waits = false;
    if (item->card->kind == DALCS_MEASURE_FIND) {
        item->value = dalcs_stretch_value(&m->stretch, formula, time);
        item->has_no_value = isnan(item->value);
    } else {
        struct slope s = {.time = time};
        item->has_no_value = !dalcs_stretch_visit(&m->stretch, formula, m->stretch.from,
                                                  m->stretch.to, &item->scale, &s, find_slope);
        item->value = s.value;
    }
    item->has_value = !item->has_no_value;
}

static bool needs_value(const struct dalcs_measured *item) {
    return item->card->kind == DALCS_MEASURE_FIND || item->card->kind == DALCS_MEASURE_DERIVATIVE;
}

/* ---- Stretches --------------------------------------------------------------------------------- */

static void measure(const struct dalcs_measuring *m, struct dalcs_measured *item) {
    const struct dalcs_measure_card *card = item->card;
    const struct dalcs_stretch *s = &m->stretch;
    double from = fmax(s->from, fmax(m->start, item->from));
    double to = fmin(s->to, fmin(m->stop, item->to));
    if (card->analysis != m->analysis || card->kind == DALCS_MEASURE_PARAM || item->has_no_value) {
        return;
    }
    if (item->waits) {
        evaluate(m, item, s->from);
    }
    if (!(from <= to)) {
        return;
    }
    item->is_means =
        item->is_means || ((m->sides != NULL || s->slides) && dalcs_measuring_adds_means(m, item));
    bool is_new = dalcs_instant_look(&item->instant[0], s, from, to);
    dalcs_instant_look(&item->instant[1], s, from, to);
    if (is_new && needs_value(item)) {
        double time = item->instant[0].time;
        item->waits = time >= s->to - dalcs_sum_rounded * fabs(s->to);
        if (!item->waits) {
            evaluate(m, item, time);
        }
    }
    if (card->kind <= DALCS_MEASURE_MAX_AT) {
        dalcs_measuring_add(m, item);
    }
}

/* What was just before: that of the stretch before, where it is known, or what it is now less what has changed. */
static void take_impulses(struct dalcs_measuring *m, double from) {
    struct dalcs_stretch *s = &m->stretch;
    const bool is_next = m->has_row && fabs(s->to - from) <= m->near;
    for (int k = 0; k < s->n_signals; k++) {
        const double before = dalcs_stretch_at(s->coefficient[k], 1.0);
        dalcs_stretch_expand(&m->rule, s->value[k], s->coefficient[k]);
        m->row[k] = is_next ? before : dalcs_stretch_at(s->coefficient[k], -1.0) - m->row[k];
    }
    s->impulse = m->impulse;
    s->left = m->row;
    if (m->kept != NULL) {
        dalcs_kept_stretches_add_impulses(m->kept, s, from);
    }
}

void dalcs_measuring_stretch(struct dalcs_measuring *m, double from, double to, bool has_impulses) {
    struct dalcs_stretch *s = &m->stretch;
    s->impulse = NULL;
    if (has_impulses) {
        take_impulses(m, from);
    }
    s->from = from;
    s->to = to;
    s->slides = m->kept != NULL && m->sides != NULL && dalcs_side_means_any_slides(m->sides);
    for (int k = 0; k < s->n_signals; k++) {
        dalcs_stretch_expand(&m->rule, s->value[k], s->coefficient[k]);
    }
    if (m->watch != NULL) {
        m->watch->begin(m->watch->user, m, -1);
    }
    for (int k = 0; k < m->n; k++) {
        if (!m->item[k].card->is_late) {
            measure(m, &m->item[k]);
        }
    }
    for (int k = 0; k < m->n_harmonics; k++) {
        struct dalcs_harmonics *h = &m->harmonics[k];
        const bool slides = m->sides != NULL && dalcs_side_means_slides(m->sides, h->mean);
        h->is_means = h->is_means || (h->mean < 0 && dalcs_measuring_is_bent(m, &h->card->formula));
        dalcs_harmonics_add(h, s, slides ? m->sides : NULL);
        dalcs_harmonics_add_impulses(h, s, m->near);
    }
    m->has_row = true;
    if (m->watch != NULL) {
        m->watch->end(m->watch->user, m, -1);
    }
    if (m->kept != NULL) {
        dalcs_kept_stretches_add(m->kept, s);
    }
}

/* Before an edge at the start of a transient: levels are passed from there, and extremes may be there. */
static void measure_before_start(const struct dalcs_measuring *m, struct dalcs_measured *item) {
    const struct dalcs_measure_card *card = item->card;
    const double at = m->stretch.from;
    for (int k = 0; k < 2; k++) {
        dalcs_instant_look_before(&item->instant[k], &m->stretch);
    }
    bool is_extreme = card->kind > DALCS_MEASURE_INTEGRAL && card->kind <= DALCS_MEASURE_MAX_AT;
    if (!is_extreme || card->instant[0].kind != DALCS_INSTANT_NONE || item->from > at) {
        return;
    }
    const double value = dalcs_stretch_value(&m->stretch, &card->formula, at);
    item->scale = fabs(value);
    dalcs_climb_to(&(struct dalcs_climb){&m->rule, 1.0, item->scale, &item->most, &item->most_at},
                   value, at);
    dalcs_climb_to(
        &(struct dalcs_climb){&m->rule, -1.0, item->scale, &item->least, &item->least_at}, value,
        at);
}

static void measure_at_point(const struct dalcs_measuring *m, struct dalcs_measured *item) {
    const struct dalcs_measure_card *card = item->card;
    if (dalcs_measuring_has_time(m->analysis)) {
        if (card->analysis == m->analysis && card->kind != DALCS_MEASURE_PARAM) {
            measure_before_start(m, item);
        }
        return;
    }
    const struct dalcs_measure_instant *instant = &card->instant[0];
    const bool is_found = card->kind == DALCS_MEASURE_FIND && instant->kind == DALCS_INSTANT_AT &&
                          item->instant[0].at == m->stretch.from;
    const bool is_inside = m->analysis == DALCS_MEASURED_OP ||
                           (item->from <= m->stretch.from && m->stretch.from <= item->to);
    if (card->analysis == m->analysis && card->formula.n > 0 && card->kind != DALCS_MEASURE_PARAM &&
        (is_found || instant->kind == DALCS_INSTANT_NONE)) {
        item->value = dalcs_stretch_value(&m->stretch, &card->formula, m->stretch.from);
        item->has_no_value = isnan(item->value);
        item->has_value = dalcs_measuring_has_one_point(m) && is_inside && !item->has_no_value;
    }
}

bool dalcs_measuring_has_one_point(const struct dalcs_measuring *m) {
    return m->analysis == DALCS_MEASURED_OP ||
           (!dalcs_measuring_has_time(m->analysis) && m->start == m->stop);
}

/* At a single point, as an operating point is. */
static void measure_point(struct dalcs_measuring *m, double at, const double *re,
                          const double *im) {
    struct dalcs_stretch *s = &m->stretch;
    s->from = at;
    s->to = at;
    for (int k = 0; k < s->n_signals; k++) {
        memset(s->coefficient[k], 0, sizeof(s->coefficient[k]));
        s->coefficient[k][0] = re[k];
        if (s->imaginary != NULL) {
            memset(s->imaginary[k], 0, sizeof(s->imaginary[k]));
            s->imaginary[k][0] = im[k];
        }
    }
    if (m->kept != NULL) {
        dalcs_kept_stretches_add(m->kept, s);
    }
    for (int k = 0; k < m->n; k++) {
        if (!m->item[k].card->is_late) {
            measure_at_point(m, &m->item[k]);
        }
    }
}

void dalcs_measuring_before_start(struct dalcs_measuring *m, const double *value) {
    if (m->start <= 0.0) {
        measure_point(m, 0.0, value, NULL);
        m->has_row = true;
    }
}

/* Of frequencies an octave at a time: over it the polynomial of a power is off by its rounding alone. */
static void join_rows(struct dalcs_measuring *m, double at, const double *re, const double *im) {
    double from = m->row_at;
    while (from < at) {
        const bool is_long = m->stretch.imaginary != NULL && from > 0.0 && 2.0 * from < at;
        m->stretch.from = from;
        m->stretch.to = is_long ? 2.0 * from : at;
        dalcs_measuring_fill_stretch(m, at, re, im);
        from = m->stretch.to;
        dalcs_measuring_stretch(m, m->stretch.from, m->stretch.to, false);
    }
}

void dalcs_measuring_row(struct dalcs_measuring *m, double at, const double *re, const double *im) {
    struct dalcs_stretch *s = &m->stretch;
    if (!m->has_row) {
        measure_point(m, at, re, im);
    } else if (at > m->row_at) {
        join_rows(m, at, re, im);
    }
    size_t bytes = (size_t)s->n_signals * sizeof(double);
    memcpy(m->row, re, bytes);
    if (im != NULL) {
        memcpy(m->row_imaginary, im, bytes);
    }
    m->row_at = at;
    m->has_row = true;
}

enum dalcs_status dalcs_measuring_close(struct dalcs_measuring *m) {
    for (int k = 0; k < m->n; k++) {
        if (m->item[k].waits) {
            evaluate(m, &m->item[k], m->stretch.to);
        }
    }
    return m->kept != NULL && m->kept->out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}

/* ---- After the run ----------------------------------------------------------------------------- */

/* A time on the card, or what earlier measurements make of it. */
static bool take_time(const struct dalcs_signal_formula *formula, const double *result,
                      double *time) {
    if (formula->n > 0) {
        *time = dalcs_signal_formula_value(formula,
                                           &(struct dalcs_signal_formula_point){.result = result});
    }
    return !isnan(*time);
}

/* A late measurement, with a watch. */
static void measure_watched(struct dalcs_measuring *m, int k) {
    if (m->watch != NULL) {
        m->watch->begin(m->watch->user, m, k);
    }
    measure(m, &m->item[k]);
    if (m->watch != NULL) {
        m->watch->end(m->watch->user, m, k);
    }
}

bool dalcs_measuring_late(struct dalcs_measuring *m, int k, const double *result) {
    struct dalcs_measured *item = &m->item[k];
    const struct dalcs_measure_card *card = item->card;
    struct dalcs_stretch *s = &m->stretch;
    struct dalcs_side_means *sides = m->sides;
    m->sides = NULL; /* they are those of the last segment */
    bool is_known = take_time(&card->from_formula, result, &item->from) &&
                    take_time(&card->to_formula, result, &item->to);
    for (int i = 0; i < 2 && is_known; i++) {
        const struct dalcs_measure_instant *instant = &card->instant[i];
        is_known = take_time(&instant->at_formula, result, &item->instant[i].at) &&
                   take_time(&instant->delay_formula, result, &item->instant[i].delay);
    }
    s->result = result;
    for (size_t i = 0; i < m->kept->n && is_known; i++) {
        if (dalcs_kept_stretches_load(m->kept, i, s)) {
            continue; /* the next one begins with them */
        }
        if (s->from == s->to) {
            measure_at_point(m, item);
        } else {
            measure_watched(m, k);
        }
        s->impulse = NULL;
    }
    if (item->waits) {
        evaluate(m, item, s->to);
    }
    s->result = NULL;
    m->sides = sides;
    return is_known;
}
