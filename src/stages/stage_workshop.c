/* stage_workshop.c - the equations of the stages for every eigenvalue, balanced and solved. */
#include "stage_workshop.h"

#include "extended.h"
#include "magnitudes.h"
#include "rounding.h"
#include "stage_choice.h"
#include "stage_shift.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* For as many unknowns as a map may have. Returns the bytes of it all. */
static size_t lay_out(struct dalcs_stage_workshop *b, void *storage) {
    const struct dalcs_system *s = b->system;
    size_t n_x = (size_t)b->n_x;
    size_t n_rhs = (size_t)b->n_rhs;
    size_t all = (size_t)dalcs_system_n_columns(s);
    size_t n = all < (size_t)b->stages->dense_limit ? all : (size_t)b->stages->dense_limit;
    size_t used = 0;
    b->solved.room = (size_t)dalcs_quads_of((int)n);
    b->wave_column = dalcs_carve(storage, &used, (size_t)s->n_inputs, sizeof(int));
    b->place = dalcs_carve(storage, &used, all, sizeof(int));
    b->eq.row_scale = dalcs_carve(storage, &used, n, sizeof(double));
    b->eq.column_scale = dalcs_carve(storage, &used, n, sizeof(double));
    b->mode = dalcs_carve(storage, &used, (size_t)b->stages->n_words, sizeof(*b->mode));
    b->eq.plain_base = dalcs_carve(storage, &used, n * n, sizeof(double));
    b->eq.plain_P = dalcs_carve(storage, &used, n_x * n_x, sizeof(double));
    b->eq.plain_rhs = dalcs_carve(storage, &used, n * n_rhs, sizeof(double));
    b->eq.nonzero_p = dalcs_carve(storage, &used, n + 1, sizeof(int));
    b->eq.nonzero_i = dalcs_carve(storage, &used, n * n, sizeof(int));
    b->reach.is_reached = dalcs_carve(storage, &used, n * n_rhs, sizeof(bool));
    b->reach.column_of = dalcs_carve(storage, &used, n, sizeof(int));
    b->reach.seen = dalcs_carve(storage, &used, n, sizeof(bool));
    b->reach.queue = dalcs_carve(storage, &used, n, sizeof(int));
    b->eq.base = dalcs_carve(storage, &used, n * n, sizeof(double));
    b->eq.P = dalcs_carve(storage, &used, n_x * n_x, sizeof(double));
    b->eq.rhs = dalcs_carve(storage, &used, n * n_rhs, sizeof(double));
    b->kept.whole_row_scale = dalcs_carve(storage, &used, n, sizeof(double));
    b->kept.whole_column_scale = dalcs_carve(storage, &used, n, sizeof(double));
    b->eq.size = dalcs_carve(storage, &used, n * n, sizeof(double));
    b->solved.of_real = dalcs_carve(storage, &used, n * (n + n_rhs), sizeof(long double));
    b->solved.of_pairs = dalcs_carve(storage, &used, n * (n + n_rhs), sizeof(*b->solved.of_pairs));
    b->solved.filled = dalcs_carve(storage, &used, n * (n + n_rhs), sizeof(bool));
    b->kept.whole = dalcs_carve(storage, &used, n * (n + n_rhs), sizeof(long double));
    b->solved.part =
        dalcs_carve(storage, &used, n * n_rhs * DALCS_SOLUTION_PARTS, sizeof(*b->solved.part));
    b->solved.real = dalcs_carve(storage, &used, n_rhs * 2 * b->solved.room, sizeof(double));
    b->column.stage = dalcs_carve(storage, &used, n + 1, sizeof(*b->column.stage));
    b->kept.follows_x = dalcs_carve(storage, &used, n * n, sizeof(*b->kept.follows_x));
    b->kept.follows_j = dalcs_carve(storage, &used, n * n, sizeof(int));
    b->kept.follows_p = dalcs_carve(storage, &used, n + 1, sizeof(int));
    b->kept.follower = dalcs_carve(storage, &used, n, sizeof(int));
    b->kept.kept = dalcs_carve(storage, &used, n, sizeof(int));
    b->kept.kept_row = dalcs_carve(storage, &used, n, sizeof(int));
    b->kept.row_of = dalcs_carve(storage, &used, n, sizeof(int));
    b->kept.owner = dalcs_carve(storage, &used, n, sizeof(int));
    b->column.lanes = dalcs_carve(storage, &used, n * DALCS_LANES, sizeof(double));
    b->column.start = dalcs_carve(storage, &used, n, sizeof(*b->column.start));
    b->column.missed = dalcs_carve(storage, &used, n_x + 1, sizeof(*b->column.missed));
    b->column.of_missed = dalcs_carve(storage, &used, n_x + 1, sizeof(int));
    b->column.filtered = dalcs_carve(storage, &used, 2 * b->solved.room, sizeof(double));
    b->column.defect = dalcs_carve(storage, &used, n_x, sizeof(*b->column.defect));
    b->column.lasting = dalcs_carve(storage, &used, n_x, sizeof(*b->column.lasting));
    b->solved.moment =
        dalcs_carve(storage, &used, dalcs_stage_shift_room((int)n, b->n_rhs), sizeof(double));
    b->solved.shift = dalcs_carve(storage, &used, n_rhs * n_x, sizeof(double));
    b->column.guard = dalcs_carve(storage, &used, (size_t)s->n_pairs * DALCS_LANES, sizeof(double));
    b->column.residual = dalcs_carve(storage, &used, n, sizeof(double));
    b->column.in = dalcs_carve(storage, &used, (size_t)b->stages->n_in, sizeof(double));
    return used;
}

