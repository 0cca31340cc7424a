/* language.h - what the files of this folder share, and one expansion of a netlist. Private to this folder. */
#ifndef DALCS_LANGUAGE_H
#define DALCS_LANGUAGE_H

#include "definitions.h"
#include "draws.h"
#include "expand.h"
#include "expression.h"
#include "formula.h"

/* Where random values are drawn: a parameter, or token `at` of a card. */
struct dalcs_draw_place {
    const struct dalcs_scope *scope;
    const struct dalcs_card *card; /* NULL: */
    const char *parameter;
    int at;
    uint32_t n; /* values drawn there */
};

/* Random values: what they depend on. */
struct dalcs_drawing {
    struct dalcs_draw_place place; /* what is being evaluated */
    uint64_t seed;
    uint32_t run; /* number of the run, from 1; 0: every draw is in the middle */
    const struct dalcs_override *corner; /* of .wcase: where each of them is; or NULL */
    bool has_runs;                       /* .mc or .wcase: what DEV and LOT are for */
    bool is_worst_case;                  /* .wcase: what is drawn is listed */
};

/* The stack of an evaluation. */
struct dalcs_evaluation_stack {
    double *stack; /* heap */
    size_t n_stack, stack_capacity;
    int call_depth;
    long operations;
};

/* Parameters that wait for each other. */
struct dalcs_sought {
    struct dalcs_value *awaited; /* what an evaluation waits for */
    struct dalcs_value **value;  /* heap */
    size_t n, capacity;
};

enum { DALCS_WRITTEN_FUNCTIONS = 2, DALCS_VARYING_POINTS = 16 };

struct dalcs_language {
    struct dalcs_deck *deck;
    const struct dalcs_netlist *netlist;
    struct dalcs_diag *diag;
    struct dalcs_arena *arena;
    struct dalcs_definition root;
    struct dalcs_scope *top;
    struct dalcs_names globals;
    struct dalcs_user_function written[DALCS_WRITTEN_FUNCTIONS]; /* made when first named */
    struct dalcs_user_function table[DALCS_VARYING_POINTS + 1];  /* of so many points that vary */
    size_t n_emitted;
    int depth;
    bool too_large;
    bool misses_assignment; /* an error on a .param or .func: names may be unknown for it */
    bool out_of_memory;
    bool is_condition; /* what is compiled is that of an .if */

    struct {
        bool caret, log, pwr;
    } noted; /* messages that are given once */

    struct {
        struct dalcs_scope **scope; /* every one, by its place in deck->instances: heap */
        size_t n, capacity;
    } instances;

    struct dalcs_evaluation_stack evaluation;
    struct dalcs_sought sought;
    struct dalcs_drawing drawing;
};

/* ---- language.c: messages ---------------------------------------------------------------------- */

void dalcs_language_report(struct dalcs_language *language, enum dalcs_severity severity,
                           const struct dalcs_scope *scope, const struct dalcs_token *token,
                           const char *hint, const char *format, ...)
    __attribute__((format(printf, 6, 7)));
void dalcs_language_report_at(struct dalcs_language *language, enum dalcs_severity severity,
                              const struct dalcs_scope *scope, struct dalcs_location where,
                              const char *hint, const char *format, ...)
    __attribute__((format(printf, 6, 7)));

/* A card of dalcs_card_is_derived_model() in full. What cannot be is reported, and is no type that anybody reads. NULL: out of memory. */
const struct dalcs_card *dalcs_model_derive(struct dalcs_language *language,
                                            const struct dalcs_scope *scope,
                                            const struct dalcs_card *card);

/* "did you mean 'a'?", "the things are: a, b", or NULL. */
const char *dalcs_language_suggest(struct dalcs_language *language, const struct dalcs_names *names,
                                   const char *name, const char *plural);

