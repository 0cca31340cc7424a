/* test_audit.c - the auditor accepts the exact waveform of a circuit, and finds each way to spoil it. */
#include "audit.h"

#include "build_network.h"
#include "run_tests.h"

#include <math.h>
#include <string.h>

/* Open up to 1 ms, then C1 charges through S1 and R1 with 10 us; D1 blocks all the time. */
static const char CHOPPER[] = "a capacitor behind a switch\n"
                              "V1 a 0 10\n"
                              "S1 a b g 0 SW\n"
                              "D1 0 b DI\n"
                              "R1 b c 9\n"
                              "C1 c 0 1u\n"
                              "Vg g 0 PULSE(0 1 1m 0 0 1m 4m)\n"
                              ".model SW SW(Ron=1 Vt=0.5)\n"
                              ".model DI D(Ron=0)\n"
                              ".tran 1u 2m uic\n";

static const double CLOSES = 1e-3, TAU = 10e-6, LONG = 20e-6;

enum fault {
    NONE,
    NUDGED,      /* the capacitor is 1e-7 of 10 V off from the event on */
    SLOW,        /* it charges by a millionth too slowly */
    LOST_GATE,   /* the switch stays open */
    EARLY_GATE,  /* it is closed before */
    LEAK,        /* the diode carries current in reverse */
    WRONG_SOURCE /* V1 is not 10 V */
};

static struct text_network t;
static enum fault fault;

static int device(const char *name) {
    for (int i = 0; i < t.circuit.n_devices; i++) {
        if (strcmp(t.circuit.device[i].name, name) == 0) {
            return i;
        }
    }
    ck_abort_msg("no %s", name);
    return -1;
}

static int node(const char *name) {
    for (int i = 0; i < t.circuit.n_nodes; i++) {
        if (strcmp(t.circuit.node_name[i], name) == 0) {
            return i;
        }
    }
    ck_abort_msg("no node %s", name);
    return -1;
}

static void read_exact(void *user, int part, struct dalcs_audit_state *s) {
    (void)user;
    (void)part;
    const bool gate = s->t > CLOSES || (s->t == CLOSES && s->side == DALCS_RIGHT);
    const bool is_closed = fault == LOST_GATE ? false : fault == EARLY_GATE ? true : gate;
    const double tau = fault == SLOW ? TAU * (1.0 + 1e-6) : TAU;
    const double charged = gate && fault != LOST_GATE ? -10.0 * expm1(-(s->t - CLOSES) / tau) : 0.0;
    const double v = charged + (gate && fault == NUDGED ? 1e-6 : 0.0);
    const double i = is_closed ? (10.0 - v) / 10.0 : 0.0;
    const double leak = fault == LEAK && is_closed ? 1e-6 : 0.0;
    memset(s->i, 0, (size_t)t.circuit.n_devices * sizeof *s->i);
    s->v[node("a")] = fault == WRONG_SOURCE ? 10.0 + 1e-5 : 10.0;
    s->v[node("b")] = v + 9.0 * i;
    s->v[node("c")] = v;
    s->v[node("g")] = gate ? 1.0 : 0.0;
    s->i[device("s1")] = i + leak;
    s->i[device("v1")] = -i - leak;
    s->i[device("d1")] = -leak;
    s->is_closed[device("s1")] = is_closed;
}

static void raise_nothing(void *user, int part, double *v, double *i, double *lambda) {
    (void)user;
    (void)part;
    (void)v;
    (void)i;
    (void)lambda;
}

static struct dalcs_audit_summary audited(enum fault which) {
    fault = which;
    build_good_network(&t, CHOPPER);
    int part[16] = {0};
    const double tolerance = 1e-9;
    const double work = 100.0;
    const struct dalcs_audit_options options = {.mode = DALCS_AUDIT_FULL,
                                                .device_part = part,
                                                .n_parts = 1,
                                                .tolerance = &tolerance,
                                                .failure = tolerance,
                                                .read_work = &work};
    const struct dalcs_audit_reader reader = {.read = read_exact, .raise = raise_nothing};
    struct dalcs_audit *audit;
    ck_assert_int_eq(dalcs_audit_create(&audit, &t.circuit, &options, &reader), DALCS_OK);
    const struct dalcs_audit_stretch open = {.to = CLOSES, .step = CLOSES, .degree = 3};
    const struct dalcs_audit_stretch closed = {
        .from = CLOSES, .to = CLOSES + LONG, .step = LONG, .degree = 3};
    dalcs_audit_enter(audit, &open);
    ck_assert(!dalcs_audit_passes_over(audit, &open, 1.0));
    dalcs_audit_leave(audit, &open);
    ck_assert(dalcs_audit_begins(audit, 0));
    dalcs_audit_enter(audit, &closed);
    ck_assert(!dalcs_audit_passes_over(audit, &closed, 1.0));
    dalcs_audit_leave(audit, &closed);
    const struct dalcs_audit_summary found = dalcs_audit_summarise(audit);
    dalcs_audit_destroy(audit);
    return found;
}

START_TEST(test_the_exact_waveform) {
    const struct dalcs_audit_summary found = audited(NONE);
    ck_assert_msg(found.defect < 1e-9, "%g", found.defect);
    ck_assert_int_eq(found.audited, 2);
    ck_assert_int_eq(found.positions, 11); /* five instants each, the far side, a change */
    text_network_finish(&t);
}

END_TEST

START_TEST(test_what_is_wrong) {
    const struct {
        enum fault fault;
        enum dalcs_audit_law law;
        const char *where;
    } spoilt[] = {
        {NUDGED, DALCS_AUDIT_KCL, "c"},          {SLOW, DALCS_AUDIT_KCL, "c"},
        {LOST_GATE, DALCS_AUDIT_POSITION, "s1"}, {EARLY_GATE, DALCS_AUDIT_POSITION, "s1"},
        {LEAK, DALCS_AUDIT_CURRENT, "d1"},       {WRONG_SOURCE, DALCS_AUDIT_BRANCH, "v1"}};

    for (size_t k = 0; k < sizeof spoilt / sizeof *spoilt; k++) {
        const struct dalcs_audit_summary found = audited(spoilt[k].fault);
        const bool is_node = spoilt[k].law == DALCS_AUDIT_KCL;
        ck_assert_msg(found.defect > 1e-9, "fault %d: %g", (int)spoilt[k].fault, found.defect);
        if (spoilt[k].fault != EARLY_GATE &&
            spoilt[k].fault != WRONG_SOURCE) { /* which break more laws than one */
            ck_assert_int_eq(found.law, spoilt[k].law);
            ck_assert_int_eq(found.index,
                             is_node ? node(spoilt[k].where) : device(spoilt[k].where));
        }
        text_network_finish(&t);
    }
}

END_TEST

RUN_TESTS("audit", test_the_exact_waveform, test_what_is_wrong)
