/* cone_assembly.h - a described system on its way to the one that the engine runs: what cones.c and the files beside it share. */
#ifndef DALCS_CONE_ASSEMBLY_H
#define DALCS_CONE_ASSEMBLY_H

#include "reading.h"

/* Where multiplier j of the file went: lambda = offset + sign * column, and w = sign * row. */
struct dalcs_multiplier_place {
    int column;
    int row;      /* of C, or, of a free one, of A */
    bool is_free; /* an unknown */
    double sign, offset;
    int bound; /* the pairs of a box: up, then down; -1: none */
};

struct dalcs_assembly {
    const struct dalcs_described_system *from;
    struct dalcs_system *s;
    struct dalcs_multiplier_place *place; /* [n_multipliers] */
    int *lifted; /* [n_inputs] column u of an input, i behind it; -1: it stays an input */
    int n_lifted;
    struct dalcs_triplets P, A, E, C, F, storage, control, direct_control;
};

/* ---- cone_labels.c ------------------------------------------------------------------------- */

void dalcs_label_inputs(const struct dalcs_reading *r, struct dalcs_assembly *a);
void dalcs_label_column(struct dalcs_system *s, int c, const struct dalcs_described_column *d);
void dalcs_label_pairs(struct dalcs_assembly *a);
enum dalcs_status dalcs_label_lifted(struct dalcs_reading *r,
                                     struct dalcs_assembly *a) DALCS_MUST_CHECK;

/* A row without a card of its own has its column's name, and the unit whose product with that of the column is a power. */
void dalcs_label_rows(struct dalcs_assembly *a);

/* Numbers of columns that rows and trees name. If not, it is told. */
bool dalcs_labels_fit(struct dalcs_reading *r, const struct dalcs_assembly *a);

/* ---- cone_storage.c ------------------------------------------------------------------------ */

/* P must be nonsingular. If not, it is told. */
bool dalcs_storage_is_regular(struct dalcs_reading *r, const struct dalcs_assembly *a);

/* Of x' = A x + B lambda with a storage of its own: S x' = S A x + S B lambda, the form in which S B = C' shows as
 * skewness. */
enum dalcs_status dalcs_scale_by_storage(struct dalcs_assembly *a) DALCS_MUST_CHECK;

#endif
