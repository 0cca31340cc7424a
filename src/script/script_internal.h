/* script_internal.h - what the files that execute a script share. */
#ifndef DALCS_SCRIPT_INTERNAL_H
#define DALCS_SCRIPT_INTERNAL_H

#include "definitions.h"
#include "script.h"
#include "statement.h"
#include "variables.h"
#include "vector_formula.h"
#include "writing.h"

#include <float.h>

/* A loop that goes round more often is taken for endless. */
enum { DALCS_MOST_ROUNDS = 1000000 };

/* A quotient of numbers that were rounded when they were read, and of a difference of such: 3 of these roundings and
 * its own are less than 4 eps. So much is added before it is cut to a whole number. */
#define DALCS_ROUNDED_UP (1.0 + 4.0 * DBL_EPSILON)

struct dalcs_script {
    const struct dalcs_script_host *host;
    struct dalcs_statements statements;
    struct dalcs_vectors vectors;
    struct dalcs_variables variables;
    struct dalcs_definitions definitions;
    struct dalcs_extra_card *card; /* of save and option, for all later runs; heap */
    size_t n_cards, card_capacity;
    struct dalcs_arena arena; /* of the statement being executed */
    struct dalcs_arena kept;  /* texts of cards */
    uint64_t random;          /* where the row of random values is */
    bool is_seeded;           /* by setseed, or the netlist */
    bool has_cards;           /* analyses of the netlist, for run */
    size_t n_signals;         /* in a row of the run at hand */
    bool has_run;             /* an analysis, since the lines were read */
    bool quits, breaks, continues;

    struct {
        const char *label; /* that is looked for; NULL: none */
        const struct dalcs_statement *from;
        long n; /* so far */
    } jump;     /* by goto */

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

/* A formula that is ready to be read from `text`. */
struct dalcs_vector_formula dalcs_script_formula(struct dalcs_script *script, const char *text);

/* What is wrong with it, said of the statement. */
enum dalcs_status dalcs_script_refuse_formula(struct dalcs_script *script,
                                              const struct dalcs_statement *statement,
                                              const struct dalcs_vector_formula *formula);

/* The value of a text that is one formula and nothing behind it, in the arena. */
enum dalcs_status dalcs_script_value(struct dalcs_script *script,
                                     const struct dalcs_statement *statement, const char *text,
                                     const struct dalcs_vector **value) DALCS_MUST_CHECK;

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

/* ---- run_command.c --------------------------------------------------------------------------------- */

enum dalcs_status dalcs_script_run_analysis(struct dalcs_script *script,
                                            size_t index) DALCS_MUST_CHECK;

/* The current plot has just begun or was made: it is called as the host calls it. */
void dalcs_script_name_plot(struct dalcs_script *script);

/* A card for the next runs, without its dot. */
enum dalcs_status dalcs_script_add_card(struct dalcs_script *script,
                                        const struct dalcs_statement *statement, const char *word,
                                        const char *rest) DALCS_MUST_CHECK;

/* What `run` does, before all statements: of measurements that follow, the cards go with it. */
enum dalcs_status dalcs_script_run_cards(struct dalcs_script *script) DALCS_MUST_CHECK;

/* ---- Functions of a statement ----------------------------------------------------------------------- */

#define DALCS_SCRIPT_FUNCTION(name)                                                                \
    enum dalcs_status name(struct dalcs_script *script, const struct dalcs_statement *statement)   \
        DALCS_MUST_CHECK

DALCS_SCRIPT_FUNCTION(dalcs_script_save);
DALCS_SCRIPT_FUNCTION(dalcs_script_alter);

/* let_command.c */
DALCS_SCRIPT_FUNCTION(dalcs_script_let);
DALCS_SCRIPT_FUNCTION(dalcs_script_unlet);
DALCS_SCRIPT_FUNCTION(dalcs_script_compose);
DALCS_SCRIPT_FUNCTION(dalcs_script_cross);
DALCS_SCRIPT_FUNCTION(dalcs_script_define);
DALCS_SCRIPT_FUNCTION(dalcs_script_undefine);

/* set_command.c */
DALCS_SCRIPT_FUNCTION(dalcs_script_set);
DALCS_SCRIPT_FUNCTION(dalcs_script_unset);
DALCS_SCRIPT_FUNCTION(dalcs_script_strcmp);
DALCS_SCRIPT_FUNCTION(dalcs_script_echo);
DALCS_SCRIPT_FUNCTION(dalcs_script_setseed);

/* Are angles in degrees behind a set or unset? */
bool dalcs_script_has_degrees(const struct dalcs_statement *statement, bool had);

/* The row of random values of a seed. */
void dalcs_script_seed(struct dalcs_script *script, double seed);

/* show_command.c */
DALCS_SCRIPT_FUNCTION(dalcs_script_print);
DALCS_SCRIPT_FUNCTION(dalcs_script_draw);
DALCS_SCRIPT_FUNCTION(dalcs_script_write);

/* plot_command.c */
enum dalcs_status dalcs_script_choose_plot(struct dalcs_script *script,
                                           const struct dalcs_statement *statement,
                                           const char *name) DALCS_MUST_CHECK;
DALCS_SCRIPT_FUNCTION(dalcs_script_setplot);
DALCS_SCRIPT_FUNCTION(dalcs_script_destroy);
DALCS_SCRIPT_FUNCTION(dalcs_script_display);
DALCS_SCRIPT_FUNCTION(dalcs_script_setscale);
DALCS_SCRIPT_FUNCTION(dalcs_script_settype);

/* spectrum_command.c */
DALCS_SCRIPT_FUNCTION(dalcs_script_linearize);
DALCS_SCRIPT_FUNCTION(dalcs_script_fft); /* psd and spec too */

#undef DALCS_SCRIPT_FUNCTION

/* ---- redirection.c: where print and echo go ----------------------------------------------------------- */

struct dalcs_redirection {
    FILE *file;       /* the host's own, or one that is to be closed */
    const char *path; /* in the arena; NULL: the host's */
    bool appends;
};

/* Cuts `> name` or `>> name` off the end of a text. */
enum dalcs_status dalcs_redirection_find(struct dalcs_redirection *redirection,
                                         struct dalcs_script *script, char *text) DALCS_MUST_CHECK;
enum dalcs_status dalcs_redirection_open(struct dalcs_redirection *redirection,
                                         struct dalcs_script *script,
                                         const struct dalcs_statement *statement) DALCS_MUST_CHECK;
enum dalcs_status dalcs_redirection_close(struct dalcs_redirection *redirection,
                                          struct dalcs_script *script,
                                          const struct dalcs_statement *statement) DALCS_MUST_CHECK;

/* "cannot write": returns DALCS_E_IO. */
enum dalcs_status dalcs_script_refuse_file(struct dalcs_script *script,
                                           const struct dalcs_statement *statement,
                                           const char *path, int error);

/* ---- script_look.c -------------------------------------------------------------------------------- */

/* Is there a statement whose vectors are not named in the text of the script? */
bool dalcs_script_keeps_all(const struct dalcs_statements *all);

/* Does it look back at plots before the newest? "tran1.v(out)", "{$dc}.out", setplot, $curplot, destroy. */
bool dalcs_script_keeps_plots(const struct dalcs_statements *all);

/* Does one of them ask for an analysis? */
bool dalcs_script_asks(const struct dalcs_statements *all);

#endif
