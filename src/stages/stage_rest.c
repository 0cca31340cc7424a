/* stage_rest.c - islands of a mode, those that move, those next to them, and the rest. */
#include "stage_rest.h"

#include "stage_plan.h"
#include "union_find.h"

#include <stdlib.h>
#include <string.h>

/* So many columns beside those that move are kept awake, and a part of these. */
enum { LEAST_AHEAD = 64, PART_AHEAD = 4 };

/* Rest is worth its bookkeeping from one column in so many on. */
enum { LEAST_PART_AT_REST = 4 };

/* ---- All awake --------------------------------------------------------------------------------- */

static void put_run(struct dalcs_stage_runs *runs, int i) {
    if (runs->n > 0 && runs->run[runs->n - 1].end == i) {
        runs->run[runs->n - 1].end++;
    } else {
        runs->run[runs->n++] = (struct dalcs_stage_run){i, i + 1};
    }
}

static void wake_all(struct dalcs_stage_plan *plan) {
    struct dalcs_stage_rest *rest = &plan->rest;
    const struct dalcs_system *s = plan->stages->system;
    rest->any = false;
    rest->n_awake = dalcs_stage_plan_n_equations(plan);
    for (int k = 0; k < rest->n_awake; k++) {
        rest->row[k] = k;
        rest->column[k] = k;
    }
    memset(rest->may_close, 0xff, (size_t)plan->stages->n_words * sizeof(*rest->may_close));
    *rest->states.run = (struct dalcs_stage_run){0, s->n_x};
    *rest->without.run = (struct dalcs_stage_run){s->n_x, rest->n_awake};
    *rest->pairs.run = (struct dalcs_stage_run){0, s->n_pairs};
    rest->states.n = rest->without.n = rest->pairs.n = 1;
}

enum dalcs_status dalcs_stage_rest_setup(struct dalcs_stage_plan *plan) {
    struct dalcs_stage_rest *rest = &plan->rest;
    const struct dalcs_system *s = plan->stages->system;
    size_t n = (size_t)dalcs_stage_plan_n_equations(plan);
    rest->row = dalcs_alloc(n, sizeof(int));
    rest->column = dalcs_alloc(n, sizeof(int));
    rest->may_close = dalcs_alloc((size_t)plan->stages->n_words, sizeof(*rest->may_close));
    rest->states.run = dalcs_alloc((size_t)s->n_x / 2 + 1, sizeof(*rest->states.run));
    rest->without.run = dalcs_alloc(n / 2 + 1, sizeof(*rest->without.run));
    rest->pairs.run = dalcs_alloc((size_t)s->n_pairs / 2 + 1, sizeof(*rest->pairs.run));
    if (rest->row == NULL || rest->column == NULL || rest->may_close == NULL ||
        rest->states.run == NULL || rest->without.run == NULL || rest->pairs.run == NULL) {
        return DALCS_E_NOMEM;
    }
    wake_all(plan);
    return DALCS_OK;
}

void dalcs_stage_rest_finish(struct dalcs_stage_rest *rest) {
    free(rest->row);
    free(rest->column);
    free(rest->may_close);
    free(rest->states.run);
    free(rest->without.run);
    free(rest->pairs.run);
    *rest = (struct dalcs_stage_rest){0};
}

void dalcs_stage_rest_end(struct dalcs_stage_plan *plan) {
    wake_all(plan);
    plan->rest.settled = true;
}

/* ---- Is it enough? ----------------------------------------------------------------------------- */

static bool are_zero(const double *x, int begin, int end) {
    for (int k = begin; k < end; k++) {
        if (x[k] != 0.0) {
            return false;
        }
    }
    return true;
}

bool dalcs_stage_rest_allows(const struct dalcs_stage_plan *plan, const uint64_t *mode,
                             const double *x) {
    const struct dalcs_stage_rest *rest = &plan->rest;
    if (!rest->any) {
        return true;
    }
    for (int i = 0; i < plan->stages->n_words; i++) {
        if ((mode[i] & ~rest->may_close[i]) != 0) {
            return false;
        }
    }
    int from = 0;
    bool zero = true;
    for (int k = 0; x != NULL && k <= rest->states.n && zero; k++) {
        bool is_last = k == rest->states.n;
        zero = are_zero(x, from, is_last ? plan->stages->system->n_x : rest->states.run[k].begin);
        from = is_last ? from : rest->states.run[k].end;
    }
    return zero;
}

