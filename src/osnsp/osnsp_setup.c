/* osnsp_setup.c - what is listed of a system once, and room for its problems. */
#include "in_order.h"
#include "latches.h"

#include <math.h>
#include <stdlib.h>

struct dalcs_osnsp_options dalcs_osnsp_options_of(const struct dalcs_run_options *run) {
    return (struct dalcs_osnsp_options){.certificate_tolerance = run->certificate_tolerance,
                                        .proximal_weight = run->proximal_weight,
                                        .rcond_min = run->rcond_min,
                                        .max_outer = run->max_outer,
                                        .max_pivots = run->max_pivots,
                                        .cache_bytes = run->cache_bytes,
                                        .dense_limit = run->dense_limit};
}

/* Is it the current of a branch that is no state, or of a pair? */
static bool is_carried(const struct dalcs_system *s, int column) {
    return column >= dalcs_system_n_equations(s) ||
           (column >= s->n_x && s->column_is_current[column]);
}

static enum dalcs_status list_column_rows(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    const int n_equations = dalcs_system_n_equations(s);
    const int n_columns = dalcs_system_n_columns(s);
    int *first = p->lists.column_rows_p =
        dalcs_arena_alloc(&p->arena, (size_t)n_columns + 2, sizeof(int));
    p->lists.column_rows = dalcs_arena_alloc(&p->arena, (size_t)s->A.p[n_equations], sizeof(int));
    if (first == NULL || p->lists.column_rows == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < s->A.p[n_equations]; k++) {
        first[s->A.j[k] + 2] += is_carried(s, s->A.j[k]) ? 1 : 0;
    }
    for (int c = 0; c < n_columns; c++) {
        first[c + 2] += first[c + 1];
    }
    for (int r = 0; r < n_equations; r++) {
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            if (is_carried(s, s->A.j[k])) {
                p->lists.column_rows[first[s->A.j[k] + 1]++] = r;
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
        bool goes_on = p->lists.n_runs > 0 && p->lists.run[p->lists.n_runs - 1].end == c &&
                       p->lists.run[p->lists.n_runs - 1].is_current == is_current;
        if (!goes_on) {
            p->lists.run[p->lists.n_runs++] = (struct dalcs_unit_run){c, c, is_current};
        }
        p->lists.run[p->lists.n_runs - 1].end = c + 1;
    }
}

/* V: thresholds say little about the voltages of a circuit (Vrev = 1 MV: never), but where all else is
 * 0 the least of them, up to this, tells rounding from an answer. Any value from 1e-3 to 1e3 is right: 2e-13 of it is
 * rounding, which is less than a nanovolt. */
static const double largest_threshold = 1.0;

/* What sources and thresholds ask for counts as a current or voltage even where the answer is 0. */
static enum dalcs_status list_drives(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    int n_equations = dalcs_system_n_equations(s);
    p->lists.drive = dalcs_arena_alloc(
        &p->arena, (size_t)(s->E.p[n_equations] + s->F.p[s->n_pairs]), sizeof(*p->lists.drive));
    if (p->lists.drive == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int r = 0; r < n_equations; r++) {
        for (int k = s->E.p[r]; k < s->E.p[r + 1]; k++) {
            p->lists.drive[p->lists.n_drives++] =
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
        p->lists.drive[p->lists.n_drives++] = least;
    }
    return DALCS_OK;
}

static void list_w_ends(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    for (int d = 0; d < s->n_pairs; d++) {
        p->lists.is_diode[d] = s->pair[d].kind == DALCS_PAIR_DIODE;
        dalcs_csr_row_difference(&s->C, d, &p->lists.w_ends[2 * d]);
        if (s->F.p[d] != s->F.p[d + 1]) {
            p->lists.w_ends[2 * d] = -1;
        }
    }
}

static enum dalcs_status list_references(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    int n_equations = dalcs_system_n_equations(s);
    for (int c = 0; c < n_equations; c++) {
        p->lists.n_references += s->column[c].kind == DALCS_LABEL_REFERENCE ? 1 : 0;
    }
    p->lists.reference = dalcs_arena_alloc(&p->arena, (size_t)p->lists.n_references, sizeof(int));
    p->lists.reference_row =
        dalcs_arena_alloc(&p->arena, (size_t)p->lists.n_references, sizeof(int));
    if (p->lists.reference == NULL || p->lists.reference_row == NULL) {
        return DALCS_E_NOMEM;
    }
    int n = 0;
    for (int r = 0; r < n_equations; r++) {
        if (s->row[r].kind == DALCS_LABEL_REFERENCE) {
            p->lists.reference[n] = s->dual[r];
            p->lists.reference_row[n++] = r;
        }
    }
    return DALCS_OK;
}

/* Bytes that are kept for the run, with something to spare. */
static size_t room(const struct dalcs_system *system) {
    enum { FOR_ALL = 3584, FOR_A_COLUMN = 256 };

    return FOR_ALL + FOR_A_COLUMN * (size_t)dalcs_system_n_columns(system);
}

/* Vectors of one size during the run. */
static enum dalcs_status make_room(struct dalcs_osnsp *p) {
    const struct dalcs_system *system = p->system;
    size_t n_pairs = (size_t)system->n_pairs;
    size_t n_columns = (size_t)dalcs_system_n_columns(system);
    size_t words = (size_t)p->n_words;
    DALCS_TRY(dalcs_arena_reserve(&p->arena, room(system)));
    p->mode = dalcs_arena_alloc(&p->arena, words, sizeof(*p->mode));
    p->work.key = dalcs_arena_alloc(&p->arena, words + 1, sizeof(*p->work.key));
    p->work.regularised_mode =
        dalcs_arena_alloc(&p->arena, words, sizeof(*p->work.regularised_mode));
    p->work.met_mode = dalcs_arena_alloc(&p->arena, words, sizeof(*p->work.met_mode));
    p->work.row = dalcs_arena_alloc(&p->arena, n_columns, sizeof(int));
    p->work.row_seen = dalcs_arena_alloc(&p->arena, n_columns, sizeof(int));
    p->w = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(double));
    p->cache.form = dalcs_arena_alloc(&p->arena, DALCS_MOST_FORMS, sizeof(*p->cache.form));
    p->cache.form_id = dalcs_arena_alloc(&p->arena, DALCS_MOST_FORMS, sizeof(*p->cache.form_id));
    p->work.difference = dalcs_arena_alloc(
        &p->arena, (size_t)(system->n_x + system->n_inputs) + n_columns, sizeof(double));
    p->lists.run = dalcs_arena_alloc(&p->arena, n_columns, sizeof(*p->lists.run));
    p->lists.is_diode = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(bool));
    p->lists.w_ends = dalcs_arena_alloc(&p->arena, 2 * n_pairs, sizeof(int));
    p->signs.violating = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(int));
    p->signs.tied = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(bool));
    p->work.tied_mode = dalcs_arena_alloc(&p->arena, words, sizeof(*p->work.tied_mode));
    p->work.tied_answer = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->work.mapped = dalcs_arena_alloc(&p->arena, n_columns + 8, sizeof(double));
    p->work.right = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->work.scaled = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->work.rhs = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->work.residual = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->work.centre = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    p->work.centre_w = dalcs_arena_alloc(&p->arena, n_pairs, sizeof(double));
    p->work.step_before = dalcs_arena_alloc(&p->arena, n_columns + n_pairs, sizeof(double));
    p->work.step_now = dalcs_arena_alloc(&p->arena, n_columns + n_pairs, sizeof(double));
    p->witness.ray = dalcs_arena_alloc(&p->arena, n_columns, sizeof(double));
    const bool complete =
        p->witness.ray != NULL && p->mode != NULL && p->work.key != NULL &&
        p->work.regularised_mode != NULL && p->work.met_mode != NULL && p->w != NULL &&
        p->work.row != NULL && p->work.row_seen != NULL && p->cache.form != NULL &&
        p->cache.form_id != NULL && p->work.difference != NULL && p->lists.run != NULL &&
        p->lists.w_ends != NULL && p->lists.is_diode != NULL && p->signs.violating != NULL &&
        p->signs.tied != NULL && p->work.tied_mode != NULL && p->work.tied_answer != NULL &&
        p->work.mapped != NULL && p->work.right != NULL && p->work.scaled != NULL &&
        p->work.rhs != NULL && p->work.residual != NULL && p->work.centre != NULL &&
        p->work.centre_w != NULL && p->work.step_before != NULL && p->work.step_now != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

