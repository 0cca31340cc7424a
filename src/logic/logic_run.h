/* logic_run.h - logic in the course of a run: its queue, its outputs, and the parts of the circuit that these act on.
 *
 * After each event, and where an output is due, the session asks it. Comparators are read, the network settles
 * (logic_network.h), outputs that change write a point into their stimulus, and the parts of the circuit that this acts
 * on begin anew from that instant, wherever their segments ended. That may move comparators, at once; then again. */
#ifndef DALCS_LOGIC_RUN_H
#define DALCS_LOGIC_RUN_H

#include "logic_network.h"
#include "radau_state.h"

/* What is told while it goes on. An instant has a number from 1 on, and so has the end of a pulse: what comes due tells of
 * which it comes. Numbers below 0 are of what was on its way when the run began (logic_memory.h). */
struct dalcs_logic_observer {
    void *user;
    void (*due)(void *user, long since);              /* it comes, at this instant */
    void (*took)(void *user, int gate);               /* a sample took what stood before */
    void (*pulse)(void *user, int gate, long number); /* one begins, whose end has that number */
    enum dalcs_status (*decided)(void *user, double t, long number); /* all that happens at t has */
};

/* Sources that a program outside gives values, from one instant at which it is asked to the next. */
struct dalcs_logic_inputs {
    int n;

    struct dalcs_logic_given {
        int stimulus;
        double *time, *value; /* heap */
        size_t capacity[2];
        double now; /* V or A; what was given last */
    } * source;     /* [n] */

    double next;   /* s, when it is asked again; INFINITY: never */
    bool is_given; /* at this instant, and not shown yet */
};

struct dalcs_logic_run {
    struct dalcs_circuit *circuit; /* whose stimuli are written; NULL: none is */
    struct dalcs_euler *euler;     /* whose switches are read */
    struct dalcs_radau *radau;     /* on it; NULL: at rest alone, or steps of implicit Euler */
    struct dalcs_logic_network network;
    bool *bit; /* [n_comparators] */
    int n_comparators;

    struct
        dalcs_logic_change { /* of a bit: the instant of the last one, and how many there were in it */
        long instant;
        int n;
        bool bit;  /* as memory has seen it last */
        long wave; /* in which it has come from outside */
    } * change;    /* [n_comparators] */

    struct dalcs_logic_place { /* of a comparator: its component, or part, and its pair there */
        int part, pair;
    } * place;

    struct dalcs_logic_output {
        bool shown;           /* by the stimuli */
        double *time, *value; /* of q, then of its complement */
        double *time_bar, *value_bar;
        size_t capacity[4];

        struct dalcs_logic_due { /* when q, as it was a delay before, is seen: it changes at each */
            double t;            /* s */
            long since;          /* the instant that it comes of */
        } * due;                 /* [n_due] behind the first */

        size_t first_due, n_due, due_capacity;
        double
            ends; /* s, the pulse of a monostable, or what is behind it; INFINITY: there is none */
        long ends_since; /* its number */
    } * output;          /* [n gates] */

    struct { /* a segment of a part ends at t, before its time */
        void *user;
        void (*tell)(void *user, int part, double t); /* or NULL */
    } cut;

    int n_samples, n_pulses;
    int *sample, *pulse;          /* [n_samples], [n_pulses] gates; pulse: monostables */
    struct dalcs_logic_set waits; /* gates of which something is due */
    double *
        taken; /* [n gates] V: what samples may take at t, as it was before anything happened there */

    struct dalcs_logic_effect {
        bool *changed; /* [n_stimuli] in the present round */
        bool *acts;    /* [n_components] what has changed does on a component */
        int *first,
            *part; /* part[first[k] .. first[k + 1] - 1]: the components that stimulus k acts on */
        bool *
            reads; /* [n_components] a comparator there reads the circuit, and what it says meets something else */
        long *looked,
            *disturbed; /* [n_components] the instant in which such ones were looked at before anything began
                                     there; in which sources changed since */
    } effect;

    double now;   /* s, of the changes of q that the queue is told of */
    bool is_open; /* what happens at `now` is still being decided */
    long
        wave; /* what comes from outside at once and what gates make of it, up to where all memory has acted */
    bool is_late; /* it has undone what has come, and that is still to be read */
    long number;  /* the last one given */
    long instant; /* the number of this one */
    struct dalcs_logic_inputs *inputs;           /* NULL: nothing comes from outside */
    const struct dalcs_logic_observer *observer; /* NULL: none */
    bool out_of_memory;
    struct dalcs_stimulus *as_built; /* [n_stimuli] what the circuit had */
};

/* Where the engine keeps comparators, place[circuit->n_comparators]. */
enum dalcs_status dalcs_logic_find_comparators(const struct dalcs_circuit *circuit,
                                               const struct dalcs_euler *euler,
                                               struct dalcs_logic_place *place) DALCS_MUST_CHECK;

/* Does nothing where no stimulus of the circuit is written. radau, on that engine, may be NULL: rest alone is asked for, or the run is
 * one of implicit Euler. */
enum dalcs_status dalcs_logic_run_setup(struct dalcs_logic_run *l, struct dalcs_circuit *circuit,
                                        struct dalcs_euler *euler,
                                        struct dalcs_radau *radau) DALCS_MUST_CHECK;
void dalcs_logic_run_finish(struct dalcs_logic_run *l);

/* Bits and outputs as the operating point that the engine has solved has them. *changed: it is to be solved again.
 * Without memory: what remembers stays. */
enum dalcs_status dalcs_logic_run_rest(struct dalcs_logic_run *l, bool with_memory,
                                       bool *changed) DALCS_MUST_CHECK;

/* Have all gates the outputs that the solved operating point demands? If not, network.moves lists the others. */
bool dalcs_logic_run_is_at_rest(struct dalcs_logic_run *l);

/* Has a comparator been on another side within this instant, and come back? */
bool dalcs_logic_run_flashed(const struct dalcs_logic_run *l, int comparator);

/* s, the next change of an output that waits; INFINITY: none does. */
double dalcs_logic_run_next(const struct dalcs_logic_run *l);

/* user is the logic. Before parts begin at t, by the positions that commands and crossings have given comparators. What does
 * not settle is refused by dalcs_logic_run_at(). */
enum dalcs_status dalcs_logic_decide_early(void *user, double t) DALCS_MUST_CHECK;

/* All that happens at t, to which all parts have come. DALCS_NOT_CONVERGED: it does not settle; network.moves are the
 * gates that go on changing. */
enum dalcs_status dalcs_logic_run_at(struct dalcs_logic_run *l, double t) DALCS_MUST_CHECK;

#endif
