/* stage_plan.c - the parts of all matrices of a system, and analyses by mode. */
#include "stage_plan.h"

#include "lu.h"
#include "stage_matrix.h"

#include <stdlib.h>
#include <string.h>

/* Analyses and factors of so many unknowns altogether are kept, and never fewer than a few. */
enum { MOST_ANALYZED = 2000000, MOST_FACTORED = 100000, FEWEST = 4, MOST = 256 };

/* Columns of [-A; C] as rows; work[2 n_rows]: 0 before and after. */
static enum dalcs_status fill_base(struct dalcs_stage_plan *plan, const struct dalcs_system *s,
                                   double *work) {
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    int n_equations = dalcs_system_n_equations(s);
    for (int r = 0; r < n_equations && status == DALCS_OK; r++) {
        status = dalcs_stage_join_row(&plan->join, s, r, -1.0, work, &t);
    }
    for (int d = 0; d < s->n_pairs; d++) {
        for (int k = s->C.p[d]; k < s->C.p[d + 1] && status == DALCS_OK; k++) {
            status = dalcs_triplets_add(&t, s->C.j[k], n_equations + d, s->C.x[k]);
        }
    }
    if (status == DALCS_OK) {
        status = dalcs_csr_compress(&plan->base, plan->n_rows, plan->n_rows, &t);
    }
    dalcs_triplets_finish(&t);
    return status;
}

static enum dalcs_status fill_P(struct dalcs_stage_plan *plan, const struct dalcs_system *s) {
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    for (int r = 0; r < s->n_x; r++) {
        for (int k = s->P.p[r]; k < s->P.p[r + 1] && status == DALCS_OK; k++) {
            status = dalcs_triplets_add(&t, s->P.j[k], r, s->P.x[k]);
        }
    }
    if (status == DALCS_OK) {
        status = dalcs_csr_compress(&plan->P, plan->n_rows, plan->n_rows, &t);
    }
    dalcs_triplets_finish(&t);
    return status;
}

/* - base on its first n_columns columns, by rows. */
static enum dalcs_status fill_drive(const struct dalcs_stage_plan *plan, int n_columns,
                                    struct dalcs_csr *drive) {
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    for (int c = 0; c < n_columns; c++) {
        for (int k = plan->base.p[c]; k < plan->base.p[c + 1] && status == DALCS_OK; k++) {
            status = dalcs_triplets_add(&t, plan->base.j[k], c, -plan->base.x[k]);
        }
    }
    if (status == DALCS_OK) {
        status = dalcs_csr_compress(drive, plan->n_rows, n_columns, &t);
    }
    dalcs_triplets_finish(&t);
    return status;
}

/* Row `from` of E, or -F, into row r. */
static void add_sources(struct dalcs_stage_plan *plan, const struct dalcs_csr *a, int from,
                        double sign, int r) {
    const double *constant = plan->stages->excitation->constant;
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        int wave = plan->waves.wave_of_input[a->j[k]];
        if (wave < 0) {
            plan->constant[r] += sign * a->x[k] * constant[a->j[k]];
            continue;
        }
        plan->waves.wave_row[plan->waves.n_waves] = r;
        plan->waves.wave_of[plan->waves.n_waves] = wave;
        plan->waves.wave_x[plan->waves.n_waves++] = sign * a->x[k];
    }
}

/* Sources by rows: [E; -F], the constant ones summed. */
static void fill_sources(struct dalcs_stage_plan *plan, const struct dalcs_system *s) {
    const struct dalcs_excitation *e = plan->stages->excitation;
    int n_equations = dalcs_system_n_equations(s);
    for (int i = 0; i < s->n_inputs; i++) {
        plan->waves.wave_of_input[i] = -1;
    }
    for (int w = 0; w < e->n_waves; w++) {
        plan->waves.wave_of_input[e->wave[w].input] = w;
    }
    for (int r = 0; r < plan->n_rows; r++) {
        if (r >= n_equations) {
            add_sources(plan, &s->F, r - n_equations, -1.0, r);
        }
        for (int f = r < n_equations ? r : -1; f >= 0;
             f = dalcs_stage_join_after(&plan->join, r, f)) {
            add_sources(plan, &s->E, f, 1.0, r);
        }
        plan->waves.wave_begin[r + 1] = plan->waves.n_waves;
    }
}

