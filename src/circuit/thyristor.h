/* thyristor.h - what a thyristor's model says, and the control of its switch. Private to this folder. */
#ifndef DALCS_CIRCUIT_THYRISTOR_H
#define DALCS_CIRCUIT_THYRISTOR_H

#include "builder.h"

enum dalcs_thyristor_kind { DALCS_THYRISTOR, DALCS_TRIAC, DALCS_GTO };

struct dalcs_thyristor {
    enum dalcs_thyristor_kind kind;
    double trigger, turn_off; /* V of the gate */
    double holding;           /* A; 0: none */
    double latching;          /* A; 0: as long as its gate it conducts whatever flows */
    double reversed;          /* V backwards, of a triac without a holding current */
    double other;             /* A in the other half of a triac that end its own current */
    double drop;              /* V when it conducts, at least */
};

/* The names that a control reads. */
struct dalcs_thyristor_places {
    const struct dalcs_token *anode, *cathode, *gate, *reference;
    const struct dalcs_token *self;
    double direction; /* of the half: 1, or -1 where it is the back of a triac */
};

/* NULL: out of memory. */
const struct dalcs_token *dalcs_thyristor_control(struct dalcs_builder *builder,
                                                  const struct dalcs_thyristor *thyristor,
                                                  const struct dalcs_thyristor_places *places);

#endif
