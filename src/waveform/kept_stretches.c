/* kept_stretches.c - stretches one after the other in one array. */
#include "kept_stretches.h"

#include "memory.h"

#include <stdlib.h>
#include <string.h>

enum { N = DALCS_STRETCH_NODES };

/* What each is: a stretch that does not slide or one that does, or impulses with the values before them. */
static const double plain = 0.0, slides = 1.0, impulses = 2.0;

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

/* NULL: out of memory. */
static double *one_more(struct dalcs_kept_stretches *kept) {
    if (kept->out_of_memory ||
        dalcs_grow(&kept->value, &kept->capacity, (kept->n + 1) * kept->n_values, sizeof(double)) !=
            DALCS_OK) {
        kept->out_of_memory = true;
        return NULL;
    }
    return kept->value + kept->n++ * kept->n_values;
}

void dalcs_kept_stretches_add(struct dalcs_kept_stretches *kept,
                              const struct dalcs_stretch *stretch) {
    size_t n = N * (size_t)stretch->n_signals;
    double *to = one_more(kept);
    if (to == NULL) {
        return;
    }
    bool is_point = stretch->from == stretch->to;
    to[0] = stretch->from;
    to[1] = stretch->to;
    to[2] = stretch->slides ? slides : plain;
    memcpy(to + 3, is_point ? stretch->coefficient : stretch->value, n * sizeof(double));
    if (stretch->imaginary != NULL) {
        memcpy(to + 3 + n, stretch->imaginary, n * sizeof(double));
    }
}

void dalcs_kept_stretches_add_impulses(struct dalcs_kept_stretches *kept,
                                       const struct dalcs_stretch *stretch, double at) {
    const size_t n = (size_t)stretch->n_signals;
    double *to = one_more(kept);
    if (to != NULL) {
        to[0] = to[1] = at;
        to[2] = impulses;
        memcpy(to + 3, stretch->impulse, n * sizeof(double));
        memcpy(to + 3 + n, stretch->left, n * sizeof(double));
    }
}

bool dalcs_kept_stretches_load(const struct dalcs_kept_stretches *kept, size_t k,
                               struct dalcs_stretch *stretch) {
    size_t n = N * (size_t)stretch->n_signals;
    const double *from = kept->value + k * kept->n_values;
    if (from[2] == impulses) {
        stretch->impulse = from + 3;
        stretch->left = from + 3 + stretch->n_signals;
        return true;
    }
    stretch->from = from[0];
    stretch->to = from[1];
    stretch->slides = from[2] == slides;
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
    return false;
}
