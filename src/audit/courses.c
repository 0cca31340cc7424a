/* courses.c - stimuli, as the netlist gave them, at many times that are close together. */
#include "screen.h"

/* A pulse: level by level, less what rounding of times may take for the next one. */
static void follow_pulse(const struct dalcs_stimulus *s, double t, struct audit_course *c) {
    const double top = s->u.pulse.rise + s->u.pulse.width;
    const double foot = top + s->u.pulse.fall;
    const bool repeats = s->u.pulse.period < INFINITY;
    const double from = t - s->u.pulse.delay;
    const double edge[] = {0.0, s->u.pulse.rise, top, foot, repeats ? s->u.pulse.period : INFINITY};
    const double low = s->u.pulse.low;
    const double level[] = {low, s->u.pulse.high, s->u.pulse.high, low, low};
    if (s->u.pulse.n_periods > 0.0 || foot > edge[4]) {
        return;
    }
    if (!(from > 0.0)) {
        *c = (struct audit_course){-INFINITY, s->u.pulse.delay, 0.0, 1, {low}};
        return;
    }
    const double past = repeats ? floor(from / s->u.pulse.period) * s->u.pulse.period : 0.0;
    const double begin = s->u.pulse.delay + past;
    const double near = 16.0 * 0x1p-52 * (t + s->u.pulse.delay);
    int k = 0;
    while (k < 3 && from - past >= edge[k + 1]) {
        k++;
    }
    c->origin = begin + edge[k];
    c->from = c->origin + near;
    c->to = begin + edge[k + 1] - near;
    c->n = level[k + 1] != level[k] ? 2 : 1;
    c->term[0] = level[k];
    c->term[1] = c->n == 2 ? (level[k + 1] - level[k]) / (edge[k + 1] - edge[k]) : 0.0;
}

/* An eighth of a radian of a sine that is not damped, by its series: what is left out is 8^-10/10! of it. Its cosine is
 * its value a fourth of a period later. Two values are worth it where the time asked before was as near. */
static void follow_sine(const struct dalcs_stimulus *s, double t, struct audit_course *c) {
    const double omega = 2.0 * 3.14159265358979323846 * s->u.sine.frequency;
    const bool is_near = omega * fabs(t - c->origin) <= 0.25;
    c->origin = t;
    if (!is_near || t < s->u.sine.delay || s->u.sine.n_cycles > 0.0 || s->u.sine.damping != 0.0 ||
        !(omega > 0.0)) {
        return;
    }
    const double quarter = 0.25 / s->u.sine.frequency;
    double sine = dalcs_stimulus_value(s, t, DALCS_RIGHT) - s->u.sine.offset;
    double cosine = dalcs_stimulus_value(s, t + quarter, DALCS_RIGHT) - s->u.sine.offset;
    *c = (struct audit_course){t, t + 0.125 / omega, t, AUDIT_COURSE_TERMS, {sine}};
    for (int k = 1; k < AUDIT_COURSE_TERMS; k++) {
        const double derivative = cosine * omega / k;
        cosine = -sine * omega / k;
        sine = derivative;
        c->term[k] = sine;
    }
    c->term[0] += s->u.sine.offset;
}

static void follow(const struct dalcs_stimulus *s, double t, struct audit_course *c);

/* term[AUDIT_COURSE_TERMS] += factor times a course, from t on. */
static void add_from(double t, double factor, const struct audit_course *c, double *term) {
    if (c->n == 2) { /* a line, which may have begun before */
        term[0] += factor * (c->term[0] + c->term[1] * (t - c->origin));
        term[1] += factor * c->term[1];
        return;
    }
    for (int k = 0; k < c->n; k++) {
        term[k] += factor * c->term[k];
    }
}

/* How long a polynomial stays within so much of its value, s, at most so long: its other terms grow at least in
 * proportion to the time. */
static double stays_within(const double *term, double most, double length) {
    double moves = 0.0;
    for (int k = AUDIT_COURSE_TERMS - 1; k > 0; k--) {
        moves = (moves + fabs(term[k])) * length;
    }
    return moves > most ? length * (most / moves) : length;
}

/* A line of its function, as long as the argument stays between the knots that it is between. */
static void follow_formula(const struct dalcs_stimulus *s, double t, struct audit_course *c) {
    const struct dalcs_stimulus_sum *sum = &s->u.formula.argument;
    const struct dalcs_piecewise *f = &s->u.formula.function;
    const double before = c->origin;
    struct audit_course all = {-INFINITY, INFINITY, t, 1, {sum->constant}};
    c->origin = t;
    for (int k = 0; k < sum->n; k++) {
        struct audit_course of = {.from = INFINITY, .origin = before};
        follow(sum->part[k].of, t, &of);
        if (!(of.from <= t && t <= of.to)) {
            return;
        }
        add_from(t, sum->part[k].factor, &of, all.term);
        all.to = fmin(all.to, of.to);
        all.n = of.n > all.n ? of.n : all.n;
    }
    int line = 0;
    while (line < f->n && f->knot[line].at <= all.term[0]) {
        line++;
    }
    const double above = line < f->n ? f->knot[line].at - all.term[0] : INFINITY;
    const double below = line > 0 ? all.term[0] - f->knot[line - 1].at : INFINITY;
    if (!(above > 0.0 && below > 0.0)) {
        return;
    }
    const double slope = dalcs_piecewise_slope(f, line);
    all.from = t;
    if (all.n > 1) {
        all.to = t + stays_within(all.term, fmin(above, below), all.to - t);
    }
    all.term[0] = dalcs_piecewise_on_line(f, line, all.term[0]);
    for (int k = 1; k < all.n; k++) {
        all.term[k] *= slope;
    }
    all.n = slope != 0.0 ? all.n : 1;
    *c = all;
}

