/* audit_measures_checks.c - what a stretch has added to a measurement, computed again. */
#include "audit_measures_asked.h"

#include "audit_reader.h"
#include "claims.h"
#include "pi.h"

#include <float.h>
#include <math.h>

/* Values at which extremes are looked for in a stretch, and those beside the best of them. */
enum { EXTREME_VALUES = 8, EXTREME_ROUNDS = 12 };

/* A formula with jumps has its integral where it is cut at them: what is found between two jumps that no value of the
 * auditor's has seen is no fault. The ends are those of the engine's spans, the values are the auditor's. */
struct by_spans {
    const struct dalcs_audit *audit;
    const struct dalcs_audit_function *f;
    int power;
    struct dalcs_audit_sum sum;
};

static bool add_span(void *user, const struct dalcs_span *span) {
    struct by_spans *b = user;
    const struct dalcs_audit_sum part =
        dalcs_audit_integral(b->audit, b->f, b->power, span->from, span->to);
    b->sum.value += part.value;
    b->sum.doubt += part.doubt;
    return isfinite(part.doubt);
}

/* rounding: what it makes of the claim. */
static void check_integral(const struct audit_asked *q, const struct dalcs_audit_function *f,
                           const struct dalcs_audit_number *number,
                           const struct dalcs_audit_claim *claim, double rounding) {
    struct dalcs_audit *audit = q->a->run->audit;
    const double from = claim->from, to = claim->to;
    const double unit = number->scale * (claim->power == 1 ? 1.0 : number->scale);
    const double allowed = dalcs_audit_most_allowed(q->a->run) * unit * (to - from);
    struct dalcs_audit_sum own = dalcs_audit_integral(audit, f, claim->power, from, to);
    if (!q->formula->is_affine && fabs(claim->value - own.value) > 1e-3 * allowed) {
        struct by_spans b = {audit, f, claim->power, {0.0, 0.0}};
        double scale = q->scale;
        dalcs_stretch_visit(&q->m->stretch, q->formula, from, to, &scale, &b, add_span);
        own = b.sum;
    }
    own.doubt += rounding;
    dalcs_audit_claim_integral(audit, number, claim, &own);
}

static void check_sum(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k,
                      double from, double to) {
    const struct dalcs_measured *item = &m->item[k];
    const bool is_square = item->card->kind == DALCS_MEASURE_RMS;
    const double now = is_square ? item->square : item->integral;
    const double then = is_square ? a->before[k].square : a->before[k].integral;
    struct audit_asked q =
        audit_measures_ask(a, m, &item->card->formula, a->item[k].reads, item->scale);
    const struct dalcs_audit_function f = {&q, audit_asked_value};
    const struct dalcs_audit_number number = audit_measures_number(k, item->scale);
    const struct dalcs_audit_claim claim = {is_square ? 2 : 1, from, to, now - then};
    check_integral(&q, &f, &number, &claim, 4.0 * DBL_EPSILON * (fabs(now) + fabs(then)));
}

/* The largest of sign times the function between two times, and where: the best of some, closed in on. */
static double find_extreme(struct dalcs_audit_measures *a, const struct dalcs_audit_function *f,
                           double sign, double from, double to, double *at) {
    const double apart = (to - from) / EXTREME_VALUES;
    const double first = from + dalcs_audit_run_chance(a->run) * apart;
    double most = -INFINITY;
    for (int k = 0; k < EXTREME_VALUES; k++) {
        const double t = fmin(first + k * apart, to);
        const double value = sign * f->value(f->user, t, NULL);
        *at = value > most ? t : *at;
        most = value > most ? value : most;
    }
    double room = apart;
    for (int k = 0; k < EXTREME_ROUNDS; k++) {
        room *= 0.5;
        for (int side = -1; side <= 1; side += 2) {
            const double t = fmin(fmax(*at + side * room, from), to);
            const double value = sign * f->value(f->user, t, NULL);
            *at = value > most ? t : *at;
            most = value > most ? value : most;
        }
    }
    return most;
}

