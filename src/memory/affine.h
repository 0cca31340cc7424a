/* affine.h - functions of a few states, affine in them: composed, and evaluated many times. */
#ifndef DALCS_AFFINE_H
#define DALCS_AFFINE_H

/* [n_x] factors, a constant. */
struct dalcs_affine_rows {
    int n;
    double *row; /* [n][n_x + 1] */
};

/* Four rows side by side: their constants, then their factors. The last ones may be the same row again. */
struct dalcs_affine_quads {
    int n; /* of rows; in whole quads when they are filled up */
    double *number;
};

/* to = rows of `of`, a function of what `inner` gives. */
void dalcs_affine_compose(int n_x, const struct dalcs_affine_rows *of, const long double *inner,
                          long double *to);

/* n rows. */
void dalcs_affine_round(int n_x, int n, const long double *from, double *to);

/* One more, for which there is room. */
void dalcs_affine_quads_put(int n_x, const long double *row, struct dalcs_affine_quads *all);
void dalcs_affine_quads_fill_up(int n_x, struct dalcs_affine_quads *all);

/* The least of all at x; INFINITY: there are none. */
double dalcs_affine_quads_least(int n_x, const struct dalcs_affine_quads *all, const double *x);

/* Takes states[0] through map[n_x] again and again until one has moved from `near` by more than most[n_x], which
 * are then in states[1], or it has been so `times`. Returns how often it has. */
long dalcs_affine_pass(int n_x, const double *map, const double *near, const double *most,
                       long times, double **states);

static inline void dalcs_affine_swap(double **states) {
    double *first = states[0];
    states[0] = states[1];
    states[1] = first;
}

#endif
