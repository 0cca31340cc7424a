/* logic_watch.h - what gates do at each instant of a run, for whoever follows small changes through it.
 *
 * An output that is on a ramp is off by -slope dt where all its edges are dt late; between edges it is off by what it was.
 * An output that rests at a level is off by nothing; what a sample holds is off by what it took. */
#ifndef DALCS_LOGIC_WATCH_H
#define DALCS_LOGIC_WATCH_H

#include "logic_memory.h"

struct dalcs_pin_change {
    bool jumps;         /* to a level */
    bool takes;         /* what the sample reads */
    double left, right; /* V/s, its slopes before and behind */
    double leap;        /* V, from before to behind */
};

struct dalcs_logic_instant {
    double t;
    long number;
    size_t n_causes;
    const long *cause;                  /* [n_causes] of what has come due */
    const struct dalcs_pin_change *pin; /* [n_pins] */
    size_t n_pulses;

    const struct dalcs_logic_pulse_begun {
        int gate;
        long number; /* of its end */
    } * pulse;       /* [n_pulses] that have begun */
};

struct dalcs_logic_watch {
    const struct dalcs_logic_memory *memory;
    struct dalcs_logic_run *logic;
    struct dalcs_logic_observer observer;
    void *user;
    enum dalcs_status (*seen)(void *user, const struct dalcs_logic_instant *instant);
    bool out_of_memory;
    size_t n_causes, cause_capacity;
    long *cause;
    struct dalcs_pin_change *pin;
    bool *takes; /* [n_gates] */
    size_t n_pulses, pulse_capacity;
    struct dalcs_logic_pulse_begun *pulse;
};

/* logic->observer is the watch's from then on. */
enum dalcs_status dalcs_logic_watch_start(
    struct dalcs_logic_watch *watch, struct dalcs_logic_run *logic,
    const struct dalcs_logic_memory *memory, void *user,
    enum dalcs_status (*seen)(void *user,
                              const struct dalcs_logic_instant *instant)) DALCS_MUST_CHECK;
void dalcs_logic_watch_finish(struct dalcs_logic_watch *watch);

#endif