static void check_extreme(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k,
                          double sign, double from, double to) {
    const struct dalcs_measured *item = &m->item[k];
    struct audit_asked q =
        audit_measures_ask(a, m, &item->card->formula, a->item[k].reads, item->scale);
    const struct dalcs_audit_function f = {&q, audit_asked_value};
    const struct dalcs_audit_number number = audit_measures_number(k, item->scale);
    const double claimed = sign > 0.0 ? item->most : item->least;
    const double at = sign > 0.0 ? item->most_at : item->least_at;
    const double then = sign > 0.0 ? a->before[k].most : a->before[k].least;
    double own_at = from, doubt;
    const double own = find_extreme(a, &f, sign, from, to, &own_at);
    f.value(f.user, own_at, &doubt);
    dalcs_audit_off(a->run->audit, &number, own - sign * claimed - doubt, own_at);
    if (claimed != then && at >= from && at <= to) {
        dalcs_audit_claim_value(a->run->audit, &number, &f, at, claimed);
    }
}

void audit_measures_check_item(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                               int k) {
    const struct dalcs_measured *item = &m->item[k];
    const enum dalcs_measure_kind kind = item->card->kind;
    double from, to;
    if (!audit_measures_find_window(m, item, &from, &to) || dalcs_measuring_adds_sides(m, item)) {
        return; /* of a slide the auditor knows means of signals alone */
    }
    a->item[k].was_looked = true;
    if (kind <= DALCS_MEASURE_INTEGRAL) {
        check_sum(a, m, k, from, to);
        return;
    }
    if (kind != DALCS_MEASURE_MIN && kind != DALCS_MEASURE_MIN_AT) {
        check_extreme(a, m, k, 1.0, from, to);
    }
    if (kind != DALCS_MEASURE_MAX && kind != DALCS_MEASURE_MAX_AT) {
        check_extreme(a, m, k, -1.0, from, to);
    }
}

/* FIND and DERIV, where they were taken. */
static void check_value(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k,
                        double t) {
    const struct dalcs_measured *item = &m->item[k];
    const struct dalcs_stretch *s = &m->stretch;
    const double near = 4.0 * a->run->radau->resolution;
    double scale = fmax(item->scale, fabs(item->value));
    struct audit_asked q = audit_measures_ask(a, m, &item->card->formula, a->item[k].reads, scale);
    const struct dalcs_audit_function f = {&q, audit_asked_value};
    if (t < s->from - near || t > s->to + near) {
        return;
    }
    if (item->card->kind == DALCS_MEASURE_FIND) {
        const struct dalcs_audit_number number = audit_measures_number(k, scale);
        dalcs_audit_claim_value(a->run->audit, &number, &f, t, item->value);
    } else {
        scale = fmax(item->scale, fabs(item->value) * (s->to - s->from));
        const struct dalcs_audit_number number = audit_measures_number(k, scale);
        dalcs_audit_claim_slope(a->run->audit, &number, &f, fmin(fmax(t, s->from), s->to), s->from,
                                s->to, item->value);
    }
}

void audit_measures_check_instants(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                                   int k) {
    const struct dalcs_measured *item = &m->item[k];
    const struct dalcs_stretch *s = &m->stretch;
    for (int i = 0; i < 2; i++) {
        const struct dalcs_instant *instant = &item->instant[i];
        double *told = &a->item[k].told[i];
        const bool is_new = instant->found && instant->time != *told;
        const bool looks = audit_measures_is_full(a) || *told < 0.0 || k == a->drawn;
        if (!is_new || item->waits) {
            continue;
        }
        *told = instant->time;
        if (instant->card->kind == DALCS_INSTANT_CROSSING && looks && instant->time >= s->from &&
            instant->time <= s->to) {
            const struct dalcs_signal_formula *formula = &instant->card->difference;
            struct audit_asked q = audit_measures_ask(
                a, m, formula, audit_measures_reads_all(a->run, formula), instant->scale);
            const struct dalcs_audit_function f = {&q, audit_asked_value};
            const struct dalcs_audit_number number = audit_measures_number(k, instant->scale);
            const enum dalcs_measure_edge edge = instant->card->edge;
            dalcs_audit_claim_crossing(a->run->audit, &number, &f, instant->time, s->from, s->to,
                                       edge == DALCS_EDGE_RISE   ? 1
                                       : edge == DALCS_EDGE_FALL ? -1
                                                                 : 0);
        }
        if (i == 0 && looks && item->has_value) {
            check_value(a, m, k, instant->time);
        }
    }
}

