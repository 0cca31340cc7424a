/* orbit_gates.h - what gates do in a period of a run, for small signals around it (orbit_log.h). */
#ifndef DALCS_ORBIT_GATES_H
#define DALCS_ORBIT_GATES_H

#include "logic_watch.h"
#include "orbit_rates.h"

/* Where a span ends, or at the start of the period. */
struct dalcs_orbit_instant {
    long number; /* 0: gates do nothing, but outputs come to the ends of their ramps */
    long cause;  /* what comes due then: it is as late as that; 0: nothing */
    double *
        by; /* [n_pins] s/V: a command along outputs is late by so much of what they are off by; NULL: none is */
    double *rate;                 /* [n_taken] V/s, of what samples read just before */
    bool *rests;                  /* [n_pins] outputs that are at a level from then on */
    bool decides;                 /* gates have: */
    struct dalcs_pin_change *pin; /* [n_pins] */
    size_t n_pulses;
    struct dalcs_logic_pulse_begun *pulse; /* [n_pulses] that begin */
    bool *is_positive;                     /* [n_pulses] they last as long as they read */
};

struct dalcs_orbit_gates {
    const struct dalcs_logic_memory *memory;
    struct dalcs_logic_run *logic;
    const struct dalcs_network *network;
    struct dalcs_logic_watch watch;
    struct dalcs_orbit_instant first; /* at the start */
    long n;                           /* the last number given */
    long *cause;                      /* [n + 1] of instants that no span ends with */
    size_t cause_capacity;
    long *since; /* [n_pulses + n_due] at the end: of what is on its way; 0: nothing is */
    struct dalcs_stimulus_term *term;
    struct dalcs_arena *arena;
};

enum dalcs_status dalcs_orbit_gates_setup(struct dalcs_orbit_gates *gates,
                                          struct dalcs_arena *arena,
                                          const struct dalcs_radau *radau,
                                          struct dalcs_logic_run *logic,
                                          const struct dalcs_logic_memory *memory) DALCS_MUST_CHECK;

/* What is known of an instant before gates decide, where the present segment of the part ends at t. */
enum dalcs_status dalcs_orbit_instant_begin(const struct dalcs_orbit_gates *gates,
                                            struct dalcs_orbit_instant *at,
                                            const struct dalcs_radau_part *part,
                                            double t) DALCS_MUST_CHECK;

/* And what they have decided; at: NULL, the circuit has no part in it. */
enum dalcs_status
dalcs_orbit_gates_note(struct dalcs_orbit_gates *gates, struct dalcs_orbit_instant *at,
                       const struct dalcs_logic_instant *instant) DALCS_MUST_CHECK;

/* At the end of the period. */
enum dalcs_status dalcs_orbit_gates_close(struct dalcs_orbit_gates *gates) DALCS_MUST_CHECK;

#endif
