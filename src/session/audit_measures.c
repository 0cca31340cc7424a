/* audit_measures.c - what a stretch adds to .meas and .four, checked at times of the auditor's own.
 *
 * Of each stretch one measurement is asked at one time: no value is beyond the extreme that is known, and a level that has
 * been passed has been counted. That costs a value of a formula. What a stretch adds is checked from the waveform where a
 * measurement begins, where its window begins or ends, and where the budget or --audit full says so. */
#include "audit_measures.h"

#include "audit_reader.h"
#include "pi.h"
#include "results.h"

#include <float.h>
#include <stdlib.h>

/* Instructions, about: of a stretch and a measurement, of its signals; of a value of a formula from a state, from the
 * stretch. */
static const double item_work = 800.0, signal_work = 500.0, state_work = 2500.0,
                    stretch_work = 300.0;

/* The share of that which checks may cost. */
static const double share = 0.03;

/* Stretches in which each measurement is asked at one time; later one of them is, which is drawn. */
enum { FIRST_STRETCHES = 256 };

/* Values at which extremes are looked for in a stretch, and those beside the best of them. */
enum { EXTREME_VALUES = 8, EXTREME_ROUNDS = 12 };

/* ---- Formulas ------------------------------------------------------------------------------------ */

struct asked {
    struct dalcs_audit_measures *a;
    const struct dalcs_measuring *m;
    const struct dalcs_signal_formula *formula;
    bool reads;   /* from states, else from the stretch */
    double scale; /* of the formula */
    /* times this, of .four: a cosine or a sine from `since` on */
    double omega, since;
    bool is_sine;
};

/* What the rounding of a time makes of a value: two ways to it have the time of a node to one rounding only, and in a
 * stretch of a few roundings that is all of it. */
static double doubt_of_time(const struct asked *q, double at, double value) {
    const struct dalcs_stretch *s = &q->m->stretch;
    const double off = DBL_EPSILON * fabs(at);
    const double before = fabs(dalcs_stretch_value_near(s, q->formula, at, -off) - value);
    const double after = fabs(dalcs_stretch_value_near(s, q->formula, at, off) - value);
    return fmax(before, after); /* of a side that has no value the other one */
}

static double value_of(void *user, double t, double *doubt) {
    const struct asked *q = user;
    const struct dalcs_stretch *s = &q->m->stretch;
    const double at = fmin(fmax(t, s->from), s->to);
    double value;
    if (q->reads) {
        value = dalcs_audit_formula(q->a->run->audit, q->formula, at,
                                    at > s->from ? DALCS_LEFT : DALCS_RIGHT, s->result, doubt);
    } else {
        value = dalcs_stretch_value(s, q->formula, at);
        if (doubt != NULL) { /* of Clenshaw's sum of as many terms */
            *doubt = 16.0 * DALCS_STRETCH_NODES * DBL_EPSILON * fmax(q->scale, fabs(value));
        }
    }
    if (doubt != NULL) {
        *doubt += doubt_of_time(q, at, dalcs_stretch_value(s, q->formula, at));
    }
    q->a->credit -= q->reads ? state_work : stretch_work;
    if (q->omega != 0.0) {
        const double angle = q->omega * (at - q->since);
        value *= q->is_sine ? sin(angle) : cos(angle);
    }
    return value;
}

/* Can the auditor read all signals of a formula while segments are there? */
static bool reads_all(const struct dalcs_audit_run *run,
                      const struct dalcs_signal_formula *formula) {
    bool reads = true;
    for (int k = 0; k < formula->n && reads; k++) {
        if (formula->step[k].push == DALCS_PUT_SIGNAL) {
            const int part = dalcs_audit_part_of(
                run->audit, run->run->s->circuit.measured[formula->step[k].index]);
            reads = part >= 0 && run->radau->part[part].kind == DALCS_PART_STEPPED;
        }
    }
    return reads;
}

/* Of one that is late there is no segment any more, and in a stretch as short as rounding of times nothing to read. */
static struct asked ask(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                        const struct dalcs_signal_formula *formula, bool reads, double scale) {
    const struct dalcs_stretch *s = &m->stretch;
    const bool is_long =
        (s->to - s->from) * dalcs_audit_most_allowed(a->run) > 4.0 * DBL_EPSILON * s->to;
    return (struct asked){.a = a,
                          .m = m,
                          .formula = formula,
                          .reads = reads && s->result == NULL && is_long,
                          .scale = scale};
}

