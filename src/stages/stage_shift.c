/* stage_shift.c - by two very short steps of implicit Euler. */
#include "stage_shift.h"

#include <math.h>
#include <string.h>

/* A step in which states move so little by themselves that what they move is what the mode does not allow, as in the
 * shortest steps of projection.c. */
static const double moment = 0x1p-30;

/* The real system of what is kept, of implicit Euler over so short a step. */
static void fill_moment(const struct dalcs_stage_workshop *b, double h) {
    const double sigma = b->stages->method->lambda / h;
    const int n = b->n_kept;
    const int width = dalcs_dense_row(n, b->n_rhs);
    for (int i = 0; i < n; i++) {
        double *row = b->moment + i * width;
        const long double *from = b->whole + b->kept_row[i] * (b->n + b->n_rhs);
        for (int j = 0; j < n; j++) {
            row[j] = (double)from[b->kept[j]];
        }
        for (int j = n; j < width; j++) {
            row[j] = j < n + b->n_rhs ? (double)from[b->n + j - n] : 0.0;
        }
        for (int j = 0; j < b->n_x && i < b->n_x; j++) {
            row[j] += sigma * b->P[j * b->n_x + i];
        }
    }
}

/* b->shift += weight times what a step of implicit Euler of length h, over lambda, adds to the states. */
static void add_shift(struct dalcs_stage_workshop *b, double h, double weight) {
    const int width = dalcs_dense_row(b->n_kept, b->n_rhs);
    fill_moment(b, h);
    bool is_regular = dalcs_dense_solve(b->n_kept, b->n_rhs, b->moment) > 0.0;
    for (int j = 0; j < b->n_rhs; j++) {
        for (int x = 0; x < b->n_x; x++) {
            double step = b->moment[x * width + b->n_kept + j] * b->column_scale[x];
            b->shift[j * b->n_x + x] += is_regular ? weight * step : NAN;
        }
    }
}

/* How far the mode moves states at once: the limit of a step of implicit Euler as it gets shorter, from two by
 * extrapolation. What goes on by itself moves states in proportion to the step, and cancels. */
void dalcs_stage_shift_find(struct dalcs_stage_workshop *b) {
    memset(b->shift, 0, (size_t)(b->n_rhs * b->n_x) * sizeof(double));
    add_shift(b, 0.5 * moment * b->entry->h, 2.0);
    add_shift(b, moment * b->entry->h, -1.0);
}

/* A source is what it is at the start. */
void dalcs_stage_shift_fill(const struct dalcs_stage_workshop *b,
                            const struct dalcs_stage_function *function) {
    const struct dalcs_excitation *e = b->stages->excitation;
    double *to = b->entry->shift_map;
    for (int x = 0; x < b->n_x; x++) {
        for (int j = 0; j < b->n_x + (b->has_constants ? 1 : 0); j++) {
            *to++ = b->shift[j * b->n_x + x];
        }
        for (int f = 0; f < e->n_functions; f++) {
            int rhs_column = b->wave_column[e->function[f].input];
            *to++ = b->shift[rhs_column * b->n_x + x] * function[f].share[0];
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
    const double *row = entry->shift_map + x * n;
    const double *factor = dalcs_stage_map_input(stages, in);
    double shift = 0.0;
    for (int j = 0; j < n; j++) {
        shift += row[j] * factor[j];
    }
    return shift;
}
