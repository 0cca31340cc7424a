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

static void write_all(FILE *f, const void *matrices) {
    const struct dalcs_matrices *m = matrices;
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

static void write_laws(FILE *f, const char *word, size_t n, const double *limit) {
    for (size_t k = 0; k < n; k++) {
        fprintf(f, "%s %s%zu", word, word, k + 1);
        if (limit != NULL) {
            fputc(' ', f);
            dalcs_write_number(f, limit[k]);
        }
        fputc('\n', f);
    }
}

static void write_coordinates(FILE *f, const struct dalcs_mechanics *m) {
    for (size_t k = 0; k < m->n_q; k++) {
        fputs("coordinate ", f);
        if (m->q_name != NULL) {
            dalcs_write_name(f, m->q_name[k]);
        } else {
            fprintf(f, "q%zu", k + 1);
        }
        if (m->q0 != NULL || m->v0 != NULL) {
            fputc(' ', f);
            dalcs_write_number(f, m->q0 == NULL ? 0.0 : m->q0[k]);
            fputc(' ', f);
            dalcs_write_number(f, m->v0 == NULL ? 0.0 : m->v0[k]);
        }
        fputc('\n', f);
    }
}

static void write_mechanics(FILE *f, const void *mechanics) {
    const struct dalcs_mechanics *m = mechanics;
    size_t n_laws = m->n_contacts + m->n_joints + m->n_frictions;
    fprintf(f, "dalcs-system 2 %s\n%s\n", m->title == NULL ? "" : m->title,
            m->cards == NULL ? "" : m->cards);
    write_coordinates(f, m);
    write_laws(f, "contact", m->n_contacts, NULL);
    write_laws(f, "joint", m->n_joints, NULL);
    write_laws(f, "friction", m->n_frictions, m->friction_limit);
    write_matrix(f, "mass", m->mass, m->n_q, m->n_q);
    write_matrix(f, "damping", m->damping, m->n_q, m->n_q);
    write_matrix(f, "stiffness", m->stiffness, m->n_q, m->n_q);
    write_matrix(f, "force", m->force, m->n_q, m->n_inputs);
    write_matrix(f, "constant_force", m->constant_force, m->n_q, 1);
    write_matrix(f, "G", m->G, n_laws, m->n_q);
    write_matrix(f, "constant_G", m->constant_G, n_laws, 1);
}

/* Reads what write(f, what) writes. */
static enum dalcs_status read_written(struct dalcs_session *session, const char *name,
                                      void (*write)(FILE *f, const void *what), const void *what) {
    char *text = NULL;
    size_t length;
    FILE *f = open_memstream(&text, &length);
    if (f == NULL) {
        return DALCS_E_NOMEM;
    }
    write(f, what);
    bool lost = ferror(f) != 0;
    lost = fclose(f) != 0 || lost || text == NULL;
    enum dalcs_status status =
        lost ? DALCS_E_NOMEM : dalcs_session_read_text(session, name, text, length);
    free(text);
    return status;
}

enum dalcs_status dalcs_session_read_matrices(struct dalcs_session *session, const char *name,
                                              const struct dalcs_matrices *matrices) {
    return read_written(session, name, write_all, matrices);
}

enum dalcs_status dalcs_session_read_mechanics(struct dalcs_session *session, const char *name,
                                               const struct dalcs_mechanics *mechanics) {
    return read_written(session, name, write_mechanics, mechanics);
}
