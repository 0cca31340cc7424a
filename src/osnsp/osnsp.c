/* osnsp.c - finding the mode: the last one first, then block principal pivoting, then that of a problem with small
 * weights, by Lemke's method where pivots get nowhere; and for small systems that are not passive every mode. */
#include "in_order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Iterative refinements of an answer whose residual is too large. */
enum { MAX_REFINEMENTS = 3 };

struct dalcs_osnsp_options dalcs_osnsp_options_of(const struct dalcs_run_options *run) {
    return (struct dalcs_osnsp_options){.certificate_tolerance = run->certificate_tolerance,
                                        .proximal_weight = run->proximal_weight,
                                        .rcond_min = run->rcond_min,
                                        .max_outer = run->max_outer,
                                        .max_pivots = run->max_pivots,
                                        .cache_bytes = run->cache_bytes,
                                        .dense_limit = run->dense_limit};
}

static enum dalcs_status list_pair_rows(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    int n_equations = dalcs_system_n_equations(s);
    p->pair_rows_p = dalcs_arena_alloc(&p->arena, (size_t)s->n_pairs + 2, sizeof(int));
    p->pair_rows = dalcs_arena_alloc(&p->arena, (size_t)s->A.p[n_equations], sizeof(int));
    if (p->pair_rows_p == NULL || p->pair_rows == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < s->A.p[n_equations]; k++) {
        if (s->A.j[k] >= n_equations) {
            p->pair_rows_p[s->A.j[k] - n_equations + 2]++;
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        p->pair_rows_p[d + 2] += p->pair_rows_p[d + 1];
    }
    for (int r = 0; r < n_equations; r++) {
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            if (s->A.j[k] >= n_equations) {
                p->pair_rows[p->pair_rows_p[s->A.j[k] - n_equations + 1]++] = r;
            }
        }
    }
    return DALCS_OK;
}

static void list_runs(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    int n_columns = dalcs_system_n_columns(s);
    for (int c = 0; c < n_columns; c++) {
        bool is_current = s->column_is_current[c];
        if (s->is_part != NULL && s->is_part[c]) {
            continue;
        }
        bool goes_on = p->n_runs > 0 && p->run[p->n_runs - 1].end == c &&
                       p->run[p->n_runs - 1].is_current == is_current;
        if (!goes_on) {
            p->run[p->n_runs++] = (struct dalcs_unit_run){c, c, is_current};
        }
        p->run[p->n_runs - 1].end = c + 1;
    }
}

/* V: thresholds say little about the voltages of a circuit (Vrev = 1 MV: never), but where all else is
 * 0 the least of them, up to this, tells rounding from an answer. */
static const double largest_threshold = 1.0;

/* What sources and thresholds ask for counts as a current or voltage even where the answer is 0. */
static enum dalcs_status list_drives(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    int n_equations = dalcs_system_n_equations(s);
    p->drive = dalcs_arena_alloc(&p->arena, (size_t)(s->E.p[n_equations] + s->F.p[s->n_pairs]),
                                 sizeof(*p->drive));
    if (p->drive == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int r = 0; r < n_equations; r++) {
        for (int k = s->E.p[r]; k < s->E.p[r + 1]; k++) {
            p->drive[p->n_drives++] =
                (struct dalcs_drive){s->n_x + s->E.j[k], s->row_is_current[r], fabs(s->E.x[k])};
        }
    }
    struct dalcs_drive least = {.coefficient = INFINITY};
    for (int k = 0; k < s->F.p[s->n_pairs]; k++) {
        double size = fmin(fabs(s->F.x[k]), largest_threshold);
        if (size > 0.0 && size < least.coefficient) {
            least = (struct dalcs_drive){s->n_x + s->F.j[k], false, size};
        }
    }
    if (isfinite(least.coefficient)) {
        p->drive[p->n_drives++] = least;
    }
    return DALCS_OK;
}

static void list_w_ends(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    for (int d = 0; d < s->n_pairs; d++) {
        p->is_diode[d] = s->pair[d].kind == DALCS_PAIR_DIODE;
        dalcs_csr_row_difference(&s->C, d, &p->w_ends[2 * d]);
        if (s->F.p[d] != s->F.p[d + 1]) {
            p->w_ends[2 * d] = -1;
        }
    }
}

