/* stage_comparison.c - steps on sparse factors, and on those of another mode with a few changes, against the dense map,
 * which is solved in extended precision and knows nothing of KLU. */
#include "stage_comparison.h"

#include <math.h>
#include <stdlib.h>

/* Errors are measured against the largest quantity of their unit, and the largest term of an
 * equation in it: where nothing flows because of two large currents, their rounding remains. */
static const double regular_tolerance = 1e-12;
static const double singular_tolerance = 1e-12;

/* Digits that methods with more stages cost: their combinations cancel by 25 and by 300. */
static double lost_digits(int s) {
    return s == 7 ? 300.0 : s == 5 ? 25.0 : 5.0;
}

/* Unit of a column at a node: 0 V, 1 A. */
static int unit_of(const struct dalcs_system *s, const struct dalcs_stage_entry *e, int column) {
    int n_equations = dalcs_system_n_equations(s);
    if (column < n_equations) {
        return s->column_is_current[column];
    }
    return column < dalcs_system_n_columns(s) && dalcs_stage_is_on(e, column - n_equations);
}

static void find_scales(const struct three_stages *b, const struct dalcs_stage_entry *e,
                        const double *x, double *scale) {
    const struct dalcs_system *s = b->system;
    scale[0] = 0.0;
    scale[1] = 0.0;
    for (int node = 0; node < b->dense.layout.n_nodes; node++) {
        const double *y = x + node * b->dense.layout.stride;
        for (int c = 0; c < b->dense.layout.stride; c++) {
            int u = unit_of(s, e, c);
            scale[u] = fmax(scale[u], fabs(y[c]));
        }
        for (int r = 0; r < dalcs_system_n_equations(s); r++) {
            int u = s->row_is_current[r];
            for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
                int c = s->A.j[k];
                if (c < dalcs_system_n_equations(s)) {
                    scale[u] = fmax(scale[u], fabs(s->A.x[k] * y[c]));
                }
            }
        }
    }
}

/* What has opened is first solved for as if it had not: then the start counts as well. */
static void raise_to_start(const struct dalcs_system *s, const struct dalcs_stage_entry *e,
                           const double *in, double *scale) {
    for (int r = 0; r < s->n_x; r++) {
        int u = unit_of(s, e, r);
        scale[u] = fmax(scale[u], fabs(in[r]));
        u = s->row_is_current[r];
        for (int k = s->P.p[r]; k < s->P.p[r + 1]; k++) {
            scale[u] = fmax(scale[u], fabs(s->P.x[k] * in[s->P.j[k]]) / e->h);
        }
    }
}

/* Everything is compared, with a name for the message. */
static void compare(const struct three_stages *b, const struct dalcs_stage_entry *dense,
                    const struct dalcs_stage_entry *sparse, const double *in, const double *x,
                    const double *y, struct tally *tally) {
    const struct dalcs_stage_layout *l = &b->dense.layout;
    const struct dalcs_system *s = b->system;
    int stages = b->dense.method->s;
    double scale[2];
    find_scales(b, dense, x, scale);
    if (dalcs_stage_is_update(sparse)) {
        raise_to_start(s, dense, in, scale);
    }
    scale[0] = fmax(scale[0], b->near);
    scale[1] = fmax(scale[1], b->near);
    double disagreement = 0.0;
    for (int k = 0; k < dense->n_clashes; k++) {
        disagreement = fmax(disagreement, fabs(x[l->n_fixed + k]));
    }
    bool clashes = disagreement > 1e-9 * fmax(scale[0], scale[1]);
    double found = 0.0;
    for (int k = 0; k < sparse->n_clashes; k++) {
        found = fmax(found, fabs(y[l->n_fixed + k]));
    }
    ck_assert_msg((found > 1e-9 * fmax(scale[0], scale[1])) == clashes, "clash %g for %g", found,
                  disagreement);
    tally->n_clashes += clashes;
    tally->n_singular += dense->n_clashes > 0;
    tally->n_regular += dense->n_clashes == 0;
    if (clashes) { /* there is no answer */
        ck_assert_double_ge(found, 0.01 * disagreement);
        return;
    }
    double tolerance = dense->n_clashes > 0 ? singular_tolerance : regular_tolerance;
    tolerance *= lost_digits(stages);
    /* What a singular mode leaves open is chosen at the start by where the polynomial and the
     * filter go, which differ by the drift. */
    double drift = 0.0;
    for (int k = 0; k < s->n_x && dense->n_clashes > 0; k++) {
        drift = fmax(drift, fabs(x[l->drift + k]));
    }
    for (int k = 0; k < l->n_fixed; k++) {
        int column = k < l->drift ? k % l->stride : k < l->ripple ? k - l->drift : k - l->ripple;
        double slack = k < l->stride || k >= l->ripple ? drift : 0.0;
        double error = fabs(x[k] - y[k]);
        ck_assert_msg(error <= tolerance * scale[unit_of(s, dense, column)] + slack,
                      "s = %d, out[%d] (node %d, column %d): %.17g, sparse %.17g", stages, k,
                      k < l->drift ? k / l->stride : -1, column, x[k], y[k]);
    }
}

