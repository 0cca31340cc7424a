/* residual.c - every row of the raw matrices, every sign.
 *
 * The scale of a row is the larger of the sum of its terms' magnitudes and of the circuit's largest
 * current or voltage. Amperes and volts vouch for each other with a thousandth of the circuit's
 * typical conductance: a part without current is not asked for more digits than its voltages have. */
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

/* The geometric mean of the conductances (and resistances, inverted) among the coefficients. */
static double typical_conductance(const struct dalcs_system *s, double sigma) {
    double sum = 0.0;
    int n = 0;
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            if (s->row_is_current[r] != s->column_is_current[s->A.j[k]]) {
                sum += (s->row_is_current[r] ? 1.0 : -1.0) * log(fabs(s->A.x[k]));
                n++;
            }
        }
    }
    for (int r = 0; sigma > 0.0 && r < s->n_x; r++) {
        for (int k = s->P.p[r]; k < s->P.p[r + 1]; k++) {
            sum += (s->row_is_current[r] ? 1.0 : -1.0) * log(fabs(sigma * s->P.x[k]));
            n++;
        }
    }
    return n > 0 ? exp(sum / n) : 1.0;
}

/* The largest of the unknowns, of the states before the step, of the sources and thresholds. */
static struct scale scale_of(const struct dalcs_system *s, double sigma, const double *u,
                             const double *y) {
    double largest[2] = {0.0, 0.0};
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        int unit = s->column_is_current[c] ? 1 : 0;
        largest[unit] = fmax(largest[unit], fabs(y[c]));
        largest[unit] = fmax(largest[unit], c < s->n_x && sigma > 0.0 ? fabs(u[c]) : 0.0);
    }
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        int unit = s->row_is_current[r] ? 1 : 0;
        largest[unit] = fmax(largest[unit], largest_term(&s->E, r, u + s->n_x));
    }
    for (int d = 0; d < s->n_pairs; d++) {
        largest[0] = fmax(largest[0], largest_term(&s->F, d, u + s->n_x));
    }
    double volt = largest[0];
    double ampere = largest[1];
    double conductance = typical_conductance(s, sigma);
    return (struct scale){fmax(volt, 1e-3 * ampere / conductance),
                          fmax(ampere, 1e-3 * volt * conductance)};
}

struct sum {
    double value, magnitude;
};

static void add(struct sum *sum, double term) {
    sum->value += term;
    sum->magnitude += fabs(term);
}

static void add_row(struct sum *sum, const struct dalcs_csr *a, int row, const double *v) {
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        add(sum, a->x[k] * v[a->j[k]]);
    }
}

static double part(double residual, double scale) {
    return residual == 0.0 ? 0.0 : residual / scale;
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
    struct scale scale = scale_of(s, sigma, u, y);
    double worst = 0.0;
    double largest_current = scale.ampere;
    for (int r = 0; r < n_equations; r++) {
        struct sum sum = {0};
        for (int k = s->P.p[r]; r < s->n_x && k < s->P.p[r + 1]; k++) {
            add(&sum, -sigma * s->P.x[k] * y[s->P.j[k]]);
            add(&sum, sigma * s->P.x[k] * u[s->P.j[k]]);
        }
        add_row(&sum, &s->A, r, y);
        add_row(&sum, &s->E, r, inputs);
        double size = fmax(sum.magnitude, s->row_is_current[r] ? scale.ampere : scale.volt);
        worst = fmax(worst, part(fabs(sum.value), size));
        largest_current = s->row_is_current[r] ? fmax(largest_current, size) : largest_current;
    }
    for (int c = 0; c < n_equations; c++) {
        if (s->column[c].kind == DALCS_LABEL_REFERENCE) {
            worst = fmax(worst, part(fabs(y[c]), largest_current));
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        struct sum w = {0};
        add_row(&w, &s->C, d, y);
        add_row(&w, &s->F, d, inputs);
        double v = w.value / fmax(fmax(w.magnitude, scale.volt), 1e-300);
        double i = lambda[d] / fmax(scale.ampere, 1e-300);
        if (s->pair[d].kind == DALCS_PAIR_SWITCH) {
            worst = fmax(worst, closed[d] ? fabs(v) : fabs(i));
        } else {
            worst = fmax(worst, fmax(fmax(-v, -i), fmin(fabs(v), fabs(i))));
        }
    }
    return worst;
}
