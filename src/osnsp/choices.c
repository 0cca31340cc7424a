/* choices.c - equations that take, of what a mode leaves open, the answer of least norm.
 *
 * An answer of least norm is orthogonal to all that is open. What pairs see of that is made independent first
 * (Gram and Schmidt); the rest, which no pair sees, is measured in the unknowns, balanced. */
#include "osnsp_internal.h"
#include "whole.h"

#include <float.h>
#include <math.h>
#include <string.h>

struct choices {
    const struct dalcs_whole *whole;
    const struct dalcs_system *s;
    size_t n_columns, n_pairs;
    double conductance; /* S */
    double *size;       /* [n_choices] of what rounding is of, as pairs see it */
};

static double *vector_of(const struct choices *c, int k) {
    return c->whole->choice + (size_t)k * c->n_columns;
}

static double *voltages_of(const struct choices *c, int k) {
    return c->whole->choice_w + (size_t)k * c->n_pairs;
}

/* sqrt(W): so that pairs all have one norm. */
static double product(const struct choices *c, int i, int k) {
    const double *lambda_i = vector_of(c, i) + (c->n_columns - c->n_pairs);
    const double *lambda_k = vector_of(c, k) + (c->n_columns - c->n_pairs);
    const double *w_i = voltages_of(c, i);
    const double *w_k = voltages_of(c, k);
    double sum = 0.0;
    for (size_t d = 0; d < c->n_pairs; d++) {
        double currents = c->s->pair[d].is_left_out[1] ? 0.0 : lambda_i[d] * lambda_k[d];
        sum += c->conductance * w_i[d] * w_k[d] + currents / c->conductance;
    }
    return sum;
}

static void find_voltages(const struct choices *c, int k) {
    const double *vector = vector_of(c, k);
    const double *lambda = vector + (c->n_columns - c->n_pairs);
    double size = 0.0;
    for (int d = 0; d < c->s->n_pairs; d++) {
        double terms = 0.0;
        for (int i = c->s->C.p[d]; i < c->s->C.p[d + 1]; i++) {
            terms += fabs(c->s->C.x[i] * vector[c->s->C.j[i]]);
        }
        bool is_closed = c->whole->place[c->n_columns - c->n_pairs + (size_t)d] >= 0 ||
                         c->s->pair[d].is_left_out[0];
        voltages_of(c, k)[d] = is_closed ? 0.0 : dalcs_csr_row_dot(&c->s->C, d, vector);
        size += is_closed ? lambda[d] * lambda[d] / c->conductance : c->conductance * terms * terms;
    }
    c->size[k] = sqrt(size);
}

static void swap_vectors(const struct choices *c, int i, int k) {
    for (size_t j = 0; j < c->n_columns && i != k; j++) {
        double value = vector_of(c, i)[j];
        vector_of(c, i)[j] = vector_of(c, k)[j];
        vector_of(c, k)[j] = value;
    }
    for (size_t d = 0; d < c->n_pairs && i != k; d++) {
        double value = voltages_of(c, i)[d];
        voltages_of(c, i)[d] = voltages_of(c, k)[d];
        voltages_of(c, k)[d] = value;
    }
    double size = c->size[i];
    c->size[i] = c->size[k];
    c->size[k] = size;
}

/* Vectors that pairs see come first and are orthogonal to all others; returns how many. */
static int separate(const struct choices *c) {
    double rounding = (double)c->n_columns * DBL_EPSILON;
    int n = 0;
    for (; n < c->whole->n_choices; n++) {
        int best = n;
        double most = 0.0;
        for (int k = n; k < c->whole->n_choices; k++) {
            double seen = sqrt(product(c, k, k));
            if (seen > rounding * c->size[k] && seen > most * c->size[k]) {
                most = seen / c->size[k];
                best = k;
            }
        }
        if (most == 0.0) {
            break;
        }
        swap_vectors(c, n, best);
        double norm = product(c, n, n);
        for (int k = n + 1; k < c->whole->n_choices; k++) {
            double part = product(c, n, k) / norm;
            for (size_t j = 0; j < c->n_columns; j++) {
                vector_of(c, k)[j] -= part * vector_of(c, n)[j];
            }
            for (size_t d = 0; d < c->n_pairs; d++) {
                voltages_of(c, k)[d] -= part * voltages_of(c, n)[d];
            }
            c->size[k] += fabs(part) * c->size[n];
        }
    }
    return n;
}

/* The product with a vector that pairs see, as coefficients of the unknowns and of w - knee. */
static void weigh_by_pairs(const struct choices *c, int k) {
    double *vector = vector_of(c, k);
    double *of_w = voltages_of(c, k);
    memset(vector, 0, (c->n_columns - c->n_pairs) * sizeof(*vector));
    for (size_t d = 0; d < c->n_pairs; d++) {
        vector[c->n_columns - c->n_pairs + d] /= c->conductance;
        of_w[d] *= c->conductance;
    }
    for (int d = 0; d < c->s->n_pairs; d++) {
        for (int i = c->s->C.p[d]; i < c->s->C.p[d + 1]; i++) {
            vector[c->s->C.j[i]] += of_w[d] * c->s->C.x[i];
        }
    }
}

/* That with another one: in the unknowns that condensing keeps, if it has any. */
static void weigh_by_unknowns(const struct choices *c, int k) {
    const struct dalcs_step_form *f = c->whole->p->cache.form[0];
    double *vector = vector_of(c, k);
    bool has_any = false;
    memset(voltages_of(c, k), 0, c->n_pairs * sizeof(double));
    memset(vector + (c->n_columns - c->n_pairs), 0, c->n_pairs * sizeof(double));
    for (int i = 0; i < f->n; i++) {
        has_any = has_any || vector[f->column_of[i]] != 0.0;
    }
    for (size_t j = 0; has_any && j < (size_t)c->s->n_x; j++) {
        bool is_kept = false;
        for (int i = c->s->n_z; i < f->n; i++) {
            is_kept = is_kept || f->column_of[i] == (int)j;
        }
        vector[j] = is_kept ? vector[j] : 0.0;
    }
    for (int i = 0; i < f->n; i++) {
        vector[f->column_of[i]] /= f->scale[i] * f->row_scale[i];
    }
}

static void normalise(const struct choices *c, int k) {
    double most = 0.0;
    for (size_t j = 0; j < c->n_columns; j++) {
        most = fmax(most, fabs(vector_of(c, k)[j]));
    }
    for (size_t j = 0; j < c->n_columns; j++) {
        vector_of(c, k)[j] /= most;
    }
    for (size_t d = 0; d < c->n_pairs; d++) {
        voltages_of(c, k)[d] /= most;
    }
}

enum dalcs_status dalcs_choices_make(struct dalcs_whole *whole) {
    const struct dalcs_system *s = whole->p->system;
    struct choices c = {.whole = whole,
                        .s = s,
                        .n_columns = (size_t)dalcs_system_n_columns(s),
                        .n_pairs = (size_t)s->n_pairs,
                        .conductance = whole->p->cache.form[0]->pair_conductance};
    c.size = dalcs_arena_alloc(&whole->arena, (size_t)whole->n_choices, sizeof(double));
    if (c.size == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < whole->n_choices; k++) {
        find_voltages(&c, k);
    }
    int n_seen = separate(&c);
    for (int k = 0; k < whole->n_choices; k++) {
        if (k < n_seen) {
            weigh_by_pairs(&c, k);
        } else {
            weigh_by_unknowns(&c, k);
        }
        normalise(&c, k);
    }
    return DALCS_OK;
}
