/* test_screen.c - each stretch is asked by a screen: of a ramp in pieces, of which one has a fault. */
#include "audit.h"

#include "build_network.h"
#include "run_tests.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* I1 charges C1, 1 V in each millisecond. D1 blocks; S1 is to close at some time. */
static const char RAMP[] = "a ramp\n"
                           "I1 0 c 1m\n"
                           "C1 c 0 1u\n"
                           "D1 c out DI\n"
                           "V1 out 0 90\n"
                           "S1 c 0 g 0 SW\n"
                           "Vg g 0 PULSE(0 1 %.17g 0 0 1 10)\n"
                           ".model SW SW(Ron=0 Vt=0.5)\n"
                           ".model DI D(Ron=0)\n"
                           ".tran 1u 40m uic\n";

/* What is stored: voltages, then currents. */
enum column { V_C, V_OUT, I_D, I_V, I_S, I_G, N_COLUMNS, STRIDE = 8 };

enum { N_NODES = 3 };

static const double NODE[N_NODES] = {0.0, 0.5, 1.0}, STEP = 1e-3;

/* At 90 V the diode would conduct. */
enum { N_STRETCHES = 25, DIODE_BLOCKS = 89, MANY_STRETCHES = 200, FAULTY = 13 };

/* What is nearer to an end is there: the tolerance times the length. */
static const double NEAR = 1e-12;

enum fault {
    NONE,
    SLOW,   /* it charges by a millionth too slowly */
    NUDGED, /* it begins 1e-6 V off, and goes on so */
    LEAK,   /* the diode carries current in reverse at the very end */
    SPOILT, /* one voltage in the middle is off by 1e-6 V */
    SHORT,  /* the values end before the stretch does */
    FALSE   /* all stretches are stored with another V1 than is read */
};

static struct text_network t;
static enum fault fault;
static int present;
static bool
    are_images; /* stretches are stored with the state and the 1 that they are an image of, and repeat each other */
static int n_gathered, n_revisited;
static double value[N_NODES * STRIDE];

static int named(const char *name) {
    for (int i = 0; i < t.circuit.n_devices; i++) {
        if (strcmp(t.circuit.device[i].name, name) == 0) {
            return i;
        }
    }
    ck_abort_msg("no %s", name);
    return -1;
}

static int column_of_node(int node) {
    const char *name = t.circuit.node_name[node];
    return strcmp(name, "c") == 0 ? V_C : V_OUT;
}

static int column_of_current(int device) {
    return device == named("d1")   ? I_D
           : device == named("v1") ? I_V
           : device == named("s1") ? I_S
                                   : I_G;
}

static bool is_gate(int node) {
    return strcmp(t.circuit.node_name[node], "g") == 0;
}

static const struct dalcs_stimulus *gate(void) {
    return &t.circuit.stimulus[t.circuit.device[named("vg")].stimulus];
}

/* Column of a stretch at theta, in steps. */
static double at(int stretch, int column, double theta) {
    const bool is = stretch == FAULTY;
    const bool is_behind = stretch > FAULTY;
    double v = stretch + theta;
    v -= fault == SLOW && is ? 1e-6 * theta : fault == SLOW && is_behind ? 1e-6 : 0.0;
    v += fault == NUDGED && (is || is_behind) ? 1e-6 : 0.0;
    v += fault == SPOILT && is && theta == 0.5 ? 1e-6 : 0.0;
    const double leak = fault == LEAK && is && theta == 1.0 ? -1e-8 : 0.0;
    return column == V_C     ? v
           : column == V_OUT ? 90.0
           : column == I_D   ? leak
           : column == I_V   ? -leak
                             : 0.0;
}

/* The parabola through the values of a stretch. */
static double between(int stretch, int column, double theta) {
    return at(stretch, column, 0.0) * (1.0 - theta) * (1.0 - 2.0 * theta) +
           at(stretch, column, 0.5) * 4.0 * theta * (1.0 - theta) +
           at(stretch, column, 1.0) * theta * (2.0 * theta - 1.0);
}

