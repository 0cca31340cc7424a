/* test_recurrence.c - spans that recur are stepped at once, and only where nothing happens in them. Whatever
 * the steps, the waveforms are those of closed forms. */
#include "transition.h"

#include "run_radau.h"

#include <math.h>

static bool is_whole_span(void) {
    const struct dalcs_transition *known = dalcs_transition_known(r.part);
    return known->span.brief != NULL && r.part->segment.h == known->span.length &&
           r.part->segment.end == 1.0;
}

/* A step that was enough for another segment is for this, up to whatever ends it. */
static bool is_known_step(void) {
    const struct dalcs_transition *known = dalcs_transition_known(r.part);
    return r.part->segment.brief != NULL && r.part->segment.brief == known->step.brief;
}

/* A chopper feeds a motor, whose voltage rises for a while: a little, so that its current only moves to
 * another mean, or so much that it ends in each period. */
static const double period = 100e-6, on = 40e-6, supply = 24.0, resistance = 1.0, inductance = 2e-3;
static const double rises = 5.013e-3, falls = 10.017e-3, motor_stop = 15e-3;

#define CHOPPER(voltages)                                                                          \
    "chopper\nV1 in 0 24\nVg g 0 PULSE(0 1 0 0 0 40u 100u)\nS1 in a g 0 sm\nD1 0 a\n"              \
    "L1 a b 2m\nR1 b c 1\nVe c 0 PULSE(" voltages " 5.013m 0 0 5.004m 1k)\n"                       \
    ".model sm SW(Vt=0.5)\n.tran 1u 15m uic\n"

/* The current after a time at a voltage, which a diode keeps from turning. *ends: it becomes 0 then. */
static double after(double i, double volts, double time, bool is_diode, bool *ends) {
    double final = volts / resistance;
    double later = final + (i - final) * exp(-time * resistance / inductance);
    *ends = is_diode && i > 0.0 && later < 0.0;
    return is_diode && later < 0.0 ? 0.0 : later;
}

/* The current at t, and how often it has ended. */
static double motor_current(double time, double low, double high, int *n_ended) {
    double i = 0.0;
    *n_ended = 0;
    for (double from = 0.0; from < time;) {
        double phase = from - period * floor(from / period + 1e-9);
        bool is_on = phase < on * (1.0 - 1e-9);
        bool is_high = from >= rises * (1.0 - 1e-9) && from < falls * (1.0 - 1e-9);
        double to = from - phase + (is_on ? on : period);
        to = fmin(to, is_high ? falls : from < falls ? rises : INFINITY);
        to = to > from ? to : from - phase + (is_on ? on : period);
        bool ends;
        double volts = (is_on ? supply : 0.0) - (is_high ? high : low);
        i = after(i, volts, fmin(to, time) - from, !is_on, &ends);
        *n_ended += ends ? 1 : 0;
        from = to;
    }
    return i;
}

/* Walks to the end; the numbers of segments by a recurring span before, in and after the rise. How many, instead, were
 * by a step that had been enough before? */
static int walk_motor(double low, double high, int n_spans[3]) {
    bool happens;
    int n_events = 0;
    int n_steps = 0;
    n_spans[0] = n_spans[1] = n_spans[2] = 0;
    for (double to; (to = dalcs_radau_next_stop(&r, &happens)) < motor_stop;) {
        int which = to <= rises ? 0 : to <= falls ? 1 : 2;
        n_spans[which] += is_whole_span() ? 1 : 0;
        n_steps += is_known_step() ? 1 : 0;
        n_events += r.part->segment.why == DALCS_END_AT_EVENT ? 1 : 0;
        ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
        int n_ended;
        double exact = motor_current(r.part->segment.t, low, high, &n_ended);
        ck_assert_msg(fabs(r.part->x[0] - exact) < 2e-9, "%.17g instead of %.17g at %g",
                      r.part->x[0], exact, r.part->segment.t);
    }
    int n_ended;
    (void)motor_current(motor_stop, low, high, &n_ended);
    ck_assert_int_eq(n_events, n_ended);
    return n_steps;
}

/* Two spans in each of 50 periods before, in and after the rise. Its edges cut one short, which is then
 * counted anew. */
START_TEST(test_spans) {
    int n[3];
    start(CHOPPER("5 6"), motor_stop);
    int n_steps = walk_motor(5.0, 6.0, n);
    ck_assert_int_lt(n_steps, 20);
    ck_assert_msg(n[0] > 60 && n[1] > 75 && n[2] > 75, "%d, %d, %d", n[0], n[1], n[2]);
    finish();
}

END_TEST

/* No span hides an event: that of the diode is left alone as long as the current ends in it; of three segments in
 * a period two may recur. That event ends a step that is the same in each of 50 periods. */
START_TEST(test_events) {
    int n[3];
    start(CHOPPER("5 12"), motor_stop);
    int n_steps = walk_motor(5.0, 12.0, n);
    ck_assert_msg(n[0] > 60 && n[1] <= 100 && n[2] > 60, "%d, %d, %d", n[0], n[1], n[2]);
    ck_assert_int_gt(n_steps, 40);
    finish();
}

