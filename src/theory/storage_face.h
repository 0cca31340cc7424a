/* storage_face.h - which P can make a system passive at all: units, and what is in the kernel of every Q(P)
 * (storage.h). */
#ifndef DALCS_STORAGE_FACE_H
#define DALCS_STORAGE_FACE_H

#include "step_blocks.h"

struct dalcs_face {
    struct dalcs_arena *arena;
    const struct dalcs_quadruple *given;
    struct dalcs_quadruple q; /* scaled */
    double *unit;             /* [n + m] of states, then of pairs */
    double time;              /* s, its unit */
    int n, m;
    struct dalcs_matrix kernel;     /* [n + m][columns] what is known of the kernel of every Q(P) */
    struct dalcs_matrix complement; /* [n + m][...] orthogonal to it */
    struct dalcs_matrix base;       /* [n][n] a P with Q(P) kernel = 0 */
    int n_free;
    struct dalcs_matrix free;    /* [n (n + 1)/2][n_free] and what may be added to it */
    bool is_gaining;             /* a form that must be >= 0 is not */
    struct dalcs_matrix gaining; /* [n + m][...] vectors whose v v' sum to a Z; rows 0: none kept */
};

/* Fills s, of which arena, given, n and m are set, but base and free. */
enum dalcs_status dalcs_face_kernel(struct dalcs_face *s) DALCS_MUST_CHECK;

/* The P with Q(P) kernel = 0: base + free. False when there is none. */
enum dalcs_status dalcs_face_find(struct dalcs_face *s, bool *exists) DALCS_MUST_CHECK;

/* Q(P) in scaled units; without the constant its linear part. */
enum dalcs_status dalcs_face_dissipation(const struct dalcs_face *s, const struct dalcs_matrix *P,
                                         bool with_constant, struct dalcs_matrix *Q,
                                         struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* The k-th direction of free. */
enum dalcs_status dalcs_face_direction(const struct dalcs_face *s, int k, struct dalcs_matrix *P,
                                       struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* m's element (i, j) times factor left[i] (or over it, inverse) right[j]. */
void dalcs_face_scale(struct dalcs_matrix *m, const double *left, bool inverse, const double *right,
                      double factor);

/* States x -> x/unit so that what drives them is as large as what they drive, pairs u -> u/unit, y -> y
 * unit likewise, so that their power stays; then time so that A is 1. */
enum dalcs_status dalcs_face_choose_units(struct dalcs_face *s);

#endif
