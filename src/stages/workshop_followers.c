/* workshop_followers.c - unknowns without memory that equations without derivatives determine: solved for once, for
 * every eigenvalue and step length. */
#include "stage_workshop.h"

#include "extended.h"
#include "extended_eliminate.h"
#include "magnitudes.h"

#include <string.h>

/* The conditions of a singular mode in S and in its right-hand sides: stage_choice.h. */
static double border(const struct dalcs_stage_workshop *b, int i, const double *of_choice, int n,
                     int j) {
    double sum = 0.0;
    for (int k = 0; k < b->open.nullity; k++) {
        sum += b->open.left[k * b->n + i] * of_choice[k * n + j];
    }
    return sum;
}

/* Does a choice stand in the place of row i? */
static bool is_given_up(const struct dalcs_stage_workshop *b, int i) {
    bool is = false;
    for (int k = 0; k < b->open.nullity && b->open.given_up != NULL && !is; k++) {
        is = b->open.given_up[k] == i;
    }
    return is;
}

/* S without P and its right-hand sides, by rows. */
static void fill_whole(struct dalcs_stage_workshop *b) {
    int n = b->n;
    memcpy(b->kept.whole_row_scale, b->eq.row_scale, (size_t)n * sizeof(double));
    memcpy(b->kept.whole_column_scale, b->eq.column_scale, (size_t)n * sizeof(double));
    for (int i = 0; i < n; i++) {
        long double *row = b->kept.whole + i * (n + b->n_rhs);
        for (int j = 0; j < n; j++) {
            row[j] = 0.0L;
        }
        for (int j = 0; j < b->n_rhs; j++) {
            row[n + j] = is_given_up(b, i) ? 0.0L : b->eq.rhs[j * n + i];
            row[n + j] += b->open.nullity > 0 ? border(b, i, b->open.chosen, b->n_rhs, j) : 0.0;
        }
    }
    for (int j = 0; j < n; j++) {
        for (int k = b->eq.nonzero_p[j]; k < b->eq.nonzero_p[j + 1]; k++) {
            int i = b->eq.nonzero_i[k];
            b->kept.whole[i * (n + b->n_rhs) + j] = is_given_up(b, i) ? 0.0L : b->eq.base[k];
        }
        for (int i = 0; i < n && b->open.nullity > 0; i++) {
            b->kept.whole[i * (n + b->n_rhs) + j] += border(b, i, b->open.choice, n, j);
        }
    }
}

/* What the sums of A were rounded to (system.h), in S and in its right-hand sides. */
static void add_rest(const struct dalcs_stage_workshop *b, struct dalcs_extended *whole) {
    const struct dalcs_csr *rest = &b->system->A_rest;
    for (int i = 0; rest->p != NULL && i < rest->n_rows; i++) {
        struct dalcs_extended *row = whole + i * (b->n + b->n_rhs);
        for (int k = rest->p[i]; k < rest->p[i + 1] && !is_given_up(b, i); k++) {
            const int column = b->place[rest->j[k]];
            const double left = rest->x[k] * b->eq.row_scale[i];
            if (column >= 0) {
                const struct dalcs_extended of_S = {-left * b->eq.column_scale[column], 0.0};
                row[column] = dalcs_extended_plus(row[column], of_S);
            }
            if (column >= 0 && column < b->n_x) {
                const struct dalcs_extended of_state = {left, 0.0};
                row[b->n + column] = dalcs_extended_plus(row[b->n + column], of_state);
            }
        }
    }
}

/* The same with the digits that sums of conductances have, and with what these lack in A. Where only derivatives determine a
 * voltage, coils alone join a part to the rest. Beside 10 S in it the rounding of a double is 1e-15 S to ground, which in a
 * step of 1e-12 s carries more than a coil of 1 H, and may be negative: then the step is unstable. */
