/* test_circuit_cards.c - what the cards of elements and models become. */
#include "built_circuit.h"

#include <math.h>

static void check_nodes(const struct dalcs_device *device, const char *a, const char *b) {
    ck_assert_str_eq(circuit.node_name[device->node[0]], a);
    ck_assert_str_eq(circuit.node_name[device->node[1]], b);
}

/* Every element; models after their use; references forwards. */
START_TEST(test_elements) {
    build_good_circuit(&circuit, "Every element\n"
                                 "F1 0 a Vs 2.5\n"
                                 "H1 h GND Vs -3\n"
                                 "R1 a Out 4.7k\n"
                                 "R2 a out R = -1\n"
                                 "Rshort out b 0\n"
                                 "L1 b 0 10u IC=1m\n"
                                 "L2 h 0 L=1m\n"
                                 "C1 (out,0) 100n ic = -5\n"
                                 "K12 L2 L1 -0.99\n"
                                 "Vs a 0 DC 1.5\n"
                                 "I1 0 out 2m\n"
                                 "E1 e 0 (a b) 10\n"
                                 "G1 e 0 a,out 1m\n"
                                 "D1 a out\n"
                                 "D2 a out DZ off\n"
                                 "S1 a out e 0 SW1 ON\n"
                                 "S2 a out e 0 SW2\n"
                                 ".model SW1 SW(Ron=10m Roff=1Meg Vt=1 Vh=0.25)\n"
                                 ".model DZ D(Ron=1 Vfwd=0.7 Vrev=5.1)\n"
                                 ".model SW2 SW\n"
                                 ".model DI D()\n"
                                 ".tran 1u 1m 2u 0.5u UIC\n"
                                 ".op\n");
    ck_assert_str_eq(circuit.title, "Every element");
    ck_assert_int_eq(circuit.n_nodes, 6);
    ck_assert_str_eq(circuit.node_name[0], "0");
    ck_assert_int_eq(circuit.n_devices, 16);
    const struct dalcs_device *d = device_named(&circuit, "f1");
    ck_assert_int_eq(d->kind, DALCS_CCCS);
    ck_assert_double_eq(d->value, 2.5);
    ck_assert_str_eq(circuit.device[d->control].name, "vs");
    ck_assert_int_eq(d->where.line, 2);
    ck_assert_str_eq(d->where.source_line, "F1 0 a Vs 2.5");
    ck_assert_str_eq(d->where.file, "t.cir");
    check_nodes(d, "0", "a");
    d = device_named(&circuit, "h1");
    ck_assert_int_eq(d->kind, DALCS_CCVS);
    check_nodes(d, "h", "0");
    d = device_named(&circuit, "r1");
    ck_assert_double_eq(d->value, 4700);
    ck_assert_int_eq(d->stimulus, -1);
    ck_assert_int_eq(d->model, -1);
    ck_assert_int_eq(d->control, -1);
    check_nodes(d, "a", "out");
    ck_assert_double_eq(device_named(&circuit, "r2")->value, -1);
    ck_assert_double_eq(device_named(&circuit, "rshort")->value, 0);
    d = device_named(&circuit, "l1");
    ck_assert_int_eq(d->kind, DALCS_INDUCTOR);
    ck_assert(d->has_initial);
    ck_assert_double_eq(d->initial, 1e-3);
    ck_assert(!device_named(&circuit, "l2")->has_initial);
    ck_assert_double_eq(device_named(&circuit, "l2")->value, 1e-3);
    d = device_named(&circuit, "c1");
    ck_assert_int_eq(d->kind, DALCS_CAPACITOR);
    ck_assert_double_eq(d->value, 100e-9);
    ck_assert_double_eq(d->initial, -5);
    check_nodes(d, "out", "0");
    d = device_named(&circuit, "vs");
    ck_assert_int_eq(circuit.stimulus[d->stimulus].kind, DALCS_STIMULUS_DC);
    ck_assert_double_eq(circuit.stimulus[d->stimulus].dc, 1.5);
    d = device_named(&circuit, "i1");
    ck_assert_double_eq(circuit.stimulus[d->stimulus].dc, 2e-3);
    d = device_named(&circuit, "e1");
    ck_assert_int_eq(d->node[2], node_named("a"));
    ck_assert_int_eq(d->node[3], node_named("b"));
    ck_assert_double_eq(d->value, 10);
    d = device_named(&circuit, "g1");
    ck_assert_int_eq(d->kind, DALCS_VCCS);
    ck_assert_int_eq(d->node[3], node_named("out"));

    ck_assert_int_eq(circuit.n_couplings, 1);
    ck_assert_str_eq(circuit.coupling[0].name, "k12");
    ck_assert_str_eq(circuit.device[circuit.coupling[0].inductor[0]].name, "l2");
    ck_assert_str_eq(circuit.device[circuit.coupling[0].inductor[1]].name, "l1");
    ck_assert_double_eq(circuit.coupling[0].k, -0.99);

    ck_assert(circuit.analyses.operating_point);
    ck_assert(circuit.analyses.transient.present);
    ck_assert(circuit.analyses.transient.use_initial_conditions);
    ck_assert_double_eq(circuit.analyses.transient.step, 1e-6);
    ck_assert_double_eq(circuit.analyses.transient.stop, 1e-3);
    ck_assert_double_eq(circuit.analyses.transient.start, 2e-6);
    ck_assert_double_eq(circuit.analyses.transient.max_step, 0.5e-6);
    dalcs_circuit_finish(&circuit);
    dalcs_circuit_finish(&circuit);
}

