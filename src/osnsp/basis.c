/* basis.c - a regular mode of an answer that a singular one gave, if it has any.
 *
 * An answer with tied pairs, lambda = 0 = w, belongs to every mode that differs in these alone: the complementary
 * bases of a degenerate vertex. It is a vertex, the only answer of a regular mode, or shares something that no mode
 * decides. Which it is, is decided by as many exchanges as the matrix lacks ranks (Berkelaar, Jansen, Roos and Terlaky,
 * Math. Program. 86, 1999): a vector that the mode maps to 0 and in which a tied pair takes part is taken away as that
 * pair changes sides. Where the circuit is passive the matrix maps no vector to 0 that its transpose does not, so that
 * each exchange takes away exactly one. The mode is preferred for what comes after the instant: behind a singular one
 * the states may have no course at all. */
#include "null_space.h"
#include "osnsp_internal.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Work. */
struct basis {
    int *place;     /* [n_columns] */
    double *vector; /* [n_columns] one that the mode maps to 0 */
    double *part;   /* [n_pairs] what tied pairs have of it */
    int *exchange;  /* [n_pairs + 1] */
    bool *is_taken; /* [n_pairs] */
    struct dalcs_arena arena;
};

/* What a pair has in a vector: lambda of a closed one and w of an open one, in units of one conductance; 0 where it is
 * no more than rounding of its terms. */
static double part_in(const struct dalcs_osnsp *p, const int *place, const double *vector, int d) {
    const struct dalcs_csr *C = &p->system->C;
    double root = sqrt(p->cache.form[0]->pair_conductance);
    int at = place[dalcs_system_n_equations(p->system) + d];
    double sum = 0.0;
    double size = 0.0;
    if (at >= 0) {
        return fabs(vector[at]) / root;
    }
    for (int k = C->p[d]; k < C->p[d + 1]; k++) {
        double term = place[C->j[k]] >= 0 ? C->x[k] * vector[place[C->j[k]]] : 0.0;
        sum += term;
        size += fabs(term);
    }
    int n_columns = dalcs_system_n_columns(p->system);
    return fabs(sum) > n_columns * DBL_EPSILON * size ? fabs(sum) * root : 0.0;
}

/* Of the vectors that the mode maps to 0, those that share no tied pair with one before: each is taken away by the tied
 * pair that has most of it, whatever becomes of the others, for between them the parts are a diagonal matrix.
 * b->exchange[*n]; *n_open: how many vectors there are. */
static enum dalcs_status find_exchanges(const struct dalcs_osnsp *p, const struct basis *b, int *n,
                                        int *n_open) {
    struct dalcs_null_space space;
    DALCS_TRY(dalcs_whole_null_space(p, b->place, &space));
    memset(b->is_taken, 0, (size_t)p->system->n_pairs * sizeof(bool));
    *n = 0;
    *n_open = space.n_free;
    for (int k = 0; k < space.n_free; k++) {
        dalcs_null_space_vector(&space, k, b->vector);
        double most = 0.0;
        bool is_alone = true;
        for (int d = 0; d < p->system->n_pairs; d++) {
            b->part[d] = p->signs.tied[d] ? part_in(p, b->place, b->vector, d) : 0.0;
            is_alone = is_alone && !(b->part[d] > 0.0 && b->is_taken[d]);
            if (b->part[d] > most) {
                most = b->part[d];
                b->exchange[*n] = d;
            }
        }
        *n += is_alone && most > 0.0 ? 1 : 0;
        for (int d = 0; d < p->system->n_pairs && is_alone; d++) {
            b->is_taken[d] = b->is_taken[d] || b->part[d] > 0.0;
        }
    }
    dalcs_null_space_finish(&space);
    return DALCS_OK;
}

/* From p->mode; *is_regular: to a regular one. */
static enum dalcs_status exchange(struct dalcs_osnsp *p, const struct basis *b, bool *is_regular) {
    int before = dalcs_system_n_columns(p->system) + 1;
    int n_open;
    int n;
    DALCS_TRY(find_exchanges(p, b, &n, &n_open));
    while (n_open > 0 && n_open < before && n > 0) {
        before = n_open;
        for (int k = 0; k < n; k++) {
            dalcs_osnsp_flip(p, b->exchange[k]);
            p->signs.tied[b->exchange[k]] = false;
            p->counters.pivots++;
        }
        DALCS_TRY(find_exchanges(p, b, &n, &n_open));
    }
    *is_regular = n_open == 0;
    return DALCS_OK;
}

/* y is that of the mode before, but where the new one has one of its own. */
static enum dalcs_status move_to_basis(struct dalcs_osnsp *p, const double *u, double *y,
                                       bool *has_moved) {
    size_t n = (size_t)dalcs_system_n_columns(p->system);
    size_t n_pairs = (size_t)p->system->n_pairs;
    struct basis b = {0};
    b.place = dalcs_arena_alloc(&b.arena, n, sizeof(int));
    b.vector = dalcs_arena_alloc(&b.arena, n, sizeof(double));
    b.part = dalcs_arena_alloc(&b.arena, n_pairs, sizeof(double));
    b.exchange = dalcs_arena_alloc(&b.arena, n_pairs + 1, sizeof(int));
    b.is_taken = dalcs_arena_alloc(&b.arena, n_pairs, sizeof(bool));
    bool has_all = b.place != NULL && b.vector != NULL && b.part != NULL && b.exchange != NULL &&
                   b.is_taken != NULL;
    enum dalcs_status status = has_all ? DALCS_OK : DALCS_E_NOMEM;
    memcpy(p->work.tied_answer, y, n * sizeof(*y));
    *has_moved = false;
    if (status == DALCS_OK) {
        status = exchange(p, &b, has_moved);
    }
    if (status == DALCS_OK && *has_moved) {
        bool sources_clash;
        status = dalcs_osnsp_try_mode(p, u, y, &sources_clash);
        *has_moved = status == DALCS_OK && dalcs_certificate_holds(p, sources_clash);
        status = status > DALCS_OK ? DALCS_OK : status; /* next to singular */
    }
    dalcs_arena_finish(&b.arena);
    return status;
}

enum dalcs_status dalcs_basis_prefer(struct dalcs_osnsp *p, const double *u, double *y) {
    size_t bytes = (size_t)p->n_words * sizeof(*p->mode);
    uint64_t tie = dalcs_ties_name(p);
    struct dalcs_mode_entry *e;
    DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &e));
    if (e->tie == tie) { /* looked for before, not found */
        return DALCS_OK;
    }
    memcpy(p->work.tied_mode, p->mode, bytes);
    bool has_moved;
    enum dalcs_status status = move_to_basis(p, u, y, &has_moved);
    if (status < DALCS_OK || has_moved) {
        return status;
    }
    bool sources_clash;
    memcpy(p->mode, p->work.tied_mode, bytes);
    memcpy(y, p->work.tied_answer, (size_t)dalcs_system_n_columns(p->system) * sizeof(*y));
    dalcs_certificate_evaluate_either(p, u, y, &sources_clash);
    p->least_norm = true;
    DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &e));
    e->tie = tie;
    return DALCS_OK;
}
