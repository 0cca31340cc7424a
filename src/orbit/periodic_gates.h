/* periodic_gates.h - small signals through the instants of gates: how late they are, and what outputs are off by then. */
#ifndef DALCS_PERIODIC_GATES_H
#define DALCS_PERIODIC_GATES_H

#include "periodic_flow.h"

/* At one frequency, in the course of a period. What outputs are off by is with the states (periodic_flow.h). */
struct dalcs_periodic_gates {
    const struct dalcs_orbit_gates *log;
    const struct dalcs_periodic_flow *flow;
    double complex *
        number; /* [n_numbers - n_pins] of those that are no outputs, at the start; then at the end */
    double complex *taken; /* [n_taken] V, of what samples read */
    double complex *next;  /* [n_pulses + n_due] s, at the end */
    double complex *late;  /* [log->n + 1] s, by number */
    bool *is_known;        /* [log->n + 1] */
};

/* How the states and the outputs at the end of a piece follow from what it begins with: a row of it. */
struct dalcs_piece_end {
    void *user;
    double complex (*row)(void *user, int row);
    double complex phase; /* of the sources' small signals, there */
};

enum dalcs_status
dalcs_periodic_gates_setup(struct dalcs_periodic_gates *g, struct dalcs_arena *arena,
                           const struct dalcs_periodic_flow *flow) DALCS_MUST_CHECK;

/* At the start: pin[n_pins] becomes what it is behind the first instant. */
void dalcs_periodic_gates_begin(struct dalcs_periodic_gates *g, double complex *pin);

/* At the end of a piece that ends a span: *dt, where the circuit's own event is not late by itself. */
void dalcs_periodic_gates_meet(struct dalcs_periodic_gates *g, const struct dalcs_orbit_span *span,
                               const struct dalcs_piece_end *end, const double complex *pin,
                               double complex *dt);

/* And behind it. */
void dalcs_periodic_gates_pass(struct dalcs_periodic_gates *g, const struct dalcs_orbit_span *span,
                               double complex dt, double complex *pin);

/* At the end of the period, of its last piece: g->number. */
void dalcs_periodic_gates_end(struct dalcs_periodic_gates *g, const struct dalcs_piece_end *end,
                              const double complex *pin);

#endif