/* What is read before it is written has to be numbers: of whole quads. */
static void clear(struct dalcs_stage_workshop *b) {
    memset(b->solved.real, 0, (size_t)((char *)b->column.stage - (char *)b->solved.real));
}

static bool is_driven(const struct dalcs_csr *a, const double *constant) {
    bool found = false;
    for (int k = 0; k < a->p[a->n_rows] && !found; k++) {
        found = a->x[k] != 0.0 && constant[a->j[k]] != 0.0;
    }
    return found;
}

enum dalcs_status dalcs_stage_workshop_create(struct dalcs_stage_workshop **workshop,
                                              const struct dalcs_stages *stages) {
    const struct dalcs_excitation *e = stages->excitation;
    struct dalcs_stage_workshop *b = dalcs_alloc(1, sizeof(*b));
    *workshop = b;
    if (b == NULL) {
        return DALCS_E_NOMEM;
    }
    *b = (struct dalcs_stage_workshop){.stages = stages,
                                       .system = stages->system,
                                       .n_x = stages->system->n_x,
                                       .n_rhs = stages->system->n_x + 1 + e->n_waves};
    b->storage = malloc(lay_out(b, NULL));
    if (b->storage == NULL) {
        dalcs_stage_workshop_destroy(b);
        *workshop = NULL;
        return DALCS_E_NOMEM;
    }
    lay_out(b, b->storage);
    clear(b);
    for (int k = 0; k < b->system->n_inputs; k++) {
        b->wave_column[k] = -1;
    }
    for (int x = 0; x < b->n_x; x++) {
        b->column.of_missed[x] = x;
    }
    for (int w = e->n_waves - 1; w >= 0; w--) {
        b->wave_column[e->wave[w].input] = b->n_x + 1 + w;
    }
    const struct dalcs_system *s = b->system;
    b->has_constants = is_driven(&s->E, e->constant) || is_driven(&s->F, e->constant);
    return DALCS_OK;
}

void dalcs_stage_workshop_destroy(struct dalcs_stage_workshop *workshop) {
    if (workshop != NULL) {
        dalcs_stage_functions_finish(&workshop->functions);
        dalcs_arena_finish(&workshop->arena);
        free(workshop->storage);
        free(workshop);
    }
}

/* The real system of what is kept, with its right-hand sides. */
static void fill_real(const struct dalcs_stage_workshop *b) {
    long double sigma = b->stages->method->exact.lambda / b->entry->h;
    int n = b->kept.n_kept;
    for (int i = 0; i < n; i++) {
        long double *row = b->solved.of_real + i * (n + b->n_rhs);
        const long double *from = b->kept.whole + b->kept.kept_row[i] * (b->n + b->n_rhs);
        for (int j = 0; j < n; j++) {
            row[j] = from[b->kept.kept[j]];
        }
        memcpy(row + n, from + b->n, (size_t)b->n_rhs * sizeof(*row));
        for (int j = 0; j < b->n_x && i < b->n_x; j++) {
            row[j] += sigma * b->eq.P[j * b->n_x + i];
        }
    }
}

/* Puts a value that is the same in all four. */
static void put_four(long double re, struct dalcs_extended_four *to) {
    struct dalcs_extended value = dalcs_extended_of(re);
    for (int p = 0; p < DALCS_QUAD; p++) {
        to->re[p] = value.high;
        to->re_low[p] = value.low;
        to->im[p] = 0.0;
        to->im_low[p] = 0.0;
    }
}

