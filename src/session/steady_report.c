/* steady_report.c - multipliers of an orbit, what they say, and what is told when there is none. */
#include "steady.h"

#include "quantity.h"

#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A multiplier is 1 within what rounding and the tolerance make of it. */
static const double near_one = 1e-9;

/* The size of a pair is, within what a hundred steps of a period make of an oscillation that the orbit does not have: the
 * steps are as long as the orbit allows, each to the 1e-9 that small circuits are held to. */
static const double near_circle = 1e-7;

/* Smaller than this beside 1 is none: nothing of it is left after one period. */
static const double vanishes = 1e-12;

/* "q(a1)": of the memory of gates. */
static const char *name_of_number(struct dalcs_steady *st, int number) {
    static const char *const what[] = {
        [DALCS_NUMBER_PIN] = "q", [DALCS_NUMBER_TAKEN] = "sample", [DALCS_NUMBER_PULSE] = "pulse"};
    int gate;
    const enum dalcs_logic_number kind = dalcs_logic_number_kind(&st->layout.memory, number, &gate);
    return kind == DALCS_NUMBER_DUE
               ? "an edge on its way"
               : dalcs_arena_printf(&st->run->s->arena, "%s(%s)", what[kind],
                                    st->run->s->circuit.control.gate[gate].name);
}

const char *dalcs_steady_name(struct dalcs_steady *st, int state) {
    const struct dalcs_network *n = &st->run->s->network;
    int k = 0;
    if (state >= st->layout.n_states) {
        return name_of_number(st, state - st->layout.n_states);
    }
    while (state >= st->layout.first[k + 1]) {
        k++;
    }
    const struct dalcs_system *s = &n->system[k];
    const int x = state - st->layout.first[k];
    for (int i = 0; i < n->n_states; i++) { /* a capacitor or coil, whose state it is */
        const struct dalcs_probe *p = &n->state[i].probe;
        if (p->system == k && p->n_terms == 1 && p->n_inputs == 0 && p->term[0].index == x) {
            return dalcs_arena_printf(&st->run->s->arena, "%s(%s)",
                                      n->state[i].is_current ? "i" : "v", n->state[i].element);
        }
    }
    return s->column[x].element;
}

/* ---- Multipliers --------------------------------------------------------------------------------- */

static int compare_size(const void *one, const void *other) {
    const struct dalcs_floquet *a = one;
    const struct dalcs_floquet *b = other;
    double difference = hypot(b->re, b->im) - hypot(a->re, a->im);
    if (fabs(difference) <= near_one) { /* conjugates stay together */
        difference = b->im - a->im;
    }
    return difference > 0.0 ? 1 : difference < 0.0 ? -1 : 0;
}

/* The state that has most of an eigenvector, by its energy. */
static int largest_entry(const struct dalcs_steady *st, int first, int n, const double *re,
                         const double *im) {
    int largest = 0;
    double most = -1.0;
    for (int x = 0; x < n; x++) {
        double size = hypot(re[x], im != NULL ? im[x] : 0.0) /
                      (st->scale[first + x] > 0.0 ? st->scale[first + x] : 1.0);
        largest = size > most ? x : largest;
        most = fmax(most, size);
    }
    return first + largest;
}

static enum dalcs_status multipliers_of(struct dalcs_steady *st, int system,
                                        struct dalcs_floquet *multiplier, size_t *n_all,
                                        struct dalcs_arena *arena) {
    const int first = st->layout.first[system];
    const int n = st->layout.first[system + 1] - first;
    const size_t square = (size_t)n * (size_t)n;
    double *A = dalcs_arena_alloc(arena, square, sizeof(double));
    double *vector = dalcs_arena_alloc(arena, square, sizeof(double));
    double *value = dalcs_arena_alloc(arena, 2 * (size_t)n, sizeof(double));
    if (A == NULL || vector == NULL || value == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(A, st->pass.M + st->layout.first_of_M[system], square * sizeof(double));
    if (n == 0) {
        return DALCS_OK;
    }
    const int failed =
        LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'V', n, A, n, value, value + n, NULL, 1, vector, n);
    if (failed != 0) {
        return failed == LAPACK_WORK_MEMORY_ERROR ? DALCS_E_NOMEM : DALCS_NOT_CONVERGED;
    }
    for (int k = 0; k < n; k++) {
        const double *v = vector + (size_t)k * (size_t)n;
        const double im = value[n + k];
        int state = im == 0.0  ? largest_entry(st, first, n, v, NULL)
                    : im > 0.0 ? largest_entry(st, first, n, v, v + n)
                               : largest_entry(st, first, n, v - n, v);
        multiplier[(*n_all)++] =
            (struct dalcs_floquet){.re = value[k], .im = im, .state = dalcs_steady_name(st, state)};
    }
    return DALCS_OK;
}

