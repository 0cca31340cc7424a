/* logic.h - gates, flip-flops and what samples: what decides by events, outside all equations.
 *
 * An input is 0 or 1: the output of another gate, or a comparator, which is a switch that nothing flows in, and whose
 * position is located as that of any other. An output is a voltage source whose stimulus is written while a run goes
 * on, point by point. */
#ifndef DALCS_LOGIC_H
#define DALCS_LOGIC_H

#include "diag.h"

enum { DALCS_GATE_PINS = 5 };

/* What a gate may become: at each output a source, a resistor, another one as a switch and a capacitor, at each input a
 * comparator and its resistor. */
enum { DALCS_GATE_DEVICES = 8 + 2 * DALCS_GATE_PINS };

enum dalcs_logic_kind {
    DALCS_GATE_AND,
    DALCS_GATE_OR,
    DALCS_GATE_XOR, /* an odd number of inputs */
    DALCS_GATE_ONE, /* one input and no other: LTspice's XOR */
    DALCS_GATE_BUFFER,
    DALCS_GATE_LATCH,      /* set, reset: which wins */
    DALCS_GATE_FLIP_FLOP,  /* data, -, clock, preset, clear: which wins */
    DALCS_GATE_TOGGLE,     /* the same: data turns q over */
    DALCS_GATE_JK,         /* set, reset, clock, preset, clear: both turn q over */
    DALCS_GATE_SR,         /* the same: reset wins */
    DALCS_GATE_DATA_LATCH, /* as a flip-flop, whose clock acts while it is high */
    DALCS_GATE_SR_LATCH,
    DALCS_GATE_COUNTER,   /* clock, reset: which wins */
    DALCS_GATE_SAMPLE,    /* -, -, clock, track */
    DALCS_GATE_MONOSTABLE /* -, -, clock, -, clear: which wins */
};

enum { DALCS_GATE_DATA, DALCS_GATE_RESET, DALCS_GATE_CLOCK, DALCS_GATE_PRESET, DALCS_GATE_CLEAR };

struct dalcs_logic_gate {
    enum dalcs_logic_kind kind;
    const char *name;
    int n_inputs;

    struct dalcs_logic_input {
        enum dalcs_logic_source { DALCS_GATE_OPEN, DALCS_GATE_COMPARATOR, DALCS_GATE_GATE } from;

        int index;
        bool is_inverted;
    } * input; /* [n_inputs] */

    int device; /* the source that shows q, or its complement where q is not wired */
    int output
        [2]; /* the stimuli of q and of its complement, -1: not wired; of a sample what is held, and whether
                         it is shown */
    double low, high; /* V */
    /* s, of q that falls, that rises: each change is seen so much later, however short it was; forced: by preset and
     * clear */
    double delay[2], forced_delay[2];
    double rise, fall; /* s */
    bool initial;      /* of a part with a memory */
    int cycles;        /* of a counter: clocks until it begins anew; */
    int n_high;        /* q is high in so many of them */
    int first;         /* of the clocks that have been, at the start */
    int sampled; /* the place among the circuit's measured signals of what a sample takes, of s that a pulse lasts; -1 */

    struct dalcs_logic_pulse { /* of a monostable, s */
        double lead, length;   /* q is high for both; the length where nothing is sampled */
        double recovery;       /* and then it does not heed its clock for so long */
        bool is_retriggered;
    } pulse;

    double held; /* V, by a sample at the start */
    struct dalcs_location where;
};

static inline bool dalcs_gate_has_delay(const struct dalcs_logic_gate *g) {
    return g->delay[0] > 0 || g->delay[1] > 0;
}

/* Heeds its clock while that is high, not where it rises. */
static inline bool dalcs_gate_is_transparent(const struct dalcs_logic_gate *g) {
    return g->kind == DALCS_GATE_DATA_LATCH || g->kind == DALCS_GATE_SR_LATCH;
}

static inline bool dalcs_gate_has_clock(const struct dalcs_logic_gate *g) {
    return g->kind >= DALCS_GATE_FLIP_FLOP;
}

#endif
