/* osnsp.c - finding the mode: the last one first, then block principal pivoting, then that of a problem with small
 * weights, by Lemke's method where pivots get nowhere; and for small systems that are not passive every mode. */
#include "in_order.h"
#include "latches.h"
#include "magnitudes.h"
#include "refute.h"

#include <string.h>

/* Iterative refinements of an answer whose residual is too large. */
enum { MAX_REFINEMENTS = 3 };

void dalcs_osnsp_unscale(const struct dalcs_osnsp *p, double *y) {
    const struct dalcs_step_form *f = p->cache.form[0];
    int n_equations = dalcs_system_n_equations(p->system);
    for (int i = 0; i < f->n; i++) {
        y[f->column_of[i]] = f->scale[i] * p->work.scaled[i];
    }
    for (int d = 0; d < f->n_pairs; d++) {
        y[n_equations + d] = f->scale[f->n + d] * p->work.scaled[f->n + d];
    }
}

/* R u solved straight into y's z and lambda: the way of every ordinary step. */
static void solve_to_answer(const struct dalcs_osnsp *p, const struct dalcs_mode_entry *e,
                            const double *u, double *y) {
    const struct dalcs_csr R = p->cache.form[0]->R;
    double *x = e->lu.work;
    for (int i = 0; i < e->lu.n; i++) {
        x[i] = dalcs_csr_row_dot(&R, e->row_of[i], u);
    }
    dalcs_lu_solve_ordered(&e->lu);
    memset(y + dalcs_system_n_equations(p->system), 0, (size_t)p->system->n_pairs * sizeof(double));
    for (int i = 0; i < e->lu.n; i++) {
        y[e->column_of[i]] = e->scale_of[i] * x[i];
    }
}

void dalcs_osnsp_scale(struct dalcs_osnsp *p, const double *y) {
    const struct dalcs_step_form *f = p->cache.form[0];
    int n_equations = dalcs_system_n_equations(p->system);
    for (int i = 0; i < f->n; i++) {
        p->work.scaled[i] = y[f->column_of[i]] / f->scale[i];
    }
    for (int d = 0; d < f->n_pairs; d++) {
        p->work.scaled[f->n + d] = y[n_equations + d] / f->scale[f->n + d];
    }
}

/* One step of iterative refinement: solve for the residual of the condensed rows. */
static void refine(struct dalcs_osnsp *p, const struct dalcs_mode_entry *e) {
    const struct dalcs_step_form *f = p->cache.form[0];
    int n = f->n + f->n_pairs;
    double *residual = p->work.residual;
    memcpy(residual, p->work.right, (size_t)n * sizeof(double));
    for (int c = 0; c < n; c++) {
        for (int k = f->K.p[c]; k < f->K.p[c + 1]; k++) {
            residual[f->K.j[k]] -= f->K.x[k] * p->work.scaled[c];
        }
    }
    memcpy(p->work.rhs, residual, (size_t)f->n * sizeof(double));
    for (int k = 0; k < e->n_on; k++) {
        p->work.rhs[f->n + k] = residual[f->n + e->on[k]];
    }
    dalcs_lu_solve(&e->lu, p->work.rhs);
    for (int i = 0; i < f->n; i++) {
        p->work.scaled[i] += p->work.rhs[i];
    }
    for (int k = 0; k < e->n_on; k++) {
        p->work.scaled[f->n + e->on[k]] += p->work.rhs[f->n + k];
    }
}

enum dalcs_status dalcs_osnsp_try_mode(struct dalcs_osnsp *p, const double *u, double *y,
                                       bool *sources_clash) {
    struct dalcs_mode_entry *e;
    DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &e));
    double tolerance = p->options.certificate_tolerance;
    p->least_norm = e->singular && (!e->answers || e->whole->n_choices > 0);
    bool by_factors = p->asks.refines && !e->singular;
    bool may_recur = e->singular ? e->answers : !by_factors;
    if (e->map == NULL && may_recur && e->n_uses++ > 2 && dalcs_step_map_pays(p)) {
        DALCS_TRY(dalcs_step_map_build(p, e));
    }
    if (e->map != NULL && !by_factors) {
        dalcs_step_map_apply(p, e, u, y);
        dalcs_certificate_evaluate(p, u, y, sources_clash);
        if (p->signs.n_violating > 0 || (p->certificate.worst <= tolerance && !*sources_clash)) {
            return DALCS_OK;
        }
    }
    if (e->singular) {
        if (!e->answers) {
            return DALCS_SINGULAR;
        }
        return dalcs_exact_evaluate(p, e->whole, u, y, sources_clash);
    }
    solve_to_answer(p, e, u, y);
    dalcs_certificate_evaluate(p, u, y, sources_clash);
    int wanted = p->asks.refines && p->signs.n_violating == 0 ? 1 : 0;
    if (p->certificate.worst > tolerance || *sources_clash || wanted > 0) {
        dalcs_osnsp_scale(p, y);
        dalcs_csr_multiply(&p->cache.form[0]->R, u, p->work.right);
    }
    for (int k = 0;
         k < MAX_REFINEMENTS && (p->certificate.worst > tolerance || *sources_clash || k < wanted);
         k++) {
        refine(p, e);
        dalcs_osnsp_unscale(p, y);
        dalcs_certificate_evaluate(p, u, y, sources_clash);
    }
    return DALCS_OK;
}

