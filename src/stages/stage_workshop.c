/* stage_workshop.c - the equations of the stages for every eigenvalue, balanced and solved. */
#include "stage_workshop.h"

#include "extended.h"
#include "extremes.h"
#include "stage_choice.h"
#include "stage_matrix.h"
#include "stage_shift.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A pivot smaller than this (balanced) asks whether the mode is singular. */
static const double doubtful_pivot = 1e-9;

/* Below this pivot (balanced) an elimination in long double leaves of a solution that is 1 more than 32 roundings of a
 * double, which is what current_error.c takes for rounding: 2^-63 over it is 2^-47. */
static const long double lossy_pivot = 0x1p-16L;

/* The smallest pivot (balanced) that makes an unknown a follower. */
static const long double least_follower = 1e-2L;

enum { BALANCING_ROUNDS = 3 };

/* ---- Room ---------------------------------------------------------------------------------- */

/* For as many unknowns as a map may have. Returns the bytes of it all. */
static size_t lay_out(struct dalcs_stage_workshop *b, void *storage) {
    const struct dalcs_system *s = b->system;
    size_t n_x = (size_t)b->n_x;
    size_t n_rhs = (size_t)b->n_rhs;
    size_t n_pairs = (size_t)s->n_pairs;
    size_t all = (size_t)dalcs_system_n_columns(s);
    size_t n = all < (size_t)b->stages->dense_limit ? all : (size_t)b->stages->dense_limit;
    size_t used = 0;
    b->room = (size_t)dalcs_quads_of((int)n);
    b->wave_column = dalcs_carve(storage, &used, (size_t)s->n_inputs, sizeof(int));
    b->place = dalcs_carve(storage, &used, all, sizeof(int));
    b->row_scale = dalcs_carve(storage, &used, n, sizeof(double));
    b->column_scale = dalcs_carve(storage, &used, n, sizeof(double));
    b->mode = dalcs_carve(storage, &used, (size_t)b->stages->n_words, sizeof(*b->mode));
    b->plain_base = dalcs_carve(storage, &used, n * n, sizeof(double));
    b->plain_P = dalcs_carve(storage, &used, n_x * n_x, sizeof(double));
    b->plain_rhs = dalcs_carve(storage, &used, n * n_rhs, sizeof(double));
    b->nonzero_p = dalcs_carve(storage, &used, n + 1, sizeof(int));
    b->nonzero_i = dalcs_carve(storage, &used, n * n, sizeof(int));
    b->base = dalcs_carve(storage, &used, n * n, sizeof(double));
    b->P = dalcs_carve(storage, &used, n_x * n_x, sizeof(double));
    b->rhs = dalcs_carve(storage, &used, n * n_rhs, sizeof(double));
    b->whole_row_scale = dalcs_carve(storage, &used, n, sizeof(double));
    b->whole_column_scale = dalcs_carve(storage, &used, n, sizeof(double));
    b->size = dalcs_carve(storage, &used, n * n, sizeof(double));
    b->of_real = dalcs_carve(storage, &used, n * (n + n_rhs), sizeof(long double));
    b->of_pairs = dalcs_carve(storage, &used, n * (n + n_rhs), sizeof(*b->of_pairs));
    b->filled = dalcs_carve(storage, &used, n * (n + n_rhs), sizeof(bool));
    b->whole = dalcs_carve(storage, &used, n * (n + n_rhs), sizeof(long double));
    b->part = dalcs_carve(storage, &used, n * n_rhs * DALCS_SOLUTION_PARTS, sizeof(*b->part));
    b->real = dalcs_carve(storage, &used, n_rhs * 2 * b->room, sizeof(double));
    b->stage = dalcs_carve(storage, &used, n + 1, sizeof(*b->stage));
    b->follows_x = dalcs_carve(storage, &used, n * n, sizeof(*b->follows_x));
    b->follows_j = dalcs_carve(storage, &used, n * n, sizeof(int));
    b->follows_p = dalcs_carve(storage, &used, n + 1, sizeof(int));
    b->follower = dalcs_carve(storage, &used, n, sizeof(int));
    b->kept = dalcs_carve(storage, &used, n, sizeof(int));
    b->kept_row = dalcs_carve(storage, &used, n, sizeof(int));
    b->row_of = dalcs_carve(storage, &used, n, sizeof(int));
    b->owner = dalcs_carve(storage, &used, n, sizeof(int));
    b->lanes = dalcs_carve(storage, &used, n * DALCS_LANES, sizeof(double));
    b->start = dalcs_carve(storage, &used, n, sizeof(*b->start));
    b->missed = dalcs_carve(storage, &used, n_x + 1, sizeof(*b->missed));
    b->of_missed = dalcs_carve(storage, &used, n_x + 1, sizeof(int));
    b->filtered = dalcs_carve(storage, &used, 2 * b->room, sizeof(double));
    b->defect = dalcs_carve(storage, &used, n_x, sizeof(*b->defect));
    b->lasting = dalcs_carve(storage, &used, n_x, sizeof(*b->lasting));
    b->moment =
        dalcs_carve(storage, &used, dalcs_stage_shift_room((int)n, b->n_rhs), sizeof(double));
    b->shift = dalcs_carve(storage, &used, n_rhs * n_x, sizeof(double));
    b->guard = dalcs_carve(storage, &used, n_pairs * DALCS_LANES, sizeof(double));
    b->residual = dalcs_carve(storage, &used, n, sizeof(double));
    b->in = dalcs_carve(storage, &used, (size_t)b->stages->n_in, sizeof(double));
    return used;
}

