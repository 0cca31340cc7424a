/* device.h - one device of a circuit, and the models of diodes and switches. */
#ifndef DALCS_DEVICE_H
#define DALCS_DEVICE_H

#include "diag.h"
#include "smooth.h"
#include "stimulus.h"

enum dalcs_device_kind {
    DALCS_RESISTOR,  /* R a b value; value 0 is a short */
    DALCS_INDUCTOR,  /* L a b value [IC=] */
    DALCS_CAPACITOR, /* C a b value [IC=] */
    DALCS_VSOURCE,   /* V a b stimulus */
    DALCS_ISOURCE,   /* I a b stimulus: current flows a -> b inside the source */
    DALCS_VCVS,      /* E a b ca cb gain; B a b V= */
    DALCS_CCCS,      /* F a b Vname gain */
    DALCS_VCCS,      /* G a b ca cb gain; B a b I= */
    DALCS_CCVS,      /* H a b Vname gain */
    DALCS_DIODE,     /* D anode cathode model */
    DALCS_SWITCH     /* S a b ca cb model [ON|OFF]; W a b Vname model [ON|OFF] */
};

/* What an affine function is made of. */
enum dalcs_quantity_kind {
    DALCS_QUANTITY_VOLTAGE, /* of a node, V */
    DALCS_QUANTITY_CURRENT, /* of a device, A */
    DALCS_QUANTITY_STIMULUS,
    DALCS_QUANTITY_PAIR, /* the lambda of a pair of the same behaviour */
    DALCS_QUANTITY_TIME, /* these two while formulas are compiled: then they are stimuli */
    DALCS_QUANTITY_WAVE
};

struct dalcs_affine {
    double constant;
    int n;

    const struct dalcs_affine_term {
        enum dalcs_quantity_kind kind;
        int index; /* node, device, stimulus, pair */
        double coefficient;
    } * term; /* [n] ascending by kind and index, none 0 */
};

/* The coefficient of a pair's current. */
static inline double dalcs_affine_of_pair(const struct dalcs_affine *f, int pair) {
    for (int k = 0; k < f->n; k++) {
        if (f->term[k].kind == DALCS_QUANTITY_PAIR && f->term[k].index == pair) {
            return f->term[k].coefficient;
        }
    }
    return 0.0;
}

/* What B, and E and G with VALUE or TABLE, put out: a piecewise-linear function, with
 * 0 <= lambda_k _|_ w_k >= 0 for k = 0..n_pairs-1; or a smooth one. */
struct dalcs_behaviour {
    struct dalcs_affine
        output; /* V or A; of a smooth function what it reads, without a meaning as a sum */
    int n_pairs;
    const struct dalcs_affine *w; /* [n_pairs] */
    const double *
        rest; /* [n_pairs] of the first pair of a jump: the part of its height that it has where its argument
                         * rests at the knot; NAN: of no jump */
    const struct dalcs_smooth *smooth; /* NULL: piecewise linear */
    bool is_part; /* of another formula: its value is no voltage that others are measured by */

    bool is_implicit; /* its pair is that of what reads it: what it puts out is in `written` */

    /* With pairs for what sources alone decide, as the formula says; NULL: this one has them. */
    const struct dalcs_behaviour *written;
};

struct dalcs_device {
    enum dalcs_device_kind kind;
    const char *name; /* "d1", "x1.d1" */
    char letter;      /* 'd': of the name in its own subcircuit */
    int node[4];      /* terminals, then controlling nodes for E, G, S */
    double value;     /* ohm, H, F, or gain */
    double initial;   /* IC=: V for C, A for L; of a balance in storage.c, its x */
    bool has_initial;
    int before_series; /* C: the first node of its card, where that is not node[0]; else 0 */
    bool is_limit;     /* I: limits a current, G: a channel; what it takes is lost as in a diode */
    bool is_storage;   /* E, G: with its core, a capacitor or a coil that is no straight line */
    bool
        is_delay; /* E: gain 0, and 1 at rest, where what a delayed source puts out is what it reads */
    bool is_transformer;    /* E, F: of an ideal one, all of which together take no power */
    bool initially_on;      /* S ... ON */
    bool has_initial_state; /* S carries ON or OFF */
    int stimulus;           /* V, I: index into circuit->stimulus, else -1 */
    int control;            /* F, H, W: index of the controlling V device, else -1 */
    int valve; /* S: index of the diode in series whose current keeps it closed in its hysteresis, else -1 */
    int model; /* D: index into diode_model; S: into switch_model; else -1 */
    const struct dalcs_behaviour *behaviour; /* E, G and B; else NULL: linear in node[2..3] */
    struct dalcs_location where;             /* the element's card */
};

/* Slope 1/roff from -vrev to vfwd, 1/ron more above and 1/rrev more below.
 * Ron = 0 is complementarity, Roff = INFINITY exactly open, Vrev = INFINITY no breakdown. */
struct dalcs_diode_model {
    const char *name;
    double ron, roff, vfwd, vrev, rrev; /* ohm, ohm, V, V, ohm */

    /* v = voltage log(1 + i / saturation) + series i, which the line above is the tangent of at the
     * current `at`; voltage is 0 where the card has lines. In breakdown, at back_at, of
     * breakdown + back_voltage log(i / breakdown_current) + series i; back_voltage is 0 where there is none. */
    struct dalcs_exponential {
        double saturation, voltage, series, at; /* A, V, ohm, A */
        double breakdown, back_voltage, breakdown_current, back_at;
    } exponential;
};

/* Takes the tangents of an exponential diode at these currents, A. */
void dalcs_exponential_take(struct dalcs_diode_model *model, double at, double back_at);

double dalcs_exponential_voltage(const struct dalcs_exponential *diode, double current);

/* Closes when the control (S: a voltage, W: a current) rises through vt + vh, opens when it falls
 * through vt - vh; inverted, the control is minus that. Ron = 0 is a wire, Roff = INFINITY a cut. */
struct dalcs_switch_model {
    const char *name;
    double ron, roff, vt, vh; /* ohm, ohm, V or A, V or A */
    double lser, vser;        /* H, V; in series with each such switch, elements of their own */
    double ilimit;            /* A, either way; INFINITY: none */
    bool is_inverted;
    bool is_exchanged; /* ON and OFF of a card mean open and closed */
};

/* What the channel of a MOSFET carries at most with its gate at its high level. */
struct dalcs_saturation {
    const char *name;
    int device;     /* whose current is the element's */
    double current; /* A; of a p channel below 0 */
    double level;   /* V of the gate */
    struct dalcs_location where;
};

/* Mutual inductance k sqrt(L1 L2) between inductor devices, |k| <= 1. */
struct dalcs_coupling {
    const char *name;
    int inductor[2];
    double k;
    struct dalcs_location where;
};

#endif