static enum dalcs_status list_references(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    int n_equations = dalcs_system_n_equations(s);
    for (int c = 0; c < n_equations; c++) {
        p->n_references += s->column[c].kind == DALCS_LABEL_REFERENCE ? 1 : 0;
    }
    p->reference = dalcs_arena_alloc(&p->arena, (size_t)p->n_references, sizeof(int));
    p->reference_row = dalcs_arena_alloc(&p->arena, (size_t)p->n_references, sizeof(int));
    if (p->reference == NULL || p->reference_row == NULL) {
        return DALCS_E_NOMEM;
    }
    int n = 0;
    for (int r = 0; r < n_equations; r++) {
        if (s->row[r].kind == DALCS_LABEL_REFERENCE) {
            p->reference[n] = s->dual[r];
            p->reference_row[n++] = r;
        }
    }
    return DALCS_OK;
}

/* Bytes that are kept for the run, with something to spare. */
static size_t room(const struct dalcs_system *system) {
    enum { FOR_ALL = 2048, FOR_A_COLUMN = 256 };

    return FOR_ALL + FOR_A_COLUMN * (size_t)dalcs_system_n_columns(system);
}

enum dalcs_status dalcs_osnsp_setup(struct dalcs_osnsp *p, const struct dalcs_system *system,
                                    const struct dalcs_osnsp_options *options) {
    *p = (struct dalcs_osnsp){.system = system, .options = *options};
    dalcs_lu_common_init(&p->klu);
    size_t n_pairs = (size_t)system->n_pairs;
    size_t n_columns = (size_t)dalcs_system_n_columns(system);
    p->n_words = (system->n_pairs + 63) / 64;
    size_t words = (size_t)p->n_words;
    DALCS_TRY(dalcs_partition_find(&p->partition, system));
    DALCS_TRY(dalcs_arena_reserve(&p->arena, room(system)));
    p->mode = dalcs_arena_alloc(&p->arena, words, sizeof(*p->mode));
    p->key = dalcs_arena_alloc(&p->arena, words + 1, sizeof(*p->key));
    p->regularised_mode = dalcs_arena_alloc(&p->arena, words, sizeof(*p->regularised_mode));
    p->met_mode = dalcs_arena_alloc(&p->arena, words, sizeof(*p->met_mode));
    p->w = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(double));
    p->form = dalcs_arena_alloc(&p->arena, 33, sizeof(*p->form));
    p->form_id = dalcs_arena_alloc(&p->arena, 33, sizeof(*p->form_id));
    p->difference = dalcs_arena_alloc(
        &p->arena, (size_t)(system->n_x + system->n_inputs) + n_columns, sizeof(double));
    p->run = dalcs_arena_alloc(&p->arena, n_columns, sizeof(*p->run));
    p->is_diode = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(bool));
    p->w_ends = dalcs_arena_alloc(&p->arena, 2 * n_pairs, sizeof(int));
    p->violating = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(int));
    p->tied = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(bool));
    p->tied_mode = dalcs_arena_alloc(&p->arena, words, sizeof(*p->tied_mode));
    p->tied_answer = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->mapped = dalcs_arena_alloc(&p->arena, n_columns + 8, sizeof(double));
    p->right = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->scaled = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->rhs = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->residual = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->centre = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->centre_w = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(double));
    p->step_before = dalcs_arena_alloc(&p->arena, n_columns + n_pairs, sizeof(double));
    p->step_now = dalcs_arena_alloc(&p->arena, n_columns + n_pairs, sizeof(double));
    p->witness.ray = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    enum dalcs_status status = DALCS_E_NOMEM;
    if (p->witness.ray != NULL && p->mode != NULL && p->key != NULL &&
        p->regularised_mode != NULL && p->met_mode != NULL && p->w != NULL && p->form != NULL &&
        p->form_id != NULL && p->difference != NULL && p->run != NULL && p->w_ends != NULL &&
        p->is_diode != NULL && p->violating != NULL && p->tied != NULL && p->tied_mode != NULL &&
        p->tied_answer != NULL && p->mapped != NULL && p->right != NULL && p->scaled != NULL &&
        p->rhs != NULL && p->residual != NULL && p->centre != NULL && p->centre_w != NULL &&
        p->step_before != NULL && p->step_now != NULL) {
        list_runs(p);
        list_w_ends(p);
        status = list_pair_rows(p);
        if (status == DALCS_OK) {
            status = list_references(p);
        }
        if (status == DALCS_OK) {
            status = list_drives(p);
        }
        if (status == DALCS_OK) {
            status = dalcs_osnsp_smooth_setup(p);
        }
    }
    if (status != DALCS_OK) {
        dalcs_osnsp_finish(p);
    }
    return status;
}

void dalcs_osnsp_finish(struct dalcs_osnsp *p) {
    if (p->form != NULL) {
        dalcs_modes_finish(p);
    }
    dalcs_in_order_finish(p);
    if (p->newton != NULL) {
        dalcs_osnsp_smooth_finish(p);
    }
    dalcs_partition_finish(&p->partition);
    dalcs_arena_finish(&p->arena);
    free(p->witness.element);
    free(p->weighed.element);
    *p = (struct dalcs_osnsp){0};
}

