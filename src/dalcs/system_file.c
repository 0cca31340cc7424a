/* system_file.c - writing and reading a DALCS as text: sizes, labels, then the matrices by entries.
 *
 * Numbers have 17 digits, so that what is read is what was written, to the bit. */
#include "system_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct section {
    const char *name;
    struct dalcs_csr *matrix;
    int n_rows, n_columns;
};

enum { N_SECTIONS = 8 };

static void list_sections(struct dalcs_system *s, struct section *section) {
    int n_equations = dalcs_system_n_equations(s);
    int n_columns = dalcs_system_n_columns(s);
    const struct section all[N_SECTIONS] = {
        {"P", &s->P, s->n_x, s->n_x},
        {"A", &s->A, n_equations, n_columns},
        {"E", &s->E, n_equations, s->n_inputs},
        {"C", &s->C, s->n_pairs, n_columns},
        {"F", &s->F, s->n_pairs, s->n_inputs},
        {"storage", &s->storage, s->n_x, s->n_x},
        {"control", &s->control, s->n_pairs, n_columns},
        {"direct_control", &s->direct_control, s->n_pairs, s->n_inputs},
    };
    memcpy(section, all, sizeof(all));
}

enum dalcs_status dalcs_system_file_write(const char *path, const struct dalcs_system *system,
                                          const struct dalcs_system_step *step) {
    FILE *f = fopen(path, "w");
    if (f == NULL) {
        return DALCS_E_IO;
    }
    struct dalcs_system s = *system; /* list_sections wants it writable; only read here */
    int n_equations = dalcs_system_n_equations(&s);
    fprintf(f, "dalcs-system 1\nsize %d %d %d %d %d\n", s.n_x, s.n_z, s.n_pairs, s.n_inputs,
            s.monotone ? 1 : 0);
    for (int c = 0; c < n_equations; c++) {
        fprintf(f, "column %d %c %s\n", (int)s.column[c].kind, s.column_is_current[c] ? 'A' : 'V',
                s.column[c].element);
    }
    for (int r = 0; r < n_equations; r++) {
        fprintf(f, "row %d %c %d %s\n", (int)s.row[r].kind, s.row_is_current[r] ? 'A' : 'V',
                s.dual[r], s.row[r].element);
    }
    for (int d = 0; d < s.n_pairs; d++) {
        const struct dalcs_pair *p = &s.pair[d];
        fprintf(f, "pair %d %d %d %d %.17g %.17g %s\n", (int)p->kind, p->is_breakdown ? 1 : 0,
                p->initially_on ? 1 : 0, p->is_direct ? 1 : 0, p->turn_on, p->turn_off, p->element);
    }
    for (int k = 1; k < s.n_inputs; k++) {
        fprintf(f, "input %s\n", s.input_element[k]);
    }
    struct section section[N_SECTIONS];
    list_sections(&s, section);
    for (int k = 0; k < N_SECTIONS; k++) {
        const struct dalcs_csr *a = section[k].matrix;
        fprintf(f, "matrix %s %d\n", section[k].name, a->p[a->n_rows]);
        for (int i = 0; i < a->n_rows; i++) {
            for (int e = a->p[i]; e < a->p[i + 1]; e++) {
                fprintf(f, "%d %d %.17g\n", i, a->j[e], a->x[e]);
            }
        }
    }
    fprintf(f, "sigma %.17g\n", step->sigma);
    for (int i = 0; i < s.n_x + s.n_inputs; i++) {
        fprintf(f, "u %.17g\n", step->u[i]);
    }
    for (int d = 0; d < s.n_pairs; d++) {
        fprintf(f, "mode %d\n", (int)(step->mode[d / 64] >> (d % 64) & 1));
    }
    bool failed = ferror(f) != 0;
    failed = fclose(f) != 0 || failed;
    return failed ? DALCS_E_IO : DALCS_OK;
}

/* ---- Reading ------------------------------------------------------------------------------- */

struct reader {
    FILE *f;
    struct dalcs_system_file *file;
};

static bool read_name(struct reader *r, const char **name) {
    char text[256];
    if (fscanf(r->f, " %255s", text) != 1) {
        return false;
    }
    *name = dalcs_arena_copy(&r->file->arena, text, strlen(text));
    return *name != NULL;
}

static bool read_labels(struct reader *r) {
    struct dalcs_system *s = &r->file->system;
    int n_equations = dalcs_system_n_equations(s);
    int kind;
    char unit;
    for (int c = 0; c < n_equations; c++) {
        if (fscanf(r->f, " column %d %c", &kind, &unit) != 2 ||
            !read_name(r, &s->column[c].element) || kind < 0 || kind > DALCS_LABEL_REFERENCE) {
            return false;
        }
        s->column[c].kind = (enum dalcs_label_kind)kind;
        s->column_is_current[c] = unit == 'A';
    }
    for (int i = 0; i < n_equations; i++) {
        if (fscanf(r->f, " row %d %c %d", &kind, &unit, &s->dual[i]) != 3 ||
            !read_name(r, &s->row[i].element) || kind < 0 || kind > DALCS_LABEL_REFERENCE ||
            s->dual[i] < 0 || s->dual[i] >= n_equations) {
            return false;
        }
        s->row[i].kind = (enum dalcs_label_kind)kind;
        s->row_is_current[i] = unit == 'A';
    }
    for (int d = 0; d < s->n_pairs; d++) {
        struct dalcs_pair *p = &s->pair[d];
        int flag[3];
        if (fscanf(r->f, " pair %d %d %d %d %lf %lf", &kind, &flag[0], &flag[1], &flag[2],
                   &p->turn_on, &p->turn_off) != 6 ||
            !read_name(r, &p->element)) {
            return false;
        }
        p->kind = kind == DALCS_PAIR_SWITCH ? DALCS_PAIR_SWITCH : DALCS_PAIR_DIODE;
        p->is_breakdown = flag[0] != 0;
        p->initially_on = flag[1] != 0;
        p->is_direct = flag[2] != 0;
        s->column_is_current[n_equations + d] = true;
    }
    for (int k = 1; k < s->n_inputs; k++) {
        if (fscanf(r->f, " input") != 0 || !read_name(r, &s->input_element[k])) {
            return false;
        }
    }
    return true;
}

