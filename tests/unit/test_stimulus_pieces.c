/* test_stimulus_pieces.c - what all sources keep to: edges in order, pieces between them, ends, repetitions. */
#include "edges_ahead.h"
#include "make_stimulus.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

static uint64_t state = 2385;

static double uniform(double low, double high) {
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(state >> 11) / 9007199254740992.0;
}

/* A time of a few decimal digits, or 0: such times coincide. */
static double decimal_time(void) {
    const double digit = floor(uniform(0, 20));
    return uniform(0, 1) < 0.2 ? 0 : digit * pow(10, floor(uniform(-4, 0)));
}

static double pwl_t[12];
static double pwl_v[12];

static const struct dalcs_tone tones[3] = {{2, 3, 0.25}, {-1.5, -0.75, 0.1}, {0.3, 17, 0.9}};

/* Kinds from 4 on end or repeat. */
static struct dalcs_stimulus random_stimulus(int kind) {
    const double low = uniform(-5, 5);
    const double high = uniform(-5, 5);
    if (kind == 4) {
        struct dalcs_stimulus s =
            make_pulse(low, high, decimal_time() - 0.5, decimal_time() / 4, decimal_time() / 4,
                       decimal_time(), decimal_time() + 0.01);
        s.u.pulse.n_periods = uniform(0, 1) < 0.7 ? floor(uniform(1, 6)) : uniform(0.1, 6);
        return s;
    }
    if (kind == 5) {
        struct dalcs_stimulus s =
            make_sine(low, high, uniform(1, 50), decimal_time(), uniform(0, 1), uniform(-180, 180));
        s.u.sine.n_cycles = uniform(0.1, 20);
        return s;
    }
    if (kind == 6) {
        struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_TONES};
        s.u.tones.offset = low;
        s.u.tones.delay = uniform(0, 1) < 0.3 ? 0 : decimal_time();
        s.u.tones.n = 3;
        s.u.tones.tone = tones;
        return s;
    }
    if (kind == 7) {
        struct dalcs_stimulus s = random_stimulus(3);
        s.u.pwl.repeat_from = pwl_t[(int)uniform(0, 11)];
        s.u.pwl.repeats = s.u.pwl.repeat_from < pwl_t[11];
        return s;
    }
    if (kind == 0) {
        const double period = uniform(0, 1) < 0.2 ? INFINITY : decimal_time() + 0.01;
        return make_pulse(low, high, decimal_time() - 0.5, decimal_time() / 4, decimal_time() / 4,
                          decimal_time(), period);
    }
    if (kind == 1) {
        return make_sine(low, high, uniform(0, 50), decimal_time(), uniform(-1, 1),
                         uniform(-180, 180));
    }
    if (kind == 2) {
        const double delay = decimal_time();
        return make_exponential(low, high, delay, decimal_time(), delay + decimal_time(),
                                decimal_time());
    }
    double t = 0;
    for (int k = 0; k < 12; k++) {
        t += decimal_time();
        pwl_t[k] = t;
        pwl_v[k] = uniform(-5, 5);
    }
    return make_pwl(pwl_t, pwl_v, 12);
}

/* No jump inside a..b. Slopes are below 1e6 a second, so that over 1e-9 s a jump stands out. */
static void check_smooth(const struct dalcs_stimulus *s, double a, double b) {
    const double near = 1e-9 * fmin(1, b - a);
    for (int k = 1; k < 16; k++) {
        const double t = a + k * (b - a) / 16;
        const double here = dalcs_stimulus_value(s, t, DALCS_LEFT);
        const double change = dalcs_stimulus_value(s, t + near, DALCS_RIGHT) -
                              dalcs_stimulus_value(s, t - near, DALCS_LEFT);
        ck_assert_double_eq(here, dalcs_stimulus_value(s, t, DALCS_RIGHT));
        ck_assert_msg(fabs(change) < 2e-3, "a jump of %g at %.17g, between %.17g and %.17g", change,
                      t, a, b);
    }
}

START_TEST(test_contract) {
    for (int trial = 0; trial < 2400; trial++) {
        const struct dalcs_stimulus s = random_stimulus(trial % 8);
        double t = 0;
        for (int k = 0; k < 30; k++) {
            const double next = dalcs_stimulus_next_edge(&s, t);
            ck_assert(next > t);
            const double end = isinf(next) ? t + 1 : next;
            const double gap = (end - t) * 1e-9 + 16 * DBL_EPSILON * end;
            if (end - t > 4 * gap) {
                /* One-sided limits are the values beside the edge. */
                ck_assert_double_eq_tol(dalcs_stimulus_value(&s, t, DALCS_RIGHT),
                                        dalcs_stimulus_value(&s, t + gap, DALCS_LEFT), 1e-4);
                ck_assert_double_eq_tol(dalcs_stimulus_value(&s, end, DALCS_LEFT),
                                        dalcs_stimulus_value(&s, end - gap, DALCS_RIGHT), 1e-4);
                check_smooth(&s, t + gap, end - gap);
            }
            if (isinf(next)) {
                break;
            }
            t = next;
        }
    }
}

