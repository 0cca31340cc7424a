/* system_file_write.c - writing a DALCS as text, with one of its one-step problems. */
#include "system_file.h"

#include "system_file_format.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

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
    fprintf(f, "dalcs-system %d\nabout ", DALCS_SYSTEM_FILE_VERSION);
    for (const char *p = about; *p != '\0'; p++) {
        fputc(*p == '\n' ? ' ' : *p, f); /* a file's name may hold anything */
    }
    fprintf(f, "\nsize %d %d %d %d %d\n", s->n_x, s->n_z, s->n_pairs, s->n_inputs,
            s->monotone ? 1 : 0);
}

static void write_labels(FILE *f, const struct dalcs_system *s) {
    int n_equations = dalcs_system_n_equations(s);
    for (int c = 0; c < n_equations; c++) {
        fprintf(f, "column %s %c %d %s\n", dalcs_system_label_kind[s->column[c].kind],
                s->column_is_current[c] ? 'A' : 'V', s->forest_root[c], s->column[c].element);
    }
    for (int r = 0; r < n_equations; r++) {
        fprintf(f, "row %s %c %d %s\n", dalcs_system_label_kind[s->row[r].kind],
                s->row_is_current[r] ? 'A' : 'V', s->dual[r], s->row[r].element);
    }
    for (int d = 0; d < s->n_pairs; d++) {
        const struct dalcs_pair *p = &s->pair[d];
        int kind = p->kind == DALCS_PAIR_SWITCH ? DALCS_FILE_SWITCH
                   : p->is_breakdown            ? DALCS_FILE_BREAKDOWN
                                                : DALCS_FILE_DIODE;
        fprintf(f, "pair %s %d %d ", dalcs_system_pair_kind[kind], p->initially_on ? 1 : 0,
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
    struct dalcs_system_section section[DALCS_N_SYSTEM_SECTIONS];
    dalcs_system_list_sections(s, section);
    for (int k = 0; k < DALCS_N_SYSTEM_SECTIONS; k++) {
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
        return true; /* opening or renaming it will fail with a message */
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
