/* expand.h - cards to flat cards: parameters, subcircuits and conditions are gone afterwards.
 *
 *     text -> cards (netlist/) -> flat cards (here) -> devices (circuit/)
 *
 * An element of a subcircuit is copied for each X: its name becomes x1.r1, a node of its own x1.n, a
 * port the node outside, a local model x1.name; each expression becomes a NUMBER. The copies keep
 * their places in the text, and their lines say by which calls they came. doc/netlist.md has the
 * rules for users. */
#ifndef DALCS_EXPAND_H
#define DALCS_EXPAND_H

#include "expression.h"
#include "names.h"
#include "netlist.h"
#include "override.h"

/* Zero-initialise, set overrides if there are any, expand, then finish. Borrows from the netlist. */
struct dalcs_deck {
    const struct dalcs_override *override; /* [n_overrides], borrowed */
    size_t n_overrides;

    const struct dalcs_card *card; /* those of the netlist when nothing was to be expanded */
    size_t n_cards;
    bool has_errors; /* some were reported; they may hide others: */
    bool hides_elements;
    bool hides_all;
    struct dalcs_language *language; /* NULL: nothing was expanded */
    struct dalcs_arena arena;
    struct dalcs_card *own; /* heap */
    size_t own_capacity;
    struct dalcs_names instances; /* "x1.x2" */

    struct dalcs_drawn *drawn; /* [n_drawn] in the order of their evaluation; heap */
    size_t n_drawn, drawn_capacity;
    struct dalcs_draw *draw; /* [n_draws] of .wcase: each tolerance; heap */
    size_t n_draws, draw_capacity;
    bool is_step;            /* of .step or .mc */
    bool has_random_formula; /* or condition: a value was drawn that is none of these */
};

/* A tolerance: DEV or LOT, or one call of a random function. */
struct dalcs_draw {
    const char *name; /* "r1", "d1(vfwd)", "lot(rb)" */
    uint64_t key;
    bool is_lot;
};

/* A value that random functions had a part in: of a parameter, or on a card. */
struct dalcs_drawn {
    const char *name; /* "c", "x1.tol", "r1", "dmod(vfwd)": the place, as a person calls it */
    const struct dalcs_card *card; /* or NULL */
    double value;
};

/* Errors go to diag and set has_errors. Fails with DALCS_E_NOMEM only. */
enum dalcs_status dalcs_deck_expand(struct dalcs_deck *deck, const struct dalcs_netlist *netlist,
                                    struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* Finds the values of the netlist's own parameters and does nothing else. */
enum dalcs_status dalcs_deck_settle(struct dalcs_deck *deck, const struct dalcs_netlist *netlist,
                                    struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* The seed of its random values: what was asked for, else what it says, else 1. */
double dalcs_deck_seed(const struct dalcs_netlist *netlist);

/* The node outside that x1.a stands for, when a is a port of x1; else NULL. */
const char *dalcs_deck_port(const struct dalcs_deck *deck, const char *name);

/* The value of one of the netlist's own parameters; false when there is none of that name. */
bool dalcs_deck_parameter(const struct dalcs_deck *deck, const char *name, double *value);
/* The number that an override would replace; false: it stands nowhere. */
bool dalcs_deck_value(const struct dalcs_deck *deck, const struct dalcs_override *override,
                      enum dalcs_dialect_name dialect, double *value);

/* Is there a parameter of this name outside of subcircuits, does anything use it, and which is the one most like it (NULL:
 * none)? */
bool dalcs_deck_has_parameter(const struct dalcs_deck *deck, const char *name);
bool dalcs_deck_uses_parameter(const struct dalcs_deck *deck, const char *name);
const char *dalcs_deck_nearest_parameter(const struct dalcs_deck *deck, const char *name);

/* The temperature that .temp, .options or a .step sets, unless `temp` is a parameter of the netlist's own. */
bool dalcs_deck_temperature(const struct dalcs_deck *deck, double *value);

/* One of the netlist's own functions, in whose body DALCS_PUSH_ARGUMENT stands for the arguments; false
 * when there is none of that name. body: NULL when it is wrong, which was reported, or memory ran out. */
bool dalcs_deck_function(const struct dalcs_deck *deck, const char *name, int *n_arguments,
                         const struct dalcs_expression **body, bool *out_of_memory);

void dalcs_deck_finish(struct dalcs_deck *deck);

/* LTspice's gates and flip-flops: eight nodes, then the function, then parameters. */
enum { DALCS_LOGIC_MODEL = 9 };

bool dalcs_card_is_logic(const struct dalcs_card *card);

#endif
