/* refute.c - contradictions: along the ray that the proximal method ran away on, or in a tree of cases.
 *
 * A case says of some pairs on which side they are. Where the linear problem of a case (farkas.h) is contradictory
 * it is closed; else a pair that is on both sides at once splits it into two. When all cases are closed there is
 * no answer. A passive problem has one unless the first case is contradictory (Cottle, Pang and Stone 1992). */
#include "refute.h"

#include "magnitudes.h"
#include "null_space.h"
#include "osnsp_internal.h"
#include "refute_case.h"

#include <math.h>
#include <string.h>

/* Rows and columns together up to which there is a tree, and the work that it may take. */
enum { MOST_SIZE = 600, MOST_MEGAFLOPS = 4000 };

/* Weights from a direction of all columns: what is 0 along it is so to its other side, too. */
static void weigh_by_ray(struct dalcs_refutation *r, double sign) {
    const struct dalcs_system *s = r->claim.system;
    const double *ray = r->p->witness.ray;
    int n_equations = dalcs_system_n_equations(s);
    memset(r->v, 0, (size_t)r->n_rows * sizeof(double));
    for (int row = 0; row < n_equations; row++) {
        r->v[row] = sign * dalcs_witness_weight(&r->p->witness, s, row);
    }
    for (int d = 0; d < s->n_pairs; d++) {
        r->v[n_equations + d] = sign * ray[n_equations + d];
    }
}

/* The pair to split the present case by: one on both sides, or any, for small numbers may hide that; -1: none is
 * left. */
static int pair_to_split(const struct dalcs_refutation *r) {
    const struct dalcs_system *s = r->claim.system;
    int best = -1;
    double most = -1.0;
    for (int d = 0; d < s->n_pairs; d++) {
        if (r->claim.side[d] != DALCS_EITHER_SIDE) {
            continue;
        }
        if (s->pair[d].kind == DALCS_PAIR_SWITCH) {
            return d;
        }
        double both = fmin(r->least.q[r->lambda[d]], r->least.q[r->slack[d]]);
        if (!s->monotone && both > most) {
            most = both;
            best = d;
        }
    }
    return best;
}

/* Are all cases within the present one contradictory? Depth first: a pair that has been on its second side is put
 * back. */
static bool refute_by_cases(struct dalcs_refutation *r, int *split /* [n_pairs] */) {
    int depth = 0;
    for (;;) {
        if (r->n_cases++ >= r->most_cases) {
            return false;
        }
        if (!dalcs_refutation_closes(r)) {
            int d = pair_to_split(r);
            if (d < 0) {
                return false;
            }
            r->claim.side[d] = DALCS_CLOSED;
            split[depth++] = d;
            continue;
        }
        while (depth > 0 && r->claim.side[split[depth - 1]] == DALCS_OPENED) {
            r->claim.side[split[--depth]] = DALCS_EITHER_SIDE;
        }
        if (depth == 0) {
            return true;
        }
        r->claim.side[split[depth - 1]] = DALCS_OPENED;
    }
}

/* V, A: how far sources, thresholds and states can drive an answer, through all conductances. */
static enum dalcs_status find_reach(struct dalcs_osnsp *p, double sigma, const double *u,
                                    double *reach) {
    const struct dalcs_system *s = p->system;
    double drive[2] = {0.0, 0.0};
    if (p->cache.form[0]->sigma != sigma) {
        DALCS_TRY(dalcs_forms_get(p, sigma));
    }
    for (int x = 0; x < s->n_x && sigma > 0.0; x++) {
        drive[s->column_is_current[x]] = fmax(drive[s->column_is_current[x]], fabs(u[x]));
    }
    for (int k = 0; k < p->lists.n_drives; k++) {
        const struct dalcs_drive *d = &p->lists.drive[k];
        drive[d->is_current] = fmax(drive[d->is_current], d->coefficient * fabs(u[d->input]));
    }
    /* An answer is no farther away than a thousand times what sources and states could raise. */
    reach[0] = 1.0 / dalcs_small * (drive[0] + drive[1] / p->cache.form[0]->least_conductance);
    reach[1] = 1.0 / dalcs_small * (drive[1] + drive[0] * p->cache.form[0]->most_conductance);
    return DALCS_OK;
}

