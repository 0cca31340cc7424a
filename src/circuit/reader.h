/* reader.h - walks over the tokens of one card.
 * Private to this folder and to equations/, whose system files are made of the same cards. */
#ifndef DALCS_READER_H
#define DALCS_READER_H

#include "builder.h"

struct dalcs_reader {
    struct dalcs_builder *builder;
    const struct dalcs_card *card;
    int at;            /* the next token */
    const char *usage; /* "R1 a b value": the hint when the card's shape is wrong */
};

/* What a number stands for: decides which suffixes are probably meant otherwise. */
enum dalcs_quantity {
    DALCS_PLAIN,
    DALCS_OHM,
    DALCS_FARAD,
    DALCS_HENRY,
    DALCS_VOLTAGE,
    DALCS_CURRENT,
    DALCS_SECOND,
    DALCS_HERTZ
};

/* Starts after the card's first token. */
struct dalcs_reader dalcs_reader_start(struct dalcs_builder *builder, const struct dalcs_card *card,
                                       const char *usage);

/* The token `ahead` places from here, or NULL. */
const struct dalcs_token *dalcs_reader_peek(const struct dalcs_reader *reader, int ahead);

/* The last token read. */
const struct dalcs_token *dalcs_reader_previous(const struct dalcs_reader *reader);

bool dalcs_reader_at_end(const struct dalcs_reader *reader);

/* Takes the next token when it is this word or of this kind. */
bool dalcs_reader_take_word(struct dalcs_reader *reader, const char *word);
bool dalcs_reader_take(struct dalcs_reader *reader, enum dalcs_token_kind kind);

/* Takes `name =` and returns the name; NULL, nothing taken, when no parameter comes next. */
const struct dalcs_token *dalcs_reader_take_parameter(struct dalcs_reader *reader);

/* Does a token look like a number (it starts as one, or was an expression)? */
bool dalcs_reader_is_number(const struct dalcs_token *token);

/* The functions below report what is wrong and return false.
 *
 * A number; `what` ("a resistance") is for the message when it is missing. A list's numbers may have
 * commas between them; elsewhere 1,5 is an error. */
bool dalcs_reader_number(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                         const char *what, double *value);
bool dalcs_reader_list_number(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                              const char *what, double *value);

/* A number, or inf. */
bool dalcs_reader_number_or_infinity(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                                     const char *what, double *value);

/* The value of a parameter that means nothing: one token of any kind. */
bool dalcs_reader_skip_value(struct dalcs_reader *reader);

/* A name (any word). */
bool dalcs_reader_name(struct dalcs_reader *reader, const char *what,
                       const struct dalcs_token **name);

/* n nodes, made when new; parentheses around them are ignored. */
bool dalcs_reader_nodes(struct dalcs_reader *reader, int n, int *node /* [n] out */);

/* Nothing may follow. */
bool dalcs_reader_end(struct dalcs_reader *reader);

/* Reports that something is missing after the last token read. */
void dalcs_reader_missing(struct dalcs_reader *reader, const char *what);

/* Reports the next token as not understood. */
void dalcs_reader_unexpected(struct dalcs_reader *reader);
/* The hint for a unit that a blank parts from the number before it, as in "100 uF"; else `otherwise`. */
const char *dalcs_reader_unit_hint(const struct dalcs_reader *reader,
                                   const struct dalcs_token *token, const char *otherwise);

/* ---- reader.c, for reader_number.c ---------------------------------------------------------------- */

/* What to write where an expression stands without braces. */
const char *dalcs_reader_brace_hint(struct dalcs_builder *builder, const struct dalcs_token *token);

/* Is it a formula where a number is wanted? */
bool dalcs_reader_is_formula(const struct dalcs_token *token);

/* A name of .param, or a formula, that stands where a number is wanted; else how the card is written. */
const char *dalcs_reader_hint_of_formula(const struct dalcs_reader *reader,
                                         const struct dalcs_token *token);

#endif
