/* stage_shift.c - by two very short steps of implicit Euler. */
#include "stage_shift.h"

#include "magnitudes.h"

#include <math.h>
#include <string.h>

/* What is kept without its rates, with its right-hand sides, by rows. */
static void fill_moment(const struct dalcs_stage_workshop *b, double *to) {
    const int n = b->kept.n_kept;
    const int width = dalcs_dense_row(n, b->n_rhs);
    for (int i = 0; i < n; i++, to += width) {
        const long double *from = b->kept.whole + b->kept.kept_row[i] * (b->n + b->n_rhs);
        for (int j = 0; j < n; j++) {
            to[j] = (double)from[b->kept.kept[j]];
        }
        for (int j = n; j < width; j++) {
            to[j] = j < n + b->n_rhs ? (double)from[b->n + j - n] : 0.0;
        }
    }
}

/* That is solved for a step of implicit Euler of length h, over lambda. */
static bool solve_moment(const struct dalcs_stage_workshop *b, double h, double *moment) {
    const double sigma = b->stages->method->lambda / h;
    const int width = dalcs_dense_row(b->kept.n_kept, b->n_rhs);
    for (int j = 0; j < b->n_x; j++) {
        for (int i = 0; i < b->n_x; i++) {
            moment[i * width + j] += sigma * b->eq.P[j * b->n_x + i];
        }
    }
    return dalcs_dense_solve(b->kept.n_kept, b->n_rhs, moment) > 0.0;
}

/* The limit of what a very short step adds to the states as it gets shorter, from two by extrapolation: in so short a step
 * states that move by themselves are alike, and what moves them is what the mode does not allow. What goes on by itself
 * moves states in proportion to the step, and cancels. */
void dalcs_stage_shift_find(struct dalcs_stage_workshop *b) {
    const int width = dalcs_dense_row(b->kept.n_kept, b->n_rhs);
    double *half = b->solved.moment;
    double *all = half + b->kept.n_kept * width;
    fill_moment(b, half);
    memcpy(all, half, (size_t)(b->kept.n_kept * width) * sizeof(*all));
    bool is_regular = solve_moment(b, 0.5 * dalcs_alike * b->entry->h, half);
    is_regular = solve_moment(b, dalcs_alike * b->entry->h, all) && is_regular;
    for (int j = 0; j < b->n_rhs; j++) {
        for (int x = 0; x < b->n_x; x++) {
            int at = x * width + b->kept.n_kept + j;
            double shift = (2.0 * half[at] - all[at]) * b->eq.column_scale[x];
            b->solved.shift[j * b->n_x + x] = is_regular ? shift : NAN;
        }
    }
}

/* A source is what it is at the start. */
void dalcs_stage_shift_fill(const struct dalcs_stage_workshop *b,
                            const struct dalcs_stage_function *function) {
    const struct dalcs_excitation *e = b->stages->excitation;
    double *to = b->entry->maps.shift;
    for (int x = 0; x < b->n_x; x++) {
        for (int j = 0; j < b->n_x + (b->has_constants ? 1 : 0); j++) {
            *to++ = b->solved.shift[j * b->n_x + x];
        }
        for (int f = 0; f < e->n_functions; f++) {
            int rhs_column = b->wave_column[e->function[f].input];
            *to++ = b->solved.shift[rhs_column * b->n_x + x] * function[f].share[0];
        }
    }
}

double dalcs_stage_shift(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                         int x, const double *in) {
    if (entry->map == NULL) {
        return NAN;
    }
    if (entry->frees_states) {
        return 0.0;
    }
    const int n = dalcs_stage_map_columns(stages);
    const double *row = entry->maps.shift + x * n;
    const double *factor = dalcs_stage_map_input(stages, in);
    double shift = 0.0;
    for (int j = 0; j < n; j++) {
        shift += row[j] * factor[j];
    }
    return shift;
}
