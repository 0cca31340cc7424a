/* response.h - small sinusoids around an operating point under the laws of the elements.
 *
 * Nothing is asked but the devices of the circuit: which line of a diode, a switch or a formula is the one that counts is
 * found anew, from the voltages and currents of the operating point. A law is asked at one frequency, and its defect is
 * measured by what it adds up there. */
#ifndef DALCS_RESPONSE_H
#define DALCS_RESPONSE_H

#include "circuit.h"

#include <complex.h>

/* Voltages and currents; of an operating point their imaginary part is 0. */
struct dalcs_response_values {
    double complex *v; /* [n_nodes] */
    double complex *i; /* [n_devices] */
    double *size; /* [n_devices] what a current is a sum of; below 0: the current is not known */
};

/* [n_devices] each */
struct dalcs_response_devices {
    const bool *are_there; /* in the values */
    const bool *
        are_restless; /* switches that do not agree with what controls them, as a warning has said */
};

struct dalcs_response_finding {
    bool is_node;
    int index;
    double defect, allowed; /* V or A */
};

struct dalcs_response_audit {
    const struct dalcs_circuit *circuit;
    double tolerance;                 /* over what a law adds up */
    struct dalcs_response_devices of; /* borrowed */
    double omega;                     /* of what is looked at */
    double volts, amperes;        /* the largest there, and what rounding makes of a 0 A at least */
    int *node_of;                 /* [n_nodes] shorts taken together */
    struct response_lines *lines; /* [n_devices] */
    struct response_node *node;   /* [n_nodes] work */
    double complex *lambda;       /* [most pairs of a formula] work */
    double *lambda_size;          /* likewise */
    bool is_known;                /* work: of what was evaluated last */
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

/* Adds to `is` the currents that follow from its voltages, and asks all laws. */
void dalcs_response_audit_look(struct dalcs_response_audit *a, double omega,
                               struct dalcs_response_values *is);

#endif