/* What is read before it is written has to be numbers: of whole quads. */
static void clear(struct dalcs_stage_workshop *b) {
    memset(b->real, 0, (size_t)((char *)b->stage - (char *)b->real));
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
        b->of_missed[x] = x;
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

/* ---- The equations ------------------------------------------------------------------------- */

/* Column of a system's column in the unknowns; -1 for an open pair. */
static void place_columns(const struct dalcs_stage_workshop *b) {
    int n_equations = dalcs_system_n_equations(b->system);
    for (int c = 0; c < n_equations; c++) {
        b->place[c] = c;
    }
    for (int d = 0; d < b->system->n_pairs; d++) {
        b->place[n_equations + d] = -1;
    }
    for (int k = 0; k < b->entry->n_on; k++) {
        b->place[n_equations + b->entry->on[k]] = n_equations + k;
    }
}

/* Adds sign * row of a matrix to a row of the base and, for its states, to the right-hand sides with
 * the opposite sign. */
static void add_row(const struct dalcs_stage_workshop *b, const struct dalcs_csr *a, int from,
                    int to, double sign) {
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        int column = b->place[a->j[k]];
        if (column < 0) {
            continue;
        }
        b->plain_base[column * b->n + to] += sign * a->x[k];
        if (column < b->n_x) {
            b->plain_rhs[column * b->n + to] -= sign * a->x[k];
        }
    }
}

static void add_inputs(const struct dalcs_stage_workshop *b, const struct dalcs_csr *a, int from,
                       int to, double sign) {
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        int wave = b->wave_column[a->j[k]];
        if (wave >= 0) {
            b->plain_rhs[wave * b->n + to] += sign * a->x[k];
        } else {
            b->plain_rhs[b->n_x * b->n + to] +=
                sign * a->x[k] * b->stages->excitation->constant[a->j[k]];
        }
    }
}

static void list_nonzeros(struct dalcs_stage_workshop *b) {
    int n = 0;
    b->nonzero_p[0] = 0;
    for (int j = 0; j < b->n; j++) {
        const double *column = b->plain_base + j * b->n;
        const double *of_rates = j < b->n_x ? b->plain_P + j * b->n_x : NULL;
        for (int i = 0; i < b->n; i++) {
            b->nonzero_i[n] = i;
            n += column[i] != 0.0 || (of_rates != NULL && i < b->n_x && of_rates[i] != 0.0) ? 1 : 0;
        }
        b->nonzero_p[j + 1] = n;
    }
}

