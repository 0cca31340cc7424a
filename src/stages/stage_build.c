/* stage_build.c - the factors of a mode and step length: made, tried out on a step, dropped. */
#include "stage_update.h"

#include "magnitudes.h"
#include "rounding.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* mu / h of a system. */
static void find_eigenvalue(const struct dalcs_stages *stages, double h, int system, double *re,
                            double *im) {
    const struct dalcs_collocation *m = stages->method;
    *re = (system == 0 ? m->lambda : creal(m->mu[system - 1])) / h;
    *im = (system == 0 ? 0.0 : cimag(m->mu[system - 1])) / h;
}

/* Lists where lu[system] has the rows and unknowns of m. */
static enum dalcs_status list_order(const struct dalcs_stage_plan *plan,
                                    const struct dalcs_stage_matrix *m,
                                    struct dalcs_stage_factors *f, int system) {
    const struct dalcs_lu *lu = &f->lu[system];
    struct dalcs_stage_order *o = &f->order[system];
    size_t n = (size_t)m->n;
    int n_equations = f->n - f->n_pairs;
    o->n = m->n;
    o->row_of = dalcs_alloc(n, sizeof(int));
    o->scale = dalcs_alloc(n, sizeof(double));
    o->position = dalcs_alloc((size_t)f->n, sizeof(int));
    o->wave_at = dalcs_alloc((size_t)plan->waves.n_waves, sizeof(int));
    o->choice_at = dalcs_alloc((size_t)f->singular.n, sizeof(int));
    int n_rows = plan->n_rows + f->singular.n;
    int *at = dalcs_alloc((size_t)n_rows, sizeof(int)); /* positions of rows of M and of choices */
    if (o->row_of == NULL || o->scale == NULL || o->position == NULL || o->wave_at == NULL ||
        o->choice_at == NULL || at == NULL) {
        free(at);
        return DALCS_E_NOMEM;
    }
    o->of_pair = o->position + n_equations;
    for (int r = 0; r < n_rows; r++) {
        at[r] = -1;
    }
    for (int i = 0; i < m->n; i++) {
        int row = lu->from[i];
        o->row_of[i] = m->row[row];
        o->scale[i] = m->row_scale[row];
        o->position[lu->to[i]] = i;
        at[o->row_of[i]] = i;
    }
    for (int k = 0; k < plan->waves.n_waves; k++) {
        o->wave_at[k] = at[plan->waves.wave_row[k]];
    }
    for (int k = 0; k < f->singular.n; k++) {
        o->choice_at[k] = at[plan->n_rows + k];
    }
    free(at);
    return DALCS_OK;
}

/* The shares of the wave of a function of unit size. */
static void find_function_shares(const struct dalcs_stages *stages, double h,
                                 const struct dalcs_excitation_function *function, double *share) {
    const struct dalcs_collocation *m = stages->method;
    for (int k = 0; k <= m->s; k++) {
        share[k] = dalcs_excitation_function_at(function, h, m->node[k]);
    }
    share[m->s + 1] = share[0]; /* of a stage at the start, if any */
    struct dalcs_extended_row part;
    long double drift = share[0];
    double missed = dalcs_excitation_missed(function, m, h, share);
    for (int i = 1; i <= m->n_stages; i++) {
        drift -= m->exact.back[i - 1] * share[i];
    }
    dalcs_collocation_parts(m, share + 1, &part);
    share[DALCS_SHARE_REAL] = part.high[0];
    share[DALCS_SHARE_DRIFT] = (double)drift;
    share[DALCS_SHARE_RIPPLE] = missed;
    share[DALCS_SHARE_RIPPLE_RATE] = missed * m->worst.factor;
    for (int k = 0; k < 2 * m->n_pairs; k++) {
        share[DALCS_SHARE_PAIR + k] = part.high[1 + k];
    }
}

