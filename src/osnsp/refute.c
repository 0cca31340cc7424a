/* refute.c - contradictions: along the ray that the proximal method ran away on, or in a tree of cases.
 *
 * A case says of some pairs on which side they are. Where the linear problem of a case (farkas.h) is contradictory
 * it is closed; else a pair that is on both sides at once splits it into two. When all cases are closed there is
 * no answer. A passive problem has one unless the first case is contradictory (Cottle, Pang and Stone 1992). */
#include "refute.h"

#include "farkas.h"
#include "nonnegative.h"
#include "osnsp_internal.h"

#include <math.h>
#include <string.h>

/* Rows and columns together up to which there is a tree, and the work that it may take, in flops. */
enum { MOST_SIZE = 600 };

static const double most_work = 4e9;

/* Passes of scaling by powers of 2; weights below this part of the largest, in scaled units, are rounding. */
enum { SCALING_PASSES = 6 };

static const double zero_weight = 1e-11;

/* Digits that weights are rounded to: the same ones are then the same to the last digit, and cancel. */
enum { ROUND_BITS = 36 };

/* An answer is no farther away than this many times what sources and states could raise. */
static const double farthest = 1e3;

struct refutation {
    const struct dalcs_osnsp *p;
    struct dalcs_claim claim;
    struct dalcs_arena work;
    int n_rows, n_columns;
    double *v, *clean;                /* [n_rows] weights */
    const double *proof;              /* those of the two that were tried last */
    double *sum;                      /* [3 n_columns] work of farkas.c */
    double *dense;                    /* [n_columns][n_rows] scaled */
    double *row_scale, *column_scale; /* [n_rows], [n_columns] */
    double *right;                    /* [n_rows] work: scaled */
    struct dalcs_nonnegative least;
    int *lambda, *slack; /* [n_pairs] columns of the least squares, -1 */
    long n_cases, most_cases;
};

/* ---- Along a ray --------------------------------------------------------------------------- */

