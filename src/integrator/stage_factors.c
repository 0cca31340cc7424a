/* stage_factors.c - a step of a large system in one mode, on sparse factors.
 *
 * The same answer as stage_map.c, solved anew for every step: one system for the real eigenvalue,
 * one for each conjugate pair, and on the real one again what the error estimates need. The scales
 * of the balancing and the orders of the factors are folded into loading and unloading them. */
#include "stage_factors.h"

#include "dense_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A factorisation that is worse than this has failed without saying so. */
static const double largest_residual = 1e-6;

void dalcs_stage_factors_eigenvalue(const struct dalcs_stages *stages, double h, int system,
                                    double *re, double *im) {
    const struct dalcs_collocation *m = stages->method;
    *re = (system == 0 ? m->lambda : creal(m->mu[system - 1])) / h;
    *im = (system == 0 ? 0.0 : cimag(m->mu[system - 1])) / h;
}

enum dalcs_status dalcs_stage_factors_order(const struct dalcs_stage_plan *plan,
                                            const struct dalcs_stage_matrix *m,
                                            struct dalcs_stage_factors *f, int system) {
    const struct dalcs_lu *lu = &f->lu[system];
    struct dalcs_stage_order *o = &f->order[system];
    size_t n = (size_t)m->n;
    int n_equations = m->n - m->n_pairs;
    o->row_of = dalcs_alloc(n, sizeof(int));
    o->scale = dalcs_alloc(n, sizeof(double));
    o->position = dalcs_alloc(n, sizeof(int));
    o->wave_at = dalcs_alloc((size_t)plan->n_waves, sizeof(int));
    int *at = dalcs_alloc((size_t)plan->n_rows, sizeof(int)); /* positions of the rows of M */
    if (o->row_of == NULL || o->scale == NULL || o->position == NULL || o->wave_at == NULL ||
        at == NULL) {
        free(at);
        return DALCS_E_NOMEM;
    }
    for (int r = 0; r < plan->n_rows; r++) {
        at[r] = -1;
    }
    for (int i = 0; i < m->n; i++) {
        int row = lu->from[i];
        o->row_of[i] = row < n_equations ? row : n_equations + m->pair[row - n_equations];
        o->scale[i] = m->row_scale[row];
        o->position[lu->to[i]] = i;
        at[o->row_of[i]] = i;
    }
    for (int k = 0; k < plan->n_waves; k++) {
        o->wave_at[k] = at[plan->wave_row[k]];
    }
    free(at);
    return DALCS_OK;
}

/* What a function of unit size makes of the shares of its wave. */
static void find_function_shares(const struct dalcs_stages *stages, double h,
                                 const struct dalcs_excitation_function *function, double *share) {
    const struct dalcs_collocation *m = stages->method;
    for (int k = 0; k <= m->s; k++) {
        share[k] = dalcs_excitation_function_at(function, h, m->node[k]);
    }
    long double real = 0.0L;
    long double drift = share[0];
    double missed = dalcs_excitation_missed(function, m, h, share);
    for (int i = 1; i <= m->s; i++) {
        real += m->exact_from[i - 1] * share[i];
        drift -= m->exact_back[i - 1] * share[i];
    }
    share[DALCS_SHARE_REAL] = (double)real;
    share[DALCS_SHARE_DRIFT] = (double)drift;
    share[DALCS_SHARE_RIPPLE] = missed;
    share[DALCS_SHARE_RIPPLE_RATE] = missed * m->test_factor;
    for (int p = 0; p < m->n_pairs; p++) {
        long double complex sum = 0.0L;
        for (int i = 1; i <= m->s; i++) {
            sum += m->exact_from_pair[p][i - 1] * share[i];
        }
        share[DALCS_SHARE_PAIR + 2 * p] = (double)creall(sum);
        share[DALCS_SHARE_PAIR + 2 * p + 1] = (double)cimagl(sum);
    }
}

