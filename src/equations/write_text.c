/* write_text.c - a network for people: every equation on a line, with the names of elements, in plain text
 * or as a LaTeX document. */
#include "equations.h"

#include <math.h>
#include <string.h>

struct printer {
    FILE *out;
    const struct dalcs_equations *e;
    bool latex;
    int n_terms; /* on the present line */
};

/* LaTeX does not break lines of formulas. */
enum { TERMS_ON_A_LINE = 6 };

/* ---- Names --------------------------------------------------------------------------------- */

static void put_name(const struct printer *p, const char *name) {
    if (!p->latex) {
        fputs(name, p->out);
        return;
    }
    for (const char *c = name; *c != '\0'; c++) {
        if (strchr("\\~^", *c) != NULL) {
            fputs(*c == '\\' ? "\\textbackslash{}" : *c == '~' ? "\\~{}" : "\\^{}", p->out);
        } else {
            fprintf(p->out, strchr("_#$%&{}", *c) != NULL ? "\\%c" : "%c", *c);
        }
    }
}

/* v(c1), i(l1), v(out) of a circuit; a column of a system file by its own name */
static void put_quantity(const struct printer *p, char letter, const char *name) {
    if (letter == '\0') {
        fputs(p->latex ? "\\mathit{" : "", p->out);
        put_name(p, name);
        fputs(p->latex ? "}" : "", p->out);
    } else {
        fprintf(p->out, p->latex ? "%c_{\\mathrm{" : "%c(", letter);
        put_name(p, name);
        fputs(p->latex ? "}}" : ")", p->out);
    }
}

static bool is_circuit(const struct printer *p) {
    return p->e->circuit->n_devices > 0;
}

/* The lambdas of one B source are told apart by numbers. */
static void put_lambda(const struct printer *p, const struct dalcs_system *s, int d) {
    const struct dalcs_pair *pair = &s->pair[d];
    if (is_circuit(p) && !pair->is_formula) {
        put_quantity(p, 'i', pair->element);
        if (pair->is_breakdown) {
            fputs(p->latex ? "^{\\mathrm{rev}}" : "_rev", p->out);
        }
        return;
    }
    int before = 0;
    while (pair->is_formula && before < d &&
           strcmp(s->pair[d - before - 1].element, pair->element) == 0) {
        before++;
    }
    fputs(p->latex ? "\\lambda_{\\mathrm{" : "lambda(", p->out);
    put_name(p, pair->element);
    if (pair->is_formula) {
        fprintf(p->out, ",%d", before + 1);
    }
    fputs(p->latex ? "}}" : ")", p->out);
}

static void put_column(const struct printer *p, const struct dalcs_system *s, int c) {
    if (c >= dalcs_system_n_equations(s)) {
        put_lambda(p, s, c - dalcs_system_n_equations(s));
        return;
    }
    char letter = s->column_is_current[c] ? 'i' : 'v';
    put_quantity(p, is_circuit(p) ? letter : '\0', s->column[c].element);
}

/* ---- Terms --------------------------------------------------------------------------------- */

static void put_number(const struct printer *p, double value) {
    char text[40];
    snprintf(text, sizeof text, "%.10g", value);
    const char *exponent = strchr(text, 'e');
    if (!p->latex || exponent == NULL) {
        fputs(text, p->out);
    } else {
        int power = 0;
        (void)sscanf(exponent + 1, "%d", &power);
        fprintf(p->out, "%.*s\\cdot 10^{%d}", (int)(exponent - text), text, power);
    }
}

/* A sign, and the number where it is not 1; of what follows. */
static void put_factor(struct printer *p, double value) {
    bool is_first = p->n_terms++ == 0;
    if (p->latex && !is_first && (p->n_terms - 1) % TERMS_ON_A_LINE == 0) {
        fputs("\\\\\n&\\quad {}", p->out);
    }
    fputs(value < 0.0 ? (is_first ? "-" : " - ") : (is_first ? "" : " + "), p->out);
    if (fabs(value) != 1.0) {
        put_number(p, fabs(value));
        fputs(p->latex ? "\\," : " ", p->out);
    }
}

static void put_columns(struct printer *p, const struct dalcs_system *s, const struct dalcs_csr *a,
                        int row) {
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        put_factor(p, a->x[k]);
        put_column(p, s, a->j[k]);
    }
}