void check_steps(struct three_stages *b, struct dalcs_stages *stages, const uint64_t *mode,
                 double h, struct dalcs_stage_entry *dense, uint64_t *random, struct tally *tally) {
    int n_equations = dalcs_system_n_equations(b->system);
    size_t n_out = (size_t)b->dense.layout.n_fixed + 64 +
                   (size_t)(b->dense.method->s * dalcs_system_n_columns(b->system));
    double *in = dalcs_alloc((size_t)b->dense.n_in, sizeof(*in));
    double *x = dalcs_alloc(n_out, sizeof(*x));
    double *y = dalcs_alloc(n_out, sizeof(*y));
    ck_assert(in != NULL && x != NULL && y != NULL);
    for (int round = 0; round < 2; round++) {
        for (int k = 0; k < b->dense.n_in; k++) {
            in[k] = next_random(random);
        }
        for (size_t k = 0; k < n_out; k++) {
            y[k] = 1e300; /* what is not written is seen */
        }
        ck_assert_int_eq(dalcs_stages_apply(&b->dense, dense, in, x), DALCS_OK);
        struct dalcs_stage_entry *sparse;
        ck_assert_int_eq(dalcs_stages_step(stages, mode, h, in, y, &sparse), DALCS_OK);
        ck_assert_double_le(dalcs_stage_residual(sparse), 1e-9);
        for (int d = 0; d < b->system->n_pairs; d++) {
            if (b->system->pair[d].kind == DALCS_PAIR_SWITCH && !dalcs_stage_is_on(sparse, d)) {
                ck_assert_double_eq(y[n_equations + d], 0.0);
            }
        }
        compare(b, dense, sparse, in, x, y, tally);
        if (sparse->n_clashes == 0) { /* the next one, in whatever mode, is solved from here */
            b->near = 0.0;
            for (int k = 0; k < dalcs_system_n_columns(b->system); k++) {
                y[k] *= 1e-3;
                b->near = fmax(b->near, fabs(y[k]));
            }
            dalcs_stages_stay_near(stages, mode, y);
        }
    }
    free(in);
    free(x);
    free(y);
}

/* What is asked of an answer: rows, at nodes from `first` on. */
static double weigh(const struct three_stages *b, const double *weight, int first,
                    const double *out, int row) {
    double sum = 0.0;
    for (int node = first; node < b->dense.layout.n_nodes; node++) {
        sum += weight[node - first] * out[node * b->dense.layout.stride + row];
    }
    return sum;
}

/* Column k against the dense map of the same state, with no sources. */
static void compare_column(struct three_stages *b, struct dalcs_stage_entry *dense,
                           const struct dalcs_stage_entry *sparse,
                           const struct dalcs_stage_columns *c, int k, double *in, double *x) {
    const struct dalcs_collocation *method = b->dense.method;
    const int n_x = b->system->n_x;
    double scale[2];
    memset(in, 0, (size_t)b->dense.n_in * sizeof(*in));
    for (int i = 0; i < n_x; i++) {
        in[i] = c->states[i][k];
    }
    ck_assert_int_eq(dalcs_stages_apply(&b->dense, dense, in, x), DALCS_OK);
    find_scales(b, dense, x, scale);
    if (dalcs_stage_is_update(sparse)) {
        raise_to_start(b->system, dense, in, scale);
    }
    const double tolerance = regular_tolerance * lost_digits(method->s);
    for (int i = 0; i < n_x; i++) {
        const double unit = tolerance * scale[unit_of(b->system, dense, i)];
        ck_assert_double_le(fabs(c->end[i][k] - weigh(b, c->weight, 0, x, i)), unit);
        ck_assert_double_le(fabs(c->begin[i][k] - weigh(b, method->back, 1, x, i)), unit);
    }
    if (c->row >= 0) {
        const double error = fabs(c->guard[k] - weigh(b, c->weight, 0, x, c->row));
        ck_assert_msg(error <= tolerance * scale[unit_of(b->system, dense, c->row)],
                      "s = %d, row %d: off by %g", method->s, c->row, error);
    }
}

