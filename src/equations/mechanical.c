/* mechanical.c - M q'' + C q' + K q = f(t) + G' lambda as a DALCS of first order, x = (q, v).
 *
 *     contact     0 <= lambda _|_ G q + c >= 0, of relative degree two. A step that lands sets q on the
 *                 constraint, the next one v: the impact is inelastic, G v+ = 0, by the mass matrix's
 *                 projection (Heemels, Schumacher and Weiland 1999, thm 6.4 to 6.6)
 *     bilateral   0 = G q + c, written as 0 = G v: G q + c keeps the value 0 that it must have at first
 *                 (Brogliato 2022, sec. 6.4 reduces the index in this way)
 *     friction    -limit <= lambda <= limit against the sliding velocity G v + c: Coulomb's law
 *                 (Brogliato and Goeleven 2013, example 6.2) */
#include "reading.h"

#include <math.h>
#include <stdlib.h>

/* A bilateral constraint may be this far off at the start, over its largest term. */
static const double rounding = 1e-12;

static enum dalcs_status add(struct dalcs_described_system *s, enum dalcs_block_name block, int row,
                             int column, double value) {
    return dalcs_triplets_add(&s->block[block].entries, row, column, value);
}

/* entries of `from`, shifted and times `factor`, into `to` */
static enum dalcs_status move(struct dalcs_described_system *s, enum dalcs_block_name from,
                              enum dalcs_block_name to, int row, int column, double factor) {
    const struct dalcs_triplets *t = &s->block[from].entries;
    for (size_t k = 0; k < t->n; k++) {
        DALCS_TRY(add(s, to, row + t->entry[k].row, column + t->entry[k].column,
                      factor * t->entry[k].value));
    }
    return DALCS_OK;
}

static bool check_columns(struct dalcs_reading *r, const struct dalcs_described_system *s) {
    bool ok = s->n_states == 2 * s->n_coordinates && s->n_unknowns == 0 && s->n_rows == 0;
    for (size_t j = 0; j < s->n_multipliers; j++) {
        ok = ok && s->multiplier[j].constraint != DALCS_NO_CONSTRAINT;
    }
    if (!ok) {
        dalcs_builder_error(&r->builder, s->token, NULL,
                            "a system of coordinates has contacts, bilateral constraints and "
                            "friction, and no other states, unknowns or multipliers");
    }
    return ok;
}

/* q1 v1 q2 v2 -> q1 q2 v1 v2 */
static enum dalcs_status sort_states(struct dalcs_described_system *s) {
    size_t n = s->n_coordinates;
    struct dalcs_described_column *sorted = dalcs_alloc(2 * n, sizeof *sorted);
    if (sorted == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        sorted[k] = s->state[2 * k];
        sorted[n + k] = s->state[2 * k + 1];
    }
    free(s->state);
    s->state = sorted;
    s->state_capacity = 2 * n;
    return DALCS_OK;
}

/* Does G q + c vanish at the start, where it must for ever? */
static bool check_start(struct dalcs_reading *r, const struct dalcs_described_system *s, int j) {
    double sum = 0.0;
    double largest = 0.0;
    const struct dalcs_triplets *g = &s->block[DALCS_BLOCK_G].entries;
    const struct dalcs_triplets *c = &s->block[DALCS_BLOCK_CONSTANT_G].entries;
    for (size_t k = 0; k < g->n; k++) {
        double term = g->entry[k].value * s->state[g->entry[k].column].initial;
        sum += g->entry[k].row == j ? term : 0.0;
        largest = g->entry[k].row == j ? fmax(largest, fabs(term)) : largest;
    }
    for (size_t k = 0; k < c->n; k++) {
        sum += c->entry[k].row == j ? c->entry[k].value : 0.0;
        largest = c->entry[k].row == j ? fmax(largest, fabs(c->entry[k].value)) : largest;
    }
    if (fabs(sum) > rounding * largest) {
        dalcs_builder_error(&r->builder, s->token, "choose positions that fulfil it",
                            "the bilateral constraint '%s' is off by %g at the start",
                            s->multiplier[j].pair.element, sum);
        return false;
    }
    return true;
}

/* w of multiplier j, from the positions or from the velocities. */
static enum dalcs_status add_constraint(struct dalcs_reading *r, struct dalcs_described_system *s,
                                        int j) {
    const struct dalcs_triplets *g = &s->block[DALCS_BLOCK_G].entries;
    const struct dalcs_triplets *c = &s->block[DALCS_BLOCK_CONSTANT_G].entries;
    int n = (int)s->n_coordinates;
    enum dalcs_constraint kind = s->multiplier[j].constraint;
    if (kind == DALCS_BILATERAL && !check_start(r, s, j)) {
        return DALCS_OK;
    }
    for (size_t k = 0; k < g->n; k++) {
        const struct dalcs_triplet *e = &g->entry[k];
        if (e->row == j) {
            DALCS_TRY(add(s, DALCS_BLOCK_BBAR_I, n + e->column, j, e->value));
            DALCS_TRY(add(s, DALCS_BLOCK_C_I, j, kind == DALCS_CONTACT ? e->column : n + e->column,
                          e->value));
        }
    }
    for (size_t k = 0; k < c->n && kind != DALCS_BILATERAL; k++) {
        if (c->entry[k].row == j) {
            DALCS_TRY(add(s, DALCS_BLOCK_CONSTANT_F, j, 0, c->entry[k].value));
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_mechanical_to_first_order(struct dalcs_reading *r,
                                                  struct dalcs_described_system *s) {
    int n = (int)s->n_coordinates;
    if (!check_columns(r, s)) {
        return DALCS_OK; /* the error is reported */
    }
    DALCS_TRY(sort_states(s));
    for (int i = 0; i < n; i++) {
        DALCS_TRY(add(s, DALCS_BLOCK_P, i, i, 1.0));
        DALCS_TRY(add(s, DALCS_BLOCK_A_I, i, n + i, 1.0));
        if (s->block[DALCS_BLOCK_MASS].card == NULL) {
            DALCS_TRY(add(s, DALCS_BLOCK_MASS, i, i, 1.0));
        }
    }
    DALCS_TRY(move(s, DALCS_BLOCK_MASS, DALCS_BLOCK_P, n, n, 1.0));
    DALCS_TRY(move(s, DALCS_BLOCK_STIFFNESS, DALCS_BLOCK_A_I, n, 0, -1.0));
    DALCS_TRY(move(s, DALCS_BLOCK_DAMPING, DALCS_BLOCK_A_I, n, n, -1.0));
    DALCS_TRY(move(s, DALCS_BLOCK_FORCE, DALCS_BLOCK_E_I, n, 0, 1.0));
    DALCS_TRY(move(s, DALCS_BLOCK_CONSTANT_FORCE, DALCS_BLOCK_CONSTANT_I, n, 0, 1.0));
    DALCS_TRY(move(s, DALCS_BLOCK_STIFFNESS, DALCS_BLOCK_STORAGE, 0, 0, 1.0));
    DALCS_TRY(move(s, DALCS_BLOCK_MASS, DALCS_BLOCK_STORAGE, n, n, 1.0));
    for (int j = 0; j < (int)s->n_multipliers; j++) {
        DALCS_TRY(add_constraint(r, s, j));
    }
    return DALCS_OK;
}
