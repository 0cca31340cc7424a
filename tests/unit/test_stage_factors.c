/* test_stage_factors.c - steps on sparse factors, and on those of another mode with a few changes,
 * against the dense map, which is solved in extended precision and knows nothing of KLU. */
#include "stage_columns.h"
#include "stage_update.h"

#include "build_network.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Errors are measured against the largest quantity of their unit, and the largest term of an
 * equation in it: where nothing flows because of two large currents, their rounding remains. */
static const double regular_tolerance = 1e-12;
static const double singular_tolerance = 1e-12;

/* Digits that methods with more stages cost: their combinations cancel by 25 and by 300. */
static double lost_digits(int s) {
    return s == 7 ? 300.0 : s == 5 ? 25.0 : 5.0;
}

struct both {
    struct text_network text;
    const struct dalcs_system *system;
    struct dalcs_excitation excitation;
    struct dalcs_stages dense;
    struct dalcs_stages sparse;  /* each mode has its own factors */
    struct dalcs_stages updated; /* some are updates of others */
    double near;                 /* the largest of what steps are solved from */
};

/* Every row of F gets all inputs and C a few lambdas, which no netlist does. */
static void generalise(struct dalcs_system *s) {
    uint64_t random = 29;
    struct dalcs_triplets f = {0};
    struct dalcs_triplets c = {0};
    for (int d = 0; d < s->n_pairs; d++) {
        for (int k = 0; k < s->n_inputs; k++) {
            ck_assert_int_eq(dalcs_triplets_add(&f, d, k, next_random(&random)), DALCS_OK);
        }
        for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
            ck_assert_int_eq(dalcs_triplets_add(&c, d, s->C.j[k], s->C.x[k]), DALCS_OK);
        }
        for (int k = 0; k <= d; k++) {
            int column = dalcs_system_n_equations(s) + k;
            ck_assert_int_eq(dalcs_triplets_add(&c, d, column, 3.0 + next_random(&random)),
                             DALCS_OK);
        }
    }
    dalcs_csr_finish(&s->F);
    dalcs_csr_finish(&s->C);
    ck_assert_int_eq(dalcs_csr_compress(&s->F, s->n_pairs, s->n_inputs, &f), DALCS_OK);
    ck_assert_int_eq(dalcs_csr_compress(&s->C, s->n_pairs, dalcs_system_n_columns(s), &c),
                     DALCS_OK);
    dalcs_triplets_finish(&f);
    dalcs_triplets_finish(&c);
}

static void setup(struct both *b, const char *netlist, int s, bool general) {
    b->near = 0.0;
    build_good_network(&b->text, netlist);
    if (general) {
        generalise(&b->text.network.system[0]);
    }
    ck_assert_int_eq(b->text.network.n_systems, 1);
    b->system = &b->text.network.system[0];
    ck_assert_int_eq(dalcs_excitation_setup(&b->excitation, &b->text.circuit, b->system, NULL),
                     DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&b->dense, b->system, &b->excitation,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, s),
                                        &(struct dalcs_stage_limits){1000000, 1e-14, SIZE_MAX}),
                     DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&b->sparse, b->system, &b->excitation,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, s),
                                        &(struct dalcs_stage_limits){0, 1e-14, SIZE_MAX}),
                     DALCS_OK);
    ck_assert_int_eq(dalcs_stages_setup(&b->updated, b->system, &b->excitation,
                                        dalcs_collocation_of(DALCS_RADAU_IIA, s),
                                        &(struct dalcs_stage_limits){0, 1e-14, SIZE_MAX}),
                     DALCS_OK);
    b->sparse.cache.update_trust = 0;
}

static void finish(struct both *b) {
    dalcs_stages_finish(&b->dense);
    dalcs_stages_finish(&b->sparse);
    dalcs_stages_finish(&b->updated);
    dalcs_excitation_finish(&b->excitation);
    text_network_finish(&b->text);
}

