/* one_step.c - the one-step problem of implicit Euler for given h, reduced to lambda: with sigma = 1/h and
 *
 *     N(sigma) = [sigma P - A_I  -B_I; -A_II  -B_II],
 *     w = M lambda + q,   M(sigma) = D + (C_I C_II) N(sigma)^-1 (Bbar_I; Bbar_II),
 *     q = F s + (C_I C_II) N(sigma)^-1 (sigma P x_k + E_I s; E_II s)
 *
 * (Brogliato 2022, eq. (3.2); Heemels, Schumacher and Weiland 1999, whose M(s) this is at s = 1/h). */
#include "eliminate.h"
#include "equations.h"
#include "printer.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double least_rcond = 1e-16;

struct work {
    double *N, *right; /* [n][n], [n][n_pairs + n_x + n_inputs] */
    double *row, *column;
    lapack_int *pivot;
};

static void fill(const struct dalcs_system *s, double sigma, struct work *w, size_t n,
                 size_t n_right) {
    for (size_t i = 0; i < n; i++) {
        int r = (int)i;
        for (int k = s->A.p[r]; k < s->A.p[r + 1]; k++) {
            size_t c = (size_t)s->A.j[k];
            if (c < n) {
                w->N[i * n + c] -= s->A.x[k];
            } else {
                w->right[i * n_right + (c - n)] += s->A.x[k];
            }
        }
        for (int k = r < s->n_x ? s->P.p[r] : 0; r < s->n_x && k < s->P.p[r + 1]; k++) {
            w->N[i * n + (size_t)s->P.j[k]] += sigma * s->P.x[k];
            w->right[i * n_right + (size_t)(s->n_pairs + s->P.j[k])] += sigma * s->P.x[k];
        }
        for (int k = s->E.p[r]; k < s->E.p[r + 1]; k++) {
            w->right[i * n_right + (size_t)(s->n_pairs + s->n_x + s->E.j[k])] += s->E.x[k];
        }
    }
}

/* By powers of 2, rows then columns. */
static void balance(struct work *w, size_t n, size_t n_right) {
    for (int by_column = 0; by_column < 2; by_column++) {
        for (size_t i = 0; i < n; i++) {
            double largest = 0.0;
            for (size_t j = 0; j < n; j++) {
                largest = fmax(largest, fabs(w->N[by_column ? j * n + i : i * n + j]));
            }
            int power = 0;
            (void)frexp(largest, &power);
            double scale = largest > 0.0 ? ldexp(1.0, -power) : 1.0;
            (by_column ? w->column : w->row)[i] = scale;
            for (size_t j = 0; j < n; j++) {
                w->N[by_column ? j * n + i : i * n + j] *= scale;
            }
            for (size_t j = 0; j < n_right && !by_column; j++) {
                w->right[i * n_right + j] *= scale;
            }
        }
    }
}

/* right becomes N^-1 right; false when N is singular. */
static enum dalcs_status solve(struct work *w, size_t n, size_t n_right, bool *is_singular) {
    lapack_int order = (lapack_int)n;
    double rcond = 0.0;
    double norm = dalcs_dense_one_norm(w->N, n);
    lapack_int info = LAPACKE_dgetrf(LAPACK_ROW_MAJOR, order, order, w->N, order, w->pivot);
    if (info == 0) {
        info = LAPACKE_dgecon(LAPACK_ROW_MAJOR, '1', order, w->N, order, norm, &rcond);
    }
    if (info == LAPACK_WORK_MEMORY_ERROR || info == LAPACK_TRANSPOSE_MEMORY_ERROR) {
        return DALCS_E_NOMEM;
    }
    *is_singular = info != 0 || rcond < least_rcond;
    if (*is_singular) {
        return DALCS_OK;
    }
    info = LAPACKE_dgetrs(LAPACK_ROW_MAJOR, 'N', order, (lapack_int)n_right, w->N, order, w->pivot,
                          w->right, (lapack_int)n_right);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n_right; j++) {
            w->right[i * n_right + j] *= w->column[i];
        }
    }
    return info == 0 ? DALCS_OK : DALCS_E_NOMEM;
}

/* An entry that is this part of what it is summed from is rounding. */
static const double rounding = 1e-14;