/* Shares of the waves in this step. */
static void find_shares(const struct dalcs_stages *stages, const struct dalcs_stage_factors *f,
                        const double *coefficient) {
    const struct dalcs_excitation *e = stages->excitation;
    double *share = stages->plan->share;
    for (int w = 0; w < e->n_waves; w++, share += DALCS_N_SHARES) {
        for (int k = 0; k < DALCS_N_SHARES; k++) {
            share[k] = 0.0;
        }
        for (int i = e->wave[w].first; i < e->wave[w].first + e->wave[w].n_functions; i++) {
            const double *of_one = f->function_share + i * DALCS_N_SHARES;
            for (int k = 0; k < DALCS_N_SHARES; k++) {
                share[k] += coefficient[i] * of_one[k];
            }
        }
    }
}

/* plan->rhs = drive x + factor * constant, of the rows that are present. */
static void find_drive(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                       const double *x, double factor) {
    int n_equations = f->n - f->n_pairs;
    for (int k = 0; k < f->n; k++) {
        int r = k < n_equations ? k : n_equations + f->pair[k - n_equations];
        plan->rhs[r] = factor * plan->constant[r] + dalcs_csr_row_dot(&plan->drive, r, x);
    }
}

/* lu.work = the balanced right-hand side in its order: plan->rhs and a share of the waves. */
static void load(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                 int system, int share) {
    const struct dalcs_stage_order *o = &f->order[system];
    double *restrict work = f->lu[system].work;
    int stride = system > 0 ? 2 : 1;
    if (stride == 1) {
        for (int i = 0; i < f->n; i++) {
            work[i] = o->scale[i] * plan->rhs[o->row_of[i]];
        }
    } else {
        for (int i = 0; i < f->n; i++) {
            work[2 * i] = o->scale[i] * plan->rhs[o->row_of[i]];
            work[2 * i + 1] = 0.0;
        }
    }
    for (int k = 0; k < plan->n_waves; k++) {
        int at = o->wave_at[k];
        const double *of_wave = plan->share + plan->wave_of[k] * DALCS_N_SHARES + share;
        for (int part = 0; at >= 0 && part < stride; part++) {
            work[at * stride + part] += o->scale[at] * plan->wave_x[k] * of_wave[part];
        }
    }
}

static void solve(const struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                  const struct dalcs_stage_factors *f, int system) {
    if (f->singular != NULL) {
        dalcs_stage_singular_solve(plan, entry, f, system);
    } else if (system == 0) {
        dalcs_lu_solve_ordered(&f->lu[0]);
    } else {
        dalcs_lu_solve_ordered_complex(&f->lu[system]);
    }
}

/* Some unknowns of all systems: a dense map from the weights of a node to their values there. */
struct piece {
    _Alignas(64) double part[DALCS_STAGE_PARTS * DALCS_STAGE_PIECE];
    double y[DALCS_STAGE_PIECE];
    int n_rows;
};

/* count unknowns of all systems, from `first` on, unscaled. */
static void unload(const struct dalcs_stage_factors *f, int first, int count, struct piece *piece) {
    const double *scale = f->column_scale + first;
    const int *position = f->order[0].position + first;
    const double *work = f->lu[0].work;
    double *part = piece->part;
    piece->n_rows = dalcs_dense_map_rows(count);
    for (int k = 0; k < count; k++) {
        part[k] = scale[k] * work[position[k]];
    }
    for (int q = 1; q < f->n_systems; q++) {
        position = f->order[q].position + first;
        work = f->lu[q].work;
        double *re = part + (2 * q - 1) * piece->n_rows;
        double *im = re + piece->n_rows;
        for (int k = 0; k < count; k++) {
            re[k] = scale[k] * work[2 * position[k]];
            im[k] = scale[k] * work[2 * position[k] + 1];
        }
    }
}

/* Columns at all nodes; the start still without its defect. plan->missed = what the states miss
 * there. */
