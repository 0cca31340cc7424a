/* lexer.h - physical lines to cards; used by netlist.c only. Bytes are looked at in lexer_characters.c, cards are made in
 * lexer_cards.c. */
#ifndef DALCS_LEXER_H
#define DALCS_LEXER_H

#include "names.h"
#include "netlist.h"

/* One file's text, line by line. `raw` is shown in messages, tokens point into `low`: both
 * have the same length and the same offsets. */
struct dalcs_lexer {
    struct dalcs_netlist *netlist;
    const struct dalcs_source *source;
    struct dalcs_diag *diag;
    char *raw;
    char *low;
    int line_number;
    bool in_control; /* between .control and .endc, which hold another language */
    bool ended;      /* .end was seen */

    bool has_invalid; /* bytes that are no text */

    size_t at; /* the line being read starts here; in the end the length of the text */
    size_t length;

    struct {
        const char *wanted; /* the only one of a library, else NULL */
        bool is_found;
        bool is_skipped;                /* one that is not wanted, until .endl */
        const struct dalcs_token *open; /* the .lib of the one being read, else NULL */
        struct dalcs_names *all;        /* of the library; for messages */
    } section;

    size_t ascii_begin, ascii_end;        /* raw between them is ASCII */
    const struct dalcs_source_line *line; /* the present one, made when first needed */
    struct dalcs_token *token;            /* of the card being read */
    size_t n_tokens;
    bool after_comma; /* the card so far ends with one */
    size_t capacity;
};

/* Stands in `low` for a byte that is no text; `raw` shows it as '?'. */
enum { DALCS_LEXER_INVALID = '\x01' };

static inline bool dalcs_lexer_is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/* Lower-cases raw[begin..length-1] into `low` and marks what is no text, before any line is read. */
void dalcs_lexer_clean(struct dalcs_lexer *lexer, size_t begin);

/* Reads the line raw[begin..end-1] (newline not included; raw[end] may be overwritten). */
enum dalcs_status dalcs_lexer_read_line(struct dalcs_lexer *lexer, size_t begin,
                                        size_t end) DALCS_MUST_CHECK;

/* Ends the last card. */
enum dalcs_status dalcs_lexer_flush(struct dalcs_lexer *lexer) DALCS_MUST_CHECK;

/* Does the line at p start with this word? */
bool dalcs_lexer_starts_with(const struct dalcs_lexer *lexer, size_t p, const char *word);

void dalcs_lexer_report(struct dalcs_lexer *lexer, const struct dalcs_token *token,
                        const char *hint, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* ---- include.c ----------------------------------------------------------------------------- */

/* Is this card .include, .lib or .endl, or an alias of them? */
bool dalcs_include_is_card(const char *name);

/* Reads what the card names into the netlist, or begins or ends a section. */
enum dalcs_status dalcs_include_card(struct dalcs_lexer *lexer,
                                     const struct dalcs_card *card) DALCS_MUST_CHECK;

/* Of a library of which one section is read: is the line at p, whose first byte that is not blank
 * is at p, outside it? */
enum dalcs_status dalcs_include_skips(struct dalcs_lexer *lexer, size_t p,
                                      bool *skips) DALCS_MUST_CHECK;

/* ---- netlist.c ----------------------------------------------------------------------------- */

/* Reads the text of a file into the netlist; `section` NULL: all of it. `call` is the word that names
 * the section. */
enum dalcs_status dalcs_source_read(struct dalcs_netlist *netlist,
                                    const struct dalcs_source *source, const char *text,
                                    size_t length, const struct dalcs_token *section,
                                    struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
