/* wide_vectors.h - functions compiled twice, for the machine at hand and for any.
 *
 * The clones differ in vector width only, not in any bit of their results: without contraction every
 * element is computed by the same operations in the same order. */
#ifndef DALCS_WIDE_VECTORS_H
#define DALCS_WIDE_VECTORS_H

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define DALCS_FOR_WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define DALCS_FOR_WIDE_VECTORS
#endif

#endif
