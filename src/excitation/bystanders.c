/* bystanders.c - blocks of the equations by union-find, solved once. */
#include "bystanders.h"

#include "extended.h"
#include "union_find.h"

#include <stdlib.h>
#include <string.h>

/* Joins everything that a row of a matrix holds with `to`. */
static void join_row(int *parent, const struct dalcs_csr *a, int row, int to) {
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        dalcs_union_join(parent, a->j[k], to);
    }
}

/* Vertices are columns, then rows; the first state, or else pair, or else control stands for all. */
static void find_blocks(const struct dalcs_system *s, int *parent) {
    int n_equations = dalcs_system_n_equations(s);
    int n_columns = dalcs_system_n_columns(s);
    int involved = n_columns + n_equations;
    dalcs_union_reset(parent, n_columns + n_equations + 1);
    for (int x = 0; x < s->n_x; x++) {
        dalcs_union_join(parent, x, involved);
        dalcs_union_join(parent, n_columns + x, involved);
    }
    for (int r = 0; r < n_equations; r++) {
        join_row(parent, &s->A, r, n_columns + r);
        /* what a source delivers is decided only if its voltage and its current both are */
        dalcs_union_join(parent, s->dual[r], n_columns + r);
    }
    for (int c = 0; c < n_equations; c++) {
        if (s->column[c].kind == DALCS_LABEL_REFERENCE) {
            dalcs_union_join(parent, c, involved); /* that it vanishes is a condition on sources */
        }
    }
    for (int k = 0; k < s->n_smooth; k++) { /* what they read is asked for within a step */
        dalcs_union_join(parent, n_columns + s->smooth[k].row, involved);
        for (int j = 0; j < s->smooth[k].n; j++) {
            if (s->smooth[k].column[j] >= 0) {
                dalcs_union_join(parent, s->smooth[k].column[j], involved);
            }
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        dalcs_union_join(parent, n_equations + d, involved);
        join_row(parent, &s->C, d, involved);
        if (!s->pair[d].is_direct) {
            join_row(parent, &s->control, d, involved);
        }
    }
}

/* gain = -A_bb^-1 E_b for all bystanders together. DALCS_SINGULAR: they are not decided after all. */
static enum dalcs_status solve(struct dalcs_bystanders *b, const struct dalcs_system *s,
                               const int *place) {
    int width = b->n + s->n_inputs;
    long double *a = dalcs_alloc((size_t)b->n * (size_t)width, sizeof(*a));
    if (a == NULL) {
        return DALCS_E_NOMEM;
    }
    int row = 0;
    for (int r = 0; r < dalcs_system_n_equations(s) && row < b->n; r++) {
        if (!b->row[r]) {
            continue;
        }
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            a[row * width + place[s->A.j[k]]] = s->A.x[k];
        }
        for (int k = s->E.p[r]; k < s->E.p[r + 1]; k++) {
            a[row * width + b->n + s->E.j[k]] = -s->E.x[k];
        }
        row++;
    }
    bool solved = row == b->n && dalcs_extended_solve(b->n, s->n_inputs, a, NULL) > 0.0L;
    for (int i = 0; i < b->n && solved; i++) {
        for (int k = 0; k < s->n_inputs; k++) {
            b->gain[i * s->n_inputs + k] = (double)a[i * width + b->n + k];
        }
    }
    free(a);
    return solved ? DALCS_OK : DALCS_SINGULAR;
}

/* More bystanders than this are left where they are: the dense solution would cost more than it
 * saves. */
enum { MOST_BYSTANDERS = 64 };

static enum dalcs_status find(struct dalcs_bystanders *b, const struct dalcs_circuit *circuit,
                              const struct dalcs_system *s, int *parent, int *place) {
    int n_equations = dalcs_system_n_equations(s);
    int n_columns = dalcs_system_n_columns(s);
    find_blocks(s, parent);
    int involved = dalcs_union_find(parent, n_columns + n_equations);
    b->column = dalcs_alloc((size_t)n_columns, sizeof(*b->column));
    b->row = dalcs_alloc((size_t)n_equations, sizeof(*b->row));
    if (b->column == NULL || b->row == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int c = 0; c < n_equations; c++) {
        if (dalcs_union_find(parent, c) != involved) {
            place[c] = b->n;
            b->column[b->n++] = c;
        }
    }
    /* what delayed sources read, whatever it is, has to be known at the nodes of steps */
    if (b->n == 0 || b->n > MOST_BYSTANDERS || circuit->control.n_delayed > 0) {
        return DALCS_SINGULAR;
    }
    for (int r = 0; r < n_equations; r++) {
        b->row[r] = dalcs_union_find(parent, n_columns + r) != involved;
    }
    b->gain = dalcs_alloc((size_t)b->n * (size_t)s->n_inputs, sizeof(*b->gain));
    return b->gain != NULL ? solve(b, s, place) : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_bystanders_find(struct dalcs_bystanders *b,
                                        const struct dalcs_circuit *circuit,
                                        const struct dalcs_system *s) {
    *b = (struct dalcs_bystanders){0};
    size_t n = (size_t)(dalcs_system_n_columns(s) + dalcs_system_n_equations(s)) + 1;
    int *parent = dalcs_alloc(n, sizeof(*parent));
    int *place = dalcs_alloc(n, sizeof(*place));
    enum dalcs_status status = DALCS_E_NOMEM;
    if (parent != NULL && place != NULL) {
        status = find(b, circuit, s, parent, place);
    }
    free(parent);
    free(place);
    if (status == DALCS_SINGULAR) { /* all take part */
        b->n = 0;
        memset(b->row, 0, (size_t)dalcs_system_n_equations(s) * sizeof(*b->row));
        status = DALCS_OK;
    }
    if (status != DALCS_OK) {
        dalcs_bystanders_finish(b);
    }
    return status;
}

void dalcs_bystanders_finish(struct dalcs_bystanders *b) {
    free(b->column);
    free(b->gain);
    free(b->row);
    *b = (struct dalcs_bystanders){0};
}
