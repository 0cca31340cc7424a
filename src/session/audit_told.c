/* audit_told.c - what is told of .meas, .four and .losses at the end, against what it says of what was added up.
 *
 * Each kind of result is a statement about sums, extremes and instants that audit_measures.c has followed: a mean times its
 * window is the integral, a series has its sums as coefficients. Windows are those of the cards, worked out once more. */
#include "audit_measures.h"

#include "audit_reader.h"
#include "claims.h"
#include "pi.h"
#include "rounding.h"

struct told {
    struct dalcs_audit_measures *a;
    const struct dalcs_measuring *m;
    const struct dalcs_measured *item;
    const struct dalcs_measurement *measurement;
    int k;
    double scale; /* of the formula */
};

/* So far off in the unit of the formula. */
static void off(const struct told *q, double by) {
    const struct dalcs_audit_number number = {DALCS_AUDIT_MEASURE, q->k, q->scale};
    const double allowed = dalcs_sum_rounded * fmax(q->scale, fabs(q->measurement->value));
    dalcs_audit_off(q->a->run->audit, &number, fabs(by) - allowed, q->m->stop);
}

/* A time that is told is another one: over the run, as a part of the scale. */
static void off_in_time(const struct told *q, double told, double is) {
    const double near = 4.0 * q->a->run->radau->resolution + dalcs_sum_rounded * fabs(is);
    const double by = fabs(told - is) > near ? fabs(told - is) / (q->m->stop - q->m->start) : 0.0;
    const struct dalcs_audit_number number = {DALCS_AUDIT_MEASURE, q->k, fmax(q->scale, 1.0)};
    dalcs_audit_off(q->a->run->audit, &number, by * number.scale, q->m->stop);
}

static double detail(const struct told *q, const char *name) {
    const struct dalcs_measurement *m = q->measurement;
    double value = NAN;
    for (int i = 0; i < m->n_details; i++) {
        value = strcmp(m->detail[i].name, name) == 0 ? m->detail[i].value : value;
    }
    return value;
}

/* The window as the card has it; what has results of others in it they have given. */
static void window_of(const struct told *q, double *from, double *to) {
    const struct dalcs_measure_card *card = q->item->card;
    const struct dalcs_instant *i = q->item->instant;
    *from = fmax(q->m->start, card->from_formula.n > 0 ? q->item->from : card->from);
    *to = fmin(q->m->stop, card->to_formula.n > 0 ? q->item->to : card->to);
    if (i[0].card->kind != DALCS_INSTANT_NONE) {
        *from = fmax(*from, i[0].time);
        *to = fmin(*to, i[1].time);
    }
}

static void check_sum(const struct told *q) {
    const struct dalcs_measured *item = q->item;
    const double value = q->measurement->value;
    double from, to;
    window_of(q, &from, &to);
    off_in_time(q, detail(q, "from"), from);
    off_in_time(q, detail(q, "to"), to);
    switch (item->card->kind) {
    case DALCS_MEASURE_AVERAGE:
        off(q, value - (item->integral + item->impulses.sum) / (to - from));
        break;
    case DALCS_MEASURE_RMS:
        off(q, value < 0.0 ? value : value - sqrt(item->square / (to - from)));
        break;
    case DALCS_MEASURE_INTEGRAL:
        off(q, (value - item->integral - item->impulses.sum) / (to - from));
        break;
    default:
        off(q, value - (item->most - item->least));
        break;
    }
}

static void check_extreme(const struct told *q) {
    const struct dalcs_measured *item = q->item;
    const enum dalcs_measure_kind kind = item->card->kind;
    const bool is_most = kind == DALCS_MEASURE_MAX || kind == DALCS_MEASURE_MAX_AT;
    const bool is_time = kind == DALCS_MEASURE_MIN_AT || kind == DALCS_MEASURE_MAX_AT;
    const double value = q->measurement->value;
    off(q, (is_time ? detail(q, "with") : value) - (is_most ? item->most : item->least));
    off_in_time(q, is_time ? value : detail(q, "at"), is_most ? item->most_at : item->least_at);
}

