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

/* Between which times none of them is below 0, around one at which none is, as far as all are lines there. */
static void settle(struct dalcs_audit *audit, struct audit_screen *screen) {
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
        screen->guarded_from = from;
        screen->guarded_to = to;
    }
}

double audit_worst_guard_between(struct dalcs_audit *audit, struct audit_screen *screen,
                                 double from, double to, double t) {
    const double worst = worst_at(audit, screen, t);
    screen->guarded_from = INFINITY;
    if (worst == 0.0) {
        settle(audit, screen);
    }
    return screen->guarded_from <= from && to <= screen->guarded_to
               ? 0.0
               : fmax(worst, fmax(worst_at(audit, screen, from), worst_at(audit, screen, to)));
}