static void put_columns(const struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                        const struct dalcs_stage_factors *f, const double *x, double *out) {
    const struct dalcs_stage_layout *l = &plan->stages->layout;
    int n_x = plan->stages->system->n_x;
    int n_equations = f->n - f->n_pairs;
    struct piece piece;
    memset(&piece, 0, sizeof(piece));
    const int end[3] = {n_x, n_equations, f->n};
    int first = 0;
    for (int kind = 0; kind < 3; kind++) {
        for (; first < end[kind]; first += DALCS_STAGE_PIECE) {
            int count = end[kind] - first;
            count = count < DALCS_STAGE_PIECE ? count : DALCS_STAGE_PIECE;
            unload(f, first, count, &piece);
            for (int node = 0; node < l->n_nodes; node++) {
                double *y = out + node * l->stride;
                dalcs_dense_map_apply(piece.n_rows, plan->n_parts, piece.part, plan->to[node],
                                      piece.y);
                if (kind == 0 && node == 0) {
                    for (int k = 0; k < count; k++) {
                        y[first + k] = x[first + k];
                        plan->missed[first + k] = -piece.y[k];
                    }
                } else if (kind == 0) {
                    for (int k = 0; k < count; k++) {
                        y[first + k] = x[first + k] + piece.y[k];
                    }
                } else if (kind == 1) {
                    memcpy(y + first, piece.y, (size_t)count * sizeof(double));
                } else {
                    for (int k = 0; k < count; k++) {
                        int d = f->pair[first + k - n_equations];
                        bool is_on = f->singular == NULL || dalcs_stage_is_on(entry, d);
                        y[n_equations + d] = is_on ? piece.y[k] : 0.0;
                    }
                }
            }
        }
        first = end[kind];
    }
}

/* Puts w of the open diodes in the place of their lambda, which is 0 so far, and the watched
 * voltages, if asked for, behind the columns. */
static void put_other_sides(const struct dalcs_stage_plan *plan,
                            const struct dalcs_stage_entry *entry, double constant, int share,
                            bool with_watched, double *columns) {
    const struct dalcs_stages *stages = plan->stages;
    const struct dalcs_system *s = stages->system;
    int n_equations = dalcs_system_n_equations(s);
    double *lambda = columns + n_equations;
    for (int d = 0; d < s->n_pairs; d++) {
        plan->guard[d] = lambda[d];
        if (dalcs_stage_is_on(entry, d) || s->pair[d].kind != DALCS_PAIR_DIODE) {
            continue;
        }
        int row = n_equations + d;
        double w = dalcs_csr_row_dot(&s->C, d, columns) - constant * plan->constant[row];
        for (int k = plan->wave_begin[row]; k < plan->wave_begin[row + 1]; k++) {
            w -= plan->wave_x[k] * plan->share[plan->wave_of[k] * DALCS_N_SHARES + share];
        }
        plan->guard[d] = w;
    }
    for (int i = 0; with_watched && i < stages->n_watched; i++) {
        int d = stages->watched[i];
        double v = 0.0;
        if (!s->pair[d].is_direct) {
            v = dalcs_csr_row_dot(&s->control, d, columns);
        } else {
            const struct dalcs_csr *c = &s->direct_control;
            for (int k = c->p[d]; k < c->p[d + 1]; k++) {
                int wave = plan->wave_of_input[c->j[k]];
                v += c->x[k] * (wave >= 0 ? plan->share[wave * DALCS_N_SHARES + share]
                                          : constant * stages->excitation->constant[c->j[k]]);
            }
        }
        columns[dalcs_system_n_columns(s) + i] = v;
    }
    memcpy(lambda, plan->guard, (size_t)s->n_pairs * sizeof(double));
}