static enum dalcs_status setup(struct dalcs_refutation *r, struct dalcs_osnsp *p, double sigma,
                               const double *u) {
    const struct dalcs_system *s = p->system;
    *r = (struct dalcs_refutation){.p = p,
                                   .claim = {.system = s, .sigma = sigma, .u = u},
                                   .n_rows = dalcs_claim_n_rows(s),
                                   .n_columns = dalcs_system_n_columns(s)};
    size_t m = (size_t)r->n_rows;
    size_t n = (size_t)r->n_columns;
    r->claim.side = dalcs_arena_alloc(&r->work, m, sizeof(*r->claim.side));
    r->v = dalcs_arena_alloc(&r->work, m, sizeof(double));
    r->clean = dalcs_arena_alloc(&r->work, m, sizeof(double));
    r->right = dalcs_arena_alloc(&r->work, m, sizeof(double));
    r->sum = dalcs_arena_alloc(&r->work, 3 * n, sizeof(double));
    if (r->claim.side == NULL || r->v == NULL || r->clean == NULL || r->right == NULL ||
        r->sum == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        bool is_known = s->pair[d].kind == DALCS_PAIR_SWITCH && !dalcs_claim_follows(s, d);
        r->claim.side[d] = !is_known                 ? DALCS_EITHER_SIDE
                           : dalcs_osnsp_is_on(p, d) ? DALCS_CLOSED
                                                     : DALCS_OPENED;
    }
    return find_reach(p, sigma, u, r->claim.reach);
}

/* Is the ray that was found a contradiction? */
static bool is_refuted_by_ray(struct dalcs_refutation *r) {
    bool is_refuted = false;
    for (int side = 0; side < 2 && r->p->witness.has_ray && !is_refuted; side++) {
        weigh_by_ray(r, side == 0 ? 1.0 : -1.0);
        is_refuted = dalcs_claim_is_refuted(&r->claim, r->v, r->sum);
    }
    return is_refuted;
}

/* Where a row of the claim goes. */
struct collection {
    struct dalcs_triplets t;
    int row;
    enum dalcs_status status;
};

static void collect(void *user, int column, double value) {
    struct collection *to = user;
    if (to->status == DALCS_OK) {
        to->status = dalcs_triplets_add(&to->t, column, to->row, value);
    }
}

/* Weights under which the equations add up to 0, as those of an island's KCL do, in the digits that they have. */
static void weigh_equations(struct dalcs_refutation *r, const struct dalcs_null_space *space,
                            int k) {
    memset(r->v, 0, (size_t)r->n_rows * sizeof(double));
    dalcs_null_space_vector(space, k, r->v);
    for (int row = 0; row < space->n_columns; row++) {
        int exponent;
        (void)frexp(space->error[row], &exponent);
        if (space->error[row] > 0.0) {
            r->v[row] = ldexp(rint(ldexp(r->v[row], -exponent)), exponent);
        }
    }
}

static bool weights_refute(struct dalcs_refutation *r) {
    if (dalcs_claim_is_refuted(&r->claim, r->v, r->sum)) {
        return true;
    }
    for (int row = 0; row < r->n_rows; row++) {
        r->v[row] = -r->v[row];
    }
    return dalcs_claim_is_refuted(&r->claim, r->v, r->sum);
}

/* Do the equations contradict each other whatever the pairs do (Fredholm)? To all digits, which least squares lose where
 * conductances or sources are far apart. */
static enum dalcs_status refute_by_equations(struct dalcs_refutation *r, bool *is_certain) {
    const int n_equations = dalcs_system_n_equations(r->claim.system);
    struct collection to = {.status = DALCS_OK};
    struct dalcs_null_space space;
    for (to.row = 0; to.row < n_equations; to.row++) {
        dalcs_claim_visit(&r->claim, to.row, collect, &to);
    }
    if (to.status == DALCS_OK) {
        to.status = dalcs_null_space_find(&space, r->n_columns, n_equations, &to.t);
    }
    dalcs_triplets_finish(&to.t);
    if (to.status != DALCS_OK) {
        return to.status;
    }
    for (int k = 0; k < space.n_free && !*is_certain; k++) {
        weigh_equations(r, &space, k);
        *is_certain = weights_refute(r);
    }
    dalcs_null_space_finish(&space);
    if (*is_certain) {
        r->proof = r->v;
        r->n_cases = 1;
    }
    return DALCS_OK;
}

static enum dalcs_status refute_at_once(struct dalcs_refutation *r, bool *is_certain) {
    *is_certain = is_refuted_by_ray(r);
    return *is_certain ? DALCS_OK : refute_by_equations(r, is_certain);
}

enum dalcs_status dalcs_refute_at_once(struct dalcs_osnsp *p, double sigma, const double *u,
                                       bool *is_certain) {
    struct dalcs_refutation r;
    enum dalcs_status status = setup(&r, p, sigma, u);
    *is_certain = false;
    status = status == DALCS_OK ? refute_at_once(&r, is_certain) : status;
    dalcs_arena_finish(&r.work);
    return status;
}