END_TEST

START_TEST(test_models) {
    build_good_circuit(&circuit, "models\n"
                                 "V1 a 0 1\n"
                                 "D1 a 0\n"
                                 "D2 a 0 di\n"
                                 "D3 a 0 full\n"
                                 "D4 a 0\n"
                                 "D5 a 0 ltspice\n"
                                 "S1 a 0 a 0 ideal\n"
                                 "S2 a 0 a 0 full2 off\n"
                                 ".model di D\n"
                                 ".model full D(Ron=1m Roff=1Meg Vfwd=0.7 Vrev=100 Rrev=2)\n"
                                 ".model ltspice D Ron=5m Roff=inf Vrev=inf Vfwd=-1 mfg=x\n"
                                 ".model ideal SW\n"
                                 ".model full2 SW ( Ron = 1m , Roff = 1Meg , Vt = -2 , Vh = 1 )\n"
                                 ".op\n");
    const struct dalcs_diode_model *m =
        &circuit.models.of_diode[device_named(&circuit, "d1")->model];
    ck_assert_double_eq(m->ron, 0);
    ck_assert(isinf(m->roff) && isinf(m->vrev));
    ck_assert_double_eq(m->vfwd, 0);
    ck_assert_int_eq(device_named(&circuit, "d4")->model, device_named(&circuit, "d1")->model);
    m = &circuit.models.of_diode[device_named(&circuit, "d2")->model];
    ck_assert_str_eq(m->name, "di");
    ck_assert_double_eq(m->ron, 0);
    ck_assert(isinf(m->roff) && isinf(m->vrev));
    m = &circuit.models.of_diode[device_named(&circuit, "d3")->model];
    ck_assert_double_eq(m->ron, 1e-3);
    ck_assert_double_eq(m->roff, 1e6);
    ck_assert_double_eq(m->vfwd, 0.7);
    ck_assert_double_eq(m->vrev, 100);
    ck_assert_double_eq(m->rrev, 2);
    m = &circuit.models.of_diode[device_named(&circuit, "d5")->model];
    ck_assert_double_eq(m->rrev, 5e-3); /* as Ron when left out */
    ck_assert_double_eq(m->vfwd, -1);
    ck_assert(isinf(m->roff) && isinf(m->vrev));

    const struct dalcs_device *s1 = device_named(&circuit, "s1");
    const struct dalcs_switch_model *w = &circuit.models.of_switch[s1->model];
    ck_assert_double_eq(w->ron, 0);
    ck_assert(isinf(w->roff));
    ck_assert_double_eq(w->vt, 0);
    ck_assert_double_eq(w->vh, 0);
    ck_assert(!s1->has_initial_state);
    const struct dalcs_device *s2 = device_named(&circuit, "s2");
    w = &circuit.models.of_switch[s2->model];
    ck_assert_double_eq(w->ron, 1e-3);
    ck_assert_double_eq(w->vt, -2);
    ck_assert_double_eq(w->vh, 1);
    ck_assert(s2->has_initial_state && !s2->initially_on);
    dalcs_circuit_finish(&circuit);
}

END_TEST

static const struct dalcs_stimulus *stimulus_of(const char *name) {
    return &circuit.stimulus[device_named(&circuit, name)->stimulus];
}

