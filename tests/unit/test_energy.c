/* test_energy.c - the ledger adds up to rounding with both methods, whatever the step, and does not
 * when a term of it is wrong. */
#include "energy.h"

#include "build_network.h"
#include "session_internal.h"

#include <math.h>
#include <stdio.h>

static struct text_network t;
static struct dalcs_euler e;
static struct dalcs_radau r;
static struct dalcs_energy energy;

/* All families, with jumps, thresholds, breakdown, switches on and off, a gate with a load of its own,
 * coupled coils, a supply that sources alone decide and that current sources take from, and a part
 * without memory. */
static const char ALL[] = "all families\n"
                          "V1 in 0 SIN(1 10 1k)\n"
                          "R1 in a 10\n"
                          "D1 a b DF\n"
                          "D2 0 b DZ\n"
                          "C1 b 0 1u IC=1\n"
                          "L1 b c 1m IC=0.01\n"
                          "L2 d 0 4m\n"
                          "K1 L1 L2 0.5\n"
                          "R2 d 0 50\n"
                          "S1 c 0 g 0 SW\n"
                          "D3 c b DF\n"
                          "Vg g 0 PULSE(0 1 10u 1u 1u 0.3m 0.5m)\n"
                          "Rg g 0 1k\n"
                          "I1 0 b PULSE(0 5m 0 0.1m 0.1m 0.1m 0.6m)\n"
                          "I2 0 b SIN(0 3m 700)\n"
                          "I3 b 0 1m\n"
                          "V0 b m 0\n"
                          "R3 m 0 1k\n"
                          "E1 x 0 b 0 0.5\n"
                          "R4 x y 100\n"
                          "C2 y 0 1u\n"
                          "G1 0 y in 0 1m\n"
                          "F1 0 y V0 0.2\n"
                          "H1 w 0 V0 20\n"
                          "R5 w y 200\n"
                          "V3 s 0 3\n"
                          "R8 s 0 100\n"
                          "I5 s b SIN(0 2m 900)\n"
                          "I6 s b 0.5m\n"
                          "V2 p 0 SIN(0 2 300)\n"
                          "R6 p q 3\n"
                          "R7 q 0 4\n"
                          "I4 0 q EXP(0 1 0.2m 0.1m)\n"
                          ".model DF D(Ron=0.1 Vfwd=0.6 Roff=1meg)\n"
                          ".model DZ D(Ron=0.2 Vrev=6 Rrev=2)\n"
                          ".model SW SW(Ron=0.5 Roff=1meg Vt=0.5)\n"
                          ".tran 10u 2m uic\n";

static void prepare(const char *text, double h, double stop) {
    build_good_network(&t, text);
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    ck_assert_int_eq(dalcs_euler_setup(&e, &t.circuit, &t.network, &options, h, stop), DALCS_OK);
    e.listener.detects_jumps = true;
}

static void run_euler(const char *text, double h, double stop) {
    prepare(text, h, stop);
    ck_assert_int_eq(dalcs_energy_setup(&energy, &e, NULL), DALCS_OK);
    ck_assert_int_eq(dalcs_euler_start(&e, t.network.initial), DALCS_OK);
    while (!dalcs_grid_at_end(&e.grid)) {
        ck_assert_int_eq(dalcs_euler_step(&e), DALCS_OK);
        if (e.at_jump && !dalcs_grid_at_end(&e.grid)) {
            ck_assert_int_eq(dalcs_euler_cross(&e), DALCS_OK);
        }
    }
    ck_assert_int_eq(dalcs_energy_close(&energy, &e, NULL), DALCS_OK);
}

static void run_radau(const char *text, int stages, double fixed_step, double stop) {
    prepare(text, stop, stop);
    const struct dalcs_osnsp_options options = usual_osnsp_options();
    const struct dalcs_radau_options o = {
        .tolerance = 1e-6, .stages = stages, .fixed_step = fixed_step, .stop = stop};
    ck_assert_int_eq(dalcs_radau_setup(&r, &e, &o, &options), DALCS_OK);
    ck_assert_int_eq(dalcs_energy_setup(&energy, &e, &r), DALCS_OK);
    dalcs_radau_start(&r, t.network.initial);
    ck_assert_int_eq(dalcs_radau_begin(&r), DALCS_OK);
    bool happens;
    for (double at = 0.0; (at = dalcs_radau_next_stop(&r, &happens)) < stop;) {
        ck_assert_int_eq(dalcs_radau_pass(&r, at), DALCS_OK);
    }
    ck_assert_int_eq(dalcs_energy_close(&energy, &e, &r), DALCS_OK);
}