static void eliminate_well(struct dalcs_stage_workshop *b) {
    const int n = b->n;
    const int width = n + b->n_rhs;
    struct dalcs_extended *whole = (struct dalcs_extended *)b->solved.of_pairs;
    fill_whole(b);
    for (int k = 0; k < n * width; k++) {
        whole[k] = dalcs_extended_of(b->kept.whole[k]);
    }
    add_rest(b, whole);
    dalcs_extended_eliminate_well(b->n_x, n, width, dalcs_slight, whole, b->kept.row_of);
    for (int k = 0; k < n * width; k++) {
        b->kept.whole[k] = dalcs_extended_value(whole[k]);
    }
}

static bool all_follow(const struct dalcs_stage_workshop *b) {
    bool all = true;
    for (int c = b->n_x; c < b->n && all; c++) {
        all = b->kept.row_of[c] >= 0;
    }
    return all;
}

/* What followers take of what is kept. */
static void list_followers(struct dalcs_stage_workshop *b) {
    int entries = 0;
    b->kept.follows_p[0] = 0;
    for (int f = 0; f < b->kept.n_followers; f++) {
        const long double *row =
            b->kept.whole + b->kept.row_of[b->kept.follower[f]] * (b->n + b->n_rhs);
        for (int k = 0; k < b->kept.n_kept; k++) {
            if (row[b->kept.kept[k]] != 0.0L) {
                b->kept.follows_j[entries] = k;
                b->kept.follows_x[entries++] = dalcs_extended_of(-row[b->kept.kept[k]]);
            }
        }
        b->kept.follows_j[entries++] = b->kept.n_kept;
        b->kept.follows_p[f + 1] = entries;
    }
}

void dalcs_workshop_eliminate(struct dalcs_stage_workshop *b) {
    int n = b->n;
    fill_whole(b);
    b->kept.n_kept = b->n_x;
    b->kept.n_followers = 0;
    /* a pivot (balanced) that is slight makes no follower */
    dalcs_extended_eliminate(b->n_x, n, n + b->n_rhs, dalcs_slight, b->kept.whole, b->kept.row_of);
    /* tangents change sums of A: what these lack then is not known */
    if (b->system->n_smooth == 0 && !all_follow(b)) {
        eliminate_well(b);
    }
    for (int r = 0; r < n; r++) {
        b->kept.owner[r] = -1;
    }
    for (int c = 0; c < b->n_x; c++) {
        b->kept.kept[c] = c;
        b->kept.kept_row[c] = c;
    }
    for (int c = b->n_x; c < n; c++) {
        if (b->kept.row_of[c] < 0) {
            b->kept.kept[b->kept.n_kept++] = c;
        } else {
            b->kept.owner[b->kept.row_of[c]] = c;
            b->kept.follower[b->kept.n_followers++] = c;
        }
    }
    for (int r = b->n_x, k = b->n_x; r < n; r++) {
        if (b->kept.owner[r] < 0) {
            b->kept.kept_row[k++] = r;
        }
    }
    list_followers(b);
}

void dalcs_workshop_rescale(struct dalcs_stage_workshop *b) {
    int n = b->n;
    for (int i = 0; i < n; i++) {
        b->kept.whole_row_scale[i] = b->eq.row_scale[i] / b->kept.whole_row_scale[i];
        b->kept.whole_column_scale[i] = b->eq.column_scale[i] / b->kept.whole_column_scale[i];
    }
    for (int r = 0; r < n; r++) {
        long double *row = b->kept.whole + r * (n + b->n_rhs);
        int of = b->kept.owner[r];
        double scale = of < 0 ? b->kept.whole_row_scale[r] : 1.0 / b->kept.whole_column_scale[of];
        for (int k = 0; k < b->kept.n_kept; k++) {
            row[b->kept.kept[k]] *= scale * b->kept.whole_column_scale[b->kept.kept[k]];
        }
        for (int j = n; j < n + b->n_rhs; j++) {
            row[j] *= scale;
        }
    }
    for (int k = 0; k < b->open.nullity; k++) {
        for (int i = 0; i < n; i++) {
            b->open.left[k * n + i] /= b->kept.whole_row_scale[i];
        }
    }
    memcpy(b->kept.whole_row_scale, b->eq.row_scale, (size_t)n * sizeof(double));
    memcpy(b->kept.whole_column_scale, b->eq.column_scale, (size_t)n * sizeof(double));
    list_followers(b);
}
