/* netlist.h - a netlist as text: a title and cards made of tokens, each with its line and column.
 *
 * The meaning of a card is not its matter (circuit/). Lexical rules (doc/netlist.md has them for users):
 * the first line is the title; '*' starts a comment line, ';' a trailing comment, and so does '$'
 * between blanks; a line that starts with '+' continues the last card, over blank and comment
 * lines; '.end' ends it all. Blanks and commas separate; '=', '(' and ')' are tokens of their own;
 * '...', "..." and {...} are one token each. The cards of .include and .lib are replaced by those of
 * the file they name. What .param, .subckt, X and .if mean is for the next folder to say. */
#ifndef DALCS_NETLIST_H
#define DALCS_NETLIST_H

#include "diag.h"
#include "dialect.h"

#include <stdint.h>

struct dalcs_formula;

enum dalcs_token_kind {
    DALCS_TOKEN_WORD,       /* a name, keyword or number: lower case */
    DALCS_TOKEN_STRING,     /* "...": case kept, quotes removed */
    DALCS_TOKEN_EXPRESSION, /* {...} or '...': lower case, braces or quotes removed */
    DALCS_TOKEN_NUMBER,     /* an expression that was evaluated: text is the expression's */
    DALCS_TOKEN_FORMULA,    /* an expression of voltages, currents and time (language/formula.h) */
    DALCS_TOKEN_EQUAL,
    DALCS_TOKEN_OPEN,
    DALCS_TOKEN_CLOSE,
    DALCS_TOKEN_BAD /* an error was reported: readers fail without another word */
};

enum { DALCS_LONGEST_TOKEN = (1 << 27) - 1 };

/* A file, or the text that was given in place of one. */
struct dalcs_source {
    const char *name;                    /* as messages call it */
    const char *real;                    /* its absolute path, NULL for a text */
    int number;                          /* in the order of reading, from 0 */
    const struct dalcs_source *outer;    /* the one that includes it, or NULL */
    const struct dalcs_origin *included; /* the same for messages */
};

/* A physical line. */
struct dalcs_source_line {
    const struct dalcs_source *source;
    const char *text;                    /* without its newline; bytes that are no text: '?' */
    const struct dalcs_origin *instance; /* in the copy that a subcircuit call makes, else NULL */
    int number;                          /* from 1 */
    int n_ascii; /* so many bytes from the first on are characters each, at least */
};

struct dalcs_token {
    const struct dalcs_source_line *line;
    const char *text; /* NUL-terminated */
    int offset;       /* of the token's first byte in line->text, quote or brace included */
    /* Half of a netlist in memory is tokens: these three share a word. */
    unsigned length : 27; /* its bytes there, at most DALCS_LONGEST_TOKEN */
    enum dalcs_token_kind kind : 4;
    bool after_comma : 1; /* a comma stands between it and the token before */

    union {
        double value;                        /* of a NUMBER */
        const struct dalcs_formula *formula; /* of a FORMULA */
    };
};

struct dalcs_card {
    const struct dalcs_token *token;
    int n;           /* at least 1 */
    char letter;     /* the first of its first word, before a subcircuit call puts its name there */
    double parallel; /* so many of them, by m= of subcircuit calls; 0: one */
};

/* `.model new ako:old [type] [parameters]` */
bool dalcs_card_is_derived_model(const struct dalcs_card *card);

/* The losses of the options of a command line, beside those of the netlist (circuit/losses.h). */
struct dalcs_losses_request {
    bool is_asked, has_window;
    double from, to; /* s; INFINITY: the end of the run */
};

/* Zero-initialise, set what stands before `name` if wanted, read, then finish. */
/* What a caller asks beside what the netlist says. */
struct dalcs_asks {
    struct dalcs_losses_request losses;
    bool steady;        /* the steady state, so that the netlist needs no analysis of its own, */
    bool response;      /* the response around it, */
    bool sensitivities; /* or how it depends on values */
    bool has_seed;      /* the next is told, whatever .options seed= says */
    uint64_t seed;      /* of random values */
    const char *transient, *transient_stop; /* in place of the netlist's .tran, or NULL; borrowed */
};