END_TEST

START_TEST(test_counted_pulses) {
    struct dalcs_stimulus s = make_pulse(0, 1, 1, 0, 0, 1, 3);
    s.u.pulse.n_periods = 2;
    const double edge[] = {1, 2, 4, 5, 7};
    double t = 0;
    for (size_t k = 0; k < sizeof edge / sizeof edge[0]; k++) {
        t = dalcs_stimulus_next_edge(&s, t);
        ck_assert_double_eq(t, edge[k]);
    }
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, t)));
    check_limits(&s, 4, 0, 1);
    check_limits(&s, 5, 1, 0);
    check_limits(&s, 7, 0, 0);
    check_limits(&s, 1000, 0, 0);
    /* Longer than the period: the last one is cut, too. */
    s.u.pulse.width = 10;
    check_limits(&s, 4, 1, 1);
    check_limits(&s, 7, 1, 0);
}

END_TEST

START_TEST(test_counted_cycles) {
    struct dalcs_stimulus s = make_sine(1, 2, 0.5, 1, 0, 0);
    s.u.sine.n_cycles = 1.25;
    ck_assert_double_eq(dalcs_stimulus_next_edge(&s, 1), 3.5);
    ck_assert(isinf(dalcs_stimulus_next_edge(&s, 3.5)));
    check_limits(&s, 1.5, 3, 3);
    check_limits(&s, 2.5, -1, -1);
    check_limits(&s, 3.5, 3, 3);
    check_limits(&s, 100, 3, 3);
}

END_TEST

START_TEST(test_repeated_points) {
    const double time[] = {0, 1, 1, 2, 3};
    const double value[] = {0, 1, 4, 6, 5};
    struct dalcs_stimulus s = make_pwl(time, value, 5);
    s.u.pwl.repeats = true;
    s.u.pwl.repeat_from = 1;
    const double edge[] = {1, 2, 3, 4, 5, 6, 7};
    double t = 0;
    for (size_t k = 0; k < sizeof edge / sizeof edge[0]; k++) {
        t = dalcs_stimulus_next_edge(&s, t);
        ck_assert_double_eq(t, edge[k]);
    }
    check_limits(&s, 1, 1, 4);
    check_limits(&s, 3, 5, 4);
    check_limits(&s, 4, 6, 6);
    check_limits(&s, 1000.5, 5.5, 5.5);
    check_limits(&s, 1001, 5, 4);
    /* A million times, at times computed in other ways than the edge itself. */
    const double fine[] = {0, 1e-6, 4e-6};
    const double triangle[] = {0, 3, 0};
    s = make_pwl(fine, triangle, 3);
    s.u.pwl.repeats = true;
    for (long n = 1; n < 1000000; n += n < 1000 ? 1 : 997) {
        const double at = (double)n * 4e-6;
        ck_assert_double_eq(dalcs_stimulus_value(&s, at, DALCS_LEFT), 0);
        ck_assert_double_eq(dalcs_stimulus_value(&s, (double)n / 250000, DALCS_RIGHT), 0);
        ck_assert_double_eq_tol(dalcs_stimulus_next_edge(&s, at), at + 1e-6, 8 * DBL_EPSILON * at);
    }
}

END_TEST

static double piece_value(const struct dalcs_stimulus_piece *piece, double tau) {
    double value = piece->level + (tau > 0 ? piece->slope * tau : 0);
    for (int k = 0; k < piece->n_terms; k++) {
        const struct dalcs_stimulus_term *term = &piece->term[k];
        value += exp(-term->decay * tau) *
                 (term->cosine * cos(term->omega * tau) + term->sine * sin(term->omega * tau));
    }
    return value;
}

/* From t to the next edge, its limits included. */
static void check_piece(const struct dalcs_stimulus *s, double t,
                        const struct dalcs_stimulus_piece *first) {
    struct dalcs_stimulus_term term[3];
    struct dalcs_stimulus_piece piece = {.term = term};
    dalcs_stimulus_piece_at(s, t, &piece);
    ck_assert_double_eq(piece.to, dalcs_stimulus_next_edge(s, t));
    ck_assert_int_eq(piece.n_terms, first->n_terms);
    for (int k = 0; k < piece.n_terms; k++) {
        ck_assert_double_eq(piece.term[k].decay, first->term[k].decay);
        ck_assert_double_eq(piece.term[k].omega, first->term[k].omega);
    }
    const double length = isinf(piece.to) ? 1 : piece.to - t;
    for (int k = 0; k <= 16; k++) {
        const double tau = k * length / 16;
        const bool is_end = k == 16 && !isinf(piece.to);
        const double expected =
            dalcs_stimulus_value(s, is_end ? piece.to : t + tau, k == 0 ? DALCS_RIGHT : DALCS_LEFT);
        ck_assert_msg(fabs(piece_value(&piece, tau) - expected) <= 1e-9 * (1 + fabs(expected)),
                      "kind %d from %.17g, after %.17g: %.17g, not %.17g", (int)s->kind, t, tau,
                      piece_value(&piece, tau), expected);
    }
}

