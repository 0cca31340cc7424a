/* system_file.c - reading a DALCS as text: sizes, labels, then the matrices by entries.
 *
 * Numbers have 17 digits, so that what is read is what was written, to the bit, and a point whatever
 * the locale. The reader checks every number: the engine uses them as indices. */
#include "system_file.h"

#include "system_file_format.h"
#include "text_file.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static enum dalcs_status read_columns(struct dalcs_system_reader *r) {
    struct dalcs_system *s = &r->file->system;
    for (int c = 0; c < dalcs_system_n_equations(s); c++) {
        int kind;
        DALCS_TRY(dalcs_system_read_keyword(r, "column"));
        DALCS_TRY(dalcs_system_read_choice(r, dalcs_system_label_kind, DALCS_N_LABEL_KINDS,
                                           "the kind of a column", &kind));
        DALCS_TRY(dalcs_system_read_unit(r, &s->column_is_current[c]));
        int root;
        DALCS_TRY(dalcs_system_read_int(r, 0, dalcs_system_n_equations(s) - 1, &root));
        s->forest_root[c] = root;
        if (root != c && (c < s->n_x || root < s->n_x)) {
            return dalcs_system_refuse(
                r, "the column itself or, for a voltage, that of its tree's root");
        }
        DALCS_TRY(dalcs_system_read_name(r, &s->column[c].element));
        s->column[c].kind = (enum dalcs_label_kind)kind;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        s->column_is_current[dalcs_system_n_equations(s) + d] = true;
    }
    return DALCS_OK;
}

static enum dalcs_status read_rows(struct dalcs_system_reader *r, bool *taken /* work, zeroed */) {
    struct dalcs_system *s = &r->file->system;
    int n = dalcs_system_n_equations(s);
    for (int i = 0; i < n; i++) {
        int kind;
        DALCS_TRY(dalcs_system_read_keyword(r, "row"));
        DALCS_TRY(dalcs_system_read_choice(r, dalcs_system_label_kind, DALCS_N_LABEL_KINDS,
                                           "the kind of a row", &kind));
        DALCS_TRY(dalcs_system_read_unit(r, &s->row_is_current[i]));
        DALCS_TRY(dalcs_system_read_int(r, 0, n - 1, &s->dual[i]));
        if (taken[s->dual[i]]) {
            return dalcs_system_refuse(r, "a column that no other row is paired with");
        }
        taken[s->dual[i]] = true;
        /* A reference is both the row of a voltage and the column of a current. */
        if ((kind == DALCS_LABEL_REFERENCE) !=
            (s->column[s->dual[i]].kind == DALCS_LABEL_REFERENCE)) {
            return dalcs_system_refuse(r, "references paired with references");
        }
        DALCS_TRY(dalcs_system_read_name(r, &s->row[i].element));
        s->row[i].kind = (enum dalcs_label_kind)kind;
    }
    return DALCS_OK;
}

static enum dalcs_status read_pairs(struct dalcs_system_reader *r) {
    struct dalcs_system *s = &r->file->system;
    for (int d = 0; d < s->n_pairs; d++) {
        struct dalcs_pair *p = &s->pair[d];
        int kind;
        int flag[2];
        DALCS_TRY(dalcs_system_read_keyword(r, "pair"));
        DALCS_TRY(dalcs_system_read_choice(r, dalcs_system_pair_kind, DALCS_N_PAIR_KINDS,
                                           "diode, breakdown or switch", &kind));
        DALCS_TRY(dalcs_system_read_int(r, 0, 1, &flag[0]));
        DALCS_TRY(dalcs_system_read_int(r, 0, 1, &flag[1]));
        DALCS_TRY(dalcs_system_read_number(r, &p->turn_on));
        DALCS_TRY(dalcs_system_read_number(r, &p->turn_off));
        DALCS_TRY(dalcs_system_read_name(r, &p->element));
        p->kind = kind == DALCS_FILE_SWITCH ? DALCS_PAIR_SWITCH : DALCS_PAIR_DIODE;
        p->is_breakdown = kind == DALCS_FILE_BREAKDOWN;
        p->initially_on = flag[0] != 0;
        p->is_direct = flag[1] != 0;
    }
    for (int k = 1; k < s->n_inputs; k++) {
        DALCS_TRY(dalcs_system_read_keyword(r, "input"));
        DALCS_TRY(dalcs_system_read_name(r, &s->input_element[k]));
    }
    return DALCS_OK;
}

