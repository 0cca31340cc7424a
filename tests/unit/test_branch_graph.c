/* test_branch_graph.c - circuits, blocks, flows and distances of small graphs, known by hand, and of
 * random ones, against searches that try everything. */
#include "branch_graph.h"

#include "run_tests.h"

#include <math.h>

enum { MOST_VERTICES = 7, MOST_BRANCHES = 10 };

static struct dalcs_arena arena;
static struct dalcs_branch_graph graph;
static struct dalcs_branch branch[MOST_BRANCHES];
static const int nothing[2] = {-1, -1};

static void build(int n_vertices, int n_branches) {
    dalcs_arena_finish(&arena);
    arena = (struct dalcs_arena){0};
    ck_assert_int_eq(dalcs_branch_graph_setup(&graph, &arena, n_vertices, n_branches, branch),
                     DALCS_OK);
}

/* A triangle 0-1-2, a bridge 2-3, two branches 3-4 and a loop at 4. */
START_TEST(test_blocks) {
    const int ends[][2] = {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 3}, {4, 4}};
    for (int e = 0; e < 7; e++) {
        branch[e] = (struct dalcs_branch){ends[e][0], ends[e][1], INFINITY, 0.0};
    }
    build(5, 7);
    int block[7];
    ck_assert_int_eq(dalcs_branch_graph_blocks(&graph, block), 3);
    ck_assert(block[0] >= 0 && block[0] == block[1] && block[1] == block[2]);
    ck_assert_int_eq(block[3], -1);
    ck_assert(block[4] >= 0 && block[4] == block[5] && block[4] != block[0]);
    ck_assert(block[6] >= 0 && block[6] != block[4] && block[6] != block[0]);
    int part[5];
    dalcs_branch_graph_circuits(&graph, part);
    ck_assert(part[0] == part[1] && part[1] == part[2]);
    ck_assert(part[3] == part[4] && part[3] != part[0]);
    branch[2].ahead = 0.0; /* no triangle any more */
    ck_assert_int_eq(dalcs_branch_graph_blocks(&graph, block), 2);
    ck_assert_int_eq(block[0], -1);
}

END_TEST

START_TEST(test_flow) {
    const struct dalcs_branch given[] = {
        {0, 1, 3.0, 0.0}, {0, 2, 2.0, 0.0}, {1, 2, 5.0, 1.0}, {1, 3, 2.0, 0.0}, {2, 3, 4.0, 0.0}};
    for (int e = 0; e < 5; e++) {
        branch[e] = given[e];
    }
    build(4, 5);
    ck_assert_double_eq(dalcs_branch_graph_flow(&graph, 0, 3, nothing), 5.0);
    ck_assert_double_eq(dalcs_branch_graph_flow(&graph, 0, 3, (int[]){0, -1}), 2.0);
    ck_assert_double_eq(dalcs_branch_graph_flow(&graph, 0, 3, (int[]){1, 3}), 3.0);
    ck_assert_double_eq(dalcs_branch_graph_flow(&graph, 2, 1, nothing), 1.0); /* back */
    ck_assert_double_eq(dalcs_branch_graph_flow(&graph, 3, 0, nothing), 0.0);
    ck_assert(isinf(dalcs_branch_graph_flow(&graph, 1, 1, nothing)));
    branch[0].ahead = branch[3].ahead = INFINITY;
    ck_assert(isinf(dalcs_branch_graph_flow(&graph, 0, 3, nothing)));
}

END_TEST

/* Numbers from 0 to n - 1 that come the same each time. */
static unsigned state = 1;

static int draw(int n) {
    state = state * 1664525u + 1013904223u;
    return (int)(state >> 16) % n;
}

static int n_vertices, n_branches;

static void draw_graph(void) {
    n_vertices = 2 + draw(MOST_VERTICES - 1);
    n_branches = 1 + draw(MOST_BRANCHES);
    for (int e = 0; e < n_branches; e++) {
        branch[e] = (struct dalcs_branch){draw(n_vertices), draw(n_vertices), draw(4), draw(3)};
    }
    build(n_vertices, n_branches);
}

