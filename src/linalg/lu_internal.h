/* lu_internal.h - what the files behind lu.h share. */
#ifndef DALCS_LU_INTERNAL_H
#define DALCS_LU_INTERNAL_H

#include "lu.h"

/* Places for factors with so many entries beside their diagonals, in lu->storage, if there is one; row pointers,
 * which count, come first. Returns the bytes of it all. */
size_t dalcs_lu_lay_out(struct dalcs_lu *lu, size_t lower, size_t upper);

#endif
