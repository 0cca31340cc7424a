/* observer.h - what a run tells to whoever keeps a record of its steps, such as the ledger of energies. The engine
 * knows nothing else of them. */
#ifndef DALCS_OBSERVER_H
#define DALCS_OBSERVER_H

#include "osnsp.h"

struct dalcs_euler_jump;
struct dalcs_radau_part;

/* Of three switches that slide for themselves. */
enum { DALCS_MOST_SIDES = 32 };

/* The answers on all sides of what slides, two for a switch, and the part of the time for which each holds. */
struct dalcs_observed_sides {
    int n;
    const double *y[DALCS_MOST_SIDES];
    double weight[DALCS_MOST_SIDES];
    double h;     /* s, of the step to all of them */
    double time;  /* s, where that ends */
    double times; /* that it counts, less than 0 where it does so against others */
    int node; /* the node of the method that the step is on its way to; 0: it goes evenly through the whole segment */
};

/* All of them are set; k is the number of a component, states are [n_x], y is [n_columns]. */
struct dalcs_observer {
    void *user;

    /* The component starts from x, before any jump at t = 0. */
    void (*start)(void *user, int k, const double *x);

    /* The answer of a step has these scales. */
    void (*scale)(void *user, int k, const struct dalcs_certificate *certificate);

    /* A step of implicit Euler of length h (s) from x to y, with the inputs at its end. */
    void (*step)(void *user, int k, const double *x, const double *y, const double *inputs,
                 double h);

    /* A jump that is reported. */
    void (*jump)(void *user, const struct dalcs_euler_jump *jump);

    /* The state changes from x to after without a jump. */
    void (*move)(void *user, int k, const double *x, const double *after);

    /* A part's present segment, or up to where it was cut, has been passed through from the state start to
     * part->x. */
    void (*segment)(void *user, const struct dalcs_radau_part *part, const double *start);

    /* A part of radau tries a segment by implicit Euler: what was told of the steps of its last try is void, unless that one
     * has been passed through. A segment that was made may begin anew, or be cut, where gates decide. */
    void (*try_by_euler)(void *user, int k);

    /* In such a try, a step from x to y, the mean of all sides. Its powers are means of those on the sides, no products of
     * means. */
    void (*step_by_euler)(void *user, int k, const double *x, const double *y,
                          const struct dalcs_observed_sides *sides, const double *inputs);
};

#endif