/* ---- Islands ----------------------------------------------------------------------------------- */

/* Items are the rows of M and, from n_rows on, its columns; level of an island, by its first item. */
struct islands {
    const struct dalcs_stage_plan *plan;
    const uint64_t *mode;
    int *of;        /* [2 n_rows] */
    int *level;     /* [2 n_rows] -1: at rest; 0: it moves; others: so many pairs away from there */
    int *n_columns; /* [2 n_rows] of equations */
    int n_awake;    /* columns of equations */
    int n_equations; /* of all */
};

static enum dalcs_status islands_init(struct islands *a, const struct dalcs_stage_plan *plan,
                                      const uint64_t *mode) {
    size_t n = 2 * (size_t)plan->n_rows;
    *a = (struct islands){plan, mode, .n_equations = dalcs_stage_plan_n_equations(plan)};
    a->of = dalcs_alloc(n, sizeof(int));
    a->level = dalcs_alloc(n, sizeof(int));
    a->n_columns = dalcs_alloc(n, sizeof(int));
    return a->of != NULL && a->level != NULL && a->n_columns != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

static void islands_finish(struct islands *a) {
    free(a->of);
    free(a->level);
    free(a->n_columns);
}

/* Row or column i of M is in the mode's matrix. */
static bool is_present(const struct islands *a, int i) {
    return i < a->n_equations || dalcs_mode_has(a->mode, i - a->n_equations);
}

static void join_column(struct islands *a, const struct dalcs_csr *m, int c) {
    for (int k = m->p[c]; k < m->p[c + 1]; k++) {
        if (is_present(a, m->j[k])) {
            dalcs_union_join(a->of, m->j[k], a->plan->n_rows + c);
        }
    }
}

static void find_islands(struct islands *a) {
    int n_rows = a->plan->n_rows;
    dalcs_union_reset(a->of, 2 * n_rows);
    for (int c = 0; c < n_rows; c++) {
        if (is_present(a, c)) {
            join_column(a, &a->plan->base, c);
            join_column(a, &a->plan->P, c);
        }
    }
    for (int i = 0; i < 2 * n_rows; i++) {
        a->of[i] = dalcs_union_find(a->of, i);
        a->level[i] = -1;
    }
    for (int c = 0; c < a->n_equations; c++) {
        a->n_columns[a->of[n_rows + c]]++;
    }
}

static void wake(struct islands *a, int item, int level) {
    int island = a->of[item];
    if (a->level[island] < 0) {
        a->level[island] = level;
        a->n_awake += a->n_columns[island];
    }
}

static bool has_source(const struct dalcs_stage_plan *plan, int row) {
    return plan->constant[row] != 0.0 || plan->wave_begin[row + 1] > plan->wave_begin[row];
}

static void wake_what_moves(struct islands *a, const double *x) {
    int n_rows = a->plan->n_rows;
    for (int c = 0; c < a->plan->stages->system->n_x; c++) {
        if (x[c] != 0.0) {
            wake(a, n_rows + c, 0);
        }
    }
    for (int r = 0; r < n_rows; r++) {
        bool is_pair = r >= a->n_equations;
        if (is_present(a, r) && (is_pair || has_source(a->plan, r))) {
            wake(a, r, 0);
        }
        if (is_present(a, r) && is_pair) {
            wake(a, n_rows + r, 0);
        }
    }
}

/* Item k of the shores of an open pair: the columns that its w is made of, then the rows where its
 * current would go. -1: there are no more. */
static int shore(const struct islands *a, int pair, int k) {
    const struct dalcs_csr *C = &a->plan->stages->system->C;
    const struct dalcs_csr *lambda = &a->plan->base;
    int column = a->n_equations + pair;
    int n_columns = C->p[pair + 1] - C->p[pair];
    if (k < n_columns) {
        return a->plan->n_rows + C->j[C->p[pair] + k];
    }
    k += lambda->p[column] - n_columns;
    return k < lambda->p[column + 1] ? lambda->j[k] : -1;
}

static bool is_of_equation(const struct islands *a, int item) {
    return item % a->plan->n_rows < a->n_equations;
}

static bool touches(const struct islands *a, int pair, int level) {
    for (int k = 0, item; (item = shore(a, pair, k)) >= 0; k++) {
        int of = a->level[a->of[item]];
        if (of >= 0 && of <= level) {
            return true;
        }
    }
    return false;
}

static void wake_shores(struct islands *a, int pair, int level) {
    for (int k = 0, item; (item = shore(a, pair, k)) >= 0; k++) {
        if (is_of_equation(a, item)) {
            wake(a, item, level);
        }
    }
}

/* From island to island over open pairs until enough are awake. */
static void wake_ahead(struct islands *a) {
    int enough = a->n_awake + a->n_awake / PART_AHEAD + LEAST_AHEAD;
    int before = -1;
    for (int level = 0; a->n_awake < enough && a->n_awake > before; level++) {
        before = a->n_awake;
        for (int d = 0; d < a->plan->stages->system->n_pairs; d++) {
            if (!dalcs_mode_has(a->mode, d) && touches(a, d, level)) {
                wake_shores(a, d, level + 1);
            }
        }
    }
}

/* ---- What is awake ----------------------------------------------------------------------------- */

static bool is_awake(const struct islands *a, int item) {
    return a->level[a->of[item]] >= 0;
}

/* Could the pair close? Does its w depend on anything that is awake? */
static void look_at_pair(const struct islands *a, int pair, bool *may_close, bool *is_seen) {
    *may_close = true;
    *is_seen = has_source(a->plan, a->n_equations + pair);
    for (int k = 0, item; (item = shore(a, pair, k)) >= 0; k++) {
        bool awake = is_awake(a, item);
        *may_close = *may_close && (awake || !is_of_equation(a, item));
        *is_seen = *is_seen || (awake && item >= a->plan->n_rows);
    }
}

/* false: rows and columns do not match, as in a mode that leaves something open. */
static bool list_awake(const struct islands *a, struct dalcs_stage_rest *rest) {
    const struct dalcs_system *s = a->plan->stages->system;
    int n_rows = 0;
    rest->n_awake = 0;
    rest->states.n = rest->without.n = rest->pairs.n = 0;
    for (int k = 0; k < a->n_equations; k++) {
        if (is_awake(a, k)) {
            rest->row[n_rows++] = k;
        }
        if (is_awake(a, a->plan->n_rows + k)) {
            rest->column[rest->n_awake++] = k;
            put_run(k < s->n_x ? &rest->states : &rest->without, k);
        }
    }
    memset(rest->may_close, 0, (size_t)a->plan->stages->n_words * sizeof(*rest->may_close));
    for (int d = 0; d < s->n_pairs; d++) {
        bool may_close;
        bool is_seen;
        look_at_pair(a, d, &may_close, &is_seen);
        rest->may_close[d / 64] |= (uint64_t)may_close << (d % 64);
        if (is_seen || may_close) {
            put_run(&rest->pairs, d);
        }
    }
    return n_rows == rest->n_awake;
}

enum dalcs_status dalcs_stage_rest_choose(struct dalcs_stage_plan *plan, const uint64_t *mode,
                                          const double *x) {
    struct islands a;
    enum dalcs_status status = islands_init(&a, plan, mode);
    if (status == DALCS_OK) {
        find_islands(&a);
        wake_what_moves(&a, x);
        wake_ahead(&a);
        int at_rest = a.n_equations - a.n_awake;
        /* where nothing moves at all there would be nothing to factor */
        plan->rest.any = a.n_awake > 0 && at_rest >= a.n_equations / LEAST_PART_AT_REST &&
                         list_awake(&a, &plan->rest);
        if (!plan->rest.any) {
            dalcs_stage_rest_end(plan);
        }
    }
    islands_finish(&a);
    return status;
}
