/* residual.c - every row of the raw matrices, every sign.
 *
 * A residual is measured against what its row could be at the largest voltage and current of the
 * problem (unknowns, states before the step, sources, thresholds): the sum of |coefficient| times
 * those, and never less than the largest of the row's own unit; the current of a diode against the
 * KCL that it enters. Amperes and volts vouch for each other through a thousandth of the circuit's
 * typical conductance and resistance (1 S where a circuit has none): a part without current is not
 * asked for more digits than its voltages have. */
#include "residual.h"

#include <math.h>

struct scale {
    double volt, ampere;
};

static double largest_term(const struct dalcs_csr *a, int row, const double *v) {
    double largest = 0.0;
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        largest = fmax(largest, fabs(a->x[k] * v[a->j[k]]));
    }
    return largest;
}

struct conductances {
    double log_sum;
    int n;
};

/* Coefficients of voltages in rows of currents, and the inverse of those the other way round. */
static void add_conductances(struct conductances *g, const struct dalcs_system *s,
                             const struct dalcs_csr *a, int row, bool of_current, double factor) {
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        if (of_current != s->column_is_current[a->j[k]]) {
            double x = fabs(factor * a->x[k]);
            double conductance = of_current ? x : 1.0 / x;
            g->log_sum += log(conductance);
            g->n++;
        }
    }
}

static struct scale scale_of(const struct dalcs_system *s, double sigma, const double *u,
                             const double *y) {
    double largest[2] = {0.0, 0.0};
    struct conductances g = {0};
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        int unit = s->column_is_current[c] ? 1 : 0;
        largest[unit] = fmax(largest[unit], fabs(y[c]));
        largest[unit] = fmax(largest[unit], c < s->n_x && sigma > 0.0 ? fabs(u[c]) : 0.0);
    }
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        int unit = s->row_is_current[r] ? 1 : 0;
        largest[unit] = fmax(largest[unit], largest_term(&s->E, r, u + s->n_x));
        add_conductances(&g, s, &s->A, r, s->row_is_current[r], 1.0);
        if (r < s->n_x && sigma > 0.0) {
            add_conductances(&g, s, &s->P, r, s->row_is_current[r], sigma);
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        largest[0] = fmax(largest[0], largest_term(&s->F, d, u + s->n_x));
        add_conductances(&g, s, &s->C, d, false, 1.0);
    }
    double typical = g.n > 0 ? exp(g.log_sum / g.n) : 1.0;
    double siemens = 1e-3 * typical;
    double ohms = 1e-3 / typical;
    return (struct scale){fmax(largest[0], ohms * largest[1]),
                          fmax(largest[1], siemens * largest[0])};
}

/* The value of a row, and how large it could be. */
struct sum {
    double value, size;
};

static void add_terms(struct sum *sum, const struct dalcs_csr *a, int row, const double *v,
                      double factor) {
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        sum->value += factor * a->x[k] * v[a->j[k]];
    }
}

static void add_size(struct sum *sum, const struct dalcs_system *s, const struct dalcs_csr *a,
                     int row, double factor, struct scale scale) {
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        bool is_current = s->column_is_current[a->j[k]];
        sum->size += fabs(factor * a->x[k]) * (is_current ? scale.ampere : scale.volt);
    }
}

static double part(double residual, double scale) {
    return residual == 0.0 ? 0.0 : residual / scale;
}

/* The largest size of a row that the current of a pair enters. */
static double size_of_current(const struct dalcs_system *s, double sigma, int pair,
                              struct scale scale) {
    int column = dalcs_system_n_equations(s) + pair;
    double largest = scale.ampere;
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        struct sum sum = {0};
        bool enters = false;
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            enters = enters || (s->A.j[k] == column && s->row_is_current[r]);
        }
        add_size(&sum, s, &s->A, r, 1.0, scale);
        if (r < s->n_x && sigma > 0.0) {
            add_size(&sum, s, &s->P, r, sigma, scale);
        }
        largest = enters ? fmax(largest, sum.size) : largest;
    }
    return largest;
}

double residual_of(const struct dalcs_system *s, double sigma, const double *u, const bool *closed,
                   const double *y) {
    int n_equations = dalcs_system_n_equations(s);
    const double *inputs = u + s->n_x;
    const double *lambda = y + n_equations;
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        if (!isfinite(y[c])) {
            return INFINITY;
        }
    }
    const struct scale scale = scale_of(s, sigma, u, y);
    double worst = 0.0;
    double largest_kcl = scale.ampere;
    for (int r = 0; r < n_equations; r++) {
        struct sum sum = {0};
        if (r < s->n_x) {
            add_terms(&sum, &s->P, r, y, -sigma);
            add_terms(&sum, &s->P, r, u, sigma);
            add_size(&sum, s, &s->P, r, sigma, scale);
        }
        add_terms(&sum, &s->A, r, y, 1.0);
        add_terms(&sum, &s->E, r, inputs, 1.0);
        add_size(&sum, s, &s->A, r, 1.0, scale);
        double size = fmax(sum.size, s->row_is_current[r] ? scale.ampere : scale.volt);
        worst = fmax(worst, part(fabs(sum.value), size));
        largest_kcl = s->row_is_current[r] ? fmax(largest_kcl, size) : largest_kcl;
    }
    for (int c = 0; c < n_equations; c++) {
        if (s->column[c].kind == DALCS_LABEL_REFERENCE) {
            worst = fmax(worst, part(fabs(y[c]), largest_kcl));
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        struct sum sum = {0};
        double current_size = size_of_current(s, sigma, d, scale);
        add_terms(&sum, &s->C, d, y, 1.0);
        add_terms(&sum, &s->F, d, inputs, 1.0);
        add_size(&sum, s, &s->C, d, 1.0, scale);
        double w = part(sum.value, fmax(sum.size, scale.volt));
        double i = part(lambda[d], current_size);
        if (s->pair[d].kind == DALCS_PAIR_SWITCH) {
            worst = fmax(worst, closed[d] ? fabs(w) : fabs(i));
        } else {
            worst = fmax(worst, fmax(fmax(-w, -i), fmin(fabs(w), fabs(i))));
        }
    }
    return worst;
}
