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
    const struct dalcs_token *typical; /* where it is named, if no card and no table has it; NULL */
    struct dalcs_diode_card diode; /* its body diode or, of a bipolar one, from base to emitter */
    bool is_lateral;               /* an NMOS or PMOS: both ends of its channel are alike */
};

/* An element: what depends on the rest of the circuit waits for it. */
struct dalcs_transistor_use {
    int device;
    const struct dalcs_token *name;
    struct dalcs_transistor *of;
    int drain, gate, source, bulk;  /* nodes */
    double width, length, parallel; /* m, m; so many of them */
    int diode, diode_device;        /* its model among the circuit's and the diode; -1: none */
    struct dalcs_transistor_use *before;
    bool is_turned; /* drain and source are exchanged against the card */
};

/* V between two nodes. */
struct dalcs_gate_range {
    bool is_known;
    double low, high;
};

/* Resistors and V sources by their nodes. */
struct dalcs_gate_links {
    int *first;     /* [n_nodes] 2 device + end + 1, 0: none */
    int (*next)[2]; /* [n_devices] */
};

struct dalcs_gate_drive {
    struct dalcs_gate_range gate; /* v(gate, source), its sign turned for a p channel */
    bool is_follower; /* `gate` is against the drain, where the source is when it is on */
    bool is_decided;  /* sources alone say what it is at all times */
};

/* Sets out_of_memory and returns false where there is none. */
bool dalcs_gate_list_links(struct dalcs_builder *builder, struct dalcs_gate_links *links);

/* v(node) against `reference` where one V source joins them. */
struct dalcs_gate_range dalcs_gate_voltage(const struct dalcs_circuit *c,
                                           const struct dalcs_gate_links *links, int node,
                                           int reference);

struct dalcs_gate_drive dalcs_gate_drive_of(const struct dalcs_circuit *c,
                                            const struct dalcs_gate_links *links,
                                            const struct dalcs_transistor_use *use);

/* channel.c: in place of the switch of a MOSFET whose bulk is not on its source or whose source follows its gate, when its
 * resistance is known. */
void dalcs_transistor_make_channel(struct dalcs_builder *builder,
                                   const struct dalcs_transistor_use *use, double ron, double roff);

/* A transistor by its part number, such as IRF540; false: it is not in the table. */
bool dalcs_transistor_part_find(const char *name, struct dalcs_transistor *transistor);

/* An n channel one of a name that is known nowhere. */
void dalcs_transistor_make_typical(struct dalcs_transistor *transistor,
                                   const struct dalcs_token *name);

/* Channel and threshold of the typical ones among the elements from `first` on, as their gates are driven. */
void dalcs_transistor_settle_typical(struct dalcs_builder *builder,
                                     const struct dalcs_gate_links *links,
                                     struct dalcs_transistor_use *first);

#endif
