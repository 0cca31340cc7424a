/* columns_solve.c - dalcs_stage_solve_loaded, of four right-hand sides that no source has a part in, and its transposed. */
#include "columns_solve.h"

#include "stage_update.h"
#include "wide_vectors.h"

#include <string.h>

/* ---- Triangles ----------------------------------------------------------------------------------- */

/* x[i] less the sum of a row's elements times what they stand at. */
static inline __attribute__((always_inline)) void subtract_row(int i, const int *p, const int *j,
                                                               const double *a, dalcs_four *x) {
    dalcs_four sum = x[i];
    for (int k = p[i]; k < p[i + 1]; k++) {
        sum -= a[k] * x[j[k]];
    }
    x[i] = sum;
}

static inline __attribute__((always_inline)) void
subtract_row_complex(int i, const int *p, const int *j, const double *a, dalcs_four *x) {
    dalcs_four re = x[2 * i];
    dalcs_four im = x[2 * i + 1];
    for (int k = p[i]; k < p[i + 1]; k++) {
        const dalcs_four *b = x + 2 * j[k];
        re -= a[2 * k] * b[0] - a[2 * k + 1] * b[1];
        im -= a[2 * k] * b[1] + a[2 * k + 1] * b[0];
    }
    x[2 * i] = re;
    x[2 * i + 1] = im;
}

DALCS_TWICE(void, solve_real, (const struct dalcs_lu *lu, dalcs_four *x), (lu, x)) {
    for (int block = lu->n_blocks - 1; block >= 0; block--) {
        const int end = lu->block[block + 1];
        for (int i = lu->block[block]; i < end; i++) {
            subtract_row(i, lu->lower_p, lu->lower_j, lu->lower_x, x);
        }
        for (int i = end - 1; i >= lu->block[block]; i--) {
            subtract_row(i, lu->upper_p, lu->upper_j, lu->upper_x, x);
            x[i] *= lu->pivot_inverse[i];
        }
    }
}

DALCS_TWICE(void, solve_complex, (const struct dalcs_lu *lu, dalcs_four *x), (lu, x)) {
    for (int block = lu->n_blocks - 1; block >= 0; block--) {
        const int end = lu->block[block + 1];
        for (int i = lu->block[block]; i < end; i++) {
            subtract_row_complex(i, lu->lower_p, lu->lower_j, lu->lower_x, x);
        }
        for (int i = end - 1; i >= lu->block[block]; i--) {
            subtract_row_complex(i, lu->upper_p, lu->upper_j, lu->upper_x, x);
            const double *by = lu->pivot_inverse + 2 * i;
            const dalcs_four re = x[2 * i];
            x[2 * i] = re * by[0] - x[2 * i + 1] * by[1];
            x[2 * i + 1] = re * by[1] + x[2 * i + 1] * by[0];
        }
    }
}

/* ---- Updates (stage_update.c) ------------------------------------------------------------------------ */

/* Row i of V times x, less what is asked of it. */
static void find_missed(const struct dalcs_stage_factors *f, int i, int system, int part,
                        const dalcs_four *x, dalcs_four *missed) {
    const struct dalcs_stage_update *u = f->update;
    const struct dalcs_stage_change *c = u->change[i];
    const int stride = system > 0 ? 2 : 1;
    if (i >= u->n_closed) {
        *missed = x[c->lambda_at[system] * stride + part];
        return;
    }
    *missed = -x[(f->lu[system].n + i) * stride + part];
    for (int k = 0; k < c->n_terms; k++) {
        *missed += c->value[k] * x[f->order[system].position[c->unknown[k]] * stride + part];
    }
}

/* x -= nu G */
DALCS_TWICE(void, subtract_real,
            (const struct dalcs_stage_response *g, const dalcs_four *nu, dalcs_four *x),
            (g, nu, x)) {
    const double *value = g->value;
    for (int k = 0; k < g->n_runs; k++) {
        for (int i = g->first[k]; i < g->end[k]; i++, value++) {
            x[i] -= nu[0] * value[0];
        }
    }
}

DALCS_TWICE(void, subtract_complex,
            (const struct dalcs_stage_response *g, const dalcs_four *nu, dalcs_four *x),
            (g, nu, x)) {
    const double *value = g->value;
    for (int k = 0; k < g->n_runs; k++) {
        for (int i = g->first[k]; i < g->end[k]; i++, value += 2) {
            x[2 * i] -= nu[0] * value[0] - nu[1] * value[1];
            x[2 * i + 1] -= nu[0] * value[1] + nu[1] * value[0];
        }
    }
}