static void put_inputs(struct printer *p, const struct dalcs_system *s, const struct dalcs_csr *a,
                       int row) {
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        if (a->j[k] > 0) {
            put_factor(p, a->x[k]);
            put_name(p, "");
            fputs(p->latex ? "\\mathrm{" : "", p->out);
            put_name(p, s->input_element[a->j[k]]);
            fputs(p->latex ? "}(t)" : "(t)", p->out);
            continue;
        }
        bool is_first = p->n_terms++ == 0;
        fputs(a->x[k] < 0.0 ? (is_first ? "-" : " - ") : (is_first ? "" : " + "), p->out);
        put_number(p, fabs(a->x[k]));
    }
}

static void end_sum(struct printer *p) {
    if (p->n_terms == 0) {
        fputc('0', p->out);
    }
    p->n_terms = 0;
}

/* ---- Rows ---------------------------------------------------------------------------------- */

/* The capacitor or coil whose value this is: C1 says more than 1e-06. */
static const char *element_of_value(const struct printer *p, const char *name, double value) {
    const struct dalcs_circuit *c = p->e->circuit;
    for (int i = 0; i < c->n_devices; i++) {
        bool stores = c->device[i].kind == DALCS_CAPACITOR || c->device[i].kind == DALCS_INDUCTOR;
        if (stores && c->device[i].value == value && strcmp(c->device[i].name, name) == 0) {
            return c->device[i].name;
        }
    }
    return NULL;
}

static void put_derivatives(struct printer *p, const struct dalcs_system *s, int row) {
    for (int k = s->P.p[row]; k < s->P.p[row + 1]; k++) {
        int c = s->P.j[k];
        const char *name = element_of_value(p, s->column[c].element, s->P.x[k]);
        put_factor(p, name != NULL ? 1.0 : s->P.x[k]);
        if (name != NULL) {
            fputs(p->latex ? "\\mathrm{" : "", p->out);
            fputc(name[0] >= 'a' && name[0] <= 'z' ? name[0] - 'a' + 'A' : name[0], p->out);
            put_name(p, name + 1);
            fputs(p->latex ? "}\\," : " ", p->out);
        }
        fputs(p->latex ? "\\dot{" : "d", p->out);
        put_column(p, s, c);
        fputs(p->latex ? "}" : "/dt", p->out);
    }
    end_sum(p);
}

static void put_row_end(const struct printer *p, const struct dalcs_system *s, int row) {
    if (p->latex) {
        fputs("\\\\\n", p->out);
        return;
    }
    static const char *const of_file[] = {[DALCS_LABEL_STATE] = "state",
                                          [DALCS_LABEL_NODE] = "node",
                                          [DALCS_LABEL_BRANCH] = "row",
                                          [DALCS_LABEL_REFERENCE] = "reference"};
    const struct dalcs_label *label = &s->row[row];
    fprintf(p->out, "      [%s %s]\n",
            is_circuit(p) ? dalcs_label_equation(label->kind) : of_file[label->kind],
            label->element);
}

static void put_rows(struct printer *p, const struct dalcs_system *s) {
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        fputs(p->latex ? "" : "  ", p->out);
        if (r < s->n_x) {
            put_derivatives(p, s, r);
        } else {
            fputc('0', p->out);
        }
        fputs(p->latex ? " &= " : " = ", p->out);
        put_columns(p, s, &s->A, r);
        put_inputs(p, s, &s->E, r);
        end_sum(p);
        put_row_end(p, s, r);
    }
}

static void put_w(struct printer *p, const struct dalcs_system *s, int pair) {
    put_columns(p, s, &s->C, pair);
    put_inputs(p, s, &s->F, pair);
    end_sum(p);
}

/* closed while control > on ..., with the two branches of the switch */
static void put_switch(struct printer *p, const struct dalcs_system *s, int d) {
    const struct dalcs_pair *pair = &s->pair[d];
    fputs(p->latex ? "" : "  ", p->out);
    put_lambda(p, s, d);
    fputs(p->latex ? " = 0 \\text{ or } 0 &= " : " = 0 (open) or 0 = ", p->out);
    put_w(p, s, d);
    fputs(p->latex ? " \\text{ (open or closed; closes above " : " (closed); closes when ", p->out);
    if (p->latex) {
        fputs("$", p->out);
        put_number(p, pair->turn_on);
        fputs("$, opens below $", p->out);
        put_number(p, pair->turn_off);
        fputs("$, $", p->out);
    }
    if (!pair->is_direct) {
        put_columns(p, s, &s->control, d);
    }
    put_inputs(p, s, &s->direct_control, d);
    end_sum(p);
    if (p->latex) {
        fputs("$)}\\\\\n", p->out);
        return;
    }
    fputs(" > ", p->out);
    put_number(p, pair->turn_on);
    fputs(", opens below ", p->out);
    put_number(p, pair->turn_off);
    fputc('\n', p->out);
}

