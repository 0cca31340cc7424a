/* instant.c - zeros of a formula, span by span, and on which side it was before. */
#include "instant.h"

#include <float.h>
#include <math.h>

/* Nearer to the level, over the largest value of either side, is on it; farther is clearly off it. */
static const double on_level = 4e-15, off_level = 1e-12;

/* A span that moves less than this, over that, is a constant. */
static const double flat = 1e-13;

enum { MOST_CUTS = 60, MOST_ROUNDS = 80 };

struct look {
    struct dalcs_instant *instant;
    const struct dalcs_stretch *stretch;
    bool is_new;
};

static bool is_over(const struct dalcs_instant *i) {
    return i->found && i->card->count > 0;
}

static void count(struct look *l, enum dalcs_measure_edge edge, double time) {
    struct dalcs_instant *i = l->instant;
    i->side = 0;
    if (is_over(i) || (i->card->edge != DALCS_EDGE_ANY && i->card->edge != edge)) {
        return;
    }
    i->n++;
    if (i->card->count == 0 || i->n == i->card->count) {
        i->found = true;
        i->time = time;
        l->is_new = true;
    }
}

/* Which way is it through the level, with this value? */
static enum dalcs_measure_edge passes(const struct dalcs_instant *i, double value) {
    double reach = on_level * i->scale;
    if (i->side < 0 && value >= -reach) {
        return DALCS_EDGE_RISE;
    }
    return i->side > 0 && value <= reach ? DALCS_EDGE_FALL : DALCS_EDGE_ANY;
}

static void take_side(struct dalcs_instant *i, double value) {
    if (fabs(value) > off_level * i->scale) {
        i->side = value < 0.0 ? -1 : 1;
    }
}

/* The zero of a span that goes one way, between values of different signs: secants that keep the
 * bracket (Illinois). */
static double zero_of(const struct dalcs_span *span, double at_a, double at_b) {
    double a = -1.0;
    double b = 1.0;
    double moved = 2.0;
    int side = 0;
    for (int round = 0; round < MOST_ROUNDS && moved > DBL_EPSILON; round++) {
        double x = a + (b - a) * (at_a / (at_a - at_b));
        if (!(x > a && x < b)) {
            return x <= a ? a : b;
        }
        double at_x = dalcs_stretch_at(span->coefficient, x);
        if (at_x == 0.0) {
            return x;
        }
        if ((at_x < 0.0) == (at_b < 0.0)) {
            moved = b - x;
            b = x;
            at_b = at_x;
            at_a *= side < 0 ? 0.5 : 1.0;
            side = -1;
        } else {
            moved = x - a;
            a = x;
            at_a = at_x;
            at_b *= side > 0 ? 0.5 : 1.0;
            side = 1;
        }
    }
    return side < 0 ? b : a;
}

/* A span that goes one way. */
static void pass(struct look *l, const struct dalcs_span *span) {
    struct dalcs_instant *i = l->instant;
    double first = dalcs_stretch_at(span->coefficient, -1.0);
    double last = dalcs_stretch_at(span->coefficient, 1.0);
    enum dalcs_measure_edge edge = passes(i, first);
    if (edge != DALCS_EDGE_ANY) {
        count(l, edge, span->from);
    }
    take_side(i, first);
    edge = passes(i, last);
    if (edge != DALCS_EDGE_ANY) {
        bool changes = (first < 0.0 && last > 0.0) || (first > 0.0 && last < 0.0);
        double x = changes ? zero_of(span, first, last) : 1.0;
        count(l, edge, x < 1.0 ? span->from + 0.5 * (1.0 + x) * (span->to - span->from) : span->to);
    }
    take_side(i, last);
}

static void walk(struct look *l, const struct dalcs_span *span, int depth) {
    struct dalcs_instant *i = l->instant;
    double middle = span->coefficient[0];
    double spread = dalcs_stretch_spread(span->coefficient);
    if (is_over(i)) {
        return;
    }
    if (fabs(middle) - spread > off_level * i->scale) {
        enum dalcs_measure_edge edge = passes(i, middle);
        if (edge != DALCS_EDGE_ANY) {
            count(l, edge, span->from);
        }
        take_side(i, middle);
        return;
    }
    double slope[DALCS_STRETCH_NODES];
    dalcs_stretch_derive(span->coefficient, slope);
    bool one_way = fabs(slope[0]) >= dalcs_stretch_spread(slope) ||
                   spread <= flat * i->scale; /* the direction is rounding */
    double least = 8.0 * DBL_EPSILON * fmax(fabs(span->from), fabs(span->to));
    if (one_way || depth == MOST_CUTS || span->to - span->from <= least) {
        pass(l, span);
        return;
    }
    struct dalcs_span half;
    dalcs_span_cut(l->stretch->rule, span, -1.0, 0.0, &half);
    walk(l, &half, depth + 1);
    dalcs_span_cut(l->stretch->rule, span, 0.0, 1.0, &half);
    walk(l, &half, depth + 1);
}

static bool look_at_span(void *user, const struct dalcs_span *span) {
    struct look *l = user;
    walk(l, span, 0);
    return !is_over(l->instant);
}

static bool look_for_time(struct dalcs_instant *i, double from, double to) {
    if (i->found || !(i->at >= from && i->at <= to)) {
        return false;
    }
    i->found = true;
    i->time = i->at;
    return true;
}

struct dalcs_instant dalcs_instant_start(const struct dalcs_measure_instant *card) {
    return (struct dalcs_instant){.card = card, .at = card->at, .delay = card->delay};
}

void dalcs_instant_look_before(struct dalcs_instant *instant, const struct dalcs_stretch *stretch) {
    const struct dalcs_measure_instant *card = instant->card;
    const double at = stretch->from;
    if (card->kind == DALCS_INSTANT_AT || card->kind == DALCS_INSTANT_NONE || instant->delay > at) {
        return;
    }
    double value = dalcs_stretch_value(stretch, &card->difference, at);
    if (!isnan(value)) {
        instant->scale = fmax(fabs(dalcs_stretch_value(stretch, &card->left, at)), fabs(value));
        take_side(instant, value);
    }
}

bool dalcs_instant_look(struct dalcs_instant *instant, const struct dalcs_stretch *stretch,
                        double from, double to) {
    const struct dalcs_measure_instant *card = instant->card;
    if (card->kind == DALCS_INSTANT_AT) {
        return look_for_time(instant, from, to);
    }
    from = fmax(from, instant->delay);
    if (card->kind == DALCS_INSTANT_NONE || is_over(instant) || !(from < to) ||
        instant->has_no_value) {
        return false;
    }
    struct look l = {.instant = instant, .stretch = stretch};
    instant->scale = fmax(instant->scale, fabs(dalcs_stretch_value(stretch, &card->left, from)));
    instant->scale = fmax(instant->scale, fabs(dalcs_stretch_value(stretch, &card->left, to)));
    bool has_value = dalcs_stretch_visit(stretch, &card->difference, from, to, &instant->scale, &l,
                                         look_at_span);
    instant->has_no_value = !has_value;
    return l.is_new;
}