/* What is left out: factors of states whose value is lost within a period. */
static size_t count_lasting(const struct dalcs_floquet *m, size_t n) {
    size_t lasting = 0;
    while (lasting < n && hypot(m[lasting].re, m[lasting].im) > vanishes) {
        lasting++;
    }
    return lasting;
}

/* The multiplier 1 of an oscillation's flow says nothing of stability: the nearest one is taken out. */
static double take_out_flow(struct dalcs_floquet *m, size_t *n) {
    size_t flow = 0;
    for (size_t k = 1; k < *n; k++) {
        if (hypot(m[k].re - 1.0, m[k].im) < hypot(m[flow].re - 1.0, m[flow].im)) {
            flow = k;
        }
    }
    if (*n == 0) {
        return 0.0;
    }
    const double is = m[flow].re;
    memmove(m + flow, m + flow + 1, (*n - flow - 1) * sizeof(*m));
    --*n;
    return is;
}

/* ---- Verdict ------------------------------------------------------------------------------------- */

/* By how much the largest lies outside the unit circle; within what is not known, 0. */
static double outside(const struct dalcs_floquet *m, size_t n) {
    const double by = n > 0 ? hypot(m[0].re, m[0].im) - 1.0 : -1.0;
    return fabs(by) > (n > 0 && m[0].im != 0.0 ? near_circle : near_one) ? by : 0.0;
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
        if (fabs(part) > near_one) {
            char factor[32] = "";
            if (fabs(fabs(part) - 1.0) > near_one) {
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

/* All of them, the largest first; the session's. */
static enum dalcs_status find_multipliers(struct dalcs_steady *st, struct dalcs_floquet **found,
                                          size_t *n) {
    struct dalcs_arena work = {0};
    struct dalcs_floquet *m =
        dalcs_arena_alloc(&st->run->s->arena, (size_t)st->layout.n_x + 1, sizeof(*m));
    enum dalcs_status status = m != NULL ? DALCS_OK : DALCS_E_NOMEM;
    *n = 0;
    for (int k = 0; k < st->layout.n_systems && status == DALCS_OK; k++) {
        status = multipliers_of(st, k, m, n, &work);
    }
    dalcs_arena_finish(&work);
    DALCS_TRY(status);
    qsort(m, *n, sizeof(*m), compare_size);
    *found = m;
    return DALCS_OK;
}

double dalcs_steady_largest_multiplier(struct dalcs_steady *st) {
    struct dalcs_floquet *m;
    size_t n;
    if (find_multipliers(st, &m, &n) != DALCS_OK) {
        return 0.0;
    }
    if (st->own.is_free) {
        (void)take_out_flow(m, &n);
    }
    return n > 0 ? hypot(m[0].re, m[0].im) : 0.0;
}

enum dalcs_status dalcs_steady_report_double(struct dalcs_steady *st, double one) {
    struct dalcs_report *report = &st->run->s->results.report;
    struct dalcs_arena *arena = &st->run->s->arena;
    struct dalcs_floquet *m;
    size_t n;
    char text[DALCS_QUANTITY_SIZE];
    DALCS_TRY(find_multipliers(st, &m, &n));
    if (st->own.is_free) {
        (void)take_out_flow(m, &n);
    }
    n = count_lasting(m, n);
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
    DALCS_TRY(find_multipliers(st, &m, &n));
    if (st->own.is_free) {
        s->results.report.steady.self_oscillating = true;
        s->results.report.steady.flow = take_out_flow(m, &n);
    }
    n = count_lasting(m, n);
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