/* What was told of the card that has this name; no number: nothing was, or two cards have it. */
static double told_of(const struct dalcs_run *r, const char *name) {
    double value = NAN;
    int n = 0;
    for (size_t k = 0; k < r->s->results.report.n_measurements; k++) {
        const struct dalcs_measurement *m = &r->measures.reported[k];
        if (strcmp(m->name, name) == 0) {
            value = m->found ? m->value : (double)NAN;
            n++;
        }
    }
    return n == 1 ? value : (double)NAN;
}

/* A formula of earlier results, of those that were told. */
static void check_formula(const struct told *q) {
    const struct dalcs_run *r = q->a->run->run;
    const struct dalcs_circuit *c = &r->s->circuit;
    const struct dalcs_signal_formula *formula = &q->item->card->formula;
    double *result =
        dalcs_arena_alloc(&q->a->run->arena, (size_t)c->results.n_measures + 1, sizeof(*result));
    bool is_known = result != NULL;
    for (int k = 0; k < formula->n && is_known; k++) {
        const struct dalcs_signal_formula_step *step = &formula->step[k];
        if (step->push == DALCS_PUT_RESULT) {
            result[step->index] = told_of(r, c->results.measure[step->index].name);
            is_known = !isnan(result[step->index]);
        }
    }
    if (is_known) {
        const struct dalcs_signal_formula_point at = {.result = result};
        off(q, q->measurement->value - dalcs_signal_formula_value(formula, &at));
    }
}

static void check(const struct told *q) {
    const struct dalcs_instant *i = q->item->instant;
    const double value = q->measurement->value;
    switch (q->item->card->kind) {
    case DALCS_MEASURE_PARAM:
        check_formula(q);
        return;
    case DALCS_MEASURE_WHEN:
        off_in_time(q, value, i[0].time);
        return;
    case DALCS_MEASURE_DELAY:
        off_in_time(q, value + i[0].time, i[1].time);
        off_in_time(q, detail(q, "trig"), i[0].time);
        off_in_time(q, detail(q, "targ"), i[1].time);
        return;
    case DALCS_MEASURE_FIND:
    case DALCS_MEASURE_DERIVATIVE:
        off(q, value - q->item->value);
        return;
    case DALCS_MEASURE_MIN:
    case DALCS_MEASURE_MAX:
    case DALCS_MEASURE_MIN_AT:
    case DALCS_MEASURE_MAX_AT:
        check_extreme(q);
        return;
    default:
        check_sum(q);
        return;
    }
}

void dalcs_audit_measures_told(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                               int k, const struct dalcs_measurement *told) {
    const struct dalcs_measured *item = &m->item[k];
    if (a->run != NULL && told->found && m->analysis != DALCS_MEASURED_OP) {
        const double scale = fmax(
            item->scale, item->card->kind == DALCS_MEASURE_DERIVATIVE ? fabs(item->value) : 0.0);
        check(&(struct told){a, m, item, told, k, scale});
    }
}

/* A series of cosines and sines, put together again from what is told. */
void dalcs_audit_fourier_told(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                              int k, const struct dalcs_fourier *told) {
    const double radians = dalcs_pi / 180.0;
    if (a->run == NULL) {
        return;
    }
    const struct dalcs_harmonics *h = &m->harmonics[k];
    const struct dalcs_audit_number number = {DALCS_AUDIT_FOURIER, k, h->scale};
    double above = 0.0;
    double worst = fabs(told->magnitude[0] - h->cosine[0]);
    for (size_t i = 1; i < told->n_harmonics; i++) {
        const double c = told->magnitude[i] * sin(radians * told->phase[i]);
        const double s = told->magnitude[i] * cos(radians * told->phase[i]);
        worst = fmax(worst, hypot(c - 2.0 * h->cosine[i], s - 2.0 * h->sine[i]));
        above = i >= 2 ? hypot(above, told->magnitude[i]) : above;
    }
    const double distortion = isfinite(told->thd) ? told->thd * told->magnitude[1] - above : 0.0;
    const double window =
        fabs((told->to - told->from) * told->frequency - h->card->n_periods) / h->card->n_periods;
    const double by = m->analysis == DALCS_MEASURED_TRAN ? window * h->scale : 0.0;
    dalcs_audit_off(a->run->audit, &number,
                    fmax(fmax(worst, fabs(distortion)), by) -
                        dalcs_sum_rounded * (double)told->n_harmonics * h->scale,
                    told->to);
}
