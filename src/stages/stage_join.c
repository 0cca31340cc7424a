/* stage_join.c - finds nodes behind one resistor, and adds their rows to those of the nodes before it. */
#include "stage_join.h"

#include "rounding.h"

#include <math.h>
#include <stdlib.h>

/* Equations without states between currents. */
static bool is_law(const struct dalcs_system *s, int r) {
    return r >= s->n_x && s->row_is_current[r];
}

static double entry_of(const struct dalcs_csr *a, int r, int column) {
    for (int k = a->p[r]; k < a->p[r + 1]; k++) {
        if (a->j[k] == column) {
            return a->x[k];
        }
    }
    return 0.0;
}

/* The laws that a voltage is in: the first two. */
struct laws {
    int n, row[2];
};

static void list_laws(const struct dalcs_system *s, struct laws *of_column) {
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        for (int k = s->A.p[r]; s->row_is_current[r] && k < s->A.p[r + 1]; k++) {
            struct laws *laws = &of_column[s->A.j[k]];
            if (laws->n < 2) {
                laws->row[laws->n] = r;
            }
            laws->n++;
        }
    }
}

/* The law of the node before the resistor, if r is that of a node behind one: it has two voltages, and one of
 * them, its own, is in no third law. -1: it is none. */
static int node_before(const struct dalcs_system *s, const struct laws *of_column, int r) {
    int column[2];
    int n_voltages = 0;
    for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
        int c = s->A.j[k];
        if (c < dalcs_system_n_equations(s) && !s->column_is_current[c] && s->A.x[k] != 0.0) {
            column[n_voltages < 2 ? n_voltages : 0] = c;
            n_voltages++;
        }
    }
    for (int i = 0; i < 2 && n_voltages == 2; i++) {
        const struct laws *laws = &of_column[column[i]];
        int other = laws->n == 2 ? laws->row[laws->row[0] == r ? 1 : 0] : -1;
        double own = entry_of(&s->A, r, column[i]);
        if (other >= 0 && is_law(s, other) && entry_of(&s->A, other, column[i]) == -own) {
            return other;
        }
    }
    return -1;
}

static void find(const struct dalcs_system *s, const struct laws *of_column,
                 struct dalcs_stage_join *join, bool *is_joined) {
    for (int r = s->n_x; r < dalcs_system_n_equations(s); r++) {
        int before = is_law(s, r) && join->other[r] < 0 ? node_before(s, of_column, r) : -1;
        if (before >= 0 && !is_joined[before]) {
            is_joined[r] = true;
            join->next[r] = join->other[before];
            join->other[before] = r;
        }
    }
}

enum dalcs_status dalcs_stage_join_find(struct dalcs_stage_join *join,
                                        const struct dalcs_system *s) {
    size_t n = (size_t)dalcs_system_n_equations(s);
    struct laws *of_column = dalcs_alloc((size_t)dalcs_system_n_columns(s), sizeof(*of_column));
    bool *is_joined = dalcs_alloc(n, sizeof(*is_joined));
    join->other = dalcs_alloc(n, sizeof(*join->other));
    join->next = dalcs_alloc(n, sizeof(*join->next));
    enum dalcs_status status = DALCS_E_NOMEM;
    if (of_column != NULL && is_joined != NULL && join->other != NULL && join->next != NULL) {
        for (size_t r = 0; r < n; r++) {
            join->other[r] = join->next[r] = -1;
        }
        list_laws(s, of_column);
        find(s, of_column, join, is_joined);
        status = DALCS_OK;
    }
    free(of_column);
    free(is_joined);
    return status;
}

void dalcs_stage_join_finish(struct dalcs_stage_join *join) {
    free(join->other);
    free(join->next);
    *join = (struct dalcs_stage_join){0};
}

enum dalcs_status dalcs_stage_join_row(const struct dalcs_stage_join *join,
                                       const struct dalcs_system *s, int r, double factor,
                                       double *work, struct dalcs_triplets *t) {
    double *value = work;
    double *size = work + dalcs_system_n_columns(s);
    for (int f = r; f >= 0; f = dalcs_stage_join_after(join, r, f)) {
        for (int k = s->A.p[f]; k < s->A.p[f + 1]; k++) {
            value[s->A.j[k]] += s->A.x[k];
            size[s->A.j[k]] += fabs(s->A.x[k]);
        }
    }
    enum dalcs_status status = DALCS_OK;
    for (int f = r; f >= 0; f = dalcs_stage_join_after(join, r, f)) {
        for (int k = s->A.p[f]; k < s->A.p[f + 1]; k++) {
            int c = s->A.j[k];
            bool is_left = fabs(value[c]) > dalcs_rounded * size[c];
            if (is_left && status == DALCS_OK) {
                status = dalcs_triplets_add(t, c, r, factor * value[c]);
            }
            value[c] = 0.0;
            size[c] = 0.0;
        }
    }
    return status;
}