static enum dalcs_status read_matrix(struct reader *r, const struct section *section) {
    char name[32];
    int n;
    if (fscanf(r->f, " matrix %31s %d", name, &n) != 2 || strcmp(name, section->name) != 0) {
        return DALCS_E_NETLIST;
    }
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < n && status == DALCS_OK; k++) {
        int i;
        int j;
        double x;
        bool valid = fscanf(r->f, " %d %d %lf", &i, &j, &x) == 3 && i >= 0 && i < section->n_rows &&
                     j >= 0 && j < section->n_columns;
        status = valid ? dalcs_triplets_add(&t, i, j, x) : DALCS_E_NETLIST;
    }
    if (status == DALCS_OK) {
        status = dalcs_csr_compress(section->matrix, section->n_rows, section->n_columns, &t);
    }
    dalcs_triplets_finish(&t);
    return status;
}

static enum dalcs_status read_all(struct reader *r) {
    struct dalcs_system_file *file = r->file;
    struct dalcs_system *s = &file->system;
    int version;
    int monotone;
    if (fscanf(r->f, "dalcs-system %d size %d %d %d %d %d", &version, &s->n_x, &s->n_z, &s->n_pairs,
               &s->n_inputs, &monotone) != 6 ||
        version != 1 || s->n_x < 0 || s->n_z < 0 || s->n_pairs < 0 || s->n_inputs < 1 ||
        s->n_x > 1 << 28 || s->n_z > 1 << 28 || s->n_pairs > 1 << 28 || s->n_inputs > 1 << 28) {
        return DALCS_E_NETLIST;
    }
    s->monotone = monotone != 0;
    size_t n_equations = (size_t)dalcs_system_n_equations(s);
    size_t n_inputs = (size_t)s->n_inputs;
    size_t n_pairs = (size_t)s->n_pairs;
    s->dual = dalcs_alloc(n_equations, sizeof(*s->dual));
    s->column_is_current = dalcs_alloc(n_equations + n_pairs, sizeof(bool));
    s->row_is_current = dalcs_alloc(n_equations, sizeof(bool));
    s->row = dalcs_alloc(n_equations, sizeof(*s->row));
    s->column = dalcs_alloc(n_equations, sizeof(*s->column));
    s->pair = dalcs_alloc(n_pairs, sizeof(*s->pair));
    s->stimulus = dalcs_alloc(n_inputs, sizeof(*s->stimulus));
    s->input_element = dalcs_alloc(n_inputs, sizeof(*s->input_element));
    file->u = dalcs_alloc((size_t)s->n_x + n_inputs, sizeof(*file->u));
    file->mode = dalcs_alloc((n_pairs + 63) / 64, sizeof(*file->mode));
    if (s->dual == NULL || s->column_is_current == NULL || s->row_is_current == NULL ||
        s->row == NULL || s->column == NULL || s->pair == NULL || s->stimulus == NULL ||
        s->input_element == NULL || file->u == NULL || file->mode == NULL) {
        return DALCS_E_NOMEM;
    }
    if (!read_labels(r)) {
        return DALCS_E_NETLIST;
    }
    struct section section[N_SECTIONS];
    list_sections(s, section);
    for (int k = 0; k < N_SECTIONS; k++) {
        DALCS_TRY(read_matrix(r, &section[k]));
    }
    bool valid = fscanf(r->f, " sigma %lf", &file->sigma) == 1;
    for (int i = 0; valid && i < s->n_x + s->n_inputs; i++) {
        valid = fscanf(r->f, " u %lf", &file->u[i]) == 1;
    }
    for (int d = 0; valid && d < s->n_pairs; d++) {
        int on;
        valid = fscanf(r->f, " mode %d", &on) == 1;
        file->mode[d / 64] |= (uint64_t)(valid && on != 0) << (d % 64);
    }
    return valid ? DALCS_OK : DALCS_E_NETLIST;
}

enum dalcs_status dalcs_system_file_read(struct dalcs_system_file *file, const char *path) {
    *file = (struct dalcs_system_file){0};
    struct reader r = {.f = fopen(path, "r"), .file = file};
    if (r.f == NULL) {
        return DALCS_E_IO;
    }
    enum dalcs_status status = read_all(&r);
    fclose(r.f);
    if (status != DALCS_OK) {
        dalcs_system_file_finish(file);
    }
    return status;
}

void dalcs_system_file_finish(struct dalcs_system_file *file) {
    dalcs_system_finish(&file->system);
    free(file->u);
    free(file->mode);
    dalcs_arena_finish(&file->arena);
    *file = (struct dalcs_system_file){0};
}
