/* open_mode.c - of all answers that a singular mode leaves open, the one of least norm that has the right signs.
 *
 * They are y + sum t_k n_k. With directions n_k that are orthonormal to the pairs, sum G w^2 + lambda^2 / G, the least
 * |t| with V t + b >= 0 for the signs b of y is t = V' a, where
 *     0 <= a _|_ V V' a + b >= 0
 * (C. L. Lawson and R. J. Hanson, Solving Least Squares Problems, 1974, ch. 23): a linear complementarity problem with
 * a positive semidefinite matrix, whatever the circuit is, so that Lemke's method ends in its answer or shows that there
 * is none. With a + b = s it is a - b = (2 (1 + V V')^-1 - 1) s - 2 (1 + V V')^-1 b. Where the circuit is passive the
 * proximal iterates come to it; elsewhere every mode is tried, and has to be asked for more than its answer of least
 * norm. */
#include "lemke.h"
#include "osnsp_internal.h"
#include "whole.h"

#include <float.h>
#include <math.h>
#include <string.h>

struct open_mode {
    struct dalcs_osnsp *p;
    struct dalcs_whole whole;
    size_t n_columns, n_pairs;
    int n;             /* directions that pairs see */
    double *direction; /* [n_choices][n_columns] */
    double *part;      /* [n_choices][n_pairs] what they are to each pair, in units of one conductance */
    double *sign;      /* [n_pairs] b */
    double *inverse;   /* [n][n] of 1 + V' V */
    struct dalcs_lemke lemke;
    struct dalcs_arena arena;
};

/* lambda of closed pairs and w of open ones, of an answer or of a direction. */
static void look_at_pairs(const struct open_mode *m, const double *y, double *part) {
    const struct dalcs_system *s = m->p->system;
    double root = sqrt(m->p->form[0]->pair_conductance);
    for (int d = 0; d < s->n_pairs; d++) {
        double lambda = y[m->n_columns - m->n_pairs + (size_t)d];
        part[d] = dalcs_osnsp_is_on(m->p, d) ? lambda / root
                                             : dalcs_csr_row_dot(&s->C, d, y) * root;
    }
}

static double product(const double *a, const double *b, size_t n) {
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static void subtract(double *a, const double *b, double factor, size_t n) {
    for (size_t i = 0; i < n; i++) {
        a[i] -= factor * b[i];
    }
}

/* Gram and Schmidt; a direction of which nothing but rounding is left says nothing new to the pairs. */
static void find_directions(struct open_mode *m) {
    for (int k = 0; k < m->whole.n_choices; k++) {
        double *direction = m->direction + (size_t)m->n * m->n_columns;
        double *part = m->part + (size_t)m->n * m->n_pairs;
        dalcs_whole_direction(&m->whole, k, direction);
        look_at_pairs(m, direction, part);
        double before = product(part, part, m->n_pairs);
        for (int j = 0; j < m->n; j++) {
            double factor = product(part, m->part + (size_t)j * m->n_pairs, m->n_pairs);
            subtract(part, m->part + (size_t)j * m->n_pairs, factor, m->n_pairs);
            subtract(direction, m->direction + (size_t)j * m->n_columns, factor, m->n_columns);
        }
        double norm = product(part, part, m->n_pairs);
        if (norm > (double)m->n_columns * DBL_EPSILON * before) {
            subtract(part, part, 1.0 - 1.0 / sqrt(norm), m->n_pairs);
            subtract(direction, direction, 1.0 - 1.0 / sqrt(norm), m->n_columns);
            m->n++;
        }
    }
}

static const double *row_of(const struct open_mode *m, int k) {
    return m->part + (size_t)k * m->n_pairs;
}

/* Of a matrix that is at least 1, by Gauss and Jordan. */
static void invert(struct open_mode *m) {
    size_t n = (size_t)m->n;
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            double sum = i == k ? 1.0 : 0.0;
            for (size_t d = 0; d < m->n_pairs; d++) {
                sum += m->p->is_diode[d] ? row_of(m, (int)i)[d] * row_of(m, (int)k)[d] : 0.0;
            }
            m->inverse[i * n + k] = sum;
        }
    }
    for (size_t i = 0; i < n; i++) {
        double pivot = m->inverse[i * n + i];
        for (size_t r = 0; r < n; r++) {
            double factor = r == i ? 0.0 : m->inverse[r * n + i] / pivot;
            for (size_t k = 0; k < n && r != i; k++) {
                m->inverse[r * n + k] -= k == i ? 0.0 : factor * m->inverse[i * n + k];
            }
            m->inverse[r * n + i] = r == i ? 1.0 / pivot : -factor;
        }
        for (size_t k = 0; k < n; k++) {
            m->inverse[i * n + k] *= k == i ? 1.0 : 1.0 / pivot;
        }
    }
}

/* (1 + V V')^-1 = 1 - V (1 + V' V)^-1 V' */
static double resolvent(const struct open_mode *m, size_t i, size_t k) {
    double sum = i == k ? 1.0 : 0.0;
    for (int a = 0; a < m->n; a++) {
        for (int b = 0; b < m->n; b++) {
            sum -= row_of(m, a)[i] * m->inverse[(size_t)a * (size_t)m->n + (size_t)b] *
                   row_of(m, b)[k];
        }
    }
    return sum;
}

static void pose(struct open_mode *m) {
    size_t n = m->n_pairs;
    double less = 1.0 - DBL_EPSILON; /* and the problem has exactly one answer */
    for (size_t i = 0; i < n; i++) {
        bool is_diode = m->p->is_diode[i];
        m->lemke.law[i] = is_diode ? DALCS_LEMKE_EITHER : DALCS_LEMKE_B_FREE;
        m->lemke.h[i] = 0.0;
        for (size_t k = 0; k < n; k++) {
            double r = is_diode && m->p->is_diode[k] ? resolvent(m, i, k) : 0.0;
            m->lemke.S[i * n + k] = less * (2.0 * r - (i == k ? 1.0 : 0.0));
            m->lemke.h[i] -= 2.0 * r * m->sign[k];
        }
    }
}

/* The signs that are 0 in the answer: V_i (V' a) + b_i = 0 for these, solved for t with the least |t| by as many
 * sweeps of Kaczmarz's projections as gain all digits. */
static void move(struct open_mode *m, double *y) {
    enum { SWEEPS = 200 };

    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (size_t i = 0; i < m->n_pairs; i++) {
            double norm = 0.0;
            for (int k = 0; k < m->n; k++) {
                norm += row_of(m, k)[i] * row_of(m, k)[i];
            }
            bool is_bound = m->p->is_diode[i] && m->lemke.is_a[i] && norm > 0.0;
            double factor = is_bound ? m->sign[i] / norm : 0.0;
            for (int k = 0; k < m->n && factor != 0.0; k++) {
                double t = factor * row_of(m, k)[i];
                subtract(y, m->direction + (size_t)k * m->n_columns, t, m->n_columns);
                subtract(m->sign, row_of(m, k), t, m->n_pairs);
            }
        }
    }
}