/* c->from is INFINITY, c->origin when it was asked before. */
static void follow(const struct dalcs_stimulus *s, double t, struct audit_course *c) {
    if (s->kind == DALCS_STIMULUS_PULSE) {
        follow_pulse(s, t, c);
    } else if (s->kind == DALCS_STIMULUS_SIN) {
        follow_sine(s, t, c);
    } else if (s->kind == DALCS_STIMULUS_FORMULA) {
        follow_formula(s, t, c);
    } else if (s->kind == DALCS_STIMULUS_DC) {
        *c = (struct audit_course){-INFINITY, INFINITY, 0.0, 1, {s->dc}};
    }
}

double audit_course_begin(struct dalcs_audit *audit, int stimulus, double t) {
    const struct dalcs_stimulus *s = &audit->circuit->stimulus[stimulus];
    struct audit_course *c = &audit->course[stimulus];
    c->from = INFINITY;
    follow(s, t, c);
    return c->from <= t && t <= c->to ? audit_stimulus_at(audit, stimulus, t)
                                      : dalcs_stimulus_value(s, t, DALCS_RIGHT);
}

/* term[] of a polynomial in t - origin become those in t - origin - by (D. E. Knuth, The Art of Computer Programming 2, sec. 4.6.4:
 * Horner's rule again and again). */
static void shift(int n, double by, double *term) {
    for (int i = 0; i < n - 1; i++) {
        for (int k = n - 2; k >= i; k--) {
            term[k] += by * term[k + 1];
        }
    }
}

static const double turn = 2.0 * 3.14159265358979323846;

/* Is it a sine from t on? */
static bool is_wave(const struct dalcs_stimulus *s, double t) {
    return s->kind == DALCS_STIMULUS_SIN && t >= s->u.sine.delay && !(s->u.sine.n_cycles > 0.0) &&
           s->u.sine.damping == 0.0 && s->u.sine.frequency > 0.0;
}

/* Sines of one frequency are one sine: of two values, a quarter of its period apart. */
static bool add_wave(const struct dalcs_stimulus *s, double factor, double t,
                     struct audit_waves *all) {
    int k = 0;
    while (k < all->n && all->wave[k].frequency != s->u.sine.frequency) {
        k++;
    }
    if (k == AUDIT_MOST_WAVES) {
        return false;
    }
    struct audit_wave *w = &all->wave[k];
    if (k == all->n) {
        all->n++;
        *w = (struct audit_wave){.frequency = s->u.sine.frequency, .origin = t};
    }
    const double since = w->origin;
    const double quarter = since + 0.25 / w->frequency;
    const double offset = s->u.sine.offset;
    w->sine += factor * (dalcs_stimulus_value(s, since, DALCS_RIGHT) - offset);
    w->cosine += factor * (dalcs_stimulus_value(s, quarter, DALCS_RIGHT) - offset);
    all->offset += factor * offset;
    return true;
}

/* Terms that are sines from t on are one wave for each frequency from now on. */
static void take_waves(const struct dalcs_audit *audit, struct audit_screen *screen, double t) {
    struct audit_term *term = screen->term[AUDIT_TERM_LAW];
    int n_left = 0;
    for (int k = 0; k < screen->n_terms[AUDIT_TERM_LAW]; k++) {
        const struct dalcs_stimulus *s = &audit->circuit->stimulus[term[k].index];
        if (!(is_wave(s, t) && add_wave(s, term[k].factor, t, &screen->waves))) {
            term[n_left++] = term[k];
        }
    }
    screen->n_terms[AUDIT_TERM_LAW] = n_left;
    for (int k = 0; k < screen->waves.n; k++) {
        struct audit_wave *w = &screen->waves.wave[k];
        w->amplitude = hypot(w->sine, w->cosine);
        w->phase = atan2(w->sine, w->cosine) / turn;
    }
}

double audit_waves_value(const struct audit_waves *all, double t) {
    double sum = all->offset;
    for (int k = 0; k < all->n; k++) {
        const struct audit_wave *w = &all->wave[k];
        const double cycles = w->frequency * (t - w->origin);
        sum += w->amplitude * sin(turn * (cycles - floor(cycles) + w->phase));
    }
    return sum;
}

/* What are no waves is one polynomial as long as all of them are. It is worth it where that is longer than since the time
 * asked before. */
double audit_laws_begin(struct dalcs_audit *audit, struct audit_screen *screen, double t) {
    struct audit_course *all = &screen->course;
    const double before = all->origin;
    take_waves(audit, screen, t);
    const struct audit_term *term = screen->term[AUDIT_TERM_LAW];
    const int n = screen->n_terms[AUDIT_TERM_LAW];
    double sum = 0.0;
    double from = -INFINITY;
    double to = INFINITY;
    for (int k = 0; k < n; k++) {
        sum += term[k].factor * audit_stimulus_at(audit, term[k].index, t);
        from = fmax(from, audit->course[term[k].index].from);
        to = fmin(to, audit->course[term[k].index].to);
    }
    *all = (struct audit_course){INFINITY, to, t, 1, {0.0}};
    if (!(from <= t && t <= to && fabs(t - before) <= to - t)) {
        return sum;
    }
    for (int k = 0; k < n; k++) {
        struct audit_course c = audit->course[term[k].index];
        shift(c.n, t - c.origin, c.term);
        for (int i = 0; i < c.n; i++) {
            all->term[i] += term[k].factor * c.term[i];
        }
        all->n = c.n > all->n ? c.n : all->n;
    }
    all->from = from;
    return sum;
}
