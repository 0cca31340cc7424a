/* matrices.c - a session from a program's own matrices: they become the text of a system file, so that one
 * reader checks both. */
#include "session_internal.h"

#include "equations.h"

#include <math.h>
#include <stdlib.h>

static void write_names(FILE *f, const char *word, char letter, size_t n, const char *const *name,
                        const double *value) {
    for (size_t k = 0; k < n; k++) {
        fprintf(f, "%s ", word);
        if (name != NULL) {
            dalcs_write_name(f, name[k]);
        } else {
            fprintf(f, "%c%zu", letter, k + 1);
        }
        if (value != NULL) {
            fputc(' ', f);
            dalcs_write_number(f, value[k]);
        }
        fputc('\n', f);
    }
}

static void write_bound(FILE *f, double bound) {
    fputc(' ', f);
    if (isfinite(bound)) {
        dalcs_write_number(f, bound);
    } else {
        fputs(bound > 0.0 ? "inf" : "-inf", f);
    }
}

static void write_matrix(FILE *f, const char *name, const double *a, size_t n_rows,
                         size_t n_columns) {
    if (a == NULL || n_rows == 0 || n_columns == 0) {
        return;
    }
    fprintf(f, "matrix %s\n", name);
    for (size_t i = 0; i < n_rows; i++) {
        fputc('+', f);
        for (size_t j = 0; j < n_columns; j++) {
            fputc(' ', f);
            dalcs_write_number(f, a[i * n_columns + j]);
        }
        fputc('\n', f);
    }
}

static void write_all(FILE *f, const struct dalcs_matrices *m) {
    fprintf(f, "dalcs-system 2 %s\n%s\n", m->title == NULL ? "" : m->title,
            m->cards == NULL ? "" : m->cards);
    write_names(f, "state", 'x', m->n_x, m->x_name, m->x0);
    write_names(f, "unknown", 'z', m->n_z, m->z_name, NULL);
    for (size_t k = 0; k < m->n_lambda; k++) {
        fprintf(f, "interval lambda%zu", k + 1);
        write_bound(f, m->low == NULL ? 0.0 : m->low[k]);
        write_bound(f, m->high == NULL ? (double)INFINITY : m->high[k]);
        fputc('\n', f);
    }
    write_matrix(f, "P", m->P, m->n_x, m->n_x);
    write_matrix(f, "A_I", m->A_I, m->n_x, m->n_x);
    write_matrix(f, "B_I", m->B_I, m->n_x, m->n_z);
    write_matrix(f, "Bbar_I", m->Bbar_I, m->n_x, m->n_lambda);
    write_matrix(f, "E_I", m->E_I, m->n_x, m->n_inputs);
    write_matrix(f, "constant_I", m->constant_I, m->n_x, 1);
    write_matrix(f, "A_II", m->A_II, m->n_z, m->n_x);
    write_matrix(f, "B_II", m->B_II, m->n_z, m->n_z);
    write_matrix(f, "Bbar_II", m->Bbar_II, m->n_z, m->n_lambda);
    write_matrix(f, "E_II", m->E_II, m->n_z, m->n_inputs);
    write_matrix(f, "constant_II", m->constant_II, m->n_z, 1);
    write_matrix(f, "C_I", m->C_I, m->n_lambda, m->n_x);
    write_matrix(f, "C_II", m->C_II, m->n_lambda, m->n_z);
    write_matrix(f, "D", m->D, m->n_lambda, m->n_lambda);
    write_matrix(f, "F", m->F, m->n_lambda, m->n_inputs);
    write_matrix(f, "constant_F", m->constant_F, m->n_lambda, 1);
    write_matrix(f, "storage", m->storage, m->n_x, m->n_x);
}

enum dalcs_status dalcs_session_read_matrices(struct dalcs_session *session, const char *name,
                                              const struct dalcs_matrices *matrices) {
    char *text = NULL;
    size_t length;
    FILE *f = open_memstream(&text, &length);
    if (f == NULL) {
        return DALCS_E_NOMEM;
    }
    write_all(f, matrices);
    bool lost = ferror(f) != 0;
    lost = fclose(f) != 0 || lost || text == NULL;
    enum dalcs_status status =
        lost ? DALCS_E_NOMEM : dalcs_session_read_text(session, name, text, length);
    free(text);
    return status;
}