static void finish(void) {
    dalcs_energy_finish(&energy);
    dalcs_radau_finish(&r);
    dalcs_euler_finish(&e);
    text_network_finish(&t);
}

/* Every account has something in it, and together they are 0. */
static void check_balance(void) {
    for (int a = 0; a < DALCS_POWER_STORED; a++) {
        ck_assert(fabs(energy.sum.account[a]) > 1e-3 * energy.sum.turnover);
    }
    ck_assert(fabs(energy.sum.stored_change) > 1e-6 * energy.sum.turnover);
    double balance = dalcs_energy_balance(&energy);
    ck_assert_msg(fabs(balance) <= 1e-13 * energy.sum.turnover, "off by %g of %g", balance,
                  energy.sum.turnover);
    ck_assert(energy.sum.rounding <= 1e-7 * energy.sum.turnover);
}

START_TEST(test_radau) {
    static const int STAGES[] = {1, 3, 5, 7, 9};
    for (int k = 0; k < 4; k++) {
        run_radau(ALL, STAGES[k], 2e-6, 2e-3);
        check_balance();
        finish();
        if (STAGES[k] > 1) {
            run_radau(ALL, STAGES[k], 0.0, 2e-3);
            check_balance();
            ck_assert(fabs(energy.sum.method) <= 1e-5 * energy.sum.turnover);
            finish();
        }
    }
}

END_TEST

START_TEST(test_euler) {
    run_euler(ALL, 1e-6, 2e-3);
    check_balance();
    double loss = energy.sum.method;
    finish();
    run_euler(ALL, 2e-6, 2e-3);
    check_balance();
    ck_assert(energy.sum.method > 1.5 * loss && energy.sum.method < 2.5 * loss);
    finish();
}

END_TEST

/* Both methods mean the same circuit. */
START_TEST(test_methods_agree) {
    run_euler(ALL, 1e-7, 2e-3);
    const struct dalcs_energy first = energy;
    finish();
    run_radau(ALL, 0, 0.0, 2e-3);
    for (int a = 0; a < DALCS_POWER_STORED; a++) {
        ck_assert_double_eq_tol(energy.sum.account[a], first.sum.account[a],
                                2e-3 * energy.sum.turnover);
    }
    ck_assert_double_eq_tol(energy.sum.stored_change, first.sum.stored_change,
                            2e-3 * energy.sum.turnover);
    finish();
}

END_TEST

/* States that go elsewhere without a jump, by more than the tolerance explains. */
START_TEST(test_a_lost_state_shows) {
    static const char RC[] = "rc\nV1 a 0 5\nR1 a b 1k\nC1 b 0 1u IC=1\n.tran 10u 1m uic\n";
    run_radau(RC, 7, 0.0, 1e-3);
    ck_assert_double_eq(dalcs_energy_unexplained(&energy, &r), 0.0);
    const double allowed = 1e5 * r.inner_tolerance * energy.sum.turnover;
    const double after = r.part[0].x[0];
    const double change = 0.7 * allowed; /* to `after`, J */
    r.part[0].x[0] = sqrt(after * after - 2.0 * change / 1e-6);
    energy.observer.move(&energy, 0, r.part[0].x, &after);
    energy.sum.stored_change += change;
    ck_assert_double_eq(dalcs_energy_unexplained(&energy, &r), 0.0);
    energy.observer.move(&energy, 0, r.part[0].x, &after);
    energy.sum.stored_change += change;
    ck_assert_double_eq_tol(dalcs_energy_unexplained(&energy, &r), 2.0 * change, 1e-3 * change);
    ck_assert_double_eq(dalcs_energy_unexplained(&energy, NULL), 0.0); /* the balance is still 0 */
    energy.sum.stored_change += change;
    ck_assert_double_eq_tol(dalcs_energy_unexplained(&energy, NULL), -change, 1e-3 * change);
    finish();
}

END_TEST

/* What rounding may leave of a balance is a part of what is moved, whatever the resistance of an open switch: its current is known
 * to rounding of itself. */
