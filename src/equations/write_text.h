/* write_text.h - what the files that write equations for people share. */
#ifndef DALCS_WRITE_TEXT_H
#define DALCS_WRITE_TEXT_H

#include "equations.h"
#include "printer.h"

struct dalcs_text_writer {
    struct dalcs_printer p;
    const struct dalcs_equations *e;
    bool names_resistors; /* some equation has v/R */
};

static inline bool dalcs_text_is_circuit(const struct dalcs_text_writer *w) {
    return w->p.circuit->n_devices > 0;
}

/* ---- write_sum.c --------------------------------------------------------------------------- */

/* A row of columns and inputs, either may be NULL, times a sign. */
struct dalcs_text_sum {
    const struct dalcs_system *s;
    const struct dalcs_csr *columns, *inputs;
    int row;
    double sign;
    bool has_resistors;
};

void dalcs_text_put_sum(struct dalcs_text_writer *w, const struct dalcs_text_sum *sum);

/* LaTeX does not break lines of formulas: here one ends before a term that would reach as far as `width`. */
void dalcs_text_break_line(struct dalcs_text_writer *w, double width);

/* ---- write_values.c ------------------------------------------------------------------------ */

/* What the names stand for: sources, smooth sources, switches, elements. */
void dalcs_text_put_values(struct dalcs_text_writer *w);

/* ---- write_text.c -------------------------------------------------------------------------- */

/* When a switch closes. */
void dalcs_text_put_control(struct dalcs_text_writer *w, const struct dalcs_system *s, int d);

#endif
