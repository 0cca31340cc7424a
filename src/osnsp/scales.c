/* scales.c - what residuals and wrong signs of an answer are measured against. */
#include "scales.h"

#include "magnitudes.h"

#include <float.h>
#include <math.h>

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

struct dalcs_scales dalcs_scales_driving(const struct dalcs_osnsp *p, const double *u) {
    double largest[2] = {0.0, 0.0};
    int n_x = p->cache.form[0]->sigma > 0.0 ? p->system->n_x : 0;
    for (int k = 0; k < p->lists.n_runs && p->lists.run[k].begin < n_x; k++) {
        const struct dalcs_unit_run *run = &p->lists.run[k];
        double a = largest_of(u, run->begin, run->end < n_x ? run->end : n_x);
        largest[run->is_current] = a > largest[run->is_current] ? a : largest[run->is_current];
    }
    for (int k = 0; k < p->lists.n_drives; k++) {
        const struct dalcs_drive *d = &p->lists.drive[k];
        double a = d->coefficient * fabs(u[d->input]);
        largest[d->is_current] = a > largest[d->is_current] ? a : largest[d->is_current];
    }
    return (struct dalcs_scales){largest[0], largest[1]};
}

/* Scales reach into the other unit no further than what drives the circuit could raise there, and not
 * far beyond it in their own: a false answer, with 1e12 A around a loop of sources that clash, must
 * not vouch for its own residual. An answer beside which what drives the circuit could raise nothing runs away. */
struct dalcs_scales dalcs_scales_physical(const struct dalcs_osnsp *p, struct dalcs_scales drive,
                                          const double *y) {
    const struct dalcs_step_form *f = p->cache.form[0];
    double largest[2] = {drive.volt, drive.ampere};
    for (int k = 0; k < p->lists.n_runs; k++) {
        const struct dalcs_unit_run *run = &p->lists.run[k];
        double a = largest_of(y, run->begin, run->end);
        largest[run->is_current] = a > largest[run->is_current] ? a : largest[run->is_current];
    }
    double raised_volt = drive.volt + drive.ampere / f->least_conductance;
    double raised_ampere = drive.ampere + drive.volt * f->most_conductance;
    const double most[2] = {1.0 / dalcs_alike * raised_volt, 1.0 / dalcs_alike * raised_ampere};
    largest[0] = largest[0] < most[0] ? largest[0] : most[0];
    largest[1] = largest[1] < most[1] ? largest[1] : most[1];
    raised_volt = raised_volt < largest[0] ? raised_volt : largest[0];
    raised_ampere = raised_ampere < largest[1] ? raised_ampere : largest[1];
    double volt = f->ampere_in_volts * raised_ampere;
    double ampere = f->volt_in_amperes * raised_volt;
    return (struct dalcs_scales){largest[0] > volt ? largest[0] : volt,
                                 largest[1] > ampere ? largest[1] : ampere};
}

/* V or A: a state that is recovered is known as well as what it is recovered from. */
static double state_size(const struct dalcs_osnsp *p, const double *u, const double *y, int x) {
    const struct dalcs_step_form *f = p->cache.form[0];
    const int *ends = f->state.ends + 2 * x;
    double sum = fabs(u[x]);
    if (ends[0] >= 0) {
        return sum + fabs(y[ends[0]]) + fabs(y[ends[1]]);
    }
    if (p->asks.keeps_states && f->state.Xu.p[x] < f->state.Xu.p[x + 1]) {
        return sum + fabs(y[x]);
    }
    for (int k = f->state.X.p[x]; k < f->state.X.p[x + 1]; k++) {
        sum += fabs(f->state.X.x[k] * y[f->state.X.j[k]]);
    }
    for (int k = f->state.Xu.p[x]; k < f->state.Xu.p[x + 1]; k++) {
        sum += fabs(f->state.Xu.x[k] * u[f->state.Xu.j[k]]);
    }
    return sum;
}

double dalcs_scales_row_terms(const struct dalcs_osnsp *p, const double *u, const double *y,
                              int i) {
    const struct dalcs_csr *a = &p->cache.form[0]->checks.form;
    int n_x = p->system->n_x;
    int n_columns = dalcs_system_n_columns(p->system);
    double of_states = 0.0;
    double sum = 0.0;
    int k = a->p[i];
    for (; k < a->p[i + 1] && a->j[k] < n_x; k++) {
        of_states += fabs(a->x[k]) * state_size(p, u, y, a->j[k]);
    }
    for (; k < a->p[i + 1] && a->j[k] < n_x + n_columns; k++) {
        sum += fabs(a->x[k] * y[a->j[k] - n_x]);
    }
    for (; k < a->p[i + 1]; k++) {
        sum += fabs(a->x[k] * u[a->j[k] - n_columns]);
    }
    return p->cache.form[0]->sigma * of_states + sum;
}