START_TEST(test_open_switches_hide_nothing) {
    static const double RON[] = {0.0, 1e-3, 1.0};
    static const double ROFF[] = {1e6, 1e9, 1e12, 1e15};
    for (int method = 0; method < 2; method++) {
        for (int k = 0; k < 12; k++) {
            char text[400];
            (void)snprintf(text, sizeof text,
                           "a chopper\nV1 a 0 10\nS1 a x g 0 SW\nD1 0 x DI\nL1 x y 1m IC=1\n"
                           "R1 y 0 5\nVg g 0 PULSE(0 1 0 1n 1n 5u 10u)\n.model DI D(Ron=0)\n"
                           ".model SW SW(Ron=%g Roff=%g Vt=0.5)\n.tran 1u 100u uic\n",
                           RON[k % 3], ROFF[k / 3]);
            if (method == 0) {
                run_euler(text, 1e-7, 1e-4);
            } else {
                run_radau(text, 7, 0.0, 1e-4);
            }
            ck_assert_double_eq(dalcs_energy_unexplained(&energy, method == 0 ? NULL : &r), 0.0);
            ck_assert_msg(energy.sum.rounding < 1e-7 * energy.sum.turnover,
                          "rounding hides %g of %g with %g and %g ohm", energy.sum.rounding,
                          energy.sum.turnover, RON[k % 3], ROFF[k / 3]);
            finish();
        }
    }
}

END_TEST

/* A channel that conducts at the start of a run charges its capacitor in no time that a micro-step sees, but in a time: sources do
 * no work in a jump that does not happen. C v^2 comes from the source, half of it stays. */
START_TEST(test_no_work_without_a_jump) {
    run_radau("a sampled voltage\nV1 s 0 -400\nVg g 0 PWL(0 -804 10u -804 10u 0)\nM1 d g s 0 MX\n"
              "C1 d 0 1p\n.model MX PMOS(Vto=-4 Kp=0.5 W=1 L=1 Rd=0)\n.tran 1u 40u uic\n",
              7, 0.0, 40e-6);
    ck_assert_double_eq(dalcs_energy_unexplained(&energy, &r), 0.0);
    ck_assert_double_eq_tol(energy.sum.account[DALCS_POWER_SOURCES], 1.6e-7, 1e-12);
    ck_assert_double_eq_tol(energy.sum.stored_change, 0.8e-7, 1e-12);
    finish();
}

END_TEST

/* Any resistor, threshold or source that is a hundredth wrong shows. */
START_TEST(test_a_wrong_term_shows) {
    for (int method = 0; method < 2; method++) {
        for (int k = 0; true; k++) {
            struct dalcs_session *session;
            struct dalcs_run_options options = dalcs_run_options_default();
            const struct dalcs_sink sink = {0};
            options.method = method == 0 ? "euler" : "radau";
            options.energy = true;
            ck_assert_int_eq(dalcs_session_create(&session), DALCS_OK);
            ck_assert_int_eq(dalcs_session_read_text(session, "all", ALL, sizeof ALL - 1),
                             DALCS_OK);
            const struct dalcs_power *power = &session->network.power[0];
            bool done = k == power->n;
            bool is_small = true; /* Roff, and what hardly conducts */
            if (!done) {
                is_small = power->term[k].factor == DALCS_POWER_SQUARE &&
                           fabs(power->term[k].coefficient) < 1e-5;
                power->term[k].coefficient *= 1.01;
            }
            enum dalcs_status status = dalcs_session_run(session, &options, &sink);
            const struct dalcs_report *report = dalcs_session_report(session);
            ck_assert(report->energy.present);
            ck_assert_msg(status == (done || is_small ? status : DALCS_E_INTERNAL),
                          "term %d of account %d, method %d: balance %g", k,
                          done ? -1 : (int)power->term[k].account, method, report->energy.balance);
            if (done) {
                ck_assert_int_eq(status, DALCS_OK);
            }
            if (status == DALCS_E_INTERNAL) {
                size_t n = dalcs_session_n_messages(session);
                enum dalcs_level level;
                const char *text = dalcs_session_message(session, n - 1, &level);
                ck_assert_int_eq(level, DALCS_LEVEL_ERROR);
                ck_assert_ptr_nonnull(strstr(text, "internal error: the energy balance is off"));
            }
            dalcs_session_destroy(session);
            if (done) {
                break;
            }
        }
    }
}

END_TEST

RUN_TESTS("energy", test_radau, test_euler, test_methods_agree, test_a_lost_state_shows,
          test_open_switches_hide_nothing, test_no_work_without_a_jump, test_a_wrong_term_shows)