static enum dalcs_status refute(struct dalcs_refutation *r, bool *is_certain) {
    DALCS_TRY(refute_at_once(r, is_certain));
    if (*is_certain || r->n_rows + r->n_columns > MOST_SIZE) {
        return DALCS_OK;
    }
    double size = 1.0 + r->n_rows + r->n_columns; /* a part may have no equation */
    r->most_cases = 1 + (long)(1e6 * MOST_MEGAFLOPS / (size * size * size));
    DALCS_TRY(dalcs_refutation_make_dense(r));
    int *split = dalcs_arena_alloc(&r->work, (size_t)r->n_rows, sizeof(int));
    if (split == NULL) {
        return DALCS_E_NOMEM;
    }
    *is_certain = refute_by_cases(r, split);
    return DALCS_OK;
}

/* Lengths of steps, each a quarter of the one before, of which each must lead 4 times as far. */
enum { LENGTHS = 6 };

/* Do states run away from x as 1/h, in certified answers? */
static enum dalcs_status runs_away(struct dalcs_osnsp *p, double sigma, const double *u,
                                   bool *is_certain) {
    const struct dalcs_system *s = p->system;
    size_t n_columns = (size_t)dalcs_system_n_columns(s);
    struct dalcs_arena work = {0};
    double *y = dalcs_arena_alloc(&work, n_columns, sizeof(double));
    double *far = dalcs_arena_alloc(&work, (size_t)s->n_x, sizeof(double));
    bool *stays = dalcs_arena_alloc(&work, (size_t)s->n_x, sizeof(bool));
    enum dalcs_status status = y == NULL || far == NULL || stays == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (int k = 0; k < LENGTHS && status == DALCS_OK; k++) {
        status = dalcs_osnsp_solve(p, ldexp(sigma, 2 * k), u, y);
        for (int x = 0; status == DALCS_OK && x < s->n_x; x++) {
            double now = fabs(y[x] - u[x]);
            stays[x] = stays[x] || !(now > 0.0) ||
                       (k > 0 && fabs(now - 4.0 * far[x]) > dalcs_slight * now);
            far[x] = now;
        }
    }
    for (int x = 0; x < s->n_x && status == DALCS_OK && !*is_certain; x++) {
        *is_certain = !stays[x];
    }
    dalcs_arena_finish(&work);
    return status < DALCS_OK ? status : DALCS_OK;
}

/* Weights that all nodes of an island have alike say nothing, unless its sources clash: without them what is left may be
 * small beside them. */
static const double *without_common(struct dalcs_refutation *r) {
    const struct dalcs_system *s = r->claim.system;
    if (r->p->lists.n_references != 1) {
        return r->proof;
    }
    const int held = s->A.j[s->A.p[r->p->lists.reference_row[0]]]; /* the node that is at 0 V */
    double common = 0.0;
    for (int row = 0; row < dalcs_system_n_equations(s); row++) {
        common = s->dual[row] == held ? r->proof[row] : common;
    }
    for (int row = 0; row < r->n_rows; row++) {
        const bool is_node = row < dalcs_system_n_equations(s) && s->row_is_current[row] &&
                             s->column[s->dual[row]].kind == DALCS_LABEL_NODE;
        const double own = r->proof[row] - (is_node ? common : 0.0);
        const bool is_rounding = is_node && fabs(own) <= dalcs_weight_rounded(fabs(common));
        r->right[row] = is_rounding ? 0.0 : own;
    }
    return dalcs_claim_is_refuted(&r->claim, r->right, r->sum) ? r->right : r->proof;
}

/* A ray of a system that is not passive tells of another problem, the transposed one, and names nothing for certain; the
 * weights do where there is but one case. Of several, each has its own. Of a passive system, and without states and pairs,
 * weights are a ray. */
static void keep_weights(struct dalcs_osnsp *p, struct dalcs_refutation *r) {
    const struct dalcs_system *s = p->system;
    const double *v = r->proof;
    if (s->monotone && r->n_cases == 1) {
        dalcs_witness_from_passive_weights(p, without_common(r));
    } else if (!s->monotone && r->n_cases == 1) {
        dalcs_witness_from_weights(p, v);
    } else if (!s->monotone) {
        dalcs_witness_from_cases(p);
    }
    if (!p->witness.has_ray && s->n_x == 0 && s->n_pairs == 0) {
        for (int row = 0; row < s->n_z; row++) {
            p->witness.ray[s->dual[row]] = v[row];
        }
        p->witness.has_ray = true;
    }
}

enum dalcs_status dalcs_osnsp_refute(struct dalcs_osnsp *p, double sigma, const double *u,
                                     bool *is_certain) {
    *is_certain = false;
    p->weighed.n_elements = 0;
    if (p->witness.kind == DALCS_WITNESS_DERIVATIVE) {
        return runs_away(p, sigma, u, is_certain);
    }
    struct dalcs_refutation r;
    enum dalcs_status status = setup(&r, p, sigma, u);
    status = status == DALCS_OK ? refute(&r, is_certain) : status;
    if (*is_certain && r.n_cases > 0) {
        keep_weights(p, &r);
    }
    dalcs_arena_finish(&r.work);
    return status;
}
