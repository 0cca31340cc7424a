/* kept_stretches.c - stretches one after the other in one array. */
#include "kept_stretches.h"

#include "memory.h"

#include <stdlib.h>
#include <string.h>

enum { N = DALCS_STRETCH_NODES };

struct dalcs_kept_stretches *dalcs_kept_stretches_create(const struct dalcs_stretch *like) {
    struct dalcs_kept_stretches *kept = dalcs_alloc(1, sizeof(*kept));
    if (kept != NULL) {
        size_t parts = like->imaginary != NULL ? 2 : 1;
        kept->n_values = 3 + parts * N * (size_t)like->n_signals;
    }
    return kept;
}

void dalcs_kept_stretches_destroy(struct dalcs_kept_stretches *kept) {
    if (kept != NULL) {
        free(kept->value);
        free(kept);
    }
}

void dalcs_kept_stretches_add(struct dalcs_kept_stretches *kept,
                              const struct dalcs_stretch *stretch) {
    size_t n = N * (size_t)stretch->n_signals;
    if (kept->out_of_memory ||
        dalcs_grow(&kept->value, &kept->capacity, (kept->n + 1) * kept->n_values, sizeof(double)) !=
            DALCS_OK) {
        kept->out_of_memory = true;
        return;
    }
    double *to = kept->value + kept->n++ * kept->n_values;
    bool is_point = stretch->from == stretch->to;
    to[0] = stretch->from;
    to[1] = stretch->to;
    to[2] = stretch->slides ? 1.0 : 0.0;
    memcpy(to + 3, is_point ? stretch->coefficient : stretch->value, n * sizeof(double));
    if (stretch->imaginary != NULL) {
        memcpy(to + 3 + n, stretch->imaginary, n * sizeof(double));
    }
}

void dalcs_kept_stretches_load(const struct dalcs_kept_stretches *kept, size_t k,
                               struct dalcs_stretch *stretch) {
    size_t n = N * (size_t)stretch->n_signals;
    const double *from = kept->value + k * kept->n_values;
    stretch->from = from[0];
    stretch->to = from[1];
    stretch->slides = from[2] != 0.0;
    if (stretch->from == stretch->to) {
        memcpy(stretch->coefficient, from + 3, n * sizeof(double));
    } else {
        memcpy(stretch->value, from + 3, n * sizeof(double));
        for (int i = 0; i < stretch->n_signals; i++) {
            dalcs_stretch_expand(stretch->rule, stretch->value[i], stretch->coefficient[i]);
        }
    }
    if (stretch->imaginary != NULL) {
        memcpy(stretch->imaginary, from + 3 + n, n * sizeof(double));
    }
}
