/* null_space.c - rows that vanish under sparse elimination, and the columns that have no pivot. */
#include "null_space.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

/* An entry so many times its bound is no rounding. */
static const long double doubt = 8.0L;

struct entry {
    int column;
    long double value, bound;
};

struct row {
    int n, capacity;
    struct entry *entry; /* columns ascending */
    int next, previous;  /* among those of as many entries, -1: none */
};

struct column {
    int n, capacity;
    int *row; /* that have, or had, an entry here; a row may be there twice */
};

struct work {
    struct row *row;
    struct column *column;
    int *first;         /* [n_columns + 1] row of so many entries, -1: none */
    int fewest;         /* no row that is left has fewer */
    int *eliminated;    /* [rank] rows in their order */
    int *pivot_of;      /* [n_rows] column, -1: none */
    struct row scratch; /* for n_columns entries */
    struct dalcs_arena arena;
};

static void list_row(struct work *w, int r) {
    struct row *row = &w->row[r];
    int n = row->n;
    row->previous = -1;
    row->next = w->first[n];
    if (row->next >= 0) {
        w->row[row->next].previous = r;
    }
    w->first[n] = r;
    w->fewest = n < w->fewest ? n : w->fewest;
}

static void unlist_row(struct work *w, int r) {
    const struct row *row = &w->row[r];
    if (row->previous >= 0) {
        w->row[row->previous].next = row->next;
    } else {
        w->first[row->n] = row->next;
    }
    if (row->next >= 0) {
        w->row[row->next].previous = row->previous;
    }
}

static enum dalcs_status note_row(struct work *w, int c, int r) {
    struct column *column = &w->column[c];
    if (column->n == column->capacity) {
        int capacity = 2 * column->n + 4;
        int *larger = dalcs_arena_alloc(&w->arena, (size_t)capacity, sizeof(int));
        if (larger == NULL) {
            return DALCS_E_NOMEM;
        }
        if (column->n > 0) {
            memcpy(larger, column->row, (size_t)column->n * sizeof(int));
        }
        column->row = larger;
        column->capacity = capacity;
    }
    column->row[column->n++] = r;
    return DALCS_OK;
}

