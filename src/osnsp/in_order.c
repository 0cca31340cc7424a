/* in_order.c - the systems of the blocks, and their answers put together. */
#include "in_order.h"

#include "block.h"
#include "rounding.h"
#include "scales.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct dalcs_ordered_blocks {
    int n;
    struct dalcs_block *block;
};

static enum dalcs_status build_all(struct dalcs_osnsp *p, int *place) {
    for (int k = 0; k < p->blocks->n; k++) {
        struct dalcs_block *b = &p->blocks->block[k];
        b->system.monotone = p->partition.is_monotone[k];
        DALCS_TRY(dalcs_block_extract(b, p->system, p->partition.block_of, k, place));
        DALCS_TRY(dalcs_osnsp_setup(&b->osnsp, &b->system, &p->options));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_in_order_build(struct dalcs_osnsp *p) {
    int n = p->partition.n_blocks;
    int *place = dalcs_alloc((size_t)dalcs_system_n_columns(p->system), sizeof(*place));
    enum dalcs_status status = DALCS_E_NOMEM;
    p->blocks = dalcs_alloc(1, sizeof(*p->blocks));
    if (p->blocks != NULL) {
        p->blocks->block = dalcs_alloc((size_t)n, sizeof(*p->blocks->block));
        p->blocks->n = p->blocks->block != NULL ? n : 0;
    }
    if (place != NULL && p->blocks != NULL && p->blocks->block != NULL) {
        status = build_all(p, place);
    }
    free(place);
    if (status != DALCS_OK) {
        dalcs_in_order_finish(p);
    }
    return status;
}

void dalcs_in_order_finish(struct dalcs_osnsp *p) {
    for (int k = 0; p->blocks != NULL && k < p->blocks->n; k++) {
        dalcs_block_finish(&p->blocks->block[k]);
    }
    if (p->blocks != NULL) {
        free(p->blocks->block);
    }
    free(p->blocks);
    p->blocks = NULL;
}

bool dalcs_osnsp_acts_on_what_it_reads(const struct dalcs_osnsp *p, const char *element) {
    const struct dalcs_system *s = p->system;
    const int *block_of = p->partition.block_of;
    int n_equations = dalcs_system_n_equations(s);
    bool acts = false;
    for (int r = 0; block_of != NULL && r < s->reads.n_rows && !acts; r++) {
        int block = block_of[r < n_equations ? s->dual[r] : r];
        for (int k = s->reads.p[r]; k < s->reads.p[r + 1] && !acts; k++) {
            acts = !p->partition.is_monotone[block] && block_of[s->reads.j[k]] == block &&
                   strcmp(s->reader[k], element) == 0;
        }
    }
    return acts;
}

/* ---- Solving ------------------------------------------------------------------------------- */

/* The pair of the whole system that pair d of the block is. */
static int whole_pair(const struct dalcs_osnsp *p, const struct dalcs_block *b, int d) {
    return b->column[dalcs_system_n_equations(&b->system) + d] -
           dalcs_system_n_equations(p->system);
}

static void go_in(const struct dalcs_osnsp *p, struct dalcs_block *b, const double *u,
                  const double *y) {
    const struct dalcs_system *s = &b->system;
    const double *inputs = u + p->system->n_x;
    int n_inputs = p->system->n_inputs;
    for (int x = 0; x < s->n_x; x++) {
        b->u[x] = u[b->column[x]];
    }
    memcpy(b->u + s->n_x, inputs, (size_t)n_inputs * sizeof(double));
    for (int k = 0; k < b->n_read; k++) {
        b->u[s->n_x + n_inputs + k] = y[b->read[k]];
    }
    for (int d = 0; d < s->n_pairs; d++) {
        dalcs_osnsp_command(&b->osnsp, d, dalcs_osnsp_is_on(p, whole_pair(p, b, d)));
    }
    b->osnsp.asks.refines = p->asks.refines;
    b->osnsp.asks.is_passing = p->asks.is_passing;
    b->osnsp.asks.most_enumerated = p->asks.most_enumerated;
}

/* What a block reads is known to the rounding of the answer that it is from. What should be 0 there is not, and nothing may be there
 * to balance it. Is there such a value? It is 0 now; the whole is certified in the end. */
static bool drop_rounding(const struct dalcs_osnsp *p, struct dalcs_block *b) {
    bool has_dropped = false;
    for (int k = 0; k < b->n_read; k++) {
        const int c = b->read[k];
        const struct dalcs_osnsp *from = &p->blocks->block[p->partition.block_of[c]].osnsp;
        const double scale = dalcs_scales_of_rows(
            from, (struct dalcs_scales){from->certificate.volt, from->certificate.ampere},
            p->system->column_is_current[c]);
        double *value = &b->u[b->system.n_x + p->system->n_inputs + k];
        if (*value != 0.0 && fabs(*value) <= dalcs_answer_rounded * scale) {
            *value = 0.0;
            has_dropped = true;
        }
    }
    return has_dropped;
}

static void come_back(struct dalcs_osnsp *p, const struct dalcs_block *b, double *y) {
    for (int c = 0; c < dalcs_system_n_columns(&b->system); c++) {
        y[b->column[c]] = b->y[c];
    }
    for (int d = 0; d < b->system.n_pairs; d++) {
        dalcs_osnsp_command(p, whole_pair(p, b, d), dalcs_osnsp_is_on(&b->osnsp, d));
    }
    p->least_norm = p->least_norm || b->osnsp.least_norm;
    bool is_unique = b->system.n_pairs == 0 || dalcs_osnsp_is_unique(&b->osnsp);
    p->cache.form[0]->answers = is_unique ? p->cache.form[0]->answers : DALCS_UNKNOWN;
}

/* What the block's counters grew by. */
static void add_counters(struct dalcs_osnsp *p, const struct dalcs_osnsp_counters *before,
                         const struct dalcs_osnsp_counters *now) {
    p->counters.pivots += now->pivots - before->pivots;
    p->counters.factorizations += now->factorizations - before->factorizations;
    p->counters.cache_hits += now->cache_hits - before->cache_hits;
    p->counters.singular += now->singular - before->singular;
    p->counters.enumerated += now->enumerated - before->enumerated;
}

static void take_witness(struct dalcs_osnsp *p, const struct dalcs_block *b) {
    const struct dalcs_witness *from = &b->osnsp.witness;
    dalcs_witness_copy(p, from);
    p->witness.has_ray =
        from->has_ray && b->n_read == 0; /* else what it reads does work along it, too */
    memset(p->witness.ray, 0, (size_t)dalcs_system_n_columns(p->system) * sizeof(double));
    for (int c = 0; c < dalcs_system_n_columns(&b->system); c++) {
        p->witness.ray[b->column[c]] = from->ray[c];
    }
}

static enum dalcs_status solve_all(struct dalcs_osnsp *p, double sigma, const double *u,
                                   double *y) {
    p->least_norm = false;
    p->cache.form[0]->answers = dalcs_osnsp_is_monotone(p) ? DALCS_UNIQUE : DALCS_UNKNOWN;
    for (int k = 0; k < p->blocks->n; k++) {
        struct dalcs_block *b = &p->blocks->block[k];
        struct dalcs_osnsp_counters before = b->osnsp.counters;
        go_in(p, b, u, y);
        enum dalcs_status status = dalcs_osnsp_solve(&b->osnsp, sigma, b->u, b->y);
        if (status > DALCS_OK && drop_rounding(p, b)) {
            status = dalcs_osnsp_solve(&b->osnsp, sigma, b->u, b->y);
        }
        add_counters(p, &before, &b->osnsp.counters);
        if (status == DALCS_INFEASIBLE) {
            take_witness(p, b);
        }
        if (status != DALCS_OK) {
            return status;
        }
        come_back(p, b, y);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_in_order_solve(struct dalcs_osnsp *p, double sigma, const double *u,
                                       double *y) {
    bool sources_clash;
    DALCS_TRY(solve_all(p, sigma, u, y));
    dalcs_certificate_evaluate_with_states(p, u, y, &sources_clash); /* blocks may have them */
    return dalcs_certificate_holds(p, sources_clash) ? DALCS_OK : DALCS_NOT_CONVERGED;
}