static enum dalcs_status read_matrix(struct dalcs_system_reader *r,
                                     const struct dalcs_system_section *section,
                                     struct dalcs_csr *matrix) {
    int n;
    DALCS_TRY(dalcs_system_read_keyword(r, "matrix"));
    dalcs_system_read_word(r);
    if (!dalcs_system_word_is(r, section->name)) {
        return dalcs_system_refuse(r, section->name);
    }
    DALCS_TRY(dalcs_system_read_int(r, 0, INT_MAX, &n));
    DALCS_TRY(dalcs_system_end_line(r));
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < n && status == DALCS_OK; k++) {
        int i = 0;
        int j = 0;
        double x = 0.0;
        r->line++;
        status = dalcs_system_read_int(r, 0, section->n_rows - 1, &i);
        status =
            status == DALCS_OK ? dalcs_system_read_int(r, 0, section->n_columns - 1, &j) : status;
        status = status == DALCS_OK ? dalcs_system_read_number(r, &x) : status;
        status = status == DALCS_OK ? dalcs_system_end_line(r) : status;
        status = status == DALCS_OK ? dalcs_triplets_add(&t, i, j, x) : status;
    }
    if (status == DALCS_OK) {
        status = dalcs_csr_compress(matrix, section->n_rows, section->n_columns, &t);
    }
    dalcs_triplets_finish(&t);
    for (int k = 0; status == DALCS_OK && k < matrix->p[matrix->n_rows]; k++) {
        if (!isfinite(matrix->x[k])) {
            return dalcs_system_refuse(r, "entries with a finite sum");
        }
    }
    return status;
}

static enum dalcs_status read_matrices(struct dalcs_system_reader *r) {
    struct dalcs_system *s = &r->file->system;
    struct dalcs_system_section section[DALCS_N_SYSTEM_SECTIONS];
    dalcs_system_list_sections(s, section);
    for (int k = 0; k < DALCS_N_SYSTEM_SECTIONS; k++) {
        struct dalcs_csr *matrix = (struct dalcs_csr *)(void *)((char *)s + section[k].offset);
        DALCS_TRY(read_matrix(r, &section[k], matrix));
    }
    return DALCS_OK;
}

static enum dalcs_status read_step(struct dalcs_system_reader *r) {
    struct dalcs_system_file *file = r->file;
    const struct dalcs_system *s = &file->system;
    DALCS_TRY(dalcs_system_read_keyword(r, "sigma"));
    DALCS_TRY(dalcs_system_read_number(r, &file->sigma));
    if (!(file->sigma >= 0.0)) {
        return dalcs_system_refuse(r, "a sigma of 0 or more");
    }
    DALCS_TRY(dalcs_system_end_line(r));
    for (int i = 0; i < s->n_x + s->n_inputs; i++) {
        DALCS_TRY(dalcs_system_read_keyword(r, "u"));
        DALCS_TRY(dalcs_system_read_number(r, &file->u[i]));
        DALCS_TRY(dalcs_system_end_line(r));
    }
    for (int d = 0; d < s->n_pairs; d++) {
        int on;
        DALCS_TRY(dalcs_system_read_keyword(r, "mode"));
        DALCS_TRY(dalcs_system_read_int(r, 0, 1, &on));
        DALCS_TRY(dalcs_system_end_line(r));
        file->mode[d / 64] |= (uint64_t)on << (d % 64);
    }
    return dalcs_system_read_keyword(r, "end");
}

static enum dalcs_status read_header(struct dalcs_system_reader *r) {
    struct dalcs_system *s = &r->file->system;
    int version;
    int monotone;
    DALCS_TRY(dalcs_system_read_keyword(r, "dalcs-system"));
    DALCS_TRY(
        dalcs_system_read_int(r, DALCS_SYSTEM_FILE_VERSION, DALCS_SYSTEM_FILE_VERSION, &version));
    DALCS_TRY(dalcs_system_end_line(r));
    DALCS_TRY(dalcs_system_read_keyword(r, "about"));
    const char *line_end = memchr(r->at, '\n', (size_t)(r->end - r->at));
    line_end = line_end == NULL ? r->end : line_end;
    while (r->at < line_end && dalcs_system_is_blank(*r->at)) {
        r->at++;
    }
    r->file->about = dalcs_arena_copy(&r->file->arena, r->at, (size_t)(line_end - r->at));
    if (r->file->about == NULL) {
        return DALCS_E_NOMEM;
    }
    r->at = line_end;
    DALCS_TRY(dalcs_system_end_line(r));
    /* Each entry counted here has a line that follows: a damaged size allocates no more memory than its
     * file deserves. */
    size_t left = (size_t)(r->end - r->at);
    int most = left < 1 << 28 ? (int)left : 1 << 28;
    DALCS_TRY(dalcs_system_read_keyword(r, "size"));
    DALCS_TRY(dalcs_system_read_int(r, 0, most, &s->n_x));
    DALCS_TRY(dalcs_system_read_int(r, 0, most - s->n_x, &s->n_z));
    DALCS_TRY(dalcs_system_read_int(r, 0, most - s->n_x - s->n_z, &s->n_pairs));
    DALCS_TRY(dalcs_system_read_int(r, 1, most, &s->n_inputs));
    DALCS_TRY(dalcs_system_read_int(r, 0, 1, &monotone));
    s->monotone = monotone != 0;
    return dalcs_system_end_line(r);
}