/* a'(A b) = (A'a)'b, for four a at once; A of end and guard. The differences are of rounding. */
static void compare_transposed(const struct dalcs_stages *stages,
                               const struct dalcs_stage_entry *sparse,
                               const struct dalcs_stage_columns *c, uint64_t *random) {
    const size_t n_x = (size_t)stages->system->n_x;
    const size_t room = dalcs_stage_columns_room(stages->system);
    dalcs_four *storage = dalcs_alloc(3 * n_x + room, sizeof *storage);
    ck_assert(storage != NULL);
    struct dalcs_stage_columns back = {.weight = c->weight,
                                       .row = c->row,
                                       .states = storage,
                                       .end = storage + n_x,
                                       .begin = storage + 2 * n_x,
                                       .work = storage + 3 * n_x};
    dalcs_four forth = {0.0};
    dalcs_four size = {0.0};
    for (size_t x = 0; x < n_x; x++) {
        for (int k = 0; k < DALCS_COLUMNS; k++) {
            back.end[x][k] = next_random(random);
            forth[k] += back.end[x][k] * c->end[x][k];
            size[k] += fabs(back.end[x][k] * c->end[x][k]);
        }
    }
    for (int k = 0; k < DALCS_COLUMNS; k++) {
        back.guard[k] = c->row >= 0 ? next_random(random) : 0.0;
        forth[k] += back.guard[k] * c->guard[k];
        size[k] += fabs(back.guard[k] * c->guard[k]);
    }
    dalcs_stage_columns_apply_back(stages, sparse, &back);
    for (int k = 0; k < DALCS_COLUMNS; k++) {
        double sum = 0.0;
        for (size_t x = 0; x < n_x; x++) {
            sum += back.states[x][k] * c->states[x][k];
            size[k] += fabs(back.states[x][k] * c->states[x][k]);
        }
        ck_assert_msg(fabs(sum - forth[k]) <=
                          regular_tolerance * lost_digits(stages->method->s) * size[k],
                      "s = %d, row %d: transposed off by %g of %g", stages->method->s, c->row,
                      sum - forth[k], size[k]);
    }
    free(storage);
}

/* Some columns at once, with each guard. */
static void check_columns(struct three_stages *b, struct dalcs_stages *stages, const uint64_t *mode,
                          double h, struct dalcs_stage_entry *dense, struct tally *tally) {
    uint64_t random = 31 + mode[0];
    struct dalcs_stage_entry *sparse;
    const size_t n_x = (size_t)b->system->n_x;
    const size_t room = dalcs_stage_columns_room(b->system);
    double weight[DALCS_MAX_NODES];
    ck_assert_int_eq(dalcs_stages_get(stages, mode, h, &sparse), DALCS_OK);
    if (!dalcs_stage_columns_can(sparse)) {
        ck_assert_int_gt(dense->n_clashes, 0);
        return;
    }
    dalcs_four *storage = dalcs_alloc(3 * n_x + room, sizeof *storage);
    double *in = dalcs_alloc((size_t)b->dense.n_in, sizeof(*in));
    double *x = dalcs_alloc(dalcs_stages_room(&b->dense), sizeof(*x));
    ck_assert(storage != NULL && in != NULL && x != NULL);
    dalcs_collocation_weights(b->dense.method, 0.37 + 0.5 * next_random(&random), weight);
    struct dalcs_stage_columns c = {.weight = weight,
                                    .states = storage,
                                    .end = storage + n_x,
                                    .begin = storage + 2 * n_x,
                                    .work = storage + 3 * n_x};
    for (size_t k = 0; k < n_x * DALCS_COLUMNS; k++) {
        c.states[k / DALCS_COLUMNS][k % DALCS_COLUMNS] = next_random(&random);
    }
    c.row = -1;
    for (; c.row < b->dense.layout.stride; c.row++) {
        if (c.row == 0) {
            c.row = dalcs_system_n_equations(b->system);
        }
        dalcs_stage_columns_apply(stages, sparse, &c);
        for (int k = 0; k < DALCS_COLUMNS; k++) {
            compare_column(b, dense, sparse, &c, k, in, x);
        }
        compare_transposed(stages, sparse, &c, &random);
        tally->n_columns += c.row >= 0 ? DALCS_COLUMNS : 0;
    }
    free(storage);
    free(in);
    free(x);
}