END_TEST

/* After 1e5 periods times have lost five digits, but a span is still as long as the first one was: the current
 * at the start of a period is that of the periodic solution. */
START_TEST(test_long_run) {
    const double last = of_cases(99999, 9999) * period;
    const double tau = inductance / resistance;
    const double e_on = exp(-on / tau);
    const double e_off = exp(-(period - on) / tau);
    const double exact =
        ((1.0 - e_on) * (supply - 5.0) * e_off - (1.0 - e_off) * 5.0) / (1.0 - e_on * e_off);
    start(CHOPPER("5 6"), 10.0);
    walk_to(last + 1e-9);
    ck_assert_double_eq_tol(r.part->segment.t, last, 1e-12);
    ck_assert_msg(fabs(r.part->x[0] - exact) < 1e-11, "%.17g instead of %.17g", r.part->x[0],
                  exact);
    finish();
}

END_TEST

/* Two switches by turns carry charge from a source to a load: at each of their moves a voltage jumps, which
 * no step may pass over. */
START_TEST(test_jumps) {
    const double stop = 10e-3;
    double v1 = 0.0;
    double v2 = 0.0;
    start("charge pump\nV1 in 0 10\nVg g 0 PULSE(0 1 0 0 0 50u 100u)\nVh h 0 PULSE(1 0 0 0 0 50u "
          "100u)\n"
          "S1 in a g 0 sm\nS2 a b h 0 sm\nC1 a 0 1u\nC2 b 0 3u\nR2 b 0 100\n"
          ".model sm SW(Vt=0.5)\n.tran 1u 10m uic\n",
          stop);
    bool happens;
    for (double to; (to = dalcs_radau_next_stop(&r, &happens)) < stop;) {
        bool was_apart = fmod(r.part->segment.t + 1e-9, 100e-6) < 50e-6;
        double tau = was_apart ? 300e-6 : 400e-6;
        v1 = was_apart ? 10.0 : v1;
        v2 *= exp(-(to - r.part->segment.t) / tau);
        v1 = was_apart ? v1 : v2;
        bool is_move = r.part->segment.why == DALCS_END_AT_EDGE;
        ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
        if (is_move && was_apart) {
            v1 = v2 = (v1 + 3.0 * v2) / 4.0;
        }
        ck_assert_msg(fabs(r.part->x[1] - v2) < 1e-8, "%.17g instead of %.17g at %g", r.part->x[1],
                      v2, r.part->segment.t);
    }
    finish();
}

END_TEST

/* Most spans have no rows; the waveforms of one can be computed all the same. */
START_TEST(test_inside) {
    bool happens;
    int n_asked = 0;
    start(CHOPPER("5 6"), motor_stop);
    for (double to; (to = dalcs_radau_next_stop(&r, &happens)) < rises;) {
        double inside = 0.7 * r.part->segment.t + 0.3 * to;
        int n_ended;
        if (is_whole_span() && ++n_asked % 3 == 0) {
            ck_assert_int_eq(dalcs_radau_evaluate(&r, inside, DALCS_LEFT), DALCS_OK);
            ck_assert_double_eq_tol(r.part->component->y[0],
                                    motor_current(inside, 5.0, 6.0, &n_ended), 2e-9);
        }
        if (n_asked == 50) {
            break;
        }
        ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
    }
    ck_assert_int_eq(n_asked, 50);
    finish();
}

END_TEST

/* Each period charges a capacitor a little, and in the 1348th it moves a switch. */
START_TEST(test_watched) {
    const double tau = 100e-3;
    const double charging = tau * log(24.0 / (24.0 - 10.0)); /* until there are 10 V */
    const double exact = floor(charging / on) * period + fmod(charging, on);
    start("charger\nV1 in 0 24\nVg g 0 PULSE(0 1 0 0 0 40u 100u)\nS1 in a g 0 sm\nR1 a b 10k\n"
          "C1 b 0 10u\nS2 b c b 0 sh\nR2 c 0 1k\n.model sm SW(Vt=0.5)\n"
          ".model sh SW(Vt=6 Vh=4)\n.tran 1u 200m uic\n",
          200e-3);
    bool happens;
    int n_spans = 0;
    double event = 0.0;
    for (double to; event == 0.0 && (to = dalcs_radau_next_stop(&r, &happens)) < 200e-3;) {
        n_spans += is_whole_span() ? 1 : 0;
        event = r.part->segment.why == DALCS_END_AT_EVENT ? to : 0.0;
        ck_assert_int_eq(dalcs_radau_pass(&r, to), DALCS_OK);
    }
    ck_assert_double_eq_tol(event, exact, 1e-12);
    ck_assert_int_gt(n_spans, 2400);
    finish();
}

END_TEST

RUN_TESTS("recurrence", test_spans, test_events, test_long_run, test_jumps, test_inside,
          test_watched)
