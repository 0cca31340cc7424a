/* logic.h - gates and flip-flops: what decides by events, outside all equations.
 *
 * An input is 0 or 1: the output of another gate, or a comparator, which is a switch that nothing flows in, and whose
 * position is located as that of any other. An output is a voltage source whose stimulus is written while a run goes
 * on, point by point. */
#ifndef DALCS_LOGIC_H
#define DALCS_LOGIC_H

#include "diag.h"

enum { DALCS_GATE_INPUTS = 5 };

/* What a gate may become: the other output, a resistor at each, a comparator and its resistor at each input. */
enum { DALCS_GATE_DEVICES = 3 + 2 * DALCS_GATE_INPUTS };

enum dalcs_logic_kind {
    DALCS_GATE_AND,
    DALCS_GATE_OR,
    DALCS_GATE_XOR,
    DALCS_GATE_BUFFER,
    DALCS_GATE_LATCH,    /* set, reset: which wins */
    DALCS_GATE_FLIP_FLOP /* data, -, clock, preset, clear: which wins */
};

enum { DALCS_GATE_DATA, DALCS_GATE_CLOCK = 2, DALCS_GATE_PRESET, DALCS_GATE_CLEAR };

struct dalcs_logic_gate {
    enum dalcs_logic_kind kind;
    const char *name;

    struct dalcs_logic_input {
        enum dalcs_logic_source { DALCS_GATE_OPEN, DALCS_GATE_COMPARATOR, DALCS_GATE_GATE } from;

        int index;
        bool is_inverted;
    } input[DALCS_GATE_INPUTS];

    int output[2];    /* the stimuli of q and of its complement, -1: not wired */
    double low, high; /* V */
    double delay, rise,
        fall;     /* s; each change of q is seen after the delay, however short it was */
    bool initial; /* of latch and flip-flop */
    struct dalcs_location where;
};

#endif