static struct dalcs_audit_number number_of(int k, double scale) {
    return (struct dalcs_audit_number){DALCS_AUDIT_MEASURE, k, scale};
}

/* ---- Windows ------------------------------------------------------------------------------------- */

/* The window of the card within the stretch; false: empty. */
static bool find_window(const struct dalcs_measuring *m, const struct dalcs_measured *item,
                        double *from, double *to) {
    const struct dalcs_instant *trig = &item->instant[0];
    const struct dalcs_instant *targ = &item->instant[1];
    *from = fmax(m->stretch.from, fmax(m->start, item->from));
    *to = fmin(m->stretch.to, fmin(m->stop, item->to));
    if (trig->card->kind != DALCS_INSTANT_NONE) {
        *from = trig->found ? fmax(*from, trig->time) : INFINITY;
        *to = targ->found ? fmin(*to, targ->time) : *to;
    }
    return *from < *to && !item->has_no_value;
}

static bool is_inside(const struct dalcs_stretch *s, double t) {
    return s->from < t && t < s->to;
}

static bool is_of(const struct dalcs_measuring *m, const struct dalcs_measured *item) {
    return item->card->analysis == m->analysis && item->card->kind != DALCS_MEASURE_PARAM;
}

/* ---- Before a stretch ---------------------------------------------------------------------------- */

static bool is_full(const struct dalcs_audit_measures *a) {
    return a->run->run->options->audit == DALCS_AUDIT_FULL;
}

static void earn(struct dalcs_audit_measures *a, const struct dalcs_measuring *m) {
    a->credit += share * (signal_work * m->stretch.n_signals + item_work * m->n);
}

/* Is what the budget allows enough for one more look? */
static bool may_look(struct dalcs_audit_measures *a) {
    if (is_full(a)) {
        return true;
    }
    if (a->credit < a->threshold) {
        return false;
    }
    a->threshold = 40.0 * state_work * dalcs_audit_run_chance(a->run);
    return true;
}

static void begin_item(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k,
                       bool may) {
    const struct dalcs_measured *item = &m->item[k];
    const struct dalcs_stretch *s = &m->stretch;
    struct audit_item *own = &a->item[k];
    double from, to;
    own->looks = false;
    if (is_of(m, item) && item->card->kind <= DALCS_MEASURE_MAX_AT) {
        const bool has_trig = item->card->instant[0].kind != DALCS_INSTANT_NONE;
        const bool is_edge = is_inside(s, item->from) || is_inside(s, item->to);
        own->looks = (has_trig || find_window(m, item, &from, &to)) &&
                     (is_full(a) || !own->was_looked || is_edge || (may && k == a->drawn));
    }
    if (own->looks) {
        a->before[k] = *item;
    }
}

/* Is it asked at one time in this stretch? */
static bool is_asked(const struct dalcs_audit_measures *a, int k) {
    return k == a->drawn || a->n_stretches <= FIRST_STRETCHES;
}

static void begin_line(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k,
                       bool may) {
    const struct dalcs_harmonics *h = &m->harmonics[k];
    const struct dalcs_stretch *s = &m->stretch;
    struct audit_line *own = &a->line[k];
    own->looks =
        h->from < s->to && s->from < h->to && (may || !own->was_looked || is_inside(s, h->from));
    if (own->looks) {
        own->line = (int)(dalcs_audit_run_chance(a->run) * (h->card->n_harmonics + 1));
        own->cosine = h->cosine[own->line];
        own->sine = h->sine[own->line];
    }
}

static void begin(void *user, const struct dalcs_measuring *m, int k) {
    struct dalcs_audit_measures *a = user;
    dalcs_audit_forget_asked(a->run->audit);
    earn(a, m);
    const bool may = may_look(a);
    a->drawn = k >= 0 ? k : (int)(dalcs_audit_run_chance(a->run) * m->n);
    a->n_stretches++;
    for (int j = 0; j < m->n; j++) {
        if (k >= 0 ? j == k : !m->item[j].card->is_late) {
            begin_item(a, m, j, may);
        }
        for (int i = 0; i < 2 && is_asked(a, j); i++) {
            a->item[j].n_now[i] = m->item[j].instant[i].n;
        }
    }
    for (int j = 0; k < 0 && j < m->n_harmonics; j++) {
        begin_line(a, m, j, may);
    }
}

