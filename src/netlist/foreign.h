/* foreign.h - what is read as a netlist by mistake: drawings of circuits, files of matrices, signs of printed text. */
#ifndef DALCS_FOREIGN_H
#define DALCS_FOREIGN_H

#include <stddef.h>

/* What a file is, and how to get a netlist of it or run it. */
struct dalcs_foreign {
    const char *what, *hint;
};

/* What this text in a file of that name is; NULL: a netlist, as far as is known. */
const struct dalcs_foreign *dalcs_foreign_file(const char *name, const char *text, size_t length);

/* What to write in place of a dash, a quotation mark or a sign of another language in a word; else NULL. */
const char *dalcs_foreign_sign(const char *word, size_t length);

#endif
