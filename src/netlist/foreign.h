/* foreign.h - what is read as a netlist by mistake: drawings of circuits, files of matrices, signs of printed text. */
#ifndef DALCS_FOREIGN_H
#define DALCS_FOREIGN_H

#include "netlist.h"

/* Reports a text of a known kind that is no netlist. The kind follows from its first bytes or the name of its file;
 * else
 * false. */
bool dalcs_foreign_is_reported(struct dalcs_netlist *netlist, const struct dalcs_source *source,
                               const char *text, size_t length, struct dalcs_diag *diag);

/* What to write in place of a dash, a quotation mark or a sign of another language in a word; else NULL. */
const char *dalcs_foreign_sign(const char *word, size_t length);

#endif
