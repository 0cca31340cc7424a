/* steady_report.c - what the multipliers of an orbit say, and what is told when there is none. */
#include "steady.h"

#include "quantity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The size of a pair is, within what a hundred steps of a period make of an oscillation that the orbit does not have: the
 * steps are as long as the orbit allows, each to the 1e-9 that small circuits are held to. */
static const double near_circle = 1e-7;

/* ---- Verdict ------------------------------------------------------------------------------------- */

/* By how much the largest lies outside the unit circle; within what is not known, 0. */
static double outside(const struct dalcs_floquet *m, size_t n) {
    const double by = n > 0 ? hypot(m[0].re, m[0].im) - 1.0 : -1.0;
    return fabs(by) > (n > 0 && m[0].im != 0.0 ? near_circle : dalcs_steady_near_one) ? by : 0.0;
}

bool dalcs_steady_is_unstable(const struct dalcs_report *report) {
    return outside(report->steady.multiplier, report->steady.n_multipliers) > 0.0;
}

/* How what is beside the orbit, of that period, leaves it; as slowly as that is, not "by 1". */
static const char *growth_text(struct dalcs_arena *arena, const struct dalcs_floquet *m,
                               double period) {
    const double size = hypot(m->re, m->im);
    const int digits = size < 1.001 ? 10 : 4;
    char text[DALCS_QUANTITY_SIZE];
    if (m->im != 0.0) {
        return dalcs_arena_printf(
            arena, "unstable: an oscillation of %s at %s grows by %.*g each period", m->state,
            dalcs_quantity_write(text, fabs(carg(m->re + I * m->im)) / (2.0 * acos(-1.0) * period),
                                 "Hz", 4),
            digits, size);
    }
    return dalcs_arena_printf(arena, "unstable: a deviation of %s %sgrows by %.*g each period",
                              m->state, m->re < 0.0 ? "changes its sign and " : "", digits, size);
}

static const char *verdict_of(struct dalcs_steady *st, const struct dalcs_floquet *m, size_t n) {
    struct dalcs_arena *arena = &st->run->s->arena;
    const double by = outside(m, n);
    if (by > 0.0) {
        return growth_text(arena, m, st->period);
    }
    if (st->own.is_free && st->own.n > 0) {
        return "not unique: nothing determines its amplitude, or another conserved quantity";
    }
    if (st->kept.n > 0) {
        return "not unique: a conserved quantity keeps its initial value";
    }
    return by < 0.0 ? "stable" : "at the border of stability";
}

/* "v(c2) - 0.5 v(c1)": the terms of a conserved quantity, the largest as 1. */
static const char *conserved_text(struct dalcs_steady *st, const struct dalcs_steady_conserved *c) {
    const int first = st->layout.first[c->system];
    const int n = st->layout.first[c->system + 1] - first;
    struct dalcs_arena *arena = &st->run->s->arena;
    double largest = 0.0;
    for (int x = 0; x < n; x++) {
        largest = fabs(c->weight[x]) > fabs(largest) ? c->weight[x] : largest;
    }
    const char *text = "";
    for (int x = 0; x < n && text != NULL; x++) {
        double part = c->weight[x] / largest;
        if (fabs(part) > dalcs_steady_near_one) {
            char factor[32] = "";
            if (fabs(fabs(part) - 1.0) > dalcs_steady_near_one) {
                snprintf(factor, sizeof factor, "%.6g ", fabs(part));
            }
            const char *sign = part < 0.0 ? " - " : " + ";
            sign = text[0] != '\0' ? sign : part < 0.0 ? "-" : "";
            text = dalcs_arena_printf(arena, "%s%s%s%s", text, sign, factor,
                                      dalcs_steady_name(st, first + x));
        }
    }
    return text;
}

