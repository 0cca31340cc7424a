/* lu_internal.h - what the files behind lu.h share. */
#ifndef DALCS_LU_INTERNAL_H
#define DALCS_LU_INTERNAL_H

#include "lu.h"

/* Places for factors with so many entries beside their diagonals, in lu->storage, if there is one; row pointers,
 * which count, come first. Returns the bytes of it all. */
size_t dalcs_lu_lay_out(struct dalcs_lu *lu, size_t lower, size_t upper);

/* What klu_extract fills: L and U by columns with their diagonals, F by columns. Imaginary parts
 * follow behind all real ones. */
struct dalcs_lu_extracted {
    int *Lp, *Li, *Up, *Ui, *Fp, *Fi;
    double *Lx, *Ux, *Fx;
    void *storage; /* of all of them */
};

/* Of numeric; places in lu->storage as well, with the pivots' columns and rows. e->storage is the caller's to free, also on
 * failure. */
enum dalcs_status dalcs_lu_extract(struct dalcs_lu_extracted *e, struct dalcs_lu *lu,
                                   klu_symbolic *symbolic, klu_numeric *numeric,
                                   klu_common *common) DALCS_MUST_CHECK;

/* The rows of both factors in lu, from the columns that were extracted. */
void dalcs_lu_arrange(struct dalcs_lu *lu, const struct dalcs_lu_extracted *e);

#endif
