/* sdpa.h - semidefinite programs
 *
 *     minimise c'x   such that   F_0 + x_1 F_1 + ... + x_n F_n >= 0 in each block,
 *
 * each F symmetric. The program sdpa (M. Yamashita and others, GPL) solves them: it is run on a file, so
 * that neither its licence nor its ways to end a program are this library's. Its answer is a number
 * among others: the caller must verify it. */
#ifndef DALCS_SDPA_H
#define DALCS_SDPA_H

#include "matrix.h"

#include <stdio.h>

/* One problem while it is written. Zero-initialise; finish in any case. */
struct dalcs_sdpa {
    struct dalcs_arena *arena;
    int n, n_blocks;
    int *size;           /* [n_blocks] rows */
    const char *folder;  /* NULL: none could be made */
    const char *path[4]; /* its files in there */
    FILE *problem;       /* or NULL */
    bool lacks_memory;
    const char *why; /* that it is not solved; NULL: nothing is wrong */
};

struct dalcs_sdpa_answer {
    bool is_solved;
    const char *why;           /* not solved */
    double *x;                 /* [n] */
    struct dalcs_matrix *dual; /* [n_blocks] Y >= 0 with tr(F_i Y) = c_i */
};

/* The reason why no program can be solved here, as a message; NULL: none. */
const char *dalcs_sdpa_missing(void);

/* size[n_blocks] and cost[n] are read at once. A file that cannot be written is no error: `solve` says
 * so. */
enum dalcs_status dalcs_sdpa_begin(struct dalcs_sdpa *s, struct dalcs_arena *arena, int n,
                                   const double *cost, int n_blocks,
                                   const int *size) DALCS_MUST_CHECK;

/* F_variable (0: the constant one) has `block` in this place; of `m` the upper triangle is read. Once for
 * each. */
void dalcs_sdpa_put(struct dalcs_sdpa *s, int variable, int block, const struct dalcs_matrix *m);

enum dalcs_status dalcs_sdpa_solve(struct dalcs_sdpa *s,
                                   struct dalcs_sdpa_answer *answer) DALCS_MUST_CHECK;

/* Removes its files. */
void dalcs_sdpa_finish(struct dalcs_sdpa *s);

#endif