/* Row r becomes what is in scratch. */
static enum dalcs_status put_row(struct work *w, int r) {
    struct row *row = &w->row[r];
    const struct row *scratch = &w->scratch;
    if (scratch->n > row->capacity) {
        row->capacity = scratch->n + scratch->n / 2;
        row->entry = dalcs_arena_alloc(&w->arena, (size_t)row->capacity, sizeof(*row->entry));
        if (row->entry == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    row->n = scratch->n;
    if (row->n > 0) {
        memcpy(row->entry, scratch->entry, (size_t)row->n * sizeof(*row->entry));
    }
    list_row(w, r);
    return DALCS_OK;
}

static enum dalcs_status load(struct work *w, const struct dalcs_csr *a) {
    for (int r = 0; r < a->n_rows; r++) {
        w->scratch.n = 0;
        for (int k = a->p[r]; k < a->p[r + 1]; k++) {
            long double bound = 0.5L * DBL_EPSILON * fabs(a->x[k]);
            w->scratch.entry[w->scratch.n++] = (struct entry){a->j[k], a->x[k], bound};
            DALCS_TRY(note_row(w, a->j[k], r));
        }
        DALCS_TRY(put_row(w, r));
    }
    return DALCS_OK;
}

static int shortest_row(struct work *w) {
    while (w->first[w->fewest] < 0) {
        w->fewest++;
    }
    return w->first[w->fewest];
}

static const struct entry *find_entry(const struct row *row, int column) {
    for (int k = 0; k < row->n && row->entry[k].column <= column; k++) {
        if (row->entry[k].column == column) {
            return &row->entry[k];
        }
    }
    return NULL;
}

/* In a column, of the rows that are left; r is one of them. */
static long double largest_of(const struct work *w, int r, const struct entry *of) {
    const struct column *column = &w->column[of->column];
    long double largest = fabsl(of->value);
    for (int k = 0; k < column->n; k++) {
        const int other = column->row[k];
        const struct entry *e =
            other != r && w->pivot_of[other] < 0 ? find_entry(&w->row[other], of->column) : NULL;
        largest = e != NULL && fabsl(e->value) > largest ? fabsl(e->value) : largest;
    }
    return largest;
}

/* The largest of its column, as near as the row has it: with less, bounds would grow along a chain. Where there is no
 * other entry there is nothing to look up. */
static struct entry choose_pivot(const struct work *w, int r) {
    const struct row *row = &w->row[r];
    if (row->n == 1) {
        return row->entry[0];
    }
    const struct entry *chosen = row->entry;
    long double best = -1.0L;
    for (int k = 0; k < row->n; k++) {
        const struct entry *e = &row->entry[k];
        const struct column *column = &w->column[e->column];
        long double part = fabsl(e->value) / largest_of(w, r, e);
        if (part > best || (part == best && column->n < w->column[chosen->column].n)) {
            chosen = e;
            best = part;
        }
    }
    return *chosen;
}

/* e -= factor * by; rounding included. */
static void subtract(struct entry *e, const struct entry *by, long double factor,
                     long double relative) {
    long double term = factor * by->value;
    e->bound += fabsl(factor) * by->bound + relative * fabsl(term) +
                LDBL_EPSILON * (fabsl(e->value) + fabsl(term));
    e->value -= term;
}

/* Row r loses its entry in the pivot's column. */
static enum dalcs_status eliminate(struct work *w, int r, const struct row *by,
                                   const struct entry *pivot) {
    struct row *row = &w->row[r];
    const struct entry *out = find_entry(row, pivot->column);
    if (out == NULL) {
        return DALCS_OK;
    }
    long double factor = out->value / pivot->value;
    long double relative = out->bound / fabsl(out->value) + pivot->bound / fabsl(pivot->value);
    unlist_row(w, r);
    w->scratch.n = 0;
    int k = 0;
    int l = 0;
    while (k < row->n || l < by->n) {
        bool is_old = k < row->n && (l == by->n || row->entry[k].column <= by->entry[l].column);
        bool changes = l < by->n && (k == row->n || by->entry[l].column <= row->entry[k].column);
        struct entry e = is_old ? row->entry[k++] : (struct entry){by->entry[l].column, 0.0L, 0.0L};
        if (changes) {
            subtract(&e, &by->entry[l++], factor, relative);
        }
        if (e.column == pivot->column || (changes && fabsl(e.value) <= doubt * e.bound)) {
            continue;
        }
        w->scratch.entry[w->scratch.n++] = e;
        if (!is_old) {
            DALCS_TRY(note_row(w, e.column, r));
        }
    }
    return put_row(w, r);
}

static enum dalcs_status eliminate_all(struct work *w, int n_rows, int *rank) {
    for (int left = n_rows; left > 0; left--) {
        int r = shortest_row(w);
        struct row *row = &w->row[r];
        unlist_row(w, r);
        if (row->n == 0) {
            continue;
        }
        struct entry pivot = choose_pivot(w, r);
        w->pivot_of[r] = pivot.column;
        w->eliminated[(*rank)++] = r;
        const struct column *column = &w->column[pivot.column];
        for (int k = 0; k < column->n; k++) {
            if (w->pivot_of[column->row[k]] < 0) {
                DALCS_TRY(eliminate(w, column->row[k], row, &pivot));
            }
        }
    }
    return DALCS_OK;
}

static void put_entry(struct dalcs_null_space *s, int at, const struct entry *e) {
    s->column[at] = e->column;
    s->value[at] = (double)e->value;
    s->bound[at] = (double)e->bound;
}

static void move_entry(struct dalcs_null_space *s, int from, int to) {
    s->column[to] = s->column[from];
    s->value[to] = s->value[from];
    s->bound[to] = s->bound[from];
}

static enum dalcs_status keep(struct dalcs_null_space *s, const struct work *w) {
    size_t n_entries = 0;
    for (int k = 0; k < s->rank; k++) {
        n_entries += (size_t)w->row[w->eliminated[k]].n;
    }
    s->begin = dalcs_arena_alloc(&s->arena, (size_t)s->rank + 1, sizeof(int));
    s->column = dalcs_arena_alloc(&s->arena, n_entries, sizeof(int));
    s->value = dalcs_arena_alloc(&s->arena, n_entries, sizeof(double));
    s->bound = dalcs_arena_alloc(&s->arena, n_entries, sizeof(double));
    s->error = dalcs_arena_alloc(&s->arena, (size_t)s->n_columns, sizeof(double));
    s->redundant = dalcs_arena_alloc(&s->arena, (size_t)(s->n_rows - s->rank), sizeof(int));
    s->free_column = dalcs_arena_alloc(&s->arena, (size_t)s->n_columns, sizeof(int));
    if (s->begin == NULL || s->column == NULL || s->value == NULL || s->bound == NULL ||
        s->error == NULL || s->redundant == NULL || s->free_column == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int r = 0; r < s->n_rows; r++) {
        if (w->pivot_of[r] < 0) {
            s->redundant[s->n_redundant++] = r;
        }
    }
    int out = 0;
    for (int k = 0; k < s->rank; k++) {
        const struct row *row = &w->row[w->eliminated[k]];
        int first = out;
        for (int i = 0; i < row->n; i++, out++) {
            if (row->entry[i].column == w->pivot_of[w->eliminated[k]]) {
                move_entry(s, first, out);
                put_entry(s, first, &row->entry[i]);
            } else {
                put_entry(s, out, &row->entry[i]);
            }
        }
        s->begin[k + 1] = out;
        s->free_column[s->column[first]] = 1; /* for now: it has a pivot */
    }
    for (int c = 0; c < s->n_columns; c++) {
        if (s->free_column[c] == 0) {
            s->free_column[s->n_free++] = c;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status find(struct dalcs_null_space *s, struct work *w,
                              const struct dalcs_csr *a) {
    size_t n_rows = (size_t)a->n_rows;
    size_t n_columns = (size_t)a->n_columns;
    w->row = dalcs_arena_alloc(&w->arena, n_rows, sizeof(*w->row));
    w->column = dalcs_arena_alloc(&w->arena, n_columns, sizeof(*w->column));
    w->first = dalcs_arena_alloc(&w->arena, n_columns + 1, sizeof(int));
    w->eliminated = dalcs_arena_alloc(&w->arena, n_rows, sizeof(int));
    w->pivot_of = dalcs_arena_alloc(&w->arena, n_rows, sizeof(int));
    w->scratch.entry = dalcs_arena_alloc(&w->arena, n_columns, sizeof(*w->scratch.entry));
    if (w->row == NULL || w->column == NULL || w->first == NULL || w->eliminated == NULL ||
        w->pivot_of == NULL || w->scratch.entry == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k <= a->n_columns; k++) {
        w->first[k] = -1;
    }
    for (int r = 0; r < a->n_rows; r++) {
        w->pivot_of[r] = -1;
    }
    DALCS_TRY(load(w, a));
    DALCS_TRY(eliminate_all(w, a->n_rows, &s->rank));
    return keep(s, w);
}

enum dalcs_status dalcs_null_space_find(struct dalcs_null_space *s, int n_rows, int n_columns,
                                        const struct dalcs_triplets *t) {
    struct work w = {0};
    struct dalcs_csr a;
    *s = (struct dalcs_null_space){.n_rows = n_rows, .n_columns = n_columns};
    DALCS_TRY(dalcs_csr_compress(&a, n_rows, n_columns, t));
    enum dalcs_status status = find(s, &w, &a);
    dalcs_arena_finish(&w.arena);
    dalcs_csr_finish(&a);
    if (status != DALCS_OK) {
        dalcs_null_space_finish(s);
    }
    return status;
}

/* Back substitution with a bound of the error of each sum. */
void dalcs_null_space_vector(const struct dalcs_null_space *s, int k, double *vector) {
    memset(vector, 0, (size_t)s->n_columns * sizeof(*vector));
    memset(s->error, 0, (size_t)s->n_columns * sizeof(*vector));
    vector[s->free_column[k]] = 1.0;
    for (int i = s->rank - 1; i >= 0; i--) {
        double sum = 0.0;
        double error = 0.0;
        const int first = s->begin[i];
        for (int at = first + 1; at < s->begin[i + 1]; at++) {
            const int c = s->column[at];
            const double term = s->value[at] * vector[c];
            sum -= term;
            error += DBL_EPSILON * fabs(term) + s->bound[at] * fabs(vector[c]) +
                     fabs(s->value[at]) * s->error[c];
        }
        const bool is_rounding = fabs(sum) <= (double)doubt * error;
        const double value = is_rounding ? 0.0 : sum / s->value[first];
        error += s->bound[first] * fabs(value);
        vector[s->column[first]] = value;
        s->error[s->column[first]] = is_rounding ? 0.0 : error / fabs(s->value[first]);
    }
    for (int c = 0; c < s->n_columns; c++) {
        s->error[c] *= (double)doubt;
    }
}

void dalcs_null_space_finish(struct dalcs_null_space *s) {
    dalcs_arena_finish(&s->arena);
    *s = (struct dalcs_null_space){0};
}
