/* test_circuit.c - cards to devices: values, nodes, references, signals. */
#include "built_circuit.h"

#include <stdio.h>

static struct dalcs_diag diag;

START_TEST(test_signals) {
    static const char netlist[] = "signals\n"
                                  "D1 b c\n"
                                  "V1 a 0 1\n"
                                  "R1 a b 1\n"
                                  "L1 c 0 1\n"
                                  "C1 c gnd 1\n"
                                  "S1 c 0 a 0 SW\n"
                                  "E1 e 0 a 0 1\n"
                                  "H1 h 0 V1 1\n"
                                  "G1 0 e a 0 1\n"
                                  "F1 0 h V1 1\n"
                                  "I1 0 c 1\n"
                                  ".model SW SW\n"
                                  ".tran 1 2\n";
    build_good_circuit(&circuit, netlist);
    static const char *const by_default[] = {"v(b)",  "v(c)",  "v(a)",  "v(e)",  "v(h)", "i(d1)",
                                             "i(v1)", "i(l1)", "i(s1)", "i(e1)", "i(h1)"};
    check_signals(by_default, 11);
    ck_assert_int_eq(circuit.results.signal[2].kind, DALCS_SIGNAL_VOLTAGE);
    ck_assert_int_eq(circuit.results.signal[2].node[0], node_named("a"));
    ck_assert_int_eq(circuit.results.signal[2].node[1], 0);
    ck_assert_int_eq(circuit.results.signal[2].device, -1);
    ck_assert_int_eq(circuit.results.signal[6].kind, DALCS_SIGNAL_CURRENT);
    ck_assert_str_eq(circuit.device[circuit.results.signal[6].device].name, "v1");
    dalcs_circuit_finish(&circuit);

    char named[1000];
    snprintf(named, sizeof named, "%s%s", netlist,
             ".save V(A) v(a,B) i(R1) v (0,c) b v(a)\n.print tran I(D1) v(a b)\n");
    build_good_circuit(&circuit, named);
    static const char *const wanted[] = {"v(a)", "v(a,b)", "i(r1)", "v(0,c)", "v(b)", "i(d1)"};
    check_signals(wanted, 6);
    ck_assert_int_eq(circuit.results.signal[1].node[1], node_named("b"));
    ck_assert_int_eq(circuit.results.signal[3].node[0], 0);
    dalcs_circuit_finish(&circuit);

    snprintf(named, sizeof named, "%s%s", netlist, ".save i(R1) v(c)\n.probe\n.save all\n");
    build_good_circuit(&circuit, named);
    ck_assert_int_eq(circuit.results.n_signals, 12);
    ck_assert_str_eq(circuit.results.signal[0].name, "i(r1)");
    ck_assert_str_eq(circuit.results.signal[2].name, "v(b)");
    dalcs_circuit_finish(&circuit);

    snprintf(named, sizeof named, "%s%s", netlist, "C2 a 0 1 Rser=1 Rpar=2\n.save i(*) alli\n");
    build_good_circuit(&circuit, named);
    static const char *const currents[] = {"i(d1)", "i(v1)", "i(r1)", "i(l1)", "i(c1)", "i(s1)",
                                           "i(e1)", "i(h1)", "i(g1)", "i(f1)", "i(i1)", "i(c2)"};
    check_signals(currents, 12);
    dalcs_circuit_finish(&circuit);

    snprintf(named, sizeof named, "%s%s", netlist, "C2 a 0 1 Rser=1\n.save v(*)\n");
    build_good_circuit(&circuit, named);
    static const char *const voltages[] = {"v(b)", "v(c)", "v(a)", "v(e)", "v(h)"};
    check_signals(voltages, 5);
    dalcs_circuit_finish(&circuit);

    snprintf(named, sizeof named, "%s%s", netlist, ".probe alli\n");
    build_good_circuit(&circuit, named);
    ck_assert_int_eq(circuit.results.n_signals, 16); /* 5 voltages and all elements */
    dalcs_circuit_finish(&circuit);
}

END_TEST

