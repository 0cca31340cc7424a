/* measure_report.c - what was measured, into the report; what could not be, in words. */
#include "measures.h"

#include "quantity.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A period and a frequency that were written with nine digits: each is off by up to 5e-9 of itself. */
static const double same_frequency = 1e-8;

/* A result on its way into the report. */
struct result {
    struct dalcs_session *s;
    const struct dalcs_measuring *measuring;
    const struct dalcs_measured *item;
    struct dalcs_measurement *measurement;
    bool out_of_memory;
};

static void fail(struct result *r, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void fail(struct result *r, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    r->measurement->failure = dalcs_arena_printf_list(&r->s->arena, format, arguments);
    va_end(arguments);
    r->out_of_memory = r->out_of_memory || r->measurement->failure == NULL;
}

static void detail(struct result *r, const char *name, double value) {
    struct dalcs_measurement *m = r->measurement;
    m->detail[m->n_details++] = (struct dalcs_measurement_detail){name, value};
}

static void give(struct result *r, double value) {
    r->measurement->found = true;
    r->measurement->value = value;
}

static const char *moment(const struct result *r, char *text, double at) {
    const char *unit = r->measuring->analysis == DALCS_MEASURED_TRAN ||
                               r->measuring->analysis == DALCS_MEASURED_PSS
                           ? "s"
                       : r->measuring->analysis == DALCS_MEASURED_AC ? "Hz"
                                                                     : "";
    return dalcs_quantity_write(text, at, unit, 6);
}

/* Why a condition did not come true: true when it did. */
static bool check_instant(struct result *r, const struct dalcs_instant *i) {
    static const char *const verbs[] = {[DALCS_EDGE_ANY] = "crosses",
                                        [DALCS_EDGE_RISE] = "rises through",
                                        [DALCS_EDGE_FALL] = "falls through"};
    const struct dalcs_measure_instant *c = i->card;
    char a[DALCS_QUANTITY_SIZE];
    char b[DALCS_QUANTITY_SIZE];
    if (i->found) {
        return true;
    }
    double from = fmax(r->measuring->start, r->item->from);
    double to = fmin(r->measuring->stop, r->item->to);
    if (c->kind == DALCS_INSTANT_AT) {
        fail(r, "AT=%s does not lie between %s and %s", moment(r, a, i->at), moment(r, b, from),
             moment(r, (char[DALCS_QUANTITY_SIZE]){0}, to));
        return false;
    }
    if (i->has_no_value) {
        fail(r, "'%s' is undefined at some of its times", c->text);
        return false;
    }
    moment(r, a, fmax(from, i->delay));
    moment(r, b, to);
    if (i->n == 0) {
        fail(r, "'%s' never %s %s between %s and %s", c->left.text, verbs[c->edge], c->text, a, b);
    } else {
        fail(r, "'%s' %s %s only %d time%s between %s and %s, not %d", c->left.text, verbs[c->edge],
             c->text, i->n, i->n == 1 ? "" : "s", a, b, c->count);
    }
    return false;
}

/* Of an operating point all are its value. Of one point of a sweep nothing is between two. */
static void tell_point(struct result *r) {
    const double value = r->item->value;
    const bool is_swept = r->measuring->analysis != DALCS_MEASURED_OP;
    switch (r->item->card->kind) {
    case DALCS_MEASURE_MIN_AT:
    case DALCS_MEASURE_MAX_AT:
        give(r, is_swept ? r->measuring->start : value);
        return;
    case DALCS_MEASURE_RMS:
        give(r, is_swept ? fabs(value) : value);
        return;
    case DALCS_MEASURE_PEAK_TO_PEAK:
    case DALCS_MEASURE_INTEGRAL:
        give(r, is_swept ? 0.0 : value);
        return;
    default:
        give(r, value);
        return;
    }
}

/* Sums and extremes. */
static void tell_statistic(struct result *r) {
    const struct dalcs_measured *item = r->item;
    const struct dalcs_instant *trig = &item->instant[0];
    const struct dalcs_instant *targ = &item->instant[1];
    char a[DALCS_QUANTITY_SIZE];
    char b[DALCS_QUANTITY_SIZE];
    double length = item->end - item->begin;
    if (item->has_value) { /* of one point */
        tell_point(r);
        return;
    }
    if (trig->card->kind != DALCS_INSTANT_NONE) {
        if (!check_instant(r, trig) || !check_instant(r, targ)) {
            return;
        }
        if (!(targ->time > trig->time)) {
            fail(r, "TARG at %s does not come after TRIG at %s", moment(r, a, targ->time),
                 moment(r, b, trig->time));
            return;
        }
    }
    if (!(item->from < item->to)) {
        fail(r, "FROM=%s does not come before TO=%s", moment(r, a, item->from),
             moment(r, b, item->to));
        return;
    }
    if (!(length > 0.0)) {
        fail(r, "there is nothing to measure: the run goes from %s to %s",
             moment(r, a, r->measuring->start), moment(r, b, r->measuring->stop));
        return;
    }
    switch (item->card->kind) {
    case DALCS_MEASURE_MIN:
        give(r, item->least);
        detail(r, "at", item->least_at);
        return;
    case DALCS_MEASURE_MAX:
        give(r, item->most);
        detail(r, "at", item->most_at);
        return;
    case DALCS_MEASURE_MIN_AT:
        give(r, item->least_at);
        detail(r, "with", item->least);
        return;
    case DALCS_MEASURE_MAX_AT:
        give(r, item->most_at);
        detail(r, "with", item->most);
        return;
    case DALCS_MEASURE_AVERAGE:
        give(r, item->integral / length);
        break;
    case DALCS_MEASURE_RMS:
        give(r, sqrt(item->square / length));
        break;
    case DALCS_MEASURE_PEAK_TO_PEAK:
        give(r, item->most - item->least);
        break;
    default:
        give(r, item->integral);
        break;
    }
    detail(r, "from", item->begin);
    detail(r, "to", item->end);
}

static void tell(struct result *r, const double *results) {
    const struct dalcs_measured *item = r->item;
    const struct dalcs_measure_card *card = item->card;
    const struct dalcs_instant *i = item->instant;
    if (item->has_no_value) {
        fail(r, "'%s' is undefined at some of its times", card->formula.text);
        return;
    }
    switch (card->kind) {
    case DALCS_MEASURE_PARAM: {
        double value = dalcs_signal_formula_value(
            &card->formula, &(struct dalcs_signal_formula_point){.result = results});
        if (isfinite(value)) {
            give(r, value);
        } else {
            fail(r, "'%s' has no value", card->formula.text);
        }
        return;
    }
    case DALCS_MEASURE_WHEN:
        if (check_instant(r, &i[0])) {
            give(r, i[0].time);
        }
        return;
    case DALCS_MEASURE_DELAY:
        if (check_instant(r, &i[0]) && check_instant(r, &i[1])) {
            give(r, i[1].time - i[0].time);
            detail(r, "targ", i[1].time);
            detail(r, "trig", i[0].time);
        }
        return;
    case DALCS_MEASURE_FIND:
    case DALCS_MEASURE_DERIVATIVE:
        if (item->has_value) {
            give(r, item->value);
        } else {
            check_instant(r, &i[0]);
        }
        return;
    default:
        tell_statistic(r);
        return;
    }
}

/* The measurement that a formula needs and that failed; NULL: none. */
static const struct dalcs_measure_card *failed_in(const struct dalcs_circuit *c,
                                                  const struct dalcs_signal_formula *formula,
                                                  const double *results) {
    for (int k = 0; k < formula->n; k++) {
        const struct dalcs_signal_formula_step *step = &formula->step[k];
        if (step->push == DALCS_PUT_RESULT && isnan(results[step->index])) {
            return &c->measure[step->index];
        }
    }
    return NULL;
}

/* The same for all formulas of a card. */
static const struct dalcs_measure_card *failed_source(const struct dalcs_circuit *c,
                                                      const struct dalcs_measure_card *card,
                                                      const double *results) {
    const struct dalcs_signal_formula *const formula[] = {
        &card->formula,
        &card->from_formula,
        &card->to_formula,
        &card->instant[0].difference,
        &card->instant[0].at_formula,
        &card->instant[0].delay_formula,
        &card->instant[1].difference,
        &card->instant[1].at_formula,
        &card->instant[1].delay_formula,
    };
    const struct dalcs_measure_card *failed = NULL;
    for (size_t k = 0; k < sizeof formula / sizeof formula[0] && failed == NULL; k++) {
        failed = failed_in(c, formula[k], results);
    }
    return failed;
}

/* An orbit has components at multiples of its own frequency alone. One without a clock is known only afterwards. */
static void warn_of_frequency(struct dalcs_run *r, const struct dalcs_measuring *m,
                              const struct dalcs_harmonics *h) {
    const double asked = h->card->frequency;
    char text[2][DALCS_QUANTITY_SIZE];
    if (m->analysis == DALCS_MEASURED_PSS && !r->s->report.steady.self_oscillating &&
        fabs(h->frequency / asked - 1.0) > same_frequency) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, &h->card->where, NULL,
                       "the orbit has no component at %s: these are multiples of %s",
                       dalcs_quantity_write(text[0], asked, "Hz", 9),
                       dalcs_quantity_write(text[1], h->frequency, "Hz", 9));
    }
}