/* Wherever the states are, a vanishing step leaves them there. */
static void check_freedom(struct three_stages *b, const uint64_t *mode, double h) {
    uint64_t random = 23;
    struct dalcs_stage_entry *dense;
    const struct dalcs_stage_layout *l = &b->dense.layout;
    double *in = dalcs_alloc((size_t)b->dense.n_in, sizeof(*in));
    double *out = dalcs_alloc((size_t)l->n_fixed + 64, sizeof(*out));
    ck_assert(in != NULL && out != NULL);
    ck_assert_int_eq(dalcs_stages_get(&b->dense, mode, ldexp(h, -40), &dense), DALCS_OK);
    for (int k = 0; k < b->dense.n_in; k++) {
        in[k] = next_random(&random);
    }
    ck_assert_int_eq(dalcs_stages_apply(&b->dense, dense, in, out), DALCS_OK);
    for (int node = 0; node < l->n_nodes; node++) {
        for (int k = 0; k < b->system->n_x; k++) {
            ck_assert_double_le(fabs(out[node * l->stride + k] - in[k]), 1e-5);
        }
    }
    free(in);
    free(out);
}

static void count_changes(const struct dalcs_stage_entry *entry, struct tally *tally) {
    if (!dalcs_stage_is_update(entry)) {
        return;
    }
    const struct dalcs_stage_update *u = entry->factors->update;
    ck_assert_int_eq(entry->n_clashes, 0);
    tally->n_closings += u->n_closed;
    tally->n_openings += u->n_changes - u->n_closed;
    tally->n_several += u->n_changes > 1;
}

/* The same units, unless rows are joined (stage_join.h), which balance otherwise. */
static void check_units(const struct three_stages *b, const struct dalcs_stage_entry *dense,
                        const struct dalcs_stage_entry *sparse) {
    int n_equations = dalcs_system_n_equations(b->system);
    bool is_joined = false;
    for (int r = 0; r < n_equations; r++) {
        is_joined = is_joined || b->sparse.plan->join.other[r] >= 0;
    }
    for (int k = 0; k < n_equations && !is_joined; k++) {
        ck_assert_double_eq(dense->natural[k], sparse->natural[k]);
    }
}

void check_mode(struct three_stages *b, const uint64_t *mode, double h, uint64_t *random,
                struct tally *tally) {
    struct dalcs_stage_entry *dense;
    struct dalcs_stage_entry *sparse;
    struct dalcs_stage_entry *updated;
    enum dalcs_status status = dalcs_stages_get(&b->dense, mode, h, &dense);
    ck_assert_int_eq(status, DALCS_OK);
    ck_assert_int_eq(dalcs_stages_get(&b->sparse, mode, h, &sparse), DALCS_OK);
    b->updated.cache.update_trust = DALCS_STAGE_FIRST_TRUST;
    ck_assert_int_eq(dalcs_stages_get(&b->updated, mode, h, &updated), DALCS_OK);
    ck_assert(!dalcs_stage_is_update(sparse));
    ck_assert_ptr_nonnull(sparse->factors);
    ck_assert_uint_gt(sparse->bytes, (size_t)sparse->n * sizeof(double));
    ck_assert_int_eq(sparse->n_clashes > 0, dense->n_clashes > 0);
    ck_assert_int_eq(updated->n_clashes > 0, dense->n_clashes > 0);
    ck_assert_double_le(dalcs_stage_residual(sparse), 1e-9);
    ck_assert_double_le(dalcs_stage_residual(updated), 1e-9);
    check_units(b, dense, sparse);
    if (dalcs_stage_frees_states(dense)) {
        check_freedom(b, mode, h);
    }
    tally->n_free += dalcs_stage_frees_states(dense);
    check_steps(b, &b->sparse, mode, h, dense, random, tally);
    check_steps(b, &b->updated, mode, h, dense, random, tally);
    check_columns(b, &b->sparse, mode, h, dense, tally);
    check_columns(b, &b->updated, mode, h, dense, tally);
    ck_assert_int_eq(dalcs_stages_get(&b->updated, mode, h, &updated), DALCS_OK);
    count_changes(updated, tally);
}