/* Is it one but for signs? */
static bool is_answer(struct dalcs_osnsp *p, const double *u, double *y, bool sources_clash) {
    const bool is_sign = p->certificate.where >= dalcs_system_n_equations(p->system);
    const double most = dalcs_beyond * p->options.certificate_tolerance;
    return !sources_clash &&
           (p->certificate.worst <= most || (is_sign && dalcs_certificate_equations_hold(p, u, y)));
}

enum dalcs_status dalcs_osnsp_answer_given(struct dalcs_osnsp *p, double sigma, const double *u,
                                           double *y) {
    bool sources_clash;
    if (p->cache.n_forms == 0 || p->cache.form[0]->sigma != sigma) {
        DALCS_TRY(dalcs_forms_get(p, sigma));
    }
    DALCS_TRY(dalcs_exact_try_mode(p, u, y, &sources_clash));
    if (!is_answer(p, u, y, sources_clash) && !p->asks.refines) {
        p->asks.refines = true; /* where a sign is wrong a map's answer is not refined by itself */
        enum dalcs_status status = dalcs_exact_try_mode(p, u, y, &sources_clash);
        p->asks.refines = false;
        DALCS_TRY(status);
    }
    if (!is_answer(p, u, y, sources_clash)) { /* nor one that its states' voltages hide */
        DALCS_TRY(dalcs_exact_keep_states(p, u, y, &sources_clash));
    }
    return is_answer(p, u, y, sources_clash) ? DALCS_OK : DALCS_NOT_CONVERGED;
}

enum dalcs_status dalcs_osnsp_answer(struct dalcs_osnsp *p, const double *u, double *y) {
    const double sigma = p->cache.form[0]->sigma;
    return p->smooth.newton == NULL
               ? dalcs_osnsp_answer_given(p, sigma, u, y)
               : dalcs_osnsp_solve_smooth(p, sigma, u, y, dalcs_osnsp_answer_given);
}

/* From p->mode by block principal pivoting over regular modes, at most `limit` changes. DALCS_SINGULAR
 * or DALCS_NOT_CONVERGED: try otherwise. */
static enum dalcs_status pivot(struct dalcs_osnsp *p, const double *u, double *y, int limit) {
    struct dalcs_pivoting pivoting = dalcs_pivoting_begin(p);
    for (int round = 0; round <= limit; round++) {
        bool sources_clash;
        DALCS_TRY(dalcs_osnsp_try_mode(p, u, y, &sources_clash));
        if (p->signs.n_violating == 0) {
            return dalcs_certificate_holds(p, sources_clash) ? DALCS_OK : DALCS_NOT_CONVERGED;
        }
        bool stalls = dalcs_pivoting_stalls(p, &pivoting);
        if (stalls && dalcs_osnsp_goes_round(p, ++pivoting.n_single)) {
            break;
        }
        dalcs_osnsp_flip_violating(p, !stalls);
    }
    return DALCS_NOT_CONVERGED;
}

/* Blocks of which each has one answer at most, if those before it are answered. Where one leaves something open the next
 * may bear another choice than the one that was made. */
static bool blocks_decide(const struct dalcs_osnsp *p) {
    return dalcs_osnsp_is_monotone(p) && !p->least_norm &&
           p->cache.form[0]->answers == DALCS_UNIQUE;
}

/* By pivoting on the whole, as most problems are solved; where that finds no answer, or one of several, block by
 * block: *is_done where that decides. The blocks begin with the sides that were there. */
static enum dalcs_status solve_in_order(struct dalcs_osnsp *p, double sigma, const double *u,
                                        double *y, bool *is_done) {
    size_t bytes = (size_t)p->n_words * sizeof(*p->mode);
    *is_done = false;
    if (p->partition.n_blocks < 2) {
        return DALCS_OK;
    }
    memcpy(p->work.tied_mode, p->mode, bytes);
    enum dalcs_status status = pivot(p, u, y, p->system->n_pairs);
    *is_done = status < DALCS_OK || (status == DALCS_OK && p->signs.n_tied == 0 && !p->least_norm);
    if (*is_done) {
        return status;
    }
    memcpy(p->work.regularised_mode, p->mode, bytes);
    memcpy(p->mode, p->work.tied_mode, bytes);
    if (p->blocks == NULL) {
        status = dalcs_in_order_build(p);
        p->partition.n_blocks = status == DALCS_NOT_CONVERGED ? 1 : p->partition.n_blocks;
    }
    if (p->partition.n_blocks > 1 && status >= DALCS_OK) {
        status = dalcs_in_order_solve(p, sigma, u, y);
    }
    *is_done = status < DALCS_OK ||
               (p->partition.n_blocks > 1 &&
                (status == DALCS_OK || (status == DALCS_INFEASIBLE && blocks_decide(p))));
    if (!*is_done) { /* pivoting goes on where it ended */
        memcpy(p->mode, p->work.regularised_mode, bytes);
    }
    return status;
}

