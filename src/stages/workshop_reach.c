/* workshop_reach.c - which unknowns a right-hand side reaches, by the pattern of the equations alone.
 *
 * With each unknown stands one equation (a matching of rows to columns). What is in row i moves the unknown of that row, and
 * one that moves is in rows whose unknowns move with it. All others have a 0 in the solution, whatever the numbers and
 * whatever the matching (J. Gilbert, Predicting structure in sparse matrix computations, 1994). Elimination leaves rounding in
 * their places. That is something where what drives it is large: a formula may be 1e20 of what it reads. */
#include "stage_workshop.h"

#include <string.h>

/* Gives column c a row, if need be one that another column has and can do without (augmenting paths). */
static bool match(const struct dalcs_stage_workshop *b, int c) {
    const struct dalcs_workshop_reach *reach = &b->reach;
    for (int k = b->eq.nonzero_p[c]; k < b->eq.nonzero_p[c + 1]; k++) {
        const int row = b->eq.nonzero_i[k];
        if (reach->seen[row]) {
            continue;
        }
        reach->seen[row] = true;
        if (reach->column_of[row] < 0 || match(b, reach->column_of[row])) {
            reach->column_of[row] = c;
            return true;
        }
    }
    return false;
}

static bool match_all(const struct dalcs_stage_workshop *b) {
    bool has_all = true;
    for (int i = 0; i < b->n; i++) {
        b->reach.column_of[i] = -1;
    }
    for (int c = 0; c < b->n && has_all; c++) {
        memset(b->reach.seen, 0, (size_t)b->n * sizeof(bool));
        has_all = match(b, c);
    }
    return has_all;
}

static void add(bool *is_reached, int *queue, int *n_queued, int unknown) {
    if (!is_reached[unknown]) {
        is_reached[unknown] = true;
        queue[(*n_queued)++] = unknown;
    }
}

static void follow(const struct dalcs_stage_workshop *b, int rhs_column) {
    bool *is_reached = b->reach.is_reached + rhs_column * b->n;
    int *queue = b->reach.queue;
    int n_queued = 0;
    for (int i = 0; i < b->n; i++) {
        if (b->eq.plain_rhs[rhs_column * b->n + i] != 0.0) {
            add(is_reached, queue, &n_queued, b->reach.column_of[i]);
        }
    }
    for (int q = 0; q < n_queued; q++) {
        for (int k = b->eq.nonzero_p[queue[q]]; k < b->eq.nonzero_p[queue[q] + 1]; k++) {
            add(is_reached, queue, &n_queued, b->reach.column_of[b->eq.nonzero_i[k]]);
        }
    }
}

void dalcs_workshop_find_reach(struct dalcs_stage_workshop *b) {
    const bool is_known = match_all(b);
    memset(b->reach.is_reached, is_known ? 0 : 1, (size_t)(b->n_rhs * b->n) * sizeof(bool));
    for (int j = 0; j < b->n_rhs && is_known; j++) {
        follow(b, j);
    }
}
