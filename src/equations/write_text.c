/* write_text.c - a network for people: every equation on a line, with the names of elements, in plain text
 * or as a LaTeX document. What stands here has the meaning of the matrices, not their signs: of a circuit an
 * equation 0 = ... may be turned around, and a sum begins with a positive term. */
#include "equations.h"
#include "printer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct writer {
    struct dalcs_printer p;
    const struct dalcs_equations *e;
    bool names_resistors; /* some equation has v/R */
};

/* Devices up to which resistors are looked up for each equation. */
enum { MOST_DEVICES = 2000 };

/* Left sides wider than that, in pt, stand on a line of their own. */
static const double widest_left = 150.0;

static bool is_circuit(const struct writer *w) {
    return w->p.circuit->n_devices > 0;
}

/* ---- Resistors in the law of a node ---------------------------------------------------------- */

static int column_of_node(const struct writer *w, const struct dalcs_system *s, int node) {
    for (int c = s->n_x; c < dalcs_system_n_equations(s); c++) {
        if (s->column[c].kind == DALCS_LABEL_NODE &&
            strcmp(s->column[c].element, w->p.circuit->node_name[node]) == 0) {
            return c;
        }
    }
    return -1;
}

static double entry(const struct dalcs_csr *a, int row, int column) {
    double sum = 0.0;
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        sum += a->j[k] == column ? a->x[k] : 0.0;
    }
    return sum;
}

/* A resistor from the node of a row, and the columns of its ends; to: -1 is ground. */
struct resistor {
    const struct dalcs_device *device;
    int from, to;
};

/* The next resistor after device `after` that the row has with its whole conductance. */
static bool next_resistor(const struct writer *w, const struct dalcs_system *s, int row, int after,
                          int *device, struct resistor *found) {
    const struct dalcs_circuit *c = w->p.circuit;
    if (c->n_devices > MOST_DEVICES || s->row[row].kind != DALCS_LABEL_NODE) {
        return false;
    }
    for (int i = after + 1; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (d->kind != DALCS_RESISTOR || d->value == 0.0) {
            continue;
        }
        for (int end = 0; end < 2; end++) {
            int here = d->node[end];
            int there = d->node[1 - end];
            if (here == 0 || strcmp(c->node_name[here], s->row[row].element) != 0) {
                continue;
            }
            *found = (struct resistor){d, column_of_node(w, s, here),
                                       there == 0 ? -1 : column_of_node(w, s, there)};
            double least = (1.0 - 1e-9) / d->value;
            if (d->value > 0.0 && found->from >= 0 && -entry(&s->A, row, found->from) >= least &&
                (there == 0 || (found->to >= 0 && entry(&s->A, row, found->to) >= least))) {
                *device = i;
                return true;
            }
        }
    }
    return false;
}

/* A row's entry less its resistors. */
static double without_resistors(const struct writer *w, const struct dalcs_system *s, int row,
                                int column, double value) {
    double left = value;
    double size = fabs(value);
    struct resistor r;
    for (int i = -1; next_resistor(w, s, row, i, &i, &r);) {
        double share = column == r.from ? 1.0 / r.device->value
                       : column == r.to ? -1.0 / r.device->value
                                        : 0.0;
        left += share;
        size += fabs(share);
    }
    return fabs(left) <= 1e-13 * size ? 0.0 : left;
}

/* ---- Sums ---------------------------------------------------------------------------------- */

/* A row of columns and inputs, either may be NULL, times a sign. */
struct sum {
    const struct dalcs_system *s;
    const struct dalcs_csr *columns, *inputs;
    int row;
    double sign;
    bool has_resistors;
};

/* A term of which at most one of these is set; all are 0 of the constant. */
struct term {
    double factor;
    int column, input;
    struct resistor resistor;
};