static void fill(struct dalcs_stage_workshop *b) {
    const struct dalcs_system *s = b->system;
    int n_equations = dalcs_system_n_equations(s);
    memset(b->plain_base, 0, (size_t)b->n * (size_t)b->n * sizeof(double));
    memset(b->plain_P, 0, (size_t)b->n_x * (size_t)b->n_x * sizeof(double));
    memset(b->plain_rhs, 0, (size_t)b->n * (size_t)b->n_rhs * sizeof(double));
    place_columns(b);
    for (int r = 0; r < n_equations; r++) {
        add_row(b, &s->A, r, r, -1.0);
        add_inputs(b, &s->E, r, r, 1.0);
    }
    for (int k = 0; k < b->entry->n_on; k++) {
        add_row(b, &s->C, b->entry->on[k], n_equations + k, 1.0);
        add_inputs(b, &s->F, b->entry->on[k], n_equations + k, -1.0);
    }
    for (int i = 0; i < b->n_x; i++) {
        for (int k = s->P.p[i]; k < s->P.p[i + 1]; k++) {
            b->plain_P[s->P.j[k] * b->n_x + i] = s->P.x[k];
        }
    }
    list_nonzeros(b);
}

static void balance_rows(const struct dalcs_stage_workshop *b) {
    memset(b->row_scale, 0, (size_t)b->n * sizeof(double));
    for (int j = 0; j < b->n; j++) {
        for (int k = b->nonzero_p[j]; k < b->nonzero_p[j + 1]; k++) {
            double *largest = &b->row_scale[b->nonzero_i[k]];
            *largest = dalcs_larger(b->size[k] * b->column_scale[j], *largest);
        }
    }
    for (int i = 0; i < b->n; i++) {
        b->row_scale[i] = dalcs_stage_matrix_scale(b->row_scale[i]);
    }
}

static void balance_columns(const struct dalcs_stage_workshop *b) {
    for (int j = 0; j < b->n; j++) {
        double largest = 0.0;
        for (int k = b->nonzero_p[j]; k < b->nonzero_p[j + 1]; k++) {
            largest = dalcs_larger(b->size[k] * b->row_scale[b->nonzero_i[k]], largest);
        }
        b->column_scale[j] = dalcs_stage_matrix_scale(largest);
    }
}

/* Those of S at the real eigenvalue. */
static void find_sizes(const struct dalcs_stage_workshop *b) {
    double sigma = b->stages->method->lambda / b->entry->h;
    for (int j = 0; j < b->n; j++) {
        for (int k = b->nonzero_p[j]; k < b->nonzero_p[j + 1]; k++) {
            int i = b->nonzero_i[k];
            double rate = i < b->n_x && j < b->n_x ? b->plain_P[j * b->n_x + i] : 0.0;
            b->size[k] = fabs(b->plain_base[j * b->n + i] + sigma * rate);
        }
    }
}

/* Rows and columns of |S| at the real eigenvalue get a largest entry near 1. */
static void balance(struct dalcs_stage_workshop *b) {
    int n = b->n;
    for (int i = 0; i < n; i++) {
        b->column_scale[i] = 1.0;
    }
    find_sizes(b);
    for (int round = 0; round < BALANCING_ROUNDS; round++) {
        balance_rows(b);
        balance_columns(b);
    }
    for (int j = 0; j < n; j++) {
        for (int k = b->nonzero_p[j]; k < b->nonzero_p[j + 1]; k++) {
            int i = b->nonzero_i[k];
            b->base[k] = b->plain_base[j * n + i] * (b->row_scale[i] * b->column_scale[j]);
        }
        for (int i = 0; i < b->n_x && j < b->n_x; i++) {
            b->P[j * b->n_x + i] =
                b->plain_P[j * b->n_x + i] * (b->row_scale[i] * b->column_scale[j]);
        }
    }
    memcpy(b->entry->natural, b->column_scale,
           (size_t)dalcs_system_n_equations(b->system) * sizeof(double));
    for (int j = 0; j < b->n_rhs; j++) {
        for (int i = 0; i < n; i++) {
            b->rhs[j * n + i] = b->plain_rhs[j * n + i] * b->row_scale[i];
        }
    }
}