static void put_pairs(struct printer *p, const struct dalcs_system *s) {
    for (int d = 0; d < s->n_pairs; d++) {
        if (s->pair[d].kind == DALCS_PAIR_SWITCH) {
            put_switch(p, s, d);
            continue;
        }
        fputs(p->latex ? "0 \\le " : "  0 <= ", p->out);
        put_lambda(p, s, d);
        fputs(p->latex ? " &\\perp " : " _|_ ", p->out);
        put_w(p, s, d);
        fputs(p->latex ? " \\ge 0\\\\\n" : " >= 0\n", p->out);
    }
}

static void put_system(struct printer *p, const struct dalcs_system *s, int index) {
    int n = p->e->network->n_systems;
    if (n > 1) {
        fprintf(p->out, p->latex ? "\\subsection*{Part %d of %d}\n" : "part %d of %d\n", index + 1,
                n);
    }
    if (p->latex) {
        fputs("\\begin{align*}\n", p->out);
    }
    put_rows(p, s);
    put_pairs(p, s);
    fputs(p->latex ? "\\end{align*}\n" : "", p->out);
}

/* ---- What the names stand for ---------------------------------------------------------------- */

static void put_values(struct printer *p) {
    const struct dalcs_circuit *c = p->e->circuit;
    for (int i = 0; i < c->n_stimuli; i++) {
        const char *name = NULL;
        const struct dalcs_network *n = p->e->network;
        for (int k = 0; k < n->n_systems && name == NULL; k++) {
            for (int u = 1; u < n->system[k].n_inputs; u++) {
                name = n->system[k].stimulus[u] == i ? n->system[k].input_element[u] : name;
            }
        }
        if (name != NULL) {
            fputs(p->latex ? "\\item[] \\texttt{" : "  ", p->out);
            put_name(p, name);
            fputs("(t): ", p->out);
            dalcs_write_stimulus(p->out, &c->stimulus[i]);
            fputs(p->latex ? "}\n" : "\n", p->out);
        }
    }
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (d->kind == DALCS_CAPACITOR || d->kind == DALCS_INDUCTOR) {
            fputs(p->latex ? "\\item[] \\texttt{" : "  ", p->out);
            fputc(d->name[0] >= 'a' && d->name[0] <= 'z' ? d->name[0] - 'a' + 'A' : d->name[0],
                  p->out);
            put_name(p, d->name + 1);
            fprintf(p->out, " = %.10g %s%s", d->value, d->kind == DALCS_CAPACITOR ? "F" : "H",
                    p->latex ? "}\n" : "\n");
        }
    }
}

static bool has_values(const struct dalcs_equations *e) {
    return e->circuit->n_stimuli > 0 || e->network->n_states > 0;
}

void dalcs_equations_write_text(FILE *f, const struct dalcs_equations *equations) {
    struct printer p = {.out = f, .e = equations};
    fprintf(f, "%s\n", equations->circuit->title);
    for (int k = 0; k < equations->network->n_systems; k++) {
        fputc('\n', f);
        put_system(&p, &equations->network->system[k], k);
    }
    if (has_values(equations)) {
        fputs("\nwhere\n", f);
        put_values(&p);
    }
}

void dalcs_equations_write_latex(FILE *f, const struct dalcs_equations *equations) {
    struct printer p = {.out = f, .e = equations, .latex = true};
    fputs("\\documentclass{article}\n\\usepackage[utf8]{inputenc}\n\\usepackage{amsmath}\n"
          "\\allowdisplaybreaks\n\\begin{document}\n\\section*{",
          f);
    put_name(&p, equations->circuit->title);
    fputs("}\n", f);
    for (int k = 0; k < equations->network->n_systems; k++) {
        put_system(&p, &equations->network->system[k], k);
    }
    const struct dalcs_circuit *c = equations->circuit;
    bool has_items = c->n_stimuli > 0;
    for (int i = 0; i < c->n_devices && !has_items; i++) {
        has_items = c->device[i].kind == DALCS_CAPACITOR || c->device[i].kind == DALCS_INDUCTOR;
    }
    if (has_items) {
        fputs("where\n\\begin{itemize}\n", f);
        put_values(&p);
        fputs("\\end{itemize}\n", f);
    }
    fputs("\\end{document}\n", f);
}
