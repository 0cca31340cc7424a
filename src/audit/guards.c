/* guards.c - signs that sources alone decide: of switches that these command. */
#include "screen.h"

/* How far below 0 the worst of them is at one time. */
static double worst_at(struct dalcs_audit *audit, const struct audit_screen *screen, double t) {
    const struct audit_term *term = screen->term[AUDIT_TERM_GUARD];
    const struct audit_term *end = term + screen->n_terms[AUDIT_TERM_GUARD];
    double worst = 0.0;
    for (int g = 0; g < screen->n_guards; g++) {
        double value = screen->constant[screen->n_places + g];
        for (; term < end && term->place == g; term++) {
            value += term->factor * audit_stimulus_at(audit, term->index, t);
        }
        worst = -value > worst || value != value ? -value : worst;
    }
    return worst;
}

/* s: so much later all pulses that guards read are what they are now; 0: that is not known. */
static double period_of(const struct dalcs_audit *audit, const struct audit_screen *screen,
                        double from) {
    const struct audit_term *term = screen->term[AUDIT_TERM_GUARD];
    double period = 0.0;
    for (int k = 0; k < screen->n_terms[AUDIT_TERM_GUARD]; k++) {
        const struct dalcs_stimulus *s = &audit->circuit->stimulus[term[k].index];
        const bool repeats = s->kind == DALCS_STIMULUS_PULSE && !(s->u.pulse.n_periods > 0.0) &&
                             s->u.pulse.period < INFINITY && from > s->u.pulse.delay;
        if (!repeats || (k > 0 && s->u.pulse.period != period)) {
            return 0.0;
        }
        period = s->u.pulse.period;
    }
    return period;
}

/* Between which times none of them is below 0, around one at which none is, as far as all are lines there. */
static void settle(struct dalcs_audit *audit, const struct audit_screen *screen,
                   struct audit_window *window) {
    const struct audit_term *term = screen->term[AUDIT_TERM_GUARD];
    double from = -INFINITY;
    double to = INFINITY;
    int n = 1;
    for (int k = 0; k < screen->n_terms[AUDIT_TERM_GUARD]; k++) {
        const struct audit_course *c = &audit->course[term[k].index];
        from = c->from > from ? c->from : from;
        to = c->to < to ? c->to : to;
        n = c->n > n ? c->n : n;
    }
    if (n == 1 || (n == 2 && from < to && to < INFINITY && worst_at(audit, screen, from) == 0.0 &&
                   worst_at(audit, screen, to) == 0.0)) {
        *window = (struct audit_window){from, to, period_of(audit, screen, from)};
    }
}

/* All of them are lines between two times, as asked last in between. */
static bool are_lines(const struct dalcs_audit *audit, const struct audit_screen *screen,
                      double from, double to) {
    const struct audit_term *term = screen->term[AUDIT_TERM_GUARD];
    bool are = true;
    for (int k = 0; k < screen->n_terms[AUDIT_TERM_GUARD] && are; k++) {
        const struct audit_course *c = &audit->course[term[k].index];
        are = c->n <= 2 && c->from <= from && to <= c->to;
    }
    return are;
}

/* Guards hold and are lines between two times outside of what is known, but for how near to an edge it ends (courses.c). */
static bool go_on(struct dalcs_audit *audit, const struct audit_screen *screen, double from,
                  double to, double end) {
    const double gap = 4.0 * 16.0 * 0x1p-52 * fabs(to);
    return from + gap < to - gap && worst_at(audit, screen, 0.5 * (from + to)) == 0.0 &&
           are_lines(audit, screen, from + (end == from ? 0.0 : gap),
                     to - (end == to ? 0.0 : gap)) &&
           worst_at(audit, screen, end) == 0.0;
}

/* A command comes in the middle of an edge, whose rest belongs to the stretch. Times are rounded: what is known goes on by half
 * of what stretches are asked within their ends. */
static void widen(struct dalcs_audit *audit, const struct audit_screen *screen,
                  struct audit_window *window, double from, double to) {
    const double first = from - 2.0 * audit->options.resolution;
    const double last = to + 2.0 * audit->options.resolution;
    if (first < window->from && go_on(audit, screen, first, window->from, first)) {
        window->from = first;
    }
    if (last > window->to && go_on(audit, screen, window->to, last, last)) {
        window->to = last;
    }
}

double audit_worst_guard_between(struct dalcs_audit *audit, struct audit_screen *screen,
                                 double from, double to, double t) {
    const double worst = worst_at(audit, screen, t);
    screen->window_at = (screen->window_at + 1) % AUDIT_WINDOWS;
    struct audit_window *window = &screen->window[screen->window_at];
    *window = (struct audit_window){.from = INFINITY};
    if (worst == 0.0) {
        settle(audit, screen, window);
    }
    if (window->from <= from && to <= window->to) {
        return 0.0;
    }
    const double at_ends = fmax(worst_at(audit, screen, from), worst_at(audit, screen, to));
    if (window->period > 0.0 && at_ends == 0.0) {
        widen(audit, screen, window, from, to);
    }
    return fmax(worst, at_ends);
}