/* ---- What a stretch has added --------------------------------------------------------------------- */

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

static void check_integral(const struct asked *q, const struct dalcs_audit_function *f,
                           const struct dalcs_audit_number *number, int power, double from,
                           double to, double claimed, double rounding) {
    const struct dalcs_audit *audit = q->a->run->audit;
    const double length = to - from;
    const double allowed = dalcs_audit_most_allowed(q->a->run) * number->scale *
                           (power == 1 ? 1.0 : number->scale) * length;
    struct dalcs_audit_sum own = dalcs_audit_integral(audit, f, power, from, to);
    if (!q->formula->is_affine && fabs(claimed - own.value) > 1e-3 * allowed) {
        struct by_spans b = {audit, f, power, {0.0, 0.0}};
        double scale = q->scale;
        dalcs_stretch_visit(&q->m->stretch, q->formula, from, to, &scale, &b, add_span);
        own = b.sum;
    }
    own.doubt += rounding;
    dalcs_audit_claim_integral(q->a->run->audit, number, power, length, claimed, to, &own);
}

static void check_sum(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k,
                      double from, double to) {
    const struct dalcs_measured *item = &m->item[k];
    const bool is_square = item->card->kind == DALCS_MEASURE_RMS;
    const double now = is_square ? item->square : item->integral;
    const double then = is_square ? a->before[k].square : a->before[k].integral;
    struct asked q = ask(a, m, &item->card->formula, a->item[k].reads, item->scale);
    const struct dalcs_audit_function f = {&q, value_of};
    const struct dalcs_audit_number number = number_of(k, item->scale);
    check_integral(&q, &f, &number, is_square ? 2 : 1, from, to, now - then,
                   4.0 * DBL_EPSILON * (fabs(now) + fabs(then)));
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
    struct asked q = ask(a, m, &item->card->formula, a->item[k].reads, item->scale);
    const struct dalcs_audit_function f = {&q, value_of};
    const struct dalcs_audit_number number = number_of(k, item->scale);
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

static void check_item(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k) {
    const struct dalcs_measured *item = &m->item[k];
    const enum dalcs_measure_kind kind = item->card->kind;
    double from, to;
    if (!find_window(m, item, &from, &to)) {
        return;
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
    struct asked q = ask(a, m, &item->card->formula, a->item[k].reads, scale);
    const struct dalcs_audit_function f = {&q, value_of};
    if (t < s->from - near || t > s->to + near) {
        return;
    }
    if (item->card->kind == DALCS_MEASURE_FIND) {
        const struct dalcs_audit_number number = number_of(k, scale);
        dalcs_audit_claim_value(a->run->audit, &number, &f, t, item->value);
    } else {
        scale = fmax(item->scale, fabs(item->value) * (s->to - s->from));
        const struct dalcs_audit_number number = number_of(k, scale);
        dalcs_audit_claim_slope(a->run->audit, &number, &f, fmin(fmax(t, s->from), s->to), s->from,
                                s->to, item->value);
    }
}

static void check_instants(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k) {
    const struct dalcs_measured *item = &m->item[k];
    const struct dalcs_stretch *s = &m->stretch;
    for (int i = 0; i < 2; i++) {
        const struct dalcs_instant *instant = &item->instant[i];
        double *told = &a->item[k].told[i];
        const bool is_new = instant->found && instant->time != *told;
        const bool looks = is_full(a) || *told < 0.0 || k == a->drawn;
        if (!is_new || item->waits) {
            continue;
        }
        *told = instant->time;
        if (instant->card->kind == DALCS_INSTANT_CROSSING && looks && instant->time >= s->from &&
            instant->time <= s->to) {
            const struct dalcs_signal_formula *formula = &instant->card->difference;
            struct asked q = ask(a, m, formula, reads_all(a->run, formula), instant->scale);
            const struct dalcs_audit_function f = {&q, value_of};
            const struct dalcs_audit_number number = number_of(k, instant->scale);
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

/* ---- One value ----------------------------------------------------------------------------------- */

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
        const struct dalcs_audit_number number = number_of(k, instant->scale);
        dalcs_audit_off(a->run->audit, &number, fabs(value), t);
    }
    if (side != 0) {
        own->side[i] = side;
        own->n_then[i] = own->n_now[i];
    }
}

static void ask_once(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k) {
    const struct dalcs_measured *item = &m->item[k];
    const struct dalcs_stretch *s = &m->stretch;
    const double t = s->from + dalcs_audit_run_chance(a->run) * (s->to - s->from);
    if (!is_of(m, item) || item->has_no_value || t < fmax(m->start, item->from) ||
        t > fmin(m->stop, item->to)) {
        return;
    }
    for (int i = 0; i < 2; i++) {
        ask_level(a, m, k, i, t);
    }
    double from, to;
    if (item->card->kind > DALCS_MEASURE_INTEGRAL && item->card->kind <= DALCS_MEASURE_MAX_AT &&
        find_window(m, item, &from, &to) && t >= from && t <= to) {
        const double value = dalcs_stretch_value(s, &item->card->formula, t);
        const struct dalcs_audit_number number = number_of(k, item->scale);
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

/* ---- Harmonics ------------------------------------------------------------------------------------ */

static void check_line(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k) {
    const struct dalcs_harmonics *h = &m->harmonics[k];
    const struct dalcs_stretch *s = &m->stretch;
    struct audit_line *own = &a->line[k];
    const double from = fmax(h->from, s->from);
    const double to = fmin(h->to, s->to);
    if (h->has_no_value || !(from < to)) {
        return;
    }
    own->was_looked = true;
    const double period = h->to - h->from;
    const struct dalcs_audit_number number = {DALCS_AUDIT_FOURIER, k, h->scale};
    for (int sine = 0; sine < 2; sine++) {
        struct asked q = ask(a, m, &h->card->formula, own->reads, h->scale);
        q.omega = dalcs_two_pi * h->frequency * own->line;
        q.since = h->from;
        q.is_sine = sine != 0;
        if (own->line == 0 && sine != 0) {
            continue;
        }
        const struct dalcs_audit_function f = {&q, value_of};
        const double now = sine != 0 ? h->sine[own->line] : h->cosine[own->line];
        const double then = sine != 0 ? own->sine : own->cosine;
        /* an angle is known to a rounding of its turns */
        const double turns =
            DBL_EPSILON * dalcs_two_pi * h->frequency * own->line * h->to * h->scale;
        check_integral(&q, &f, &number, 1, from, to, (now - then) * period,
                       4.0 * DBL_EPSILON * (fabs(now) + fabs(then)) * period +
                           8.0 * turns * (to - from));
    }
}

static void end(void *user, const struct dalcs_measuring *m, int k) {
    struct dalcs_audit_measures *a = user;
    for (int j = 0; j < m->n; j++) {
        if ((k >= 0 ? j == k : !m->item[j].card->is_late) && is_of(m, &m->item[j])) {
            if (a->item[j].looks) {
                check_item(a, m, j);
            }
            check_instants(a, m, j);
            if (is_asked(a, j)) {
                ask_once(a, m, j);
            }
        }
    }
    for (int j = 0; k < 0 && j < m->n_harmonics; j++) {
        if (a->line[j].looks) {
            check_line(a, m, j);
        }
    }
}

/* ---- Start and end ------------------------------------------------------------------------------- */

enum dalcs_status dalcs_audit_measures_start(struct dalcs_audit_measures *a,
                                             struct dalcs_audit_run *run,
                                             struct dalcs_measuring *m) {
    *a = (struct dalcs_audit_measures){0};
    if (run == NULL || run->audit == NULL) {
        return DALCS_OK;
    }
    a->run = run;
    a->watch = (struct dalcs_measuring_watch){a, begin, end};
    a->item = dalcs_alloc((size_t)m->n, sizeof(*a->item));
    a->before = dalcs_alloc((size_t)m->n, sizeof(*a->before));
    a->line = dalcs_alloc((size_t)m->n_harmonics, sizeof(*a->line));
    if (a->item == NULL || a->before == NULL || a->line == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < m->n; k++) {
        a->item[k].reads = reads_all(run, &m->item[k].card->formula);
        a->item[k].told[0] = a->item[k].told[1] = -1.0;
    }
    for (int k = 0; k < m->n_harmonics; k++) {
        a->line[k].reads = reads_all(run, &m->harmonics[k].card->formula);
    }
    m->watch = &a->watch;
    return DALCS_OK;
}

void dalcs_audit_measures_finish(struct dalcs_audit_measures *a) {
    free(a->item);
    free(a->before);
    free(a->line);
    *a = (struct dalcs_audit_measures){0};
}