static enum dalcs_status factor_all(struct dalcs_stages *stages, struct dalcs_stage_entry *entry,
                                    struct dalcs_stage_factors *f, struct dalcs_stage_matrix *m,
                                    double rcond_min) {
    struct dalcs_stage_analysis *a;
    DALCS_TRY(dalcs_stage_plan_analyze(stages, entry->mode, f->singular.n > 0, m, &a));
    for (int q = 0; q < f->n_systems; q++) {
        double re;
        double im;
        find_eigenvalue(stages, entry->h, q, &re, &im);
        dalcs_stage_matrix_at(m, re, im, q > 0);
        const struct dalcs_columns columns = {
            .n = m->n, .p = m->p, .i = m->i, .x = m->values, .is_complex = q > 0};
        DALCS_TRY(dalcs_lu_factor_analyzed(&f->lu[q],
                                           q > 0 ? &stages->cache.klu_complex : &stages->cache.klu,
                                           a->symbolic, &a->numeric[q], &columns, rcond_min));
        DALCS_TRY(list_order(stages->plan, m, f, q));
    }
    return DALCS_OK;
}

static void remember_pivots(struct dalcs_stage_plan *plan, const struct dalcs_stage_matrix *m,
                            const struct dalcs_stage_factors *f) {
    for (int i = 0; i < m->n; i++) {
        plan->match[m->column[f->lu[0].to[i]]] = f->order[0].row_of[i];
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
        free(o->choice_at);
        *o = (struct dalcs_stage_order){0};
    }
}

/* entry->residual of an arbitrary step, from anywhere but where the circuit is. */
static enum dalcs_status find_residual(struct dalcs_stages *stages,
                                       struct dalcs_stage_entry *entry) {
    const struct dalcs_system *s = stages->system;
    struct dalcs_stage_plan *plan = stages->plan;
    const struct dalcs_stage_layout *l = &stages->layout;
    double *near = plan->work.near;
    double *nowhere = dalcs_alloc((size_t)plan->n_rows, sizeof(double));
    double *in = dalcs_alloc((size_t)stages->n_in, sizeof(double));
    double *out = dalcs_alloc((size_t)(l->n_fixed + entry->n_clashes), sizeof(double));
    enum dalcs_status status = DALCS_E_NOMEM;
    if (nowhere != NULL && in != NULL && out != NULL) {
        for (int k = 0; k < stages->n_in; k++) {
            in[k] = k == s->n_x ? 1.0 : cos(1.0 + k * (double)k);
        }
        plan->work.near = nowhere;
        status = dalcs_stage_factors_apply(stages, entry, in, out);
        plan->work.near = near;
    }
    if (status == DALCS_OK) {
        entry->residual = dalcs_stage_factors_miss(stages, entry, in, out);
    }
    free(nowhere);
    free(in);
    free(out);
    return status;
}

/* The same with choices in the place of rows that follow from others. */
static enum dalcs_status factor_singular(struct dalcs_stages *stages,
                                         struct dalcs_stage_entry *entry,
                                         struct dalcs_stage_factors *f,
                                         struct dalcs_stage_matrix *m) {
    const struct dalcs_stage_plan *plan = stages->plan;
    for (int i = 0; i < m->n; i++) {
        for (int k = 0; k < f->singular.n; k++) {
            if (m->row[i] == f->singular.row[k]) {
                f->singular.scale[k] = m->row_scale[i];
            }
        }
    }
    dalcs_stage_matrix_finish(m);
    DALCS_TRY(dalcs_stage_matrix_build(m, plan, f->n_pairs, f->pair, &f->singular, entry->h));
    memcpy(f->column_scale, m->column_scale, (size_t)m->n * sizeof(double));
    return factor_all(stages, entry, f, m, stages->rcond_min);
}

/* After pivots next to 0: a mode that leaves something open, or none. In a step of 1e-15 s a resistor beside a coil
 * of 0.4 H is 1e15 times as conductive, and where nothing else leads on, such pivots are all there is, or all that
 * are left once the choice is made. */
static enum dalcs_status factor_doubtful(struct dalcs_stages *stages,
                                         struct dalcs_stage_entry *entry,
                                         struct dalcs_stage_factors *f,
                                         struct dalcs_stage_matrix *m, double *largest) {
    drop_systems(f);
    DALCS_TRY(dalcs_stage_singular_find(&f->singular, stages->plan, entry));
    if (f->singular.n > 0) {
        entry->n_clashes = f->singular.n * stages->method->s;
        entry->gives_rows_up = f->singular.within_blocks;
        enum dalcs_status status = factor_singular(stages, entry, f, m);
        if (status != DALCS_SINGULAR) {
            return status;
        }
        drop_systems(f);
    }
    *largest = dalcs_answer_rounded;
    return factor_all(stages, entry, f, m, stages->rcond_min * stages->rcond_min);
}

