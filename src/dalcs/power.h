/* power.h - what every device gives or takes, as products of the columns of its system.
 *
 * It is written from the devices, not from the equations, so that the sum over all of them, which
 * Tellegen's theorem says is 0, is a check of both. */
#ifndef DALCS_POWER_H
#define DALCS_POWER_H

#include "status.h"

enum dalcs_power_account {
    DALCS_POWER_SOURCES,   /* V, I and controlled ones: what they deliver */
    DALCS_POWER_RESISTORS, /* R, switches, and Roff of diodes: what they take */
    DALCS_POWER_DIODES,    /* their two branches */
    DALCS_POWER_STORED,    /* what coils and capacitors that are no straight lines take besides */
    DALCS_N_POWER_ACCOUNTS
};

/* coefficient * first * second, in W: each a difference of two columns, of which -1 is 0. */
struct dalcs_power_term {
    enum dalcs_power_account account;

    enum dalcs_power_factor {
        DALCS_POWER_CONSTANT, /* second is 1 */
        DALCS_POWER_SQUARE,   /* second is first */
        DALCS_POWER_PRODUCT,
        DALCS_POWER_INPUT /* second is an input */
    } factor;

    const char *element; /* the device */
    double coefficient;
    int first[2], second[2]; /* columns */
    int input;
    int pair; /* 0 while this pair is off; -1: always there */
};

struct dalcs_power {
    int n;
    struct dalcs_power_term *term; /* [n] of one system */
};

struct dalcs_layout;
struct dalcs_network;

/* network->power from the devices; after assembling. */
enum dalcs_status dalcs_power_build(struct dalcs_network *network,
                                    const struct dalcs_layout *layout) DALCS_MUST_CHECK;

#endif
