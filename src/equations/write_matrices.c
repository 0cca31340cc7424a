/* write_matrices.c - the blocks of a system: entries on cards, in JSON, or as Matrix Market files. */
#include "card_writer.h"

#include <stdlib.h>

/* Rows first_row.. and columns first_column.. of a matrix. */
struct view {
    const struct dalcs_csr *a;
    int first_row, n_rows, first_column, n_columns;
    const struct dalcs_csr *rest; /* of its sums, beyond their digits; NULL: there is none */
};

/* A row of the matrix, then that of its rest: entries that are repeated add up. */
struct row_of_view {
    const struct dalcs_csr *a;
    int row; /* of the view, from 1 on */
    int k, end;
};

static int next_entry(const struct view *v, struct row_of_view *at) {
    while (at->k < at->end) {
        const int j = at->a->j[at->k++] - v->first_column;
        if (j >= 0 && j < v->n_columns) {
            return j;
        }
    }
    return -1;
}

static struct row_of_view row_at(const struct view *v, int i) {
    const struct dalcs_csr *a = i < v->n_rows ? v->a : v->rest;
    const int row = i % v->n_rows;
    const int from = v->first_row + row;
    return (struct row_of_view){a, row + 1, a->p[from], a->p[from + 1]};
}

static int n_rows_of(const struct view *v) {
    return v->rest != NULL && v->rest->p != NULL ? 2 * v->n_rows : v->n_rows;
}

static int count_entries(const struct view *v) {
    int n = 0;
    for (int i = 0; i < n_rows_of(v); i++) {
        struct row_of_view at = row_at(v, i);
        while (next_entry(v, &at) >= 0) {
            n++;
        }
    }
    return n;
}

static void list_entries(FILE *f, const struct view *v, const char *before, const char *after) {
    for (int i = 0; i < n_rows_of(v); i++) {
        struct row_of_view at = row_at(v, i);
        for (int j = next_entry(v, &at); j >= 0; j = next_entry(v, &at)) {
            fprintf(f, "%s%d %d ", before, at.row, j + 1);
            dalcs_write_number(f, at.a->x[at.k - 1]);
            fputs(after, f);
        }
    }
}

static void list_json(FILE *f, const struct view *v) {
    static const char *const key[] = {"row", "column", "value"};
    fprintf(f, "{\"rows\": %d, \"columns\": %d", v->n_rows, v->n_columns);
    for (int part = 0; part < 3; part++) {
        bool first = true;
        fprintf(f, ", \"%s\": [", key[part]);
        for (int i = 0; i < n_rows_of(v); i++) {
            struct row_of_view at = row_at(v, i);
            for (int j = next_entry(v, &at); j >= 0; j = next_entry(v, &at)) {
                fputs(first ? "" : ", ", f);
                first = false;
                if (part < 2) {
                    fprintf(f, "%d", part == 0 ? at.row : j + 1);
                } else {
                    dalcs_write_number(f, at.a->x[at.k - 1]);
                }
            }
        }
        fputc(']', f);
    }
    fputc('}', f);
}

/* A file of its own. */
static void put_market(struct dalcs_card_writer *w, const char *name, const struct view *v, int n) {
    char suffix[64];
    char *text = NULL;
    size_t length;
    if (w->n_matrices++ == 0) { /* no two of a set have the same name */
        snprintf(suffix, sizeof suffix, ".%s.mtx", name);
    } else {
        snprintf(suffix, sizeof suffix, ".%d.%s.mtx", w->n_matrices, name);
    }
    FILE *f = open_memstream(&text, &length);
    if (f == NULL) {
        w->status = DALCS_E_NOMEM;
        return;
    }
    fprintf(f, "%%%%MatrixMarket matrix coordinate real general\n%d %d %d\n", v->n_rows,
            v->n_columns, n);
    list_entries(f, v, "", "\n");
    bool lost = ferror(f) != 0;
    lost = fclose(f) != 0 || lost || text == NULL;
    if (lost) {
        w->status = DALCS_E_NOMEM;
    } else if (w->status == DALCS_OK) {
        w->status = w->files->file(w->files->user, suffix, text, length);
    }
    free(text);
    fprintf(w->out, "matrix %s \"%s%s\"\n", name, w->files->stem, suffix);
}

static void put_matrix(struct dalcs_card_writer *w, const char *name, const struct view *v) {
    int n = v->n_rows > 0 && v->n_columns > 0 ? count_entries(v) : 0;
    bool is_default = n == 0; /* what is not written is 0 */
    if (is_default) {
        return;
    }
    if (w->format == DALCS_AS_MATRIX_MARKET) {
        put_market(w, name, v, n);
    } else if (w->format == DALCS_AS_JSON) {
        fprintf(w->out, "%s\n\"%s\": ", w->first ? "" : ",", name);
        w->first = false;
        list_json(w->out, v);
    } else {
        fprintf(w->out, "matrix %s sparse\n", name);
        list_entries(w->out, v, "+ ", "\n");
    }
}

void dalcs_card_matrices(struct dalcs_card_writer *w, const struct dalcs_system *s) {
    const int x = s->n_x;
    const int z = s->n_z;
    const int m = s->n_pairs;
    const int u = s->n_inputs - 1;

    const struct {
        const char *name;
        struct view view;
    } block[] = {
        {"P", {&s->P, 0, x, 0, x, NULL}},
        {"A_I", {&s->A, 0, x, 0, x, &s->A_rest}},
        {"B_I", {&s->A, 0, x, x, z, &s->A_rest}},
        {"Bbar_I", {&s->A, 0, x, x + z, m, &s->A_rest}},
        {"E_I", {&s->E, 0, x, 1, u, NULL}},
        {"constant_I", {&s->E, 0, x, 0, 1, NULL}},
        {"A_II", {&s->A, x, z, 0, x, &s->A_rest}},
        {"B_II", {&s->A, x, z, x, z, &s->A_rest}},
        {"Bbar_II", {&s->A, x, z, x + z, m, &s->A_rest}},
        {"E_II", {&s->E, x, z, 1, u, NULL}},
        {"constant_II", {&s->E, x, z, 0, 1, NULL}},
        {"C_I", {&s->C, 0, m, 0, x, NULL}},
        {"C_II", {&s->C, 0, m, x, z, NULL}},
        {"D", {&s->C, 0, m, x + z, m, NULL}},
        {"F", {&s->F, 0, m, 1, u, NULL}},
        {"constant_F", {&s->F, 0, m, 0, 1, NULL}},
        {"storage", {&s->storage, 0, x, 0, x, NULL}},
        {"control", {&s->control, 0, m, 0, x + z + m, NULL}},
        {"direct_control", {&s->direct_control, 0, m, 1, u, NULL}},
    };

    for (size_t k = 0; k < sizeof block / sizeof *block; k++) {
        put_matrix(w, block[k].name, &block[k].view);
    }
}
