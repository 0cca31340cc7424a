/* least_norm.c - of what a mode leaves open, what is seen and what is not. */
#include "least_norm.h"

#include <math.h>

static double product(const double *a, const double *b, int n) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static void subtract(double *a, double factor, const double *b, int n) {
    for (int i = 0; i < n; i++) {
        a[i] -= factor * b[i];
    }
}

static void swap(double *a, double *b, int n) {
    for (int i = 0; i < n; i++) {
        double value = a[i];
        a[i] = b[i];
        b[i] = value;
    }
}

/* Of the vectors from `first` on, the one that is seen most beside its own terms; -1: rounding is all that is seen. */
static int find_largest(const struct dalcs_least_norm *o, int first) {
    int best = -1;
    double most = dalcs_least_norm_rounding(o->n_columns);
    for (int k = first; k < o->n; k++) {
        const double *part = dalcs_least_norm_part(o, k);
        double seen = sqrt(product(part, part, o->n_parts));
        if (seen > most * o->size[k]) {
            most = seen / o->size[k];
            best = k;
        }
    }
    return best;
}

int dalcs_least_norm_separate(const struct dalcs_least_norm *o) {
    for (int n = 0; n < o->n; n++) {
        int best = find_largest(o, n);
        if (best < 0) {
            return n;
        }
        double *vector = dalcs_least_norm_vector(o, n);
        double *part = dalcs_least_norm_part(o, n);
        if (best != n) {
            swap(vector, dalcs_least_norm_vector(o, best), o->n_columns);
            swap(part, dalcs_least_norm_part(o, best), o->n_parts);
            swap(&o->size[n], &o->size[best], 1);
        }
        double norm = product(part, part, o->n_parts);
        for (int k = n + 1; k < o->n; k++) {
            double share = product(part, dalcs_least_norm_part(o, k), o->n_parts) / norm;
            if (share != 0.0) {
                subtract(dalcs_least_norm_vector(o, k), share, vector, o->n_columns);
                subtract(dalcs_least_norm_part(o, k), share, part, o->n_parts);
                o->size[k] += fabs(share) * o->size[n];
            }
        }
    }
    return o->n;
}