void dalcs_osnsp_unscale(const struct dalcs_osnsp *p, double *y) {
    const struct dalcs_step_form *f = p->form[0];
    int n_equations = dalcs_system_n_equations(p->system);
    for (int i = 0; i < f->n; i++) {
        y[f->column_of[i]] = f->scale[i] * p->scaled[i];
    }
    for (int d = 0; d < f->n_pairs; d++) {
        y[n_equations + d] = f->scale[f->n + d] * p->scaled[f->n + d];
    }
}

/* R u solved straight into y's z and lambda: the way of every ordinary step. */
static void solve_to_answer(const struct dalcs_osnsp *p, const struct dalcs_mode_entry *e,
                            const double *u, double *y) {
    const struct dalcs_csr R = p->form[0]->R;
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
    const struct dalcs_step_form *f = p->form[0];
    int n_equations = dalcs_system_n_equations(p->system);
    for (int i = 0; i < f->n; i++) {
        p->scaled[i] = y[f->column_of[i]] / f->scale[i];
    }
    for (int d = 0; d < f->n_pairs; d++) {
        p->scaled[f->n + d] = y[n_equations + d] / f->scale[f->n + d];
    }
}

/* One step of iterative refinement: solve for the residual of the condensed rows. */
static void refine(struct dalcs_osnsp *p, const struct dalcs_mode_entry *e) {
    const struct dalcs_step_form *f = p->form[0];
    int n = f->n + f->n_pairs;
    double *residual = p->residual;
    memcpy(residual, p->right, (size_t)n * sizeof(double));
    for (int c = 0; c < n; c++) {
        for (int k = f->K.p[c]; k < f->K.p[c + 1]; k++) {
            residual[f->K.j[k]] -= f->K.x[k] * p->scaled[c];
        }
    }
    memcpy(p->rhs, residual, (size_t)f->n * sizeof(double));
    for (int k = 0; k < e->n_on; k++) {
        p->rhs[f->n + k] = residual[f->n + e->on[k]];
    }
    dalcs_lu_solve(&e->lu, p->rhs);
    for (int i = 0; i < f->n; i++) {
        p->scaled[i] += p->rhs[i];
    }
    for (int k = 0; k < e->n_on; k++) {
        p->scaled[f->n + e->on[k]] += p->rhs[f->n + k];
    }
}