static void fill(int stretch) {
    present = stretch;
    for (int k = 0; k < N_NODES; k++) {
        for (int c = 0; c < N_COLUMNS; c++) {
            value[k * STRIDE + c] =
                at(stretch, c, NODE[k]) + (fault == FALSE && c == V_OUT ? 1.0 : 0.0);
        }
    }
}

static void read_stretch(int stretch, double theta, struct dalcs_audit_state *s) {
    for (int n = 1; n < t.circuit.n_nodes; n++) {
        s->v[n] = is_gate(n) ? dalcs_stimulus_value(gate(), s->t, s->side)
                             : between(stretch, column_of_node(n), theta);
    }
    for (int i = 0; i < t.circuit.n_devices; i++) {
        s->i[i] = 0.0;
        s->is_closed[i] = false;
    }
    s->i[named("d1")] = between(stretch, I_D, theta);
    s->i[named("v1")] = between(stretch, I_V, theta);
}

static void read_present(void *user, int part, struct dalcs_audit_state *s) {
    (void)user;
    (void)part;
    read_stretch(present, s->t / STEP - present, s);
}

static void read_before(void *user, int part, double earlier, struct dalcs_audit_state *s) {
    (void)user;
    (void)part;
    s->t = present * STEP - earlier;
    s->side = DALCS_LEFT;
    read_stretch(present - 1, 1.0 - earlier / STEP, s);
}

static void complete(void *user, int part) {
    (void)user;
    (void)part;
}

static void add_voltage(void *user, int part, int node, double factor,
                        struct dalcs_audit_row *row) {
    (void)user;
    (void)part;
    if (is_gate(node)) { /* which a source alone decides */
        dalcs_audit_row_add_stimulus(row, t.circuit.device[named("vg")].stimulus, factor);
    } else {
        dalcs_audit_row_add_column(row, column_of_node(node), factor);
    }
}

static void add_current(void *user, int part, int device, double factor,
                        struct dalcs_audit_row *row) {
    (void)user;
    (void)part;
    dalcs_audit_row_add_column(row, column_of_current(device), factor);
}

static void read_columns(void *user, int part, double *is_read) {
    (void)user;
    (void)part;
    for (int k = 0; k < N_COLUMNS; k++) {
        is_read[k] = 1.0;
    }
}

/* The diode blocks and the switch is open. */
static bool is_on(void *user, int part, int device, int k) {
    (void)user;
    (void)part;
    (void)device;
    (void)k;
    return false;
}

static void raise_to_known(void *user, int part, double *v, double *i, double *lambda) {
    (void)user;
    (void)part;
    (void)lambda;
    for (int n = 1; n < t.circuit.n_nodes; n++) {
        v[n] = 90.0;
    }
    for (int k = 0; k < t.circuit.n_devices; k++) {
        i[k] = 1e-3;
    }
}

/* What the state at the start, and 1, are multiplied by. */
static const double *column_of_map(void *user, int part, int j) {
    static double of[N_NODES * STRIDE];
    (void)user;
    (void)part;
    for (int k = 0; k < N_NODES; k++) {
        of[k * STRIDE + V_C] = j == 0 ? 1.0 : NODE[k];
        of[k * STRIDE + V_OUT] = j == 0 ? 0.0 : 90.0;
    }
    return of;
}

static struct dalcs_audit_polynomials stored = {.key = 1,
                                                .n_columns = N_COLUMNS,
                                                .n_nodes = N_NODES,
                                                .stride = STRIDE,
                                                .node = NODE,
                                                .step = STEP,
                                                .value = value};
static struct dalcs_audit_stretch stretch = {.step = STEP, .degree = 2, .stored = &stored};
static double input[] = {0.0, 1.0};

static void put_present(int k) {
    fill(k);
    input[0] = at(k, V_C, 0.0);
    stored.end = 1.0;
    stored.n_inputs = are_images ? 2 : 0;
    stored.input = are_images ? input : NULL;
    stretch.from = k * STEP;
    stretch.to = (k + 1) * STEP;
}

static int latest;