static enum dalcs_status tell_harmonics(struct dalcs_measures *measures, struct dalcs_run *r) {
    const struct dalcs_measuring *m = &measures->measuring;
    size_t n = (size_t)m->n_harmonics;
    const size_t n_before = r->s->report.n_fourier; /* of .pss before a .tran */
    struct dalcs_fourier *fourier = dalcs_arena_alloc(&r->s->arena, n_before + n, sizeof(*fourier));
    for (size_t k = 0; fourier != NULL && k < n_before; k++) {
        fourier[k] = r->s->report.fourier[k];
    }
    r->s->report.fourier = fourier;
    for (size_t k = 0; fourier != NULL && k < n; k++) {
        const struct dalcs_harmonics *h = &m->harmonics[k];
        size_t n_lines = (size_t)h->card->n_harmonics + 1;
        double *magnitude = dalcs_arena_alloc(&r->s->arena, n_lines, sizeof(double));
        double *phase = dalcs_arena_alloc(&r->s->arena, n_lines, sizeof(double));
        if (magnitude == NULL || phase == NULL) {
            return DALCS_E_NOMEM;
        }
        if (h->from < m->start - 1e-9 * m->stop || h->has_no_value) {
            dalcs_diag_add(&r->s->diag, DALCS_WARNING, &h->card->where, NULL,
                           h->has_no_value
                               ? "'%s' is undefined at some of its times: no Fourier analysis"
                               : "'%s': the run is shorter than the periods that are to "
                                 "be analysed",
                           h->card->formula.text);
            continue;
        }
        warn_of_frequency(r, m, h);
        double square = 0.0;
        for (size_t i = 0; i < n_lines; i++) {
            double factor = i == 0 ? 1.0 : 2.0;
            magnitude[i] = i == 0 ? h->cosine[0] : factor * hypot(h->cosine[i], h->sine[i]);
            phase[i] = i == 0 ? 0.0 : 57.295779513082320877 * atan2(h->cosine[i], h->sine[i]);
            square += i >= 2 ? magnitude[i] * magnitude[i] : 0.0;
        }
        const char *text = h->card->formula.text;
        const char *signal = dalcs_arena_copy(&r->s->arena, text, strlen(text));
        if (signal == NULL) {
            return DALCS_E_NOMEM;
        }
        fourier[r->s->report.n_fourier++] =
            (struct dalcs_fourier){.signal = signal,
                                   .frequency = h->frequency,
                                   .from = h->from,
                                   .to = h->to,
                                   .thd = sqrt(square) / magnitude[1],
                                   .n_harmonics = n_lines,
                                   .magnitude = magnitude,
                                   .phase = phase};
        dalcs_audit_fourier_told(&measures->audit, m, (int)k, &fourier[r->s->report.n_fourier - 1]);
    }
    return fourier == NULL ? DALCS_E_NOMEM : DALCS_OK;
}