enum dalcs_status dalcs_osnsp_try_mode(struct dalcs_osnsp *p, const double *u, double *y,
                                       bool *sources_clash) {
    struct dalcs_mode_entry *e;
    DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &e));
    double tolerance = p->options.certificate_tolerance;
    p->least_norm = e->singular && (!e->answers || e->whole->n_choices > 0);
    bool by_factors = p->refines && !e->singular;
    bool may_recur = e->singular ? e->answers : !by_factors;
    if (e->map == NULL && may_recur && e->n_uses++ > 2 && dalcs_step_map_pays(p)) {
        DALCS_TRY(dalcs_step_map_build(p, e));
    }
    if (e->map != NULL && !by_factors) {
        dalcs_step_map_apply(p, e, u, y);
        dalcs_certificate_evaluate(p, u, y, sources_clash);
        if (p->n_violating > 0 || (p->certificate.worst <= tolerance && !*sources_clash)) {
            return DALCS_OK;
        }
    }
    if (e->singular) {
        if (!e->answers) {
            return DALCS_SINGULAR;
        }
        dalcs_exact_evaluate(p, e->whole, u, y, sources_clash);
        return DALCS_OK;
    }
    solve_to_answer(p, e, u, y);
    dalcs_certificate_evaluate(p, u, y, sources_clash);
    int wanted = p->refines && p->n_violating == 0 ? 1 : 0;
    if (p->certificate.worst > tolerance || *sources_clash || wanted > 0) {
        dalcs_osnsp_scale(p, y);
        dalcs_csr_multiply(&p->form[0]->R, u, p->right);
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

/* From p->mode by block principal pivoting over regular modes, at most `limit` changes. DALCS_SINGULAR
 * or DALCS_NOT_CONVERGED: try otherwise. */
static enum dalcs_status pivot(struct dalcs_osnsp *p, const double *u, double *y, int limit) {
    struct dalcs_pivoting pivoting = dalcs_pivoting_begin(p);
    for (int round = 0; round <= limit; round++) {
        bool sources_clash;
        DALCS_TRY(dalcs_osnsp_try_mode(p, u, y, &sources_clash));
        if (p->n_violating == 0) {
            if (sources_clash) {
                dalcs_witness_from_clash(p);
                return DALCS_INFEASIBLE;
            }
            return p->certificate.worst <= p->options.certificate_tolerance ? DALCS_OK
                                                                            : DALCS_NOT_CONVERGED;
        }
        bool stalls = dalcs_pivoting_stalls(p, &pivoting);
        if (stalls && dalcs_osnsp_goes_round(p, ++pivoting.n_single)) {
            break;
        }
        dalcs_osnsp_flip_violating(p, !stalls);
    }
    return DALCS_NOT_CONVERGED;
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
    memcpy(p->tied_mode, p->mode, bytes);
    enum dalcs_status status = pivot(p, u, y, p->system->n_pairs);
    *is_done = status < DALCS_OK || (status == DALCS_OK && p->n_tied == 0 && !p->least_norm);
    if (*is_done) {
        return status;
    }
    memcpy(p->regularised_mode, p->mode, bytes);
    memcpy(p->mode, p->tied_mode, bytes);
    if (p->blocks == NULL) {
        status = dalcs_in_order_build(p);
        p->partition.n_blocks = status == DALCS_NOT_CONVERGED ? 1 : p->partition.n_blocks;
    }
    if (p->partition.n_blocks > 1 && status >= DALCS_OK) {
        status = dalcs_in_order_solve(p, sigma, u, y);
    }
    *is_done = status < DALCS_OK ||
               (p->partition.n_blocks > 1 &&
                (status == DALCS_OK || (status == DALCS_INFEASIBLE && dalcs_osnsp_is_monotone(p))));
    if (!*is_done) { /* pivoting goes on where it ended */
        memcpy(p->mode, p->regularised_mode, bytes);
    }
    return status;
}

static enum dalcs_status solve_somehow(struct dalcs_osnsp *p, const double *u, double *y) {
    int limit = p->options.max_pivots + 2 * p->system->n_pairs;
    enum dalcs_status status = pivot(p, u, y, limit);
    if (status == DALCS_OK && p->n_tied > 0 && dalcs_osnsp_is_monotone(p) && !p->least_norm) {
        return dalcs_ties_settle(p, u, y);
    }
    if (status > DALCS_OK && status != DALCS_INFEASIBLE) {
        status = dalcs_proximal_solve(p, u, y);
    }
    return status;
}

static bool is_undecided(enum dalcs_status status) {
    return status == DALCS_NOT_CONVERGED || status == DALCS_SINGULAR;
}

/* A ray may be no more than C/h beside a stray, and proves nothing where the circuit is not passive. */
static bool is_proof(const struct dalcs_osnsp *p) {
    return p->system->monotone && p->form[0]->sigma == 0.0;
}

/* With given sources. */
static enum dalcs_status solve(struct dalcs_osnsp *p, double sigma, const double *u, double *y) {
    p->counters.solved++;
    if (p->n_forms == 0 || p->form[0]->sigma != sigma) {
        DALCS_TRY(dalcs_forms_get(p, sigma));
    }
    bool is_done;
    enum dalcs_status status = solve_in_order(p, sigma, u, y, &is_done);
    if (is_done) {
        return status;
    }
    status = solve_somehow(p, u, y);
    if (is_undecided(status) || (status == DALCS_INFEASIBLE && !is_proof(p))) {
        enum dalcs_status otherwise = dalcs_scattering_solve(p, u, y);
        status = otherwise <= DALCS_OK ? otherwise : status;
    }
    if (is_undecided(status) && dalcs_osnsp_is_monotone(p)) { /* a mode may only seem singular */
        p->insists = true;
        enum dalcs_status insisted = pivot(p, u, y, p->options.max_pivots + 2 * p->system->n_pairs);
        p->insists = false;
        status = insisted <= DALCS_OK ? insisted : status;
    }
    if (status > DALCS_OK && !dalcs_osnsp_is_monotone(p)) {
        status = dalcs_enumerate(p, u, y);
        if (status == DALCS_INFEASIBLE) {
            dalcs_witness_from_modes(p);
        }
    }
    if (status == DALCS_INFEASIBLE) {
        dalcs_witness_complete(p);
    }
    if (status == DALCS_OK && p->least_norm && p->n_tied > 0) {
        status = dalcs_basis_prefer(p, u, y);
    }
    p->counters.singular += status == DALCS_OK && p->least_norm ? 1 : 0;
    return status;
}

enum dalcs_status dalcs_osnsp_solve(struct dalcs_osnsp *p, double sigma, const double *u,
                                    double *y) {
    return p->newton == NULL ? solve(p, sigma, u, y)
                             : dalcs_osnsp_solve_smooth(p, sigma, u, y, solve);
}