/* Roundings of the whole, over n: those of Arioli, Demmel and Duff. */
static const double roundings = 1000.0;

double dalcs_scales_own(const struct dalcs_osnsp *p, double terms, double norm) {
    double rounding = roundings * dalcs_system_n_columns(p->system) * DBL_EPSILON;
    double own = fmin(terms, norm); /* an answer that runs away is bounded by the norm */
    return own > rounding * norm ? own : own + norm;
}

/* The first of the rows that hold a pair's lambda, and the one behind the last, in p->lists.column_rows. */
static const int *rows_of(const struct dalcs_osnsp *p, int pair) {
    return p->lists.column_rows_p + dalcs_system_n_equations(p->system) + pair;
}

double dalcs_scales_of_rows(const struct dalcs_osnsp *p, struct dalcs_scales scale,
                            bool is_current) {
    double size = is_current ? scale.ampere : scale.volt;
    for (int r = 0; r < dalcs_system_n_equations(p->system); r++) {
        size = p->system->row_is_current[r] == is_current
                   ? fmax(size, dalcs_scales_norm(p->cache.form[0], scale, r))
                   : size;
    }
    return size;
}

double dalcs_scales_current_norm(const struct dalcs_osnsp *p, int pair, struct dalcs_scales scale) {
    const int *first = rows_of(p, pair);
    double size = scale.ampere;
    for (int k = first[0]; k < first[1]; k++) {
        int r = p->lists.column_rows[k];
        size = fmax(size, dalcs_scales_norm(p->cache.form[0], scale, r));
    }
    return size;
}

double dalcs_scales_pair_terms(const struct dalcs_osnsp *p, const double *u, const double *y,
                               int d) {
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

double dalcs_scales_terms(const struct dalcs_system *s, const double *u, const double *y, int r) {
    double size = 0.0;
    for (int i = s->A.p[r]; i < s->A.p[r + 1]; i++) {
        size += fabs(s->A.x[i] * y[s->A.j[i]]);
    }
    for (int i = s->E.p[r]; i < s->E.p[r + 1]; i++) {
        size += fabs(s->E.x[i] * u[s->n_x + s->E.j[i]]);
    }
    return size;
}

double dalcs_scales_current_terms(const struct dalcs_osnsp *p, const double *u, const double *y,
                                  int d) {
    const int *first = rows_of(p, d);
    double largest = 0.0;
    for (int k = first[0]; k < first[1]; k++) {
        largest = fmax(largest, dalcs_scales_terms(p->system, u, y, p->lists.column_rows[k]));
    }
    return largest;
}

/* Is it a current that no voltage tells: of a closed pair, or one that stands in KCL alone, as that of a V source? */
static bool leads_on(const struct dalcs_osnsp *p, int column) {
    const int pair = column - dalcs_system_n_equations(p->system);
    const int *first = p->lists.column_rows_p + column;
    bool is_in_kcl = first[0] < first[1];
    for (int k = first[0]; k < first[1] && is_in_kcl; k++) {
        is_in_kcl = p->system->row_is_current[p->lists.column_rows[k]];
    }
    return is_in_kcl &&
           (pair < 0 || (dalcs_osnsp_is_on(p, pair) && !p->system->pair[pair].is_formula));
}

static int add_rows(struct dalcs_osnsp *p, int column, int n) {
    for (int k = p->lists.column_rows_p[column]; k < p->lists.column_rows_p[column + 1]; k++) {
        const int r = p->lists.column_rows[k];
        if (p->work.row_seen[r] != p->work.searches) {
            p->work.row_seen[r] = p->work.searches;
            p->work.row[n++] = r;
        }
    }
    return n;
}

double dalcs_scales_series_terms(struct dalcs_osnsp *p, const double *u, const double *y, int d) {
    const struct dalcs_system *s = p->system;
    p->work.searches++;
    int n = add_rows(p, dalcs_system_n_equations(s) + d, 0);
    double largest = 0.0;
    for (int k = 0; k < n; k++) {
        const int r = p->work.row[k];
        largest = fmax(largest, dalcs_scales_terms(s, u, y, r));
        for (int i = s->A.p[r]; i < s->A.p[r + 1]; i++) {
            n = leads_on(p, s->A.j[i]) ? add_rows(p, s->A.j[i], n) : n;
        }
    }
    return largest;
}
