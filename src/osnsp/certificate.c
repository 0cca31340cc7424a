/* certificate.c - the proof that comes with every accepted step.
 *
 * Nothing of how the answer was found is used: the rows of the system itself are evaluated with
 * (x_k, s) and (x+, z+, lambda+), each residual against its own scale, the larger of the sum of its
 * terms' magnitudes and of the circuit's largest voltage or current. Voltages and currents vouch for
 * each other through the typical conductance of a diode's surroundings, so that a part without
 * current is not asked for more digits than its voltages have. */
#include "osnsp_internal.h"

#include <math.h>

/* How far a scale of one unit reaches into the other. */
static const double cross_floor = 1e-3;

struct scales {
    double volt, ampere;
};

static struct scales physical_scales(const struct dalcs_osnsp *p, const double *y) {
    const struct dalcs_system *s = p->system;
    int n_equations = dalcs_system_n_equations(s);
    int n_columns = dalcs_system_n_columns(s);
    const bool *is_current = s->column_is_current;
    double largest[2] = {0.0, 0.0};
    for (int c = 0; c < n_equations; c++) {
        double a = fabs(y[c]);
        double *unit = &largest[is_current[c]];
        *unit = a > *unit ? a : *unit;
    }
    for (int c = n_equations; c < n_columns; c++) {
        double a = fabs(y[c]);
        largest[1] = a > largest[1] ? a : largest[1];
    }
    double g = cross_floor * p->form[0]->pair_conductance;
    double r = cross_floor / p->form[0]->pair_conductance;
    return (struct scales){fmax(largest[0], r * largest[1]), fmax(largest[1], g * largest[0])};
}

static void note(struct dalcs_certificate *c, double residual, double scale, int where) {
    if (residual > c->worst * scale) {
        c->worst = residual / scale;
        c->where = where;
    }
    if (!(residual <= 1e300)) { /* NaN or overflow: never certified */
        c->worst = INFINITY;
        c->where = where;
    }
}

static void recover_states(const struct dalcs_osnsp *p, const double *u, double *y) {
    const struct dalcs_step_form *f = p->form[0];
    int n_x = p->system->n_x;
    for (int x = 0; x < n_x; x++) {
        double sum = 0.0;
        double size = 0.0;
        for (int k = f->X.p[x]; k < f->X.p[x + 1]; k++) {
            double term = f->X.x[k] * y[f->X.j[k]];
            sum += term;
            size += fabs(term);
        }
        for (int k = f->Xu.p[x]; k < f->Xu.p[x + 1]; k++) {
            double term = f->Xu.x[k] * u[f->Xu.j[k]];
            sum += term;
            size += fabs(term);
        }
        y[x] = sum;
        p->state_size[x] = size;
    }
    for (int x = 0; x < n_x; x++) {
        p->difference[x] = f->sigma * (y[x] - u[x]);
    }
}

static void check_equations(struct dalcs_osnsp *p, const double *u, const double *y,
                            struct scales scale) {
    const struct dalcs_system *s = p->system;
    const struct dalcs_step_form *f = p->form[0];
    const double *inputs = u + s->n_x;
    for (int i = 0; i < f->n_checked; i++) {
        int r = f->checked[i];
        double sum = 0.0;
        double size = 0.0;
        if (r < s->n_x) {
            for (int k = s->P.p[r]; k < s->P.p[r + 1]; k++) {
                /* x+ is the rounded difference of two voltages: the row is known no better. */
                sum -= s->P.x[k] * p->difference[s->P.j[k]];
                size += fabs(s->P.x[k]) * f->sigma * p->state_size[s->P.j[k]];
            }
        }
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            double term = s->A.x[k] * y[s->A.j[k]];
            sum += term;
            size += fabs(term);
        }
        for (int k = s->E.p[r]; k < s->E.p[r + 1]; k++) {
            double term = s->E.x[k] * inputs[s->E.j[k]];
            sum += term;
            size += fabs(term);
        }
        double unit = s->row_is_current[r] ? scale.ampere : scale.volt;
        size = size > unit ? size : unit;
        p->magnitude[r] = size;
        note(&p->certificate, fabs(sum), size, r);
    }
}

/* The current of a diode is known no better than the KCL that it enters. */
static double current_scale(const struct dalcs_osnsp *p, int pair, double floor) {
    for (int k = p->pair_rows_p[pair]; k < p->pair_rows_p[pair + 1]; k++) {
        floor = fmax(floor, p->magnitude[p->pair_rows[k]]);
    }
    return floor;
}

static void check_pairs(struct dalcs_osnsp *p, const double *u, const double *y,
                        struct scales scale) {
    const struct dalcs_system *s = p->system;
    const double *inputs = u + s->n_x;
    const double *lambda = y + dalcs_system_n_equations(s);
    double tolerance = p->options.certificate_tolerance;
    int n_equations = dalcs_system_n_equations(s);
    for (int d = 0; d < s->n_pairs; d++) {
        double w = 0.0;
        double size = 0.0;
        for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
            double term = s->C.x[k] * y[s->C.j[k]];
            w += term;
            size += fabs(term);
        }
        for (int k = s->F.p[d]; k < s->F.p[d + 1]; k++) {
            double term = s->F.x[k] * inputs[s->F.j[k]];
            w += term;
            size += fabs(term);
        }
        size = size > scale.volt ? size : scale.volt;
        bool is_diode = s->pair[d].kind == DALCS_PAIR_DIODE;
        if (dalcs_osnsp_is_on(p, d)) {
            /* w = 0 by the mode: what is left of it is a residual, and so is a negative current. */
            note(&p->certificate, fabs(w), size, n_equations + d);
            p->w[d] = 0.0;
            if (is_diode && lambda[d] < 0.0 && -lambda[d] > tolerance * scale.ampere) {
                double local = current_scale(p, d, scale.ampere);
                if (-lambda[d] > tolerance * local) {
                    p->violating[p->n_violating++] = d;
                } else {
                    note(&p->certificate, -lambda[d], local, n_equations + d);
                }
            }
        } else {
            p->w[d] = w;
            if (is_diode && w < 0.0) {
                if (-w > tolerance * size) {
                    p->violating[p->n_violating++] = d;
                } else {
                    note(&p->certificate, -w, size, n_equations + d);
                }
            }
        }
    }
}

/* The reference of a floating island would have to carry what its current sources do not balance. It
 * is the sum of the island's KCL, known as well as the largest of them. */
static void check_references(struct dalcs_osnsp *p, const double *y, struct scales scale,
                             bool *sources_clash) {
    const struct dalcs_system *s = p->system;
    double size = scale.ampere;
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        size = s->row_is_current[r] ? fmax(size, p->magnitude[r]) : size;
    }
    for (int k = 0; k < p->n_references; k++) {
        double residual = fabs(y[p->reference[k]]);
        if (residual > p->options.certificate_tolerance * size) {
            *sources_clash = true;
        }
        note(&p->certificate, residual, size, p->reference_row[k]);
    }
}

void dalcs_certificate_evaluate(struct dalcs_osnsp *p, const double *u, double *y,
                                bool *sources_clash) {
    p->certificate = (struct dalcs_certificate){.where = -1};
    p->n_violating = 0;
    recover_states(p, u, y);
    struct scales scale = physical_scales(p, y);
    check_equations(p, u, y, scale);
    check_pairs(p, u, y, scale);
    *sources_clash = false;
    if (p->n_references > 0) {
        check_references(p, y, scale, sources_clash);
    }
}