START_TEST(test_pieces) {
    for (int trial = 0; trial < 2400; trial++) {
        const struct dalcs_stimulus s = random_stimulus(trial % 8);
        struct dalcs_stimulus_term term[3];
        struct dalcs_stimulus_piece first = {.term = term};
        dalcs_stimulus_piece_at(&s, 0, &first);
        double t = 0;
        for (int k = 0; k < 20 && isfinite(t); k++) {
            const double next = dalcs_stimulus_next_edge(&s, t);
            const double end = isinf(next) ? t + 1 : next;
            check_piece(&s, t, &first);
            check_piece(&s, t + uniform(0.1, 0.9) * (end - t), &first);
            t = next;
        }
    }
    const struct dalcs_stimulus dc = {.kind = DALCS_STIMULUS_DC, .dc = 3};
    struct dalcs_stimulus_term term[3];
    struct dalcs_stimulus_piece piece = {.term = term};
    dalcs_stimulus_piece_at(&dc, 2, &piece);
    ck_assert(piece.level == 3 && piece.slope == 0 && piece.n_terms == 0 && isinf(piece.to));
}

END_TEST

/* The pieces themselves: a ramp, a jump at its end, a sine before and after its delay. */
START_TEST(test_known_pieces) {
    struct dalcs_stimulus s = make_pulse(1, 3, 0.5, 0.25, 0, 1, 4);
    struct dalcs_stimulus_term term[3];
    struct dalcs_stimulus_piece piece = {.term = term};
    dalcs_stimulus_piece_at(&s, 0.5, &piece);
    ck_assert(piece.level == 1 && piece.slope == 8 && piece.to == 0.75);
    dalcs_stimulus_piece_at(&s, 0.75, &piece);
    ck_assert(piece.level == 3 && piece.slope == 0 && piece.to == 1.75);
    dalcs_stimulus_piece_at(&s, 1.75, &piece);
    ck_assert(piece.level == 1 && piece.slope == 0 && piece.to == 4.5);
    s = make_sine(1, 2, 0.25, 3, 0.5, 90);
    dalcs_stimulus_piece_at(&s, 1, &piece);
    ck_assert(piece.level == 3 && piece.term[0].cosine == 0 && piece.term[0].sine == 0);
    ck_assert(piece.to == 3 && piece.term[0].decay == 0.5);
    dalcs_stimulus_piece_at(&s, 3, &piece);
    ck_assert(piece.level == 1 && piece.term[0].cosine == 2 && isinf(piece.to));
    ck_assert_double_eq_tol(piece.term[0].omega, PI / 2, 1e-15);
}

END_TEST

static double edge_of_all(const struct dalcs_stimulus *s, int n, double t) {
    double next = INFINITY;
    for (int k = 0; k < n; k++) {
        next = fmin(next, dalcs_stimulus_next_edge(&s[k], t));
    }
    return next;
}

/* What was kept of several stimuli is what they say: on edges, between them, going on and back. */
START_TEST(test_edges_ahead) {
    for (int trial = 0; trial < 300; trial++) {
        struct dalcs_stimulus s[8];
        for (int k = 0; k < 8; k++) {
            s[k] = random_stimulus(k % 3 == 0 ? 0 : 1 + k % 2);
        }
        struct dalcs_edges_ahead ahead;
        ck_assert_int_eq(dalcs_edges_ahead_of_all(&ahead, s, 8), DALCS_OK);
        double t = 0;
        for (int k = 0; k < 60; k++) {
            const double next = edge_of_all(s, 8, t);
            ck_assert_double_eq(dalcs_edges_ahead_after(&ahead, t), next);
            const double end = isinf(next) ? t + 1 : next;
            const double way = uniform(0, 1);
            t = way < 0.2 ? uniform(0.5, 1) * t : way < 0.6 ? end : t + uniform(0, 2) * (end - t);
            t = way > 0.9 ? end * (1 - DBL_EPSILON) : t; /* a rounding before it */
        }
        dalcs_edges_ahead_finish(&ahead);
    }
}

END_TEST

/* A gate goes on writing: an edge that comes later is seen, though there was none when it was asked first. */
START_TEST(test_edges_written) {
    const double time[] = {0, 2, 2};
    const double value[] = {0, 0, 1};
    struct dalcs_stimulus s = make_pwl(time, value, 1);
    s.is_written = true;
    struct dalcs_edges_ahead ahead;
    ck_assert_int_eq(dalcs_edges_ahead_of_all(&ahead, &s, 1), DALCS_OK);
    ck_assert(isinf(dalcs_edges_ahead_after(&ahead, 0)));
    s.u.pwl.n = 3;
    ck_assert_double_eq(dalcs_edges_ahead_after(&ahead, 1), 2);
    dalcs_edges_ahead_finish(&ahead);
}

END_TEST

RUN_TESTS("stimulus pieces", test_contract, test_counted_pulses, test_counted_cycles,
          test_repeated_points, test_pieces, test_known_pieces, test_edges_ahead,
          test_edges_written)
