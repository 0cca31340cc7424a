/* write_one_step.c - the one-step problem as text, in LaTeX, and for programs. */
#include "equations.h"
#include "printer.h"

#include <stdlib.h>

static void write_row(FILE *f, const double *row, int n) {
    for (int j = 0; j < n; j++) {
        fprintf(f, " %14.7g", row[j]);
    }
}

void dalcs_one_step_write_text(FILE *f, const struct dalcs_one_step *step) {
    const struct dalcs_system *s = step->system;
    fprintf(f,
            "one step of h = %.10g s, sigma = %.10g 1/s: 0 <= lambda _|_ w = M lambda + q >= 0\n",
            1.0 / step->sigma, step->sigma);
    if (step->is_singular) {
        fputs("  N(sigma) is singular: without complementarity the step is not determined, and "
              "lambda alone does not determine x and z\n"
              "  hint: if a part floats while its diodes block, a resistor from it to ground, such "
              "as 1Meg, makes N(sigma) regular\n",
              f);
        return;
    }
    fputs("  M(sigma) = D + (C_I C_II) N(sigma)^-1 (Bbar_I; Bbar_II), rows and columns:\n", f);
    for (int d = 0; d < s->n_pairs; d++) {
        fprintf(f, "  %-10s", s->pair[d].element);
        write_row(f, step->M + (size_t)d * (size_t)s->n_pairs, s->n_pairs);
        fputc('\n', f);
    }
    fputs("  q = what the reverse voltages w were with all multipliers 0: the sum of\n", f);
    for (int x = 0; x < s->n_x; x++) {
        fprintf(f, "    %s before the step times", s->column[x].element);
        for (int d = 0; d < s->n_pairs; d++) {
            fprintf(f, " %.7g", step->of_x[(size_t)d * (size_t)s->n_x + (size_t)x]);
        }
        fputc('\n', f);
    }
    for (int k = 0; k < s->n_inputs; k++) {
        bool is_zero = true;
        for (int d = 0; d < s->n_pairs; d++) {
            is_zero = is_zero && step->of_s[(size_t)d * (size_t)s->n_inputs + (size_t)k] == 0.0;
        }
        if (is_zero) {
            continue;
        }
        fprintf(f, k == 0 ? "    the constant" : "    %s at the end of the step times",
                k == 0 ? "" : s->input_element[k]);
        for (int d = 0; d < s->n_pairs; d++) {
            fprintf(f, " %.7g", step->of_s[(size_t)d * (size_t)s->n_inputs + (size_t)k]);
        }
        fputc('\n', f);
    }
}

void dalcs_one_step_begin_latex(FILE *f, const struct dalcs_circuit *circuit) {
    struct dalcs_printer p = {.out = f, .latex = true, .circuit = circuit};
    dalcs_print_latex_begin(f);
    fputs("% as wide as the page at most\n"
          "\\newcommand{\\fit}[1]{\\setbox0\\hbox{$\\displaystyle #1$}%\n"
          "  \\ifdim\\wd0>\\linewidth\\resizebox{\\linewidth}{!}{\\box0}\\else\\box0\\fi}\n"
          "\\section*{",
          f);
    dalcs_print_name(&p, circuit->title);
    fputs("}\n", f);
}

/* Part of w: a matrix of n_columns, of which those that are 0 are left out where it is not M. */
struct part {
    const char *name;
    const double *a;
    int n_columns;
    bool is_square;
};

static bool is_used(const struct dalcs_one_step *step, const struct part *part, int column) {
    for (int d = 0; d < step->system->n_pairs; d++) {
        if (part->a[(size_t)d * (size_t)part->n_columns + (size_t)column] != 0.0) {
            return true;
        }
    }
    return part->is_square;
}

static void write_matrix(struct dalcs_printer *p, const struct dalcs_one_step *step,
                         const struct part *part) {
    FILE *f = p->out;
    fprintf(f, "\\[\\fit{%s=\\left(\\begin{array}{*{%d}{r}}\n", part->name, part->n_columns);
    for (int d = 0; d < step->system->n_pairs; d++) {
        bool is_first = true;
        for (int j = 0; j < part->n_columns; j++) {
            if (!is_used(step, part, j)) {
                continue;
            }
            double value = part->a[(size_t)d * (size_t)part->n_columns + (size_t)j];
            fputs(is_first ? "" : " & ", f);
            dalcs_print_digits(p, value, 7);
            is_first = false;
        }
        fputs("\\\\\n", f);
    }
    fputs("\\end{array}\\right)}\\]\n", f);
}

/* $x = (v_{c1}, ...)$ in running text, only what w has of it. */
static void write_vector(struct dalcs_printer *p, const struct dalcs_one_step *step,
                         const struct part *part, int which) {
    static const char *const letter[] = {"\\lambda", "x_k", "s"};
    const struct dalcs_system *s = step->system;
    bool is_first = true;
    for (int j = 0; j < part->n_columns; j++) {
        if (!is_used(step, part, j)) {
            continue;
        }
        fprintf(p->out, is_first ? "$%s=($" : ", ", letter[which]);
        fputc('$', p->out);
        if (which == 2 && j == 0) {
            fputc('1', p->out);
        } else if (which == 2) {
            dalcs_print_input(p, s->input_element[j]);
        } else {
            dalcs_print_column(p, s, which == 0 ? dalcs_system_n_equations(s) + j : j, 0);
        }
        fputc('$', p->out);
        is_first = false;
    }
    fputs(is_first ? "" : "$)$\n\n", p->out);
}

