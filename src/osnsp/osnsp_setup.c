/* osnsp_setup.c - what is listed of a system once, and room for its problems. */
#include "in_order.h"

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

/* Vectors of one size during the run. */
static enum dalcs_status make_room(struct dalcs_osnsp *p) {
    const struct dalcs_system *system = p->system;
    size_t n_pairs = (size_t)system->n_pairs;
    size_t n_columns = (size_t)dalcs_system_n_columns(system);
    size_t words = (size_t)p->n_words;
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
    const bool complete =
        p->witness.ray != NULL && p->mode != NULL && p->key != NULL &&
        p->regularised_mode != NULL && p->met_mode != NULL && p->w != NULL && p->form != NULL &&
        p->form_id != NULL && p->difference != NULL && p->run != NULL && p->w_ends != NULL &&
        p->is_diode != NULL && p->violating != NULL && p->tied != NULL && p->tied_mode != NULL &&
        p->tied_answer != NULL && p->mapped != NULL && p->right != NULL && p->scaled != NULL &&
        p->rhs != NULL && p->residual != NULL && p->centre != NULL && p->centre_w != NULL &&
        p->step_before != NULL && p->step_now != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

static enum dalcs_status build(struct dalcs_osnsp *p) {
    DALCS_TRY(dalcs_partition_find(&p->partition, p->system));
    DALCS_TRY(make_room(p));
    list_runs(p);
    list_w_ends(p);
    DALCS_TRY(list_pair_rows(p));
    DALCS_TRY(list_references(p));
    DALCS_TRY(list_drives(p));
    return dalcs_osnsp_smooth_setup(p);
}

enum dalcs_status dalcs_osnsp_setup(struct dalcs_osnsp *p, const struct dalcs_system *system,
                                    const struct dalcs_osnsp_options *options) {
    *p = (struct dalcs_osnsp){
        .system = system, .options = *options, .n_words = (system->n_pairs + 63) / 64};
    dalcs_lu_common_init(&p->klu);
    enum dalcs_status status = build(p);
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