/* What the conditions of a singular mode add to S, and to its right-hand sides: stage_choice.h. */
static double border(const struct dalcs_stage_workshop *b, int i, const double *of_choice, int n,
                     int j) {
    double sum = 0.0;
    for (int k = 0; k < b->nullity; k++) {
        sum += b->left[k * b->n + i] * of_choice[k * n + j];
    }
    return sum;
}

/* S without P and its right-hand sides, by rows. */
static void fill_whole(struct dalcs_stage_workshop *b) {
    int n = b->n;
    memcpy(b->whole_row_scale, b->row_scale, (size_t)n * sizeof(double));
    memcpy(b->whole_column_scale, b->column_scale, (size_t)n * sizeof(double));
    for (int i = 0; i < n; i++) {
        long double *row = b->whole + i * (n + b->n_rhs);
        for (int j = 0; j < n; j++) {
            row[j] = 0.0L;
        }
        for (int j = 0; j < b->n_rhs; j++) {
            row[n + j] = b->rhs[j * n + i];
            row[n + j] += b->nullity > 0 ? border(b, i, b->chosen, b->n_rhs, j) : 0.0;
        }
    }
    for (int j = 0; j < n; j++) {
        for (int k = b->nonzero_p[j]; k < b->nonzero_p[j + 1]; k++) {
            b->whole[b->nonzero_i[k] * (n + b->n_rhs) + j] = b->base[k];
        }
        for (int i = 0; i < n && b->nullity > 0; i++) {
            b->whole[i * (n + b->n_rhs) + j] += border(b, i, b->choice, n, j);
        }
    }
}

/* What followers take of what is kept. */
static void list_followers(struct dalcs_stage_workshop *b) {
    int entries = 0;
    b->follows_p[0] = 0;
    for (int f = 0; f < b->n_followers; f++) {
        const long double *row = b->whole + b->row_of[b->follower[f]] * (b->n + b->n_rhs);
        for (int k = 0; k < b->n_kept; k++) {
            if (row[b->kept[k]] != 0.0L) {
                b->follows_j[entries] = k;
                b->follows_x[entries++] = dalcs_extended_of(-row[b->kept[k]]);
            }
        }
        b->follows_j[entries++] = b->n_kept;
        b->follows_p[f + 1] = entries;
    }
}

/* What the equations without derivatives say of an unknown without memory is the same for every
 * eigenvalue: those that they determine are solved for once. What is kept are the states and, where the
 * index is 2, what only derivatives determine. */
static void eliminate_followers(struct dalcs_stage_workshop *b) {
    int n = b->n;
    b->n_kept = b->n_x;
    b->n_followers = 0;
    dalcs_extended_eliminate(b->n_x, n, n + b->n_rhs, least_follower, b->whole, b->row_of);
    for (int r = 0; r < n; r++) {
        b->owner[r] = -1;
    }
    for (int c = 0; c < b->n_x; c++) {
        b->kept[c] = c;
        b->kept_row[c] = c;
    }
    for (int c = b->n_x; c < n; c++) {
        if (b->row_of[c] < 0) {
            b->kept[b->n_kept++] = c;
        } else {
            b->owner[b->row_of[c]] = c;
            b->follower[b->n_followers++] = c;
        }
    }
    for (int r = b->n_x, k = b->n_x; r < n; r++) {
        if (b->owner[r] < 0) {
            b->kept_row[k++] = r;
        }
    }
    list_followers(b);
}

/* Brings what was eliminated for another step length to the present scales. All are powers of 2: no digit
 * is lost. */
