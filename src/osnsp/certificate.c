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

/* The largest |y[begin..end-1]|. Four running maxima: one alone would wait for itself. */
static double largest_of(const double *y, int begin, int end) {
    double m[4] = {0.0, 0.0, 0.0, 0.0};
    int c = begin;
    for (; c + 4 <= end; c += 4) {
        for (int i = 0; i < 4; i++) {
            double a = fabs(y[c + i]);
            m[i] = a > m[i] ? a : m[i];
        }
    }
    for (; c < end; c++) {
        double a = fabs(y[c]);
        m[0] = a > m[0] ? a : m[0];
    }
    m[0] = m[1] > m[0] ? m[1] : m[0];
    m[2] = m[3] > m[2] ? m[3] : m[2];
    return m[2] > m[0] ? m[2] : m[0];
}

static struct scales physical_scales(const struct dalcs_osnsp *p, const double *y) {
    double largest[2] = {0.0, 0.0};
    for (int k = 0; k < p->n_runs; k++) {
        const struct dalcs_unit_run *run = &p->run[k];
        largest[run->is_current] =
            fmax(largest[run->is_current], largest_of(y, run->begin, run->end));
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
        const int *ends = &f->x_ends[2 * x];
        if (ends[0] >= 0) {
            y[x] = y[ends[0]] - y[ends[1]];
            continue;
        }
        double sum = 0.0;
        for (int k = f->X.p[x]; k < f->X.p[x + 1]; k++) {
            sum += f->X.x[k] * y[f->X.j[k]];
        }
        for (int k = f->Xu.p[x]; k < f->Xu.p[x + 1]; k++) {
            sum += f->Xu.x[k] * u[f->Xu.j[k]];
        }
        y[x] = sum;
    }
    for (int x = 0; x < n_x; x++) {
        p->difference[x] = f->sigma * (y[x] - u[x]);
    }
}

/* The sum of |terms| that x+ is recovered from: it is rounded to that. */
static double state_size(const struct dalcs_osnsp *p, const double *u, const double *y, int x) {
    const struct dalcs_step_form *f = p->form[0];
    double size = 0.0;
    for (int k = f->X.p[x]; k < f->X.p[x + 1]; k++) {
        size += fabs(f->X.x[k] * y[f->X.j[k]]);
    }
    for (int k = f->Xu.p[x]; k < f->Xu.p[x + 1]; k++) {
        size += fabs(f->Xu.x[k] * u[f->Xu.j[k]]);
    }
    return size;
}

/* The magnitude of a row: no residual of it is known better than this times a rounding. */
static double row_size(const struct dalcs_osnsp *p, const double *u, const double *y, int r) {
    const struct dalcs_system *s = p->system;
    const double *inputs = u + s->n_x;
    double size = 0.0;
    for (int k = r < s->n_x ? s->P.p[r] : 0; r < s->n_x && k < s->P.p[r + 1]; k++) {
        size += fabs(s->P.x[k]) * p->form[0]->sigma * state_size(p, u, y, s->P.j[k]);
    }
    for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
        size += fabs(s->A.x[k] * y[s->A.j[k]]);
    }
    for (int k = s->E.p[r]; k < s->E.p[r + 1]; k++) {
        size += fabs(s->E.x[k] * inputs[s->E.j[k]]);
    }
    return size;
}

/* Row r's residual. */
static inline double evaluate_row(const struct dalcs_system *s, const double *difference,
                                  const double *y, const double *inputs, int r) {
    double sum = 0.0;
    if (r < s->n_x) {
        for (int k = s->P.p[r]; k < s->P.p[r + 1]; k++) {
            sum -= s->P.x[k] * difference[s->P.j[k]];
        }
    }
    for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
        sum += s->A.x[k] * y[s->A.j[k]];
    }
    for (int k = s->E.p[r]; k < s->E.p[r + 1]; k++) {
        sum += s->E.x[k] * inputs[s->E.j[k]];
    }
    return fabs(sum);
}

static void check_equations(struct dalcs_osnsp *p, const double *u, const double *y,
                            struct scales scale) {
    const struct dalcs_system s = *p->system; /* a copy: nothing that is written can alias it */
    const int *checked = p->form[0]->checked;
    int n_checked = p->form[0]->n_checked;
    const double *difference = p->difference;
    const double floor[2] = {scale.volt, scale.ampere};
    double tolerance = p->options.certificate_tolerance;
    double largest[2] = {0.0, 0.0};
    int where[2] = {-1, -1};
    for (int i = 0; i < n_checked; i++) {
        int r = checked[i];
        double residual = evaluate_row(&s, difference, y, u + s.n_x, r);
        int unit = s.row_is_current[r];
        if (residual <= largest[unit]) {
            continue;
        }
        if (residual <= tolerance * floor[unit]) {
            largest[unit] = residual;
            where[unit] = r;
        } else {
            /* The row's own magnitude is worth computing only where the circuit's is not enough. */
            note(&p->certificate, residual, fmax(floor[unit], row_size(p, u, y, r)), r);
        }
    }
    for (int unit = 0; unit < 2; unit++) {
        note(&p->certificate, largest[unit], floor[unit], where[unit]);
    }
}

