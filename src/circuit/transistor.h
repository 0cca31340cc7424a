/* transistor.h - MOSFETs, IGBTs and bipolar transistors as switches. Private to this folder. */
#ifndef DALCS_TRANSISTOR_H
#define DALCS_TRANSISTOR_H

#include "builder.h"

enum dalcs_transistor_kind { DALCS_MOSFET, DALCS_IGBT, DALCS_BIPOLAR };

/* What a card says, or the table of parts. */
struct dalcs_transistor {
    enum dalcs_transistor_kind kind;
    const char *name;
    bool is_p;        /* PMOS, PNP: on below its threshold */
    double threshold; /* V of the gate against the source, of the base against the emitter */
    double gain;      /* A/V^2 where the channel is a resistance; 0: `ron` says what that is */
    double
        saturating; /* A/V^2: twice a channel's largest current over the square of v - threshold; 0: not known */
    double width, length; /* m, where no element says others */
    double ron;           /* ohm */
    double series;        /* ohm, besides: Rd + Rs */
    double leakage;       /* ohm across it when it is off */
    double high;          /* V of the gate that it is on at, Vgon=; 0: the circuit says */
    double knee;          /* V that it has at least when it is on: Vce0 of an IGBT */
    bool has_diode;       /* across it, against its direction */
    double drop;          /* V of that of an IGBT */
    bool was_noted;       /* and with these: */
    double noted_ohms;
    struct dalcs_diode_card diode; /* its body diode or, of a bipolar one, from base to emitter */
};

/* An element: what depends on the rest of the circuit waits for it. */
struct dalcs_transistor_use {
    int device;
    const struct dalcs_token *name;
    struct dalcs_transistor *of;
    int drain, gate, source;        /* nodes */
    double width, length, parallel; /* m, m; so many of them */
    int diode;                      /* its model among the circuit's, -1: none */
    struct dalcs_transistor_use *before;
};

/* A transistor by the name that people write, such as IRF540; false: the table does not know it. */
bool dalcs_transistor_part_find(const char *name, struct dalcs_transistor *transistor);

#endif