static void put_fraction(struct writer *w, const struct dalcs_system *s, const struct term *t) {
    const struct resistor *r = &t->resistor;
    struct dalcs_printer *p = &w->p;
    dalcs_print_factor(p, t->factor < 0.0 ? -1.0 : 1.0);
    dalcs_print(p, r->to >= 0 ? "(" : "", "\\frac{", 0.0);
    dalcs_print_column(p, s, r->from, 0);
    if (r->to >= 0) {
        dalcs_print(p, " - ", " - ", 12.5);
        dalcs_print_column(p, s, r->to, 0);
    }
    dalcs_print(p, r->to >= 0 ? ")/" : "/", "}{", 0.0);
    double width = p->width;
    dalcs_print_element(p, r->device->name);
    p->width = width + 3.0;
    dalcs_print(p, "", "}", 0.0);
    w->names_resistors = true;
}

static void put_plain_term(struct writer *w, const struct sum *sum, const struct term *t) {
    struct dalcs_printer *p = &w->p;
    if (t->resistor.device != NULL) {
        put_fraction(w, sum->s, t);
    } else if (t->column >= 0) {
        dalcs_print_factor(p, t->factor);
        dalcs_print_column(p, sum->s, t->column, 0);
    } else if (t->input > 0) {
        dalcs_print_factor(p, t->factor);
        dalcs_print_input(p, sum->s->input_element[t->input]);
    } else {
        dalcs_print_factor(p, t->factor < 0.0 ? -1.0 : 1.0);
        dalcs_print_number(p, fabs(t->factor));
    }
}

/* LaTeX does not break lines of formulas: here one ends before a term that would reach as far as `width`. */
static void break_line(struct writer *w, double width) {
    struct dalcs_printer *p = &w->p;
    if (p->latex && p->out != NULL && p->limit > 0.0 && p->n_terms > 0 && width > p->limit) {
        fputs("\\\\\n&\\quad {}", p->out);
        p->width = 20.0;
    }
}

static void put_term(struct writer *w, const struct sum *sum, const struct term *t) {
    struct writer measure = *w;
    measure.p.out = NULL;
    put_plain_term(&measure, sum, t);
    break_line(w, measure.p.width);
    put_plain_term(w, sum, t);
}

/* Either the first positive term alone, or all others. */
struct pass {
    bool only_first;
    bool found;
};

static void offer(struct writer *w, const struct sum *sum, const struct term *t,
                  struct pass *pass) {
    bool is_first = !pass->found && t->factor > 0.0;
    pass->found = pass->found || is_first;
    if (t->factor != 0.0 && is_first == pass->only_first) {
        put_term(w, sum, t);
    }
}

static void put_pass(struct writer *w, const struct sum *sum, struct pass *pass) {
    const struct dalcs_csr *a = sum->columns;
    for (int k = a == NULL ? 0 : a->p[sum->row]; a != NULL && k < a->p[sum->row + 1]; k++) {
        double value =
            sum->has_resistors ? without_resistors(w, sum->s, sum->row, a->j[k], a->x[k]) : a->x[k];
        offer(w, sum, &(struct term){sum->sign * value, a->j[k], 0, {0}}, pass);
    }
    struct resistor r;
    for (int i = -1; sum->has_resistors && next_resistor(w, sum->s, sum->row, i, &i, &r);) {
        double sign = -sum->sign; /* of v(from) */
        if (r.to >= 0 && sign < 0.0) {
            r = (struct resistor){r.device, r.to, r.from};
            sign = 1.0;
        }
        offer(w, sum, &(struct term){sign, -1, 0, r}, pass);
    }
    for (int constant = 0; constant < 2; constant++) {
        for (int k = sum->inputs == NULL ? 0 : sum->inputs->p[sum->row];
             sum->inputs != NULL && k < sum->inputs->p[sum->row + 1]; k++) {
            int input = sum->inputs->j[k];
            if ((input == 0) == (constant == 1)) {
                offer(w, sum, &(struct term){sum->sign * sum->inputs->x[k], -1, input, {0}}, pass);
            }
        }
    }
}

