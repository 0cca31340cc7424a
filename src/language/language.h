/* language.h - what the files of this folder share: definitions, scopes and their values.
 *
 * A definition is the text of a subcircuit, or of the whole netlist; a scope is one instance of it.
 * Names of parameters and functions are looked up in the scope that uses them and then in those that
 * call it, as in ngspice; subcircuits and models in the text around them. Private to this folder. */
#ifndef DALCS_LANGUAGE_H
#define DALCS_LANGUAGE_H

#include "draws.h"
#include "expand.h"
#include "expression.h"
#include "formula.h"

struct dalcs_scope;

/* What a card is for. */
enum dalcs_item_kind {
    DALCS_ITEM_CARD,  /* an element, an analysis, ...: copied */
    DALCS_ITEM_MODEL, /* copied; its name is local */
    DALCS_ITEM_CALL,  /* X */
    DALCS_ITEM_IF,
    DALCS_ITEM_ELSEIF,
    DALCS_ITEM_ELSE,
    DALCS_ITEM_ENDIF,
    DALCS_ITEM_NONE /* .param, .func, .subckt, .global: only definitions */
};

struct dalcs_item {
    const struct dalcs_card *card;
    struct dalcs_expression **expression; /* [card->n], made when first needed */
    enum dalcs_item_kind kind;
};

/* name = expression on a .param or .subckt card. */
struct dalcs_assignment {
    const struct dalcs_token *name;
    const struct dalcs_token *value; /* the first token of its expression */
    int n_tokens;
    int slot;            /* of the parameter, which may be assigned more than once */
    int item;            /* that it stands in; -1 on the .subckt card */
    bool is_conditional; /* inside an .if */
    struct dalcs_expression *expression; /* made when first needed */
};

struct dalcs_user_function {
    const struct dalcs_token *name;
    struct dalcs_names arguments; /* name -> index */
    int n_arguments;
    const struct dalcs_token *body;
    int n_tokens;
    int item;
    bool is_active;                      /* being evaluated */
    struct dalcs_expression *expression; /* made when first needed */
    struct dalcs_user_function *other;   /* one more of this name, or NULL */
};

struct dalcs_definition {
    const struct dalcs_token *name;     /* NULL: the netlist itself */
    const struct dalcs_token *card;     /* its .subckt */
    struct dalcs_definition *enclosing; /* or NULL */
    struct dalcs_definition *other;     /* one more of this name, or NULL */
    int place;                          /* the item of `enclosing` that defines it */
    struct dalcs_names port_index;
    const struct dalcs_token **port; /* [n_ports] */
    int n_ports;
    struct dalcs_item *item; /* heap, as all arrays with a capacity */
    size_t n_items, item_capacity;
    struct dalcs_assignment *assignment;
    size_t n_assignments, assignment_capacity;
    size_t *last_of; /* [n_slots] the last of them to each parameter */
    size_t last_capacity;
    struct dalcs_names parameters; /* name -> slot */
    int n_slots;
    struct dalcs_names functions; /* name -> index of function */
    struct dalcs_user_function **function;
    size_t n_functions, function_capacity;
    struct dalcs_names subcircuits; /* name -> index of inner */
    struct dalcs_definition **inner;
    size_t n_inner, inner_capacity;
    struct dalcs_names models; /* name -> 0 */
    int condition_depth;       /* of .if inside each other; 0: none */
    bool is_open;              /* an instance of it is being expanded */
};

enum dalcs_value_state {
    DALCS_VALUE_UNKNOWN,
    DALCS_VALUE_SOUGHT,
    DALCS_VALUE_KNOWN,
    DALCS_VALUE_WRONG
};

