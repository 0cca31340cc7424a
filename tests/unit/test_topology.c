/* test_topology.c - what the graph says: shorts, parts, islands, the capacitor forest. */
#include "topology.h"

#include "build_circuit.h"

#include <stdlib.h>

struct sketch {
    struct dalcs_circuit circuit;
    struct dalcs_topology t;
};

/* `wants`: an element whose current is asked for, or NULL. */
static void sketch_build(struct sketch *s, const char *text, const char *wants) {
    build_good_circuit(&s->circuit, text);
    bool *wants_current = calloc((size_t)s->circuit.n_devices, sizeof(*wants_current));
    ck_assert_ptr_nonnull(wants_current);
    for (int i = 0; wants != NULL && i < s->circuit.n_devices; i++) {
        wants_current[i] = strcmp(s->circuit.device[i].name, wants) == 0;
    }
    ck_assert_int_eq(dalcs_topology_build(&s->t, &s->circuit, wants_current), DALCS_OK);
    free(wants_current);
}

static void sketch_finish(struct sketch *s) {
    dalcs_topology_finish(&s->t);
    dalcs_circuit_finish(&s->circuit);
}

static int node(const struct sketch *s, const char *name) {
    for (int n = 0; n < s->circuit.n_nodes; n++) {
        if (strcmp(s->circuit.node_name[n], name) == 0) {
            return n;
        }
    }
    ck_abort_msg("no node %s", name);
    return -1;
}

static int device(const struct sketch *s, const char *name) {
    return (int)(device_named(&s->circuit, name) - s->circuit.device);
}

START_TEST(test_shorts) {
    static const char text[] = "shorts\nV1 a 0 1\nR1 a b 0\nR2 c b 0\nR3 c 0 1\nR4 g 0 0\n"
                               "R5 c g 1\n.op\n";
    struct sketch s;
    sketch_build(&s, text, NULL);
    ck_assert_int_eq(s.t.node_of[node(&s, "c")], node(&s, "a"));
    ck_assert_int_eq(s.t.node_of[node(&s, "g")], 0);
    ck_assert_int_eq(s.t.device_component[device(&s, "r1")], -1);
    ck_assert(!s.t.has_current[device(&s, "r1")]);
    sketch_finish(&s);
    /* Its current is asked for: it stays, as a branch of 0 V. */
    sketch_build(&s, text, "r1");
    ck_assert_int_eq(s.t.node_of[node(&s, "a")], node(&s, "a"));
    ck_assert_int_eq(s.t.node_of[node(&s, "c")], node(&s, "b"));
    ck_assert(s.t.has_current[device(&s, "r1")]);
    ck_assert_int_ge(s.t.device_component[device(&s, "r1")], 0);
    sketch_finish(&s);
}

END_TEST

/* Ground joins nothing; couplings, current controls and controlling nodes do. */
START_TEST(test_components) {
    struct sketch s;
    sketch_build(&s,
                 "parts\nV1 a 0 1\nR1 a 0 1\nV2 b 0 1\nR2 b 0 1\n"
                 "L1 c 0 1m\nI1 c 0 1\nL2 d 0 1m\nR3 d 0 1\nK1 L1 L2 0.5\n"
                 "V3 e 0 1\nF1 0 f V3 2\nR4 f 0 1\n"
                 "V4 g 0 1\nE1 h 0 g 0 2\nR5 h 0 1\nR6 k 0 1\nS1 k 0 h 0 sm\n.model sm SW\n.op\n",
                 NULL);
    ck_assert_int_eq(s.t.n_components, 5);
    static const char *const part[] = {"v1 r1", "v2 r2", "l1 i1 l2 r3", "v3 f1 r4",
                                       "v4 e1 r5 r6 s1"};
    for (int i = 0; i < s.circuit.n_devices; i++) {
        int k = s.t.device_component[i];
        ck_assert_ptr_nonnull(strstr(part[k], s.circuit.device[i].name));
    }
    ck_assert_int_eq(s.t.node_component[node(&s, "k")], 4);
    ck_assert_int_eq(s.t.node_component[0], -1);
    sketch_finish(&s);
}

END_TEST

