/* write_sum.c - the terms of a sum: the first positive one first, resistors as v/R, lines that end in time. */
#include "write_text.h"

#include <math.h>
#include <string.h>

/* Devices up to which resistors are looked up for each equation. */
enum { MOST_DEVICES = 2000 };

/* ---- Resistors in the law of a node ---------------------------------------------------------- */

static int column_of_node(const struct dalcs_text_writer *w, const struct dalcs_system *s,
                          int node) {
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
static bool next_resistor(const struct dalcs_text_writer *w, const struct dalcs_system *s, int row,
                          int after, int *device, struct resistor *found) {
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
static double without_resistors(const struct dalcs_text_writer *w, const struct dalcs_system *s,
                                int row, int column, double value) {
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

/* A term of which at most one of these is set; all are 0 of the constant. */
struct term {
    double factor;
    int column, input;
    struct resistor resistor;
};

static void put_fraction(struct dalcs_text_writer *w, const struct dalcs_system *s,
                         const struct term *t) {
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

static void put_plain_term(struct dalcs_text_writer *w, const struct dalcs_text_sum *sum,
                           const struct term *t) {
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

void dalcs_text_break_line(struct dalcs_text_writer *w, double width) {
    struct dalcs_printer *p = &w->p;
    if (p->latex && p->out != NULL && p->limit > 0.0 && p->n_terms > 0 && width > p->limit) {
        fputs("\\\\\n&\\quad {}", p->out);
        p->width = 20.0;
    }
}

static void put_term(struct dalcs_text_writer *w, const struct dalcs_text_sum *sum,
                     const struct term *t) {
    struct dalcs_text_writer measure = *w;
    measure.p.out = NULL;
    put_plain_term(&measure, sum, t);
    dalcs_text_break_line(w, measure.p.width);
    put_plain_term(w, sum, t);
}

/* Either the first positive term alone, or all others. */
struct pass {
    bool only_first;
    bool found;
};

static void offer(struct dalcs_text_writer *w, const struct dalcs_text_sum *sum,
                  const struct term *t, struct pass *pass) {
    bool is_first = !pass->found && t->factor > 0.0;
    pass->found = pass->found || is_first;
    if (t->factor != 0.0 && is_first == pass->only_first) {
        put_term(w, sum, t);
    }
}

static void put_pass(struct dalcs_text_writer *w, const struct dalcs_text_sum *sum,
                     struct pass *pass) {
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

void dalcs_text_put_sum(struct dalcs_text_writer *w, const struct dalcs_text_sum *sum) {
    w->p.n_terms = 0;
    struct pass pass = {.only_first = dalcs_text_is_circuit(w)};
    if (dalcs_text_is_circuit(w)) {
        put_pass(w, sum, &pass);
        pass = (struct pass){0};
    } else {
        pass.found = true; /* the order of the columns, as the papers have it */
    }
    put_pass(w, sum, &pass);
    dalcs_print_sum_end(&w->p);
}
