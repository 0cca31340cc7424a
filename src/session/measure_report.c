/* measure_report.c - what was measured, into the report; what could not be, in words. */
#include "measures.h"

#include "quantity.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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

/* Is there a time to measure over? */
static bool check_window(struct result *r) {
    const struct dalcs_measured *item = r->item;
    const struct dalcs_instant *trig = &item->instant[0];
    const struct dalcs_instant *targ = &item->instant[1];
    char a[DALCS_QUANTITY_SIZE];
    char b[DALCS_QUANTITY_SIZE];
    if (trig->card->kind != DALCS_INSTANT_NONE) {
        if (!check_instant(r, trig) || !check_instant(r, targ)) {
            return false;
        }
        if (!(targ->time > trig->time)) {
            fail(r, "TARG at %s does not come after TRIG at %s", moment(r, a, targ->time),
                 moment(r, b, trig->time));
            return false;
        }
    }
    if (!(item->from < item->to)) {
        fail(r, "FROM=%s does not come before TO=%s", moment(r, a, item->from),
             moment(r, b, item->to));
        return false;
    }
    if (!(item->end - item->begin > 0.0)) {
        fail(r, "there is nothing to measure: the run goes from %s to %s",
             moment(r, a, r->measuring->start), moment(r, b, r->measuring->stop));
        return false;
    }
    return true;
}

/* An impulse has an area, but no height. */
static bool check_impulses(struct result *r) {
    const struct dalcs_measured *item = r->item;
    const char *text = item->card->formula.text;
    char at[DALCS_QUANTITY_SIZE];
    if (item->impulses.n == 0) {
        return true;
    }
    moment(r, at, item->impulses.first);
    if (item->card->kind == DALCS_MEASURE_RMS) {
        fail(r, "'%s' has an impulse at %s: the square of an impulse has no integral", text, at);
    } else if (item->card->kind > DALCS_MEASURE_INTEGRAL) {
        dalcs_diag_add(&r->s->diag, DALCS_WARNING, &item->card->where, NULL,
                       "%s: '%s' has an impulse at %s, which has no height: this is its extreme "
                       "beside impulses",
                       item->card->name, text, at);
    } else if (isnan(item->impulses.sum)) {
        fail(r, "'%s' has an impulse at %s, whose area %s", text, at,
             r->measuring->is_euler ? "implicit Euler spreads over its steps; method=auto counts it"
                                    : "the circuit or the formula does not tell");
    }
    return r->measurement->failure == NULL;
}

/* Sums and extremes. */
static void tell_statistic(struct result *r) {
    const struct dalcs_measured *item = r->item;
    const double length = item->end - item->begin;
    if (item->has_value) { /* of one point */
        tell_point(r);
        return;
    }
    if (!check_window(r)) {
        return;
    }
    if (!check_impulses(r)) {
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
        give(r, (item->integral + item->impulses.sum) / length);
        break;
    case DALCS_MEASURE_RMS:
        give(r, sqrt(item->square / length));
        break;
    case DALCS_MEASURE_PEAK_TO_PEAK:
        give(r, item->most - item->least);
        break;
    default:
        give(r, item->integral + item->impulses.sum);
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
    if (item->is_means) {
        fail(r,
             "a switch slides along its threshold meanwhile, where signals are means over its "
             "positions, and this is not linear in them%s",
             card->is_late ? "; without the result of another measurement it can be measured" : "");
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

static enum dalcs_status make_room(struct dalcs_run *r) {
    struct dalcs_report *report = &r->s->results.report;
    size_t n = (size_t)r->s->circuit.results.n_measures;
    if (r->measures.reported == NULL) {
        r->measures.reported = dalcs_arena_alloc(&r->s->arena, n, sizeof(*r->measures.reported));
        r->measures.result = dalcs_arena_alloc(&r->s->arena, n, sizeof(*r->measures.result));
        report->measurement = r->measures.reported;
        for (size_t k = 0; r->measures.result != NULL && k < n; k++) {
            r->measures.result[k] = NAN; /* until its analysis has run */
        }
    }
    return r->measures.reported == NULL || r->measures.result == NULL ? DALCS_E_NOMEM : DALCS_OK;
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
        const struct dalcs_measure_card *card = &c->results.measure[k];
        struct dalcs_measurement *measurement =
            &r->measures.reported[r->s->results.report.n_measurements];
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
        const struct dalcs_measure_card *source =
            dalcs_measures_failed_source(c, card, r->measures.result);
        if (status != DALCS_OK) {
            fail(&result, "the run did not come to its end");
        } else if (source != NULL) {
            fail(&result, "it needs '%s', which could not be measured", source->name);
        } else if (card->mistake != NULL) {
            fail(&result, "%s", card->mistake);
        } else if (card->is_late && !dalcs_measuring_late(m, k, r->measures.result)) {
            fail(&result, "a time that earlier measurements give has no value");
        } else {
            tell(&result, r->measures.result);
            dalcs_audit_measures_told(&measures->audit, m, k, measurement);
        }
        if (result.out_of_memory) {
            return DALCS_E_NOMEM;
        }
        r->measures.result[k] = measurement->found ? measurement->value : (double)NAN;
        r->s->results.report.n_measurements++;
        if (!measurement->found && status == DALCS_OK && card->mistake == NULL) {
            dalcs_diag_add(&r->s->diag, DALCS_WARNING, &card->where, NULL, "%s: %s", card->name,
                           measurement->failure);
        }
    }
    return status == DALCS_OK ? dalcs_measures_tell_harmonics(measures, r) : DALCS_OK;
}
