/* step_form.c - condensing the OSNSP: sparse Gauss-Jordan elimination of the states, then balancing.
 *
 * Rows are short growable lists over the columns (x, z, lambda | x_k, s); the right-hand side rides
 * along, so that one elimination gives K, R and the recovery of x+ at once. */
#include "step_form.h"

#include "extremes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A pivot this much smaller than its row is kept as an unknown: a coil that is nearly a short. */
static const double pivot_floor = 1e-8;
static const int fill_limit = 4096;

/* How far a scale of one unit reaches into the other, as a part of the typical conductance: a voltage
 * next to a large one is known no better than to its own rounding, whose current may spread where
 * conductances are small. */
static const double cross_floor = 1e-3;

/* Entries that a row may get before it moves. */
enum { SPARE = 4 };

struct row {
    int n, capacity;
    int *column;
    double *value;
    bool
        has_moved; /* from the room that all rows have together to one of its own: that of value and column */
};

struct column_rows {
    int n, capacity;
    int *row;
};

struct elimination {
    const struct dalcs_system *s;
    int n_rows; /* equations, then pairs */
    int n_left; /* columns of the system; the right-hand side follows */
    struct row *row;
    void *room;                /* of the rows as they begin, and a little more */
    struct column_rows *users; /* [n_x] rows that hold an x column (or once did) */
    int *where;                /* [all columns] slot in the row being changed, else -1 */
    int *pivot_row;            /* [n_x], -1 if kept */
    bool *is_pivot;            /* [n_rows] */
    int *row_of_dual;          /* [n_equations] */
    int *reduced;              /* [n_left] the unknown that a column is, once that is known */
    struct dalcs_arena work;   /* all of them */
};

static enum dalcs_status push_int(int **array, int *capacity, int n) {
    size_t c = (size_t)*capacity;
    DALCS_TRY(dalcs_grow(array, &c, (size_t)n + 1, sizeof(**array)));
    *capacity = (int)c;
    return DALCS_OK;
}

static enum dalcs_status row_move(struct row *r) {
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
    *r = (struct row){r->n, (int)capacity, column, value, true};
    return DALCS_OK;
}

static enum dalcs_status row_push(struct row *r, int column, double value) {
    if (r->n == r->capacity) {
        DALCS_TRY(row_move(r));
    }
    r->column[r->n] = column;
    r->value[r->n++] = value;
    return DALCS_OK;
}

static double *row_find(const struct row *r, int column) {
    for (int k = 0; k < r->n; k++) {
        if (r->column[k] == column) {
            return &r->value[k];
        }
    }
    return NULL;
}

static enum dalcs_status note_user(struct elimination *e, int column, int row) {
    if (column >= e->s->n_x) {
        return DALCS_OK;
    }
    struct column_rows *u = &e->users[column];
    DALCS_TRY(push_int(&u->row, &u->capacity, u->n));
    u->row[u->n++] = row;
    return DALCS_OK;
}