static void put_sum(struct writer *w, const struct sum *sum) {
    w->p.n_terms = 0;
    struct pass pass = {.only_first = is_circuit(w)};
    if (is_circuit(w)) {
        put_pass(w, sum, &pass);
        pass = (struct pass){0};
    } else {
        pass.found = true; /* the order of the columns, as the papers have it */
    }
    put_pass(w, sum, &pass);
    dalcs_print_sum_end(&w->p);
}

/* ---- Rows ---------------------------------------------------------------------------------- */

/* The capacitor or coil whose value this is: C1 says more than 1e-06. */
static bool is_value_of(const struct writer *w, const char *name, double value) {
    const struct dalcs_circuit *c = w->p.circuit;
    for (int i = 0; i < c->n_devices; i++) {
        bool stores = c->device[i].kind == DALCS_CAPACITOR || c->device[i].kind == DALCS_INDUCTOR;
        if (stores && c->device[i].value == fabs(value) && strcmp(c->device[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* Of a circuit: the sign with which the row has more positive terms, or its derivative is positive. */
static double sign_of(const struct writer *w, const struct dalcs_system *s, int row) {
    int n = 0;
    if (row < s->n_x) {
        n = s->P.p[row] < s->P.p[row + 1] && s->P.x[s->P.p[row]] < 0.0 ? -1 : 1;
    } else {
        for (int k = s->A.p[row]; k < s->A.p[row + 1]; k++) {
            n += s->A.x[k] > 0.0 ? 1 : -1;
        }
    }
    return is_circuit(w) && n < 0 ? -1.0 : 1.0;
}

static void put_derivative(struct writer *w, const struct dalcs_system *s, int row, int k) {
    struct dalcs_printer *p = &w->p;
    int c = s->P.j[k];
    double value = sign_of(w, s, row) * s->P.x[k];
    bool is_named = is_circuit(w) && is_value_of(w, s->column[c].element, value);
    dalcs_print_factor(p, is_named ? (value < 0.0 ? -1.0 : 1.0) : value);
    if (is_named) {
        dalcs_print_element(p, s->column[c].element);
        dalcs_print(p, " ", "\\,", 2.0);
    }
    bool is_velocity = !is_circuit(w) && strncmp(s->column[c].element, "d(", 2) == 0;
    dalcs_print(p, is_velocity ? "d " : "d", "", 0.0);
    dalcs_print_column(p, s, c, 1);
    dalcs_print(p, "/dt", "", 0.0);
}

static void put_left(struct writer *w, const struct dalcs_system *s, int row) {
    w->p.n_terms = 0;
    for (int k = row < s->n_x ? s->P.p[row] : 0; row < s->n_x && k < s->P.p[row + 1]; k++) {
        struct writer measure = *w;
        measure.p.out = NULL;
        put_derivative(&measure, s, row, k);
        break_line(w, measure.p.width);
        put_derivative(w, s, row, k);
    }
    dalcs_print_sum_end(&w->p);
}

static void put_switch_left(struct writer *w, const struct dalcs_system *s, int d) {
    dalcs_print_column(&w->p, s, dalcs_system_n_equations(s) + d, 0);
    dalcs_print(&w->p, " = 0 or 0", " = 0 \\text{ or } 0", 60.0);
}

static double width_of_left(const struct writer *w, const struct dalcs_system *s, int row, int d) {
    struct writer measure = *w;
    measure.p.out = NULL;
    measure.p.width = 0.0;
    if (d >= 0) {
        put_switch_left(&measure, s, d);
    } else {
        put_left(&measure, s, row);
    }
    return measure.p.width;
}

/* The room in a line for the right sides of a system. */
static double limit_of(const struct writer *w, const struct dalcs_system *s) {
    double widest = 40.0; /* 0 <= i(d) */
    for (int i = 0; w->p.latex && i < dalcs_system_n_equations(s) + s->n_pairs; i++) {
        int d = i - dalcs_system_n_equations(s);
        if (d < 0 || s->pair[d].kind == DALCS_PAIR_SWITCH) {
            double width = width_of_left(w, s, i, d);
            widest = width > widest && width <= widest_left ? width : widest;
        }
    }
    return dalcs_latex_line - widest - 35.0; /* the signs of equality and inequality */
}

static void begin_row(struct writer *w, bool *is_first) {
    if (w->p.out == NULL) {
        return;
    }
    fputs(!w->p.latex ? "  " : *is_first ? "" : "\\\\\n", w->p.out);
    *is_first = false;
}

static void put_row(struct writer *w, const struct dalcs_system *s, int row) {
    struct dalcs_printer *p = &w->p;
    bool is_wide = p->latex && width_of_left(w, s, row, -1) > widest_left;
    dalcs_print(p, "", is_wide ? "&" : "", 0.0);
    p->width = 0.0;
    put_left(w, s, row);
    dalcs_print(p, " = ", is_wide ? "\\\\\n&\\quad {}= " : " &= ", 0.0);
    p->width = is_wide ? 30.0 : 0.0;
    put_sum(w, &(struct sum){s, &s->A, &s->E, row, sign_of(w, s, row), is_circuit(w)});
    if (p->latex) {
        return;
    }
    static const char *const of_file[] = {[DALCS_LABEL_STATE] = "state",
                                          [DALCS_LABEL_NODE] = "node",
                                          [DALCS_LABEL_BRANCH] = "row",
                                          [DALCS_LABEL_REFERENCE] = "reference"};
    const struct dalcs_label *label = &s->row[row];
    fprintf(p->out, "      [%s %s]\n",
            is_circuit(w) ? dalcs_label_equation(label->kind) : of_file[label->kind],
            label->element);
}

static void put_w(struct writer *w, const struct dalcs_system *s, int d) {
    put_sum(w, &(struct sum){s, &s->C, &s->F, d, 1.0, false});
}

/* vg(t) > 0.5, and below what it opens where that is another threshold. */
static void put_control(struct writer *w, const struct dalcs_system *s, int d) {
    struct dalcs_printer *p = &w->p;
    const struct dalcs_pair *pair = &s->pair[d];
    bool has_hysteresis = pair->turn_on != pair->turn_off;
    double limit = p->limit;
    p->limit = 0.0; /* in running text */
    dalcs_print(p, has_hysteresis ? "closes when " : "closed while ",
                has_hysteresis ? " closes when $" : " is closed while $", 0.0);
    if (pair->is_direct) {
        put_sum(w, &(struct sum){s, NULL, &s->direct_control, d, 1.0, false});
    } else {
        put_sum(w, &(struct sum){s, &s->control, NULL, d, 1.0, false});
    }
    dalcs_print(p, " > ", " > ", 0.0);
    dalcs_print_number(p, pair->turn_on);
    if (has_hysteresis) {
        dalcs_print(p, ", opens below ", "$, opens below $", 0.0);
        dalcs_print_number(p, pair->turn_off);
    }
    dalcs_print(p, "", "$", 0.0);
    p->limit = limit;
}

static void put_switch(struct writer *w, const struct dalcs_system *s, int d) {
    put_switch_left(w, s, d);
    dalcs_print(&w->p, " = ", " &= ", 0.0);
    w->p.width = 0.0;
    put_w(w, s, d);
    if (!w->p.latex) {
        fputs("      [", w->p.out);
        put_control(w, s, d);
        fputs("]\n", w->p.out);
    }
}

static void put_pair(struct writer *w, const struct dalcs_system *s, int d) {
    dalcs_print(&w->p, "0 <= ", "0 \\le ", 0.0);
    dalcs_print_column(&w->p, s, dalcs_system_n_equations(s) + d, 0);
    dalcs_print(&w->p, " _|_ ", " &\\perp ", 0.0);
    w->p.width = 0.0;
    put_w(w, s, d);
    dalcs_print(&w->p, " >= 0\n", " \\ge 0", 0.0);
}

static void put_system(struct writer *w, const struct dalcs_system *s, int index) {
    struct dalcs_printer *p = &w->p;
    int n = w->e->network->n_systems;
    int n_equations = dalcs_system_n_equations(s);
    if (n > 1) {
        fprintf(p->out, p->latex ? "\\subsection*{Part %d of %d}\n" : "part %d of %d\n", index + 1,
                n);
    }
    if (n_equations + s->n_pairs == 0) {
        return;
    }
    bool is_first = true;
    p->limit = limit_of(w, s);
    dalcs_print(p, "", "\\begin{align*}\n", 0.0);
    for (int r = 0; r < n_equations; r++) {
        begin_row(w, &is_first);
        put_row(w, s, r);
    }
    for (int d = 0; d < s->n_pairs; d++) {
        begin_row(w, &is_first);
        if (s->pair[d].kind == DALCS_PAIR_SWITCH) {
            put_switch(w, s, d);
        } else {
            put_pair(w, s, d);
        }
    }
    dalcs_print(p, "", "\n\\end{align*}\n", 0.0);
}

/* ---- What the names stand for ---------------------------------------------------------------- */

static bool begin_values(struct writer *w, bool begun) {
    if (!begun) {
        dalcs_print(&w->p, "\nwhere\n", "where\n\\begin{itemize}\\raggedright\n", 0.0);
    }
    return true;
}

static const char *input_of(const struct dalcs_network *n, int stimulus) {
    for (int k = 0; k < n->n_systems; k++) {
        for (int u = 1; u < n->system[k].n_inputs; u++) {
            if (n->system[k].stimulus[u] == stimulus) {
                return n->system[k].input_element[u];
            }
        }
    }
    return NULL;
}

static bool put_sources(struct writer *w, bool begun) {
    struct dalcs_printer *p = &w->p;
    const struct dalcs_circuit *c = p->circuit;
    for (int i = 0; i < c->n_stimuli; i++) {
        const struct dalcs_stimulus *stimulus = &c->stimulus[i];
        const char *name = input_of(w->e->network, i);
        if (name == NULL || (c->n_smooth > 0 && i == c->smooth_stimulus)) {
            continue;
        }
        begun = begin_values(w, begun);
        dalcs_print(p, "  ", "\\item[] $", 0.0);
        dalcs_print_input(p, name);
        if (stimulus->kind == DALCS_STIMULUS_DC) {
            dalcs_print(p, " = ", " = ", 0.0);
            dalcs_print_number(p, stimulus->dc);
            dalcs_print(p, "\n", "$\n", 0.0);
        } else {
            dalcs_print(p, " = ", "$ = \\texttt{", 0.0);
            dalcs_write_stimulus(p->out, stimulus);
            dalcs_print(p, "\n", "}\n", 0.0);
        }
    }
    return begun;
}

static void put_argument(struct writer *w, const struct dalcs_system *s,
                         const struct dalcs_smooth_input *of, int k) {
    if (of->column[k] >= 0) {
        dalcs_print_column(&w->p, s, of->column[k], 0);
    } else {
        dalcs_print_number(&w->p, of->number[k]);
    }
}

/* f(a) = v(x) * v(y), or = exp(v(x)) */
static bool put_smooth(struct writer *w, bool begun) {
    const struct dalcs_network *n = w->e->network;
    struct dalcs_printer *p = &w->p;
    for (int q = 0; q < n->n_systems; q++) {
        for (int k = 0; k < n->system[q].n_smooth; k++) {
            const struct dalcs_smooth_input *of = &n->system[q].smooth[k];
            const char *name = dalcs_smooth_name(of->kind);
            const bool is_infix = *name == '*' || *name == '/';
            begun = begin_values(w, begun);
            dalcs_print(p, "  ", "\\item[] $", 0.0);
            dalcs_print_input(p, of->element);
            dalcs_print(p, " = ", " = ", 0.0);
            if (!is_infix) {
                fprintf(p->out, p->latex ? "\\mathrm{%s}(" : "%s(", name);
            }
            put_argument(w, &n->system[q], of, 0);
            for (int j = 1; j < of->n; j++) {
                fputs(!is_infix                  ? ", "
                      : p->latex && *name == '*' ? " \\cdot "
                      : *name == '*'             ? " * "
                                                 : " / ",
                      p->out);
                put_argument(w, &n->system[q], of, j);
            }
            fputs(is_infix ? "" : ")", p->out);
            dalcs_print(p, "\n", "$\n", 0.0);
        }
    }
    return begun;
}

/* When switches close, which LaTeX's formulas have no room for. */
static bool put_switches(struct writer *w, bool begun) {
    const struct dalcs_network *n = w->e->network;
    for (int k = 0; k < n->n_systems && w->p.latex; k++) {
        for (int d = 0; d < n->system[k].n_pairs; d++) {
            if (n->system[k].pair[d].kind != DALCS_PAIR_SWITCH) {
                continue;
            }
            begun = begin_values(w, begun);
            fputs("\\item[] ", w->p.out);
            dalcs_print_name(&w->p, n->system[k].pair[d].element);
            put_control(w, &n->system[k], d);
            fputc('\n', w->p.out);
        }
    }
    return begun;
}

/* Some to a line. */
static bool put_elements(struct writer *w, bool begun) {
    struct dalcs_printer *p = &w->p;
    const struct dalcs_circuit *c = p->circuit;
    int n = 0;
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        const char *unit = d->kind == DALCS_CAPACITOR                        ? "F"
                           : d->kind == DALCS_INDUCTOR                       ? "H"
                           : d->kind == DALCS_RESISTOR && w->names_resistors ? "Ohm"
                                                                             : NULL;
        if (unit == NULL || d->value == 0.0) {
            continue;
        }
        begun = begin_values(w, begun);
        dalcs_print(p,
                    n == 0       ? "  "
                    : n % 5 == 0 ? ",\n  "
                                 : ", ",
                    n == 0 ? "\\item[] $" : ", $", 0.0);
        dalcs_print_element(p, d->name);
        dalcs_print(p, " = ", " = ", 0.0);
        dalcs_print_value(p, d->value, unit);
        dalcs_print(p, "", "$", 0.0);
        n++;
    }
    if (n > 0) {
        fputc('\n', p->out);
    }
    return begun;
}

static void put_values(struct writer *w) {
    bool begun = put_smooth(w, put_sources(w, false));
    begun = put_switches(w, begun);
    begun = put_elements(w, begun);
    dalcs_print(&w->p, "", begun ? "\\end{itemize}\n" : "", 0.0);
}

void dalcs_equations_write_text(FILE *f, const struct dalcs_equations *equations) {
    struct writer w = {.p = {.out = f, .circuit = equations->circuit}, .e = equations};
    fprintf(f, "%s\n", equations->circuit->title);
    for (int k = 0; k < equations->network->n_systems; k++) {
        fputc('\n', f);
        put_system(&w, &equations->network->system[k], k);
    }
    put_values(&w);
}

void dalcs_equations_write_latex(FILE *f, const struct dalcs_equations *equations) {
    struct writer w = {.p = {.out = f, .latex = true, .circuit = equations->circuit},
                       .e = equations};
    dalcs_print_latex_begin(f);
    fputs("\\section*{", f);
    dalcs_print_name(&w.p, equations->circuit->title);
    fputs("}\n", f);
    for (int k = 0; k < equations->network->n_systems; k++) {
        put_system(&w, &equations->network->system[k], k);
    }
    put_values(&w);
    fputs("\\end{document}\n", f);
}