/* Four systems likewise, with these for d/dt. */
static void fill_four(const struct dalcs_stage_workshop *b, const long double complex *sigma) {
    int n = b->kept.n_kept;
    int width = n + b->n_rhs;
    for (int i = 0; i < n; i++) {
        struct dalcs_extended_four *row = b->solved.of_pairs + i * width;
        bool *filled = b->solved.filled + i * width;
        const long double *from = b->kept.whole + b->kept.kept_row[i] * (b->n + b->n_rhs);
        for (int j = 0; j < width; j++) {
            long double a = from[j < n ? b->kept.kept[j] : b->n + j - n];
            put_four(a, &row[j]);
            filled[j] = a != 0.0L;
        }
        for (int j = 0; j < b->n_x && i < b->n_x; j++) {
            double of_rate = b->eq.P[j * b->n_x + i];
            for (int p = 0; p < DALCS_QUAD && of_rate != 0.0; p++) {
                struct dalcs_extended re =
                    dalcs_extended_of(from[b->kept.kept[j]] + creall(sigma[p]) * of_rate);
                struct dalcs_extended im = dalcs_extended_of(cimagl(sigma[p]) * of_rate);
                row[j].re[p] = re.high;
                row[j].re_low[p] = re.low;
                row[j].im[p] = im.high;
                row[j].im_low[p] = im.low;
                filled[j] = true;
            }
        }
    }
}

static struct dalcs_extended *parts_of(const struct dalcs_stage_workshop *b, int rhs_column,
                                       int kept) {
    return b->solved.part + (rhs_column * b->kept.n_kept + kept) * DALCS_SOLUTION_PARTS;
}

static void take_pairs(const struct dalcs_stage_workshop *b) {
    for (int i = 0; i < b->kept.n_kept; i++) {
        const struct dalcs_extended_four *x =
            b->solved.of_pairs + i * (b->kept.n_kept + b->n_rhs) + b->kept.n_kept;
        for (int j = 0; j < b->n_rhs; j++) {
            struct dalcs_extended *part = parts_of(b, j, i) + 1;
            const double is = dalcs_workshop_reaches(b, j, b->kept.kept[i]) ? 1.0 : 0.0;
            for (int p = 0; p < b->stages->method->n_pairs; p++) {
                part[2 * p] = (struct dalcs_extended){is * x[j].re[p], is * x[j].re_low[p]};
                part[2 * p + 1] = (struct dalcs_extended){is * x[j].im[p], is * x[j].im_low[p]};
            }
        }
    }
}

/* The solution of the real eigenvalue, of all unknowns. */
static void take_real(const struct dalcs_stage_workshop *b) {
    for (int j = 0; j < b->n_rhs; j++) {
        double *high = b->solved.real + 2 * b->solved.room * (size_t)j;
        double *low = high + b->solved.room;
        for (int k = 0; k < b->kept.n_kept; k++) {
            struct dalcs_extended *part = parts_of(b, j, k);
            const long double *row = b->solved.of_real + k * (b->kept.n_kept + b->n_rhs);
            const bool is_reached = dalcs_workshop_reaches(b, j, b->kept.kept[k]);
            *part = dalcs_extended_of(is_reached ? row[b->kept.n_kept + j] : 0.0L);
            high[b->kept.kept[k]] = part->high;
            low[b->kept.kept[k]] = part->low;
        }
        for (int f = 0; f < b->kept.n_followers; f++) {
            long double y = dalcs_stage_workshop_drive(b, f, j);
            for (int k = b->kept.follows_p[f]; k < b->kept.follows_p[f + 1] - 1; k++) {
                y += dalcs_extended_value(b->kept.follows_x[k]) *
                     dalcs_extended_value(*parts_of(b, j, b->kept.follows_j[k]));
            }
            struct dalcs_extended value =
                dalcs_extended_of(dalcs_workshop_reaches(b, j, b->kept.follower[f]) ? y : 0.0L);
            high[b->kept.follower[f]] = value.high;
            low[b->kept.follower[f]] = value.low;
        }
    }
}

static long double solve_kept(struct dalcs_stage_workshop *b) {
    fill_real(b);
    return dalcs_extended_solve(b->kept.n_kept, b->n_rhs, b->solved.of_real, NULL);
}