START_TEST(test_sources) {
    build_good_circuit(&circuit, "sources\n"
                                 "V1 a 0 SIN(1 2 50 1m 3 90)\n"
                                 "V2 b 0 dc=7 sine 0 5\n"
                                 "V3 c 0 PULSE 0 5\n"
                                 "I4 d 0 Pulse(1,2,3m,4u,5u,6u,70u) AC 1 0 DC 3\n"
                                 "V5 e 0 DC PWL (0 0\n"
                                 "+ 1m,5 1m 6\n"
                                 "+ 2m 7)\n"
                                 "V6 f 0 EXP(0 1 1m 2m)\n"
                                 "V7 g 0 PULSE(0 1 0 0 0 0 0)\n"
                                 "R1 a b 1\nR2 c d 1\nR3 e f 1\nR4 g a 1\n"
                                 ".tran 1u 20m\n");
    const struct dalcs_stimulus *s = stimulus_of("v1");
    ck_assert_int_eq(s->kind, DALCS_STIMULUS_SIN);
    ck_assert(!s->has_dc);
    ck_assert_double_eq(s->u.sine.offset, 1);
    ck_assert_double_eq(s->u.sine.amplitude, 2);
    ck_assert_double_eq(s->u.sine.frequency, 50);
    ck_assert_double_eq(s->u.sine.delay, 1e-3);
    ck_assert_double_eq(s->u.sine.damping, 3);
    ck_assert_double_eq(s->u.sine.phase, 90);
    s = stimulus_of("v2");
    ck_assert(s->has_dc);
    ck_assert_double_eq(s->dc, 7);
    ck_assert_double_eq(s->u.sine.frequency, 1 / 20e-3);
    s = stimulus_of("v3");
    ck_assert_double_eq(s->u.pulse.high, 5);
    ck_assert_double_eq(s->u.pulse.rise, 0);
    ck_assert(isinf(s->u.pulse.width) && isinf(s->u.pulse.period));
    s = stimulus_of("i4");
    ck_assert_int_eq(s->kind, DALCS_STIMULUS_PULSE);
    ck_assert_double_eq(s->dc, 3);
    ck_assert_double_eq(s->u.pulse.low, 1);
    ck_assert_double_eq(s->u.pulse.high, 2);
    ck_assert_double_eq(s->u.pulse.delay, 3e-3);
    ck_assert_double_eq(s->u.pulse.rise, 4e-6);
    ck_assert_double_eq(s->u.pulse.fall, 5e-6);
    ck_assert_double_eq(s->u.pulse.width, 6e-6);
    ck_assert_double_eq(s->u.pulse.period, 70e-6);
    s = stimulus_of("v5");
    ck_assert(!s->has_dc);
    ck_assert_int_eq(s->u.pwl.n, 4);
    ck_assert_double_eq(s->u.pwl.t[2], 1e-3);
    ck_assert_double_eq(s->u.pwl.v[1], 5);
    ck_assert_double_eq(s->u.pwl.v[2], 6);
    s = stimulus_of("v6");
    ck_assert_double_eq(s->u.exponential.rise_delay, 1e-3);
    ck_assert_double_eq(s->u.exponential.rise_tau, 2e-3);
    ck_assert(isinf(s->u.exponential.fall_delay));
    s = stimulus_of("v7"); /* a width of 0 is 0, a period of 0 is once */
    ck_assert_double_eq(s->u.pulse.width, 0);
    ck_assert(isinf(s->u.pulse.period));
    dalcs_circuit_finish(&circuit);
}

END_TEST

/* A coil of 0 H is a short, a capacitor of 0 F is open; both keep their names. */
START_TEST(test_no_states) {
    build_good_circuit(&circuit, "zeros\nV1 a 0 1\nL1 a b 0 ic=1\nC1 b 0 0\nR1 b 0 1\n.op\n");
    const struct dalcs_device *l1 = device_named(&circuit, "l1");
    ck_assert_int_eq(l1->kind, DALCS_RESISTOR);
    ck_assert_double_eq(l1->value, 0);
    ck_assert(!l1->has_initial);
    const struct dalcs_device *c1 = device_named(&circuit, "c1");
    ck_assert_int_eq(c1->kind, DALCS_ISOURCE);
    ck_assert_int_eq(circuit.stimulus[c1->stimulus].kind, DALCS_STIMULUS_DC);
    ck_assert_double_eq(circuit.stimulus[c1->stimulus].dc, 0);
    static const char *const wanted[] = {"v(a)", "v(b)", "i(v1)", "i(l1)"};
    check_signals(wanted, 4);
    dalcs_circuit_finish(&circuit);
}

END_TEST

/* Networks without a ground, with loops of short circuits and loose ends are ordinary input. */
START_TEST(test_unusual_networks) {
    build_good_circuit(&circuit, "no ground\nV1 a b 1\nR1 a b 1\n.op\n");
    ck_assert_int_eq(circuit.n_nodes, 3);
    dalcs_circuit_finish(&circuit);
    build_good_circuit(&circuit, "loops\nV1 a 0 1\nV2 a 0 1\nR1 a 0 0\nR2 a a 0\nD1 0 0\n.op\n");
    dalcs_circuit_finish(&circuit);
    build_good_circuit(&circuit, "one time\nV1 a 0 1\nR1 a 0 1\n.tran 5m\n");
    ck_assert_double_eq(circuit.analyses.transient.stop, 5e-3);
    ck_assert_double_eq(circuit.analyses.transient.step, 0);
    dalcs_circuit_finish(&circuit);
    build_good_circuit(&circuit, "perfect coils\nL1 a 0 1\nL2 b 0 4\nL3 c 0 9\nR1 a b 1\nR2 b c 1\n"
                                 "K1 L1 L2 1\nK2 L2 L3 -1\nK3 L1 L3 -1\nL4 d 0 1\nR4 d a 1\n.op\n");
    ck_assert_int_eq(circuit.n_couplings, 3);
    dalcs_circuit_finish(&circuit);
}

END_TEST

RUN_TESTS("circuit cards", test_elements, test_models, test_sources, test_no_states,
          test_unusual_networks)