/* Weights from a direction of all columns: what is 0 along it is so to its other side, too. */
static void weigh_by_ray(struct refutation *r, double sign) {
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

/* ---- The least squares of a case ----------------------------------------------------------- */

static void add_dense(void *user, int column, double value) {
    double *row = user;
    row[column] += value;
}

static double power_of_2(double size) {
    int exponent;
    (void)frexp(size, &exponent);
    return size > 0.0 ? ldexp(1.0, -(exponent / 2)) : 1.0;
}

/* Rows and columns of about the same size (D. Ruiz, RAL-TR-2001-034). */
static void balance(struct refutation *r) {
    size_t m = (size_t)r->n_rows;
    for (int pass = 0; pass < SCALING_PASSES; pass++) {
        for (int row = 0; row < r->n_rows; row++) {
            double most = 0.0;
            for (int c = 0; c < r->n_columns; c++) {
                most = fmax(most, fabs(r->dense[(size_t)c * m + (size_t)row]));
            }
            double by = power_of_2(most);
            r->row_scale[row] *= by;
            for (int c = 0; c < r->n_columns; c++) {
                r->dense[(size_t)c * m + (size_t)row] *= by;
            }
        }
        for (int c = 0; c < r->n_columns; c++) {
            double *column = r->dense + (size_t)c * m;
            double most = 0.0;
            for (int row = 0; row < r->n_rows; row++) {
                most = fmax(most, fabs(column[row]));
            }
            double by = power_of_2(most);
            r->column_scale[c] *= by;
            for (int row = 0; row < r->n_rows; row++) {
                column[row] *= by;
            }
        }
    }
}

static enum dalcs_status make_dense(struct refutation *r) {
    size_t m = (size_t)r->n_rows;
    size_t n = (size_t)r->n_columns;
    double *row = dalcs_arena_alloc(&r->work, n, sizeof(double));
    r->dense = dalcs_arena_alloc(&r->work, m * n, sizeof(double));
    r->row_scale = dalcs_arena_alloc(&r->work, m, sizeof(double));
    r->column_scale = dalcs_arena_alloc(&r->work, n, sizeof(double));
    r->right = dalcs_arena_alloc(&r->work, m, sizeof(double));
    r->lambda = dalcs_arena_alloc(&r->work, m, sizeof(int));
    r->slack = dalcs_arena_alloc(&r->work, m, sizeof(int));
    if (row == NULL || r->dense == NULL || r->row_scale == NULL || r->column_scale == NULL ||
        r->right == NULL || r->lambda == NULL || r->slack == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < m; i++) {
        memset(row, 0, n * sizeof(double));
        dalcs_claim_visit(&r->claim, (int)i, add_dense, row);
        for (size_t c = 0; c < n; c++) {
            r->dense[c * m + i] = row[c];
        }
        r->row_scale[i] = 1.0;
    }
    for (size_t c = 0; c < n; c++) {
        r->column_scale[c] = 1.0;
    }
    balance(r);
    return dalcs_nonnegative_setup(&r->least, &r->work, r->n_rows, r->n_columns + r->n_rows);
}

static int put_slack(struct refutation *r, int n, int row, double sign, bool is_free) {
    double *column = r->least.a + (size_t)n * (size_t)r->n_rows;
    memset(column, 0, (size_t)r->n_rows * sizeof(double));
    column[row] = sign;
    r->least.is_free[n] = is_free;
    return n + 1;
}

/* Does a resistance stand in this branch equation? What refutes a passive circuit dissipates nothing, so that such an
 * equation needs no weight (Cottle, Pang and Stone 1992, thm 3.1.2). */
static bool is_resistive(const struct dalcs_system *s, int row) {
    bool is = false;
    for (int k = s->A.p[row]; k < s->A.p[row + 1] && !is; k++) {
        is =
            s->row[row].kind == DALCS_LABEL_BRANCH && s->A.j[k] == s->dual[row] && s->A.x[k] != 0.0;
    }
    return is;
}

/* Is the problem but one of a passive circuit? Where a control says on which side a switch is, a current through a resistor
 * may contradict it. */
static bool is_passive(const struct dalcs_system *s) {
    bool is = s->monotone;
    for (int d = 0; d < s->n_pairs && is; d++) {
        is = !dalcs_claim_follows(s, d);
    }
    return is;
}

/* The columns of the present case; how many. */
static int put_columns(struct refutation *r) {
    const struct dalcs_system *s = r->claim.system;
    size_t m = (size_t)r->n_rows;
    int n_equations = dalcs_system_n_equations(s);
    int n = 0;
    for (int c = 0; c < r->n_columns; c++) {
        int d = c - n_equations;
        bool is_diode = d >= 0 && s->pair[d].kind == DALCS_PAIR_DIODE;
        if (d >= 0) {
            r->lambda[d] = dalcs_claim_is_void(&r->claim, c) ? -1 : n;
        }
        if (!dalcs_claim_is_void(&r->claim, c)) {
            r->least.is_free[n] = !is_diode;
            memcpy(r->least.a + (size_t)n++ * m, r->dense + (size_t)c * m, m * sizeof(double));
        }
    }
    bool needs_no_resistor = is_passive(s);
    for (int row = 0; row < n_equations && needs_no_resistor; row++) {
        n = is_resistive(s, row) ? put_slack(r, n, row, 1.0, true) : n;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        enum dalcs_side_claim side = r->claim.side[d];
        bool is_told = dalcs_claim_follows(s, d) && side != DALCS_EITHER_SIDE;
        r->slack[d] = side == DALCS_CLOSED ? -1 : n;
        if (side != DALCS_CLOSED) {
            n = put_slack(r, n, n_equations + d, -1.0, s->pair[d].kind == DALCS_PAIR_SWITCH);
        }
        n = put_slack(r, n, n_equations + s->n_pairs + d, side == DALCS_CLOSED ? -1.0 : 1.0,
                      !is_told);
    }
    return n;
}

static void put_right(struct refutation *r) {
    double most = 0.0;
    for (int row = 0; row < r->n_rows; row++) {
        double size;
        r->least.b[row] = r->row_scale[row] * dalcs_claim_right(&r->claim, row, &size);
        most = fmax(most, fabs(r->least.b[row]));
    }
    for (int row = 0; row < r->n_rows && most > 0.0; row++) {
        r->least.b[row] /= most;
    }
}

/* The weights as they are, without rounding, and rounded off: is one of these a contradiction? */
static bool is_refuted(struct refutation *r) {
    double most = 0.0;
    double largest = 0.0;
    for (int row = 0; row < r->n_rows; row++) {
        most = fmax(most, fabs(r->least.rest[row]));
    }
    for (int row = 0; row < r->n_rows; row++) {
        bool is_zero = !(fabs(r->least.rest[row]) > zero_weight * most);
        r->v[row] = r->row_scale[row] * r->least.rest[row];
        r->clean[row] = is_zero ? 0.0 : r->v[row];
        largest = fmax(largest, fabs(r->clean[row]));
    }
    r->proof = r->v;
    if (dalcs_claim_is_refuted(&r->claim, r->v, r->sum)) {
        return true;
    }
    r->proof = r->clean;
    if (dalcs_claim_is_refuted(&r->claim, r->clean, r->sum)) {
        return true;
    }
    for (int row = 0; row < r->n_rows && largest > 0.0; row++) {
        int exponent;
        double digits = frexp(r->clean[row] / largest, &exponent);
        r->clean[row] = ldexp(rint(ldexp(digits, ROUND_BITS)), exponent - ROUND_BITS);
    }
    return dalcs_claim_is_refuted(&r->claim, r->clean, r->sum);
}

/* Is the present case contradictory? */
static bool is_contradictory(struct refutation *r) {
    int n = put_columns(r);
    put_right(r);
    dalcs_nonnegative_solve(&r->least, n);
    return is_refuted(r);
}

/* ---- The tree of cases --------------------------------------------------------------------- */

/* The pair to split the present case by: one on both sides, or any, for small numbers may hide that; -1: none is
 * left. */
static int pair_to_split(const struct refutation *r) {
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
static bool refute_by_cases(struct refutation *r, int *split /* [n_pairs] */) {
    int depth = 0;
    for (;;) {
        if (r->n_cases++ >= r->most_cases) {
            return false;
        }
        if (!is_contradictory(r)) {
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

/* ---- All together -------------------------------------------------------------------------- */

/* V, A: how far sources, thresholds and states can drive an answer, through all conductances. */
static enum dalcs_status find_reach(struct dalcs_osnsp *p, double sigma, const double *u,
                                    double *reach) {
    const struct dalcs_system *s = p->system;
    double drive[2] = {0.0, 0.0};
    if (p->form[0]->sigma != sigma) {
        DALCS_TRY(dalcs_forms_get(p, sigma));
    }
    for (int x = 0; x < s->n_x && sigma > 0.0; x++) {
        drive[s->column_is_current[x]] = fmax(drive[s->column_is_current[x]], fabs(u[x]));
    }
    for (int k = 0; k < p->n_drives; k++) {
        const struct dalcs_drive *d = &p->drive[k];
        drive[d->is_current] = fmax(drive[d->is_current], d->coefficient * fabs(u[d->input]));
    }
    reach[0] = farthest * (drive[0] + drive[1] / p->form[0]->least_conductance);
    reach[1] = farthest * (drive[1] + drive[0] * p->form[0]->most_conductance);
    return DALCS_OK;
}

static enum dalcs_status setup(struct refutation *r, struct dalcs_osnsp *p, double sigma,
                               const double *u) {
    const struct dalcs_system *s = p->system;
    *r = (struct refutation){.p = p,
                             .claim = {.system = s, .sigma = sigma, .u = u},
                             .n_rows = dalcs_claim_n_rows(s),
                             .n_columns = dalcs_system_n_columns(s)};
    size_t m = (size_t)r->n_rows;
    size_t n = (size_t)r->n_columns;
    r->claim.side = dalcs_arena_alloc(&r->work, m, sizeof(*r->claim.side));
    r->v = dalcs_arena_alloc(&r->work, m, sizeof(double));
    r->clean = dalcs_arena_alloc(&r->work, m, sizeof(double));
    r->sum = dalcs_arena_alloc(&r->work, 3 * n, sizeof(double));
    if (r->claim.side == NULL || r->v == NULL || r->clean == NULL || r->sum == NULL) {
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

static enum dalcs_status refute(struct refutation *r, bool *is_certain) {
    for (int side = 0; side < 2 && r->p->witness.has_ray && !*is_certain; side++) {
        weigh_by_ray(r, side == 0 ? 1.0 : -1.0);
        *is_certain = dalcs_claim_is_refuted(&r->claim, r->v, r->sum);
    }
    if (*is_certain || r->n_rows + r->n_columns > MOST_SIZE) {
        return DALCS_OK;
    }
    double size = 1.0 + r->n_rows + r->n_columns; /* a part may have no equation */
    r->most_cases = 1 + (long)(most_work / (size * size * size));
    DALCS_TRY(make_dense(r));
    int *split = dalcs_arena_alloc(&r->work, (size_t)r->n_rows, sizeof(int));
    if (split == NULL) {
        return DALCS_E_NOMEM;
    }
    *is_certain = refute_by_cases(r, split);
    return DALCS_OK;
}

/* Lengths of steps, each a quarter of the one before, and how nearly 4 times as far each must lead. */
enum { LENGTHS = 6 };

static const double nearly = 0.01;

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
            stays[x] =
                stays[x] || !(now > 0.0) || (k > 0 && fabs(now - 4.0 * far[x]) > nearly * now);
            far[x] = now;
        }
    }
    for (int x = 0; x < s->n_x && status == DALCS_OK && !*is_certain; x++) {
        *is_certain = !stays[x];
    }
    dalcs_arena_finish(&work);
    return status < DALCS_OK ? status : DALCS_OK;
}

/* A ray of a system that is not passive tells of another problem, the transposed one, and names nothing for certain; the
 * weights do where there is but one case. Of several, each has its own. Without states and pairs they are a ray. */
static void keep_weights(struct dalcs_osnsp *p, const struct refutation *r) {
    const struct dalcs_system *s = p->system;
    const double *v = r->proof;
    if (!s->monotone && r->n_cases == 1) {
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
    struct refutation r;
    enum dalcs_status status = setup(&r, p, sigma, u);
    status = status == DALCS_OK ? refute(&r, is_certain) : status;
    if (*is_certain && r.n_cases > 0) {
        keep_weights(p, &r);
    }
    dalcs_arena_finish(&r.work);
    return status;
}