/* nu of change i: the inverse of S times what is missed. */
DALCS_TWICE(void, find_nu,
            (const struct dalcs_stage_update *u, int i, int system, const dalcs_four (*missed)[2],
             dalcs_four *nu),
            (u, i, system, missed, nu)) {
    const int n = u->n_changes;
    const long double *re = u->inverse[system] + i * n;
    memset(nu, 0, 2 * sizeof *nu);
    for (int j = 0; j < n; j++) {
        const double a = (double)re[j];
        const double b = system > 0 ? (double)re[j + n * n] : 0.0;
        nu[0] += a * missed[j][0] - b * missed[j][1];
        nu[1] += a * missed[j][1] + b * missed[j][0];
    }
}

/* What closes is asked for its part of rhs, and nothing is of what opens. */
static void load_update(const struct dalcs_stage_factors *f, int system, const dalcs_four *rhs,
                        dalcs_four *x) {
    const struct dalcs_stage_update *u = f->update;
    const int stride = system > 0 ? 2 : 1;
    for (int i = 0; i < u->n_changes; i++) {
        const struct dalcs_stage_change *c = u->change[i];
        const bool closes = i < u->n_closed;
        dalcs_four *at = x + (closes ? f->lu[system].n + i : c->row_at[system]) * stride;
        memset(at, 0, (size_t)stride * sizeof *at);
        if (closes) {
            *at = c->row_scale * rhs[f->n - f->n_pairs + c->pair];
        }
    }
}

static void solve_update(const struct dalcs_stage_factors *f, int system, dalcs_four *x) {
    const struct dalcs_stage_update *u = f->update;
    const int stride = system > 0 ? 2 : 1;
    dalcs_four missed[DALCS_STAGE_MOST_CHANGES][2];
    memset(missed, 0, sizeof missed);
    for (int i = 0; i < stride * u->n_changes; i++) {
        find_missed(f, i / stride, system, i % stride, x, &missed[i / stride][i % stride]);
    }
    for (int i = 0; i < u->n_changes; i++) {
        dalcs_four nu[2];
        find_nu(u, i, system, missed, nu);
        if (system == 0) {
            subtract_real(&u->change[i]->response[0], nu, x);
        } else {
            subtract_complex(&u->change[i]->response[system], nu, x);
        }
        if (i < u->n_closed) {
            memcpy(x + (f->lu[system].n + i) * stride, nu, (size_t)stride * sizeof *x);
        }
    }
}

/* ---- Systems ------------------------------------------------------------------------------------- */

DALCS_TWICE(void, load,
            (const struct dalcs_stage_order *o, int system, const dalcs_four *rhs, dalcs_four *x),
            (o, system, rhs, x)) {
    const int stride = system > 0 ? 2 : 1;
    for (int i = 0; i < o->n; i++) {
        x[i * stride + stride - 1] = (dalcs_four){0.0};
        x[i * stride] = o->scale[i] * rhs[o->row_of[i]];
    }
}

void dalcs_columns_solve(const struct dalcs_stage_factors *f, int system, const dalcs_four *rhs,
                         dalcs_four *solved) {
    load(&f->order[system], system, rhs, solved);
    if (f->update != NULL) {
        load_update(f, system, rhs, solved);
    }
    if (system == 0) {
        solve_real(&f->lu[0], solved);
    } else {
        solve_complex(&f->lu[system], solved);
    }
    if (f->update != NULL) {
        solve_update(f, system, solved);
    }
}

/* ---- Transposed: each operation from the last to the first, with what it reads and writes the other way round -------- */

static inline __attribute__((always_inline)) void add_row(int i, const int *p, const int *j,
                                                          const double *a, dalcs_four *x) {
    for (int k = p[i]; k < p[i + 1]; k++) {
        x[j[k]] -= a[k] * x[i];
    }
}

static inline __attribute__((always_inline)) void add_row_complex(int i, const int *p, const int *j,
                                                                  const double *a, dalcs_four *x) {
    const dalcs_four re = x[2 * i];
    const dalcs_four im = x[2 * i + 1];
    for (int k = p[i]; k < p[i + 1]; k++) {
        dalcs_four *b = x + 2 * j[k];
        b[0] -= a[2 * k] * re + a[2 * k + 1] * im;
        b[1] -= a[2 * k] * im - a[2 * k + 1] * re;
    }
}

DALCS_TWICE(void, solve_real_back, (const struct dalcs_lu *lu, dalcs_four *x), (lu, x)) {
    for (int block = 0; block < lu->n_blocks; block++) {
        const int end = lu->block[block + 1];
        for (int i = lu->block[block]; i < end; i++) {
            x[i] *= lu->pivot_inverse[i];
            add_row(i, lu->upper_p, lu->upper_j, lu->upper_x, x);
        }
        for (int i = end - 1; i >= lu->block[block]; i--) {
            add_row(i, lu->lower_p, lu->lower_j, lu->lower_x, x);
        }
    }
}

