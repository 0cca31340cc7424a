/* periodic_response.h - the response of one part of a circuit around its periodic orbit at one frequency.
 *
 * With small signals exp(j w t) on the sources, the perturbation of each quantity y of the circuit is exp(j w t) p(t) with
 * p of the period T. The response is the component at w, or at w + sideband 2 pi / T,
 *     (1/T) int_0^T exp(-j (w + sideband 2 pi / T) t) dy dt,
 * in which a jump of y at an event whose time moves by dt counts as an impulse of (y- - y+) dt. The perturbation d of
 * the states at the start follows from the one period later, exp(j w T) d = M d + r. */
#ifndef DALCS_PERIODIC_RESPONSE_H
#define DALCS_PERIODIC_RESPONSE_H

#include "periodic_gates.h"

/* A piece as a response goes through it. */
struct dalcs_piece_passed {
    const struct dalcs_flow_piece *piece;
    const double complex
        *start; /* [flow->n_columns] the states that it begins with, and outputs of gates */
    double complex phase; /* of sources, where it begins */
    double complex late;  /* s, by which the event at its end is */
};

struct dalcs_periodic_response {
    struct dalcs_periodic_flow *flow;

    struct { /* is told each piece of the next frequency; passed: NULL, none */
        void *user;
        void (*passed)(void *user, const struct dalcs_piece_passed *passed);
    } listener;

    int n_read, *read;                 /* [n_read] columns that are asked for */
    double complex *y;                 /* [n_columns] those of the last frequency */
    int n_all;                         /* states, and the numbers of gates */
    double complex *d;                 /* [n_all] these at the start of the period */
    double complex *now, *next;        /* [flow->n_columns] */
    double complex *A;                 /* [n_all][n_all] */
    double *M;                         /* [n_all][n_all] of the period */
    double drive;                      /* 1: sources have their small signals; 0: none has */
    struct dalcs_periodic_gates gates; /* log is NULL: there are none */
    int *pivot;
    const char *
        resting; /* an element that small signals of a frequency so far leave no linear response (periodic_rest.h) */

    struct { /* a diode that only comes near to its other side, and that they move */
        const struct dalcs_orbit_low *low; /* NULL: none */
        double reach;                      /* of the signals, by which they take it there */
    } near;

    long stamp;
    long last_look; /* the stamp up to which it is looked for */
    struct dalcs_arena arena;
};

/* is_read[n_columns]: columns of the flow's system. */
enum dalcs_status dalcs_periodic_response_setup(struct dalcs_periodic_response *response,
                                                struct dalcs_periodic_flow *flow,
                                                const bool *is_read) DALCS_MUST_CHECK;
void dalcs_periodic_response_finish(struct dalcs_periodic_response *response);

/* response->y at w (rad/s). DALCS_SINGULAR: a multiplier is exp(j w T), there is no single answer. */
enum dalcs_status dalcs_periodic_response_at(struct dalcs_periodic_response *response, double w,
                                             int sideband) DALCS_MUST_CHECK;

#endif
