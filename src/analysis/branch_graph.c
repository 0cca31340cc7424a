/* branch_graph.c - four classical walks over one table of branches, none of them recursive. */
#include "branch_graph.h"

#include <math.h>
#include <string.h>

enum dalcs_status dalcs_branch_graph_setup(struct dalcs_branch_graph *g, struct dalcs_arena *arena,
                                           int n_vertices, int n_branches,
                                           const struct dalcs_branch *branch) {
    size_t vertices = (size_t)n_vertices;
    size_t branches = (size_t)n_branches;
    *g = (struct dalcs_branch_graph){
        .n_vertices = n_vertices, .n_branches = n_branches, .branch = branch};
    g->first = dalcs_arena_alloc(arena, vertices + 2, sizeof(int));
    g->end = dalcs_arena_alloc(arena, 2 * branches, sizeof(int));
    g->room = dalcs_arena_alloc(arena, 2 * branches, sizeof(double));
    bool complete = g->first != NULL && g->end != NULL && g->room != NULL;
    for (int k = 0; k < 5; k++) {
        g->work[k] = dalcs_arena_alloc(arena, vertices + 2 * branches, sizeof(int));
        complete = complete && g->work[k] != NULL;
    }
    if (!complete) {
        return DALCS_E_NOMEM;
    }
    for (int e = 0; e < n_branches; e++) {
        g->first[branch[e].tail + 2]++;
        g->first[branch[e].head + 2]++;
    }
    for (int v = 0; v < n_vertices; v++) {
        g->first[v + 2] += g->first[v + 1];
    }
    for (int e = 0; e < n_branches; e++) {
        g->end[g->first[branch[e].tail + 1]++] = 2 * e;
        g->end[g->first[branch[e].head + 1]++] = 2 * e + 1;
    }
    return DALCS_OK;
}

static int across(const struct dalcs_branch_graph *g, int end) {
    return end % 2 == 0 ? g->branch[end / 2].head : g->branch[end / 2].tail;
}

static double capacity(const struct dalcs_branch_graph *g, int end) {
    return end % 2 == 0 ? g->branch[end / 2].ahead : g->branch[end / 2].back;
}

static bool is_there(const struct dalcs_branch_graph *g, int branch) {
    return g->branch[branch].ahead > 0.0 || g->branch[branch].back > 0.0;
}

void dalcs_branch_graph_circuits(const struct dalcs_branch_graph *g, int *part) {
    int *number = g->work[0]; /* in the order of discovery, from 1 */
    int *lowest = g->work[1];
    int *next = g->work[2];
    int *path = g->work[3];
    int *waiting = g->work[4];
    int n_numbers = 0;
    int n_waiting = 0;
    int n_parts = 0;
    for (int v = 0; v < g->n_vertices; v++) {
        number[v] = 0;
        part[v] = -1;
    }
    for (int root = 0; root < g->n_vertices; root++) {
        int depth = 0;
        if (number[root] == 0) {
            path[depth++] = root;
        }
        while (depth > 0) {
            int v = path[depth - 1];
            if (number[v] == 0) {
                number[v] = lowest[v] = ++n_numbers;
                next[v] = g->first[v];
                waiting[n_waiting++] = v;
            }
            bool deeper = false;
            for (; next[v] < g->first[v + 1] && !deeper; next[v]++) {
                int end = g->end[next[v]];
                int to = across(g, end);
                if (!(capacity(g, end) > 0.0) || part[to] >= 0) {
                    continue;
                }
                if (number[to] == 0) {
                    path[depth++] = to;
                    deeper = true;
                    break; /* the branch is seen again on the way back, then with a number */
                }
                lowest[v] = lowest[to] < lowest[v] ? lowest[to] : lowest[v];
            }
            if (deeper) {
                continue;
            }
            if (lowest[v] == number[v]) {
                int member;
                do {
                    member = waiting[--n_waiting];
                    part[member] = n_parts;
                } while (member != v);
                n_parts++;
            }
            depth--;
        }
    }
}

/* Branches from the top of the pile down to `last` are one block; a block of one is no loop. */
static int close_block(int *pile, int *n_pile, int last, int n_blocks, int *block) {
    int top = *n_pile;
    while (pile[--*n_pile] != last) {
    }
    if (top - *n_pile == 1) {
        return n_blocks;
    }
    for (int k = *n_pile; k < top; k++) {
        block[pile[k]] = n_blocks;
    }
    return n_blocks + 1;
}

int dalcs_branch_graph_blocks(const struct dalcs_branch_graph *g, int *block) {
    int *number = g->work[0];
    int *lowest = g->work[1];
    int *next = g->work[2];
    int *path = g->work[3]; /* ends of branches by which vertices were entered */
    int *pile = g->work[4];
    int n_numbers = 0;
    int n_pile = 0;
    int n_blocks = 0;
    for (int v = 0; v < g->n_vertices; v++) {
        number[v] = 0;
    }
    for (int e = 0; e < g->n_branches; e++) {
        bool is_loop = is_there(g, e) && g->branch[e].tail == g->branch[e].head;
        block[e] = is_loop ? n_blocks++ : -1;
    }
    for (int root = 0; root < g->n_vertices; root++) {
        if (number[root] > 0) {
            continue;
        }
        int depth = 0;
        int v = root;
        number[v] = lowest[v] = ++n_numbers;
        next[v] = g->first[v];
        for (;;) {
            if (next[v] < g->first[v + 1]) {
                int end = g->end[next[v]++];
                int to = across(g, end);
                bool entered_by = depth > 0 && path[depth - 1] / 2 == end / 2;
                if (!is_there(g, end / 2) || to == v || entered_by) {
                    continue;
                }
                if (number[to] == 0) {
                    pile[n_pile++] = end / 2;
                    path[depth++] = end;
                    v = to;
                    number[v] = lowest[v] = ++n_numbers;
                    next[v] = g->first[v];
                } else if (number[to] < number[v]) {
                    pile[n_pile++] = end / 2;
                    lowest[v] = number[to] < lowest[v] ? number[to] : lowest[v];
                }
                continue;
            }
            if (depth == 0) {
                break;
            }
            int end = path[--depth];
            int before = across(g, end ^ 1);
            if (lowest[v] >= number[before]) {
                n_blocks = close_block(pile, &n_pile, end / 2, n_blocks, block);
            } else {
                lowest[before] = lowest[v] < lowest[before] ? lowest[v] : lowest[before];
            }
            v = before;
        }
    }
    return n_blocks;
}