static bool is_undecided(enum dalcs_status status) {
    return status == DALCS_NOT_CONVERGED || status == DALCS_SINGULAR;
}

/* From p->mode; where that leads nowhere once more without maps, and from there on: a sign may be wrong by their rounding
 * alone. */
static enum dalcs_status pivot_twice(struct dalcs_osnsp *p, const double *u, double *y, int limit) {
    const size_t bytes = (size_t)p->n_words * sizeof(*p->mode);
    memcpy(p->work.tied_mode, p->mode, bytes);
    enum dalcs_status status = pivot(p, u, y, limit);
    if (is_undecided(status) && !p->asks.refines) {
        memcpy(p->mode, p->work.tied_mode, bytes);
        p->asks.refines = true;
        status = pivot(p, u, y, limit);
    }
    return status;
}

static enum dalcs_status solve_somehow(struct dalcs_osnsp *p, const double *u, double *y) {
    int limit = p->options.max_pivots + 2 * p->system->n_pairs;
    enum dalcs_status status = pivot_twice(p, u, y, limit);
    if (status == DALCS_OK && p->signs.n_tied > 0 && dalcs_osnsp_is_monotone(p) && !p->least_norm) {
        return dalcs_ties_settle(p, u, y);
    }
    if (status > DALCS_OK && status != DALCS_INFEASIBLE) {
        status = dalcs_proximal_solve(p, u, y);
    }
    return status;
}

/* Where the circuit is not passive a ray proves nothing, and iterates that have far to go look like one. */
static enum dalcs_status prove(struct dalcs_osnsp *p, double sigma, const double *u,
                               bool *is_proof) {
    *is_proof = false;
    return p->system->monotone ? dalcs_refute_at_once(p, sigma, u, is_proof) : DALCS_OK;
}

/* Where solving block by block has not decided. is_open: blocks have chosen before one had no answer. */
static enum dalcs_status solve_whole(struct dalcs_osnsp *p, double sigma, const double *u,
                                     double *y, bool is_open) {
    enum dalcs_status status = solve_somehow(p, u, y);
    bool is_proof = false;
    if (status == DALCS_INFEASIBLE) {
        DALCS_TRY(prove(p, sigma, u, &is_proof));
    }
    if (is_undecided(status) || (status == DALCS_INFEASIBLE && !is_proof)) {
        enum dalcs_status otherwise = dalcs_scattering_solve(p, u, y);
        status = otherwise <= DALCS_OK ? otherwise : status;
    }
    if (is_undecided(status) && dalcs_osnsp_is_monotone(p)) { /* a mode may only seem singular */
        p->asks.insists = true;
        enum dalcs_status insisted = pivot(p, u, y, p->options.max_pivots + 2 * p->system->n_pairs);
        p->asks.insists = false;
        status = insisted <= DALCS_OK ? insisted : status;
    }
    if (is_undecided(status)) {
        DALCS_TRY(prove(p, sigma, u, &is_proof));
        status = is_proof ? DALCS_INFEASIBLE : status;
    }
    if (status > DALCS_OK && (is_open || !dalcs_osnsp_is_monotone(p))) {
        status = dalcs_enumerate(p, u, y);
        if (status == DALCS_INFEASIBLE) {
            dalcs_witness_from_modes(p);
        }
    }
    return status;
}

enum dalcs_status dalcs_osnsp_solve_given(struct dalcs_osnsp *p, double sigma, const double *u,
                                          double *y) {
    if (dalcs_osnsp_is_cancelled(p)) {
        return DALCS_E_CANCELLED;
    }
    p->counters.solved++;
    if (p->cache.n_forms == 0 || p->cache.form[0]->sigma != sigma) {
        DALCS_TRY(dalcs_forms_get(p, sigma));
    }
    bool is_done;
    enum dalcs_status status = solve_in_order(p, sigma, u, y, &is_done);
    if (is_done) {
        return status;
    }
    const bool refines = p->asks.refines;
    status = solve_whole(p, sigma, u, y, status == DALCS_INFEASIBLE);
    p->asks.refines = refines;
    if (status == DALCS_INFEASIBLE) {
        dalcs_witness_complete(p);
    }
    if (status == DALCS_OK && p->least_norm && p->signs.n_tied > 0) {
        status = dalcs_basis_prefer(p, u, y);
    }
    p->counters.singular += status == DALCS_OK && p->least_norm ? 1 : 0;
    return status;
}

enum dalcs_status dalcs_osnsp_solve(struct dalcs_osnsp *p, double sigma, const double *u,
                                    double *y) {
    return p->smooth.newton == NULL ? dalcs_latches_solve(p, sigma, u, y)
                                    : dalcs_osnsp_solve_smooth(p, sigma, u, y, dalcs_latches_solve);
}
