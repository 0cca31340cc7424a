/* system_file.c - writing and reading a DALCS as text: sizes, labels, then the matrices by entries.
 *
 * Numbers have 17 digits, so that what is read is what was written, to the bit, and a point whatever
 * the locale. The reader believes nothing: the engine indexes with what it is given. */
#include "system_file.h"

#include "number.h"
#include "text_file.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { VERSION = 1, N_SECTIONS = 8, N_LABEL_KINDS = 4, N_PAIR_KINDS = 3 };

static const char *const label_kind[N_LABEL_KINDS] = {[DALCS_LABEL_STATE] = "state",
                                                      [DALCS_LABEL_NODE] = "node",
                                                      [DALCS_LABEL_BRANCH] = "branch",
                                                      [DALCS_LABEL_REFERENCE] = "reference"};

enum { DIODE, BREAKDOWN, SWITCH };

static const char *const pair_kind[N_PAIR_KINDS] = {
    [DIODE] = "diode", [BREAKDOWN] = "breakdown", [SWITCH] = "switch"};

struct section {
    const char *name;
    size_t offset; /* of the matrix in struct dalcs_system */
    int n_rows, n_columns;
};

static void list_sections(const struct dalcs_system *s, struct section *section) {
    int n_equations = dalcs_system_n_equations(s);
    int n_columns = dalcs_system_n_columns(s);
#define MATRIX(name) #name, offsetof(struct dalcs_system, name)
    const struct section all[N_SECTIONS] = {
        {MATRIX(P), s->n_x, s->n_x},
        {MATRIX(A), n_equations, n_columns},
        {MATRIX(E), n_equations, s->n_inputs},
        {MATRIX(C), s->n_pairs, n_columns},
        {MATRIX(F), s->n_pairs, s->n_inputs},
        {MATRIX(storage), s->n_x, s->n_x},
        {MATRIX(control), s->n_pairs, n_columns},
        {MATRIX(direct_control), s->n_pairs, s->n_inputs},
    };
#undef MATRIX
    memcpy(section, all, sizeof(all));
}

/* ---- Writing ------------------------------------------------------------------------------- */

static void write_number(FILE *f, double value, const char *after) {
    char text[40];
    snprintf(text, sizeof(text), "%.17g", value);
    size_t point = strspn(text, "+-0123456789");
    size_t rest = point + strcspn(text + point, "+-0123456789e");
    if (isfinite(value) && rest > point) { /* whatever the locale's point is */
        text[point] = '.';
        memmove(text + point + 1, text + rest, strlen(text + rest) + 1);
    }
    fprintf(f, "%s%s", text, after);
}

static void write_header(FILE *f, const struct dalcs_system *s, const char *about) {
    fprintf(f, "dalcs-system %d\nabout ", VERSION);
    for (const char *p = about; *p != '\0'; p++) {
        fputc(*p == '\n' ? ' ' : *p, f); /* a file's name may hold anything */
    }
    fprintf(f, "\nsize %d %d %d %d %d\n", s->n_x, s->n_z, s->n_pairs, s->n_inputs,
            s->monotone ? 1 : 0);
}

static void write_labels(FILE *f, const struct dalcs_system *s) {
    int n_equations = dalcs_system_n_equations(s);
    for (int c = 0; c < n_equations; c++) {
        fprintf(f, "column %s %c %d %s\n", label_kind[s->column[c].kind],
                s->column_is_current[c] ? 'A' : 'V', s->forest_root[c], s->column[c].element);
    }
    for (int r = 0; r < n_equations; r++) {
        fprintf(f, "row %s %c %d %s\n", label_kind[s->row[r].kind],
                s->row_is_current[r] ? 'A' : 'V', s->dual[r], s->row[r].element);
    }
    for (int d = 0; d < s->n_pairs; d++) {
        const struct dalcs_pair *p = &s->pair[d];
        int kind = p->kind == DALCS_PAIR_SWITCH ? SWITCH : p->is_breakdown ? BREAKDOWN : DIODE;
        fprintf(f, "pair %s %d %d ", pair_kind[kind], p->initially_on ? 1 : 0,
                p->is_direct ? 1 : 0);
        write_number(f, p->turn_on, " ");
        write_number(f, p->turn_off, " ");
        fprintf(f, "%s\n", p->element);
    }
    for (int k = 1; k < s->n_inputs; k++) {
        fprintf(f, "input %s\n", s->input_element[k]);
    }
}

