/* elimination.c - sparse Gauss-Jordan elimination of the states of a one-step problem.
 *
 * Rows are short growable lists over the columns (x, z, lambda | x_k, s); the right-hand side rides
 * along, so that one elimination gives K, R and the recovery of x+ at once. */
#include "elimination.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int fill_limit = 4096;

/* Entries that a row may get before it moves. */
enum { SPARE = 4 };

static enum dalcs_status push_int(int **array, int *capacity, int n) {
    size_t c = (size_t)*capacity;
    DALCS_TRY(dalcs_grow(array, &c, (size_t)n + 1, sizeof(**array)));
    *capacity = (int)c;
    return DALCS_OK;
}

static enum dalcs_status row_move(struct dalcs_elimination_row *r) {
    size_t n = (size_t)r->n;
    size_t capacity = 2 * n + SPARE;
    double *value = malloc(capacity * (sizeof(*r->value) + sizeof(*r->column)));
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    void *column = value + capacity;
    memcpy(value, r->value, n * sizeof(*r->value));
    memcpy(column, r->column, n * sizeof(*r->column));
    if (r->has_moved) {
        free(r->value);
    }
    *r = (struct dalcs_elimination_row){r->n, (int)capacity, column, value, true};
    return DALCS_OK;
}

static enum dalcs_status row_push(struct dalcs_elimination_row *r, int column, double value) {
    if (r->n == r->capacity) {
        DALCS_TRY(row_move(r));
    }
    r->column[r->n] = column;
    r->value[r->n++] = value;
    return DALCS_OK;
}

double *dalcs_elimination_find(const struct dalcs_elimination_row *r, int column) {
    for (int k = 0; k < r->n; k++) {
        if (r->column[k] == column) {
            return &r->value[k];
        }
    }
    return NULL;
}

static enum dalcs_status note_user(struct dalcs_elimination *e, int column, int row) {
    if (column >= e->s->n_x) {
        return DALCS_OK;
    }
    struct dalcs_elimination_users *u = &e->users[column];
    DALCS_TRY(push_int(&u->row, &u->capacity, u->n));
    u->row[u->n++] = row;
    return DALCS_OK;
}

/* target -= factor * source; the entry of `gone` disappears exactly. */
static enum dalcs_status subtract(struct dalcs_elimination *e, int target, int source, int gone,
                                  double factor) {
    struct dalcs_elimination_row *t = &e->row[target];
    const struct dalcs_elimination_row *s = &e->row[source];
    for (int k = 0; k < t->n; k++) {
        e->where[t->column[k]] = k;
    }
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < s->n && status == DALCS_OK; k++) {
        int column = s->column[k];
        int slot = e->where[column];
        if (slot >= 0) {
            t->value[slot] -= factor * s->value[k];
        } else {
            status = row_push(t, column, -factor * s->value[k]);
            if (status == DALCS_OK) {
                e->where[column] = t->n - 1;
                status = note_user(e, column, target);
            }
        }
    }
    int out = 0;
    for (int k = 0; k < t->n; k++) {
        e->where[t->column[k]] = -1;
        if (t->column[k] != gone && t->value[k] != 0.0) {
            t->column[out] = t->column[k];
            t->value[out++] = t->value[k];
        }
    }
    t->n = out;
    return status;
}

static enum dalcs_status add_entries(struct dalcs_elimination *e, int row,
                                     const struct dalcs_csr *a, int i, int first_column,
                                     double factor) {
    for (int k = a->p[i]; k < a->p[i + 1]; k++) {
        int column = first_column + a->j[k];
        double *present = column < e->s->n_x ? dalcs_elimination_find(&e->row[row], column) : NULL;
        if (present != NULL) {
            *present += factor * a->x[k];
        } else {
            DALCS_TRY(row_push(&e->row[row], column, factor * a->x[k]));
            DALCS_TRY(note_user(e, column, row));
        }
    }
    return DALCS_OK;
}

static int row_length(const struct dalcs_csr *a, int i) {
    return a->p[i + 1] - a->p[i];
}

/* Room for what fill_rows() puts into each row, and a little more. */
static enum dalcs_status make_room(struct dalcs_elimination *e) {
    const struct dalcs_system *s = e->s;
    int n_equations = dalcs_system_n_equations(s);
    size_t all = 0;
    for (int i = 0; i < e->n_rows; i++) {
        int d = i - n_equations;
        int n = d < 0 ? row_length(&s->A, i) + row_length(&s->E, i)
                      : row_length(&s->C, d) + row_length(&s->F, d);
        e->row[i].capacity = n + (i < s->n_x ? 2 * row_length(&s->P, i) : 0) + SPARE;
        all += (size_t)e->row[i].capacity;
    }
    double *value = dalcs_arena_alloc(&e->work, all, sizeof(*value));
    int *column = dalcs_arena_alloc(&e->work, all, sizeof(*column));
    if (value == NULL || column == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < e->n_rows; i++) {
        e->row[i].value = value;
        e->row[i].column = column;
        value += e->row[i].capacity;
        column += e->row[i].capacity;
    }
    return DALCS_OK;
}