/* A level that was passed from one asked time to the next, by more than is promised, has been counted in between. */
static void ask_level(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k, int i,
                      double t) {
    const struct dalcs_instant *instant = &m->item[k].instant[i];
    struct audit_item *own = &a->item[k];
    if (instant->card->kind != DALCS_INSTANT_CROSSING || instant->has_no_value ||
        (instant->found && instant->card->count > 0) || !(t >= instant->delay)) {
        return;
    }
    const double value = dalcs_stretch_value(&m->stretch, &instant->card->difference, t);
    const double clear = dalcs_audit_most_allowed(a->run) * instant->scale;
    const int side = value > clear ? 1 : value < -clear ? -1 : 0;
    const enum dalcs_measure_edge way = side > 0 ? DALCS_EDGE_RISE : DALCS_EDGE_FALL;
    const bool counts = instant->card->edge == DALCS_EDGE_ANY || instant->card->edge == way;
    if (side != 0 && own->side[i] == -side && counts && instant->n == own->n_then[i]) {
        const struct dalcs_audit_number number = audit_measures_number(k, instant->scale);
        dalcs_audit_off(a->run->audit, &number, fabs(value), t);
    }
    if (side != 0) {
        own->side[i] = side;
        own->n_then[i] = own->n_now[i];
    }
}

void audit_measures_ask_once(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                             int k) {
    const struct dalcs_measured *item = &m->item[k];
    const struct dalcs_stretch *s = &m->stretch;
    const double t = s->from + dalcs_audit_run_chance(a->run) * (s->to - s->from);
    if (!audit_measures_is_of(m, item) || item->has_no_value || t < fmax(m->start, item->from) ||
        t > fmin(m->stop, item->to)) {
        return;
    }
    for (int i = 0; i < 2; i++) {
        ask_level(a, m, k, i, t);
    }
    double from, to;
    if (item->card->kind > DALCS_MEASURE_INTEGRAL && item->card->kind <= DALCS_MEASURE_MAX_AT &&
        !dalcs_measuring_adds_sides(m, item) && audit_measures_find_window(m, item, &from, &to) &&
        t >= from && t <= to) {
        const double value = dalcs_stretch_value(s, &item->card->formula, t);
        const struct dalcs_audit_number number = audit_measures_number(k, item->scale);
        const enum dalcs_measure_kind kind = item->card->kind;
        const double above =
            kind == DALCS_MEASURE_MIN || kind == DALCS_MEASURE_MIN_AT ? 0.0 : value - item->most;
        const double below =
            kind == DALCS_MEASURE_MAX || kind == DALCS_MEASURE_MAX_AT ? 0.0 : item->least - value;
        /* of a sum whose terms are of the size of the scale */
        dalcs_audit_off(a->run->audit, &number,
                        fmax(above, below) - 16.0 * DALCS_STRETCH_NODES * DBL_EPSILON * item->scale,
                        t);
    }
}

void audit_measures_check_line(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                               int k) {
    const struct dalcs_harmonics *h = &m->harmonics[k];
    const struct dalcs_stretch *s = &m->stretch;
    struct audit_line *own = &a->line[k];
    const double from = fmax(h->from, s->from);
    const double to = fmin(h->to, s->to);
    const bool is_of_sides = m->sides != NULL && dalcs_side_means_slides(m->sides, h->mean);
    if (h->has_no_value || !(from < to) || is_of_sides) {
        return;
    }
    own->was_looked = true;
    const double period = h->to - h->from;
    const struct dalcs_audit_number number = {DALCS_AUDIT_FOURIER, k, h->scale};
    for (int sine = 0; sine < 2; sine++) {
        struct audit_asked q = audit_measures_ask(a, m, &h->card->formula, own->reads, h->scale);
        q.omega = dalcs_two_pi * h->frequency * own->line;
        q.since = h->from;
        q.is_sine = sine != 0;
        if (own->line == 0 && sine != 0) {
            continue;
        }
        const struct dalcs_audit_function f = {&q, audit_asked_value};
        const double now = sine != 0 ? h->sine[own->line] : h->cosine[own->line];
        const double then = sine != 0 ? own->sine : own->cosine;
        /* an angle is known to a rounding of its turns */
        const double turns =
            DBL_EPSILON * dalcs_two_pi * h->frequency * own->line * h->to * h->scale;
        const struct dalcs_audit_claim claim = {1, from, to, (now - then) * period};
        const double rounding = 4.0 * DBL_EPSILON * (fabs(now) + fabs(then)) * period;
        check_integral(&q, &f, &number, &claim, rounding + 8.0 * turns * (to - from));
    }
}