static void rescale_followers(struct dalcs_stage_workshop *b) {
    int n = b->n;
    for (int i = 0; i < n; i++) {
        b->whole_row_scale[i] = b->row_scale[i] / b->whole_row_scale[i];
        b->whole_column_scale[i] = b->column_scale[i] / b->whole_column_scale[i];
    }
    for (int r = 0; r < n; r++) {
        long double *row = b->whole + r * (n + b->n_rhs);
        int of = b->owner[r];
        double scale = of < 0 ? b->whole_row_scale[r] : 1.0 / b->whole_column_scale[of];
        for (int k = 0; k < b->n_kept; k++) {
            row[b->kept[k]] *= scale * b->whole_column_scale[b->kept[k]];
        }
        for (int j = n; j < n + b->n_rhs; j++) {
            row[j] *= scale;
        }
    }
    for (int k = 0; k < b->nullity; k++) {
        for (int i = 0; i < n; i++) {
            b->left[k * n + i] /= b->whole_row_scale[i];
        }
    }
    memcpy(b->whole_row_scale, b->row_scale, (size_t)n * sizeof(double));
    memcpy(b->whole_column_scale, b->column_scale, (size_t)n * sizeof(double));
    list_followers(b);
}

/* The real system of what is kept, with its right-hand sides. */
static void fill_real(const struct dalcs_stage_workshop *b) {
    long double sigma = b->stages->method->exact_lambda / b->entry->h;
    int n = b->n_kept;
    for (int i = 0; i < n; i++) {
        long double *row = b->of_real + i * (n + b->n_rhs);
        const long double *from = b->whole + b->kept_row[i] * (b->n + b->n_rhs);
        for (int j = 0; j < n; j++) {
            row[j] = from[b->kept[j]];
        }
        memcpy(row + n, from + b->n, (size_t)b->n_rhs * sizeof(*row));
        for (int j = 0; j < b->n_x && i < b->n_x; j++) {
            row[j] += sigma * b->P[j * b->n_x + i];
        }
    }
}

