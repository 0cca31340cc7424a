/* call.h - one call of a subcircuit. */
#ifndef DALCS_CALL_H
#define DALCS_CALL_H

#include "status.h"

#include <stddef.h>

struct dalcs_item;
struct dalcs_language;
struct dalcs_scope;

/* The parts of an X card. */
struct dalcs_call {
    struct dalcs_language *language;
    struct dalcs_scope *scope; /* the caller's */
    struct dalcs_item *item;
    int name; /* the token that names the subcircuit; 0: none */
    int n_nodes;
    int parameters; /* where they start */
    struct dalcs_scope
        *inner; /* the instance's, of the language's arena; NULL: it cannot be made */
};

/* Reads the card of call->item and makes call->inner, with its nodes and parameters. What is wrong with the call is
 * reported, and `inner` stays NULL; only memory that is out is a status. */
enum dalcs_status dalcs_call_open(struct dalcs_call *call) DALCS_MUST_CHECK;

/* After the cards of the instance are copied, `first` and those behind it: parameters that the call gives and nothing
 * inside looks at; m= is then the number of such subcircuits in parallel, as in every SPICE. */
void dalcs_call_close(const struct dalcs_call *call, size_t first);

#endif
