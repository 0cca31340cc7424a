/* workshop_followers.c - unknowns without memory that equations without derivatives determine: solved for once, for
 * every eigenvalue and step length. */
#include "stage_workshop.h"

#include "extended.h"

#include <string.h>

/* The smallest pivot (balanced) that makes an unknown a follower. */
static const long double least_follower = 1e-2L;

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
            row[j] = b->base[j * n + i];
        }
        for (int j = 0; j < n && b->nullity > 0; j++) {
            row[j] += border(b, i, b->choice, n, j);
        }
        for (int j = 0; j < b->n_rhs; j++) {
            row[n + j] = b->rhs[j * n + i];
            row[n + j] += b->nullity > 0 ? border(b, i, b->chosen, b->n_rhs, j) : 0.0;
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

void dalcs_workshop_eliminate(struct dalcs_stage_workshop *b) {
    int n = b->n;
    fill_whole(b);
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

void dalcs_workshop_rescale(struct dalcs_stage_workshop *b) {
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
