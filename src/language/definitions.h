/* definitions.h - definitions, scopes and their values.
 *
 * A definition is the text of a subcircuit, or of the whole netlist; a scope is one instance of it.
 * Names of parameters and functions are looked up in the scope that uses them and then in those that
 * call it, as in ngspice; subcircuits and models in the text around them. Private to this folder. */
#ifndef DALCS_DEFINITIONS_H
#define DALCS_DEFINITIONS_H

#include "expression.h"

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

struct dalcs_parameters {
    struct dalcs_names names; /* name -> slot */
    int n_slots;
    struct dalcs_assignment *assignment; /* heap, as the next */
    size_t n_assignments, capacity;
    size_t *last_of; /* [n_slots] the last of them to each parameter */
    size_t last_capacity;
};

struct dalcs_functions {
    struct dalcs_names names;              /* name -> index of function */
    struct dalcs_user_function **function; /* heap */
    size_t n, capacity;
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
    struct dalcs_parameters parameters;
    struct dalcs_functions functions;
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

#endif