static struct dalcs_audit_stretch *revisit(void *user, int part,
                                           const struct dalcs_audit_kept *before,
                                           const struct dalcs_audit_kept *kept) {
    (void)user;
    (void)part;
    latest = present;
    n_revisited++;
    put_present((int)lrint(kept->from / STEP));
    ck_assert(kept->input[0] == input[0] && kept->input[1] == 1.0 && kept->to == stretch.to);
    ck_assert(before->to == kept->from && before->input[0] == at(present - 1, V_C, 0.0));
    return &stretch;
}

static void go_back(void *user, int part) {
    (void)user;
    (void)part;
    put_present(latest);
}

/* As a run does with stretches that have the mode, the step, the end and the map of the one before. */
static bool gathers(struct dalcs_audit *audit) {
    struct dalcs_audit_batch *batch = dalcs_audit_batch_of(audit, 0);
    if (!batch->is_on || stretch.to > batch->last ||
        !dalcs_audit_is_image(audit, 0, input, value)) {
        return false;
    }
    dalcs_audit_put(batch, stretch.from, stretch.to, input, 1.0);
    n_gathered++;
    if (batch->n == DALCS_AUDIT_BATCH) {
        dalcs_audit_ask_batch(audit, 0);
    }
    return true;
}

static struct dalcs_audit *make(void) {
    static const int part[16] = {0};
    static const double tolerance = 1e-9;
    static const double work = 100.0;
    const struct dalcs_audit_options options = {.mode = DALCS_AUDIT_SAMPLE,
                                                .device_part = part,
                                                .n_parts = 1,
                                                .resolution = 1e-18,
                                                .tolerance = &tolerance,
                                                .failure = tolerance,
                                                .read_work = &work};
    const struct dalcs_audit_reader reader = {.read = read_present,
                                              .read_before = read_before,
                                              .revisit = revisit,
                                              .go_back = go_back,
                                              .complete = complete,
                                              .column = column_of_map,
                                              .read_columns = read_columns,
                                              .is_on = is_on,
                                              .add_voltage = add_voltage,
                                              .add_current = add_current,
                                              .raise = raise_to_known};
    struct dalcs_audit *audit;
    ck_assert_int_eq(dalcs_audit_create(&audit, &t.circuit, &options, &reader), DALCS_OK);
    return audit;
}

/* n stretches of a run that can afford no look but those that screens ask for; S1 is told to close at some time. */
static struct dalcs_audit_summary audited(enum fault which, int n, double closes, double short_by) {
    char netlist[sizeof RAMP + 32];
    fault = which;
    n_gathered = n_revisited = 0;
    snprintf(netlist, sizeof netlist, RAMP, closes);
    build_good_network(&t, netlist);
    struct dalcs_audit *audit = make();
    for (int k = 0; k < n; k++) {
        put_present(k);
        if (which == SHORT && k == FAULTY) {
            stored.end = 1.0 - short_by;
        }
        if (dalcs_audit_begins(audit, 0)) {
            dalcs_audit_enter(audit, &stretch);
        }
        if (are_images && k > 0 && gathers(audit)) {
            continue;
        }
        dalcs_audit_settle(audit, 0);
        if (!dalcs_audit_passes_over(audit, &stretch, 1.0)) {
            dalcs_audit_leave(audit, &stretch);
        }
    }
    dalcs_audit_settle(audit, 0);
    const struct dalcs_audit_summary found = dalcs_audit_summarise(audit);
    dalcs_audit_destroy(audit);
    text_network_finish(&t);
    return found;
}

static const double NEVER = 5.0;

START_TEST(test_right_stretches_are_asked_and_not_looked_at) {
    const struct dalcs_audit_summary found = audited(NONE, N_STRETCHES, NEVER, 0.0);
    ck_assert_msg(found.defect < 1e-12, "%g", found.defect);
    ck_assert_int_eq(found.screened, N_STRETCHES);
    ck_assert_int_eq(found.audited, 0);
}

END_TEST