static void write_matrices(FILE *f, const struct dalcs_system *s) {
    struct section section[N_SECTIONS];
    list_sections(s, section);
    for (int k = 0; k < N_SECTIONS; k++) {
        const struct dalcs_csr *a =
            (const struct dalcs_csr *)(const void *)((const char *)s + section[k].offset);
        fprintf(f, "matrix %s %d\n", section[k].name, a->p[a->n_rows]);
        for (int i = 0; i < a->n_rows; i++) {
            for (int e = a->p[i]; e < a->p[i + 1]; e++) {
                fprintf(f, "%d %d ", i, a->j[e]);
                write_number(f, a->x[e], "\n");
            }
        }
    }
}

static void write_step(FILE *f, const struct dalcs_system *s,
                       const struct dalcs_system_step *step) {
    fputs("sigma ", f);
    write_number(f, step->sigma, "\n");
    for (int i = 0; i < s->n_x + s->n_inputs; i++) {
        fputs("u ", f);
        write_number(f, step->u[i], "\n");
    }
    for (int d = 0; d < s->n_pairs; d++) {
        fprintf(f, "mode %d\n", dalcs_mode_has(step->mode, d) ? 1 : 0);
    }
    fputs("end\n", f);
}

/* rename() would replace a device. */
static bool is_replaceable(const char *path) {
    struct stat target;
    if (stat(path, &target) != 0) {
        return true; /* opening and renaming will tell */
    }
    errno = S_ISDIR(target.st_mode) ? EISDIR : EINVAL;
    return S_ISREG(target.st_mode);
}

enum dalcs_status dalcs_system_file_write(const char *path, const struct dalcs_system *system,
                                          const struct dalcs_system_step *step) {
    static const char suffix[] = ".partial";
    if (!is_replaceable(path)) {
        return DALCS_E_IO;
    }
    char *temporary = dalcs_alloc(strlen(path) + sizeof(suffix), 1);
    if (temporary == NULL) {
        return DALCS_E_NOMEM;
    }
    strcat(strcpy(temporary, path), suffix);
    enum dalcs_status status = DALCS_E_IO;
    FILE *f = fopen(temporary, "w");
    if (f != NULL) {
        write_header(f, system, step->about);
        write_labels(f, system);
        write_matrices(f, system);
        write_step(f, system, step);
        bool failed = ferror(f) != 0;
        failed = fclose(f) != 0 || failed;
        if (!failed && rename(temporary, path) == 0) {
            status = DALCS_OK;
        } else {
            int error = errno;
            remove(temporary);
            errno = error;
        }
    }
    free(temporary);
    return status;
}

/* ---- Reading ------------------------------------------------------------------------------- */

struct reader {
    struct dalcs_system_file *file;
    const char *name;
    struct dalcs_diag *diag;
    const char *at, *end;
    int line;
    const char *word; /* [length] the last one read */
    size_t length;
};

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

static enum dalcs_status refuse(struct reader *r, const char *expected) {
    const struct dalcs_location where = {.file = r->name, .line = r->line};
    size_t shown = r->length < 40 ? r->length : 40;
    dalcs_diag_add(r->diag, DALCS_ERROR, &where, NULL, "expected %s%s%.*s%s", expected,
                   shown > 0 ? ", not '" : "; the line ends too early", (int)shown, r->word,
                   shown > 0 ? "'" : "");
    return DALCS_E_NETLIST;
}

/* The next word of the line; of length 0 at its end. */
static void read_word(struct reader *r) {
    while (r->at < r->end && is_blank(*r->at)) {
        r->at++;
    }
    r->word = r->at;
    while (r->at < r->end && !is_blank(*r->at) && *r->at != '\n') {
        r->at++;
    }
    r->length = (size_t)(r->at - r->word);
}

static bool word_is(const struct reader *r, const char *text) {
    return r->length == strlen(text) && memcmp(r->word, text, r->length) == 0;
}

static enum dalcs_status read_keyword(struct reader *r, const char *keyword) {
    r->line++;
    read_word(r);
    return word_is(r, keyword) ? DALCS_OK : refuse(r, keyword);
}

static enum dalcs_status end_line(struct reader *r) {
    read_word(r);
    if (r->length > 0) {
        return refuse(r, "the end of the line");
    }
    if (r->at < r->end) {
        r->at++;
    }
    return DALCS_OK;
}

static enum dalcs_status read_int(struct reader *r, int first, int last, int *value) {
    read_word(r);
    long long sum = 0;
    bool valid = r->length > 0 && r->length < 10;
    for (size_t k = 0; valid && k < r->length; k++) {
        valid = r->word[k] >= '0' && r->word[k] <= '9';
        sum = 10 * sum + (r->word[k] - '0');
    }
    if (!valid || sum < first || sum > last) {
        return refuse(r, last < first ? "no such entry" : "a whole number in its range");
    }
    *value = (int)sum;
    return DALCS_OK;
}