void dalcs_one_step_write_latex(FILE *f, const struct dalcs_circuit *circuit,
                                const struct dalcs_one_step *step) {
    const struct dalcs_system *s = step->system;
    struct dalcs_printer p = {.out = f, .latex = true, .circuit = circuit};
    if (step->is_singular) {
        fputs("A step of $h=", f);
        dalcs_print_value(&p, 1.0 / step->sigma, "s");
        fputs("$: $N(\\sigma)$ is singular, $\\sigma=1/h$. Without complementarity the step is not "
              "determined, and $\\lambda$ alone does not determine $x$ and $z$.\n\n",
              f);
        return;
    }

    const struct part part[] = {{"M", step->M, s->n_pairs, true},
                                {"Q_x", step->of_x, s->n_x, false},
                                {"Q_s", step->of_s, s->n_inputs, false}};
    static const char *const times[] = {"M\\lambda", "+Q_x x_k", "+Q_s s"};
    bool has[3] = {true, false, false};
    for (int k = 1; k < 3; k++) {
        for (int j = 0; j < part[k].n_columns; j++) {
            has[k] = has[k] || is_used(step, &part[k], j);
        }
    }
    fputs("\\[0\\le\\lambda\\perp ", f);
    for (int k = 0; k < 3; k++) {
        fputs(has[k] ? times[k] : "", f);
    }
    fputs("\\ge 0,\\qquad h=", f);
    dalcs_print_value(&p, 1.0 / step->sigma, "s");
    fputs("\\]\n{\\raggedright\\noindent ", f);
    for (int k = 0; k < 3; k++) {
        write_vector(&p, step, &part[k], k);
    }
    fputs("}\n", f);
    for (int k = 0; k < 3; k++) {
        if (has[k] && s->n_pairs > 0) {
            write_matrix(&p, step, &part[k]);
        }
    }
}

static void write_json_matrix(FILE *f, const char *name, const double *a, int n_rows,
                              int n_columns) {
    fprintf(f, ",\n\"%s\": [", name);
    for (int i = 0; i < n_rows; i++) {
        fputs(i > 0 ? ",\n[" : "[", f);
        for (int j = 0; j < n_columns; j++) {
            fputs(j > 0 ? ", " : "", f);
            dalcs_write_number(f, a[(size_t)i * (size_t)n_columns + (size_t)j]);
        }
        fputc(']', f);
    }
    fputc(']', f);
}

static void write_json_name(FILE *f, const char *name) {
    fputc('"', f);
    for (const char *p = name; *p != '\0'; p++) {
        fprintf(f, *p == '"' || *p == '\\' ? "\\%c" : "%c", *p);
    }
    fputc('"', f);
}

void dalcs_one_step_write_json(FILE *f, const struct dalcs_one_step *step) {
    const struct dalcs_system *s = step->system;
    fputs("{\"sigma\": ", f);
    dalcs_write_number(f, step->sigma);
    for (int part = 0; part < 3; part++) {
        static const char *const key[] = {"lambda", "x", "s"};
        int n = part == 0 ? s->n_pairs : part == 1 ? s->n_x : s->n_inputs;
        fprintf(f, ", \"%s\": [", key[part]);
        for (int k = 0; k < n; k++) {
            const char *name = part == 0   ? s->pair[k].element
                               : part == 1 ? s->column[k].element
                               : k == 0    ? "1"
                                           : s->input_element[k];
            fputs(k > 0 ? ", " : "", f);
            write_json_name(f, name);
        }
        fputc(']', f);
    }
    if (step->is_singular) {
        fputs(", \"singular\": true", f);
    } else {
        write_json_matrix(f, "M", step->M, s->n_pairs, s->n_pairs);
        write_json_matrix(f, "Qx", step->of_x, s->n_pairs, s->n_x);
        write_json_matrix(f, "Qs", step->of_s, s->n_pairs, s->n_inputs);
    }
    fputs("}", f);
}

enum dalcs_status dalcs_one_step_write_market(const struct dalcs_one_step *step, int part,
                                              const struct dalcs_equations_files *files) {
    const struct dalcs_system *s = step->system;

    const struct {
        const char *name;
        const double *a;
        int n_columns;
    } matrix[] = {
        {"M", step->M, s->n_pairs}, {"Qx", step->of_x, s->n_x}, {"Qs", step->of_s, s->n_inputs}};
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < 3 && status == DALCS_OK && !step->is_singular; k++) {
        char suffix[40];
        char *text = NULL;
        size_t length;
        if (part == 0) {
            snprintf(suffix, sizeof suffix, ".%s.mtx", matrix[k].name);
        } else {
            snprintf(suffix, sizeof suffix, ".%d.%s.mtx", part, matrix[k].name);
        }
        FILE *f = open_memstream(&text, &length);
        if (f == NULL) {
            return DALCS_E_NOMEM;
        }
        fprintf(f, "%%%%MatrixMarket matrix array real general\n%d %d\n", s->n_pairs,
                matrix[k].n_columns);
        for (int j = 0; j < matrix[k].n_columns; j++) {
            for (int i = 0; i < s->n_pairs; i++) {
                dalcs_write_number(
                    f, matrix[k].a[(size_t)i * (size_t)matrix[k].n_columns + (size_t)j]);
                fputc('\n', f);
            }
        }
        bool lost = ferror(f) != 0;
        lost = fclose(f) != 0 || lost || text == NULL;
        status = lost ? DALCS_E_NOMEM : files->file(files->user, suffix, text, length);
        free(text);
    }
    return status;
}
