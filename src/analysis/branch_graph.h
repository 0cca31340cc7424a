/* branch_graph.h - branches between vertices: what can circulate, how much, and how far it is.
 *
 * A branch may be passed ahead, from tail to head, and back, each up to a capacity. Infinite ones are
 * INFINITY; a branch that nothing passes has 0 both ways. */
#ifndef DALCS_BRANCH_GRAPH_H
#define DALCS_BRANCH_GRAPH_H

#include "memory.h"

struct dalcs_branch {
    int tail, head;
    double ahead, back;
};

struct dalcs_branch_graph {
    int n_vertices, n_branches;
    const struct dalcs_branch *branch; /* [n_branches] borrowed; capacities may change */
    int *first;                        /* [n_vertices + 1] */
    int *end;     /* [2 n_branches] by vertex: 2 branch + 1 where the vertex is its head */
    int *work[5]; /* [n_vertices + 2 n_branches] */
    double *room; /* [2 n_branches] */
};

/* Everything is in the arena. */
enum dalcs_status dalcs_branch_graph_setup(struct dalcs_branch_graph *graph,
                                           struct dalcs_arena *arena, int n_vertices,
                                           int n_branches,
                                           const struct dalcs_branch *branch) DALCS_MUST_CHECK;

/* part[n_vertices]: vertices that reach each other have the same number (R. Tarjan, SIAM J. Comput. 1,
 * 1972). */
void dalcs_branch_graph_circuits(const struct dalcs_branch_graph *graph, int *part);

/* block[n_branches]: branches on a common loop have the same number, those on none -1. Directions do
 * not count, but a branch without capacity is not there. Returns the number of blocks. */
int dalcs_branch_graph_blocks(const struct dalcs_branch_graph *graph, int *block);

/* The most that can flow from one vertex to another, not through the branches `without` (two; -1: no
 * such branch); E. A. Dinic, Soviet Math. Dokl. 11, 1970. It is INFINITY where nothing limits it. */
double dalcs_branch_graph_flow(const struct dalcs_branch_graph *graph, int from, int to,
                               const int *without);

/* distance[n_vertices] from a vertex along branches of length[n_branches] >= 0, ahead or, if
 * `backwards`, back, that are passable ahead; INFINITY where there is no way (Dijkstra). */
void dalcs_branch_graph_distances(const struct dalcs_branch_graph *graph, int from,
                                  const double *length, bool backwards, double *distance);

#endif
