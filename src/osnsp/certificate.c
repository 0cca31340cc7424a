/* certificate.c - the proof that comes with every accepted step.
 *
 * Nothing of how the answer was found is used: the rows of the system itself are evaluated with
 * (x_k, s) and (x+, z+, lambda+), and each residual is measured against the row's norm times the
 * largest voltage and current of the answer (the backward error of that row, volts and amperes
 * apart). Voltages and currents vouch for each other through a thousandth of the typical conductance
 * and resistance, so that a part without current is not asked for more digits than its voltages
 * have. */
#include "osnsp_internal.h"

#include <float.h>
#include <math.h>
#include <string.h>

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

/* The largest voltage and current that sources, thresholds and states put in. */
static struct scales driving_scales(const struct dalcs_osnsp *p, const double *u) {
    double largest[2] = {0.0, 0.0};
    int n_x = p->form[0]->sigma > 0.0 ? p->system->n_x : 0;
    for (int k = 0; k < p->n_runs && p->run[k].begin < n_x; k++) {
        const struct dalcs_unit_run *run = &p->run[k];
        double a = largest_of(u, run->begin, run->end < n_x ? run->end : n_x);
        largest[run->is_current] = a > largest[run->is_current] ? a : largest[run->is_current];
    }
    for (int k = 0; k < p->n_drives; k++) {
        const struct dalcs_drive *d = &p->drive[k];
        double a = d->coefficient * fabs(u[d->input]);
        largest[d->is_current] = a > largest[d->is_current] ? a : largest[d->is_current];
    }
    return (struct scales){largest[0], largest[1]};
}

/* An answer this many times what drives the circuit could raise is one that runs away. */
static const double runaway = 1e9;

/* Scales reach into the other unit no further than what drives the circuit could raise there, and not
 * far beyond it in their own: a false answer, with 1e12 A around a loop of sources that clash, must
 * not vouch for its own residual. */
static struct scales physical_scales(const struct dalcs_osnsp *p, struct scales drive,
                                     const double *y) {
    const struct dalcs_step_form *f = p->form[0];
    double largest[2] = {drive.volt, drive.ampere};
    for (int k = 0; k < p->n_runs; k++) {
        const struct dalcs_unit_run *run = &p->run[k];
        double a = largest_of(y, run->begin, run->end);
        largest[run->is_current] = a > largest[run->is_current] ? a : largest[run->is_current];
    }
    double raised_volt = drive.volt + drive.ampere / f->least_conductance;
    double raised_ampere = drive.ampere + drive.volt * f->most_conductance;
    largest[0] = largest[0] < runaway * raised_volt ? largest[0] : runaway * raised_volt;
    largest[1] = largest[1] < runaway * raised_ampere ? largest[1] : runaway * raised_ampere;
    raised_volt = raised_volt < largest[0] ? raised_volt : largest[0];
    raised_ampere = raised_ampere < largest[1] ? raised_ampere : largest[1];
    double volt = f->ampere_in_volts * raised_ampere;
    double ampere = f->volt_in_amperes * raised_volt;
    return (struct scales){largest[0] > volt ? largest[0] : volt,
                           largest[1] > ampere ? largest[1] : ampere};
}