/* How far the equations disagree at each stage, from what the solutions have left. */
static void put_clashes(const struct dalcs_stage_plan *plan, double *clash) {
    int n_x = plan->stages->system->n_x;
    for (int i = 1; i <= plan->stages->method->s; i++) {
        double largest = 0.0;
        for (int r = n_x; r < plan->n_rows; r++) {
            double sum = 0.0;
            for (int q = 0; q < plan->n_parts; q++) {
                sum += plan->to[i][q] * plan->left[q * plan->n_rows + r];
            }
            largest = fmax(largest, fabs(sum));
        }
        clash[i - 1] = largest;
    }
}

/* The real system's unknowns to the places of columns, where they are added. */
static void add_real(const struct dalcs_stage_entry *entry, const struct dalcs_stage_factors *f,
                     int first, double *columns) {
    const int *position = f->order[0].position;
    const double *work = f->lu[0].work;
    int n_equations = f->n - f->n_pairs;
    for (int u = first; u < n_equations; u++) {
        columns[u] += f->column_scale[u] * work[position[u]];
    }
    for (int u = n_equations; u < f->n; u++) {
        int d = f->pair[u - n_equations];
        if (dalcs_stage_is_on(entry, d)) {
            columns[n_equations + d] += f->column_scale[u] * work[position[u]];
        }
    }
}

enum dalcs_status dalcs_stage_factors_apply(struct dalcs_stages *stages,
                                            const struct dalcs_stage_entry *entry, const double *in,
                                            double *out) {
    const struct dalcs_stage_plan *plan = stages->plan;
    const struct dalcs_stage_factors *f = entry->factors;
    const struct dalcs_stage_layout *l = &stages->layout;
    int n_x = stages->system->n_x;
    int n_columns = dalcs_system_n_columns(stages->system);
    memset(out, 0, (size_t)l->n_fixed * sizeof(double));
    find_shares(stages, f, in + n_x + 1);
    find_drive(plan, f, in, in[n_x]);
    for (int q = 0; q < f->n_systems; q++) {
        load(plan, f, q, q == 0 ? DALCS_SHARE_REAL : DALCS_SHARE_PAIR + 2 * (q - 1));
        solve(plan, entry, f, q);
    }
    put_columns(plan, entry, f, in, out);
    if (f->singular != NULL) {
        put_clashes(plan, out + l->n_fixed);
    }
    find_drive(plan, f, plan->missed, 0.0);
    load(plan, f, 0, DALCS_SHARE_DRIFT);
    solve(plan, entry, f, 0);
    for (int x = 0; x < n_x; x++) {
        out[l->drift + x] = f->column_scale[x] * f->lu[0].work[f->order[0].position[x]];
    }
    add_real(entry, f, n_x, out);
    if (n_x > 0) {
        /* What was added goes with states that are off by the drift: take that back as well. */
        for (int x = 0; x < n_x; x++) {
            plan->missed[x] = -out[l->drift + x];
        }
        find_drive(plan, f, plan->missed, 0.0);
        load(plan, f, 0, DALCS_SHARE_NONE);
        solve(plan, entry, f, 0);
        add_real(entry, f, n_x, out);
    }
    for (int node = 0; node < l->n_nodes; node++) {
        put_other_sides(plan, entry, in[n_x], node, true, out + node * l->stride);
    }
    if (stages->excitation->is_curved) {
        memset(plan->rhs, 0, (size_t)n_columns * sizeof(double));
        load(plan, f, 0, DALCS_SHARE_RIPPLE_RATE);
        solve(plan, entry, f, 0);
        add_real(entry, f, 0, out + l->ripple);
        put_other_sides(plan, entry, 0.0, DALCS_SHARE_RIPPLE, false, out + l->ripple);
    }
    return DALCS_OK;
}

