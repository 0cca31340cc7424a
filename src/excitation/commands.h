/* commands.h - when sources open and close the switches of one system.
 *
 * A switch whose control is a sum of sources moves at times that are known beforehand. Along straight lines
 * they come from the sources' own edges, counted by periods, never accumulated; along curves and their sums with
 * lines from the sources' own terms (control_course.h). The edges themselves are no reason for a step to end. */
#ifndef DALCS_COMMANDS_H
#define DALCS_COMMANDS_H

#include "control_course.h"

struct dalcs_command {
    int pair;
    bool is_on;      /* now */
    double searched; /* s: no move up to here that is not `next` */
    double next;     /* s: it moves then, or when `moves` is false the search goes on then */
    bool moves;
    bool
        on_ramp; /* `next` is in the middle of a ramp or a curve, on which the control then runs away from the
                     threshold */

    /* a PULSE alone that crosses both thresholds in every period: at delay + n period + offset */
    const struct dalcs_stimulus *pulse; /* NULL: the general way */
    double offset[2];                   /* s: closes, opens */
    long n[2];                          /* period of the next of each */
};

/* Of its n-th move (0: closes, 1: opens), for one by a PULSE. */
static inline double dalcs_command_time(const struct dalcs_command *m, int way, long n) {
    return m->pulse->u.pulse.delay + (double)n * m->pulse->u.pulse.period + m->offset[way];
}

struct dalcs_commands {
    const struct dalcs_system *system;
    struct dalcs_control control;
    int n;
    struct dalcs_command *command;
    double next; /* s, the earliest */
};

enum dalcs_status dalcs_commands_setup(struct dalcs_commands *commands,
                                       const struct dalcs_circuit *circuit,
                                       const struct dalcs_system *system) DALCS_MUST_CHECK;

void dalcs_commands_finish(struct dalcs_commands *commands);

/* At t = 0: is_on of every command from its control, and from what it was before; the first search. */
void dalcs_commands_start(struct dalcs_commands *commands);

/* Moves what is due until then, once each, and looks for the next. Returns whether anything moved. */
bool dalcs_commands_obey(struct dalcs_commands *commands, double until);

/* Stimuli (changed[n_stimuli of the circuit]) are others from t on: switches that they control are looked at anew. */
void dalcs_commands_disturb(struct dalcs_commands *commands, double t, const bool *changed);

/* Goes on with searches that have found nothing so far, up to a time. */
void dalcs_commands_look(struct dalcs_commands *commands, double until);

/* s; of all, if they are PULSEs of one period; 0: they are not. After the start. */
double dalcs_commands_period(const struct dalcs_commands *commands);

/* All are PULSEs of the same period: passes over so many of them. */
void dalcs_commands_leap(struct dalcs_commands *commands, long n_periods);

#endif