static enum dalcs_status tell_conserved(struct dalcs_steady *st) {
    struct dalcs_session *s = st->run->s;
    const char **conserved =
        dalcs_arena_alloc(&s->arena, (size_t)st->kept.n + 1, sizeof(*conserved));
    if (conserved == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < st->kept.n; k++) {
        conserved[k] = conserved_text(st, &st->kept.of[k]);
        if (conserved[k] == NULL) {
            return DALCS_E_NOMEM;
        }
        dalcs_diag_add(&s->diag, DALCS_WARNING, NULL, "IC= or .ic with uic choose another one",
                       "the steady state is not unique: %s keeps its initial value", conserved[k]);
    }
    s->results.report.steady.conserved = conserved;
    s->results.report.steady.n_conserved = (size_t)st->kept.n;
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_report_signals(struct dalcs_steady *st) {
    struct dalcs_session *s = st->run->s;
    const struct dalcs_circuit *c = &s->circuit;
    const size_t n = (size_t)(c->results.n_computed > 0 ? c->results.n_named : c->results.n_shown);
    struct dalcs_steady_signal *signal = dalcs_arena_alloc(&s->arena, n + 1, sizeof(*signal));
    if (signal == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        signal[k] = (struct dalcs_steady_signal){st->run->signals.name[k], st->found.average[k],
                                                 st->found.rms[k]};
    }
    s->results.report.steady.signal = signal;
    s->results.report.steady.state = st->found.state;
    s->results.report.steady.n_signals = n;
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_report_double(struct dalcs_steady *st, double one) {
    struct dalcs_report *report = &st->run->s->results.report;
    struct dalcs_arena *arena = &st->run->s->arena;
    struct dalcs_floquet *m;
    size_t n;
    char text[DALCS_QUANTITY_SIZE];
    DALCS_TRY(dalcs_steady_find_multipliers(st, &m, &n));
    if (st->own.is_free) {
        (void)dalcs_steady_take_out_flow(m, &n);
    }
    n = dalcs_steady_count_lasting(m, n);
    const double size = n > 0 ? hypot(m[0].re, m[0].im) : 0.0;
    report->steady.doubled.period = st->period;
    report->steady.doubled.stable = outside(m, n) < 0.0;
    report->steady.doubled.n_multipliers = n;
    report->steady.doubled.multiplier = m;
    report->steady.verdict = dalcs_arena_printf(
        arena, "%s; an orbit of two periods, %s, was found: %s, with a largest factor of %.6g%s",
        growth_text(arena, report->steady.multiplier, one),
        dalcs_quantity_write(text, st->period, "s", 12),
        report->steady.doubled.stable ? "stable" : "unstable too", size,
        st->own.is_free ? "" : "; .pss periods=2 gives it");
    return report->steady.verdict != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* What a run comes to, as the end of a sentence; "": that is not known. */
static const char *attractor_text(struct dalcs_arena *arena, const struct dalcs_steady_attractor *a,
                                  double period) {
    char text[DALCS_QUANTITY_SIZE];
    switch (a->kind) {
    case DALCS_STEADY_ORBIT:
        return a->n == 1 ? dalcs_arena_printf(
                               arena,
                               "; another orbit of one period was found: stable, with a "
                               "largest factor of %.6g; start nearer to it with IC= and uic",
                               a->growth)
                         : dalcs_arena_printf(arena,
                                              "; an orbit of %d periods, %s, was found: stable, "
                                              "with a largest factor of "
                                              "%.6g; .pss periods=%d gives it",
                                              a->n, dalcs_quantity_write(text, period, "s", 12),
                                              a->growth, a->n);
    case DALCS_STEADY_TORUS:
        return "; a run beside it is quasi-periodic: an oscillation that has no common period with "
               "the sources";
    case DALCS_STEADY_CHAOS:
        return dalcs_arena_printf(
            arena,
            "; a run beside it is chaotic: what two runs differ by grows by %.4g each period, on "
            "average",
            a->growth);
    case DALCS_STEADY_SETTLING:
    case DALCS_STEADY_UNKNOWN:
        break;
    }
    return "";
}

enum dalcs_status dalcs_steady_report_attractor(struct dalcs_steady *st, double one,
                                                const struct dalcs_steady_attractor *a) {
    static const char *const kind[] = {[DALCS_STEADY_ORBIT] = "orbit",
                                       [DALCS_STEADY_TORUS] = "quasi-periodic",
                                       [DALCS_STEADY_CHAOS] = "chaos"};
    struct dalcs_report *report = &st->run->s->results.report;
    const double period = a->n * one;
    const char *text = attractor_text(&st->run->s->arena, a, period);
    report->steady.attractor.kind = kind[a->kind];
    report->steady.attractor.periods = a->n;
    report->steady.attractor.period = period;
    report->steady.attractor.growth = a->growth;
    report->steady.verdict =
        text == NULL ? NULL
                     : dalcs_arena_printf(&st->run->s->arena, "%s%s", report->steady.verdict, text);
    return report->steady.verdict != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_steady_report(struct dalcs_steady *st) {
    struct dalcs_session *s = st->run->s;
    struct dalcs_floquet *m;
    size_t n;
    DALCS_TRY(dalcs_steady_find_multipliers(st, &m, &n));
    if (st->own.is_free) {
        s->results.report.steady.self_oscillating = true;
        s->results.report.steady.flow = dalcs_steady_take_out_flow(m, &n);
    }
    n = dalcs_steady_count_lasting(m, n);
    s->results.report.steady.present = true;
    s->results.report.steady.period = st->period;
    s->results.report.steady.newton = st->n.newton;
    s->results.report.steady.bursts = st->n.bursts;
    s->results.report.steady.leaps = st->n.leaps;
    s->results.report.steady.periods = st->n.periods;
    s->results.report.steady.residual = st->pass.residual;
    s->results.report.steady.distance = st->distance;
    s->results.report.steady.exact = st->pass.is_exact;
    s->results.report.steady.multiplier = m;
    s->results.report.steady.n_multipliers = n;
    s->results.report.steady.stable = st->kept.n == 0 && st->own.n == 0 && outside(m, n) < 0.0;
    s->results.report.steady.verdict = verdict_of(st, m, n);
    DALCS_TRY(tell_conserved(st));
    return s->results.report.steady.verdict != NULL ? dalcs_steady_report_signals(st)
                                                    : DALCS_E_NOMEM;
}