static enum dalcs_status factor_regular(struct dalcs_stages *stages,
                                        struct dalcs_stage_entry *entry,
                                        struct dalcs_stage_factors *f,
                                        struct dalcs_stage_matrix *m) {
    struct dalcs_stage_analysis *a;
    DALCS_TRY(
        dalcs_stage_plan_analyze(stages, entry->mode, m->n, m->n_pairs, m->pair, m->p, m->i, &a));
    for (int q = 0; q < f->n_systems; q++) {
        double re;
        double im;
        dalcs_stage_factors_eigenvalue(stages, entry->h, q, &re, &im);
        dalcs_stage_matrix_at(m, re, im, q > 0);
        DALCS_TRY(dalcs_lu_factor_analyzed(&f->lu[q], q > 0 ? &stages->klu_complex : &stages->klu,
                                           a->symbolic, &a->numeric[q], q > 0, m->p, m->i,
                                           m->values, stages->rcond_min));
        DALCS_TRY(dalcs_stage_factors_order(stages->plan, m, f, q));
    }
    return DALCS_OK;
}

static void remember_pivots(struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f) {
    const int *row_of = f->order[0].row_of;
    int n_equations = f->n - f->n_pairs;
    for (int i = 0; i < f->n; i++) {
        int u = f->lu[0].to[i];
        plan->match[u < n_equations ? u : n_equations + f->pair[u - n_equations]] = row_of[i];
    }
}

static void drop_systems(struct dalcs_stage_factors *f) {
    for (int q = 0; q < DALCS_STAGE_SYSTEMS; q++) {
        struct dalcs_stage_order *o = &f->order[q];
        dalcs_lu_finish(&f->lu[q]);
        free(o->row_of);
        free(o->scale);
        free(o->position);
        free(o->wave_at);
        *o = (struct dalcs_stage_order){0};
    }
}

/* The largest miss of the rows without derivatives over the largest of their terms, balanced, at
 * the last stage of an arbitrary step. */
static enum dalcs_status find_residual(struct dalcs_stages *stages, struct dalcs_stage_entry *entry,
                                       const struct dalcs_stage_matrix *m) {
    const struct dalcs_stage_plan *plan = stages->plan;
    const struct dalcs_system *s = stages->system;
    const struct dalcs_stage_layout *l = &stages->layout;
    int n_equations = dalcs_system_n_equations(s);
    double *in = dalcs_alloc((size_t)stages->n_in, sizeof(double));
    double *out = dalcs_alloc((size_t)l->n_fixed, sizeof(double));
    enum dalcs_status status = DALCS_E_NOMEM;
    if (in != NULL && out != NULL) {
        for (int k = 0; k < stages->n_in; k++) {
            in[k] = k == s->n_x ? 1.0 : cos(1.0 + k * (double)k);
        }
        status = dalcs_stage_factors_apply(stages, entry, in, out);
    }
    double *y = out != NULL ? out + stages->method->s * l->stride : NULL;
    double worst = 0.0;
    double size = 0.0;
    for (int d = 0; status == DALCS_OK && d < s->n_pairs; d++) {
        y[n_equations + d] *= dalcs_stage_is_on(entry, d) ? 1.0 : 0.0;
    }
    for (int u = s->n_x; status == DALCS_OK && u < m->n; u++) {
        int d = u < n_equations ? -1 : m->pair[u - n_equations];
        int r = d < 0 ? u : n_equations + d;
        const struct dalcs_csr *a = d < 0 ? &s->A : &s->C;
        int from = d < 0 ? u : d;
        double missed = plan->constant[r];
        double terms = fabs(missed);
        for (int k = a->p[from]; k < a->p[from + 1]; k++) {
            double term = (d < 0 ? a->x[k] : -a->x[k]) * y[a->j[k]];
            missed += term;
            terms += fabs(term);
            if (a->j[k] < s->n_x) { /* solved for as an increment over this */
                terms += fabs(a->x[k] * in[a->j[k]]);
            }
        }
        for (int k = plan->wave_begin[r]; k < plan->wave_begin[r + 1]; k++) {
            double term = plan->wave_x[k] *
                          plan->share[plan->wave_of[k] * DALCS_N_SHARES + stages->method->s];
            missed += term;
            terms += fabs(term);
        }
        worst = missed != missed ? INFINITY : fmax(worst, m->row_scale[u] * fabs(missed));
        size = fmax(size, m->row_scale[u] * terms);
    }
    entry->residual = size > 0.0 ? worst / size : 0.0;
    free(in);
    free(out);
    return status;
}

