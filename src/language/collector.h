/* collector.h - what the files that sort cards into definitions share. Private to this folder. */
#ifndef DALCS_COLLECTOR_H
#define DALCS_COLLECTOR_H

#include "language.h"

enum { DALCS_DEEPEST_DEFINITION = 100 };

/* An .if that is not closed yet. */
struct dalcs_open_if {
    int first; /* its item */
    bool has_else;
};

struct dalcs_collector {
    struct dalcs_language *language;
    struct dalcs_definition *definition; /* the one being read */
    struct dalcs_open_if *open;          /* heap */
    size_t n_open, open_capacity;
    size_t base[DALCS_DEEPEST_DEFINITION + 1]; /* n_open where each definition started */
    int depth;
};

/* An error at a token. */
void dalcs_collector_error(struct dalcs_collector *c, const struct dalcs_token *token,
                           const char *hint, const char *what);

/* An error behind a token. */
void dalcs_collector_missing(struct dalcs_collector *c, const struct dalcs_token *after,
                             const char *usage, const char *what);

/* Is the card inside an .if? */
bool dalcs_collector_is_conditional(const struct dalcs_collector *c);

/* The same line of a file that was included twice? */
bool dalcs_token_is_same_place(const struct dalcs_token *a, const struct dalcs_token *b);

/* Reports the .if that are open in the present definition. */
void dalcs_collector_close_conditions(struct dalcs_collector *c);

/* .ends and .eom */
void dalcs_collector_end(struct dalcs_collector *c, const struct dalcs_card *card);

/* Are more subcircuits begun than ended? */
bool dalcs_collector_lacks_end(const struct dalcs_netlist *netlist);

/* LTspice ends a subcircuit that lacks its .ends with the file that holds it. This ends those whose file
 * ends before the card `next`. Only for a netlist that lacks an .ends: in any other it may stand in another
 * file than its .subckt. */
void dalcs_collector_end_with_file(struct dalcs_collector *c, const struct dalcs_card *next);

/* name=value ... from token `at` of the card on; is_formal: of a .subckt card, where there are no functions. */
enum dalcs_status dalcs_collector_read_assignments(struct dalcs_collector *c,
                                                   const struct dalcs_card *card, int at,
                                                   bool is_formal);

/* .param and its kin. */
enum dalcs_status dalcs_collector_read_param(struct dalcs_collector *c,
                                             const struct dalcs_card *card);

/* .func and its kin. */
enum dalcs_status dalcs_collector_read_function(struct dalcs_collector *c,
                                                const struct dalcs_card *card);

#endif
