/* wide_vectors.h - functions compiled twice, for the machine at hand and for any.
 *
 *     DALCS_TWICE(double, sum, (int n, const double *a), (n, a)) { ... }
 *
 * defines `static double sum(int n, const double *a)`. The two differ in vector width only, not in any
 * bit of their results: without contraction every element is computed by the same operations in the
 * same order.
 *
 *     DALCS_TWICE_FUSED(double, sum, (DALCS_FUSED, int n, ...), (true, n, ...), (fused, n, ...)) { ... }
 *
 * likewise, with a first parameter `fused` that says whether it may use fma(); called as
 * sum(DALCS_FUSES, n, ...).
 *
 * Which one it is was asked when the program was loaded, of what the C library had found out by then: a
 * compiler's own clones ask the processor at each start, and in a virtual machine that is as long as
 * reading a netlist. */
#ifndef DALCS_WIDE_VECTORS_H
#define DALCS_WIDE_VECTORS_H

#include <stdbool.h>

/* Does every machine that this is compiled for multiply and add at once? Where not, fma() is a call that takes a
 * hundred times as long. */
#ifdef __FP_FAST_FMA
#define DALCS_FUSES true
#else
#define DALCS_FUSES false
#endif
#define DALCS_FUSED __attribute__((unused)) bool fused /* where it is known to be true */

#if defined(__x86_64__) && !defined(__AVX2__) && defined(__has_include)
#if __has_include(<sys/platform/x86.h>)
#include <sys/platform/x86.h>
#endif
#endif

#ifdef CPU_FEATURE_ACTIVE
#define DALCS_MAY_BE_WIDE
extern bool dalcs_is_wide;

#define DALCS_TWICE_FUSED(type, name, parameters, wide_arguments, arguments)                       \
    static inline __attribute__((always_inline)) type name##_body parameters;                      \
    __attribute__((target("avx2,fma"))) static type name##_wide parameters {                       \
        return name##_body wide_arguments;                                                         \
    }                                                                                              \
    static type name parameters {                                                                  \
        return dalcs_is_wide ? name##_wide wide_arguments : name##_body arguments;                 \
    }                                                                                              \
    static inline __attribute__((always_inline)) type name##_body parameters
#else
#define DALCS_TWICE_FUSED(type, name, parameters, wide_arguments, arguments)                       \
    static type name parameters
#endif

#define DALCS_TWICE(type, name, parameters, arguments)                                             \
    DALCS_TWICE_FUSED(type, name, parameters, arguments, arguments)

#endif