static enum dalcs_status build(struct dalcs_stages *stages, struct dalcs_stage_entry *entry,
                               struct dalcs_stage_matrix *m) {
    const struct dalcs_system *s = stages->system;
    const struct dalcs_excitation *e = stages->excitation;
    struct dalcs_stage_factors *f = entry->factors;
    DALCS_TRY(dalcs_stage_plan_get(stages));
    f->n = entry->n;
    f->n_pairs = entry->n_on;
    f->n_systems = 1 + stages->method->n_pairs;
    f->pair = dalcs_alloc((size_t)s->n_pairs, sizeof(int));
    f->column_scale = dalcs_alloc((size_t)dalcs_system_n_columns(s), sizeof(double));
    f->function_share = dalcs_alloc((size_t)e->n_functions, DALCS_N_SHARES * sizeof(double));
    if (f->pair == NULL || f->column_scale == NULL || f->function_share == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(f->pair, entry->on, (size_t)entry->n_on * sizeof(int));
    for (int k = 0; k < e->n_functions; k++) {
        find_function_shares(stages, entry->h, &e->function[k],
                             f->function_share + k * DALCS_N_SHARES);
    }
    DALCS_TRY(dalcs_stage_matrix_build(m, stages->plan, f->n_pairs, f->pair, entry->h));
    memcpy(f->column_scale, m->column_scale, (size_t)m->n * sizeof(double));
    memcpy(entry->natural, m->column_scale, (size_t)dalcs_system_n_equations(s) * sizeof(double));
    enum dalcs_status status = factor_regular(stages, entry, f, m);
    if (status == DALCS_OK) {
        remember_pivots(stages->plan, f);
        DALCS_TRY(find_residual(stages, entry, m));
    } else if (status == DALCS_SINGULAR && s->n_pairs > 0) {
        drop_systems(f);
        DALCS_TRY(dalcs_stage_singular_build(stages, entry, f));
        entry->n_clashes = stages->method->s;
        entry->residual = dalcs_stage_singular_residual(stages->plan, entry, f);
    } else {
        return status;
    }
    return entry->residual <= largest_residual ? DALCS_OK : DALCS_SINGULAR;
}

enum dalcs_status dalcs_stage_factors_build(struct dalcs_stages *stages,
                                            struct dalcs_stage_entry *entry) {
    struct dalcs_stage_factors *f = dalcs_alloc(1, sizeof(*f));
    if (f == NULL) {
        return DALCS_E_NOMEM;
    }
    entry->factors = f;
    struct dalcs_stage_matrix m = {0};
    enum dalcs_status status = build(stages, entry, &m);
    dalcs_stage_matrix_finish(&m);
    DALCS_TRY(status);
    size_t n = (size_t)f->n;
    entry->bytes += sizeof(*f) + dalcs_stage_singular_bytes(f->singular) +
                    (size_t)stages->system->n_pairs * sizeof(int) + n * sizeof(double) +
                    (size_t)stages->excitation->n_functions * DALCS_N_SHARES * sizeof(double);
    for (int q = 0; q < f->n_systems; q++) {
        entry->bytes += dalcs_lu_bytes(&f->lu[q]) + n * (2 * sizeof(int) + sizeof(double)) +
                        (size_t)stages->plan->n_waves * sizeof(int);
    }
    return DALCS_OK;
}

void dalcs_stage_factors_destroy(struct dalcs_stage_factors *factors) {
    if (factors == NULL) {
        return;
    }
    drop_systems(factors);
    dalcs_stage_singular_destroy(factors->singular);
    free(factors->pair);
    free(factors->column_scale);
    free(factors->function_share);
    free(factors);
}
