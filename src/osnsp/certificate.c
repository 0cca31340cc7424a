/* certificate.c - the proof that comes with every accepted step.
 *
 * Nothing of how the answer was found is used: the rows of the system itself are evaluated with
 * (x_k, s) and (x+, z+, lambda+), and each residual and each wrong sign is measured on a scale of its own (scales.h). */
#include "scales.h"

#include "magnitudes.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

static void note(struct dalcs_certificate *c, double residual, double scale, int where) {
    if (residual > c->worst * scale) {
        c->worst = scale > 0.0 ? residual / scale : INFINITY;
        c->where = where;
    }
    if (!(residual < INFINITY)) { /* NaN or overflow: never certified */
        c->worst = INFINITY;
        c->where = where;
    }
}

static void recover_states(const struct dalcs_osnsp *p, const double *u, double *y) {
    const struct dalcs_step_form *f = p->cache.form[0];
    int n_x = p->system->n_x;
    for (int x = 0; x < n_x; x++) {
        const int *ends = f->state.ends + 2 * x;
        if (ends[0] >= 0) {
            y[x] = y[ends[0]] - y[ends[1]];
            continue;
        }
        if (p->asks.keeps_states && f->state.Xu.p[x] < f->state.Xu.p[x + 1]) {
            continue;
        }
        double sum = 0.0;
        for (int k = f->state.X.p[x]; k < f->state.X.p[x + 1]; k++) {
            sum += f->state.X.x[k] * y[f->state.X.j[k]];
        }
        for (int k = f->state.Xu.p[x]; k < f->state.Xu.p[x + 1]; k++) {
            sum += f->state.Xu.x[k] * u[f->state.Xu.j[k]];
        }
        y[x] = sum;
    }
    for (int x = 0; x < n_x; x++) {
        p->work.difference[x] = f->sigma * (y[x] - u[x]);
    }
}

static void check_equations(struct dalcs_osnsp *p, const double *u, const double *y,
                            struct dalcs_scales scale) {
    const struct dalcs_system *s = p->system;
    const struct dalcs_step_form *f = p->cache.form[0];
    const struct dalcs_csr check = f->checks.form;
    double *v = p->work.difference; /* (sigma (x+ - x_k), y, s) */
    memcpy(v + s->n_x, y, (size_t)dalcs_system_n_columns(s) * sizeof(*v));
    memcpy(v + s->n_x + dalcs_system_n_columns(s), u + s->n_x, (size_t)s->n_inputs * sizeof(*v));
    double worst = 0.0;
    int where = -1;
    for (int i = 0; i < check.n_rows; i++) {
        double residual = fabs(dalcs_csr_row_dot(&check, i, v));
        if (residual == 0.0) {
            continue;
        }
        double norm = dalcs_scales_norm(f, scale, f->checks.row[i]);
        double size = dalcs_scales_own(p, dalcs_scales_row_terms(p, u, y, i), norm);
        if (!(residual <= worst * size && size < INFINITY)) {
            /* An infinite row would vouch for any residual. A NaN must stay the worst: it compares with nothing that
             * follows. */
            const bool is_measured = size > 0.0 && size < INFINITY && residual < INFINITY;
            worst = is_measured ? residual / size : INFINITY;
            where = f->checks.row[i];
        }
    }
    note(&p->certificate, worst, 1.0, where);
}

static double pair_voltage(const struct dalcs_osnsp *p, const double *u, const double *y, int d) {
    const struct dalcs_system *s = p->system;
    const int *ends = p->lists.w_ends + 2 * d;
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
        p->signs.violating[p->signs.n_violating++] = d;
    } else {
        note(&p->certificate, excess, size, dalcs_system_n_equations(p->system) + d);
    }
}

/* The scale of a pair's voltage: a threshold may be far beyond all else. */
static double voltage_size(const struct dalcs_osnsp *p, const double *u, const double *y, int d,
                           struct dalcs_scales scale) {
    double terms = dalcs_scales_pair_terms(p, u, y, d);
    return dalcs_scales_own(p, terms, fmax(scale.volt, terms));
}

/* The scale of a pair's current, which is below 0: where what its own equations add up to does not excuse that, those of what is
 * in series with it may. */
static double current_size(struct dalcs_osnsp *p, const double *u, const double *y, int d,
                           struct dalcs_scales scale) {
    const double excess = -y[dalcs_system_n_equations(p->system) + d];
    const double tolerance = p->options.certificate_tolerance;
    const double norm = dalcs_scales_current_norm(p, d, scale);
    const double own = dalcs_scales_own(p, dalcs_scales_current_terms(p, u, y, d), norm);
    return excess > tolerance * own && excess <= tolerance * norm
               ? dalcs_scales_own(p, dalcs_scales_series_terms(p, u, y, d), norm)
               : own;
}

static void check_pairs(struct dalcs_osnsp *p, const double *u, const double *y,
                        struct dalcs_scales scale) {
    const struct dalcs_system *s = p->system;
    const double *lambda = y + dalcs_system_n_equations(s);
    double tolerance = p->options.certificate_tolerance;
    int n_equations = dalcs_system_n_equations(s);
    p->signs.n_tied = 0;
    for (int d = 0; d < s->n_pairs; d++) {
        double w = pair_voltage(p, u, y, d);
        bool is_diode = p->lists.is_diode[d];
        if (dalcs_osnsp_is_on(p, d)) {
            /* w = 0 by the mode: what is left of it is a residual. */
            note(&p->certificate, fabs(w), w == 0.0 ? 1.0 : voltage_size(p, u, y, d, scale),
                 n_equations + d);
            p->w[d] = 0.0;
            p->signs.tied[d] = is_diode && lambda[d] <= tolerance * scale.ampere;
            if (is_diode && lambda[d] < 0.0) {
                judge_sign(p, d, -lambda[d], current_size(p, u, y, d, scale));
            }
        } else {
            p->w[d] = w;
            p->signs.tied[d] = is_diode && w <= tolerance * scale.volt;
            if (is_diode && w < 0.0) {
                judge_sign(p, d, -w, voltage_size(p, u, y, d, scale));
            }
        }
        p->signs.n_tied += p->signs.tied[d] ? 1 : 0;
    }
}