START_TEST(test_initial_conditions) {
    build_good_circuit(&circuit, "ic\n"
                                 ".ic v(b)=1 V(a,b) = -2.5 i(L1)=3\n"
                                 "+ v(b)=1 v(b,a)=2.5 v(0)=0\n"
                                 "V1 a 0 1\nR1 a b 1\nL1 b 0 1\n"
                                 ".tran 1 2 uic\n");
    ck_assert_int_eq(circuit.n_initial_conditions, 2);
    ck_assert_int_eq(circuit.initial_condition[0].node[0], node_named("b"));
    ck_assert_int_eq(circuit.initial_condition[0].node[1], 0);
    ck_assert_double_eq(circuit.initial_condition[0].value, 1);
    ck_assert_int_eq(circuit.initial_condition[1].node[1], node_named("b"));
    ck_assert_double_eq(circuit.initial_condition[1].value, -2.5);
    ck_assert_int_eq(circuit.initial_condition[1].where.line, 2);
    ck_assert(device_named(&circuit, "l1")->has_initial);
    ck_assert_double_eq(device_named(&circuit, "l1")->initial, 3);
    dalcs_circuit_finish(&circuit);
}

END_TEST

START_TEST(test_options) {
    build_good_circuit(&circuit, "options\nV1 a 0 1\nR1 a 0 1\n"
                                 ".options reltol=1e-5 abstol 1n vntol=2u gmin=1p method=Euler\n"
                                 ".opt step = 3u\n.op\n");
    ck_assert_double_eq(circuit.options.reltol, 1e-5);
    ck_assert_double_eq(circuit.options.abstol, 1e-9);
    ck_assert_double_eq(circuit.options.vntol, 2e-6);
    ck_assert_double_eq(circuit.options.step, 3e-6);
    ck_assert_str_eq(circuit.options.method, "euler");
    ck_assert_int_eq(circuit.options.method_where.column, 56);
    ck_assert_int_eq(circuit.options.stages, 0);
    ck_assert_double_eq(circuit.options.compress, 0);
    ck_assert_double_eq(circuit.options.fill, 0);
    ck_assert(!circuit.options.lines);
    dalcs_circuit_finish(&circuit);
    build_good_circuit(&circuit,
                       "options\nV1 a 0 1\nR1 a 0 1\n"
                       ".options method=radau stages=7 compress=1m fill=2u curve=lines\n.op\n");
    ck_assert_str_eq(circuit.options.method, "radau");
    ck_assert_int_eq(circuit.options.stages, 7);
    ck_assert_double_eq(circuit.options.compress, 1e-3);
    ck_assert_int_eq(circuit.options.compress_where.column, 41);
    ck_assert_double_eq(circuit.options.fill, 2e-6);
    ck_assert(circuit.options.lines);
    dalcs_circuit_finish(&circuit);
    build_good_circuit(&circuit, "options\nV1 a 0 1\nR1 a 0 1\n.options method=gear\n.op\n");
    ck_assert_ptr_null(circuit.options.method);
    ck_assert(!circuit.analyses.transient.present);
    dalcs_circuit_finish(&circuit);
}

END_TEST

/* All errors at once, sorted, and nothing to free. */
START_TEST(test_errors) {
    ck_assert_int_eq(build_circuit(&circuit, &diag,
                                   "errors\nR1 a 0 1,5\n.ic i(bb)=1\nD1 a 0 DX\n"
                                   "F1 a 0 V9 1\nC1 a 0 'x\n.tran 1 0\n"),
                     DALCS_E_NETLIST);
    static const int line[] = {2, 3, 4, 5, 6, 7};
    ck_assert_uint_eq(diag.n, 6);
    for (size_t k = 0; k < diag.n; k++) {
        ck_assert_int_eq(diag.item[k].severity, DALCS_ERROR);
        ck_assert_int_eq(diag.item[k].line, line[k]);
    }
    ck_assert_ptr_null(circuit.arena.head);
    ck_assert_ptr_null(circuit.device);
    ck_assert_int_eq(circuit.n_devices, 0);
    dalcs_diag_finish(&diag);
}

END_TEST

static size_t count_severity(const char *text, enum dalcs_severity severity) {
    const enum dalcs_status status = build_circuit(&circuit, &diag, text);
    size_t n = 0;
    for (size_t k = 0; k < diag.n; k++) {
        n += diag.item[k].severity == severity;
    }
    ck_assert(status == (diag.n_errors > 0 ? DALCS_E_NETLIST : DALCS_OK));
    dalcs_diag_finish(&diag);
    dalcs_circuit_finish(&circuit);
    return n;
}