struct dalcs_source_lines {
    struct dalcs_source_line *line; /* [n] heap */
    size_t n, capacity;
};

enum dalcs_status dalcs_source_lines_add(struct dalcs_source_lines *lines,
                                         struct dalcs_source_line line) DALCS_MUST_CHECK;

struct dalcs_netlist {
    bool no_includes;             /* refuse .include and .lib: no other file is read */
    size_t most_cards;            /* that subcircuit calls may expand to; 0: DALCS_MOST_CARDS */
    struct dalcs_dialect dialect; /* once it is read: what it is written in */
    struct dalcs_asks asks;

    const char *name; /* the file's path, or what read_text was told */
    const char *title;
    const struct dalcs_source_line *title_line;
    struct dalcs_card *card;
    size_t n_cards;
    size_t capacity;
    struct dalcs_source_lines commands; /* the lines between .control and .endc, as written */
    struct dalcs_source_lines later;    /* analyses of a kind that was there before, as commands */
    bool has_errors;  /* of spelling: a circuit cannot be built, but may be looked at for more */
    bool misses_file; /* one that it includes could not be read: much may be undefined */
    const char *missing_library; /* the last one that is left out because it is not here; or NULL */
    bool has_tolerances;         /* DEV or LOT somewhere */
    bool has_language; /* expressions, parameters, subcircuits or conditions: must be expanded */
    int n_sources;     /* files read, the netlist itself included */
    size_t n_bytes;    /* of them together */
    struct dalcs_arena arena;
};

/* Reads text[0..length-1], which messages call `name`. Errors of spelling go to diag and set
 * has_errors; the result is DALCS_OK all the same, so that the errors of meaning can be found too
 * (dalcs_circuit_build refuses such a netlist). Fails with DALCS_E_NOMEM or DALCS_E_LIMIT only. */
enum dalcs_status dalcs_netlist_read_text(struct dalcs_netlist *netlist, const char *name,
                                          const char *text, size_t length,
                                          struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* The same where the text is that of the file at `path`, which must not include itself. */
enum dalcs_status dalcs_netlist_read_file_text(struct dalcs_netlist *netlist, const char *path,
                                               const char *text, size_t length,
                                               struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* The same from a file. DALCS_E_IO, with a message, when it cannot be read. */
enum dalcs_status dalcs_netlist_read_file(struct dalcs_netlist *netlist, const char *path,
                                          struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* Adds one more card, as if it stood on this line: text without its first dot, such as "tran 1u 1m".
 * `line` is of this netlist. Errors as above. */
enum dalcs_status dalcs_netlist_add_card(struct dalcs_netlist *netlist,
                                         const struct dalcs_source_line *line, const char *text,
                                         struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* Once all is read: .tran as `transient` and `transient_stop` say. */
enum dalcs_status dalcs_other_transient(struct dalcs_netlist *netlist,
                                        struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* Once all is read: a second .tran, .op, .dc or .ac is no card of the circuit, but is kept for `run`. */
enum dalcs_status dalcs_second_analyses(struct dalcs_netlist *netlist,
                                        struct dalcs_diag *diag) DALCS_MUST_CHECK;

enum { DALCS_MOST_CARDS = 20000000 };

void dalcs_netlist_finish(struct dalcs_netlist *netlist);

/* Where a token stands; borrows from the netlist. */
struct dalcs_location dalcs_token_location(const struct dalcs_token *token);

/* Is the token this word, unquoted? */
bool dalcs_token_is_word(const struct dalcs_token *token, const char *word);

/* From one token to another; underlines all between them when they share a line. */
struct dalcs_location dalcs_token_span(const struct dalcs_token *first,
                                       const struct dalcs_token *last);

/* The place just after a token, where something is missing. */
struct dalcs_location dalcs_token_end(const struct dalcs_token *token);

#endif
