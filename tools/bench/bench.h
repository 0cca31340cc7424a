/* bench.h - clock and statistics of the benchmarks. */
#ifndef DALCS_BENCH_H
#define DALCS_BENCH_H

#include "dalcs.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* Seconds of this process. */
static inline double bench_now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline int bench_compare(const void *a, const void *b) {
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

static inline double bench_median(double *v, int n) {
    qsort(v, (size_t)n, sizeof(*v), bench_compare);
    return v[n / 2];
}

static inline void bench_must(enum dalcs_status status, const char *what) {
    if (status != DALCS_OK) {
        fprintf(stderr, "bench: %s: %s\n", what, dalcs_status_text(status));
        exit(1);
    }
}

#endif