/* A suffix is questioned where it is probably a slip, and only there. */
START_TEST(test_suffix_warnings) {
    static const struct {
        const char *card;
        size_t n_warnings;
    } table[] = {
        {"R1 a 0 1M", 1},           {"R1 a 0 1m", 0},
        {"R1 a 0 1mOhm", 0},        {"R1 a 0 10MOhm", 1},
        {"R1 a 0 1Meg", 0},         {"C1 a 0 1F", 1},
        {"C1 a 0 1f", 1},           {"C1 a 0 1fF", 0},
        {"C1 a 0 1farad", 1},       {"C1 a 0 1mF", 0},
        {"L1 a 0 1M", 0},           {"R1 a 0 1f", 0},
        {"I1 a 0 1A", 1},           {"I1 a 0 1amp", 1},
        {"I1 a 0 1aA", 0},          {"V1 a 0 SIN 0 1 1Mhz", 1},
        {"V1 a 0 SIN 0 1 1mhz", 1}, {"V1 a 0 SIN 0 1 1mHz", 0},
        {"V1 a 0 SIN 0 1 1M", 1},   {"V1 a 0 SIN 0 1 1MegHz", 0},
        {"R1 a 0 5x", 1},           {"R1 a 0 5mil", 1},
        {"V1 a 0 5V", 0},           {"R1 a 0 5", 0},
    };

    for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
        char text[100];
        snprintf(text, sizeof text, "t\n%s\nRx a 0 1\n.op\n", table[k].card);
        ck_assert_msg(count_severity(text, DALCS_WARNING) == table[k].n_warnings, "%s",
                      table[k].card);
    }
}

END_TEST

/* As ngspice and LTspice accept them. */
START_TEST(test_spellings) {
    build_good_circuit(&circuit, ".title A card as the title\n"
                                 "V1 in 0 5\n"
                                 "E1 e 0 in 0 2\n"
                                 "R1 e a RM 1k\n"
                                 "F1 in 0 E1 0.5\n"
                                 "D1 a 0 DM\n"
                                 "L1 a b 1m\n"
                                 "L2 b 0 1m\n"
                                 "K1 (L1 L2) .9\n"
                                 ".model RM RES TC1=0 TC2=0\n"
                                 ".model DM D(\n"
                                 "+ Vfwd=0.7\n"
                                 ")\n"
                                 ".param p={max(3,\n"
                                 "+ -5)} q = '1 +\n"
                                 "* a comment and a blank line\n"
                                 "\n"
                                 "+ p'\n"
                                 "R2 a 0 {\n"
                                 "+ p + 10*q}\n"
                                 ".save @d1[id] p(r1) @r1[i]\n"
                                 ".probe p(Vc1)\n"
                                 ".meas tran x FIND @d1[id]+v(a) AT 1m\n"
                                 ".tran 1u 2m\n");
    ck_assert_str_eq(circuit.title, "A card as the title");
    ck_assert_double_eq(circuit.device[2].value, 1000);
    ck_assert_str_eq(circuit.device[circuit.device[3].control].name, "e1");
    ck_assert_double_eq(circuit.models.of_diode[circuit.device[4].model].vfwd, 0.7);
    ck_assert_int_eq(circuit.n_couplings, 1);
    ck_assert_double_eq(circuit.device[7].value, 43);
    check_signals((const char *[]){"i(d1)", "i(r1)", "v(r1)", "v(a)"}, 4);
    ck_assert_int_eq(circuit.results.n_named, 2);
    ck_assert_int_eq(circuit.results.n_shown, 4); /* rows have what p(r1) is computed from */
    ck_assert_int_eq(circuit.results.n_computed, 1);
    ck_assert_str_eq(circuit.results.computed[0].name, "p(r1)");
    ck_assert_int_eq(circuit.results.computed[0].at, 1);
    ck_assert_int_eq(circuit.results.n_measures, 1);
    dalcs_circuit_finish(&circuit);
}

END_TEST

START_TEST(test_title_warnings) {
    ck_assert_uint_eq(count_severity(".title A\nR2 a 0 1\nR3 a 0 1\n.op\n", DALCS_WARNING), 0);
    ck_assert_uint_eq(count_severity("R1 a 0 1k\nR2 a 0 1\nR3 a 0 1\n.op\n", DALCS_WARNING), 1);
    ck_assert_uint_eq(count_severity(".op\nR2 a 0 1\nR3 a 0 1\n.op\n", DALCS_WARNING), 1);
    ck_assert_uint_eq(count_severity("* R1 a 0 1k\nR2 a 0 1\nR3 a 0 1\n.op\n", DALCS_WARNING), 0);
    ck_assert_uint_eq(
        count_severity("Rectifier number is 5\nR2 a 0 1\nR3 a 0 1\n.op\n", DALCS_WARNING), 0);
    ck_assert_uint_eq(count_severity("V1 and R1 of 5\nR2 a 0 1\nR3 a 0 1\n.op\n", DALCS_WARNING),
                      0);
}

END_TEST

RUN_TESTS("circuit", test_signals, test_initial_conditions, test_options, test_errors,
          test_suffix_warnings, test_spellings, test_title_warnings)
