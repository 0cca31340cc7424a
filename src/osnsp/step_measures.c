/* step_measures.c - norms of rows, and the conductances of a system. */
#include "step_measures.h"

#include "magnitudes.h"

#include <float.h>
#include <math.h>

struct conductances {
    double least, most, log_sum;
    int n;
};

/* A coefficient of a voltage in a row of currents is a conductance, the other way round a
 * resistance. */
static void see_conductance(struct conductances *g, bool row_is_current, bool column_is_current,
                            double a) {
    if (row_is_current != column_is_current && a > 0.0) {
        double conductance = row_is_current ? a : 1.0 / a;
        g->least = g->n == 0 ? conductance : fmin(g->least, conductance);
        g->most = fmax(g->most, conductance);
        g->log_sum += log(conductance);
        g->n++;
    }
}

/* The sum of a row over voltages: in KCL that is what leads to the reference, which the diagonal holds among all others. */
struct row_sum {
    long double sum, size;
    int n;
};

static void add_row(struct row_sum *to, const struct dalcs_system *s, const struct dalcs_csr *m,
                    int r, double factor) {
    for (int k = m->p != NULL ? m->p[r] : 0; m->p != NULL && k < m->p[r + 1]; k++) {
        if (!s->column_is_current[m->j[k]]) {
            to->sum += (long double)factor * m->x[k];
            to->size += fabsl((long double)factor * m->x[k]);
            to->n++;
        }
    }
}

static void see_shunt(struct conductances *g, const struct dalcs_system *s, int r, double sigma) {
    struct row_sum to = {0};
    if (!s->row_is_current[r]) {
        return;
    }
    add_row(&to, s, &s->A, r, 1.0);
    add_row(&to, s, &s->A_rest, r, 1.0);
    if (r < s->n_x) {
        add_row(&to, s, &s->P, r, sigma);
    }
    if (fabsl(to.sum) > to.n * LDBL_EPSILON * to.size) { /* else it is rounding */
        g->least = g->n > 0 ? fmin(g->least, (double)fabsl(to.sum)) : g->least;
    }
}

void dalcs_step_form_measure(struct dalcs_step_form *f, const struct dalcs_system *s) {
    int n_equations = dalcs_system_n_equations(s);
    struct conductances g = {0};
    for (int r = 0; r < n_equations; r++) {
        double *norm[2] = {&f->checks.volts[r], &f->checks.amperes[r]};
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            bool is_current = s->column_is_current[s->A.j[k]];
            *norm[is_current] += fabs(s->A.x[k]);
            see_conductance(&g, s->row_is_current[r], is_current, fabs(s->A.x[k]));
        }
        for (int k = r < s->n_x ? s->P.p[r] : 0; r < s->n_x && k < s->P.p[r + 1]; k++) {
            bool is_current = s->column_is_current[s->P.j[k]];
            *norm[is_current] += f->sigma * fabs(s->P.x[k]);
            see_conductance(&g, s->row_is_current[r], is_current, f->sigma * fabs(s->P.x[k]));
        }
        see_shunt(&g, s, r, f->sigma);
    }
    for (int k = 0; k < s->C.p[s->n_pairs]; k++) {
        see_conductance(&g, false, s->column_is_current[s->C.j[k]], fabs(s->C.x[k]));
    }
    double typical = g.n > 0 ? exp(g.log_sum / g.n) : 1.0;
    f->least_conductance = g.n > 0 ? g.least : 1.0;
    f->most_conductance = g.n > 0 ? g.most : 1.0;
    /* A voltage next to a large one is known no better than to its own rounding, whose current may spread where
     * conductances are much smaller than the typical one. */
    f->volt_in_amperes = dalcs_small * typical;
    f->ampere_in_volts = dalcs_small / typical;
}