/* The real system as one of the four that were solved last has it. */
static void take_well(const struct dalcs_stage_workshop *b, int lane) {
    const int width = b->kept.n_kept + b->n_rhs;
    for (int i = 0; i < b->kept.n_kept; i++) {
        for (int j = b->kept.n_kept; j < width; j++) {
            const struct dalcs_extended_four *x = &b->solved.of_pairs[i * width + j];
            b->solved.of_real[i * width + j] = (long double)x->re[lane] + x->re_low[lane];
        }
    }
}

/* The real system once more, with the digits that the complex ones have. */
static bool solve_kept_well(struct dalcs_stage_workshop *b) {
    long double complex sigma[DALCS_QUAD];
    for (int p = 0; p < DALCS_QUAD; p++) {
        sigma[p] = b->stages->method->exact.lambda / b->entry->h;
    }
    fill_four(b, sigma);
    if (!(dalcs_extended_solve_four(b->kept.n_kept, b->n_rhs, b->solved.of_pairs,
                                    b->solved.filled) > 0.0)) {
        return false;
    }
    take_well(b, 0);
    return true;
}

/* is_lossy: it takes more digits. */
static enum dalcs_status solve_real(struct dalcs_stage_workshop *b, bool *is_lossy) {
    if (b->is_known) {
        dalcs_workshop_rescale(b);
    } else {
        dalcs_workshop_eliminate(b);
    }
    long double pivot = solve_kept(b);
    if (pivot < dalcs_alike && b->open.nullity == 0) { /* balanced: the mode may be singular */
        b->is_known = false;
        DALCS_TRY(dalcs_stage_choice_find(b));
        if (b->open.nullity > 0) {
            dalcs_workshop_eliminate(b);
            pivot = solve_kept(b);
        }
    }
    b->entry->frees_states = b->kept.n_kept == b->n_x && b->open.nullity == 0;
    /* An elimination in long double leaves of a solution that is 1 its own rounding over the pivot, and no more than
     * that of a sum in doubles is wanted. */
    *is_lossy = pivot < LDBL_EPSILON / dalcs_sum_rounded && b->stages->method->n_pairs > 0;
    return pivot > 0.0L ? DALCS_OK : DALCS_SINGULAR;
}

/* is_lossy: the real system is solved in the place of a pair, where there are fewer of them. */
static enum dalcs_status solve_pairs(struct dalcs_stage_workshop *b, bool is_lossy) {
    const struct dalcs_collocation *m = b->stages->method;
    if (m->n_pairs == 0) {
        return DALCS_OK;
    }
    const bool has_place = is_lossy && m->n_pairs < DALCS_QUAD;
    if (is_lossy && !has_place && !solve_kept_well(b)) {
        return DALCS_SINGULAR;
    }
    long double complex sigma[DALCS_QUAD]; /* where there are fewer, the first stands in */
    for (int p = 0; p < DALCS_QUAD; p++) {
        sigma[p] = m->exact.mu[p < m->n_pairs ? p : 0] / b->entry->h;
    }
    if (has_place) {
        sigma[m->n_pairs] = m->exact.lambda / b->entry->h;
    }
    fill_four(b, sigma);
    double pivot =
        dalcs_extended_solve_four(b->kept.n_kept, b->n_rhs, b->solved.of_pairs, b->solved.filled);
    if (has_place) {
        take_well(b, m->n_pairs);
    }
    take_pairs(b);
    return pivot > 0.0 ? DALCS_OK : DALCS_SINGULAR;
}

/* What does not depend on the step length is kept from the last map if that was of the same mode. */
static void recall(struct dalcs_stage_workshop *b) {
    bool is_same =
        b->n == b->entry->n && dalcs_mode_is(b->mode, b->entry->mode, b->stages->n_words);
    b->is_known = b->is_known && is_same;
    if (b->is_known) {
        return;
    }
    b->n = b->entry->n;
    b->open.nullity = 0;
    dalcs_arena_finish(&b->arena);
    memcpy(b->mode, b->entry->mode, (size_t)b->stages->n_words * sizeof(*b->mode));
    dalcs_workshop_fill(b);
    dalcs_workshop_find_reach(b);
}

enum dalcs_status dalcs_stage_workshop_solve(struct dalcs_stage_workshop *b,
                                             struct dalcs_stage_entry *entry) {
    b->entry = entry;
    recall(b);
    dalcs_workshop_balance(b);
    if (b->n > 0) {
        bool is_lossy;
        DALCS_TRY(solve_real(b, &is_lossy));
        DALCS_TRY(solve_pairs(b, is_lossy));
        take_real(b);
        if (!entry->frees_states) {
            dalcs_stage_shift_find(b);
        }
    }
    b->is_known = b->kept.n_followers > 0;
    return DALCS_OK;
}