/* Those that repeat the one before are asked together. What is wrong in one of them is found where it is. */
START_TEST(test_stretches_that_repeat_are_asked) {
    are_images = true;
    const struct dalcs_audit_summary right = audited(NONE, DIODE_BLOCKS, NEVER, 0.0);
    ck_assert_msg(right.defect < 1e-12, "%g", right.defect);
    ck_assert_int_eq(right.stretches, DIODE_BLOCKS);
    ck_assert_int_eq(right.screened, DIODE_BLOCKS);
    ck_assert_int_eq(right.audited, 0);
    ck_assert_msg(n_gathered > DIODE_BLOCKS / 2, "%d", n_gathered);
    ck_assert_int_eq(n_revisited, 0);

    const enum fault faults[] = {SLOW, NUDGED};

    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        const struct dalcs_audit_summary found = audited(faults[k], N_STRETCHES, NEVER, 0.0);
        ck_assert_msg(found.defect > 1e-9, "fault %d: %g", (int)faults[k], found.defect);
        ck_assert_msg(found.time > (FAULTY - 1e-6) * STEP && found.time < (FAULTY + 2) * STEP,
                      "fault %d at %g", (int)faults[k], found.time);
        ck_assert_msg(n_gathered > 0, "fault %d", (int)faults[k]);
    }
    ck_assert_msg(n_revisited > 0, "nothing was looked at once more");
    const double end = (FAULTY + 1) * STEP;
    const struct dalcs_audit_summary late = audited(NONE, FAULTY + 1, end - 3.0 * NEAR, 0.0);
    ck_assert_int_eq(late.law, DALCS_AUDIT_POSITION);
    ck_assert_msg(late.defect > 1e-9, "%g", late.defect);
    ck_assert_int_eq(audited(NONE, FAULTY + 1, end - NEAR / 3.0, 0.0).audited, 0);
    are_images = false;
}

END_TEST

START_TEST(test_one_fault_is_found) {
    const enum fault faults[] = {SLOW, NUDGED, LEAK, SPOILT};

    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        const struct dalcs_audit_summary found = audited(faults[k], N_STRETCHES, NEVER, 0.0);
        ck_assert_msg(found.defect > 1e-9, "fault %d: %g", (int)faults[k], found.defect);
        ck_assert_msg(found.audited > 0, "fault %d", (int)faults[k]);
    }
}

END_TEST

/* Commands that come so much before the end of a stretch, three times what is near and a third of it. */
START_TEST(test_a_command_within_a_stretch_is_found) {
    const double end = (FAULTY + 1) * STEP;
    const struct dalcs_audit_summary late = audited(NONE, FAULTY + 1, end - 3.0 * NEAR, 0.0);
    ck_assert_int_eq(late.audited, 1);
    ck_assert_int_eq(late.law, DALCS_AUDIT_POSITION);
    ck_assert_msg(late.defect > 1e-9, "%g", late.defect);
    const struct dalcs_audit_summary near = audited(NONE, FAULTY + 1, end - NEAR / 3.0, 0.0);
    ck_assert_int_eq(near.audited, 0);
}

END_TEST

START_TEST(test_values_that_end_before_the_stretch_are_looked_at) {
    const double share = NEAR / STEP;
    ck_assert_int_eq(audited(SHORT, N_STRETCHES, NEVER, 3.0 * share).audited, 1);
    ck_assert_int_eq(audited(SHORT, N_STRETCHES, NEVER, share / 3.0).audited, 0);
}

END_TEST

/* Four alarms of a screen, each after a rest twice as long, whatever they cost; more while the run can afford it. */
START_TEST(test_few_false_alarms_are_looked_at) {
    const struct dalcs_audit_summary found = audited(FALSE, MANY_STRETCHES, NEVER, 0.0);
    ck_assert_msg(found.defect < 1e-12, "%g", found.defect);
    ck_assert_int_eq(found.audited, 4);
    ck_assert_msg(found.screened < MANY_STRETCHES, "it never rests");
}

END_TEST

RUN_TESTS("screen", test_right_stretches_are_asked_and_not_looked_at,
          test_stretches_that_repeat_are_asked, test_one_fault_is_found,
          test_a_command_within_a_stretch_is_found,
          test_values_that_end_before_the_stretch_are_looked_at,
          test_few_false_alarms_are_looked_at)