/* Stages from parts, and the value at 0 of the polynomial through them. */
static void fill_combination(struct dalcs_stage_plan *plan) {
    const struct dalcs_collocation *m = plan->stages->method;
    plan->n_parts = 1 + 2 * m->n_pairs;
    for (int q = 0; q < plan->n_parts; q++) {
        for (int i = 0; i < m->s; i++) {
            plan->to[i + 1][q] = m->exact.to[q].high[i];
        }
        plan->to[0][q] = plan->to[m->s + 1][q] = m->exact.to[q].high[m->s];
    }
}

static bool allocate(struct dalcs_stage_plan *plan, const struct dalcs_system *s) {
    size_t n = (size_t)plan->n_rows;
    size_t n_entries = (size_t)(2 * s->E.p[s->E.n_rows] + s->F.p[s->F.n_rows]);
    plan->constant = dalcs_alloc(n, sizeof(double));
    plan->waves.wave_row = dalcs_alloc(n_entries, sizeof(int));
    plan->waves.wave_of = dalcs_alloc(n_entries, sizeof(int));
    plan->waves.wave_x = dalcs_alloc(n_entries, sizeof(double));
    plan->waves.wave_begin = dalcs_alloc(n + 1, sizeof(int));
    plan->waves.wave_of_input = dalcs_alloc((size_t)s->n_inputs, sizeof(int));
    plan->match = dalcs_alloc(n, sizeof(int));
    plan->analysis = dalcs_alloc((size_t)plan->most_analyses, sizeof(*plan->analysis));
    plan->work.rhs = dalcs_alloc(n, 2 * sizeof(double));
    plan->work.share =
        dalcs_alloc((size_t)plan->stages->excitation->n_waves, DALCS_N_SHARES * sizeof(double));
    plan->work.missed = dalcs_alloc(n, sizeof(double));
    plan->work.near = dalcs_alloc(n, sizeof(double));
    plan->work.from = dalcs_alloc(n, sizeof(double));
    plan->work.guard = dalcs_alloc((size_t)(s->n_pairs + plan->stages->n_watched), sizeof(double));
    return plan->constant != NULL && plan->waves.wave_row != NULL && plan->waves.wave_of != NULL &&
           plan->waves.wave_x != NULL && plan->waves.wave_begin != NULL &&
           plan->waves.wave_of_input != NULL && plan->match != NULL && plan->analysis != NULL &&
           plan->work.rhs != NULL && plan->work.share != NULL && plan->work.missed != NULL &&
           plan->work.near != NULL && plan->work.from != NULL && plan->work.guard != NULL;
}

static int how_many(int unknowns, int n) {
    int affordable = unknowns / (n + 1);
    return affordable < FEWEST ? FEWEST : affordable > MOST ? MOST : affordable;
}

static enum dalcs_status setup(struct dalcs_stage_plan *plan, const struct dalcs_system *s) {
    plan->n_rows = dalcs_system_n_columns(s);
    plan->most_analyses = how_many(MOST_ANALYZED, plan->n_rows);
    plan->most_kept = how_many(MOST_FACTORED, plan->n_rows);
    if (!allocate(plan, s)) {
        return DALCS_E_NOMEM;
    }
    for (int c = 0; c < plan->n_rows; c++) {
        plan->match[c] = -1;
    }
    DALCS_TRY(dalcs_stage_join_find(&plan->join, s));
    fill_sources(plan, s);
    fill_combination(plan);
    DALCS_TRY(fill_base(plan, s, plan->work.rhs));
    DALCS_TRY(fill_P(plan, s));
    DALCS_TRY(fill_drive(plan, plan->n_rows, &plan->drive));
    return fill_drive(plan, s->n_x, &plan->drive_of_states);
}

enum dalcs_status dalcs_stage_plan_get(struct dalcs_stages *stages) {
    if (stages->plan != NULL) {
        return DALCS_OK;
    }
    stages->plan = dalcs_alloc(1, sizeof(*stages->plan));
    if (stages->plan == NULL) {
        return DALCS_E_NOMEM;
    }
    stages->plan->stages = stages;
    enum dalcs_status status = setup(stages->plan, stages->system);
    if (status != DALCS_OK) {
        dalcs_stage_plan_destroy(stages);
    }
    return status;
}

static void drop_factors(struct dalcs_stages *stages, struct dalcs_stage_analysis *a) {
    for (int q = 0; q < DALCS_STAGE_SYSTEMS; q++) {
        dalcs_lu_drop(&a->numeric[q], q > 0,
                      q > 0 ? &stages->cache.klu_complex : &stages->cache.klu);
    }
}