static enum dalcs_status read_number(struct reader *r, double *value) {
    read_word(r);
    char text[64];
    struct dalcs_number number;
    if (r->length >= sizeof(text)) {
        return refuse(r, "a number");
    }
    memcpy(text, r->word, r->length);
    text[r->length] = '\0';
    /* Suffixes are for netlists: a letter here is damage. */
    if (dalcs_number_parse(text, &number) != DALCS_NUMBER_OK ||
        (size_t)number.digits != r->length) {
        return refuse(r, "a number");
    }
    *value = number.value;
    return DALCS_OK;
}

static enum dalcs_status read_choice(struct reader *r, const char *const *choice, int n,
                                     const char *expected, int *index) {
    read_word(r);
    for (*index = 0; *index < n && !word_is(r, choice[*index]);) {
        ++*index;
    }
    return *index < n ? DALCS_OK : refuse(r, expected);
}

static enum dalcs_status read_unit(struct reader *r, bool *is_current) {
    static const char *const unit[] = {"V", "A"};
    int index;
    DALCS_TRY(read_choice(r, unit, 2, "V or A", &index));
    *is_current = index == 1;
    return DALCS_OK;
}

/* A name and the end of its line. */
static enum dalcs_status read_name(struct reader *r, const char **name) {
    read_word(r);
    if (r->length == 0 || memchr(r->word, '\0', r->length) != NULL) {
        return refuse(r, "a name");
    }
    *name = dalcs_arena_copy(&r->file->arena, r->word, r->length);
    return *name == NULL ? DALCS_E_NOMEM : end_line(r);
}

static enum dalcs_status read_columns(struct reader *r) {
    struct dalcs_system *s = &r->file->system;
    for (int c = 0; c < dalcs_system_n_equations(s); c++) {
        int kind;
        DALCS_TRY(read_keyword(r, "column"));
        DALCS_TRY(read_choice(r, label_kind, N_LABEL_KINDS, "the kind of a column", &kind));
        DALCS_TRY(read_unit(r, &s->column_is_current[c]));
        int root;
        DALCS_TRY(read_int(r, 0, dalcs_system_n_equations(s) - 1, &root));
        s->forest_root[c] = root;
        if (root != c && (c < s->n_x || root < s->n_x)) {
            return refuse(r, "the column itself or, for a voltage, that of its tree's root");
        }
        DALCS_TRY(read_name(r, &s->column[c].element));
        s->column[c].kind = (enum dalcs_label_kind)kind;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        s->column_is_current[dalcs_system_n_equations(s) + d] = true;
    }
    return DALCS_OK;
}

static enum dalcs_status read_rows(struct reader *r, bool *taken /* work, zeroed */) {
    struct dalcs_system *s = &r->file->system;
    int n = dalcs_system_n_equations(s);
    for (int i = 0; i < n; i++) {
        int kind;
        DALCS_TRY(read_keyword(r, "row"));
        DALCS_TRY(read_choice(r, label_kind, N_LABEL_KINDS, "the kind of a row", &kind));
        DALCS_TRY(read_unit(r, &s->row_is_current[i]));
        DALCS_TRY(read_int(r, 0, n - 1, &s->dual[i]));
        if (taken[s->dual[i]]) {
            return refuse(r, "a column that no other row is paired with");
        }
        taken[s->dual[i]] = true;
        /* A reference is both the row of a voltage and the column of a current. */
        if ((kind == DALCS_LABEL_REFERENCE) !=
            (s->column[s->dual[i]].kind == DALCS_LABEL_REFERENCE)) {
            return refuse(r, "references paired with references");
        }
        DALCS_TRY(read_name(r, &s->row[i].element));
        s->row[i].kind = (enum dalcs_label_kind)kind;
    }
    return DALCS_OK;
}

static enum dalcs_status read_pairs(struct reader *r) {
    struct dalcs_system *s = &r->file->system;
    for (int d = 0; d < s->n_pairs; d++) {
        struct dalcs_pair *p = &s->pair[d];
        int kind;
        int flag[2];
        DALCS_TRY(read_keyword(r, "pair"));
        DALCS_TRY(read_choice(r, pair_kind, N_PAIR_KINDS, "diode, breakdown or switch", &kind));
        DALCS_TRY(read_int(r, 0, 1, &flag[0]));
        DALCS_TRY(read_int(r, 0, 1, &flag[1]));
        DALCS_TRY(read_number(r, &p->turn_on));
        DALCS_TRY(read_number(r, &p->turn_off));
        DALCS_TRY(read_name(r, &p->element));
        p->kind = kind == SWITCH ? DALCS_PAIR_SWITCH : DALCS_PAIR_DIODE;
        p->is_breakdown = kind == BREAKDOWN;
        p->initially_on = flag[0] != 0;
        p->is_direct = flag[1] != 0;
    }
    for (int k = 1; k < s->n_inputs; k++) {
        DALCS_TRY(read_keyword(r, "input"));
        DALCS_TRY(read_name(r, &s->input_element[k]));
    }
    return DALCS_OK;
}

