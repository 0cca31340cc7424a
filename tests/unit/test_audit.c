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
    NUDGED,       /* the capacitor is 1e-7 of 10 V off from the event on */
    SLOW,         /* it charges by a millionth too slowly */
    LOST_GATE,    /* the switch stays open */
    EARLY_GATE,   /* it is closed before */
    LEAK,         /* the diode carries current in reverse */
    WRONG_SOURCE, /* V1 is not 10 V */
    /* by 1e-7 of what they are */
    DRIFT,       /* the capacitor gains on the way */
    LOST_AMPERE, /* the switch carries more than the source gives */
    WRONG_RON,   /* the voltage across the switch is off */
    CONDUCTING,  /* a diode without resistance has a voltage, forward, and a current */
    WRONG_GATE,  /* Vg is not 1 V */
    SHUNTED,     /* the open switch carries 0.1 uA */
    LATE_CHARGE  /* the capacitor has had its charge from before */
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
    const double since = gate ? (s->t - CLOSES) / LONG : 0.0;
    const double v = charged + (gate && fault == NUDGED ? 1e-6 : 0.0) +
                     (fault == DRIFT ? 1e-6 * since : 0.0) + (fault == LATE_CHARGE ? 1e-6 : 0.0);
    const double i = is_closed ? (10.0 - v) / 10.0 : fault == SHUNTED ? 1e-7 : 0.0;
    const double leak = fault == LEAK && is_closed ? 1e-6 : 0.0;
    memset(s->i, 0, (size_t)t.circuit.n_devices * sizeof *s->i);
    s->v[node("a")] = fault == WRONG_SOURCE ? 10.0 + 1e-5 : 10.0;
    s->v[node("b")] = fault == CONDUCTING && is_closed  ? -1e-6
                      : fault == WRONG_RON && is_closed ? v + 9.0 * i + 1e-6
                                                        : v + 9.0 * i;
    s->v[node("c")] = v;
    s->v[node("g")] = gate ? (fault == WRONG_GATE ? 1.0 + 1e-7 : 1.0) : 0.0;
    s->i[device("s1")] = i + leak + (fault == LOST_AMPERE && is_closed ? 1e-7 : 0.0);
    s->i[device("v1")] = -i - leak;
    s->i[device("d1")] = -leak;
    s->is_closed[device("s1")] = is_closed;
}

static void read_before(void *user, int part, double earlier, struct dalcs_audit_state *s) {
    s->t = CLOSES - earlier;
    s->side = DALCS_LEFT;
    read_exact(user, part, s);
}

/* V and A that all values have reached by the time that is looked at, and V that a node beside them has; 0: what was read is
 * the largest. */
static double reached, beside;

/* A that Vg has carried by then. */
static double carried;

static void raise_to_reached(void *user, int part, double *v, double *i, double *lambda) {
    (void)user;
    (void)part;
    (void)lambda;
    for (int k = 1; reached > 0.0 && k < t.circuit.n_nodes; k++) {
        v[k] = fmax(v[k], reached);
    }
    for (int k = 0; reached > 0.0 && k < t.circuit.n_devices; k++) {
        i[k] = fmax(i[k], reached);
    }
    i[device("vg")] = fmax(i[device("vg")], carried);
    if (beside > 0.0) {
        v[node("g")] = fmax(v[node("g")], beside);
    }
}

/* It goes on as it is, but has had a spike. */
static void go_on_after(double spike, struct dalcs_audit *audit) {
    const struct dalcs_audit_stretch next = {
        .from = CLOSES + LONG, .to = CLOSES + 2.0 * LONG, .step = LONG, .degree = 3};
    reached = spike;
    dalcs_audit_enter(audit, &next);
    ck_assert(!dalcs_audit_passes_over(audit, &next, 1.0));
    dalcs_audit_leave(audit, &next);
    reached = 0.0;
}

static struct dalcs_audit_summary audited_before(double spike, enum fault which) {
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
    const struct dalcs_audit_reader reader = {
        .read = read_exact, .read_before = read_before, .raise = raise_to_reached};
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
    if (spike > 0.0) {
        go_on_after(spike, audit);
    }
    const struct dalcs_audit_summary found = dalcs_audit_summarise(audit);
    dalcs_audit_destroy(audit);
    return found;
}

static struct dalcs_audit_summary audited(enum fault which) {
    return audited_before(0.0, which);
}

START_TEST(test_the_exact_waveform) {
    const struct dalcs_audit_summary found = audited(NONE);
    ck_assert_msg(found.defect < 1e-9, "%g", found.defect);
    ck_assert_int_eq(found.audited, 2);
    ck_assert_int_eq(found.positions, 11); /* five instants each, the far side, a change */
    text_network_finish(&t);
}

END_TEST

/* Values become 3e4 times as large later, or one beside them has been 1e4 times as large: what is wrong by 1e-7 is as wrong
 * as without that. While a signal is nothing yet it is held to less, and then more is found alone. */
START_TEST(test_beside_a_spike) {
    const enum fault spoilt[] = {NUDGED,      SLOW,      LOST_GATE,  EARLY_GATE, WRONG_SOURCE,
                                 DRIFT,       WRONG_RON, CONDUCTING, WRONG_GATE, LATE_CHARGE,
                                 LOST_AMPERE, LEAK,      SHUNTED};

    for (size_t k = 0; k < sizeof spoilt / sizeof *spoilt; k++) {
        const double alone = audited(spoilt[k]).defect;
        text_network_finish(&t);
        const double before = audited_before(3e4, spoilt[k]).defect;
        text_network_finish(&t);
        beside = 1e4;
        const double behind = audited(spoilt[k]).defect;
        beside = 0.0;
        text_network_finish(&t);
        ck_assert_msg(alone > 9e-9, "fault %d: %g", (int)spoilt[k], alone);
        const double least = 0.9 * fmin(alone, 1e-7);
        const bool is_the_spike = spoilt[k] == WRONG_GATE; /* the node beside them all */
        ck_assert_msg(before > least && (behind > least || is_the_spike),
                      "fault %d: %g, %g before a spike, %g behind one", (int)spoilt[k], alone,
                      before, behind);
    }
    const struct dalcs_audit_summary right = audited_before(3e4, NONE);
    ck_assert_msg(right.defect < 1e-9, "%g", right.defect);
    text_network_finish(&t);
}

END_TEST

/* A signal is held to 1e-5 of what it becomes: 10 uV of 10 V before a spike of 10 MV. */
START_TEST(test_far_before_a_spike) {
    const struct dalcs_audit_summary found = audited_before(1e7, WRONG_SOURCE);
    const double wanted = 1e-5 / (1e-5 * 1e7);

    ck_assert_msg(found.defect > 0.5 * wanted && found.defect < 2.0 * wanted, "%g", found.defect);
    text_network_finish(&t);
}

END_TEST

/* The current of a switch is held to 1e-2 of the largest: 0.1 uA that the source of 1 A does not give, beside 1 kA. */
START_TEST(test_beside_a_large_current) {
    carried = 1e3;
    const struct dalcs_audit_summary found = audited(LOST_AMPERE);
    const double wanted = 1e-7 / (1.0 + 1e-2 * carried);

    carried = 0.0;
    ck_assert_msg(found.defect > 0.5 * wanted && found.defect < 2.0 * wanted, "%g", found.defect);
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

RUN_TESTS("audit", test_the_exact_waveform, test_beside_a_spike, test_far_before_a_spike,
          test_beside_a_large_current, test_what_is_wrong)