/* printf into the arena; NULL and out_of_memory when there is none. */
const char *dalcs_language_text(struct dalcs_language *language, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* "main.cir:3:1" */
const char *dalcs_language_place(struct dalcs_language *language, const struct dalcs_token *token);

/* ---- assignment.c: name = expression --------------------------------------------------------- */

/* The next `name = value ...` of the card from token *at on: its name, and the tokens of its value
 * from *value to *at, exclusive. NULL at the end of the card, or when an error was reported. */
const struct dalcs_token *dalcs_assignment_next(struct dalcs_language *language,
                                                const struct dalcs_scope *scope,
                                                const struct dalcs_card *card, int *at, int *value);

/* Is the word `params:`, which may stand before assignments? */
bool dalcs_assignment_is_params(const struct dalcs_token *token);

/* Does `name =` stand at token k (and not a comparison)? */
bool dalcs_assignment_starts(const struct dalcs_card *card, int k);

/* The slot of what .csparam gives to the script where .param has the name: no card can spell it. */
#define DALCS_SCRIPT_PARAMETER ".csparam %s"

/* ---- definition.c: the netlist's cards to definitions ------------------------------------------ */

enum dalcs_status dalcs_definition_collect(struct dalcs_language *language) DALCS_MUST_CHECK;
void dalcs_definition_finish(struct dalcs_definition *definition);

/* ---- scope.c: values of parameters ------------------------------------------------------------- */

/* The subcircuit that a name means in this scope; *owner is the instance that holds it. NULL: none. */
struct dalcs_definition *dalcs_scope_find_subcircuit(struct dalcs_scope *scope, const char *name,
                                                     struct dalcs_scope **owner);

/* The parameter that a name means in this scope, or NULL. */
struct dalcs_value *dalcs_scope_find_value(struct dalcs_scope *scope, const char *name);

/* The parameter of this name that the call of a scope gives; NULL: none. */
struct dalcs_value *dalcs_scope_find_given(struct dalcs_scope *scope, const char *name);

/* The function that a name means in this scope, or NULL. */
struct dalcs_user_function *dalcs_scope_find_function(struct dalcs_scope *scope, const char *name);

/* The same, or one that is written in others for every netlist (written.c). NULL: there is none, or no memory. */
struct dalcs_user_function *dalcs_language_function(struct dalcs_language *language,
                                                    struct dalcs_scope *scope, const char *name);
/* table(x, x1, y1, ...) of n points, some of which vary, as a formula; NULL: more than DALCS_VARYING_POINTS,
 * or no memory. */
struct dalcs_user_function *dalcs_language_table(struct dalcs_language *language, int n);

void dalcs_language_finish_written(struct dalcs_language *language);

/* Is the item in a branch that counts? */
bool dalcs_scope_is_active(const struct dalcs_scope *scope, int item);

/* Makes a scope and its parameters; those given by the call come afterwards. NULL: out of memory. */
struct dalcs_scope *dalcs_scope_make(struct dalcs_language *language,
                                     struct dalcs_definition *definition,
                                     struct dalcs_scope *caller, struct dalcs_scope *enclosing);

/* Decides the conditions and evaluates all parameters. */
void dalcs_scope_settle(struct dalcs_language *language, struct dalcs_scope *scope);

/* Evaluates an expression in a scope; false when an error was reported, now or before. */
bool dalcs_scope_evaluate(struct dalcs_language *language, struct dalcs_scope *scope,
                          struct dalcs_expression *expression, double *value);

/* Compiles token[0..n-1] into *expression unless that was done; false when it is wrong. */
bool dalcs_scope_compile(struct dalcs_language *language, const struct dalcs_scope *scope,
                         const struct dalcs_token *token, int n,
                         const struct dalcs_names *arguments, struct dalcs_expression **expression);

/* ---- override_parameters.c, override.c: other values than the text says ----------------------------------------------- */

/* Those of parameters, of the top scope; also declares what .step steps and no .param sets. */
enum dalcs_status dalcs_override_parameters(struct dalcs_language *language) DALCS_MUST_CHECK;

/* Those of elements and models, in the deck's flat cards. */
enum dalcs_status dalcs_override_cards(struct dalcs_language *language) DALCS_MUST_CHECK;

/* ---- tolerance.c: DEV and LOT --------------------------------------------------------------------- */

/* Takes them off the deck's cards, and puts what they make of values in this run there. */
enum dalcs_status dalcs_tolerances_apply(struct dalcs_language *language) DALCS_MUST_CHECK;

/* ---- drawn.c: random values ---------------------------------------------------------------------- */

/* The netlist's seed, else the usual one, and the number of this run. */
void dalcs_drawn_start(struct dalcs_language *language);

/* Value k of a place in this run: in (0, 1), in a corner also 0 or 1, the ends of what is tolerated. */
double dalcs_drawn_place(struct dalcs_language *language, uint64_t key, uint32_t k);

/* Lists it for .wcase. */
void dalcs_drawn_list(struct dalcs_language *language, uint64_t key, const char *name, bool is_lot);

/* A value that tolerances have a part in, where runs draw them. */
void dalcs_drawn_keep(struct dalcs_language *language, const char *name, double value);

/* The next value of the place that is being evaluated. */
double dalcs_drawn_next(struct dalcs_language *language, dalcs_draw *draw, const double *x, int n);

/* What is evaluated now is at `place`; returns the place before. */
struct dalcs_draw_place dalcs_drawn_enter(struct dalcs_language *language,
                                          struct dalcs_draw_place place);

/* It had this value: kept if it was drawn. And back to the place before; value NULL: it has none. */
void dalcs_drawn_leave(struct dalcs_language *language, struct dalcs_draw_place before,
                       const double *value);

/* ---- evaluate.c -------------------------------------------------------------------------------- */

enum dalcs_outcome { DALCS_OUTCOME_VALUE, DALCS_OUTCOME_WAITS, DALCS_OUTCOME_WRONG };

/* Runs an expression as far as the parameters are known: WAITS sets language->awaited. */
enum dalcs_outcome dalcs_evaluate(struct dalcs_language *language, struct dalcs_scope *scope,
                                  const struct dalcs_expression *expression, double *value);

/* ---- formula.c --------------------------------------------------------------------------------- */

/* Where the card has a formula: token[*first..*first+*n-1]; false when nowhere. */
bool dalcs_formula_find(const struct dalcs_card *card, int *first, int *n);

/* The same of LAPLACE: what is an expression of s. */
bool dalcs_transfer_find(const struct dalcs_card *card, int *first, int *n);

/* The formula of token[0..n-1]; NULL when an error was reported or out of memory. */
const struct dalcs_formula *dalcs_formula_make(struct dalcs_language *language,
                                               struct dalcs_scope *scope,
                                               const struct dalcs_token *token, int n);

/* The same of a variable, which the formula calls time, as there is none; variable NULL: that of any source. */
const struct dalcs_formula *dalcs_formula_make_of(struct dalcs_language *language,
                                                  struct dalcs_scope *scope,
                                                  const struct dalcs_token *token, int n,
                                                  const char *variable);

/* ---- expand.c ---------------------------------------------------------------------------------- */

/* The name that a node, or else an element, of this scope has in the flat netlist; NULL: out of
 * memory. */
const char *dalcs_scope_flat_name(struct dalcs_language *language, const struct dalcs_scope *scope,
                                  bool is_node, const char *name);

/* ---- roles.c: which words of a card are names -------------------------------------------------- */

enum dalcs_role {
    DALCS_ROLE_VALUE,
    DALCS_ROLE_NODE,
    DALCS_ROLE_PORT, /* a node of XSPICE, perhaps with a bracket or a ~ */
    DALCS_ROLE_DEVICE,
    DALCS_ROLE_MODEL,
    DALCS_ROLE_RAW,
    DALCS_ROLE_SIGNAL /* a formula of signals, compiled on its own */
};

/* role[card->n] of an element or a card such as .ic, its first token excepted. RAW: an expression of
 * voltages, which is not a number. */
void dalcs_roles(const struct dalcs_card *card, unsigned char *role);

/* The nodes of a transistor's card: the words before its model, which is the last one before parameters that is no
 * number. */
int dalcs_roles_count_terminals(const struct dalcs_card *card);

/* ---- temperature.c --------------------------------------------------------------------------- */

enum { DALCS_TEMPERATURE_NAMES = 2 };

/* The token of the temperature that the netlist sets; NULL: it does not. */
const struct dalcs_token *dalcs_temperature_find(const struct dalcs_language *language);

/* Puts temp and temper into the netlist's scope, which has room for them. */
enum dalcs_status dalcs_temperature_declare(struct dalcs_language *language,
                                            const struct dalcs_token *token) DALCS_MUST_CHECK;

#endif
