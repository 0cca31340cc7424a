/* choice.h - the tolerance and the stages of a part, and whether its steps are maps or solves with factors. */
#ifndef DALCS_CHOICE_H
#define DALCS_CHOICE_H

#include "radau_state.h"

/* S: the least and the most that tie a voltage to a current in a system, storage over the whole run among them. */
struct dalcs_conductances {
    double least, most; /* INFINITY and 0: none */
    double joint; /* the largest at one node without storage, a sum that a double rounds; 0: none */
};

struct dalcs_choice {
    double tolerance;    /* that the part is held to; no more than asked for */
    int stages;          /* of the family asked for */
    const char *because; /* why so many; NULL: asked for */
    int map_limit;       /* unknowns of a mode up to which its steps are dense maps */
};

struct dalcs_conductances dalcs_conductances_find(const struct dalcs_system *system, double stop);

/* dense_limit: that of the OSNSP's maps, in unknowns. */
struct dalcs_choice dalcs_choice_make(const struct dalcs_radau_options *options,
                                      const struct dalcs_component *component,
                                      const struct dalcs_conductances *conductances,
                                      int dense_limit);

#endif