/* What is the same in all. */
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
    int n = b->n_kept;
    int width = n + b->n_rhs;
    for (int i = 0; i < n; i++) {
        struct dalcs_extended_four *row = b->of_pairs + i * width;
        bool *filled = b->filled + i * width;
        const long double *from = b->whole + b->kept_row[i] * (b->n + b->n_rhs);
        for (int j = 0; j < width; j++) {
            long double a = from[j < n ? b->kept[j] : b->n + j - n];
            put_four(a, &row[j]);
            filled[j] = a != 0.0L;
        }
        for (int j = 0; j < b->n_x && i < b->n_x; j++) {
            double of_rate = b->P[j * b->n_x + i];
            for (int p = 0; p < DALCS_QUAD && of_rate != 0.0; p++) {
                struct dalcs_extended re =
                    dalcs_extended_of(from[b->kept[j]] + creall(sigma[p]) * of_rate);
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
    return b->part + (rhs_column * b->n_kept + kept) * DALCS_SOLUTION_PARTS;
}

static void take_pairs(const struct dalcs_stage_workshop *b) {
    for (int i = 0; i < b->n_kept; i++) {
        const struct dalcs_extended_four *x = b->of_pairs + i * (b->n_kept + b->n_rhs) + b->n_kept;
        for (int j = 0; j < b->n_rhs; j++) {
            struct dalcs_extended *part = parts_of(b, j, i) + 1;
            for (int p = 0; p < b->stages->method->n_pairs; p++) {
                part[2 * p] = (struct dalcs_extended){x[j].re[p], x[j].re_low[p]};
                part[2 * p + 1] = (struct dalcs_extended){x[j].im[p], x[j].im_low[p]};
            }
        }
    }
}

/* The solution of the real eigenvalue, of all unknowns. */
static void take_real(const struct dalcs_stage_workshop *b) {
    for (int j = 0; j < b->n_rhs; j++) {
        double *high = b->real + 2 * b->room * (size_t)j;
        double *low = high + b->room;
        for (int k = 0; k < b->n_kept; k++) {
            struct dalcs_extended *part = parts_of(b, j, k);
            *part = dalcs_extended_of(b->of_real[k * (b->n_kept + b->n_rhs) + b->n_kept + j]);
            high[b->kept[k]] = part->high;
            low[b->kept[k]] = part->low;
        }
        for (int f = 0; f < b->n_followers; f++) {
            long double y = dalcs_stage_workshop_drive(b, f, j);
            for (int k = b->follows_p[f]; k < b->follows_p[f + 1] - 1; k++) {
                y += dalcs_extended_value(b->follows_x[k]) *
                     dalcs_extended_value(*parts_of(b, j, b->follows_j[k]));
            }
            struct dalcs_extended value = dalcs_extended_of(y);
            high[b->follower[f]] = value.high;
            low[b->follower[f]] = value.low;
        }
    }
}

static long double solve_kept(struct dalcs_stage_workshop *b) {
    fill_real(b);
    return dalcs_extended_solve(b->n_kept, b->n_rhs, b->of_real, NULL);
}

/* The real system as one of the four that were solved last has it. */
static void take_well(const struct dalcs_stage_workshop *b, int lane) {
    const int width = b->n_kept + b->n_rhs;
    for (int i = 0; i < b->n_kept; i++) {
        for (int j = b->n_kept; j < width; j++) {
            const struct dalcs_extended_four *x = &b->of_pairs[i * width + j];
            b->of_real[i * width + j] = (long double)x->re[lane] + x->re_low[lane];
        }
    }
}

/* The real system once more, with the digits that the complex ones have. */
static bool solve_kept_well(struct dalcs_stage_workshop *b) {
    long double complex sigma[DALCS_QUAD];
    for (int p = 0; p < DALCS_QUAD; p++) {
        sigma[p] = b->stages->method->exact_lambda / b->entry->h;
    }
    fill_four(b, sigma);
    if (!(dalcs_extended_solve_four(b->n_kept, b->n_rhs, b->of_pairs, b->filled) > 0.0)) {
        return false;
    }
    take_well(b, 0);
    return true;
}

/* is_lossy: it takes more digits. */
static enum dalcs_status solve_real(struct dalcs_stage_workshop *b, bool *is_lossy) {
    if (b->is_known) {
        rescale_followers(b);
    } else {
        fill_whole(b);
        eliminate_followers(b);
    }
    long double pivot = solve_kept(b);
    if (pivot < doubtful_pivot && b->nullity == 0) {
        b->is_known = false;
        DALCS_TRY(dalcs_stage_choice_find(b));
        if (b->nullity > 0) {
            fill_whole(b);
            eliminate_followers(b);
            pivot = solve_kept(b);
        }
    }
    b->entry->frees_states = b->n_kept == b->n_x && b->nullity == 0;
    *is_lossy = pivot < lossy_pivot && b->stages->method->n_pairs > 0;
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
        sigma[p] = m->exact_mu[p < m->n_pairs ? p : 0] / b->entry->h;
    }
    if (has_place) {
        sigma[m->n_pairs] = m->exact_lambda / b->entry->h;
    }
    fill_four(b, sigma);
    double pivot = dalcs_extended_solve_four(b->n_kept, b->n_rhs, b->of_pairs, b->filled);
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
    b->nullity = 0;
    dalcs_arena_finish(&b->arena);
    memcpy(b->mode, b->entry->mode, (size_t)b->stages->n_words * sizeof(*b->mode));
    fill(b);
}

enum dalcs_status dalcs_stage_workshop_solve(struct dalcs_stage_workshop *b,
                                             struct dalcs_stage_entry *entry) {
    b->entry = entry;
    recall(b);
    balance(b);
    if (b->n > 0) {
        bool is_lossy;
        DALCS_TRY(solve_real(b, &is_lossy));
        DALCS_TRY(solve_pairs(b, is_lossy));
        take_real(b);
        if (!entry->frees_states) {
            dalcs_stage_shift_find(b);
        }
    }
    b->is_known = b->n_followers > 0;
    return DALCS_OK;
}