static enum dalcs_status allocate(struct dalcs_system_file *file) {
    struct dalcs_system *s = &file->system;
    size_t n_equations = (size_t)dalcs_system_n_equations(s);
    size_t n_inputs = (size_t)s->n_inputs;
    size_t n_pairs = (size_t)s->n_pairs;
    s->dual = dalcs_alloc(n_equations, sizeof(*s->dual));
    s->forest_root = dalcs_alloc(n_equations, sizeof(*s->forest_root));
    s->column_is_current = dalcs_alloc(n_equations + n_pairs, sizeof(bool));
    s->row_is_current = dalcs_alloc(n_equations, sizeof(bool));
    s->row = dalcs_alloc(n_equations, sizeof(*s->row));
    s->column = dalcs_alloc(n_equations, sizeof(*s->column));
    s->pair = dalcs_alloc(n_pairs, sizeof(*s->pair));
    s->stimulus = dalcs_alloc(n_inputs, sizeof(*s->stimulus));
    s->input_element = dalcs_alloc(n_inputs, sizeof(*s->input_element));
    file->u = dalcs_alloc((size_t)s->n_x + n_inputs, sizeof(*file->u));
    file->mode = dalcs_alloc((n_pairs + 63) / 64, sizeof(*file->mode));
    if (s->dual == NULL || s->forest_root == NULL || s->column_is_current == NULL ||
        s->row_is_current == NULL || s->row == NULL || s->column == NULL || s->pair == NULL ||
        s->stimulus == NULL || s->input_element == NULL || file->u == NULL || file->mode == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n_inputs; k++) {
        s->stimulus[k] = -1; /* the inputs of one step are in u */
    }
    return DALCS_OK;
}

static enum dalcs_status read_all(struct dalcs_system_reader *r) {
    DALCS_TRY(read_header(r));
    DALCS_TRY(allocate(r->file));
    DALCS_TRY(read_columns(r));
    bool *taken = dalcs_alloc((size_t)dalcs_system_n_equations(&r->file->system), sizeof(*taken));
    enum dalcs_status status = taken == NULL ? DALCS_E_NOMEM : read_rows(r, taken);
    free(taken);
    DALCS_TRY(status);
    DALCS_TRY(read_pairs(r));
    DALCS_TRY(read_matrices(r));
    return read_step(r);
}

enum dalcs_status dalcs_system_file_read_text(struct dalcs_system_file *file, const char *name,
                                              const char *text, size_t length,
                                              struct dalcs_diag *diag) {
    *file = (struct dalcs_system_file){0};
    struct dalcs_system_reader r = {
        .file = file, .name = name, .diag = diag, .at = text, .end = text + length, .word = text};
    enum dalcs_status status = read_all(&r);
    if (status != DALCS_OK) {
        dalcs_system_file_finish(file);
    }
    return status;
}

enum dalcs_status dalcs_system_file_read(struct dalcs_system_file *file, const char *path,
                                         struct dalcs_diag *diag) {
    *file = (struct dalcs_system_file){0};
    char *text;
    size_t length;
    enum dalcs_status status = dalcs_text_file_read(path, SIZE_MAX, &text, &length, NULL, diag);
    if (status == DALCS_OK) {
        status = dalcs_system_file_read_text(file, path, text, length, diag);
    }
    free(text);
    return status;
}

void dalcs_system_file_finish(struct dalcs_system_file *file) {
    dalcs_system_finish(&file->system);
    free(file->u);
    free(file->mode);
    dalcs_arena_finish(&file->arena);
    *file = (struct dalcs_system_file){0};
}
