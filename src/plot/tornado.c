/* tornado.c - effects of single values, from runs of .wcase or from a fitted plane. */
#include "tornado.h"

#include "memory.h"
#include "names.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static double cell(const struct dalcs_waveforms *w, size_t row, size_t column) {
    return w->value[row * w->n_columns + column];
}

/* n_columns: there is none. */
static size_t find_column(const struct dalcs_waveforms *w, const char *name, size_t length) {
    size_t k = 0;
    while (k < w->n_columns &&
           (strlen(w->name[k]) != length || strncasecmp(w->name[k], name, length) != 0)) {
        k++;
    }
    return k;
}

static enum dalcs_status refuse(const struct dalcs_waveforms *w, struct dalcs_diag *diag,
                                const char *name, size_t length) {
    char *copy = dalcs_alloc(length + 1, 1);
    if (copy == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(copy, name, length);
    const char *nearest = dalcs_names_nearest_of(w->name, w->n_columns, copy);
    char hint[160] = "";
    if (nearest != NULL) {
        snprintf(hint, sizeof hint, "did you mean '%.100s'?", nearest);
    }
    dalcs_diag_add(diag, DALCS_ERROR, NULL, nearest != NULL ? hint : NULL,
                   "the table has no column '%s'", copy);
    free(copy);
    return DALCS_E_OPTION;
}

/* ---- .wcase ------------------------------------------------------------------------------------ */

/* Row 1 + 2 p and the next have value p at the ends around the first row's, and of the first n values no other. */
static bool is_alone(const struct dalcs_waveforms *w, size_t p, size_t n) {
    if (2 + 2 * p >= w->n_rows ||
        !((cell(w, 1 + 2 * p, p) - cell(w, 0, p)) * (cell(w, 2 + 2 * p, p) - cell(w, 0, p)) < 0)) {
        return false;
    }
    for (size_t row = 1 + 2 * p; row < 3 + 2 * p; row++) {
        for (size_t k = 0; k < n; k++) {
            if ((cell(w, row, k) == cell(w, 0, k)) == (k == p)) {
                return false;
            }
        }
    }
    return true;
}

/* The number of values that .wcase has varied; 0: it is another table. */
static size_t count_alone(const struct dalcs_waveforms *w) {
    size_t n = w->n_columns;
    for (; n > 0; n--) {
        size_t p = 0;
        while (p < n && is_alone(w, p, n)) {
            p++;
        }
        if (p == n) {
            break;
        }
    }
    return n;
}

static void take_ends(struct dalcs_tornado *t, const struct dalcs_waveforms *w, size_t result) {
    t->middle = cell(w, 0, result);
    for (size_t p = 0; p < t->n; p++) {
        t->bar[p] = (struct dalcs_tornado_bar){.name = w->name[p],
                                               .low = cell(w, 1 + 2 * p, p),
                                               .high = cell(w, 2 + 2 * p, p),
                                               .at_low = cell(w, 1 + 2 * p, result),
                                               .at_high = cell(w, 2 + 2 * p, result)};
    }
}

/* ---- A plane ------------------------------------------------------------------------------------ */

/* The rows that count, values and result around their means: columns of n_rows numbers. */
struct plane {
    size_t n_rows, n;   /* n values */
    double *column;     /* [(n + 1) * n_rows] heap */
    double *mean;       /* [n + 1] */
    double *least;      /* [n] of a value, from its mean */
    double *largest;    /* [n] the same */
    double *triangle;   /* [n * n] */
    double *projection; /* [n] */
};

static double dot(const struct plane *plane, size_t a, size_t b) {
    double sum = 0;
    for (size_t k = 0; k < plane->n_rows; k++) {
        sum += plane->column[a * plane->n_rows + k] * plane->column[b * plane->n_rows + k];
    }
    return sum;
}

/* Those where all of them are numbers. */
static void fill_columns(struct plane *plane, const struct dalcs_waveforms *w,
                         const size_t *column /* [n + 1] */) {
    const size_t stride = plane->n_rows;
    size_t n_rows = 0;
    for (size_t row = 0; row < w->n_rows; row++) {
        bool is_whole = true;
        for (size_t k = 0; k <= plane->n; k++) {
            plane->column[k * stride + n_rows] = cell(w, row, column[k]);
            is_whole = is_whole && isfinite(cell(w, row, column[k]));
        }
        n_rows += is_whole ? 1 : 0;
    }
    for (size_t k = 1; k <= plane->n; k++) {
        memmove(plane->column + k * n_rows, plane->column + k * stride,
                n_rows * sizeof *plane->column);
    }
    plane->n_rows = n_rows;
    for (size_t k = 0; k <= plane->n && n_rows > 0; k++) {
        double *at = plane->column + k * n_rows;
        double least = at[0];
        double largest = at[0];
        double sum = 0;
        for (size_t row = 0; row < n_rows; row++) {
            least = fmin(least, at[row]);
            largest = fmax(largest, at[row]);
            sum += at[row];
        }
        plane->mean[k] = sum / (double)n_rows;
        if (k < plane->n) {
            plane->least[k] = least - plane->mean[k];
            plane->largest[k] = largest - plane->mean[k];
        }
        for (size_t row = 0; row < n_rows; row++) {
            at[row] -= plane->mean[k];
        }
    }
}

/* Modified Gram-Schmidt (Golub & Van Loan, Matrix Computations, 5.2.8): the values' columns become orthonormal. A column
 * of which less than the root of the rounding is left was a sum of those before it: its slope would have no digit.
 * Returns n, or the first one that is. */
static size_t orthogonalize(struct plane *plane) {
    static const double nothing = 0x1p-26;
    for (size_t k = 0; k < plane->n; k++) {
        const double whole = sqrt(dot(plane, k, k));
        for (size_t i = 0; i < k; i++) {
            const double part = dot(plane, i, k);
            plane->triangle[i * plane->n + k] = part;
            for (size_t row = 0; row < plane->n_rows; row++) {
                plane->column[k * plane->n_rows + row] -=
                    part * plane->column[i * plane->n_rows + row];
            }
        }
        const double left = sqrt(dot(plane, k, k));
        if (!(left > nothing * whole)) {
            return k;
        }
        plane->triangle[k * plane->n + k] = left;
        for (size_t row = 0; row < plane->n_rows; row++) {
            plane->column[k * plane->n_rows + row] /= left;
        }
        plane->projection[k] = dot(plane, k, plane->n);
    }
    return plane->n;
}

/* Slopes in the place of the projections. */
static void substitute(struct plane *plane) {
    for (size_t k = plane->n; k-- > 0;) {
        double sum = plane->projection[k];
        for (size_t i = k + 1; i < plane->n; i++) {
            sum -= plane->triangle[k * plane->n + i] * plane->projection[i];
        }
        plane->projection[k] = sum / plane->triangle[k * plane->n + k];
    }
}

static enum dalcs_status fit(struct dalcs_tornado *t, const struct dalcs_waveforms *w,
                             const size_t *column, struct dalcs_diag *diag) {
    const size_t n = t->n;
    struct plane plane = {.n = n, .n_rows = w->n_rows};
    plane.column = dalcs_alloc((n + 1) * (w->n_rows + 1), sizeof *plane.column);
    plane.mean = dalcs_alloc(n * n + 4 * n + 1, sizeof *plane.mean);
    enum dalcs_status status = DALCS_E_NOMEM;
    if (plane.column != NULL && plane.mean != NULL) {
        plane.least = plane.mean + n + 1;
        plane.largest = plane.least + n;
        plane.projection = plane.largest + n;
        plane.triangle = plane.projection + n;
        fill_columns(&plane, w, column);
        const size_t done = plane.n_rows > n ? orthogonalize(&plane) : n;
        status = DALCS_E_OPTION;
        if (plane.n_rows <= n) {
            dalcs_diag_add(diag, DALCS_ERROR, NULL, "run more of them",
                           "%zu runs are too few to tell the effects of %zu values apart",
                           plane.n_rows, n);
        } else if (done < n) {
            dalcs_diag_add(diag, DALCS_ERROR, NULL, "leave it out",
                           "'%s' is constant in the table, or follows from the values before it",
                           w->name[column[done]]);
        } else {
            substitute(&plane);
            status = DALCS_OK;
        }
        t->middle = plane.mean[n];
    }
    for (size_t k = 0; k < n && status == DALCS_OK; k++) {
        const double slope = plane.projection[k];
        t->bar[k] = (struct dalcs_tornado_bar){.name = w->name[column[k]],
                                               .low = plane.mean[k] + plane.least[k],
                                               .high = plane.mean[k] + plane.largest[k],
                                               .at_low = t->middle + slope * plane.least[k],
                                               .at_high = t->middle + slope * plane.largest[k]};
    }
    free(plane.column);
    free(plane.mean);
    return status;
}

static enum dalcs_status fit_named(struct dalcs_tornado *t, struct dalcs_waveforms *w,
                                   size_t result, const char *values, struct dalcs_diag *diag) {
    size_t *column = dalcs_alloc(w->n_columns + strlen(values) + 1, sizeof *column);
    enum dalcs_status status = column != NULL ? DALCS_OK : DALCS_E_NOMEM;
    for (const char *at = values; *at != '\0' && status == DALCS_OK;) {
        const size_t length = strcspn(at, ",");
        const size_t found = find_column(w, at, length);
        if (found == w->n_columns) {
            status = refuse(w, diag, at, length);
        } else {
            column[t->n++] = found;
        }
        at += length + (at[length] == ',' ? 1 : 0);
    }
    t->bar = status == DALCS_OK ? dalcs_arena_alloc(&w->arena, t->n + 1, sizeof *t->bar) : NULL;
    if (status == DALCS_OK && t->bar != NULL) {
        column[t->n] = result;
        status = fit(t, w, column, diag);
    } else if (status == DALCS_OK) {
        status = DALCS_E_NOMEM;
    }
    free(column);
    return status;
}

enum dalcs_status dalcs_tornado_make(struct dalcs_tornado *tornado,
                                     struct dalcs_waveforms *waveforms, const char *result,
                                     const char *values, struct dalcs_diag *diag) {
    const size_t at = find_column(waveforms, result, strlen(result));
    if (at == waveforms->n_columns) {
        return refuse(waveforms, diag, result, strlen(result));
    }
    tornado->result = waveforms->name[at];
    if (values != NULL) {
        DALCS_TRY(fit_named(tornado, waveforms, at, values, diag));
    } else {
        tornado->n = count_alone(waveforms);
        if (tornado->n == 0 || at < tornado->n) {
            dalcs_diag_add(
                diag, DALCS_ERROR, NULL, "say which columns are values: --tornado=r1,c1",
                tornado->n == 0
                    ? "'%s' may depend on any other column: the table is none that .wcase wrote"
                    : "'%s' is one of the values that .wcase has varied",
                tornado->result);
            return DALCS_E_OPTION;
        }
        tornado->bar = dalcs_arena_alloc(&waveforms->arena, tornado->n, sizeof *tornado->bar);
        if (tornado->bar == NULL) {
            return DALCS_E_NOMEM;
        }
        take_ends(tornado, waveforms, at);
    }
    dalcs_tornado_sort(tornado);
    return DALCS_OK;
}