static void note(struct dalcs_certificate *c, double residual, double scale, int where) {
    if (residual > c->worst * scale) {
        c->worst = scale > 0.0 ? residual / scale : INFINITY;
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
        if (p->keeps_states && f->Xu.p[x] < f->Xu.p[x + 1]) {
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

/* The magnitude that row r can have at these voltages and currents: its norm times theirs. No residual
 * of it is known better than this times a rounding. */
static inline double row_size(const struct dalcs_step_form *f, struct scales scale, int r) {
    return f->row_volts[r] * scale.volt + f->row_amperes[r] * scale.ampere;
}

/* So many nodes of a chain are looked at. */
enum { MOST_AROUND = 32 };

static bool is_among(const int *list, int n, int i) {
    for (int k = 0; k < n; k++) {
        if (list[k] == i) {
            return true;
        }
    }
    return false;
}

static bool is_bare(const struct dalcs_osnsp *p, int row) {
    return p->system->row_is_current[row] && p->form[0]->row_volts[row] == 0.0;
}

/* The KCL that closed pairs tie to that of this row, and any pairs to those that only pairs enter,
 * together: their rounding flows along the chain. */
static double size_around(const struct dalcs_osnsp *p, struct scales scale, int row) {
    const struct dalcs_system *s = p->system;
    int reached[MOST_AROUND] = {row};
    int n = 1;
    double size = 0.0;
    for (int i = 0; i < n; i++) {
        size += row_size(p->form[0], scale, reached[i]);
        for (int k = s->A.p[reached[i]]; k < s->A.p[reached[i] + 1]; k++) {
            int d = s->A.j[k] - dalcs_system_n_equations(s);
            if (d < 0 || !(is_bare(p, reached[i]) || dalcs_osnsp_is_on(p, d))) {
                continue;
            }
            for (int e = p->pair_rows_p[d]; e < p->pair_rows_p[d + 1]; e++) {
                if (n < MOST_AROUND && !is_among(reached, n, p->pair_rows[e])) {
                    reached[n++] = p->pair_rows[e];
                }
            }
        }
    }
    return size;
}

static void check_equations(struct dalcs_osnsp *p, const double *u, const double *y,
                            struct scales scale) {
    const struct dalcs_system *s = p->system;
    const struct dalcs_step_form *f = p->form[0];
    const struct dalcs_csr check = f->check;
    double *v = p->difference; /* (sigma (x+ - x_k), y, s) */
    memcpy(v + s->n_x, y, (size_t)dalcs_system_n_columns(s) * sizeof(*v));
    memcpy(v + s->n_x + dalcs_system_n_columns(s), u + s->n_x, (size_t)s->n_inputs * sizeof(*v));
    double worst = 0.0;
    int where = -1;
    for (int i = 0; i < check.n_rows; i++) {
        double residual = fabs(dalcs_csr_row_dot(&check, i, v));
        double size = row_size(f, scale, f->checked[i]);
        if (!(residual <= worst * size)) {
            if (p->looks_around && is_bare(p, f->checked[i])) {
                size = fmax(size, size_around(p, scale, f->checked[i]));
            }
            if (residual <= worst * size) {
                continue;
            }
            /* A NaN must stay the worst: it compares with nothing that follows. */
            worst = size > 0.0 && residual < INFINITY ? residual / size : INFINITY;
            where = f->checked[i];
        }
    }
    note(&p->certificate, worst, 1.0, where);
}

/* The current of a diode is known no better than the KCL that it enters. */
static double current_scale(const struct dalcs_osnsp *p, int pair, struct scales scale) {
    double size = scale.ampere;
    for (int k = p->pair_rows_p[pair]; k < p->pair_rows_p[pair + 1]; k++) {
        int r = p->pair_rows[k];
        size =
            fmax(size, p->looks_around ? size_around(p, scale, r) : row_size(p->form[0], scale, r));
    }
    return size;
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
    p->n_tied = 0;
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
            p->tied[d] = is_diode && lambda[d] <= tolerance * scale.ampere;
            if (is_diode && lambda[d] < 0.0) {
                judge_sign(p, d, -lambda[d], current_scale(p, d, scale));
            }
        } else {
            p->w[d] = w;
            p->tied[d] = is_diode && w <= tolerance * scale.volt;
            if (is_diode && w < 0.0) {
                judge_sign(p, d, -w, fmax(scale.volt, pair_size(p, u, y, d)));
            }
        }
        p->n_tied += p->tied[d] ? 1 : 0;
    }
}

/* A current that is this part of what drives the circuit, and this many roundings, is no rounding. */
static const double clash_part = 1e-6;
static const double clash_roundings = 32.0 * DBL_EPSILON;

/* The reference of a floating island would have to carry what its current sources do not balance. It
 * is the sum of the island's KCL, known as well as the largest of them. */
static void check_references(struct dalcs_osnsp *p, const double *y, struct scales scale,
                             struct scales drive, bool *sources_clash) {
    const struct dalcs_system *s = p->system;
    if (p->n_references == 0) {
        return;
    }
    double size = scale.ampere;
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        size = s->row_is_current[r] ? fmax(size, row_size(p->form[0], scale, r)) : size;
    }
    double limit = fmin(p->options.certificate_tolerance * size,
                        fmax(clash_part * drive.ampere, clash_roundings * size));
    for (int k = 0; k < p->n_references; k++) {
        double residual = fabs(y[p->reference[k]]);
        *sources_clash = *sources_clash || residual > limit;
        note(&p->certificate, residual, size, p->reference_row[k]);
    }
}