/* target -= factor * source; the entry of `gone` disappears exactly. */
static enum dalcs_status subtract(struct elimination *e, int target, int source, int gone,
                                  double factor) {
    struct row *t = &e->row[target];
    const struct row *s = &e->row[source];
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

static enum dalcs_status add_entries(struct elimination *e, int row, const struct dalcs_csr *a,
                                     int i, int first_column, double factor) {
    for (int k = a->p[i]; k < a->p[i + 1]; k++) {
        int column = first_column + a->j[k];
        double *present = column < e->s->n_x ? row_find(&e->row[row], column) : NULL;
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

/* Room for what fill_rows() puts into each row, all in one piece. */
static enum dalcs_status make_room(struct elimination *e) {
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
    double *value = malloc((all > 0 ? all : 1) * (sizeof(double) + sizeof(int)));
    e->room = value;
    if (value == NULL) {
        return DALCS_E_NOMEM;
    }
    int *column = (void *)(value + all);
    for (int i = 0; i < e->n_rows; i++) {
        e->row[i].value = value;
        e->row[i].column = column;
        value += e->row[i].capacity;
        column += e->row[i].capacity;
    }
    return DALCS_OK;
}

/* Row i: (sigma P - A | sigma P, E); pair d: (C | -F). */
static enum dalcs_status fill_rows(struct elimination *e, double sigma) {
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

static bool pivot_is_sound(const struct elimination *e, int x, int row) {
    const struct row *r = &e->row[row];
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
    return pivot > 0.0 && pivot >= pivot_floor * largest &&
           (long)(n_left - 1) * (e->users[x].n - 1) <= fill_limit;
}

static enum dalcs_status eliminate_states(struct elimination *e) {
    for (int x = 0; x < e->s->n_x; x++) {
        int r = e->row_of_dual[x];
        e->pivot_row[x] = -1;
        if (!pivot_is_sound(e, x, r)) {
            continue;
        }
        e->pivot_row[x] = r;
        e->is_pivot[r] = true;
        double pivot = *row_find(&e->row[r], x);
        for (int k = 0; k < e->users[x].n; k++) {
            int target = e->users[x].row[k];
            const double *entry = target == r ? NULL : row_find(&e->row[target], x);
            if (entry != NULL) {
                DALCS_TRY(subtract(e, target, r, x, *entry / pivot));
            }
        }
    }
    return DALCS_OK;
}

/* By half the powers of 2 in the largest entry. False: there are none. */
static bool lower_scale(double *scale, double largest) {
    int powers = largest > 0.0 ? (int)lrint(0.5 * log2(largest)) : 0;
    if (powers != 0) {
        *scale = ldexp(*scale, -powers);
    }
    return powers != 0;
}

/* Equilibration by powers of 2 (Ruiz 2001): exact, and it makes a conductance of 1e9 S next to one of
 * 1e-12 S, or volts next to amperes, look alike to KLU's pivoting and to rcond. Rows and columns
 * have their own scales: the KCL of a floating group of capacitors, summed over the group, has none
 * of the large companion conductances that its voltages see elsewhere. */
static enum dalcs_status balance(struct dalcs_step_form *f, struct elimination *e) {
    int n = f->n + f->n_pairs;
    double *largest = dalcs_arena_alloc(&e->work, 2 * (size_t)n, sizeof(*largest));
    if (largest == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < n; i++) {
        f->scale[i] = 1.0;
        f->row_scale[i] = 1.0;
    }
    bool changed = true;
    for (int pass = 0; pass < 8 && changed; pass++) {
        changed = false;
        memset(largest, 0, 2 * (size_t)n * sizeof(*largest));
        for (int c = 0; c < n; c++) {
            for (int k = f->K.p[c]; k < f->K.p[c + 1]; k++) {
                int r = f->K.j[k];
                double a = fabs(f->K.x[k]) * f->scale[c] * f->row_scale[r];
                largest[c] = dalcs_larger(largest[c], a);
                largest[n + r] = dalcs_larger(largest[n + r], a);
            }
        }
        for (int i = 0; i < n; i++) {
            changed = lower_scale(&f->scale[i], largest[i]) || changed;
            changed = lower_scale(&f->row_scale[i], largest[n + i]) || changed;
        }
    }
    double sum = 0.0;
    for (int d = 0; d < f->n_pairs; d++) {
        sum += log2(f->scale[f->n + d]) + log2(f->row_scale[f->n + d]);
    }
    f->pair_conductance = f->n_pairs > 0 ? exp2(rint(sum / f->n_pairs)) : 1.0;
    for (int c = 0; c < n; c++) {
        for (int k = f->K.p[c]; k < f->K.p[c + 1]; k++) {
            f->K.x[k] *= f->scale[c] * f->row_scale[f->K.j[k]];
        }
        for (int k = f->R.p[c]; k < f->R.p[c + 1]; k++) {
            f->R.x[k] *= f->row_scale[c];
        }
    }
    for (int d = 0; d < f->n_pairs; d++) {
        for (int k = f->W.p[d]; k < f->W.p[d + 1]; k++) {
            f->W.x[k] *= f->row_scale[f->n + d] * f->scale[f->W.j[k]];
        }
    }
    return DALCS_OK;
}

struct conductances {
    double least, most, log_sum;
    int n;
};

/* A coefficient of a voltage in a row of currents is a conductance, the other way round a
 * resistance. */
static void see_conductance(struct conductances *g, bool row_is_current, bool column_is_current,
                            double a) {
    if (row_is_current != column_is_current && a > 0.0) {
        double conductance = row_is_current ? a : 1.0 / a;
        g->least = g->n == 0 ? conductance : fmin(g->least, conductance);
        g->most = fmax(g->most, conductance);
        g->log_sum += log(conductance);
        g->n++;
    }
}

/* The norm of every row of the system over voltages and over currents, and how far a voltage counts
 * as a current. */
static void measure_rows(struct dalcs_step_form *f, const struct dalcs_system *s) {
    int n_equations = dalcs_system_n_equations(s);
    struct conductances g = {0};
    for (int r = 0; r < n_equations; r++) {
        double *norm[2] = {&f->row_volts[r], &f->row_amperes[r]};
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            bool is_current = s->column_is_current[s->A.j[k]];
            *norm[is_current] += fabs(s->A.x[k]);
            see_conductance(&g, s->row_is_current[r], is_current, fabs(s->A.x[k]));
        }
        for (int k = r < s->n_x ? s->P.p[r] : 0; r < s->n_x && k < s->P.p[r + 1]; k++) {
            bool is_current = s->column_is_current[s->P.j[k]];
            *norm[is_current] += f->sigma * fabs(s->P.x[k]);
            see_conductance(&g, s->row_is_current[r], is_current, f->sigma * fabs(s->P.x[k]));
        }
    }
    for (int k = 0; k < s->C.p[s->n_pairs]; k++) {
        see_conductance(&g, false, s->column_is_current[s->C.j[k]], fabs(s->C.x[k]));
    }
    double typical = g.n > 0 ? exp(g.log_sum / g.n) : 1.0;
    f->least_conductance = g.n > 0 ? g.least : 1.0;
    f->most_conductance = g.n > 0 ? g.most : 1.0;
    f->volt_in_amperes = cross_floor * typical;
    f->ampere_in_volts = cross_floor / typical;
}

/* What was collected becomes *a, and t is empty again. */
static enum dalcs_status compress(struct dalcs_csr *a, int n_rows, int n_columns,
                                  struct dalcs_triplets *t) {
    DALCS_TRY(dalcs_csr_compress(a, n_rows, n_columns, t));
    t->n = 0;
    return DALCS_OK;
}

static enum dalcs_status copy_row(struct dalcs_triplets *t, int row, const struct dalcs_csr *a,
                                  int i, int first_column, double sign) {
    for (int k = a->p[i]; k < a->p[i + 1]; k++) {
        DALCS_TRY(dalcs_triplets_add(t, row, first_column + a->j[k], sign * a->x[k]));
    }
    return DALCS_OK;
}

/* The rows that a certificate evaluates, in one matrix: its loop is a good part of a step. */
static enum dalcs_status gather_checked_rows(struct dalcs_step_form *f,
                                             const struct dalcs_system *s,
                                             struct dalcs_triplets *t) {
    int n_columns = dalcs_system_n_columns(s);
    for (int i = 0; i < f->n_checked; i++) {
        int r = f->checked[i];
        if (r < s->n_x) {
            DALCS_TRY(copy_row(t, i, &s->P, r, 0, -1.0));
        }
        DALCS_TRY(copy_row(t, i, &s->A, r, s->n_x, 1.0));
        DALCS_TRY(copy_row(t, i, &s->E, r, s->n_x + n_columns, 1.0));
    }
    return compress(&f->check, f->n_checked, s->n_x + n_columns + s->n_inputs, t);
}

/* x = v(a) - v(b) with unit coefficients leaves nothing to check: evaluating the row again would repeat
 * the very same subtraction. */
static bool is_definition(const struct elimination *e, int i) {
    const struct dalcs_csr *A = &e->s->A;
    bool defines = e->is_pivot[i] && i >= e->s->n_x && A->p[i + 1] - A->p[i] <= 3;
    for (int k = A->p[i]; k < A->p[i + 1]; k++) {
        defines = defines && fabs(A->x[k]) == 1.0;
    }
    for (int k = 0; k < e->row[i].n; k++) {
        defines = defines && e->row[i].column[k] < e->n_left;
    }
    return defines;
}

static enum dalcs_status make_room_for_form(struct dalcs_step_form *f,
                                            const struct elimination *e) {
    size_t n_equations = (size_t)dalcs_system_n_equations(e->s);
    f->column_of = dalcs_arena_alloc(&f->arena, n_equations, sizeof(*f->column_of));
    f->checked = dalcs_arena_alloc(&f->arena, n_equations, sizeof(*f->checked));
    f->scale = dalcs_arena_alloc(&f->arena, (size_t)e->n_rows, sizeof(*f->scale));
    f->row_scale = dalcs_arena_alloc(&f->arena, (size_t)e->n_rows, sizeof(*f->row_scale));
    f->row_volts = dalcs_arena_alloc(&f->arena, n_equations, sizeof(*f->row_volts));
    f->row_amperes = dalcs_arena_alloc(&f->arena, n_equations, sizeof(*f->row_amperes));
    f->x_ends = dalcs_arena_alloc(&f->arena, 2 * (size_t)e->s->n_x, sizeof(*f->x_ends));
    bool complete = f->column_of != NULL && f->checked != NULL && f->scale != NULL &&
                    f->row_scale != NULL && f->row_volts != NULL && f->row_amperes != NULL &&
                    f->x_ends != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

/* Numbers what is left. */
static void number_unknowns(struct dalcs_step_form *f, struct elimination *e) {
    const struct dalcs_system *s = e->s;
    int n_equations = dalcs_system_n_equations(s);
    for (int c = s->n_x; c < n_equations; c++) {
        f->column_of[f->n++] = c;
    }
    for (int x = 0; x < s->n_x; x++) {
        if (e->pivot_row[x] < 0) {
            f->column_of[f->n++] = x;
        }
    }
    for (int i = 0; i < f->n; i++) {
        e->reduced[f->column_of[i]] = i;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        e->reduced[n_equations + d] = f->n + d;
    }
}

/* Row i of what is left. */
static const struct row *row_left(const struct dalcs_step_form *f, const struct elimination *e,
                                  int i) {
    return &e->row[i < f->n ? e->row_of_dual[f->column_of[i]]
                            : dalcs_system_n_equations(e->s) + i - f->n];
}

static enum dalcs_status collect_K(struct dalcs_step_form *f, const struct elimination *e,
                                   struct dalcs_triplets *t) {
    int n = f->n + f->n_pairs;
    for (int i = 0; i < n; i++) {
        const struct row *r = row_left(f, e, i);
        for (int k = 0; k < r->n; k++) {
            if (r->column[k] < e->n_left) {
                DALCS_TRY(dalcs_triplets_add(t, e->reduced[r->column[k]], i, r->value[k]));
            }
        }
    }
    return compress(&f->K, n, n, t);
}

static enum dalcs_status collect_W(struct dalcs_step_form *f, const struct elimination *e,
                                   struct dalcs_triplets *t) {
    for (int d = 0; d < f->n_pairs; d++) {
        const struct row *r = row_left(f, e, f->n + d);
        for (int k = 0; k < r->n; k++) {
            if (r->column[k] < e->n_left) {
                DALCS_TRY(dalcs_triplets_add(t, d, e->reduced[r->column[k]], r->value[k]));
            }
        }
    }
    return compress(&f->W, f->n_pairs, f->n + f->n_pairs, t);
}

static enum dalcs_status collect_R(struct dalcs_step_form *f, const struct elimination *e,
                                   struct dalcs_triplets *t) {
    int n = f->n + f->n_pairs;
    for (int i = 0; i < n; i++) {
        const struct row *r = row_left(f, e, i);
        for (int k = 0; k < r->n; k++) {
            if (r->column[k] >= e->n_left) {
                DALCS_TRY(dalcs_triplets_add(t, i, r->column[k] - e->n_left, r->value[k]));
            }
        }
    }
    return compress(&f->R, n, f->n_u, t);
}

static enum dalcs_status collect_X(struct dalcs_step_form *f, const struct elimination *e,
                                   struct dalcs_triplets *t) {
    for (int x = 0; x < e->s->n_x; x++) {
        if (e->pivot_row[x] < 0) {
            DALCS_TRY(dalcs_triplets_add(t, x, x, 1.0));
            continue;
        }
        const struct row *r = &e->row[e->pivot_row[x]];
        double pivot = *row_find(r, x);
        for (int k = 0; k < r->n; k++) {
            if (r->column[k] < e->n_left && r->column[k] != x) {
                DALCS_TRY(dalcs_triplets_add(t, x, r->column[k], -r->value[k] / pivot));
            }
        }
    }
    return compress(&f->X, e->s->n_x, e->n_left, t);
}

static enum dalcs_status collect_Xu(struct dalcs_step_form *f, const struct elimination *e,
                                    struct dalcs_triplets *t) {
    for (int x = 0; x < e->s->n_x; x++) {
        const struct row *r = e->pivot_row[x] < 0 ? NULL : &e->row[e->pivot_row[x]];
        for (int k = 0; r != NULL && k < r->n; k++) {
            if (r->column[k] >= e->n_left) {
                DALCS_TRY(dalcs_triplets_add(t, x, r->column[k] - e->n_left,
                                             r->value[k] / *row_find(r, x)));
            }
        }
    }
    return compress(&f->Xu, e->s->n_x, f->n_u, t);
}

/* Splits the rows into K, R, X and Xu. */
static enum dalcs_status collect_all(struct dalcs_step_form *f, struct elimination *e,
                                     struct dalcs_triplets *t) {
    const struct dalcs_system *s = e->s;
    DALCS_TRY(make_room_for_form(f, e));
    number_unknowns(f, e);
    DALCS_TRY(collect_K(f, e, t));
    DALCS_TRY(collect_W(f, e, t));
    DALCS_TRY(collect_R(f, e, t));
    DALCS_TRY(collect_X(f, e, t));
    DALCS_TRY(collect_Xu(f, e, t));
    for (int x = 0; x < s->n_x; x++) {
        dalcs_csr_row_difference(&f->X, x, &f->x_ends[2 * x]);
        if (f->Xu.p[x] != f->Xu.p[x + 1]) {
            f->x_ends[2 * x] = -1;
        }
    }
    for (int i = 0; i < dalcs_system_n_equations(s); i++) {
        if (!is_definition(e, i)) {
            f->checked[f->n_checked++] = i;
        }
    }
    DALCS_TRY(gather_checked_rows(f, s, t));
    measure_rows(f, s);
    return balance(f, e);
}

static enum dalcs_status collect(struct dalcs_step_form *f, struct elimination *e) {
    struct dalcs_triplets t = {0};
    enum dalcs_status status = collect_all(f, e, &t);
    dalcs_triplets_finish(&t);
    return status;
}

static void elimination_finish(struct elimination *e) {
    for (int i = 0; e->row != NULL && i < e->n_rows; i++) {
        if (e->row[i].has_moved) {
            free(e->row[i].value);
        }
    }
    free(e->room);
    for (int x = 0; e->users != NULL && x < e->s->n_x; x++) {
        free(e->users[x].row);
    }
    dalcs_arena_finish(&e->work);
}

static enum dalcs_status elimination_setup(struct elimination *e, const struct dalcs_system *s) {
    int n_equations = dalcs_system_n_equations(s);
    *e = (struct elimination){
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
    e->reduced = dalcs_arena_alloc(&e->work, (size_t)e->n_left, sizeof(*e->reduced));
    if (e->row == NULL || e->users == NULL || e->where == NULL || e->pivot_row == NULL ||
        e->is_pivot == NULL || e->row_of_dual == NULL || e->reduced == NULL) {
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

static enum dalcs_status build(struct dalcs_step_form *form, struct elimination *e) {
    DALCS_TRY(elimination_setup(e, e->s));
    DALCS_TRY(fill_rows(e, form->sigma));
    DALCS_TRY(eliminate_states(e));
    return collect(form, e);
}

enum dalcs_status dalcs_step_form_build(struct dalcs_step_form *form,
                                        const struct dalcs_system *system, double sigma) {
    *form = (struct dalcs_step_form){
        .sigma = sigma, .n_pairs = system->n_pairs, .n_u = system->n_x + system->n_inputs};
    struct elimination e = {.s = system};
    enum dalcs_status status = build(form, &e);
    elimination_finish(&e);
    if (status != DALCS_OK) {
        dalcs_step_form_finish(form);
    }
    return status;
}

void dalcs_step_form_finish(struct dalcs_step_form *form) {
    dalcs_arena_finish(&form->arena);
    dalcs_csr_finish(&form->K);
    dalcs_csr_finish(&form->check);
    dalcs_csr_finish(&form->W);
    dalcs_csr_finish(&form->R);
    dalcs_csr_finish(&form->X);
    dalcs_csr_finish(&form->Xu);
    *form = (struct dalcs_step_form){0};
}