static enum dalcs_status build(struct dalcs_stages *stages, struct dalcs_stage_entry *entry,
                               struct dalcs_stage_matrix *m) {
    const struct dalcs_system *s = stages->system;
    const struct dalcs_excitation *e = stages->excitation;
    struct dalcs_stage_plan *plan = stages->plan;
    struct dalcs_stage_factors *f = entry->factors;
    f->n = entry->n;
    f->n_pairs = entry->n_on;
    f->n_systems = 1 + stages->method->n_pairs;
    f->pair = dalcs_alloc((size_t)s->n_pairs, sizeof(int));
    f->column_scale = dalcs_alloc((size_t)dalcs_system_n_columns(s), sizeof(double));
    f->function_share = dalcs_alloc((size_t)e->n_functions, DALCS_N_SHARES * sizeof(double));
    if (f->pair == NULL || f->column_scale == NULL || f->function_share == NULL) {
        return DALCS_E_NOMEM;
    }
    f->pair_scale = f->column_scale + dalcs_system_n_equations(s);
    memcpy(f->pair, entry->on, (size_t)entry->n_on * sizeof(int));
    for (int k = 0; k < e->n_functions; k++) {
        find_function_shares(stages, entry->h, &e->function[k],
                             f->function_share + k * DALCS_N_SHARES);
    }
    DALCS_TRY(dalcs_stage_matrix_build(m, plan, f->n_pairs, f->pair, &f->singular, entry->h));
    memcpy(f->column_scale, m->column_scale, (size_t)m->n * sizeof(double));
    memcpy(entry->natural, f->column_scale, (size_t)dalcs_system_n_equations(s) * sizeof(double));
    enum dalcs_status status = factor_all(stages, entry, f, m, stages->rcond_min);
    double largest = dalcs_nothing;
    if (status == DALCS_OK) {
        remember_pivots(plan, m, f);
    } else if (status == DALCS_SINGULAR && s->n_pairs > 0) {
        DALCS_TRY(factor_doubtful(stages, entry, f, m, &largest));
    } else {
        return status;
    }
    DALCS_TRY(find_residual(stages, entry));
    return entry->residual <= largest ? DALCS_OK : DALCS_SINGULAR;
}

static enum dalcs_status build_own(struct dalcs_stages *stages, struct dalcs_stage_entry *entry) {
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
    entry->bytes += sizeof(*f) + dalcs_stage_singular_bytes(&f->singular) +
                    (size_t)stages->system->n_pairs * sizeof(int) + n * sizeof(double) +
                    (size_t)stages->excitation->n_functions * DALCS_N_SHARES * sizeof(double);
    for (int q = 0; q < f->n_systems; q++) {
        entry->bytes += dalcs_lu_bytes(&f->lu[q]) + n * (2 * sizeof(int) + sizeof(double)) +
                        (size_t)stages->plan->waves.n_waves * sizeof(int);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_stage_factors_build(struct dalcs_stages *stages,
                                            struct dalcs_stage_entry *entry, bool of_its_own) {
    DALCS_TRY(dalcs_stage_plan_get(stages));
    if (!of_its_own) {
        DALCS_TRY(dalcs_stage_update_build(stages, entry));
    }
    if (entry->factors != NULL) {
        entry->bytes += dalcs_stage_update_bytes(entry->factors);
        return DALCS_OK;
    }
    return build_own(stages, entry);
}

void dalcs_stage_factors_destroy(struct dalcs_stages *stages, struct dalcs_stage_factors *factors) {
    if (factors == NULL) {
        return;
    }
    if (factors->update != NULL) {
        dalcs_stage_update_destroy(stages, factors);
    } else {
        drop_systems(factors);
        dalcs_stage_singular_finish(&factors->singular);
        dalcs_stage_changes_destroy(stages, factors->change);
        free(factors->pair);
        free(factors->column_scale);
        free(factors->function_share);
    }
    free(factors);
}
