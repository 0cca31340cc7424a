/* lexer.h - physical lines to cards; used by netlist.c only. */
#ifndef DALCS_LEXER_H
#define DALCS_LEXER_H

#include "netlist.h"

/* A netlist's text, line by line. `raw` is shown to people, `low` is what tokens point into: both
 * have the same length and the same offsets. */
struct dalcs_lexer {
    struct dalcs_netlist *netlist;
    struct dalcs_diag *diag;
    char *raw;
    char *low;
    int line_number;
    bool in_control; /* between .control and .endc, which hold another language */
    bool ended;      /* .end was seen */

    const struct dalcs_source_line *line; /* the present one, made when first needed */
    struct dalcs_token *token;            /* of the card being read */
    size_t n_tokens;
    size_t capacity;
};

/* Reads the line raw[begin..end-1] (newline not included; raw[end] may be overwritten). */
enum dalcs_status dalcs_lexer_read_line(struct dalcs_lexer *lexer, size_t begin,
                                        size_t end) DALCS_MUST_CHECK;

/* Ends the last card. */
enum dalcs_status dalcs_lexer_flush(struct dalcs_lexer *lexer) DALCS_MUST_CHECK;

#endif
