/* write_text.c - a network for people: every equation on a line, with the names of elements, in plain text
 * or as a LaTeX document. What stands here has the meaning of the matrices, not their signs: of a circuit an
 * equation 0 = ... may be turned around, and a sum begins with a positive term. */
#include "write_text.h"

#include <math.h>
#include <string.h>

/* Left sides wider than that, in pt, stand on a line of their own. */
static const double widest_left = 150.0;

/* The capacitor or coil whose value this is: C1 says more than 1e-06. */
static bool is_value_of(const struct dalcs_text_writer *w, const char *name, double value) {
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
static double sign_of(const struct dalcs_text_writer *w, const struct dalcs_system *s, int row) {
    int n = 0;
    if (row < s->n_x) {
        n = s->P.p[row] < s->P.p[row + 1] && s->P.x[s->P.p[row]] < 0.0 ? -1 : 1;
    } else {
        for (int k = s->A.p[row]; k < s->A.p[row + 1]; k++) {
            n += s->A.x[k] > 0.0 ? 1 : -1;
        }
    }
    return dalcs_text_is_circuit(w) && n < 0 ? -1.0 : 1.0;
}

static void put_derivative(struct dalcs_text_writer *w, const struct dalcs_system *s, int row,
                           int k) {
    struct dalcs_printer *p = &w->p;
    int c = s->P.j[k];
    double value = sign_of(w, s, row) * s->P.x[k];
    bool is_named = dalcs_text_is_circuit(w) && is_value_of(w, s->column[c].element, value);
    dalcs_print_factor(p, is_named ? (value < 0.0 ? -1.0 : 1.0) : value);
    if (is_named) {
        dalcs_print_element(p, s->column[c].element);
        dalcs_print(p, " ", "\\,", 2.0);
    }
    bool is_velocity = !dalcs_text_is_circuit(w) && strncmp(s->column[c].element, "d(", 2) == 0;
    dalcs_print(p, is_velocity ? "d " : "d", "", 0.0);
    dalcs_print_column(p, s, c, 1);
    dalcs_print(p, "/dt", "", 0.0);
}

static void put_left(struct dalcs_text_writer *w, const struct dalcs_system *s, int row) {
    w->p.n_terms = 0;
    for (int k = row < s->n_x ? s->P.p[row] : 0; row < s->n_x && k < s->P.p[row + 1]; k++) {
        struct dalcs_text_writer measure = *w;
        measure.p.out = NULL;
        put_derivative(&measure, s, row, k);
        dalcs_text_break_line(w, measure.p.width);
        put_derivative(w, s, row, k);
    }
    dalcs_print_sum_end(&w->p);
}

static void put_switch_left(struct dalcs_text_writer *w, const struct dalcs_system *s, int d) {
    dalcs_print_column(&w->p, s, dalcs_system_n_equations(s) + d, 0);
    dalcs_print(&w->p, " = 0 or 0", " = 0 \\text{ or } 0", 60.0);
}

static double width_of_left(const struct dalcs_text_writer *w, const struct dalcs_system *s,
                            int row, int d) {
    struct dalcs_text_writer measure = *w;
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
static double limit_of(const struct dalcs_text_writer *w, const struct dalcs_system *s) {
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

static void begin_row(struct dalcs_text_writer *w, bool *is_first) {
    if (w->p.out == NULL) {
        return;
    }
    fputs(!w->p.latex ? "  " : *is_first ? "" : "\\\\\n", w->p.out);
    *is_first = false;
}

static void put_row(struct dalcs_text_writer *w, const struct dalcs_system *s, int row) {
    struct dalcs_printer *p = &w->p;
    bool is_wide = p->latex && width_of_left(w, s, row, -1) > widest_left;
    dalcs_print(p, "", is_wide ? "&" : "", 0.0);
    p->width = 0.0;
    put_left(w, s, row);
    dalcs_print(p, " = ", is_wide ? "\\\\\n&\\quad {}= " : " &= ", 0.0);
    p->width = is_wide ? 30.0 : 0.0;
    dalcs_text_put_sum(w, &(struct dalcs_text_sum){s, &s->A, &s->E, row, sign_of(w, s, row),
                                                   dalcs_text_is_circuit(w)});
    if (p->latex) {
        return;
    }
    static const char *const of_file[] = {[DALCS_LABEL_STATE] = "state",
                                          [DALCS_LABEL_NODE] = "node",
                                          [DALCS_LABEL_BRANCH] = "row",
                                          [DALCS_LABEL_REFERENCE] = "reference"};
    const struct dalcs_label *label = &s->row[row];
    fprintf(p->out, "      [%s %s]\n",
            dalcs_text_is_circuit(w) ? dalcs_label_equation(label->kind) : of_file[label->kind],
            label->element);
}

static void put_w(struct dalcs_text_writer *w, const struct dalcs_system *s, int d) {
    dalcs_text_put_sum(w, &(struct dalcs_text_sum){s, &s->C, &s->F, d, 1.0, false});
}

/* vg(t) > 0.5, and below what it opens where that is another threshold. */
void dalcs_text_put_control(struct dalcs_text_writer *w, const struct dalcs_system *s, int d) {
    struct dalcs_printer *p = &w->p;
    const struct dalcs_pair *pair = &s->pair[d];
    bool has_hysteresis = pair->turn_on != pair->turn_off;
    double limit = p->limit;
    p->limit = 0.0; /* in running text */
    dalcs_print(p, has_hysteresis ? "closes when " : "closed while ",
                has_hysteresis ? " closes when $" : " is closed while $", 0.0);
    if (pair->is_direct) {
        dalcs_text_put_sum(w, &(struct dalcs_text_sum){s, NULL, &s->direct_control, d, 1.0, false});
    } else {
        dalcs_text_put_sum(w, &(struct dalcs_text_sum){s, &s->control, NULL, d, 1.0, false});
    }
    dalcs_print(p, " > ", " > ", 0.0);
    dalcs_print_number(p, pair->turn_on);
    if (has_hysteresis) {
        dalcs_print(p, ", opens below ", "$, opens below $", 0.0);
        dalcs_print_number(p, pair->turn_off);
    }
    if (pair->has_valve) {
        dalcs_print(p, ", and below the former while ", "$, and below the former while ", 0.0);
        dalcs_print_name(p, s->pair[pair->valve].element);
    }
    dalcs_print(p, pair->has_valve ? " blocks" : "", pair->has_valve ? " blocks" : "$", 0.0);
    p->limit = limit;
}

static void put_switch(struct dalcs_text_writer *w, const struct dalcs_system *s, int d) {
    put_switch_left(w, s, d);
    dalcs_print(&w->p, " = ", " &= ", 0.0);
    w->p.width = 0.0;
    put_w(w, s, d);
    if (!w->p.latex) {
        fputs("      [", w->p.out);
        dalcs_text_put_control(w, s, d);
        fputs("]\n", w->p.out);
    }
}

static void put_pair(struct dalcs_text_writer *w, const struct dalcs_system *s, int d) {
    dalcs_print(&w->p, "0 <= ", "0 \\le ", 0.0);
    dalcs_print_column(&w->p, s, dalcs_system_n_equations(s) + d, 0);
    dalcs_print(&w->p, " _|_ ", " &\\perp ", 0.0);
    w->p.width = 0.0;
    put_w(w, s, d);
    dalcs_print(&w->p, " >= 0\n", " \\ge 0", 0.0);
}

static void put_system(struct dalcs_text_writer *w, const struct dalcs_system *s, int index) {
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

void dalcs_equations_write_text(FILE *f, const struct dalcs_equations *equations) {
    struct dalcs_text_writer w = {.p = {.out = f, .circuit = equations->circuit}, .e = equations};
    fprintf(f, "%s\n", equations->circuit->title);
    for (int k = 0; k < equations->network->n_systems; k++) {
        fputc('\n', f);
        put_system(&w, &equations->network->system[k], k);
    }
    dalcs_text_put_values(&w);
}

void dalcs_equations_write_latex(FILE *f, const struct dalcs_equations *equations) {
    struct dalcs_text_writer w = {.p = {.out = f, .latex = true, .circuit = equations->circuit},
                                  .e = equations};
    dalcs_print_latex_begin(f);
    fputs("\\section*{", f);
    dalcs_print_name(&w.p, equations->circuit->title);
    fputs("}\n", f);
    for (int k = 0; k < equations->network->n_systems; k++) {
        put_system(&w, &equations->network->system[k], k);
    }
    dalcs_text_put_values(&w);
    fputs("\\end{document}\n", f);
}
