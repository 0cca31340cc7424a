/* printer.h - names, numbers and terms of equations for people, in plain text or in LaTeX. */
#ifndef DALCS_PRINTER_H
#define DALCS_PRINTER_H

#include "network.h"

#include <stdio.h>

struct dalcs_printer {
    FILE *out; /* NULL: only measure */
    bool latex;
    const struct dalcs_circuit *circuit; /* without devices: of a system file */
    double width;                        /* LaTeX: of the present line so far, about, in pt */
    double limit;                        /* LaTeX: of a line; 0: breaks itself */
    int n_terms;                         /* of the present sum */
};

/* What LaTeX's documents here begin with. `width` below is theirs. */
void dalcs_print_latex_begin(FILE *f);

/* Of a line of text, in pt. */
extern const double dalcs_latex_line;

/* Plain or LaTeX, whichever the printer writes; of a width in LaTeX. */
void dalcs_print(struct dalcs_printer *p, const char *plain, const char *latex, double width);

/* A name in running text. */
void dalcs_print_name(struct dalcs_printer *p, const char *name);

/* Ten digits. */
void dalcs_print_number(struct dalcs_printer *p, double value);
void dalcs_print_digits(struct dalcs_printer *p, double value, int n_digits);

/* With a prefix, "25 uH". */
void dalcs_print_value(struct dalcs_printer *p, double value, const char *unit);

/* The value of an element, C1. */
void dalcs_print_element(struct dalcs_printer *p, const char *name);

/* v(out), i(l1), lambda(d); in LaTeX with dots for derivatives. Columns of a system file have their own
 * names. */
void dalcs_print_column(struct dalcs_printer *p, const struct dalcs_system *s, int column,
                        int n_dots);

/* v1(t) */
void dalcs_print_input(struct dalcs_printer *p, const char *name);

/* A sign, and a factor where it is not 1, of what follows. */
void dalcs_print_factor(struct dalcs_printer *p, double value);

/* The sum of terms that p wrote since the last one, 0 if there were none. */
void dalcs_print_sum_end(struct dalcs_printer *p);

#endif