static void forget(struct dalcs_stages *stages, struct dalcs_stage_analysis *a) {
    drop_factors(stages, a);
    klu_free_symbolic(&a->symbolic, &stages->cache.klu);
    free(a->mode);
    *a = (struct dalcs_stage_analysis){0};
}

void dalcs_stage_plan_destroy(struct dalcs_stages *stages) {
    struct dalcs_stage_plan *plan = stages->plan;
    if (plan == NULL) {
        return;
    }
    while (plan->n_analyses > 0) {
        forget(stages, &plan->analysis[--plan->n_analyses]);
    }
    stages->plan = NULL;
    dalcs_stage_join_finish(&plan->join);
    dalcs_csr_finish(&plan->base);
    dalcs_csr_finish(&plan->P);
    dalcs_csr_finish(&plan->drive);
    dalcs_csr_finish(&plan->drive_of_states);
    free(plan->constant);
    free(plan->waves.wave_row);
    free(plan->waves.wave_of);
    free(plan->waves.wave_x);
    free(plan->waves.wave_begin);
    free(plan->waves.wave_of_input);
    free(plan->match);
    free(plan->analysis);
    free(plan->work.rhs);
    free(plan->work.share);
    free(plan->work.missed);
    free(plan->work.near);
    free(plan->work.from);
    free(plan->work.guard);
    free(plan);
}

/* A copy of m->i with each column's match first; NULL when out of memory. */
static int *list_matches_first(const struct dalcs_stage_plan *plan,
                               const struct dalcs_stage_matrix *m) {
    const int *p = m->p;
    const int *i = m->i;
    int *first = dalcs_alloc((size_t)p[m->n], sizeof(int));
    for (int c = 0; first != NULL && c < m->n; c++) {
        int match = plan->match[m->column[c]];
        for (int k = p[c]; k < p[c + 1]; k++) {
            first[k] = i[k];
            if (m->row[i[k]] == match) {
                first[k] = first[p[c]];
                first[p[c]] = i[k];
            }
        }
    }
    return first;
}

static enum dalcs_status analyze(struct dalcs_stages *stages, const uint64_t *mode,
                                 bool is_singular, const struct dalcs_stage_matrix *m,
                                 struct dalcs_stage_analysis *a) {
    size_t words = (size_t)stages->n_words;
    int *first = list_matches_first(stages->plan, m);
    *a = (struct dalcs_stage_analysis){.mode = dalcs_alloc(words, sizeof(*mode)),
                                       .is_singular = is_singular};
    enum dalcs_status status = DALCS_E_NOMEM;
    if (first != NULL && a->mode != NULL) {
        status = dalcs_lu_analyze(&a->symbolic, &stages->cache.klu,
                                  &(struct dalcs_columns){.n = m->n, .p = m->p, .i = first});
    }
    free(first);
    if (status != DALCS_OK) {
        free(a->mode);
        return status;
    }
    memcpy(a->mode, mode, words * sizeof(*mode));
    return DALCS_OK;
}

enum dalcs_status dalcs_stage_plan_analyze(struct dalcs_stages *stages, const uint64_t *mode,
                                           bool is_singular, const struct dalcs_stage_matrix *m,
                                           struct dalcs_stage_analysis **analysis) {
    struct dalcs_stage_plan *plan = stages->plan;
    size_t bytes = (size_t)stages->n_words * sizeof(*mode);
    int at = 0;
    for (; at < plan->n_analyses; at++) {
        const struct dalcs_stage_analysis *a = &plan->analysis[at];
        if (a->is_singular == is_singular && memcmp(a->mode, mode, bytes) == 0) {
            break;
        }
    }
    struct dalcs_stage_analysis found;
    if (at < plan->n_analyses) {
        found = plan->analysis[at];
    } else {
        DALCS_TRY(analyze(stages, mode, is_singular, m, &found));
        if (at == plan->most_analyses) {
            forget(stages, &plan->analysis[--at]);
        } else {
            plan->n_analyses++;
        }
    }
    memmove(plan->analysis + 1, plan->analysis, (size_t)at * sizeof(found));
    plan->analysis[0] = found;
    if (plan->n_analyses > plan->most_kept) {
        drop_factors(stages, &plan->analysis[plan->most_kept]);
    }
    *analysis = &plan->analysis[0];
    return DALCS_OK;
}
