/* response.h - small sinusoids around an operating point, or around a periodic orbit, under the laws of the elements.
 *
 * Around an orbit a small signal is looked at at one time, with its derivative, and on both sides of an event. Nothing is
 * asked but the devices of the circuit: which line of a diode, a switch or a formula is the one that counts is
 * found anew, from the voltages and currents of the operating point. A law is asked at one frequency, and its defect is
 * measured by what it adds up there. */
#ifndef DALCS_RESPONSE_H
#define DALCS_RESPONSE_H

#include "circuit.h"

#include <complex.h>

/* Voltages and currents; of an operating point and of an orbit their imaginary part is 0. */
struct dalcs_response_values {
    double complex *v; /* [n_nodes] NAN: not known */
    double complex *i; /* [n_devices] */
    double *size; /* [n_devices] what a current is a sum of; below 0: the current is not known */
    double complex *v_rate, *i_rate; /* their derivatives by time; NULL: those of a sine */
    double complex *u,
        *u_rate;      /* [n_devices] of capacitors, by their states; NULL: of their nodes */
    double steepness; /* 1/s: how much of the error of a value its derivative may have */
};

/* [n_devices] each */
struct dalcs_response_devices {
    const bool *are_there; /* in the values */
    const bool *
        are_restless; /* switches that do not agree with what controls them, as a warning has said */
};

enum dalcs_response_law {
    DALCS_RESPONSE_BRANCH,
    DALCS_RESPONSE_NODE,  /* Kirchhoff's current law */
    DALCS_RESPONSE_STATE, /* of a capacitor or a coil across an event */
    DALCS_RESPONSE_TIME,  /* of an event: that of a diode or a switch */
};

struct dalcs_response_finding {
    enum dalcs_response_law law;
    int index;              /* of a node or a device */
    double defect, allowed; /* V or A */
};

/* What happens at one time of an orbit; [2]: just before, and behind. */
struct dalcs_response_event {
    const struct dalcs_response_values *is[2], *at[2]; /* small signals, and the orbit */
    double complex late;                               /* s, by which small signals make it late */
    const signed char *changes; /* [n_devices] of diodes and switches: 1 closes, -1 opens */
    bool is_at_edge;            /* of a source, which is not late */
    bool has_other_causes;      /* that no diode and no switch tells */
};

struct dalcs_response_audit {
    const struct dalcs_circuit *circuit;
    double tolerance; /* over what a law adds up */
    double rounding;  /* of an answer, over the largest */

    struct {                   /* of the orbit, if it is one */
        double tolerance;      /* over the largest that it has */
        double volts, amperes; /* these */
    } orbit;

    const double complex *source; /* [n_stimuli] small signals; NULL: their AC values */
    double t;                     /* s, of the orbit; NAN: of an operating point */

    struct { /* the largest small signals of an orbit so far */
        double volts, amperes;
        double of_flux; /* V: what rounding leaves in the derivatives of fluxes there */
    } small;

    struct dalcs_response_devices of; /* borrowed */
    double omega;                     /* of what is looked at */
    double volts, amperes;        /* the largest there, and what rounding makes of a 0 A at least */
    int *node_of;                 /* [n_nodes] shorts taken together */
    struct response_lines *lines; /* [n_devices] */

    struct {
        int *cluster;               /* [n_nodes] */
        struct response_gain *gain; /* [n_devices] */
        struct response_node *node; /* [n_nodes] */
        double complex *lambda;     /* [most pairs of a formula] */
        double *lambda_size;        /* likewise */
        bool is_known;              /* of what was evaluated last */
    } work;
    struct dalcs_response_finding worst;
    long n_checked, n_not_checked; /* laws */
    struct dalcs_arena arena;
};

/* At the operating point `at`; borrows the circuit and what `of` has. */
enum dalcs_status dalcs_response_audit_start(struct dalcs_response_audit *a,
                                             const struct dalcs_circuit *circuit,
                                             const struct dalcs_response_devices *of,
                                             const struct dalcs_response_values *at,
                                             double tolerance) DALCS_MUST_CHECK;
void dalcs_response_audit_finish(struct dalcs_response_audit *a);

/* From now on around the orbit at the time t, where it is `at`. */
enum dalcs_status
dalcs_response_audit_settle(struct dalcs_response_audit *a, double t,
                            const struct dalcs_response_values *at) DALCS_MUST_CHECK;

/* Adds to `is` the currents that follow from its voltages, and asks all laws. */
void dalcs_response_audit_look(struct dalcs_response_audit *a, double omega,
                               struct dalcs_response_values *is);

/* Are states on both sides what its lateness makes of them, and is it as late as the guard says that brings it about? */
void dalcs_response_audit_event(struct dalcs_response_audit *a,
                                const struct dalcs_response_event *event);

#endif