/* Row i: (sigma P - A | sigma P, E); pair d: (C | -F). */
static enum dalcs_status fill_rows(struct dalcs_elimination *e, double sigma) {
    const struct dalcs_system *s = e->s;
    int n_equations = dalcs_system_n_equations(s);
    for (int i = 0; i < n_equations; i++) {
        if (i < s->n_x && sigma != 0.0) {
            DALCS_TRY(add_entries(e, i, &s->P, i, 0, sigma));
            DALCS_TRY(add_entries(e, i, &s->P, i, e->n_left, sigma));
        }
        DALCS_TRY(add_entries(e, i, &s->A, i, 0, -1.0));
        DALCS_TRY(add_entries(e, i, &s->E, i, e->n_left + s->n_x, 1.0));
    }
    for (int d = 0; d < s->n_pairs; d++) {
        DALCS_TRY(add_entries(e, n_equations + d, &s->C, d, 0, 1.0));
        DALCS_TRY(add_entries(e, n_equations + d, &s->F, d, e->n_left + s->n_x, -1.0));
    }
    return DALCS_OK;
}

static bool pivot_is_sound(const struct dalcs_elimination *e, int x, int row) {
    const struct dalcs_elimination_row *r = &e->row[row];
    double pivot = 0.0;
    double largest = 0.0;
    int n_left = 0;
    for (int k = 0; k < r->n; k++) {
        if (r->column[k] == x) {
            pivot = fabs(r->value[k]);
        }
        if (r->column[k] < e->n_left) {
            largest = fmax(largest, fabs(r->value[k]));
            n_left++;
        }
    }
    /* A pivot that is smaller beside its row than half of the digits is kept as an unknown: a coil that is nearly a short. */
    return pivot > 0.0 && pivot >= sqrt(DBL_EPSILON) * largest &&
           (long)(n_left - 1) * (e->users[x].n - 1) <= fill_limit;
}

static enum dalcs_status eliminate_states(struct dalcs_elimination *e) {
    for (int x = 0; x < e->s->n_x; x++) {
        int r = e->row_of_dual[x];
        e->pivot_row[x] = -1;
        if (!pivot_is_sound(e, x, r)) {
            continue;
        }
        e->pivot_row[x] = r;
        e->is_pivot[r] = true;
        double pivot = *dalcs_elimination_find(&e->row[r], x);
        for (int k = 0; k < e->users[x].n; k++) {
            int target = e->users[x].row[k];
            const double *entry = target == r ? NULL : dalcs_elimination_find(&e->row[target], x);
            if (entry != NULL) {
                DALCS_TRY(subtract(e, target, r, x, *entry / pivot));
            }
        }
    }
    return DALCS_OK;
}

static enum dalcs_status set_up(struct dalcs_elimination *e, const struct dalcs_system *s) {
    int n_equations = dalcs_system_n_equations(s);
    *e = (struct dalcs_elimination){
        .s = s, .n_rows = n_equations + s->n_pairs, .n_left = dalcs_system_n_columns(s)};
    size_t n_all = (size_t)(e->n_left + s->n_x + s->n_inputs);
    size_t n_rows = (size_t)e->n_rows;
    size_t n_x = (size_t)s->n_x;
    e->row = dalcs_arena_alloc(&e->work, n_rows, sizeof(*e->row));
    e->users = dalcs_arena_alloc(&e->work, n_x, sizeof(*e->users));
    e->where = dalcs_arena_alloc(&e->work, n_all, sizeof(*e->where));
    e->pivot_row = dalcs_arena_alloc(&e->work, n_x, sizeof(*e->pivot_row));
    e->is_pivot = dalcs_arena_alloc(&e->work, n_rows, sizeof(*e->is_pivot));
    e->row_of_dual = dalcs_arena_alloc(&e->work, (size_t)n_equations, sizeof(*e->row_of_dual));
    if (e->row == NULL || e->users == NULL || e->where == NULL || e->pivot_row == NULL ||
        e->is_pivot == NULL || e->row_of_dual == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n_all; k++) {
        e->where[k] = -1;
    }
    for (int i = 0; i < n_equations; i++) {
        e->row_of_dual[s->dual[i]] = i;
    }
    return make_room(e);
}

enum dalcs_status dalcs_elimination_run(struct dalcs_elimination *e,
                                        const struct dalcs_system *system, double sigma) {
    DALCS_TRY(set_up(e, system));
    DALCS_TRY(fill_rows(e, sigma));
    return eliminate_states(e);
}

void dalcs_elimination_finish(struct dalcs_elimination *e) {
    for (int i = 0; e->row != NULL && i < e->n_rows; i++) {
        if (e->row[i].has_moved) {
            free(e->row[i].value);
        }
    }
    for (int x = 0; e->users != NULL && x < e->s->n_x; x++) {
        free(e->users[x].row);
    }
    dalcs_arena_finish(&e->work);
}
