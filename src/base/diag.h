/* diag.h - what a person reads: messages with a place in the netlist, a caret and a hint.
 *
 * Collected, never printed here; only the program's main.c prints. */
#ifndef DALCS_DIAG_H
#define DALCS_DIAG_H

#include "memory.h"

#include <stdarg.h>

enum dalcs_severity { DALCS_NOTE, DALCS_WARNING, DALCS_ERROR };

/* A place in a netlist. line and column count from 1; line 0 means "no place". */
struct dalcs_location {
    const char *file;        /* borrowed: lives as long as the netlist or circuit that made it */
    const char *source_line; /* borrowed: the physical line's text without its newline, or NULL */
    int line;
    int column;
    int length; /* characters to underline, at least 1 */
};

struct dalcs_diagnostic {
    enum dalcs_severity severity;
    int line;
    int column;
    char *text; /* the whole formatted message: "file:line:col: error: ...", source line, caret,
                   hint; ends without a newline */
};

struct dalcs_diag {
    struct dalcs_diagnostic *item;
    size_t n;
    size_t capacity;
    size_t n_errors;
    bool out_of_memory; /* a message was lost */
};

/* Adds a message. `where` may be NULL or have line 0. `hint` (may be NULL) is printed on its own
 * line as "  hint: ...". At most 1000 messages are kept; a last one says that there were more. */
void dalcs_diag_add(struct dalcs_diag *diag, enum dalcs_severity severity,
                    const struct dalcs_location *where, const char *hint, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

void dalcs_diag_finish(struct dalcs_diag *diag);

#endif