static enum dalcs_status build(struct dalcs_osnsp *p) {
    DALCS_TRY(dalcs_partition_find(&p->partition, p->system));
    DALCS_TRY(make_room(p));
    list_runs(p);
    list_w_ends(p);
    DALCS_TRY(list_column_rows(p));
    DALCS_TRY(list_references(p));
    DALCS_TRY(list_drives(p));
    DALCS_TRY(dalcs_latches_setup(p));
    return dalcs_osnsp_smooth_setup(p);
}

enum dalcs_status dalcs_osnsp_setup(struct dalcs_osnsp *p, const struct dalcs_system *system,
                                    const struct dalcs_osnsp_options *options) {
    *p = (struct dalcs_osnsp){
        .system = system, .options = *options, .n_words = (system->n_pairs + 63) / 64};
    dalcs_lu_common_init(&p->cache.klu);
    enum dalcs_status status = build(p);
    if (status != DALCS_OK) {
        dalcs_osnsp_finish(p);
    }
    return status;
}

void dalcs_osnsp_finish(struct dalcs_osnsp *p) {
    if (p->cache.form != NULL) {
        dalcs_modes_finish(p);
    }
    dalcs_in_order_finish(p);
    if (p->smooth.newton != NULL) {
        dalcs_osnsp_smooth_finish(p);
    }
    dalcs_partition_finish(&p->partition);
    dalcs_arena_finish(&p->arena);
    free(p->witness.element);
    free(p->weighed.element);
    *p = (struct dalcs_osnsp){0};
}