/* The current of a diode is known no better than the KCL that it enters. */
static double current_scale(const struct dalcs_osnsp *p, const double *u, const double *y, int pair,
                            double floor) {
    for (int k = p->pair_rows_p[pair]; k < p->pair_rows_p[pair + 1]; k++) {
        floor = fmax(floor, row_size(p, u, y, p->pair_rows[k]));
    }
    return floor;
}

static double pair_size(const struct dalcs_osnsp *p, const double *u, const double *y, int d) {
    const struct dalcs_system *s = p->system;
    double size = 0.0;
    for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
        size += fabs(s->C.x[k] * y[s->C.j[k]]);
    }
    for (int k = s->F.p[d]; k < s->F.p[d + 1]; k++) {
        size += fabs(s->F.x[k] * u[s->n_x + s->F.j[k]]);
    }
    return size;
}

static double pair_voltage(const struct dalcs_osnsp *p, const double *u, const double *y, int d) {
    const struct dalcs_system *s = p->system;
    const int *ends = &p->w_ends[2 * d];
    if (ends[0] >= 0) {
        return y[ends[0]] - y[ends[1]];
    }
    double w = 0.0;
    for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
        w += s->C.x[k] * y[s->C.j[k]];
    }
    for (int k = s->F.p[d]; k < s->F.p[d + 1]; k++) {
        w += s->F.x[k] * u[s->n_x + s->F.j[k]];
    }
    return w;
}

/* A wrong sign beyond rounding is for pivoting to mend; within it, it is part of the residual. */
static void judge_sign(struct dalcs_osnsp *p, int d, double excess, double size) {
    if (excess > p->options.certificate_tolerance * size) {
        p->violating[p->n_violating++] = d;
    } else {
        note(&p->certificate, excess, size, dalcs_system_n_equations(p->system) + d);
    }
}

static void check_pairs(struct dalcs_osnsp *p, const double *u, const double *y,
                        struct scales scale) {
    const struct dalcs_system *s = p->system;
    const double *lambda = y + dalcs_system_n_equations(s);
    double tolerance = p->options.certificate_tolerance;
    int n_equations = dalcs_system_n_equations(s);
    for (int d = 0; d < s->n_pairs; d++) {
        double w = pair_voltage(p, u, y, d);
        bool is_diode = p->is_diode[d];
        if (dalcs_osnsp_is_on(p, d)) {
            /* w = 0 by the mode: what is left of it is a residual. */
            double residual = fabs(w);
            double size = residual <= tolerance * scale.volt
                              ? scale.volt
                              : fmax(scale.volt, pair_size(p, u, y, d));
            note(&p->certificate, residual, size, n_equations + d);
            p->w[d] = 0.0;
            if (is_diode && lambda[d] < 0.0) {
                double size_i = -lambda[d] <= tolerance * scale.ampere
                                    ? scale.ampere
                                    : current_scale(p, u, y, d, scale.ampere);
                judge_sign(p, d, -lambda[d], size_i);
            }
        } else {
            p->w[d] = w;
            if (is_diode && w < 0.0) {
                judge_sign(p, d, -w, fmax(scale.volt, pair_size(p, u, y, d)));
            }
        }
    }
}

/* The reference of a floating island would have to carry what its current sources do not balance. It
 * is the sum of the island's KCL, known as well as the largest of them. */
static void check_references(struct dalcs_osnsp *p, const double *u, const double *y,
                             struct scales scale, bool *sources_clash) {
    const struct dalcs_system *s = p->system;
    for (int k = 0; k < p->n_references; k++) {
        double residual = fabs(y[p->reference[k]]);
        double size = scale.ampere;
        if (residual > p->options.certificate_tolerance * size) {
            for (int r = 0; r < dalcs_system_n_equations(s); r++) {
                size = s->row_is_current[r] ? fmax(size, row_size(p, u, y, r)) : size;
            }
        }
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
    *sources_clash = false;
    recover_states(p, u, y);
    struct scales scale = physical_scales(p, y);
    check_equations(p, u, y, scale);
    check_pairs(p, u, y, scale);
    check_references(p, u, y, scale, sources_clash);
}