/* A parameter in a scope. */
struct dalcs_value {
    const struct dalcs_token *name;
    const struct dalcs_token
        *token; /* its expression, compiled when it is needed; NULL: none yet */
    int n_tokens;
    struct dalcs_expression **expression;
    struct dalcs_scope *where; /* the scope that its expression is evaluated in */
    struct dalcs_scope *owner; /* the scope that has it; NULL: the same */
    enum dalcs_value_state state;
    double value;
    bool is_used;
    bool is_given; /* by a call */
};

struct dalcs_scope {
    struct dalcs_definition *definition;
    struct dalcs_scope *caller;    /* or NULL */
    struct dalcs_scope *enclosing; /* an instance of definition->enclosing, or NULL */
    const char *name;              /* "x1.x2", "" for the netlist */
    const struct dalcs_origin *origin;
    const char **port;         /* [n_ports] the nodes outside */
    struct dalcs_value *value; /* [n_slots] */
    struct dalcs_value *extra; /* [n_extra] parameters that the call gives and nothing declares */
    int n_extra;
    bool *active;                         /* [n_items] in a branch that counts; NULL: all are */
    const struct dalcs_source_line *line; /* the last line copied, */
    struct dalcs_source_line *copy;       /* and its copy */
};

/* Where random values are drawn: a parameter, or token `at` of a card. */
struct dalcs_draw_place {
    const struct dalcs_scope *scope;
    const struct dalcs_card *card; /* NULL: */
    const char *parameter;
    int at;
    uint32_t n; /* values drawn there */
};

enum { DALCS_WRITTEN_FUNCTIONS = 2 };

struct dalcs_language {
    struct dalcs_deck *deck;
    const struct dalcs_netlist *netlist;
    struct dalcs_diag *diag;
    struct dalcs_arena *arena;
    struct dalcs_definition root;
    struct dalcs_scope *top;
    struct dalcs_names globals;
    struct dalcs_user_function written[DALCS_WRITTEN_FUNCTIONS]; /* made when first named */
    size_t n_emitted;
    int depth;
    bool too_large;
    bool misses_assignment; /* an error on a .param or .func: names may be unknown for it */
    bool out_of_memory;
    bool is_condition; /* what is compiled is that of an .if */
    bool noted_caret;
    bool noted_log;

    double *stack; /* of the evaluation: heap */
    size_t n_stack, stack_capacity;
    int call_depth;
    long operations;
    struct dalcs_value *awaited; /* what an evaluation waits for */
    struct dalcs_value **sought; /* parameters that wait for each other: heap */
    size_t n_sought, sought_capacity;
    struct dalcs_scope **scope; /* every instance, by its place in deck->instances: heap */
    size_t n_scopes, scope_capacity;

    struct dalcs_draw_place place; /* what is being evaluated */
    uint64_t seed;
    uint32_t run; /* number of the run, from 1; 0: every draw is in the middle */
    const struct dalcs_override *corner; /* of .wcase: where each of them is; or NULL */
    bool has_runs;                       /* .mc or .wcase: what DEV and LOT are for */
    bool is_worst_case;                  /* .wcase: what is drawn is listed */
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

/* ---- override.c: other values than the text says ----------------------------------------------- */

/* Those of parameters, of the top scope; also declares what .step steps and no .param sets. */
enum dalcs_status dalcs_override_parameters(struct dalcs_language *language) DALCS_MUST_CHECK;

/* Those of elements and models, in the deck's flat cards. */
enum dalcs_status dalcs_override_cards(struct dalcs_language *language) DALCS_MUST_CHECK;

/* The token of an element's value; *is_there: false when it has none. */
int dalcs_card_find_value(const struct dalcs_card *card, bool *is_there);

/* A copy of the card with this value at token `at`. */
enum dalcs_status dalcs_card_set(struct dalcs_language *language, struct dalcs_card *card, int at,
                                 double value) DALCS_MUST_CHECK;

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

/* The same formula, whose parts have values where they are not chosen, too: n_parts are made. */
const struct dalcs_formula *dalcs_formula_guard(struct dalcs_language *language,
                                                const struct dalcs_formula *formula, int n_parts);

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
