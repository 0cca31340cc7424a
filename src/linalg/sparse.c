/* sparse.c - triplets and compressed rows. Compression is a counting sort by column, then a stable
 * one by row: linear in the entries and the same order on every machine. */
#include "sparse.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>

/* Indices that work needs at most to be on the stack. */
enum { FEW = 128 };

enum dalcs_status dalcs_triplets_add(struct dalcs_triplets *t, int row, int column, double value) {
    DALCS_TRY(dalcs_grow(&t->entry, &t->capacity, t->n + 1, sizeof(*t->entry)));
    t->entry[t->n++] = (struct dalcs_triplet){row, column, value};
    return DALCS_OK;
}

void dalcs_triplets_finish(struct dalcs_triplets *t) {
    free(t->entry);
    *t = (struct dalcs_triplets){0};
}

/* One allocation for all three arrays, the one with the largest elements first; it is x. */
static bool make_room(struct dalcs_csr *a, size_t n) {
    const size_t n_starts = (size_t)a->n_rows + 1;
    const size_t n_indices = n_starts + n;
    a->x = dalcs_alloc(n + (n_indices + 1) / 2, sizeof(*a->x));
    if (a->x == NULL) {
        return false;
    }
    _Static_assert(2 * sizeof(*a->p) <= sizeof(*a->x), "two indices take the room of a value");
    void *indices = a->x + n;
    a->p = indices;
    a->j = a->p + n_starts;
    return true;
}

/* order[t->n]: the entries, column by column; start[n_columns + 1] is 0 before. */
static void order_by_column(const struct dalcs_triplets *t, int n_columns, int *start, int *order) {
    for (size_t k = 0; k < t->n; k++) {
        start[t->entry[k].column + 1]++;
    }
    for (int c = 0; c < n_columns; c++) {
        start[c + 1] += start[c];
    }
    for (size_t k = 0; k < t->n; k++) {
        order[start[t->entry[k].column]++] = (int)k;
    }
}

/* The sum of x[0..n-1], all but rounded once (A. Neumaier, Z. angew. Math. Mech. 54, 1974). The KCL of a tree of
 * capacitors adds up the conductances that leave each of its nodes: what stays inside must cancel without a trace,
 * however much larger it is than what leaves the tree. */
static double sum_of(const double *x, int n) {
    double sum = x[0];
    double lost = 0.0;
    for (int k = 1; k < n; k++) {
        double next = sum + x[k];
        lost += fabs(sum) >= fabs(x[k]) ? (sum - next) + x[k] : (x[k] - next) + sum;
        sum = next;
    }
    return isfinite(lost) ? sum + lost : sum;
}

static int by_size(const void *a, const void *b) {
    const double x = fabs(*(const double *)a), y = fabs(*(const double *)b);
    return (x > y) - (x < y);
}

static double size_of(const double *x, int n) {
    double size = 0.0;
    for (int k = 0; k < n; k++) {
        size += fabs(x[k]);
    }
    return size;
}

/* Is this sum what rounding left where the terms cancel? Each of them is a rounded number, as 1/3 S of 3 ohm is, and off by half
 * a unit in its last place. Two that are opposites came from one element and leave nothing. x[] is sorted. */
static bool is_rounding(double *x, int n, double sum) {
    const double rounding = 0.5 * DBL_EPSILON;
    if (!(fabs(sum) <= rounding * size_of(x, n))) {
        return false;
    }
    qsort(x, (size_t)n, sizeof *x, by_size);
    double size = 0.0;
    for (int k = 0; k < n;) {
        const double of_one = fabs(x[k]);
        double together = 0.0;
        for (; k < n && fabs(x[k]) == of_one; k++) {
            together += x[k] < 0.0 ? -1.0 : 1.0;
        }
        size += fabs(together) * of_one;
    }
    return fabs(sum) <= rounding * size;
}

/* p[r] is the end of row r: walk forward, merge duplicates, drop what cancelled. */
static void merge_duplicates(struct dalcs_csr *a, bool drops_rounding) {
    int out = 0;
    int begin = 0;
    for (int r = 0; r < a->n_rows; r++) {
        int end = a->p[r];
        a->p[r] = out;
        for (int k = begin; k < end;) {
            int column = a->j[k];
            int first = k++;
            while (k < end && a->j[k] == column) {
                k++;
            }
            double sum = sum_of(a->x + first, k - first);
            const bool may_be_rounding = drops_rounding && k - first > 1;
            if (sum != 0.0 && !(may_be_rounding && is_rounding(a->x + first, k - first, sum))) {
                a->j[out] = column;
                a->x[out++] = sum;
            }
        }
        begin = end;
    }
    a->p[a->n_rows] = out;
}

static enum dalcs_status compress(struct dalcs_csr *a, int n_rows, int n_columns,
                                  const struct dalcs_triplets *t, bool drops_rounding) {
    *a = (struct dalcs_csr){.n_rows = n_rows, .n_columns = n_columns};
    if (t->n > INT_MAX / 2) {
        return DALCS_E_LIMIT;
    }
    int few[FEW] = {0}; /* most matrices are small, and there are many of them */
    const size_t n_work = (size_t)n_columns + 1 + t->n;
    int *work = n_work <= FEW ? few : dalcs_alloc(n_work, sizeof(*work));
    const bool complete = work != NULL && make_room(a, t->n);
    if (complete) {
        int *order = work + n_columns + 1;
        order_by_column(t, n_columns, work, order);
        for (size_t k = 0; k < t->n; k++) {
            a->p[t->entry[k].row + 1]++;
        }
        for (int r = 0; r < n_rows; r++) {
            a->p[r + 1] += a->p[r];
        }
        for (size_t k = 0; k < t->n; k++) {
            const struct dalcs_triplet *e = &t->entry[order[k]];
            int slot = a->p[e->row]++;
            a->j[slot] = e->column;
            a->x[slot] = e->value;
        }
        merge_duplicates(a, drops_rounding);
    }
    if (work != few) {
        free(work);
    }
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_csr_compress(struct dalcs_csr *a, int n_rows, int n_columns,
                                     const struct dalcs_triplets *t) {
    return compress(a, n_rows, n_columns, t, false);
}

enum dalcs_status dalcs_csr_compress_rounded(struct dalcs_csr *a, int n_rows, int n_columns,
                                             const struct dalcs_triplets *t) {
    return compress(a, n_rows, n_columns, t, true);
}

void dalcs_csr_finish(struct dalcs_csr *a) {
    free(a->x);
    *a = (struct dalcs_csr){0};
}

void dalcs_csr_row_difference(const struct dalcs_csr *a, int i, int *ends) {
    int k = a->p[i];
    ends[0] = -1;
    ends[1] = -1;
    if (a->p[i + 1] - k == 2 && a->x[k] * a->x[k + 1] == -1.0 && fabs(a->x[k]) == 1.0) {
        int plus = a->x[k] == 1.0 ? k : k + 1;
        ends[0] = a->j[plus];
        ends[1] = a->j[2 * k + 1 - plus];
    }
}

void dalcs_csr_multiply(const struct dalcs_csr *a, const double *v, double *y) {
    for (int i = 0; i < a->n_rows; i++) {
        y[i] = dalcs_csr_row_dot(a, i, v);
    }
}
