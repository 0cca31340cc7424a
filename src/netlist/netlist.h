/* netlist.h - a netlist as text: a title and cards made of tokens, each of which knows its place.
 *
 * Nothing here knows what a resistor is. Lexical rules (doc/netlist.md says them for users):
 * the first line is the title; '*' starts a comment line, ';' a trailing comment, and so does '$'
 * between blanks; a line that starts with '+' continues the last card, over blank and comment
 * lines; '.end' ends it all. Blanks and commas separate; '=', '(' and ')' are tokens of their own;
 * '...', "..." and {...} are one token each. */
#ifndef DALCS_NETLIST_H
#define DALCS_NETLIST_H

#include "diag.h"

enum dalcs_token_kind {
    DALCS_TOKEN_WORD,       /* a name, keyword or number: lower case */
    DALCS_TOKEN_STRING,     /* quoted: case kept, quotes removed */
    DALCS_TOKEN_EXPRESSION, /* {...}: lower case, braces removed */
    DALCS_TOKEN_EQUAL,
    DALCS_TOKEN_OPEN,
    DALCS_TOKEN_CLOSE,
    DALCS_TOKEN_BAD /* an error was reported: readers fail without another word */
};

/* A physical line. */
struct dalcs_source_line {
    const char *file;
    const char *text; /* without its newline; bytes that are no text are shown as '?' */
    int number;       /* from 1 */
};

struct dalcs_token {
    const struct dalcs_source_line *line;
    const char *text; /* NUL-terminated */
    int offset;       /* of the token's first byte in line->text, quote or brace included */
    int length;       /* its bytes there */
    enum dalcs_token_kind kind;
    bool after_comma; /* a comma stands between it and the token before */
};

struct dalcs_card {
    const struct dalcs_token *token;
    int n; /* at least 1 */
};

/* Zero-initialise, read, then finish. */
struct dalcs_netlist {
    const char *name; /* the file's path, or what read_text was told */
    const char *title;
    const struct dalcs_source_line *title_line;
    struct dalcs_card *card;
    size_t n_cards;
    size_t capacity;
    bool has_errors; /* of spelling: a circuit cannot be built, but may be looked at for more */
    struct dalcs_arena arena;
};

/* Reads text[0..length-1], which messages call `name`. Errors of spelling go to diag and set
 * has_errors; the result is DALCS_OK all the same, so that the errors of meaning can be found too
 * (dalcs_circuit_build refuses such a netlist). Fails with DALCS_E_NOMEM or DALCS_E_LIMIT only. */
enum dalcs_status dalcs_netlist_read_text(struct dalcs_netlist *netlist, const char *name,
                                          const char *text, size_t length,
                                          struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* The same from a file. DALCS_E_IO, with a message, when it cannot be read. */
enum dalcs_status dalcs_netlist_read_file(struct dalcs_netlist *netlist, const char *path,
                                          struct dalcs_diag *diag) DALCS_MUST_CHECK;

void dalcs_netlist_finish(struct dalcs_netlist *netlist);

/* Where a token stands; borrows from the netlist. */
struct dalcs_location dalcs_token_location(const struct dalcs_token *token);

/* From one token to another; underlines all between them when they share a line. */
struct dalcs_location dalcs_token_span(const struct dalcs_token *first,
                                       const struct dalcs_token *last);

/* The place just after a token, where something is missing. */
struct dalcs_location dalcs_token_end(const struct dalcs_token *token);

#endif
