/* cones.h - the sources for which a circuit has a solution: linear programs in the equations themselves.
 *
 * At an instant the algebraic rows and the signs of the diodes are
 *     0 = A_II x + B_II z + L_II lambda + E_II s,   lambda >= 0,   C_I x + C_II z + D lambda + F s >= 0.
 * By Farkas' lemma some (z, lambda) satisfies them exactly when mu'(A_II x + E_II s) + nu'(C_I x + F s)
 * >= 0 for every (mu, nu) of the cone
 *     nu >= 0,   B_II' mu + C_II' nu = 0,   L_II' mu + D' nu <= 0.
 * Its members bound the states: a source that one of them contains can make states jump. Members in
 * which no state remains, A_II' mu + C_I' nu = 0, bound the sources themselves: loops of diodes and
 * voltages, cutsets of diodes and currents. Where there are none,
 * some x, z and lambda > 0 make every w > 0: condition (22) of Brogliato and Thibault 2010 with a D, and
 * the corrected condition of theorem 2 of Brogliato and Goeleven 2009 and 5.6 of 2013, whichever
 * variable of each pair is called lambda. GLPK solves the programs. */
#ifndef DALCS_CONES_H
#define DALCS_CONES_H

#include "blocks.h"

/* In a range [lower, upper] of mu' E_II + nu' F over members with |mu|, nu <= 1. */
struct dalcs_cone_range {
    double lower, upper;
    double *lowest,
        *highest; /* [n_x + n_z + n_pairs] multipliers of rows and pairs, those of rows I
                                 0; NULL where the bound is 0 */
};

enum dalcs_cone { DALCS_CONE_SOURCES, DALCS_CONE_STATES, DALCS_N_CONES };

struct dalcs_cones {
    bool is_solved; /* false: built without GLPK, or GLPK gave none */
    bool is_qualified;
    double *point;        /* [n_columns] x, z and lambda at which every w and every lambda is at
                      least 1, when qualified */
    double *ray;          /* [n_x + n_z + n_pairs] a member without states, when not */
    bool has_constraints; /* a member that bounds a diode */
    struct dalcs_cone_range *range[DALCS_N_CONES]; /* [n_inputs] */
};

/* Everything is in the arena. */
enum dalcs_status dalcs_cones_find(struct dalcs_cones *cones, struct dalcs_arena *arena,
                                   const struct dalcs_system *system,
                                   const enum dalcs_hold *hold) DALCS_MUST_CHECK;

#endif
