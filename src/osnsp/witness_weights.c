/* witness_weights.c - the elements whose equations contradict each other, from the weights under which they do (farkas.h). */
#include "osnsp_internal.h"

#include "magnitudes.h"

#include <math.h>

/* Sources that enter an equation. */
static void add_inputs(struct dalcs_osnsp *p, int r) {
    const struct dalcs_csr *of = &p->system->E;
    for (int k = of->p[r]; k < of->p[r + 1]; k++) {
        if (of->j[k] > 0 && of->x[k] != 0.0) {
            dalcs_witness_add(&p->weighed, p->system->input_element[of->j[k]]);
        }
    }
}

/* Sources by what the circuit has in it, which have no equation of their own. */
static void add_readers(struct dalcs_osnsp *p, int r) {
    const struct dalcs_csr *reads = &p->system->reads;
    for (int k = reads->p == NULL ? 0 : reads->p[r]; reads->p != NULL && k < reads->p[r + 1]; k++) {
        dalcs_witness_add(&p->weighed, p->system->reader[k]);
    }
}

/* V, A: the largest weight of equations in volts, and of those in amperes; how many equations have one. */
static int largest_weights(const struct dalcs_system *s, const double *v, double *largest) {
    int n_rows = 0;
    largest[0] = largest[1] = 0.0;
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        double *of = &largest[s->row_is_current[r]];
        *of = fmax(*of, fabs(v[r]));
        n_rows += v[r] != 0.0;
    }
    return n_rows;
}

/* What the weighted equations add up to for the current of a pair; *size: without their signs. */
static double current_of_pair(const struct dalcs_system *s, const double *v, int pair,
                              double *size) {
    int n_equations = dalcs_system_n_equations(s);
    double sum = 0.0;
    *size = 0.0;
    for (int r = 0; r < n_equations + s->n_pairs; r++) {
        const struct dalcs_csr *of = r < n_equations ? &s->A : &s->C;
        int row = r < n_equations ? r : r - n_equations;
        for (int k = of->p[row]; k < of->p[row + 1]; k++) {
            if (of->j[k] == n_equations + pair) {
                sum += (r < n_equations ? -1.0 : 1.0) * v[r] * of->x[k];
                *size += fabs(v[r] * of->x[k]);
            }
        }
    }
    return sum;
}

/* Do the weights use that one of its two sides is 0 or not negative? */
static bool is_weighed(const struct dalcs_system *s, const double *v, int pair, double largest) {
    int n_equations = dalcs_system_n_equations(s);
    double size;
    double sum = current_of_pair(s, v, pair, &size);
    double side = fmax(fabs(v[n_equations + pair]), fabs(v[n_equations + s->n_pairs + pair]));
    return side > dalcs_nothing * largest || fabs(sum) > dalcs_nothing * size;
}

void dalcs_witness_from_weights(struct dalcs_osnsp *p, const double *v) {
    const struct dalcs_system *s = p->system;
    int n_equations = dalcs_system_n_equations(s);
    double largest[2];
    bool is_alone = largest_weights(s, v, largest) == 1; /* what enters a node has cancelled */
    p->weighed.n_elements = 0;
    p->weighed.kind = DALCS_WITNESS_EQUATIONS;
    for (int r = 0; r < n_equations; r++) {
        if (!(fabs(v[r]) > dalcs_nothing * largest[s->row_is_current[r]])) {
            continue;
        }
        add_inputs(p, r);
        add_readers(p, r);
        if (s->row[r].kind == DALCS_LABEL_BRANCH || s->row[r].kind == DALCS_LABEL_STATE ||
            (s->row[r].kind == DALCS_LABEL_NODE && is_alone)) {
            dalcs_witness_add(&p->weighed, s->row[r].element);
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        if (is_weighed(s, v, d, fmax(largest[0], largest[1]))) {
            dalcs_witness_add(&p->weighed, s->pair[d].element);
        }
    }
}