/* level[v]: branches from `from`, 0 where it does not reach. */
static bool find_levels(const struct dalcs_branch_graph *g, int from, int to, int *level,
                        int *queue) {
    int n = 0;
    memset(level, 0, (size_t)g->n_vertices * sizeof(*level));
    level[from] = 1;
    queue[n++] = from;
    for (int k = 0; k < n && level[to] == 0; k++) {
        int v = queue[k];
        for (int i = g->first[v]; i < g->first[v + 1]; i++) {
            int next = across(g, g->end[i]);
            if (g->room[g->end[i]] > 0.0 && level[next] == 0) {
                level[next] = level[v] + 1;
                queue[n++] = next;
            }
        }
    }
    return level[to] > 0;
}

/* Fills the ways along ascending levels. */
static double fill_levels(const struct dalcs_branch_graph *g, int from, int to, int *level,
                          int *next, int *path) {
    double sum = 0.0;
    int depth = 0;
    memcpy(next, g->first, (size_t)g->n_vertices * sizeof(*next));
    for (int v = from;;) {
        if (v == to) {
            double least = INFINITY;
            for (int k = 0; k < depth; k++) {
                least = fmin(least, g->room[path[k]]);
            }
            if (isinf(least)) {
                return INFINITY;
            }
            sum += least;
            int full = depth;
            for (int k = depth - 1; k >= 0; k--) {
                g->room[path[k]] -= least;
                g->room[path[k] ^ 1] += least;
                full = g->room[path[k]] > 0.0 ? full : k;
            }
            depth = full;
            v = across(g, path[depth] ^ 1);
            continue;
        }
        bool found = false;
        for (; next[v] < g->first[v + 1] && !found; next[v] += found ? 0 : 1) {
            int end = g->end[next[v]];
            found = g->room[end] > 0.0 && level[across(g, end)] == level[v] + 1;
        }
        if (found) {
            path[depth++] = g->end[next[v]];
            v = across(g, path[depth - 1]);
        } else if (depth > 0) {
            v = across(g, path[--depth] ^ 1);
            next[v]++;
        } else {
            return sum;
        }
    }
}

double dalcs_branch_graph_flow(const struct dalcs_branch_graph *g, int from, int to,
                               const int *without) {
    if (from == to) {
        return INFINITY;
    }
    for (int e = 0; e < g->n_branches; e++) {
        bool is_out = e == without[0] || e == without[1];
        g->room[2 * e] = is_out ? 0.0 : g->branch[e].ahead;
        g->room[2 * e + 1] = is_out ? 0.0 : g->branch[e].back;
    }
    double sum = 0.0;
    while (!isinf(sum) && find_levels(g, from, to, g->work[0], g->work[1])) {
        sum += fill_levels(g, from, to, g->work[0], g->work[2], g->work[3]);
    }
    return sum;
}

/* A heap of vertices, the nearest first. */
struct heap {
    int n;
    int *vertex, *place;
    const double *key;
};

static void sift_up(struct heap *h, int at, int vertex) {
    for (; at > 0 && h->key[h->vertex[(at - 1) / 2]] > h->key[vertex]; at = (at - 1) / 2) {
        h->vertex[at] = h->vertex[(at - 1) / 2];
        h->place[h->vertex[at]] = at;
    }
    h->vertex[at] = vertex;
    h->place[vertex] = at;
}

static int take_nearest(struct heap *h) {
    int nearest = h->vertex[0];
    int last = h->vertex[--h->n];
    int at = 0;
    for (int child = 1; child < h->n; child = 2 * at + 1) {
        if (child + 1 < h->n && h->key[h->vertex[child + 1]] < h->key[h->vertex[child]]) {
            child++;
        }
        if (!(h->key[h->vertex[child]] < h->key[last])) {
            break;
        }
        h->vertex[at] = h->vertex[child];
        h->place[h->vertex[at]] = at;
        at = child;
    }
    if (h->n > 0) {
        h->vertex[at] = last;
        h->place[last] = at;
    }
    h->place[nearest] = -1;
    return nearest;
}

void dalcs_branch_graph_distances(const struct dalcs_branch_graph *g, int from,
                                  const double *length, bool backwards, double *distance) {
    struct heap heap = {.vertex = g->work[0], .place = g->work[1], .key = distance};
    for (int v = 0; v < g->n_vertices; v++) {
        distance[v] = INFINITY;
        heap.place[v] = -1;
    }
    distance[from] = 0.0;
    sift_up(&heap, heap.n++, from);
    while (heap.n > 0) {
        int v = take_nearest(&heap);
        for (int i = g->first[v]; i < g->first[v + 1]; i++) {
            int end = g->end[i];
            int to = across(g, end);
            double way = distance[v] + length[end / 2];
            bool passes = end % 2 == (backwards ? 1 : 0) && g->branch[end / 2].ahead > 0.0;
            if (passes && way < distance[to]) {
                distance[to] = way;
                sift_up(&heap, heap.place[to] >= 0 ? heap.place[to] : heap.n++, to);
            }
        }
    }
}