START_TEST(test_references) {
    struct sketch s;
    sketch_build(&s,
                 "a transformer's secondary floats; a current source ties nothing\n"
                 "V1 a 0 1\nL1 a 0 1m\nL2 b c 1m\nK1 L1 L2 0.9\nR1 b c 1\nI1 0 c 1\n"
                 "D1 d 0\nI2 0 d 1\n.op\n",
                 NULL);
    for (int n = 1; n < s.circuit.n_nodes; n++) {
        ck_assert_int_eq(s.t.is_reference[n], n == node(&s, "b"));
    }
    sketch_finish(&s);
}

END_TEST

START_TEST(test_forest) {
    static const char text[] = "four capacitors, a loop of three, one of its own\n"
                               "C1 a b 1\nC2 b c 1\nC3 c a 1\nC4 c 0 1\nC5 x y 1\n"
                               "R1 a 0 1\nR2 x 0 1\nR3 y a 1\n.op\n";
    struct sketch s;
    sketch_build(&s, text, NULL);
    static const bool in_forest[] = {true, true, false, true, true};
    for (int k = 0; k < 5; k++) {
        ck_assert_int_eq(s.t.in_forest[k], in_forest[k]);
        ck_assert_int_eq(s.t.has_current[k], !in_forest[k]);
    }
    ck_assert_int_eq(s.t.forest_root[node(&s, "b")], 0);
    ck_assert_int_eq(s.t.forest_root[node(&s, "y")], node(&s, "x"));
    sketch_finish(&s);
    /* A current that is asked for is an unknown: the capacitor leaves the forest. */
    sketch_build(&s, text, "c2");
    ck_assert(!s.t.in_forest[device(&s, "c2")]);
    ck_assert(s.t.has_current[device(&s, "c2")]);
    ck_assert(s.t.in_forest[device(&s, "c3")]);
    sketch_finish(&s);
}

END_TEST

/* Voltages that V sources alone fix, stacked and upside down; looked for where there is a switch. */
START_TEST(test_potentials) {
    struct sketch s;
    sketch_build(&s, "no switch\nV1 0 a 1\nR1 a 0 1\n.op\n", NULL);
    ck_assert_int_eq(s.t.potential_source[node(&s, "a")], -1);
    sketch_finish(&s);
    sketch_build(&s,
                 "stack\nV2 b a 1\nV1 0 a 1\nR1 b c 1\nV3 c d 1\nR2 d 0 1\nS1 c 0 b 0 m\n"
                 ".model m sw\n.op\n",
                 NULL);
    ck_assert_int_eq(s.t.potential_source[node(&s, "a")], device(&s, "v1"));
    ck_assert_int_eq(s.t.potential_source[node(&s, "b")], device(&s, "v2"));
    ck_assert_int_eq(s.t.potential_source[node(&s, "c")], -1);
    ck_assert_int_eq(s.t.potential_root[node(&s, "b")], 0);
    ck_assert_int_eq(s.t.potential_root[node(&s, "c")], s.t.potential_root[node(&s, "d")]);
    sketch_finish(&s);
}

END_TEST

static int root(const struct sketch *s, const char *name) {
    return s->t.potential_root[node(s, name)];
}

/* Floating trees of sources: along an E of such a tree into others and on, not between trees that stand already. */
START_TEST(test_floating_potentials) {
    struct sketch s;
    sketch_build(
        &s,
        "floating\nE1 x y a b 2\nE3 m n x y 2\nV1 a b 1\nV2 p q 1\nE2 p 0 a b 3\nE4 f 0 r 0 1\n"
        "R1 a 0 1\nR2 x 0 1\nR3 q r 1\nR4 m 0 1\nS1 r 0 a b m\n.model m sw\n.op\n",
        NULL);
    ck_assert_int_eq(root(&s, "a"), root(&s, "b"));
    ck_assert_int_ge(root(&s, "a"), 1);
    ck_assert_int_eq(root(&s, "x"), root(&s, "y"));
    ck_assert_int_ge(root(&s, "x"), 1);
    ck_assert_int_ne(root(&s, "x"), root(&s, "a"));
    ck_assert_int_eq(root(&s, "m"), root(&s, "n"));
    ck_assert_int_ge(root(&s, "m"), 1);
    ck_assert_int_eq(root(&s, "p"), 0);
    ck_assert_int_eq(root(&s, "q"), 0);
    ck_assert_int_eq(root(&s, "r"), -1);
    ck_assert_int_eq(root(&s, "f"), -1);
    sketch_finish(&s);
}

END_TEST

RUN_TESTS("topology", test_shorts, test_components, test_references, test_forest, test_potentials,
          test_floating_potentials)