/* The least cut, over all sets of vertices. */
static double least_cut(int from, int to) {
    double least = INFINITY;
    for (int set = 0; set < 1 << n_vertices; set++) {
        if ((set >> from & 1) == 0 || (set >> to & 1) != 0) {
            continue;
        }
        double cut = 0.0;
        for (int e = 0; e < n_branches; e++) {
            bool tail = (set >> branch[e].tail & 1) != 0;
            bool head = (set >> branch[e].head & 1) != 0;
            cut += tail && !head ? branch[e].ahead : 0.0;
            cut += head && !tail ? branch[e].back : 0.0;
        }
        least = fmin(least, cut);
    }
    return least;
}

START_TEST(test_random_flow) {
    const int n_graphs = of_cases(3000, 300);
    for (int k = 0; k < n_graphs; k++) {
        draw_graph();
        int from = draw(n_vertices);
        int to = (from + 1 + draw(n_vertices - 1)) % n_vertices;
        ck_assert_double_eq(dalcs_branch_graph_flow(&graph, from, to, nothing),
                            least_cut(from, to));
    }
}

END_TEST

/* reach[v]: by rounds over all branches, `without` one. */
static void reach_from(int from, int without, bool both_ways, bool *reach) {
    for (int v = 0; v < n_vertices; v++) {
        reach[v] = v == from;
    }
    for (int round = 0; round < n_vertices; round++) {
        for (int e = 0; e < n_branches; e++) {
            const struct dalcs_branch *b = &branch[e];
            bool there = e != without && (b->ahead > 0.0 || b->back > 0.0);
            bool ahead = there && (both_ways || b->ahead > 0.0);
            bool back = there && (both_ways || b->back > 0.0);
            reach[b->head] = reach[b->head] || (ahead && reach[b->tail]);
            reach[b->tail] = reach[b->tail] || (back && reach[b->head]);
        }
    }
}

START_TEST(test_random_circuits) {
    const int n_graphs = of_cases(3000, 300);
    for (int k = 0; k < n_graphs; k++) {
        draw_graph();
        int part[MOST_VERTICES];
        int block[MOST_BRANCHES];
        bool reach[MOST_VERTICES][MOST_VERTICES];
        dalcs_branch_graph_circuits(&graph, part);
        (void)dalcs_branch_graph_blocks(&graph, block);
        for (int v = 0; v < n_vertices; v++) {
            reach_from(v, -1, false, reach[v]);
        }
        for (int v = 0; v < n_vertices; v++) {
            for (int w = 0; w < n_vertices; w++) {
                ck_assert((part[v] == part[w]) == (reach[v][w] && reach[w][v]));
            }
        }
        for (int e = 0; e < n_branches; e++) {
            /* on a loop where the others connect its ends */
            bool around[MOST_VERTICES];
            reach_from(branch[e].tail, e, true, around);
            bool there = branch[e].ahead > 0.0 || branch[e].back > 0.0;
            ck_assert((block[e] >= 0) == (there && around[branch[e].head]));
        }
    }
}

END_TEST

START_TEST(test_random_distances) {
    const int n_graphs = of_cases(3000, 300);
    for (int k = 0; k < n_graphs; k++) {
        draw_graph();
        double length[MOST_BRANCHES];
        for (int e = 0; e < n_branches; e++) {
            length[e] = draw(5);
        }
        bool backwards = k % 2 == 0;
        double known[MOST_VERTICES];
        double found[MOST_VERTICES];
        for (int v = 0; v < n_vertices; v++) {
            known[v] = v == 0 ? 0.0 : INFINITY;
        }
        for (int round = 0; round < n_vertices; round++) {
            for (int e = 0; e < n_branches; e++) {
                int a = backwards ? branch[e].head : branch[e].tail;
                int b = backwards ? branch[e].tail : branch[e].head;
                known[b] = branch[e].ahead > 0.0 ? fmin(known[b], known[a] + length[e]) : known[b];
            }
        }
        dalcs_branch_graph_distances(&graph, 0, length, backwards, found);
        for (int v = 0; v < n_vertices; v++) {
            ck_assert(known[v] == found[v]);
        }
    }
    dalcs_arena_finish(&arena);
}

END_TEST

RUN_TESTS("branch_graph", test_blocks, test_flow, test_random_flow, test_random_circuits,
          test_random_distances)
