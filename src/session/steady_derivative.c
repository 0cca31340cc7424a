/* steady_derivative.c - what a pass with M has found, into the search. */
#include "steady.h"

#include "variation.h"

#include <math.h>
#include <string.h>

void dalcs_steady_read_signature(struct dalcs_steady *st, const struct dalcs_variation *variation) {
    st->pass.signature = 0;
    for (int k = 0; k < variation->n_parts; k++) {
        st->pass.signature = st->pass.signature * 31 + variation->part[k].signature;
    }
}

/* Of the part whose first event comes first. */
void dalcs_steady_read_phase(struct dalcs_steady *st, const struct dalcs_variation *variation) {
    const struct dalcs_variation_part *first = NULL;
    int index = 0;
    memset(st->pass.phase, 0, (size_t)st->layout.n_x * sizeof(double));
    for (int k = 0; k < variation->n_parts; k++) {
        const struct dalcs_variation_part *v = &variation->part[k];
        if (v->n_x > 0 && isfinite(v->moved) && (first == NULL || v->moved < first->moved)) {
            first = v;
            index = k;
        }
    }
    if (first != NULL) {
        memcpy(st->pass.phase + st->layout.first[index], first->moves,
               (size_t)first->n_columns * sizeof(double));
    }
}

void dalcs_steady_read_M(struct dalcs_steady *st, const struct dalcs_variation *variation) {
    st->pass.is_exact = true;
    for (int k = 0; k < variation->n_parts; k++) {
        const struct dalcs_variation_part *v = &variation->part[k];
        const size_t n_x = (size_t)v->n_x;
        const size_t n_rows = (size_t)(st->layout.first[k + 1] - st->layout.first[k]);
        double *M = st->pass.M + st->layout.first_of_M[k];
        double *first = st->pass.first + st->layout.first[k];
        double *last = st->pass.last + st->layout.first[k];
        for (int c = 0; c < v->n_columns; c++) {
            memcpy(M + (size_t)c * n_rows, v->v + (size_t)c * n_x, n_x * sizeof(double));
        }
        memcpy(first, v->first, n_x * sizeof(double));
        memcpy(last, v->last, n_x * sizeof(double));
        if (variation->gates != NULL) {
            dalcs_gate_variation_put(variation->gates, M, first, last);
        }
        st->pass.is_exact = st->pass.is_exact && v->is_exact;
    }
}