/* What the terms of the equations that hold lambda_d add up to: the currents around the pair. */
static double current_size(const struct dalcs_osnsp *p, const double *u, const double *y, int d) {
    const struct dalcs_system *s = p->system;
    double largest = 0.0;
    for (int k = p->pair_rows_p[d]; k < p->pair_rows_p[d + 1]; k++) {
        int r = p->pair_rows[k];
        double size = 0.0;
        for (int i = s->A.p[r]; i < s->A.p[r + 1]; i++) {
            size += fabs(s->A.x[i] * y[s->A.j[i]]);
        }
        for (int i = s->E.p[r]; i < s->E.p[r + 1]; i++) {
            size += fabs(s->E.x[i] * u[s->n_x + s->E.j[i]]);
        }
        largest = fmax(largest, size);
    }
    return largest;
}

bool dalcs_certificate_signs_hold(const struct dalcs_osnsp *p, const double *u, const double *y) {
    const double *lambda = y + dalcs_system_n_equations(p->system);
    double tolerance = p->options.certificate_tolerance;
    bool hold = true;
    for (int d = 0; d < p->system->n_pairs && hold; d++) {
        bool is_on = dalcs_osnsp_is_on(p, d);
        double value = is_on ? lambda[d] : p->w[d];
        hold = !p->is_diode[d] || !(value < 0.0) ||
               -value <= tolerance * (is_on ? current_size(p, u, y, d) : pair_size(p, u, y, d));
    }
    return hold;
}

/* V, A: rows of larger ones may overflow, and infinite rows would vouch for any residual. */
static const double largest_scale = 1e250;

void dalcs_certificate_evaluate(struct dalcs_osnsp *p, const double *u, double *y,
                                bool *sources_clash) {
    p->certificate.worst = 0.0;
    p->certificate.where = -1;
    p->n_violating = 0;
    *sources_clash = false;
    recover_states(p, u, y);
    struct scales drive = driving_scales(p, u);
    struct scales scale = physical_scales(p, drive, y);
    p->certificate.volt = scale.volt;
    p->certificate.ampere = scale.ampere;
    if (!(scale.volt <= largest_scale && scale.ampere <= largest_scale)) {
        note(&p->certificate, INFINITY, 1.0, 0);
    }
    check_equations(p, u, y, scale);
    check_pairs(p, u, y, scale);
    check_references(p, y, scale, drive, sources_clash);
}

void dalcs_certificate_evaluate_with_states(struct dalcs_osnsp *p, const double *u, double *y,
                                            bool *sources_clash) {
    p->keeps_states = true;
    dalcs_certificate_evaluate(p, u, y, sources_clash);
    p->keeps_states = false;
}

void dalcs_osnsp_find_ties(struct dalcs_osnsp *p, const double *u, const double *y,
                           double scale[2]) {
    const double *lambda = y + dalcs_system_n_equations(p->system);
    double tolerance = p->options.certificate_tolerance;
    struct scales s = physical_scales(p, driving_scales(p, u), y);
    double typical_resistance = sqrt(p->form[0]->ampere_in_volts / p->form[0]->volt_in_amperes);
    double volts = fmax(s.volt, typical_resistance * s.ampere);
    for (int d = 0; d < p->system->n_pairs; d++) {
        bool small = dalcs_osnsp_is_on(p, d) ? lambda[d] <= tolerance * current_scale(p, d, s)
                                             : p->w[d] <= tolerance * volts;
        p->tied[d] = p->is_diode[d] && small;
    }
    scale[0] = s.volt;
    scale[1] = s.ampere;
}
