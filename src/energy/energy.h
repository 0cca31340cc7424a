/* energy.h - the ledger of a run: where the energy came from and where it went.
 *
 *     sources = resistors + diodes + jumps + stored change + method
 *
 * holds up to rounding for both methods, whatever the step. In a step of implicit Euler Tellegen's
 * theorem at its end gives it with method = 1/2 |dx|^2 in the metric of the storage; where the step
 * crosses a jump, that is what the jump dissipates. For Radau IIA it holds for the polynomials through
 * the stages (stage_rule.h), method being what the states miss them by, 1/2 |x_0 - x~(0)|^2 over a whole
 * step: algebraic stability (Hairer and Wanner, Solving ODEs II, sec. IV.12). What the integrator moves
 * states by without a jump, where it puts them back on what a mode allows, counts as method too.
 *
 * Kept only when asked for. */
#ifndef DALCS_ENERGY_H
#define DALCS_ENERGY_H

#include "radau_state.h"

/* J; what steps of implicit Euler move. */
struct dalcs_energy_share {
    double account[DALCS_N_POWER_ACCOUNTS];
    double taken; /* by what stores energy, and by the method */
    double turnover;
};

struct dalcs_energy_part {
    const struct dalcs_system *system;
    int n_terms, n_stepped;        /* the first n_stepped need steps, sources decide the others */
    struct dalcs_power_term *term; /* [n_terms] */
    double stored_at_start;        /* J */
    double lost;                   /* J, in the jumps that the next step of euler crosses */
    double largest[2];             /* V, A: what sources drive */
    double *column;                /* [n_columns] the largest of the steps of euler */
    double *half;                  /* [n_x] of the diagonal of the storage */
    bool is_coupled;               /* the storage has entries off its diagonal */
    double *defect;                /* [n_x] work: how far states are off */
    struct dalcs_energy_share tried
        [DALCS_MAX_NODES]; /* in the last segment by implicit Euler: evenly, and up to each node from the one before */
};

struct dalcs_energy_sums { /* J */
    double account[DALCS_N_POWER_ACCOUNTS];
    double jumps, stored_change, method;
    double missed;   /* of radau's polynomials and moves: the magnitudes that are in method */
    double turnover; /* the sum of all that was moved, whatever its sign */
    double rounding; /* what certificates leave open: a balance of this size means nothing */
};

struct dalcs_energy {
    struct dalcs_energy_sums sum;
    struct dalcs_observer observer; /* the engine's way to enter things */
    bool is_euler;
    int n_parts;
    struct dalcs_energy_part *part;
};

/* For the components of `e`, which go with radau or, where that is NULL, with implicit Euler. It is an observer of
 * `e` from then on; it must not move before it is finished. */
enum dalcs_status dalcs_energy_setup(struct dalcs_energy *energy, struct dalcs_euler *e,
                                     const struct dalcs_radau *radau) DALCS_MUST_CHECK;

void dalcs_energy_finish(struct dalcs_energy *energy);

/* At the end of the run: the last segments, what needed no steps, the stored energy. */
enum dalcs_status dalcs_energy_close(struct dalcs_energy *energy, struct dalcs_euler *e,
                                     struct dalcs_radau *radau) DALCS_MUST_CHECK;

/* J: what the sources gave less where it went. */
double dalcs_energy_balance(const struct dalcs_energy *energy);

/* J: a balance that is more than rounding, or else what radau missed where that is more than its
 * tolerance explains; 0 when all is well. radau: NULL with implicit Euler. */
double dalcs_energy_unexplained(const struct dalcs_energy *energy, const struct dalcs_radau *radau);

#endif
