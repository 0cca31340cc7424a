/* diag.h - what a person reads: messages with a place in the netlist, a caret and a hint.
 *
 * Collected, never printed here; only the program's main.c prints. */
#ifndef DALCS_DIAG_H
#define DALCS_DIAG_H

#include "memory.h"

#include <stdarg.h>

enum dalcs_severity { DALCS_NOTE, DALCS_WARNING, DALCS_ERROR };

/* Why a line counts: the card that calls its subcircuit or includes its file, and what that card is
 * in, outwards. */
struct dalcs_origin {
    const char *instance; /* "x1.x2"; NULL for an included file */
    const char *file;     /* where the calling or including card stands */
    int line;
    const struct dalcs_origin *outer; /* NULL: the netlist itself */
};

/* A place in a netlist. line and column count from 1; line 0 means "no place in the file". */
struct dalcs_location {
    const char *file;        /* borrowed: lives as long as the netlist or circuit that made it */
    const char *source_line; /* borrowed: the physical line's text without its newline, or NULL */
    int line;
    int column;      /* in characters (UTF-8 code points), as an editor counts */
    int length;      /* characters to underline, at least 1 */
    int file_number; /* of included files, in the order of reading; 0 for the netlist itself */
    const struct dalcs_origin *instance; /* borrowed: the subcircuit calls it is in, or NULL */
    const struct dalcs_origin *included; /* borrowed: how the file was included, or NULL */
};

struct dalcs_diagnostic {
    enum dalcs_severity severity;
    int file_number;
    int line; /* 0: no place */
    int column;
    const char
        *format; /* of a place in a subcircuit, else NULL: one mistake in its text is told once,
                           not once for each of its instances */
    char *text;  /* the whole formatted message: "file:line:col: error: ...", source line, caret,
                   hint; ends without a newline */
};

/* Zero-initialise; finish frees everything. */
struct dalcs_diag {
    struct dalcs_diagnostic *item;
    size_t n;
    size_t capacity;
    size_t n_errors;    /* all of them, kept or not */
    size_t n_other;     /* notes and warnings, kept or not */
    bool out_of_memory; /* a message was lost */
};

/* Messages kept: a flood of warnings must not push out an error. When one kind is full, a last
 * message says that there were more. */
enum { DALCS_DIAG_MAX_ERRORS = 800, DALCS_DIAG_MAX_OTHER = 200 };

/* Adds a message. `where` may be NULL or have line 0. `hint` (may be NULL) is printed on its own
 * line as "  hint: ...". */
void dalcs_diag_add(struct dalcs_diag *diag, enum dalcs_severity severity,
                    const struct dalcs_location *where, const char *hint, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

void dalcs_diag_add_list(struct dalcs_diag *diag, enum dalcs_severity severity,
                         const struct dalcs_location *where, const char *hint, const char *format,
                         va_list arguments) __attribute__((format(printf, 5, 0)));

/* Adds a message that is formatted already: the text of another list's item. */
void dalcs_diag_add_text(struct dalcs_diag *diag, enum dalcs_severity severity, const char *text);

/* Sorts by line and column, messages without a place last; equal places keep their order. Several
 * passes over a netlist find its errors in no order that a reader would expect. */
void dalcs_diag_sort(struct dalcs_diag *diag);

/* The number of messages, as a mark to return to. */
struct dalcs_diag_mark {
    size_t n, n_errors, n_other;
};

struct dalcs_diag_mark dalcs_diag_mark(const struct dalcs_diag *diag);

/* As if those behind the mark had not been. */
void dalcs_diag_forget(struct dalcs_diag *diag, const struct dalcs_diag_mark *mark);

/* Makes warnings of the errors behind the mark: "warning: no node 'c': CONSEQUENCE". Their number. */
size_t dalcs_diag_soften(struct dalcs_diag *diag, const struct dalcs_diag_mark *mark,
                         const char *consequence);

/* What a message says, without its place, its level and what stands below; of any other text its first line. */
const char *dalcs_diag_sentence(const char *text, size_t *length);

void dalcs_diag_finish(struct dalcs_diag *diag);

#endif
