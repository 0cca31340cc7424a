/* foreign.h - what reaches a netlist by mistake: drawings of circuits, signs of printed text. */
#ifndef DALCS_FOREIGN_H
#define DALCS_FOREIGN_H

#include <stddef.h>

/* A drawing of a circuit, which the program that made it writes as a netlist. */
struct dalcs_foreign {
    const char *program, *hint;
};

/* The program that drew this; NULL: none that is known. */
const struct dalcs_foreign *dalcs_foreign_drawing(const char *text, size_t length);

/* What to write in place of a dash, a quotation mark or a sign of another language in a word; else NULL. */
const char *dalcs_foreign_sign(const char *word, size_t length);

#endif
