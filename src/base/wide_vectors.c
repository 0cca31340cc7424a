/* wide_vectors.c - what the C library found out of the processor, asked once. */
#include "wide_vectors.h"

#ifdef DALCS_MAY_BE_WIDE
bool dalcs_is_wide = false;

/* A fact of the machine, known before anything runs and never changed. */
__attribute__((constructor)) static void ask(void) {
    dalcs_is_wide = CPU_FEATURE_ACTIVE(AVX2) && CPU_FEATURE_ACTIVE(FMA);
}
#else
typedef int dalcs_no_wide_vectors; /* a file must hold something */
#endif