static enum dalcs_status read_matrix(struct reader *r, const struct section *section,
                                     struct dalcs_csr *matrix) {
    int n;
    DALCS_TRY(read_keyword(r, "matrix"));
    read_word(r);
    if (!word_is(r, section->name)) {
        return refuse(r, section->name);
    }
    DALCS_TRY(read_int(r, 0, INT_MAX, &n));
    DALCS_TRY(end_line(r));
    struct dalcs_triplets t = {0};
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < n && status == DALCS_OK; k++) {
        int i = 0;
        int j = 0;
        double x = 0.0;
        r->line++;
        status = read_int(r, 0, section->n_rows - 1, &i);
        status = status == DALCS_OK ? read_int(r, 0, section->n_columns - 1, &j) : status;
        status = status == DALCS_OK ? read_number(r, &x) : status;
        status = status == DALCS_OK ? end_line(r) : status;
        status = status == DALCS_OK ? dalcs_triplets_add(&t, i, j, x) : status;
    }
    if (status == DALCS_OK) {
        status = dalcs_csr_compress(matrix, section->n_rows, section->n_columns, &t);
    }
    dalcs_triplets_finish(&t);
    for (int k = 0; status == DALCS_OK && k < matrix->p[matrix->n_rows]; k++) {
        if (!isfinite(matrix->x[k])) {
            return refuse(r, "entries with a finite sum");
        }
    }
    return status;
}

static enum dalcs_status read_matrices(struct reader *r) {
    struct dalcs_system *s = &r->file->system;
    struct section section[N_SECTIONS];
    list_sections(s, section);
    for (int k = 0; k < N_SECTIONS; k++) {
        struct dalcs_csr *matrix = (struct dalcs_csr *)(void *)((char *)s + section[k].offset);
        DALCS_TRY(read_matrix(r, &section[k], matrix));
    }
    return DALCS_OK;
}

static enum dalcs_status read_step(struct reader *r) {
    struct dalcs_system_file *file = r->file;
    const struct dalcs_system *s = &file->system;
    DALCS_TRY(read_keyword(r, "sigma"));
    DALCS_TRY(read_number(r, &file->sigma));
    if (!(file->sigma >= 0.0)) {
        return refuse(r, "a sigma of 0 or more");
    }
    DALCS_TRY(end_line(r));
    for (int i = 0; i < s->n_x + s->n_inputs; i++) {
        DALCS_TRY(read_keyword(r, "u"));
        DALCS_TRY(read_number(r, &file->u[i]));
        DALCS_TRY(end_line(r));
    }
    for (int d = 0; d < s->n_pairs; d++) {
        int on;
        DALCS_TRY(read_keyword(r, "mode"));
        DALCS_TRY(read_int(r, 0, 1, &on));
        DALCS_TRY(end_line(r));
        file->mode[d / 64] |= (uint64_t)on << (d % 64);
    }
    return read_keyword(r, "end");
}

static enum dalcs_status read_header(struct reader *r) {
    struct dalcs_system *s = &r->file->system;
    int version;
    int monotone;
    DALCS_TRY(read_keyword(r, "dalcs-system"));
    DALCS_TRY(read_int(r, VERSION, VERSION, &version));
    DALCS_TRY(end_line(r));
    DALCS_TRY(read_keyword(r, "about"));
    const char *line_end = memchr(r->at, '\n', (size_t)(r->end - r->at));
    line_end = line_end == NULL ? r->end : line_end;
    while (r->at < line_end && is_blank(*r->at)) {
        r->at++;
    }
    r->file->about = dalcs_arena_copy(&r->file->arena, r->at, (size_t)(line_end - r->at));
    if (r->file->about == NULL) {
        return DALCS_E_NOMEM;
    }
    r->at = line_end;
    DALCS_TRY(end_line(r));
    /* Everything counted here has a line to come: a damaged size asks for no more memory than its
     * file deserves. */
    size_t left = (size_t)(r->end - r->at);
    int most = left < 1 << 28 ? (int)left : 1 << 28;
    DALCS_TRY(read_keyword(r, "size"));
    DALCS_TRY(read_int(r, 0, most, &s->n_x));
    DALCS_TRY(read_int(r, 0, most - s->n_x, &s->n_z));
    DALCS_TRY(read_int(r, 0, most - s->n_x - s->n_z, &s->n_pairs));
    DALCS_TRY(read_int(r, 1, most, &s->n_inputs));
    DALCS_TRY(read_int(r, 0, 1, &monotone));
    s->monotone = monotone != 0;
    return end_line(r);
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

static enum dalcs_status read_all(struct reader *r) {
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
    struct reader r = {
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