/* The reference of a floating island would have to carry what its current sources do not balance. It
 * is the sum of the island's KCL, known as well as the largest of them. */
static void check_references(struct dalcs_osnsp *p, const double *y, struct dalcs_scales scale,
                             struct dalcs_scales drive, bool *sources_clash) {
    if (p->lists.n_references == 0) {
        return;
    }
    const double size = dalcs_scales_of_rows(p, scale, true);
    /* a current that is something beside what drives the circuit, and beyond rounding, is none that is balanced */
    double limit = fmin(p->options.certificate_tolerance * size,
                        fmax(dalcs_nothing * drive.ampere, dalcs_sum_rounded * size));
    for (int k = 0; k < p->lists.n_references; k++) {
        double residual = fabs(y[p->lists.reference[k]]);
        *sources_clash = *sources_clash || residual > limit;
        note(&p->certificate, residual, size, p->lists.reference_row[k]);
    }
}

bool dalcs_certificate_signs_hold(const struct dalcs_osnsp *p, const double *u, const double *y) {
    const double *lambda = y + dalcs_system_n_equations(p->system);
    double tolerance = p->options.certificate_tolerance;
    bool hold = true;
    for (int d = 0; d < p->system->n_pairs && hold; d++) {
        bool is_on = dalcs_osnsp_is_on(p, d);
        double value = is_on ? lambda[d] : p->w[d];
        hold = !p->lists.is_diode[d] || !(value < 0.0) ||
               -value <= tolerance * (is_on ? dalcs_scales_current_terms(p, u, y, d)
                                            : dalcs_scales_pair_terms(p, u, y, d));
    }
    return hold;
}

void dalcs_certificate_evaluate(struct dalcs_osnsp *p, const double *u, double *y,
                                bool *sources_clash) {
    p->certificate.worst = 0.0;
    p->certificate.where = -1;
    p->signs.n_violating = 0;
    *sources_clash = false;
    recover_states(p, u, y);
    struct dalcs_scales drive = dalcs_scales_driving(p, u);
    struct dalcs_scales scale = dalcs_scales_physical(p, drive, y);
    p->certificate.volt = scale.volt;
    p->certificate.ampere = scale.ampere;
    check_equations(p, u, y, scale);
    check_pairs(p, u, y, scale);
    check_references(p, y, scale, drive, sources_clash);
}

void dalcs_certificate_evaluate_with_states(struct dalcs_osnsp *p, const double *u, double *y,
                                            bool *sources_clash) {
    p->asks.keeps_states = true;
    dalcs_certificate_evaluate(p, u, y, sources_clash);
    p->asks.keeps_states = false;
}

void dalcs_certificate_evaluate_either(struct dalcs_osnsp *p, const double *u, double *y,
                                       bool *sources_clash) {
    dalcs_certificate_evaluate_with_states(p, u, y, sources_clash);
    if (!dalcs_certificate_holds(p, *sources_clash)) {
        dalcs_certificate_evaluate(p, u, y, sources_clash);
    }
}

bool dalcs_certificate_pairs_hold(struct dalcs_osnsp *p, const double *u, const double *y) {
    const struct dalcs_certificate whole = p->certificate;
    p->certificate.worst = 0.0;
    p->signs.n_violating = 0;
    check_pairs(p, u, y, dalcs_scales_physical(p, dalcs_scales_driving(p, u), y));
    const bool hold =
        p->signs.n_violating == 0 && p->certificate.worst <= p->options.certificate_tolerance;
    p->certificate = whole;
    return hold;
}

bool dalcs_certificate_equations_hold(struct dalcs_osnsp *p, const double *u, double *y) {
    const struct dalcs_certificate whole = p->certificate;
    p->certificate.worst = 0.0;
    check_equations(p, u, y, dalcs_scales_physical(p, dalcs_scales_driving(p, u), y));
    const bool hold = p->certificate.worst <= dalcs_beyond * p->options.certificate_tolerance;
    p->certificate = whole;
    return hold;
}

void dalcs_osnsp_find_ties(struct dalcs_osnsp *p, const double *u, const double *y,
                           double scale[2]) {
    const double *lambda = y + dalcs_system_n_equations(p->system);
    double tolerance = p->options.certificate_tolerance;
    struct dalcs_scales s = dalcs_scales_physical(p, dalcs_scales_driving(p, u), y);
    double typical_resistance =
        sqrt(p->cache.form[0]->ampere_in_volts / p->cache.form[0]->volt_in_amperes);
    double volts = fmax(s.volt, typical_resistance * s.ampere);
    for (int d = 0; d < p->system->n_pairs; d++) {
        bool small = dalcs_osnsp_is_on(p, d)
                         ? lambda[d] <= tolerance * dalcs_scales_current_norm(p, d, s)
                         : p->w[d] <= tolerance * volts;
        p->signs.tied[d] = p->lists.is_diode[d] && small;
    }
    scale[0] = s.volt;
    scale[1] = s.ampere;
}
