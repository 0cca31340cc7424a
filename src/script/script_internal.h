/* script_internal.h - what the files that execute a script share. */
#ifndef DALCS_SCRIPT_INTERNAL_H
#define DALCS_SCRIPT_INTERNAL_H

#include "script.h"
#include "statement.h"
#include "variables.h"
#include "vector_formula.h"
#include "writing.h"

struct dalcs_script {
    const struct dalcs_script_host *host;
    struct dalcs_statements statements;
    struct dalcs_vectors vectors;
    struct dalcs_variables variables;
    struct dalcs_extra_card *card; /* of save and option, for all later runs; heap */
    size_t n_cards, card_capacity;
    struct dalcs_arena arena; /* of the statement being executed */
    struct dalcs_arena kept;  /* texts of cards */
    bool has_cards;           /* analyses of the netlist, for run */
    size_t n_signals;         /* in a row of the run at hand */
    bool has_run;             /* an analysis, since the lines were read */
    bool quits, breaks, continues;
    bool is_silent; /* nothing is said: it is tried whether a text has a value yet */
};

/* ---- text.c: a statement's text ------------------------------------------------------------------- */

/* An error at the statement, or a warning where the script goes on without it; returns DALCS_E_NETLIST.
 * hint may be NULL. */
enum dalcs_status dalcs_script_refuse(struct dalcs_script *script,
                                      const struct dalcs_statement *statement, const char *hint,
                                      const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* What follows the statement's word, with $name, $&vector and {formula} replaced. */
enum dalcs_status dalcs_script_expand(struct dalcs_script *script,
                                      const struct dalcs_statement *statement,
                                      const char **text) DALCS_MUST_CHECK;

/* The same in lower case. */
enum dalcs_status dalcs_script_expand_low(struct dalcs_script *script,
                                          const struct dalcs_statement *statement,
                                          const char **text) DALCS_MUST_CHECK;

/* The next word of *text, without quotes, which moves behind it; NULL at the end or when out of
 * memory. */
const char *dalcs_script_word(struct dalcs_script *script, const char **text);

/* The value of a text that is one formula of one number. */
enum dalcs_status dalcs_script_number(struct dalcs_script *script,
                                      const struct dalcs_statement *statement, const char *text,
                                      double *value) DALCS_MUST_CHECK;

/* All formulas of a text, or all vectors of the plot: vector[*n], in the arena. */
enum dalcs_status dalcs_script_vectors(struct dalcs_script *script,
                                       const struct dalcs_statement *statement, const char *text,
                                       const struct dalcs_vector ***vector,
                                       size_t *n) DALCS_MUST_CHECK;

/* ---- measuring.c: measurements of the run before them ---------------------------------------------- */

/* Adds the cards of those that follow statement first - 1: they are measured while it runs. */
enum dalcs_status dalcs_script_add_measurements(struct dalcs_script *script,
                                                size_t first) DALCS_MUST_CHECK;

/* ---- command.c: one statement that is no block ---------------------------------------------------- */

/* `index`: of the statement, for what follows an analysis. */
enum dalcs_status dalcs_script_command(struct dalcs_script *script, size_t index) DALCS_MUST_CHECK;

/* A card for the next runs, without its dot. */
enum dalcs_status dalcs_script_add_card(struct dalcs_script *script,
                                        const struct dalcs_statement *statement, const char *word,
                                        const char *rest) DALCS_MUST_CHECK;

/* What `run` does, before all statements: of measurements that follow, the cards go with it. */
enum dalcs_status dalcs_script_run_cards(struct dalcs_script *script) DALCS_MUST_CHECK;

#endif
