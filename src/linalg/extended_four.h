/* extended_four.h - four complex systems of one pattern side by side, with twice a double's digits. */
#ifndef DALCS_EXTENDED_FOUR_H
#define DALCS_EXTENDED_FOUR_H

#include <stdbool.h>

/* The same entry of all four. */
struct dalcs_extended_four {
    double re[4], re_low[4], im[4], im_low[4];
};

/* Solves A X = B as dalcs_extended_solve() does, with the same exchanges of rows in all: row i is
 * a[i * (n + n_rhs)] with A first and B behind; X takes the place of B. filled[]: an entry is not 0 in all, and so
 * afterwards. Returns the smallest pivot of all four, up to a factor of sqrt(2); with 0, X means nothing. */
double dalcs_extended_solve_four(int n, int n_rhs, struct dalcs_extended_four *a, bool *filled);

#endif
