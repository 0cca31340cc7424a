/* measuring_sums.c - what a stretch adds to sums and extremes of a measurement. */
#include "measuring_sums.h"

#include "measuring_extremes.h"
#include "side_span.h"

#include <math.h>

enum { N = DALCS_STRETCH_NODES };

struct addition {
    struct dalcs_measured *item;
    const struct dalcs_stretch_rule *rule;
};

static bool add_span(void *user, const struct dalcs_span *span) {
    const struct addition *a = user;
    struct dalcs_measured *item = a->item;
    enum dalcs_measure_kind kind = item->card->kind;
    double length = span->to - span->from;
    if (kind <= DALCS_MEASURE_INTEGRAL) {
        double square = 0.0;
        for (int i = 0; i < N; i++) {
            square += a->rule->weight[i] * span->value[i] * span->value[i];
        }
        item->integral += length * span->coefficient[0];
        item->square += length * square;
        return true;
    }
    if (kind != DALCS_MEASURE_MIN && kind != DALCS_MEASURE_MIN_AT) {
        dalcs_climb(&(struct dalcs_climb){a->rule, 1.0, item->scale, &item->most, &item->most_at},
                    span);
    }
    if (kind != DALCS_MEASURE_MAX && kind != DALCS_MEASURE_MAX_AT) {
        dalcs_climb(
            &(struct dalcs_climb){a->rule, -1.0, item->scale, &item->least, &item->least_at}, span);
    }
    return true;
}

/* Of a slide: means over its sides, where the waveform has means of signals alone. */
static void add_sides(const struct dalcs_measuring *m, struct dalcs_measured *item, double from,
                      double to) {
    struct dalcs_span span;
    dalcs_side_means_span(m->sides, item->mean, &m->rule, from, to, &span);
    item->has_no_value = isnan(span.coefficient[0]);
    if (item->card->kind == DALCS_MEASURE_RMS) {
        item->square += span.coefficient[0] * (to - from);
    } else {
        item->scale = fmax(item->scale, fabs(span.coefficient[0]));
        add_span(&(struct addition){item, &m->rule}, &span);
    }
}

/* Those at the start of the stretch, of a window [from, to): windows side by side add up. */
static void add_impulses(const struct dalcs_measuring *m, struct dalcs_measured *item, double from,
                         double to) {
    const double at = m->stretch.from;
    struct dalcs_measured_impulses *impulses = &item->impulses;
    if (m->stretch.impulse == NULL || at < from - m->near || at >= to - m->near) {
        return;
    }
    const double area = dalcs_stretch_impulse(&m->stretch, &item->card->formula);
    if (area != 0.0) {
        impulses->first = impulses->n == 0 ? at : impulses->first;
        impulses->n++;
        impulses->sum += area;
    }
}

void dalcs_measuring_add(const struct dalcs_measuring *m, struct dalcs_measured *item) {
    const struct dalcs_instant *trig = &item->instant[0];
    const struct dalcs_instant *targ = &item->instant[1];
    double from = fmax(m->start, item->from);
    double to = fmin(m->stop, item->to);
    if (trig->card->kind != DALCS_INSTANT_NONE) {
        from = trig->found ? fmax(from, trig->time) : INFINITY;
        to = targ->found ? fmin(to, targ->time) : to;
    }
    add_impulses(m, item, from, to);
    from = fmax(m->stretch.from, from);
    to = fmin(m->stretch.to, to);
    if (from < to) {
        item->begin = fmin(item->begin, from);
        item->end = to;
        if (dalcs_measuring_adds_sides(m, item)) {
            add_sides(m, item, from, to);
            return;
        }
        struct addition a = {item, &m->rule};
        item->has_no_value = !dalcs_stretch_visit(&m->stretch, &item->card->formula, from, to,
                                                  &item->scale, &a, add_span);
    }
}
