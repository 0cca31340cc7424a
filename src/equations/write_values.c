/* write_values.c - what the names in equations stand for. */
#include "write_text.h"

static bool begin_values(struct dalcs_text_writer *w, bool begun) {
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

static bool put_sources(struct dalcs_text_writer *w, bool begun) {
    struct dalcs_printer *p = &w->p;
    const struct dalcs_circuit *c = p->circuit;
    for (int i = 0; i < c->n_stimuli; i++) {
        const struct dalcs_stimulus *stimulus = &c->stimulus[i];
        const char *name = input_of(w->e->network, i);
        if (name == NULL || (c->control.n_smooth > 0 && i == c->control.smooth_stimulus)) {
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

static void put_argument(struct dalcs_text_writer *w, const struct dalcs_system *s,
                         const struct dalcs_smooth_input *of, int k) {
    if (of->column[k] >= 0) {
        dalcs_print_column(&w->p, s, of->column[k], 0);
    } else {
        dalcs_print_number(&w->p, of->number[k]);
    }
}

/* f(a) = v(x) * v(y), or = exp(v(x)) */
static bool put_smooth(struct dalcs_text_writer *w, bool begun) {
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
static bool put_switches(struct dalcs_text_writer *w, bool begun) {
    const struct dalcs_network *n = w->e->network;
    for (int k = 0; k < n->n_systems && w->p.latex; k++) {
        for (int d = 0; d < n->system[k].n_pairs; d++) {
            if (n->system[k].pair[d].kind != DALCS_PAIR_SWITCH) {
                continue;
            }
            begun = begin_values(w, begun);
            fputs("\\item[] ", w->p.out);
            dalcs_print_name(&w->p, n->system[k].pair[d].element);
            dalcs_text_put_control(w, &n->system[k], d);
            fputc('\n', w->p.out);
        }
    }
    return begun;
}

/* Some to a line. */
static bool put_elements(struct dalcs_text_writer *w, bool begun) {
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

void dalcs_text_put_values(struct dalcs_text_writer *w) {
    bool begun = put_smooth(w, put_sources(w, false));
    begun = put_switches(w, begun);
    begun = put_elements(w, begun);
    dalcs_print(&w->p, "", begun ? "\\end{itemize}\n" : "", 0.0);
}
