/* oscillator.h - sources whose control voltage is their frequency. */
#ifndef DALCS_OSCILLATOR_H
#define DALCS_OSCILLATOR_H

#include "block_parts.h"

enum dalcs_oscillator_shape {
    DALCS_OSCILLATOR_TRIANGLE,
    DALCS_OSCILLATOR_SQUARE,
    DALCS_OSCILLATOR_SINE,
    DALCS_OSCILLATOR_DIGITAL
};

struct dalcs_oscillator {
    const struct dalcs_oscillator *before; /* the list of those that wait */
    struct dalcs_block_card card;          /* whose element it is */
    const char *what;                /* NULL: it has the element's name; else it is a part of it */
    const struct dalcs_token *place; /* of messages */
    struct dalcs_block_end control, out;
    enum dalcs_oscillator_shape shape;
    bool may_resist; /* LTspice's */
    double low, high;
    double duty;                   /* of the period: that a triangle rises, that a square is high */
    double phase;                  /* of the period, at the start */
    struct dalcs_piecewise hertz;  /* of the control, never below 0 */
    double rise, fall;             /* s */
    double rise_delay, fall_delay; /* s */
};

/* A frequency for each voltage of a table, which goes on beyond its ends, down to 0; false: out of memory. */
bool dalcs_oscillator_set_hertz(struct dalcs_oscillator *o, const struct dalcs_piecewise *table);

/* Puts it into the circuit when all elements are known: what its control is decides on its form. */
void dalcs_oscillator_add(const struct dalcs_oscillator *o);
void dalcs_oscillator_put_all(struct dalcs_builder *builder);

#endif