DALCS_TWICE(void, solve_complex_back, (const struct dalcs_lu *lu, dalcs_four *x), (lu, x)) {
    for (int block = 0; block < lu->n_blocks; block++) {
        const int end = lu->block[block + 1];
        for (int i = lu->block[block]; i < end; i++) {
            const double *by = lu->pivot_inverse + 2 * i;
            const dalcs_four re = x[2 * i];
            x[2 * i] = re * by[0] + x[2 * i + 1] * by[1];
            x[2 * i + 1] = x[2 * i + 1] * by[0] - re * by[1];
            add_row_complex(i, lu->upper_p, lu->upper_j, lu->upper_x, x);
        }
        for (int i = end - 1; i >= lu->block[block]; i--) {
            add_row_complex(i, lu->lower_p, lu->lower_j, lu->lower_x, x);
        }
    }
}

/* nu -= G' x */
DALCS_TWICE(void, read_response,
            (const struct dalcs_stage_response *g, int stride, const dalcs_four *x, dalcs_four *nu),
            (g, stride, x, nu)) {
    const double *value = g->value;
    for (int k = 0; k < g->n_runs; k++) {
        for (int i = g->first[k]; i < g->end[k]; i++, value += stride) {
            nu[0] -= x[stride * i] * value[0];
            if (stride > 1) {
                nu[0] -= x[2 * i + 1] * value[1];
                nu[1] -= x[2 * i + 1] * value[0] - x[2 * i] * value[1];
            }
        }
    }
}

/* missed = the transposed inverse of S times nu. */
static void find_missed_back(const struct dalcs_stage_update *u, int system, int j,
                             const dalcs_four (*nu)[2], dalcs_four *missed) {
    const int n = u->n_changes;
    const bool is_complex = system > 0;
    const long double *re = u->inverse[system] + j;
    memset(missed, 0, 2 * sizeof *missed);
    for (int i = 0; i < n; i++) {
        const double a = (double)re[i * n];
        const double b = is_complex ? (double)re[i * n + n * n] : 0.0;
        missed[0] += a * nu[i][0] + b * nu[i][1];
        missed[1] += a * nu[i][1] - b * nu[i][0];
    }
}

static void solve_update_back(const struct dalcs_stage_factors *f, int system, dalcs_four *x) {
    const struct dalcs_stage_update *u = f->update;
    const int stride = system > 0 ? 2 : 1;
    dalcs_four nu[DALCS_STAGE_MOST_CHANGES][2];
    memset(nu, 0, sizeof nu);
    for (int i = 0; i < u->n_changes; i++) {
        if (i < u->n_closed) {
            memcpy(nu[i], x + (f->lu[system].n + i) * stride, (size_t)stride * sizeof *x);
        }
        read_response(&u->change[i]->response[system], stride, x, nu[i]);
    }
    for (int i = 0; i < u->n_changes; i++) {
        const struct dalcs_stage_change *c = u->change[i];
        dalcs_four missed[2];
        find_missed_back(u, system, i, (const dalcs_four(*)[2])nu, missed);
        for (int part = 0; part < stride; part++) {
            if (i >= u->n_closed) {
                x[c->lambda_at[system] * stride + part] += missed[part];
                continue;
            }
            x[(f->lu[system].n + i) * stride + part] = -missed[part];
            for (int k = 0; k < c->n_terms; k++) {
                x[f->order[system].position[c->unknown[k]] * stride + part] +=
                    c->value[k] * missed[part];
            }
        }
    }
}

static void load_update_back(const struct dalcs_stage_factors *f, int system, dalcs_four *x,
                             dalcs_four *rhs) {
    const struct dalcs_stage_update *u = f->update;
    const int stride = system > 0 ? 2 : 1;
    for (int i = 0; i < u->n_changes; i++) {
        const struct dalcs_stage_change *c = u->change[i];
        if (i < u->n_closed) {
            rhs[f->n - f->n_pairs + c->pair] += c->row_scale * x[(f->lu[system].n + i) * stride];
        } else {
            x[c->row_at[system] * stride] = (dalcs_four){0.0};
        }
    }
}

void dalcs_columns_solve_back(const struct dalcs_stage_factors *f, int system, dalcs_four *solved,
                              dalcs_four *rhs) {
    const struct dalcs_stage_order *o = &f->order[system];
    if (f->update != NULL) {
        solve_update_back(f, system, solved);
    }
    if (system == 0) {
        solve_real_back(&f->lu[0], solved);
    } else {
        solve_complex_back(&f->lu[system], solved);
    }
    if (f->update != NULL) {
        load_update_back(f, system, solved, rhs);
    }
    for (int i = 0; i < o->n; i++) {
        rhs[o->row_of[i]] += o->scale[i] * solved[i * (system > 0 ? 2 : 1)];
    }
}