/* Pair d's coefficient of column j of `right`. */
static double coefficient(const struct dalcs_system *s, const struct work *w, int d, size_t j,
                          size_t n_right) {
    const size_t n = (size_t)dalcs_system_n_equations(s);
    double sum = 0.0;
    double size = 0.0;
    for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
        size_t c = (size_t)s->C.j[k];
        double factor = c < n ? w->right[c * n_right + j] : c - n == j ? 1.0 : 0.0;
        sum += s->C.x[k] * factor;
        size = fmax(size, fabs(s->C.x[k] * factor));
    }
    size_t first_input = (size_t)(s->n_pairs + s->n_x);
    for (int k = s->F.p[d]; k < s->F.p[d + 1]; k++) {
        double factor = first_input + (size_t)s->F.j[k] == j ? s->F.x[k] : 0.0;
        sum += factor;
        size = fmax(size, fabs(factor));
    }
    return fabs(sum) <= rounding * size ? 0.0 : sum;
}

/* What N^-1 left of 0, beside the rest of its column. */
static void drop_rounding(double *a, size_t n_rows, size_t n_columns) {
    for (size_t j = 0; j < n_columns; j++) {
        double largest = 0.0;
        for (size_t i = 0; i < n_rows; i++) {
            largest = fmax(largest, fabs(a[i * n_columns + j]));
        }
        for (size_t i = 0; i < n_rows; i++) {
            double *value = &a[i * n_columns + j];
            *value = fabs(*value) <= 1e-15 * largest ? 0.0 : *value;
        }
    }
}

static void read_off(struct dalcs_one_step *step, const struct work *w, size_t n_right) {
    const struct dalcs_system *s = step->system;
    for (int d = 0; d < s->n_pairs; d++) {
        double *const target[] = {step->M + (size_t)d * (size_t)s->n_pairs,
                                  step->of_x + (size_t)d * (size_t)s->n_x,
                                  step->of_s + (size_t)d * (size_t)s->n_inputs};
        const int width[] = {s->n_pairs, s->n_x, s->n_inputs};
        size_t from = 0;
        for (int part = 0; part < 3; part++) {
            for (int j = 0; j < width[part]; j++) {
                target[part][j] = coefficient(s, w, d, from++, n_right);
            }
        }
    }
    size_t n_pairs = (size_t)s->n_pairs;
    drop_rounding(step->M, n_pairs, n_pairs);
    drop_rounding(step->of_x, n_pairs, (size_t)s->n_x);
    drop_rounding(step->of_s, n_pairs, (size_t)s->n_inputs);
}

enum dalcs_status dalcs_one_step_of(struct dalcs_one_step *step, const struct dalcs_system *s,
                                    double h) {
    size_t n = (size_t)dalcs_system_n_equations(s);
    size_t n_pairs = (size_t)s->n_pairs;
    size_t n_right = n_pairs + (size_t)s->n_x + (size_t)s->n_inputs;
    *step = (struct dalcs_one_step){.system = s, .sigma = 1.0 / h};
    step->M = dalcs_alloc(n_pairs * n_pairs, sizeof *step->M);
    step->of_x = dalcs_alloc(n_pairs * (size_t)s->n_x, sizeof *step->of_x);
    step->of_s = dalcs_alloc(n_pairs * (size_t)s->n_inputs, sizeof *step->of_s);
    struct work w = {.N = dalcs_alloc(n * n, sizeof *w.N),
                     .right = dalcs_alloc(n * n_right, sizeof *w.right),
                     .row = dalcs_alloc(n, sizeof *w.row),
                     .column = dalcs_alloc(n, sizeof *w.column),
                     .pivot = dalcs_alloc(n, sizeof *w.pivot)};
    enum dalcs_status status = DALCS_E_NOMEM;
    if (step->M != NULL && step->of_x != NULL && step->of_s != NULL && w.N != NULL &&
        w.right != NULL && w.row != NULL && w.column != NULL && w.pivot != NULL) {
        fill(s, step->sigma, &w, n, n_right);
        balance(&w, n, n_right);
        status = n == 0 ? DALCS_OK : solve(&w, n, n_right, &step->is_singular);
        if (status == DALCS_OK && !step->is_singular) {
            read_off(step, &w, n_right);
        }
    }
    free(w.N);
    free(w.right);
    free(w.row);
    free(w.column);
    free(w.pivot);
    if (status != DALCS_OK) {
        dalcs_one_step_finish(step);
    }
    return status;
}

void dalcs_one_step_finish(struct dalcs_one_step *step) {
    free(step->M);
    free(step->of_x);
    free(step->of_s);
    *step = (struct dalcs_one_step){0};
}

/* ---- Writing ------------------------------------------------------------------------------- */

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

/* ---- In LaTeX ------------------------------------------------------------------------------ */

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

/* ---- For programs -------------------------------------------------------------------------- */

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