static enum dalcs_status make_room(struct dalcs_run *r) {
    struct dalcs_report *report = &r->s->report;
    size_t n = (size_t)r->s->circuit.n_measures;
    if (r->measurement == NULL) {
        r->measurement = dalcs_arena_alloc(&r->s->arena, n, sizeof(*r->measurement));
        r->result = dalcs_arena_alloc(&r->s->arena, n, sizeof(*r->result));
        report->measurement = r->measurement;
        for (size_t k = 0; r->result != NULL && k < n; k++) {
            r->result[k] = NAN; /* until its analysis has run */
        }
    }
    return r->measurement == NULL || r->result == NULL ? DALCS_E_NOMEM : DALCS_OK;
}

enum dalcs_status dalcs_measures_report(struct dalcs_measures *measures, struct dalcs_run *r,
                                        enum dalcs_status status) {
    struct dalcs_measuring *m = &measures->measuring;
    const struct dalcs_circuit *c = &r->s->circuit;
    if (!measures->wanted || status == DALCS_E_NOMEM) {
        return DALCS_OK;
    }
    DALCS_TRY(make_room(r));
    DALCS_TRY(dalcs_measuring_close(m));
    for (int k = 0; k < m->n; k++) {
        const struct dalcs_measure_card *card = &c->measure[k];
        struct dalcs_measurement *measurement = &r->measurement[r->s->report.n_measurements];
        struct result result = {
            .s = r->s, .measuring = m, .item = &m->item[k], .measurement = measurement};
        if (card->analysis != m->analysis) {
            continue;
        }
        /* with .step the card goes before the report does */
        const char *name = dalcs_arena_copy(&r->s->arena, card->name, strlen(card->name));
        if (name == NULL) {
            return DALCS_E_NOMEM;
        }
        *measurement = (struct dalcs_measurement){.name = name};
        const struct dalcs_measure_card *source = failed_source(c, card, r->result);
        if (status != DALCS_OK) {
            fail(&result, "the run did not come to its end");
        } else if (source != NULL) {
            fail(&result, "it needs '%s', which could not be measured", source->name);
        } else if (card->is_late && !dalcs_measuring_late(m, k, r->result)) {
            fail(&result, "a time that earlier measurements give has no value");
        } else {
            tell(&result, r->result);
            dalcs_audit_measures_told(&measures->audit, m, k, measurement);
        }
        if (result.out_of_memory) {
            return DALCS_E_NOMEM;
        }
        r->result[k] = measurement->found ? measurement->value : (double)NAN;
        r->s->report.n_measurements++;
        if (!measurement->found && status == DALCS_OK) {
            dalcs_diag_add(&r->s->diag, DALCS_WARNING, &card->where, NULL, "%s: %s", card->name,
                           measurement->failure);
        }
    }
    return status == DALCS_OK ? tell_harmonics(measures, r) : DALCS_OK;
}