/* Unit of a column at a node: 0 V, 1 A. */
static int unit_of(const struct dalcs_system *s, const struct dalcs_stage_entry *e, int column) {
    int n_equations = dalcs_system_n_equations(s);
    if (column < n_equations) {
        return s->column_is_current[column];
    }
    return column < dalcs_system_n_columns(s) && dalcs_stage_is_on(e, column - n_equations);
}

static void find_scales(const struct both *b, const struct dalcs_stage_entry *e, const double *x,
                        double *scale) {
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

struct tally {
    int n_regular, n_singular, n_clashes;
    int n_closings, n_openings, n_several; /* updates by what changes */
    int n_free;                            /* entries that free the states */
    int n_columns;                         /* several at once, with a guard */
};

/* Everything is compared, with a name for the message. */
static void compare(const struct both *b, const struct dalcs_stage_entry *dense,
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

/* Two steps from anywhere. */
static void check_steps(struct both *b, struct dalcs_stages *stages, const uint64_t *mode, double h,
                        struct dalcs_stage_entry *dense, uint64_t *random, struct tally *tally) {
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
static double weigh(const struct both *b, const double *weight, int first, const double *out,
                    int row) {
    double sum = 0.0;
    for (int node = first; node < b->dense.layout.n_nodes; node++) {
        sum += weight[node - first] * out[node * b->dense.layout.stride + row];
    }
    return sum;
}

/* Column k against the dense map of the same state, with no sources. */
static void compare_column(struct both *b, struct dalcs_stage_entry *dense,
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
static void check_columns(struct both *b, struct dalcs_stages *stages, const uint64_t *mode,
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
static void check_freedom(struct both *b, const uint64_t *mode, double h) {
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
static void check_units(const struct both *b, const struct dalcs_stage_entry *dense,
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

static void check_mode(struct both *b, const uint64_t *mode, double h, uint64_t *random,
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

/* All modes of up to 6 pairs, many of more. */
static struct tally check_system(const char *netlist, double h, bool general) {
    struct tally tally = {0};
    for (int s = 1; s <= 7; s += 2) {
        struct both b;
        setup(&b, netlist, s, general);
        int n_pairs = b.system->n_pairs;
        uint64_t random = 17;
        int n_modes = n_pairs <= 6 ? 1 << n_pairs : 64;
        for (int k = 0; k < n_modes; k++) {
            /* up or down, so that pairs close or open */
            uint64_t mode[2] = {(uint64_t)(s % 4 == 1 ? k : n_modes - 1 - k)};
            for (int d = 0; d < n_pairs && n_pairs > 6; d++) {
                bool on = next_random(&random) > (k % 8) * 0.25 - 1.0;
                mode[d / 64] = (mode[d / 64] & ~((uint64_t)1 << (d % 64))) | (uint64_t)on
                                                                                 << (d % 64);
            }
            check_mode(&b, mode, h, &random, &tally);
            if (k % 4 == 0) { /* a known pattern again */
                check_mode(&b, mode, h / 8.0, &random, &tally);
            }
        }
        finish(&b);
    }
    return tally;
}

static struct tally check_netlist(const char *netlist, double h) {
    return check_system(netlist, h, false);
}

/* Updates that are wrong are refused, and thus missing. */
static void check_updates(const struct tally *t) {
    ck_assert_int_gt(t->n_columns, 900);
    ck_assert_int_gt(t->n_closings, 15);
    ck_assert_int_gt(t->n_openings, 15);
    ck_assert_int_gt(t->n_several, 0);
}

START_TEST(test_ladder) {
    struct tally t = check_netlist("ladder\n"
                                   "v1 in 0 sin(0 10 1k)\n"
                                   "rs in n0 10\n"
                                   "d1 n0 m1 di\nr1 m1 n1 1\nc1 n1 0 1u\nrl1 n1 0 10k\n"
                                   "d2 n1 m2 di\nr2 m2 n2 1\nc2 n2 0 1u\nrl2 n2 0 10k\n"
                                   "d3 n2 m3 di\nr3 m3 n3 1\nc3 n3 0 1u\nrl3 n3 0 10k\n"
                                   "d4 n3 m4 di\nr4 m4 n4 1\nc4 n4 0 1u\nrl4 n4 0 10k\n"
                                   ".model di d\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_regular, 0);
    ck_assert_int_eq(t.n_singular, 0);
    ck_assert_int_gt(t.n_free, 0);
    check_updates(&t);
}

END_TEST

/* More unknowns than a piece of the combination holds, and two words of pairs. */
START_TEST(test_multiplier) {
    char text[16384];
    int at = snprintf(text, sizeof(text), "multiplier\nv1 a0 0 sin(0 100 50)\nvb b0 0 0\n");
    for (int k = 1; k <= 35; k++) {
        at += snprintf(text + at, sizeof(text) - (size_t)at,
                       "ca%d a%d a%d 1u\ncb%d b%d b%d 1u\nda%d b%d a%d di\ndb%d a%d b%d di\n", k,
                       k - 1, k, k, k - 1, k, k, k - 1, k, k, k, k);
    }
    (void)snprintf(text + at, sizeof(text) - (size_t)at,
                   "rl b35 0 10meg\n.model di d(ron=10)\n.tran 2u 4m uic\n.end\n");
    struct both b;
    setup(&b, text, 5, false);
    struct tally tally = {0};
    uint64_t random = 3;
    for (int k = 0; k < 4; k++) {
        uint64_t mode[2] = {0x0123456789abcdefu << k, 0x2bu >> k};
        check_mode(&b, mode, 1e-4, &random, &tally);
    }
    finish(&b);
    ck_assert_int_gt(tally.n_regular, 0);
}

END_TEST

START_TEST(test_coupled_coils) {
    struct tally t = check_netlist("coils\n"
                                   "v1 a 0 exp(0 10 1u 2u 20u 5u)\n"
                                   "r1 a b 0.5\n"
                                   "l1 b 0 1m\nl2 c 0 4m\nl3 d 0 1m\n"
                                   "k12 l1 l2 0.9\nk13 l1 l3 0.5\nk23 l2 l3 0.6\n"
                                   "d1 c e di\nd2 d e di\nc1 e 0 10u\nr2 e 0 50\n"
                                   "rc c 0 1k\nrd d 0 2k\n"
                                   ".model di d(vfwd=0.7 ron=0.01)\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_regular, 0);
    ck_assert_int_gt(t.n_closings, 0);
}

END_TEST

START_TEST(test_controlled_sources) {
    struct tally t = check_netlist("controlled\n"
                                   "v1 a 0 pulse(0 5 0 1u 1u 10u 20u)\n"
                                   "i1 0 c sin(0 1m 2k 0 300 30)\n"
                                   "v2 e 0 3\n"
                                   "r1 a b 100\nc1 b 0 100n\n"
                                   "e1 f 0 b 0 2\nr2 f g 50\nd1 g c di\nrc c 0 1k\nc2 c 0 1u\n"
                                   "g1 0 k c b 1m\nrk k 0 2k\nd2 k e di\n"
                                   "h1 m 0 v2 30\nrm m n 10\nl1 n 0 1m\n"
                                   "f1 0 n v1 0.5\nrn n 0 500\n"
                                   "s1 n c b 0 sw\ns2 k c a 0 sw off\n"
                                   "v3 p 0 sin(0 2 5k)\nrp p c 1k\ns3 m c p a sw\n"
                                   ".model sw sw(vt=1 vh=0.2)\n"
                                   ".model di d(vfwd=0.6)\n.tran 1u 1m uic\n.end\n",
                                   1e-6);
    ck_assert_int_gt(t.n_regular, 0);
    check_updates(&t);
}

END_TEST

/* Closed diodes tie capacitors to sources and to each other: currents of index 2. */
START_TEST(test_index_2) {
    struct tally t =
        check_netlist("loops of sources and capacitors\n"
                      "v1 a 0 sin(1 10 1k 0 100 20)\n"
                      "v2 b 0 pwl(0 0 1m 5)\n"
                      "d1 a c di\nc1 c 0 1u\nr1 c 0 1k\n"
                      "d2 c d di\nc2 d 0 2u\nr2 d 0 2k\n"
                      "rb b e 10\nl1 e f 1m\nd3 f g di\nl2 g 0 2m\nrf f 0 100\nrg g 0 200\n"
                      "c3 e d 1n\n"
                      ".model di d\n.tran 1u 1m uic\n.end\n",
                      1e-5);
    ck_assert_int_gt(t.n_regular, 0);
    check_updates(&t);
}

END_TEST

/* With all diodes open the direct-current side floats; with two closed in a loop a current is
 * open. */
START_TEST(test_floating_bridge) {
    struct tally t = check_netlist("bridge\n"
                                   "v1 a 0 sin(0 10 50)\n"
                                   "rs a s 0.5\n"
                                   "d1 s p di\nd2 0 p di\nd3 m s di\nd4 m 0 di\n"
                                   "cf p m 300n\nr1 p m 1k\n"
                                   ".model di d\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_singular, 0);
    ck_assert_int_eq(t.n_clashes, 0);
}

END_TEST

/* Equal diodes in parallel and in series, with a switch that must not count. */
START_TEST(test_shared_by_diodes) {
    struct tally t = check_netlist("parallel and series\n"
                                   "v1 a 0 sin(0 10 50)\nv2 k 0 pulse(0 1 0 1u 1u 1m 2m)\n"
                                   "r1 a b 1\n"
                                   "d1 b c di\nd2 b c di\nd3 b c di\n"
                                   "c1 c 0 10u\nr2 c 0 100\n"
                                   "d4 c d di\nd5 d e di\nr3 e 0 30\n"
                                   "s1 d f k 0 sw\nd6 f 0 di\n"
                                   ".model di d\n.model sw sw(vt=0.5)\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_singular, 0);
}

END_TEST

/* The same where surroundings differ by a thousand. */
START_TEST(test_shared_unequally) {
    struct tally t = check_netlist("loops and chains of diodes\n"
                                   "v1 a 0 sin(1 10 50)\nr1 a b 10\nr2 a c 1k\nr3 c 0 10k\n"
                                   "d1 b c di\nd2 c d di\nd3 b d di\nr4 d 0 300\n"
                                   "d4 b e di\nd5 e c di\nd6 e d di\nc1 c 0 1u\n"
                                   ".model di d\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_singular, 0);
}

END_TEST

START_TEST(test_general_system) {
    struct tally t = check_system("sources in the sides of pairs\n"
                                  "v1 a 0 sin(0 10 1k)\nv2 b 0 exp(0 5 0 1m 5m 1m)\nv3 f 0 2\n"
                                  "r1 a c 10\nc1 c 0 1u\nd1 c d di\nr2 d b 20\nl1 d 0 1m\n"
                                  "d2 d e di\nr3 e f 30\nc2 e 0 2u\nd3 c e di\n"
                                  ".model di d\n.tran 1u 1m uic\n.end\n",
                                  1e-5, true);
    ck_assert_int_gt(t.n_regular, 0);
    ck_assert_int_eq(t.n_singular, 0);
    check_updates(&t);
}

END_TEST

/* A mode may force a state to 0: what is left of it then is nothing but rounding. */
START_TEST(test_forced_to_zero) {
    struct tally t = check_netlist("coil against a diode\n"
                                   "l1 a 0 1m\nd1 a 0 di\n.model di d\n.tran 1u 1m uic\n.end\n",
                                   1e-5);
    ck_assert_int_gt(t.n_regular, 0);
    ck_assert_int_eq(t.n_singular, 0);
}

END_TEST

/* Sources that closed diodes put in parallel, or open ones in series. */
START_TEST(test_clashes) {
    struct tally t =
        check_netlist("clashes\n"
                      "v1 a 0 sin(0 10 50)\nd1 a b di\nv2 b 0 pulse(0 1 0 1u 1u 1m 2m)\n"
                      "i1 0 c exp(0 1 0 1m 5m 1m)\nd2 c 0 di\nd3 c a di\n"
                      "r1 b d 10\nc1 d 0 1u\n"
                      ".model di d\n.tran 1u 1m uic\n.end\n",
                      1e-5);
    ck_assert_int_gt(t.n_clashes, 0);
}

END_TEST

/* An update keeps the factors that it uses, and all bytes are accounted for. */
START_TEST(test_base_is_evicted) {
    struct both b;
    struct tally tally = {0};
    uint64_t random = 5;
    setup(&b,
          "peak detectors\n"
          "v1 n0 0 sin(0 10 1k)\n"
          "r1 n0 n1 1\nc1 n1 0 10n\nd1 n1 p1 di\ncp1 p1 0 10n\nrp1 p1 0 1meg\n"
          "r2 n1 n2 1\nc2 n2 0 10n\nd2 n2 p2 di\ncp2 p2 0 10n\nrp2 p2 0 1meg\n"
          ".model di d\n.tran 1u 1m uic\n.end\n",
          5, false);
    const uint64_t open = 0;
    const uint64_t first = 1;
    const double h = 1e-6;
    struct dalcs_stage_entry *base;
    struct dalcs_stage_entry *update;
    ck_assert_int_eq(dalcs_stages_get(&b.updated, &open, h, &base), DALCS_OK);
    ck_assert_int_eq(dalcs_stages_get(&b.updated, &first, h, &update), DALCS_OK);
    ck_assert(dalcs_stage_is_update(update));
    ck_assert_ptr_eq(update->factors->update->base, base);
    ck_assert_int_eq(b.updated.cache.factorizations, 1);
    ck_assert_uint_eq(b.updated.cache.bytes, base->bytes + update->bytes);
    b.updated.cache.most_bytes = 1; /* the next one is alone, with what it cannot do without */
    for (uint64_t mode = 2; mode <= 3; mode++) {
        check_mode(&b, &mode, h, &random, &tally);
        ck_assert(!dalcs_stages_find(&b.updated, &open, h));
        ck_assert(!dalcs_stages_find(&b.updated, &first, h));
        ck_assert_uint_eq(b.updated.cache.bytes, base->bytes + b.updated.cache.newest->bytes);
    }
    check_mode(&b, &open, h, &random, &tally); /* nothing changes */
    ck_assert_int_eq(b.updated.cache.factorizations, 1);
    check_mode(&b, &open, 2.0 * h, &random, &tally);
    ck_assert_int_eq(b.updated.cache.factorizations, 2);
    ck_assert_uint_eq(b.updated.cache.bytes, b.updated.cache.newest->bytes);
    finish(&b);
    ck_assert_int_eq(tally.n_closings, 3);
}

END_TEST

static const char *const peak_detector =
    "peak detector\nv1 n0 0 sin(0 10 1k)\nr1 n0 n1 1\nc1 n1 0 10n\n"
    "d1 n1 p1 di\ncp1 p1 0 10n\nrp1 p1 0 1meg\n.model di d\n.tran 1u 1m uic\n.end\n";

/* Where an update is used again and again, factors of its own are cheaper. */
START_TEST(test_update_is_spent) {
    struct both b;
    setup(&b, peak_detector, 3, false);
    struct dalcs_stage_entry *entry;
    int n_steps = 0;
    for (uint64_t mode = 0; mode < 2; mode++) {
        ck_assert_int_eq(dalcs_stages_get(&b.updated, &mode, 1e-6, &entry), DALCS_OK);
    }
    ck_assert(dalcs_stage_is_update(entry));
    for (uint64_t mode = 1; dalcs_stage_is_update(entry); n_steps++) {
        ck_assert_int_lt(n_steps, 10000);
        ck_assert_int_eq(dalcs_stages_get(&b.updated, &mode, 1e-6, &entry), DALCS_OK);
    }
    ck_assert_int_gt(n_steps, 10);
    ck_assert_int_eq(b.updated.cache.factorizations, 2);
    ck_assert_int_eq(HASH_COUNT(b.updated.cache.entries), 2);
    finish(&b);
}

END_TEST

/* A step that misses its equations is not believed: the mode gets factors of its own. */
START_TEST(test_update_is_doubtful) {
    struct both b;
    setup(&b, peak_detector, 3, false);
    struct dalcs_stage_entry *entry;
    struct tally tally = {0};
    uint64_t random = 7;
    for (uint64_t mode = 0; mode < 2; mode++) {
        check_mode(&b, &mode, 1e-6, &random, &tally);
    }
    const uint64_t closed = 1;
    ck_assert_int_eq(dalcs_stages_get(&b.updated, &closed, 1e-6, &entry), DALCS_OK);
    ck_assert(dalcs_stage_is_update(entry));
    ck_assert_int_eq(b.updated.cache.factorizations, 1);
    entry->factors->update->inverse[0][0] *= 1.0L + 1e-9L;
    entry->factors->update->inverse[1][0] *= 1.0L + 1e-9L;
    struct dalcs_stage_entry *dense;
    ck_assert_int_eq(dalcs_stages_get(&b.dense, &closed, 1e-6, &dense), DALCS_OK);
    check_steps(&b, &b.updated, &closed, 1e-6, dense, &random, &tally);
    ck_assert_int_eq(b.updated.cache.factorizations, 2);
    ck_assert_int_eq(dalcs_stages_get(&b.updated, &closed, 1e-6, &entry), DALCS_OK);
    ck_assert(!dalcs_stage_is_update(entry));
    finish(&b);
}

END_TEST

/* In a long chain of capacitors that diodes tie together a voltage that opens is small beside what it makes of
 * currents: digits cancel, which only some can spare. */
START_TEST(test_unseen_rounding) {
    char netlist[1 << 13];
    int length = sprintf(netlist, "multiplier\nv1 a0 0 sin(0 100 50k)\nr0 b0 0 1m\n");
    for (int k = 0; k < 30; k++) {
        length += sprintf(netlist + length,
                          "ca%d a%d a%d 1u\nda%d b%d a%d\ncb%d b%d b%d 1u\ndb%d a%d b%d\n", k, k,
                          k + 1, k, k, k + 1, k, k, k + 1, k, k + 1, k + 1);
    }
    sprintf(netlist + length, "rl b30 0 10meg\n.tran 1u 1m uic\n.end\n");
    struct both b;
    setup(&b, netlist, 5, false);
    const uint64_t closed = (UINT64_C(1) << 60) - 1;
    const uint64_t first_open = closed - 2;
    const double h = 5e-7;
    for (int spared = 0; spared < 2; spared++) {
        struct dalcs_stage_entry *entry;
        b.updated.unseen = spared ? 3e-13 : 0.0;
        ck_assert_int_eq(dalcs_stages_get(&b.updated, &closed, spared ? 2.0 * h : h, &entry),
                         DALCS_OK);
        ck_assert(!dalcs_stage_is_update(entry));
        ck_assert_int_eq(dalcs_stages_get(&b.updated, &first_open, spared ? 2.0 * h : h, &entry),
                         DALCS_OK);
        ck_assert(dalcs_stage_is_update(entry) == (spared == 1));
    }
    struct tally tally = {0};
    uint64_t random = 11;
    check_mode(&b, &first_open, 2.0 * h, &random, &tally);
    ck_assert_int_eq(tally.n_openings, 1);
    struct dalcs_stage_entry *update;
    ck_assert_int_eq(dalcs_stages_get(&b.updated, &first_open, 2.0 * h, &update), DALCS_OK);
    b.updated.unseen = 1e-9; /* residuals are reported: they are to be rounding */
    update->residual = 5e-14;
    ck_assert(!dalcs_stage_update_is_doubtful(&b.updated, update));
    update->residual = 2e-13;
    ck_assert(dalcs_stage_update_is_doubtful(&b.updated, update));
    finish(&b);
}

END_TEST

RUN_TESTS("stage factors", test_unseen_rounding, test_update_is_doubtful, test_base_is_evicted,
          test_update_is_spent, test_ladder, test_multiplier, test_coupled_coils,
          test_controlled_sources, test_index_2, test_floating_bridge, test_shared_by_diodes,
          test_shared_unequally, test_general_system, test_forced_to_zero, test_clashes)
